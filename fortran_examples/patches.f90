! Effect `patches`: two steel balls are pressed side by side onto a plate by 1000 N in total. With the factor 0 each ball has a plate of its own.
! With the factor 1 both are on one half-space, where each ball also displaces the surface below the other one.
program patches_example
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use contact_normal
  implicit none
  integer(c_int32_t), parameter :: M = 64
  real(c_double), parameter :: FACTORS(3) = [0.0_c_double, 0.5_c_double, 1.0_c_double]
  type(contact_normal_scene) :: scene
  type(contact_normal_patches), target :: patches
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  real(c_double), target :: h(M, M), matrix(2, 2)
  integer(c_int32_t), target :: patch(M, M)
  real(c_double) :: x, y
  integer :: ix, iy, i

  call contact_normal_scene_init(scene)
  call contact_normal_fields_init(fields)
  call contact_normal_report_init(report)
  scene%mx = M
  scene%my = M
  scene%dx = 0.1_c_double
  scene%dy = 0.1_c_double
  do iy = 1, M
    do ix = 1, M
      x = (ix - 0.5_c_double*(M + 1))*scene%dx
      y = (iy - 0.5_c_double*(M + 1))*scene%dy
      h(ix, iy) = ((abs(x) - 1.2_c_double)**2 + y**2)/1000
      patch(ix, iy) = merge(0_c_int32_t, 1_c_int32_t, x < 0)
    end do
  end do
  call contact_normal_set_undeformed_distance(scene, h)
  scene%shear_modulus = 82000
  scene%poisson_ratio = 0.28_c_double
  scene%force = 1000
  print '(a)', "factor  approach  max pressure  contact area"
  do i = 1, size(FACTORS)
    matrix = reshape([1.0_c_double, FACTORS(i), FACTORS(i), 1.0_c_double], [2, 2])
    call contact_normal_set_patches(scene, patches, patch, matrix)
    if (contact_normal_solve(scene, fields=fields, report=report) /= CONTACT_NORMAL_OK) then
      print '(a)', contact_normal_last_error_message()
      error stop 1
    end if
    print '(f6.1, f10.6, 2f14.2)', FACTORS(i), report%normal%approach, report%normal%max_pressure, report%normal%contact_area
  end do
end program patches_example
