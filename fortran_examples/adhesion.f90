! A sphere that sticks to a plane: the force at some approaches, and the pull-off. Units: R = 1, w = 1/pi, E* = 3/4, in which forces are in
! pi w R and JKR pulls off at -1.5.
program adhesion_of_a_sphere
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_positive_inf
  use contact_normal
  implicit none
  integer, parameter :: m = 64
  real(c_double), parameter :: half_width = 3.0_c_double, d = 2*half_width/m
  real(c_double), pointer, contiguous :: h(:, :)
  type(contact_normal_scene) :: scene
  type(contact_normal_adhesion), pointer :: adhesion
  type(contact_normal_report) :: report
  integer :: ix, iy, k

  allocate (h(m, m), adhesion)
  do iy = 1, m
    do ix = 1, m
      h(ix, iy) = 0.5_c_double*(((ix - 0.5_c_double)*d - half_width)**2 + ((iy - 0.5_c_double)*d - half_width)**2)
    end do
  end do
  call contact_normal_scene_init(scene)
  scene%mx = m
  scene%my = m
  scene%dx = d
  scene%dy = d
  ! 1/E* = (1 - nu)/(2 G) of body 1, body 2 is rigid.
  scene%shear_modulus = [0.375_c_double, ieee_value(0.0_c_double, ieee_positive_inf)]
  call contact_normal_set_undeformed_distance(scene, h)
  call contact_normal_set_adhesion(scene, adhesion, work=0.3183098861837907_c_double, range=0.5647539_c_double)
  call contact_normal_report_init(report)
  print '(a)', 'approach    force  contact attraction'
  do k = 2, -1, -1
    scene%load = CONTACT_NORMAL_PRESCRIBED_APPROACH
    scene%approach = 0.5_c_double*k
    call check(contact_normal_solve(scene, report=report))
    print '(f8.2, 2f9.3, f11.3)', report%normal%approach, report%normal%force, report%adhesion%repulsive_force, &
      report%adhesion%adhesive_force
  end do
  scene%load = CONTACT_NORMAL_PRESCRIBED_FORCE
  scene%force = 0
  call check(contact_normal_pull_off(scene, report=report))
  print '(a, f5.2)', 'pull-off: force ', report%normal%force

contains

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status /= CONTACT_NORMAL_OK) then
      print '(a)', contact_normal_last_error_message()
      error stop 1
    end if
  end subroutine
end program
