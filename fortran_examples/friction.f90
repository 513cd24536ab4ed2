! Effect friction and tang_solve: a steel ball on a steel plate is pushed sideways and back, step by step, and then rolls.
program friction
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use contact_normal, only: contact_normal_hertz, contact_normal_hertz_solution, contact_normal_hertz_solution_init, &
    CONTACT_NORMAL_PRESCRIBED_FORCE, tang_solve
  implicit none
  integer, parameter :: dp = c_double
  integer(c_int32_t), parameter :: M = 48
  real(dp), parameter :: D = 0.04_dp, G(2) = 82000.0_dp, NU(2) = 0.28_dp
  real(dp) :: ps(M, M), mus(M, M), px(M, M), py(M, M), ssx(M, M), ssy(M, M), x, y, xi, eta, fx, fy, mu_n, err
  integer(c_int32_t) :: igs(M, M), ierror
  type(contact_normal_hertz_solution) :: hertz
  real(dp), parameter :: SHIFTS(5) = [-0.6_dp, -0.6_dp, 0.6_dp, 0.6_dp, 0.6_dp]
  integer :: ix, iy, step

  ! The pressures of Hertz for a force of 1000 N and h = r^2/100.
  call contact_normal_hertz_solution_init(hertz)
  ierror = contact_normal_hertz(0.01_dp, 0.01_dp, G, NU, CONTACT_NORMAL_PRESCRIBED_FORCE, 1000.0_dp, hertz)
  if (ierror /= 0) error stop "no Hertz solution"
  do iy = 1, M
    do ix = 1, M
      x = (ix - 0.5_dp*(M + 1))*D/hertz%semi_axis_x
      y = (iy - 0.5_dp*(M + 1))*D/hertz%semi_axis_y
      ps(ix, iy) = hertz%max_pressure*sqrt(max(0.0_dp, 1 - x*x - y*y))
    end do
  end do
  mus = 0.3_dp
  mu_n = 0.3_dp*sum(ps)*D*D
  px = 0
  py = 0
  print '(a)', "step  shift in um  Fx/(mu N)  stick  slip"
  do step = 1, 5
    xi = SHIFTS(step)*1e-3_dp
    eta = 0
    call tang_solve(M, M, D, D, G, NU, ps, mus, 0, 0, xi, eta, 0.0_dp, fx, fy, 0.0_dp, 0.0_dp, px, py, igs, ssx, ssy, &
      1e-6_dp, 1000, err, ierror)
    if (ierror /= 0) error stop "tang_solve failed"
    print '(i4, f13.2, f11.4, 2i6)', step, 1e3_dp*xi, fx/mu_n, count(igs == 1), count(igs == 2)
  end do
  print '(a)', "step  rolled in mm  Fx/(mu N)  stick  slip"
  do step = 1, 40
    xi = -0.0005_dp
    call tang_solve(M, M, D, D, G, NU, ps, mus, 1, 0, xi, eta, 0.0_dp, fx, fy, D, 0.0_dp, px, py, igs, ssx, ssy, &
      1e-6_dp, 1000, err, ierror)
    if (ierror /= 0) error stop "tang_solve failed"
    if (mod(step, 10) == 0) print '(i4, f13.2, f11.4, 2i6)', step, step*D, fx/mu_n, count(igs == 1), count(igs == 2)
  end do
end program friction
