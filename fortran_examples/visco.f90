! Effect `visco`: a rigid ball of radius 10 mm on a polymer plate of two branches. First its approach is held, and the force relaxes as the
! modulus does; then a force is held, and the approach creeps. mm, N, s.
program visco_of_a_ball
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_positive_inf
  use contact_normal
  implicit none
  integer, parameter :: m = 64, steps = 8
  real(c_double), parameter :: d = 0.1_c_double, g = 8
  real(c_double), pointer, contiguous :: h(:, :), moduli(:), times(:)
  type(contact_normal_scene) :: scene
  type(contact_normal_visco), pointer :: visco
  integer :: ix, iy

  allocate (h(m, m), moduli(2), times(2), visco)
  moduli = [4.0_c_double, 3.0_c_double]
  times = [0.3_c_double, 3.0_c_double]
  do iy = 1, m
    do ix = 1, m
      h(ix, iy) = (((ix - 0.5_c_double*(m + 1))*d)**2 + ((iy - 0.5_c_double*(m + 1))*d)**2)/20
    end do
  end do
  call contact_normal_scene_init(scene)
  scene%mx = m
  scene%my = m
  scene%dx = d
  scene%dy = d
  scene%shear_modulus = [ieee_value(0.0_c_double, ieee_positive_inf), g]
  scene%poisson_ratio = [0.0_c_double, 0.5_c_double]
  call contact_normal_set_undeformed_distance(scene, h)

  print '(a)', '  time  approach     force   relative      exact'
  scene%load = CONTACT_NORMAL_PRESCRIBED_APPROACH
  scene%approach = 0.2_c_double
  call held()
  print '(a)', '  time  approach     force   pressure'
  scene%load = CONTACT_NORMAL_PRESCRIBED_FORCE
  scene%force = 3
  call held()

contains

  ! Steps of 0.25 s after a jump of the load, which is then held.
  subroutine held()
    type(contact_normal_solver) :: solver
    type(contact_normal_report) :: report
    real(c_double) :: first, exact
    integer :: k

    call contact_normal_report_init(report)
    first = 1
    do k = 0, steps
      call contact_normal_set_visco(scene, visco, modulus_2=moduli, time_2=times, &
        time_step=merge(0.25_c_double, 0.0_c_double, k > 0), continues=k > 0)
      if (k == 0) call check(contact_normal_solver_new(scene, solver=solver))
      call check(contact_normal_solver_solve(solver, scene, report=report))
      if (k == 0) first = report%normal%force
      exact = 1 - sum(moduli*(1 - exp(-report%visco%time/times)))/g
      if (scene%load == CONTACT_NORMAL_PRESCRIBED_APPROACH) then
        print '(f6.2, 2f10.4, 2f11.5)', report%visco%time, report%normal%approach, report%normal%force, &
          report%normal%force/first, exact
      else
        print '(f6.2, 2f10.4, f11.4)', report%visco%time, report%normal%approach, report%normal%force, report%normal%max_pressure
      end if
    end do
    call contact_normal_solver_free(solver)
  end subroutine

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status /= CONTACT_NORMAL_OK) then
      print '(a)', contact_normal_last_error_message()
      error stop 1
    end if
  end subroutine
end program
