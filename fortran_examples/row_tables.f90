! Effect `row_tables`: a steel roller is pressed into a groove by 20 kN. y runs along the section of the groove, a part of a circle, so that the
! normal rotates with y. The displacement along the normal of another row is that on a plane times the cosine of the angle between the normals.
program row_tables_example
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use contact_normal
  implicit none
  integer(c_int32_t), parameter :: M = 64
  real(c_double), parameter :: CURVATURES(3) = [0.0_c_double, 0.05_c_double, 0.1_c_double]
  type(contact_normal_scene) :: scene
  type(contact_normal_row_tables), target :: row_tables
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  real(c_double), target :: h(M, M), plane(-M:M-1, -M:M-1)
  real(c_double), allocatable, target :: tables(:, :, :)
  integer :: ix, iy, jy, i

  call contact_normal_scene_init(scene)
  call contact_normal_fields_init(fields)
  call contact_normal_report_init(report)
  scene%mx = M
  scene%my = M
  scene%dx = 0.2_c_double
  scene%dy = 0.32_c_double
  do iy = 1, M
    do ix = 1, M
      h(ix, iy) = 0.002_c_double*((ix - 0.5_c_double*(M + 1))*scene%dx)**2 &
                + 0.0003_c_double*((iy - 0.5_c_double*(M + 1))*scene%dy)**2
    end do
  end do
  call contact_normal_set_undeformed_distance(scene, h)
  scene%shear_modulus = 82000
  scene%poisson_ratio = 0.28_c_double
  scene%force = 20000
  if (contact_normal_influence_half_space(M, M, scene%dx, scene%dy, scene%shear_modulus, scene%poisson_ratio, plane) &
      /= CONTACT_NORMAL_OK) call stop_with_message()
  allocate(tables(-M:M-1, M, M))
  print '(a)', "curvature  approach  max pressure  contact area"
  do i = 1, size(CURVATURES)
    do jy = 1, M
      do iy = 1, M
        tables(:, iy, jy) = cos((iy - jy)*scene%dy*CURVATURES(i))*plane(:, iy - jy)
      end do
    end do
    call contact_normal_set_row_tables(scene, row_tables, M, tables)
    if (contact_normal_solve(scene, fields=fields, report=report) /= CONTACT_NORMAL_OK) call stop_with_message()
    print '(f9.2, f10.6, f14.1, f14.2)', CURVATURES(i), report%normal%approach, report%normal%max_pressure, &
      report%normal%contact_area
  end do
contains
  subroutine stop_with_message()
    print '(a)', contact_normal_last_error_message()
    error stop 1
  end subroutine
end program row_tables_example
