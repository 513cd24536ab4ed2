! Wear: a steel ball of radius 5 mm does not move, and is pressed by 50 N onto a steel disc that slides past it in 100 steps of 0.5 mm. After each
! step the depth of wear of the ball, K/H p |s|, is added to the undeformed distance. The contact area grows, and the pressures decrease. Units
! are m, N and Pa.
program wear_of_a_ball
  use, intrinsic :: iso_c_binding
  use contact_normal
  implicit none
  integer, parameter :: dp = c_double, m = 64
  real(dp), parameter :: slide = 5e-4_dp, force = 50, wear_coefficient = 1e-4_dp, hardness = 6e9_dp
  real(dp), target :: h(m, m), pressure(m, m), q(m, m, 2), s(m, m, 2), depth(m, m)
  real(dp) :: volume, work
  type(contact_normal_solver) :: solver
  type(contact_normal_scene) :: scene
  type(contact_normal_options) :: options
  type(contact_normal_friction), target :: friction
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  type(contact_normal_wear) :: wear
  type(contact_normal_worn) :: worn
  integer :: ix, iy, k, step

  call contact_normal_scene_init(scene)
  call contact_normal_options_init(options)
  call contact_normal_friction_init(friction)
  call contact_normal_fields_init(fields)
  call contact_normal_report_init(report)
  call contact_normal_wear_init(wear)
  call contact_normal_worn_init(worn)
  scene%mx = m
  scene%my = m
  scene%dx = 6.25e-6_dp
  scene%dy = scene%dx
  wear%dx = scene%dx
  wear%dy = scene%dy
  do iy = 1, m
    do ix = 1, m
      h(ix, iy) = (((ix - 0.5_dp*(m + 1))*scene%dx)**2 + ((iy - 0.5_dp*(m + 1))*scene%dy)**2)/0.01_dp
    end do
  end do
  scene%undeformed_distance = c_loc(h)
  scene%shear_modulus = 80e9_dp
  scene%poisson_ratio = 0.3_dp
  scene%force = force
  scene%friction = c_loc(friction)
  friction%coefficient = 0.5_dp
  friction%creepage(1) = -slide
  fields%pressure = c_loc(pressure)
  do k = 1, 2
    fields%traction(k) = c_loc(q(1, 1, k))
    fields%slip(k) = c_loc(s(1, 1, k))
  end do
  wear%coefficient = wear_coefficient
  wear%hardness = hardness
  call check(contact_normal_solver_new(scene, options, solver))
  print '(a)', '  slid  elements  largest p  deepest  volume  K F L/H    work  mu F L'
  print '(a)', '    mm                  MPa   um/step    um^3     um^3      mJ      mJ'
  volume = 0
  work = 0
  do step = 1, 100
    friction%continues = merge(1_c_int32_t, 0_c_int32_t, step > 1)
    call check(contact_normal_solver_solve(solver, scene, options, fields, report))
    call check(contact_normal_frictional_wear(wear, q, s, depth=depth, worn=worn, pressure=pressure))
    h = h + depth
    volume = volume + worn%volume
    work = work + worn%work
    if (step == 1 .or. mod(step, 20) == 0) print '(f6.1, i10, i11, f10.4, i8, i9, 2f8.2)', 1e3_dp*step*slide, &
      report%normal%contact_count, nint(1e-6_dp*report%normal%max_pressure), 1e6_dp*worn%largest_depth, nint(1e18_dp*volume), &
      nint(1e18_dp*wear_coefficient*force*step*slide/hardness), 1e3_dp*work, 1e3_dp*0.5_dp*force*step*slide
  end do
  call contact_normal_solver_free(solver)

contains

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status /= CONTACT_NORMAL_OK) then
      print '(a)', contact_normal_last_error_message()
      error stop 1
    end if
  end subroutine
end program
