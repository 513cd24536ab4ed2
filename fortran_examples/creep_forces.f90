! A table of creep forces: an elliptic contact of steel on steel in steady rolling. The normal problem is solved once, and then the tangential
! problem for each creepage and spin, on all cores.
program creep_forces
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use contact_normal
  implicit none
  integer, parameter :: dp = c_double
  integer(c_int32_t), parameter :: MX = 48, MY = 36, CREEPAGES = 7, SPINS = 2, N = CREEPAGES*SPINS
  real(dp), parameter :: D = 0.3_dp, MU = 0.3_dp
  real(dp), parameter :: XI(CREEPAGES) = [-1e-4_dp, -2e-4_dp, -5e-4_dp, -1e-3_dp, -2e-3_dp, -4e-3_dp, -8e-3_dp]
  real(dp), parameter :: PHI(SPINS) = [5e-5_dp, 2e-4_dp]
  type(contact_normal_scene) :: scene
  type(contact_normal_friction), target :: friction
  type(contact_normal_options) :: options
  type(contact_normal_friction_results) :: results
  type(contact_normal_report) :: report
  real(dp), target :: h(MX, MY), force(2, N), moment(N)
  integer(c_int64_t), target :: slip_count(N)
  real(dp) :: entries(3, N)
  integer :: ix, iy, i, k

  do iy = 1, MY
    do ix = 1, MX
      h(ix, iy) = ((ix - 0.5_dp*(MX + 1))*D)**2/920 + ((iy - 0.5_dp*(MY + 1))*D)**2/600
    end do
  end do
  call contact_normal_scene_init(scene)
  call contact_normal_options_init(options)
  call contact_normal_friction_results_init(results)
  call contact_normal_report_init(report)
  call contact_normal_set_undeformed_distance(scene, h)
  scene%mx = MX
  scene%my = MY
  scene%dx = D
  scene%dy = D
  scene%shear_modulus = 82000
  scene%poisson_ratio = 0.28_dp
  scene%force = 82000
  call contact_normal_set_friction(scene, friction, coefficient=MU)
  friction%motion = CONTACT_NORMAL_MOTION_STEADY_ROLLING
  options%threads = 0
  ! Entries that follow each other have similar motions, because each solve starts from the tractions of the entry before.
  do k = 1, SPINS
    do i = 1, CREEPAGES
      entries(:, (k - 1)*CREEPAGES + i) = [XI(i), 0.0_dp, PHI(k)]
    end do
  end do
  call contact_normal_set_friction_results(results, force=force, moment=moment, slip_count=slip_count)
  if (contact_normal_solve_tangential(scene, options=options, n=N, entries=entries, results=results, report=report) /= &
    CONTACT_NORMAL_OK) error stop "contact_normal_solve_tangential failed"
  print '(i0, a)', report%normal%contact_count, " elements in contact"
  print '(a)', "creepage in 1e-3  spin in 1/m  Fx/(mu N)  Fy/(mu N)  Mz in Nm   slip"
  do i = 1, N
    print '(f16.1, f13.2, 2f11.3, f10.2, i7)', 1e3_dp*entries(1, i), 1e3_dp*entries(3, i), force(:, i)/(MU*report%normal%force), &
      1e-3_dp*moment(i), slip_count(i)
  end do
end program creep_forces
