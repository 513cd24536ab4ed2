! Effect `visco`: a rigid ball of radius 10 mm on a polymer plate, whose modulus has two branches. First the approach is held, and the force relaxes
! as the modulus does. Then a force is held, and the approach creeps. At last two viscoelastic balls roll on each other at the same speed, with
! influence coefficients of steady rolling: the material behind the contact is relaxed, so the pressures are ahead of the middle. Units are mm, N
! and s.
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
  call rolls(1000.0_c_double)
  call rolls(-1000.0_c_double)

contains

  ! Solves steps of 0.25 s after a jump of the load, which is then held.
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

  ! Rolls balls of radius 50 mm under 100 N to the right or to the left. Their modulus relaxes to one half with a time of 4 ms. The coefficients of
  ! tractions reach one element farther than those of pressures, because of the step of rolling.
  subroutine rolls(speed)
    real(c_double), intent(in) :: speed
    integer(c_int32_t), parameter :: n = 32, reach = n + 1
    real(c_double), parameter :: side = 0.4_c_double, g(2) = 8, nu(2) = 0.4_c_double, pi = acos(-1.0_c_double)
    real(c_double), pointer, contiguous :: h(:, :), p(:, :), normal(:, :), own(:, :, :), half(:), time(:)
    real(c_double), pointer, contiguous :: xx(:, :), yy(:, :), xy(:, :)
    type(contact_normal_scene) :: balls
    type(contact_normal_visco), pointer :: relaxing
    type(contact_normal_friction), pointer :: friction
    type(contact_normal_influence), pointer :: influence
    type(contact_normal_influence), target :: tables(3)
    type(contact_normal_fields) :: fields
    type(contact_normal_report) :: report
    real(c_double) :: x(n)
    integer :: i

    allocate (h(n, n), p(n, n), normal(2*n, 2*n), own(2*reach, 2*reach, 3), half(1), time(1), relaxing, friction, influence)
    half = 4
    time = 0.004_c_double
    x = [((i - 0.5_c_double*(n + 1))*side, i=1, n)]
    h = (spread(x**2, 2, n) + spread(x**2, 1, n))/50
    call contact_normal_scene_init(balls)
    call contact_normal_set_visco(balls, relaxing, half, time, half, time)
    call check(contact_normal_influence_rolling(n, n, side, side, g, nu, relaxing, speed, normal))
    call check(contact_normal_influence_rolling_tangential(reach, reach, side, side, g, nu, relaxing, speed, own))
    xx => own(:, :, 1)
    yy => own(:, :, 2)
    xy => own(:, :, 3)
    ! The scene of steady rolling does not have the effect `visco`, which describes time steps.
    balls%visco = c_null_ptr
    balls%mx = n
    balls%my = n
    balls%dx = side
    balls%dy = side
    balls%force = 100
    call contact_normal_set_undeformed_distance(balls, h)
    call contact_normal_set_influence(balls, influence, n, n, normal)
    call contact_normal_set_friction(balls, friction, coefficient=0.3_c_double)
    call contact_normal_set_tangential_influence(friction, tables, xx, yy, xy)
    friction%motion = CONTACT_NORMAL_MOTION_STEADY_ROLLING
    friction%rolling_direction = merge(0.0_c_double, pi, speed > 0)
    friction%creepage(1) = merge(-0.01_c_double, 0.01_c_double, speed > 0)
    call contact_normal_fields_init(fields)
    fields%pressure = c_loc(p)
    call contact_normal_report_init(report)
    call check(contact_normal_solve(balls, fields=fields, report=report))
    print '(a, f7.0, a, f8.4, a, f8.3, a)', 'at ', speed, ' mm/s: ', sum(p*spread(x, 2, n))/sum(p), ' mm ahead, creep force ', &
      report%tangential%force(1), ' N'
    deallocate (h, p, normal, own, half, time, relaxing, friction, influence)
  end subroutine

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status /= CONTACT_NORMAL_OK) then
      print '(a)', contact_normal_last_error_message()
      error stop 1
    end if
  end subroutine
end program
