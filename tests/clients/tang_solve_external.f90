! tang_solve from a code without the module and without an interface, compared with that of the module.
program tang_solve_external
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use contact_normal, only: tang_solve
  implicit none
  integer, parameter :: dp = c_double
  integer(c_int32_t), parameter :: MX = 20, MY = 14
  real(dp), parameter :: DX = 0.12_dp, DY = 0.15_dp, G(2) = 82000.0_dp, NU(2) = 0.28_dp, PHI = 1e-4_dp, EPS = 1e-8_dp
  real(dp) :: ps(MX, MY), mus(MX, MY), x, y, q(MX, MY, 2, 2), s(MX, MY, 2, 2), xi(2), eta(2), fx(2), fy(2), err(2)
  integer(c_int32_t) :: igs(MX, MY, 2), ierror(2)
  integer :: ix, iy, motion
  external :: old_code

  do iy = 1, MY
    do ix = 1, MX
      x = (ix - 0.5_dp*(MX + 1))*DX
      y = (iy - 0.5_dp*(MY + 1))*DY
      ps(ix, iy) = 1000*sqrt(max(0.0_dp, 1 - x*x - y*y))
    end do
  end do
  mus = 0.3_dp
  q = 0
  ! A shift by a given force, then a step of rolling from it, then steady rolling.
  do motion = 0, 2
    xi = -7
    eta = 1e-4_dp
    fx = 0.15_dp*sum(ps)*DX*DY
    fy = -7
    igs = -7
    s = -7
    err = -7
    ierror = -7
    call tang_solve(MX, MY, DX, DY, G, NU, ps, mus, motion, 1, xi(1), eta(1), PHI, fx(1), fy(1), DX, 0.0_dp, &
      q(:, :, 1, 1), q(:, :, 2, 1), igs(:, :, 1), s(:, :, 1, 1), s(:, :, 2, 1), EPS, 1000, err(1), ierror(1))
    call old_code(MX, MY, DX, DY, G, NU, ps, mus, motion, xi(2), eta(2), PHI, fx(2), fy(2), &
      q(:, :, 1, 2), q(:, :, 2, 2), igs(:, :, 2), s(:, :, 1, 2), s(:, :, 2, 2), EPS, err(2), ierror(2))
    if (any(ierror /= 0)) error stop "not solved"
    if (.not. (err(2) <= EPS .and. err(2) >= 0)) error stop "residual"
    if (count(igs(:, :, 2) == 1) == 0 .or. count(igs(:, :, 2) == 2) == 0) error stop "stick and slip"
    if (any(igs(:, :, 1) /= igs(:, :, 2))) error stop "codes"
    if (any(bits(q(:, :, :, 1)) /= bits(q(:, :, :, 2))) .or. any(bits(s(:, :, :, 1)) /= bits(s(:, :, :, 2)))) &
      error stop "tractions or slip"
    if (any(bits([xi(1), eta(1), fx(1), fy(1), err(1)]) /= bits([xi(2), eta(2), fx(2), fy(2), err(2)]))) error stop "numbers"
    if (abs(sum(q(:, :, 1, 2))*DX*DY/fx(2) - 1) > 1e-12_dp) error stop "force"
  end do
  call one_element_by_its_layer()
  call one_element_by_its_weights()
  print '(a)', "the same bits"

contains

  ! An element that sticks: (a + layer) q = -xi. The layer has no compliance, a uniform one, or one per element.
  function traction_by(compliance, compliances) result(found)
    real(dp), intent(in), optional :: compliance, compliances(1, 1)
    real(dp) :: found, xi, eta, fx, fy, px(1, 1), py(1, 1), sx(1, 1), sy(1, 1), err
    integer(c_int32_t) :: code(1, 1), status
    xi = -1e-5_dp
    eta = 0
    px = 0
    py = 0
    call tang_solve(1, 1, DX, DY, G, NU, one(1.0_dp), one(1e3_dp), 0, 0, xi, eta, 0.0_dp, fx, fy, DX, 0.0_dp, &
      px, py, code, sx, sy, EPS, 100, err, status, compliance=compliance, compliances=compliances)
    if (status /= 0 .or. code(1, 1) /= 1) error stop "an element with a layer"
    found = px(1, 1)
  end function

  subroutine one_element_by_its_layer()
    real(dp), parameter :: LAYER = 3e-6_dp, XI = 1e-5_dp
    real(dp) :: bare
    bare = traction_by()
    if (abs(XI/traction_by(LAYER) - XI/bare - LAYER) > 1e-6_dp*LAYER) error stop "the compliance of a layer"
    if (abs(XI/traction_by(compliances=one(LAYER)) - XI/bare - LAYER) > 1e-6_dp*LAYER) error stop "one compliance per element"
  end subroutine

  ! The force is the sum of weight times q dx dy and does not change. The creepage moves the element by its weight.
  subroutine one_element_by_its_weights()
    real(dp) :: xi, eta, fx, fy, px(1, 1), py(1, 1), sx(1, 1), sy(1, 1), err, a
    integer(c_int32_t) :: code(1, 1), status
    a = 1e-5_dp/traction_by()
    xi = 0
    eta = 0
    fx = 0.2_dp*DX*DY
    px = 0
    py = 0
    call tang_solve(1, 1, DX, DY, G, NU, one(1.0_dp), one(1.0_dp), 0, 1, xi, eta, 0.0_dp, fx, fy, DX, 0.0_dp, &
      px, py, code, sx, sy, EPS, 100, err, status, weight_x=one(0.5_dp), weight_y=one(0.3_dp))
    if (status /= 0) error stop "an element with weights"
    if (abs(px(1, 1) - 0.4_dp) > 1e-6_dp .or. bits(fx) /= bits(0.2_dp*DX*DY)) error stop "a weighted force"
    if (abs(xi/(-a*0.4_dp/0.5_dp) - 1) > 1e-6_dp) error stop "a weighted creepage"
    ! One of the two is not given.
    call tang_solve(1, 1, DX, DY, G, NU, one(1.0_dp), one(1.0_dp), 0, 1, xi, eta, 0.0_dp, fx, fy, DX, 0.0_dp, &
      px, py, code, sx, sy, EPS, 100, err, status, weight_x=one(0.5_dp))
    if (status >= 0) error stop "one of two weights"
  end subroutine

  function one(value) result(array)
    real(dp), intent(in) :: value
    real(dp) :: array(1, 1)
    array = value
  end function

  elemental function bits(value) result(found)
    use, intrinsic :: iso_c_binding, only: c_int64_t
    real(dp), intent(in) :: value
    integer(c_int64_t) :: found
    found = transfer(value, found)
  end function

end program tang_solve_external

subroutine old_code(mx, my, dx, dy, g, nu, ps, mus, motion, xi, eta, phi, fx, fy, px, py, igs, ssx, ssy, eps, err, ierror)
  implicit none
  integer :: mx, my, motion, igs(*), ierror
  double precision :: dx, dy, g(2), nu(2), ps(*), mus(*), xi, eta, phi, fx, fy, px(*), py(*), ssx(*), ssy(*), eps, err
  external :: tang_solve
  call tang_solve(mx, my, dx, dy, g, nu, ps, mus, motion, 1, xi, eta, phi, fx, fy, dx, 0d0, px, py, igs, ssx, ssy, &
    eps, 1000, err, ierror)
end subroutine old_code
