! Friction that falls with the slip velocity: a steel wheel starts to roll at 10 m/s, step by step. The solver handle keeps the state of the
! particles of the interface, the friction coefficient of each element, from step to step.
program laws
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_loc
  use contact_normal
  implicit none
  integer, parameter :: dp = c_double
  integer(c_int32_t), parameter :: MX = 48, MY = 44
  real(dp), target :: h(MX, MY), mu(MX, MY)
  real(dp) :: x, y
  integer(c_int32_t) :: status
  integer :: ix, iy, step
  type(contact_normal_solver) :: solver
  type(contact_normal_scene) :: scene
  type(contact_normal_options), target :: options
  type(contact_normal_friction), target :: friction
  type(contact_normal_fields), target :: fields
  type(contact_normal_report), target :: report

  call contact_normal_scene_init(scene)
  call contact_normal_options_init(options)
  call contact_normal_friction_init(friction)
  call contact_normal_fields_init(fields)
  call contact_normal_report_init(report)
  scene%mx = MX
  scene%my = MY
  scene%dx = 0.289_dp
  scene%dy = 0.6304_dp
  do iy = 1, MY
    do ix = 1, MX
      x = (ix - 0.5_dp*(MX + 1))*scene%dx
      y = (iy - 0.5_dp*(MY + 1))*scene%dy
      h(ix, iy) = 8e-4_dp*x*x + 2.8142e-4_dp*y*y
    end do
  end do
  scene%undeformed_distance = c_loc(h)
  scene%shear_modulus = 82000.0_dp
  scene%poisson_ratio = 0.28_dp
  scene%force = 106700.0_dp
  friction%coefficient = 0.33_dp
  friction%motion = CONTACT_NORMAL_MOTION_TRANSIENT_ROLLING
  friction%creepage = [-0.01_dp, 0.0_dp]
  friction%law = CONTACT_NORMAL_FRICTION_LAW_EXPONENTIAL
  friction%kinetic = 0.14_dp
  friction%falling(1) = 0.19_dp
  friction%half_speed(1) = 1250.0_dp
  friction%speed = 10000.0_dp
  friction%memory_distance = 0.02_dp
  friction%memory_speed = 1.0_dp
  scene%friction = c_loc(friction)
  fields%friction_coefficient = c_loc(mu)
  status = contact_normal_solver_new(scene, options, solver)
  if (status < 0) error stop "no solver"
  print '(a)', "step  rolled in mm  Fx/(.33 N)  stick  slip  least mu"
  do step = 1, 60
    friction%continues = merge(0, 1, step == 1)
    status = contact_normal_solver_solve(solver, scene, options, fields, report)
    if (status /= CONTACT_NORMAL_OK) error stop "a step failed"
    if (mod(step, 10) == 0) print '(i4, f14.2, f12.4, 2i6, f11.4)', step, step*scene%dx, &
      report%tangential%force(1)/(0.33_dp*report%normal%force), report%tangential%stick_count, &
      report%tangential%slip_count, minval(mu)
  end do
  call contact_normal_solver_free(solver)
end program laws
