! Effect `period`: a wavy surface d cos(2 pi x/L) cos(2 pi y/L), periodic in x and y. Contact is full if the mean pressure is at least
! p* = sqrt(2) pi E* d/L (Johnson, Contact Mechanics, section 13.3).
program period_example
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use contact_normal
  implicit none
  integer(c_int32_t), parameter :: M = 64
  real(c_double), parameter :: SHARES(5) = [0.01_c_double, 0.1_c_double, 0.5_c_double, 0.9_c_double, 1.1_c_double]
  real(c_double), parameter :: PI = acos(-1.0_c_double), LENGTH = 1, D = 0.001_c_double
  type(contact_normal_scene) :: scene
  type(contact_normal_period), target :: period
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  real(c_double), target :: h(M, M)
  real(c_double) :: full
  integer :: ix, iy, i

  call contact_normal_scene_init(scene)
  call contact_normal_fields_init(fields)
  call contact_normal_report_init(report)
  scene%mx = M                       ! the grid is one period
  scene%my = M
  scene%dx = LENGTH/M
  scene%dy = LENGTH/M
  do iy = 1, M
    do ix = 1, M
      h(ix, iy) = D*(1 - cos(2*PI*(ix - 0.5_c_double)/M)*cos(2*PI*(iy - 0.5_c_double)/M))
    end do
  end do
  call contact_normal_set_undeformed_distance(scene, h)
  scene%shear_modulus = 82000
  scene%poisson_ratio = 0.28_c_double
  call contact_normal_set_period(scene, period, x=.true., y=.true.)
  full = sqrt(2.0_c_double)*PI*(82000/(1 - 0.28_c_double))*D/LENGTH
  print '(a)', "mean pressure/p*  part in contact  approach/d"
  do i = 1, size(SHARES)
    scene%force = SHARES(i)*full*LENGTH**2
    if (contact_normal_solve(scene, fields=fields, report=report) /= CONTACT_NORMAL_OK) then
      print '(a)', contact_normal_last_error_message()
      error stop 1
    end if
    print '(f16.2, f17.4, f12.4)', SHARES(i), report%normal%contact_area/LENGTH**2, report%normal%approach/D
  end do
end program period_example
