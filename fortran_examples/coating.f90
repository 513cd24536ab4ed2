! Effect `coating`: a steel ball of radius 10 mm is pressed by 100 N onto a steel plate with an elastic coating of 0.05 mm, from soft to stiff
! coatings.
program coating_example
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use contact_normal
  implicit none
  integer(c_int32_t), parameter :: M = 96
  real(c_double), parameter :: MODULI(5) = [4e3_c_double, 2e4_c_double, 8e4_c_double, 2e5_c_double, 4e5_c_double]
  type(contact_normal_scene) :: scene
  type(contact_normal_coating), target :: coating
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  real(c_double), target :: h(M, M)
  real(c_double) :: compliance
  integer :: ix, iy, i

  call contact_normal_scene_init(scene)
  call contact_normal_fields_init(fields)
  call contact_normal_report_init(report)
  scene%mx = M
  scene%my = M
  scene%dx = 0.008_c_double
  scene%dy = 0.008_c_double
  do iy = 1, M
    do ix = 1, M
      h(ix, iy) = (((ix - 0.5_c_double*(M + 1))*scene%dx)**2 + ((iy - 0.5_c_double*(M + 1))*scene%dy)**2)/20
    end do
  end do
  call contact_normal_set_undeformed_distance(scene, h)
  scene%shear_modulus = 80000
  scene%poisson_ratio = 0.3_c_double
  scene%force = 100
  print '(a)', "G of coating   approach  max pressure  contact area   compliance at 1/mm"
  do i = 1, size(MODULI)
    call contact_normal_set_coating(scene, 2, coating, 0.05_c_double, MODULI(i), 0.3_c_double)
    call check(contact_normal_coating_compliance(coating, 80000.0_c_double, 0.3_c_double, 1.0_c_double, compliance))
    call check(contact_normal_solve(scene, fields=fields, report=report))
    print '(f12.0, f11.6, f14.1, f14.5, es21.4)', MODULI(i), report%normal%approach, report%normal%max_pressure, &
      report%normal%contact_area, compliance
  end do

contains

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status == CONTACT_NORMAL_OK) return
    print '(a)', contact_normal_last_error_message()
    error stop 1
  end subroutine

end program coating_example
