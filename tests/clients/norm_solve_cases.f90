! norm_solve against an independent dense solution (Gaussian elimination inside an active set), and its promises about
! estimates, codes, garbage and refusals. Prints one line per case that holds; stops at the first that does not.
! Compiled also with -ffast-math and with floating-point traps, so it never computes with the NaNs that it hands over.
module cases
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use contact_normal
  implicit none
  integer, parameter :: dp = c_double, ip = c_int32_t
  real(dp), parameter :: EPS = 1e-9_dp
  real(dp), parameter :: SHEAR_MODULUS(2) = 0.5_dp, POISSON_RATIO(2) = 0.25_dp

  ! One problem with its table, which `reach` times the grid covers.
  type problem
    integer(ip) :: mx, my, cx, cy
    real(dp) :: dx, dy, pen
    real(dp), allocatable :: cf(:, :), hs(:, :)
  end type

  type answer
    real(dp), allocatable :: ps(:, :)
    integer(ip), allocatable :: igs(:, :)
    real(dp) :: pen = -7, fn = -7, err = -7
    integer(ip) :: itcg = -7, ierror = -7
  end type

contains

  ! A NaN that no operation has made.
  function not_a_number() result(value)
    real(dp) :: value
    value = transfer(int(z'7FF8000000000000', c_int64_t), value)
  end function

  ! A paraboloid, h = 0 in the middle and 3 pen or 6 pen at the rim.
  function paraboloid(mx, my, dx, dy, reach) result(new)
    integer(ip), intent(in) :: mx, my, reach
    real(dp), intent(in) :: dx, dy
    type(problem) :: new
    integer :: ix, iy
    new = problem(mx, my, reach*mx, reach*my, dx, dy, 0.01_dp, null(), null())
    allocate (new%cf(-new%cx:new%cx - 1, -new%cy:new%cy - 1), new%hs(mx, my))
    if (contact_normal_influence_half_space(new%cx, new%cy, dx, dy, SHEAR_MODULUS, POISSON_RATIO, new%cf) /= 0) &
      error stop "no coefficients"
    do iy = 1, my
      do ix = 1, mx
        new%hs(ix, iy) = 3*new%pen*(across(ix, mx)**2 + across(iy, my)**2)
      end do
    end do
  end function

  pure function across(i, m) result(x)
    integer, intent(in) :: i
    integer(ip), intent(in) :: m
    real(dp) :: x
    x = (2*i - m - 1)/real(m, dp)
  end function

  ! By norm_solve, from an empty estimate or from `start`.
  function solved(of, norm, load, start, maxit) result(found)
    type(problem), intent(in) :: of
    integer(ip), intent(in) :: norm
    real(dp), intent(in) :: load
    type(answer), intent(in), optional :: start
    integer(ip), intent(in), optional :: maxit
    type(answer) :: found
    integer(ip) :: most
    most = 1000
    if (present(maxit)) most = maxit
    if (present(start)) then
      found = start
    else
      allocate (found%ps(of%mx, of%my), found%igs(of%mx, of%my))
      found%igs = 0
      found%ps = not_a_number()       ! an empty estimate has no pressures that could be read
    end if
    if (norm == 0) found%pen = load
    if (norm == 1) found%fn = load
    call norm_solve(of%mx, of%my, of%dx, of%dy, of%cx, of%cy, of%cf, of%hs, norm, found%pen, found%fn, found%igs, &
                    found%ps, EPS, most, found%itcg, found%err, found%ierror)
  end function

  ! The same by elimination: bordered by the condition of force if norm is 1.
  function dense(of, norm, load) result(found)
    type(problem), intent(in) :: of
    integer(ip), intent(in) :: norm
    real(dp), intent(in) :: load
    type(answer) :: found
    real(dp), allocatable :: a(:, :), h(:), p(:), e(:), b(:, :), x(:)
    logical, allocatable :: contact(:), wrong(:)
    integer, allocatable :: list(:)
    integer :: n, i, j, k, step
    n = of%mx*of%my
    allocate (a(n, n), e(n), p(n), contact(n), wrong(n))
    h = reshape(of%hs, [n])
    do j = 0, n - 1
      do i = 0, n - 1
        a(i + 1, j + 1) = of%cf(mod(i, of%mx) - mod(j, of%mx), i/of%mx - j/of%mx)
      end do
    end do
    found%pen = load
    contact = h < merge(load, huge(load), norm == 0) .and. h < 1e20_dp
    do step = 1, 200
      list = pack([(i, i=1, n)], contact)
      k = size(list)
      allocate (b(k + norm, k + norm), x(k + norm))
      b(:k, :k) = a(list, list)
      x(:k) = -h(list)
      if (norm == 0) then
        x = x + load
      else
        b(:k, k + 1) = -1
        b(k + 1, :k) = of%dx*of%dy
        b(k + 1, k + 1) = 0
        x(k + 1) = load
      end if
      call eliminate(b, x)
      p = 0
      p(list) = x(:k)
      if (norm == 1) found%pen = x(k + 1)
      e = matmul(a, p) - found%pen
      where (h < 1e20_dp) e = e + h
      ! Round-off of the elimination is not a violation.
      where (contact)
        wrong = p < 0
      elsewhere
        wrong = h < 1e20_dp .and. e < -1e-13_dp*of%pen
      end where
      if (.not. any(wrong)) then
        found%ps = reshape(p, [of%mx, of%my])
        found%igs = merge(1, 0, reshape(contact, [of%mx, of%my]))
        found%fn = sum(p)*of%dx*of%dy
        return
      end if
      contact = contact .neqv. wrong
      deallocate (b, x)
    end do
    error stop "the dense solution was not found"
  end function

  ! Gaussian elimination with partial pivoting; x is the right-hand side, then the solution.
  subroutine eliminate(b, x)
    real(dp), intent(inout) :: b(:, :), x(:)
    real(dp) :: row(size(x)), value
    integer :: n, i, k, pivot
    n = size(x)
    do k = 1, n
      pivot = k - 1 + maxloc(abs(b(k:, k)), 1)
      row = b(k, :); b(k, :) = b(pivot, :); b(pivot, :) = row
      value = x(k); x(k) = x(pivot); x(pivot) = value
      do i = k + 1, n
        value = b(i, k)/b(k, k)
        b(i, k:) = b(i, k:) - value*b(k, k:)
        x(i) = x(i) - value*x(k)
      end do
    end do
    do k = n, 1, -1
      x(k) = (x(k) - dot_product(b(k, k + 1:), x(k + 1:)))/b(k, k)
    end do
  end subroutine

  ! The iteration stops at an rms update of EPS rms(p). If errors fall to 0.9 or less in an iteration, what is left is
  ! at most 10 updates, and in one element at most sqrt(n) times the rms.
  function pressure_tolerance(of, exact) result(tolerance)
    type(problem), intent(in) :: of
    type(answer), intent(in) :: exact
    real(dp) :: tolerance
    tolerance = 10*sqrt(real(of%mx, dp)*of%my)*EPS*maxval(exact%ps)
  end function

  ! Errors of p times the area, and times the largest row sum of A: those of the force and of hs + A p, so of pen.
  subroutine agree(name, of, found, exact)
    character(*), intent(in) :: name
    type(problem), intent(in) :: of
    type(answer), intent(in) :: found, exact
    real(dp) :: tolerance
    tolerance = pressure_tolerance(of, exact)
    call hold(found%ierror == 0, name//": status")
    call hold(all(abs(found%ps - exact%ps) <= tolerance), name//": pressures")
    call hold(all(found%ps >= 0), name//": negative pressures")
    call hold(all((found%igs > 0) .or. abs(found%ps) <= 0), name//": pressure outside the contact area")
    call hold(all(((found%igs > 0) .eqv. (exact%igs > 0)) .or. exact%ps <= tolerance), name//": contact area")
    call hold(abs(found%fn - exact%fn) <= tolerance*of%mx*of%my*of%dx*of%dy, name//": force")
    call hold(abs(found%pen - exact%pen) <= tolerance*sum(abs(of%cf(1 - of%mx:of%mx - 1, 1 - of%my:of%my - 1))), &
              name//": approach")
    call hold(found%err <= EPS*maxval(found%ps), name//": err")
  end subroutine

  ! Given approach and given force, both from an empty estimate, against the dense solution and so against each other.
  subroutine both_loads(name, of)
    character(*), intent(in) :: name
    type(problem), intent(in) :: of
    type(answer) :: exact
    exact = dense(of, 0, of%pen)
    call agree(name//", approach", of, solved(of, 0, of%pen), exact)
    call agree(name//", force", of, solved(of, 1, exact%fn), exact)
    exact = dense(of, 1, 2*exact%fn)
    call agree(name//", twice the force", of, solved(of, 1, exact%fn), exact)
    print '(a)', name
  end subroutine

  subroutine hold(condition, what)
    logical, intent(in) :: condition
    character(*), intent(in) :: what
    if (condition) return
    print '(4a)', "FAILED: ", what, " ", contact_normal_last_error_message()
    error stop 1
  end subroutine

end module cases

program norm_solve_cases
  use cases
  implicit none
  call grids()
  call tables()
  call no_contact()
  call estimates()
  call refusals()
  call without_the_module()

contains

  subroutine grids()
    integer :: i
    real(dp), parameter :: RATIOS(7) = [1e-6_dp, 1e-3_dp, 0.25_dp, 1.0_dp, 4.0_dp, 1e3_dp, 1e6_dp]
    character(9) :: ratio
    type(problem) :: of
    type(answer) :: found
    do i = 1, size(RATIOS)
      write (ratio, '(es9.2)') RATIOS(i)
      call both_loads("square grid, dx/dy ="//ratio, paraboloid(16, 16, RATIOS(i), 1.0_dp, 1))
      call both_loads("odd grid, dx/dy ="//ratio, paraboloid(13, 7, RATIOS(i), 1.0_dp, 1))
      call both_loads("mx = 1, dx/dy ="//ratio, paraboloid(1, 40, RATIOS(i), 1.0_dp, 1))
      call both_loads("my = 1, dx/dy ="//ratio, paraboloid(41, 1, RATIOS(i), 1.0_dp, 1))
      call both_loads("1 x 1, dx/dy ="//ratio, paraboloid(1, 1, RATIOS(i), 1.0_dp, 1))
      call both_loads("2 x 3, dx/dy ="//ratio, paraboloid(2, 3, RATIOS(i), 1.0_dp, 1))
    end do
    ! One element far below the others.
    of = paraboloid(9, 11, 0.5_dp, 1.0_dp, 1)
    of%hs = of%hs + 100*of%pen
    of%hs(3, 8) = 0
    call both_loads("one element in contact", of)
    found = solved(of, 0, of%pen)
    call hold(count(found%igs > 0) == 1 .and. found%igs(3, 8) == 1, "one element in contact: the case")
    ! Excluded elements, in the middle too.
    of = paraboloid(14, 12, 1.0_dp, 1.0_dp, 1)
    of%hs(7, 6) = 1e20_dp
    of%hs(1:3, :) = 3e25_dp
    of%hs(9, 4) = transfer(int(z'7FF0000000000000', c_int64_t), of%hs(9, 4))
    call both_loads("excluded elements", of)
    found = solved(of, 0, of%pen)
    call hold(.not. any(found%igs > 0 .and. of%hs >= 1e20_dp), "excluded elements: in contact")
  end subroutine

  subroutine tables()
    type(problem) :: of
    type(answer) :: clean
    integer :: k, l
    call both_loads("a table ten times the grid", paraboloid(12, 9, 0.3_dp, 1.0_dp, 10))
    of = paraboloid(12, 9, 0.3_dp, 1.0_dp, 10)
    clean = solved(of, 0, of%pen)
    of%cf(-of%cx, :) = not_a_number()
    of%cf(:, -of%cy) = not_a_number()
    call same("NaN in row -cy and column -cx of a large table", clean, solved(of, 0, of%pen))
    of = paraboloid(12, 9, 0.3_dp, 1.0_dp, 1)
    of%cf(-of%cx, :) = not_a_number()
    of%cf(:, -of%cy) = not_a_number()
    call same("NaN in row -cy and column -cx of a tight table", clean, solved(of, 0, of%pen))
    of = paraboloid(12, 12, 1.0_dp, 1.0_dp, 1)
    do l = -of%cy, of%cy - 1
      do k = -of%cx, of%cx - 1
        of%cf(k, l) = of%cf(k, l)*(1 + 0.03_dp*k/of%cx - 0.02_dp*l/of%cy)
      end do
    end do
    call both_loads("a slightly non-symmetric table", of)
    ! A layer on a rigid base: coefficients of both signs.
    of = paraboloid(16, 16, 1.0_dp, 1.0_dp, 1)
    of%cf = of%cf - 0.4_dp*of%cf(3, 3)
    where (abs(of%cf) < 0.02_dp*of%cf(0, 0)) of%cf = 0
    call both_loads("a table with negative coefficients", of)
  end subroutine

  subroutine same(name, a, b)
    character(*), intent(in) :: name
    type(answer), intent(in) :: a, b
    call hold(a%ierror == 0 .and. b%ierror == 0, name//": status")
    call hold(all(transfer(a%ps, [0_c_int64_t]) == transfer(b%ps, [0_c_int64_t])), name//": pressures")
    call hold(all(a%igs == b%igs) .and. a%itcg == b%itcg, name//": contact area")
    print '(a)', name
  end subroutine

  subroutine no_contact()
    type(problem) :: of
    type(answer) :: start, found
    of = paraboloid(10, 8, 1.0_dp, 1.0_dp, 1)
    allocate (start%ps(10, 8), start%igs(10, 8))
    start%ps = 5
    start%igs = 3
    call nothing("no contact, approach", solved(of, 0, -1.0_dp))
    call nothing("no contact, approach, from an estimate", solved(of, 0, -1.0_dp, start))
    call nothing("no contact, force", solved(of, 1, 0.0_dp))
    call nothing("no contact, force, from an estimate", solved(of, 1, 0.0_dp, start))
    ! The bodies touch, with nothing to carry: contact without pressure, or none.
    found = solved(of, 0, minval(of%hs))
    call hold(found%ierror == 0 .and. all(abs(found%ps) <= 0) .and. abs(found%err) <= 0, "touching")
    print '(a)', "touching"
    of%hs = 1e30_dp
    found = solved(of, 0, 1.0_dp, start)
    call nothing("no contact, everything excluded", found)
    call hold(abs(found%fn) <= 0, "no contact: force")
  end subroutine

  subroutine nothing(name, found)
    character(*), intent(in) :: name
    type(answer), intent(in) :: found
    call hold(found%ierror == 0, name//": status")
    call hold(all(abs(found%ps) <= 0) .and. all(found%igs == 0), name//": pressures")
    call hold(found%itcg == 0 .and. abs(found%err) <= 0, name//": iterations")
    print '(a)', name
  end subroutine

  subroutine estimates()
    type(problem) :: of
    type(answer) :: exact, found, start
    integer :: norm
    of = paraboloid(24, 20, 1.0_dp, 1.0_dp, 1)
    exact = dense(of, 0, of%pen)
    do norm = 0, 1
      found = solved(of, norm, merge(exact%pen, exact%fn, norm == 0))
      ! From its own solution, with codes in it. One iteration finds that nothing is left to do; a second one at most.
      start = found
      where (start%igs > 0) start%igs = 2
      start%igs(12, 10) = 3
      found = solved(of, norm, merge(exact%pen, exact%fn, norm == 0), start)
      call agree("restart", of, found, exact)
      call hold(found%itcg <= 2, "restart: iterations")
      call hold(found%igs(12, 10) == 3 .and. all(found%igs == start%igs), "restart: codes")
      print '(a, i0)', "a restart from the solution, norm ", norm
      ! From a contact area that is too small on one side and too large on the other; garbage where igs is 0.
      start%ps = not_a_number()
      start%igs = 0
      start%igs(11:24, :) = 2
      start%igs(12, 10) = 3
      start%igs(1, :) = -4
      where (start%igs > 0) start%ps = 0
      found = solved(of, norm, merge(exact%pen, exact%fn, norm == 0), start)
      call agree("estimate", of, found, exact)
      call hold(all(found%igs == merge(merge(start%igs, 1, start%igs > 0), 0, found%igs > 0)), "estimate: codes")
      call hold(any(found%igs == 1) .and. any(found%igs == 2) .and. found%igs(12, 10) == 3, "estimate: the case")
      print '(a, i0)', "codes of an estimate are kept, new elements get 1, norm ", norm
    end do
    ! An estimate without any element that can be in contact.
    of%hs(1:2, :) = 1e20_dp
    exact = dense(of, 0, of%pen)
    start%igs = 0
    start%igs(1:2, :) = 1
    start%ps = 1
    call agree("excluded estimate", of, solved(of, 1, exact%fn, start), exact)
    print '(a)', "an estimate of excluded elements only"
    found = solved(of, 0, of%pen, maxit=1)
    call hold(found%ierror == CONTACT_NORMAL_ITERATION_LIMIT, "maxit: status")
    call hold(found%itcg == 1 .and. all(found%ps >= 0) .and. found%err > 0, "maxit: the best iterate")
    print '(a)', "maxit"
  end subroutine

  subroutine refusals()
    type(problem) :: good, of
    type(answer) :: start
    good = paraboloid(6, 5, 1.0_dp, 1.0_dp, 1)
    allocate (start%ps(6, 5), start%igs(6, 5))
    start%ps = 5
    start%igs = 3
    of = good; of%mx = 0; call refused("mx", of, 0, 1.0_dp, -2)
    of = good; of%my = -5; call refused("my", of, 0, 1.0_dp, -2)
    of = good; of%mx = huge(of%mx); call refused("mx", of, 0, 1.0_dp, -2)
    of = good; of%dx = 0; call refused("dx", of, 0, 1.0_dp, -2)
    of = good; of%dy = -1; call refused("dy", of, 0, 1.0_dp, -2)
    of = good; of%dy = not_a_number(); call refused("dy", of, 0, 1.0_dp, -3)
    of = good; of%cx = 5; call refused("cx", of, 0, 1.0_dp, -2)
    of = good; of%cy = 0; call refused("cy", of, 0, 1.0_dp, -2)
    of = good; of%cf(-2, 1) = not_a_number(); call refused("coefficients", of, 0, 1.0_dp, -3)
    of = good; of%cf(0, 0) = -1; call refused("coefficients", of, 0, 1.0_dp, -7)
    of = good; of%hs(2, 3) = not_a_number(); call refused("undeformed_distance", of, 0, 1.0_dp, -3)
    of = good; of%hs(2, 3) = transfer(int(z'FFF0000000000000', c_int64_t), 1.0_dp)
    call refused("undeformed_distance", of, 0, 1.0_dp, -3)
    of = good; of%hs = 1e20_dp; call refused("force", of, 1, 1.0_dp, -6)
    call refused("load", good, 2, 1.0_dp, -2)
    call refused("approach", good, 0, not_a_number(), -3)
    call refused("force", good, 1, -1.0_dp, -2)
    call refused("force", good, 1, not_a_number(), -3)
    call refused("max_cycles", good, 0, 1.0_dp, -2, maxit=0)
    start%ps(4, 4) = not_a_number()
    call refused("pressure", good, 0, 1.0_dp, -3, start)
    print '(a)', "refusals"
  end subroutine

  subroutine refused(argument, of, norm, load, status, start, maxit)
    character(*), intent(in) :: argument
    type(problem), intent(in) :: of
    integer, intent(in) :: norm, status
    real(dp), intent(in) :: load
    type(answer), intent(in), optional :: start
    integer(ip), intent(in), optional :: maxit
    type(answer) :: before, found
    if (present(start)) then
      before = start
    else
      allocate (before%ps(6, 5), before%igs(6, 5))
      before%ps = 5
      before%igs = 3
    end if
    found = solved(of, norm, load, before, maxit)
    call hold(found%ierror == status, "refusal of "//argument//": status")
    call hold(index(contact_normal_last_error_message(), argument) > 0, "refusal of "//argument//": message")
    call hold(all(found%igs == before%igs) .and. found%itcg == -7 .and. abs(found%err + 7) <= 0, "refusal: outputs")
    call hold(all(transfer(found%ps, [0_c_int64_t]) == transfer(before%ps, [0_c_int64_t])), "refusal: pressures")
    if (norm /= 0) call hold(abs(found%pen + 7) <= 0, "refusal: pen")
    if (norm /= 1) call hold(abs(found%fn + 7) <= 0, "refusal: fn")
  end subroutine

  subroutine without_the_module()
    type(problem) :: of
    type(answer) :: exact, found
    external :: old_code
    of = paraboloid(12, 9, 0.3_dp, 1.0_dp, 1)
    exact = solved(of, 0, of%pen)
    found = exact
    call old_code(of%mx, of%my, of%dx, of%dy, of%cx, of%cy, of%cf, of%hs, found%pen, found%fn, found%igs, found%ps, &
                  EPS, found%itcg, found%err, found%ierror)
    call same("the external subroutine", exact, found)
  end subroutine

end program norm_solve_cases

! A code that knows neither the module nor an interface.
subroutine old_code(mx, my, dx, dy, cx, cy, cf, hs, pen, fn, igs, ps, eps, itcg, err, ierror)
  implicit none
  integer :: mx, my, cx, cy, igs(*), itcg, ierror, i
  double precision :: dx, dy, cf(*), hs(*), pen, fn, ps(*), eps, err
  external :: norm_solve
  do i = 1, mx*my
    igs(i) = 0
  end do
  call norm_solve(mx, my, dx, dy, cx, cy, cf, hs, 0, pen, fn, igs, ps, eps, 1000, itcg, err, ierror)
end subroutine old_code
