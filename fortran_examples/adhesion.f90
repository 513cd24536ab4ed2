! A sphere that adheres to a plane comes closer and goes back. Its forces are compared with those of Johnson, Kendall and Roberts (JKR), and its
! pull-off force is found. Then a periodic rough surface is solved with weak to strong adhesion. With R = 1, w = 1/pi and E* = 3/4 of the sphere
! forces are in pi w R, and the pull-off force of JKR is -1.5.
program adhesion_of_a_sphere
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_positive_inf
  use contact_normal
  implicit none
  integer, parameter :: m = 48, n = 32, steps = 12
  real(c_double), parameter :: half_width = 2.2_c_double, d = 2*half_width/m
  real(c_double), pointer, contiguous :: h(:, :)
  type(contact_normal_scene) :: scene
  type(contact_normal_adhesion), pointer :: adhesion
  type(contact_normal_report) :: report
  integer :: ix, iy

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
  ! 1/E* is (1 - nu)/(2 G) of body 1, because body 2 is rigid.
  scene%shear_modulus = [0.375_c_double, ieee_value(0.0_c_double, ieee_positive_inf)]
  call contact_normal_set_undeformed_distance(scene, h)
  ! Tabor's parameter is 1.9.
  call contact_normal_set_adhesion(scene, adhesion, work=0.3183098861837907_c_double, range=0.3_c_double)
  adhesion%start = CONTACT_NORMAL_START_FROM_APART
  call contact_normal_report_init(report)
  call loop()
  scene%load = CONTACT_NORMAL_PRESCRIBED_FORCE
  scene%force = 0
  call check(contact_normal_pull_off(scene, report=report))
  print '(3(a, f0.2))', 'pull-off: force ', report%normal%force, ', contact ', report%adhesion%repulsive_force, &
    ', attraction ', report%adhesion%adhesive_force
  call weak_to_sticky()

contains

  ! Moves the sphere closer in steps of 0.2, and back again. Each solve of the handle starts from the state of the step before.
  subroutine loop()
    type(contact_normal_solver) :: solver
    type(contact_normal_options) :: options
    real(c_double) :: closer(0:steps - 1), back(0:steps - 1)
    integer :: k, at

    call contact_normal_options_init(options)
    call check(contact_normal_solver_new(scene, solver=solver))
    scene%load = CONTACT_NORMAL_PRESCRIBED_APPROACH
    do k = 0, 2*steps - 2
      at = min(k, 2*steps - 2 - k)
      scene%approach = 0.2_c_double*(at - 6)
      call check(contact_normal_solver_solve(solver, scene, options, report=report))
      if (k < steps) closer(at) = report%normal%force
      back(at) = report%normal%force
      options%initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS
    end do
    call contact_normal_solver_free(solver)
    print '(a)', 'approach   closer     back      JKR'
    do at = steps - 1, 0, -1
      scene%approach = 0.2_c_double*(at - 6)
      if (at > 1) then
        print '(f8.2, 3f9.3)', scene%approach, closer(at), back(at), jkr(scene%approach)
      else
        print '(f8.2, 2f9.3)', scene%approach, closer(at), back(at)
      end if
    end do
  end subroutine

  ! The force of JKR at a given approach. With the contact radius a the approach is a^2 - 2/3 sqrt(6 a), and the force a^3 - sqrt(6 a^3). a is
  ! found by bisection, from the radius of least approach on.
  real(c_double) function jkr(approach)
    real(c_double), intent(in) :: approach
    real(c_double) :: low, high, a

    low = 6.0_c_double**(-1.0_c_double/3)
    high = 3
    do while (high - low > 1e-12_c_double)
      a = 0.5_c_double*(low + high)
      if (a**2 - 2*sqrt(6*a)/3 < approach) then
        low = a
      else
        high = a
      end if
    end do
    jkr = low**3 - sqrt(6*low**3)
  end function

  ! Prints the part of the area that is in contact, for several mean pressures, and for works of adhesion from none to strong. E* = 1, and the
  ! grid is one period.
  subroutine weak_to_sticky()
    integer, parameter :: waves(2, 0:5) = reshape([2, 1, 1, -2, 3, 2, -2, 4, 5, 1, 4, -5], [2, 6])
    real(c_double), parameter :: works(3) = [0.0_c_double, 1e-5_c_double, 1e-4_c_double], pi = acos(-1.0_c_double)
    real(c_double), pointer, contiguous :: distance(:, :)
    type(contact_normal_scene) :: rough
    type(contact_normal_period), pointer :: period
    type(contact_normal_adhesion), pointer :: attraction
    real(c_double) :: areas(3), x, y
    integer :: i, k

    allocate (distance(n, n), period, attraction)
    do iy = 1, n
      do ix = 1, n
        x = (ix - 0.5_c_double)/n
        y = (iy - 0.5_c_double)/n
        distance(ix, iy) = 0.1_c_double + sum([(0.01_c_double/(k + 1)*cos(2*pi*(waves(1, k)*x + waves(2, k)*y) + k*k), k=0, 5)])
      end do
    end do
    call contact_normal_scene_init(rough)
    rough%mx = n
    rough%my = n
    rough%dx = 1.0_c_double/n
    rough%dy = rough%dx
    rough%shear_modulus = [0.5_c_double, ieee_value(0.0_c_double, ieee_positive_inf)]
    call contact_normal_set_undeformed_distance(rough, distance)
    call contact_normal_set_period(rough, period, x=.true., y=.true.)
    rough%load = CONTACT_NORMAL_PRESCRIBED_FORCE
    print '(a)', 'mean pressure   area without, weak and sticky'
    do i = 0, 2
      rough%force = 0.005_c_double*2**i
      do k = 1, 3
        call contact_normal_set_adhesion(rough, attraction, work=works(k))
        call check(contact_normal_solve(rough, report=report))
        areas(k) = report%normal%contact_area
      end do
      print '(f13.3, 1x, 3f9.3)', rough%force, areas
    end do
    deallocate (distance, period, attraction)
  end subroutine

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status /= CONTACT_NORMAL_OK) then
      print '(a)', contact_normal_last_error_message()
      error stop 1
    end if
  end subroutine
end program
