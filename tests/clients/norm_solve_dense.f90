! Problems for norm_solve, and their independent dense solution by Gaussian elimination inside an active set. Included by the programs beside it.
module cases
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use contact_normal
  implicit none
  integer, parameter :: dp = c_double, ip = c_int32_t
  real(dp), parameter :: EPS = 1e-9_dp
  real(dp), parameter :: SHEAR_MODULUS(2) = 0.5_dp, POISSON_RATIO(2) = 0.25_dp

  ! A problem with its table, which covers `reach` times the grid.
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

  ! A NaN that is made from its bits, without a floating-point operation.
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

  ! Solves by norm_solve, from an empty estimate or from `start`.
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

  ! A of the table.
  function matrix(of) result(a)
    type(problem), intent(in) :: of
    real(dp), allocatable :: a(:, :)
    integer :: n, i, j
    n = of%mx*of%my
    allocate (a(n, n))
    do j = 0, n - 1
      do i = 0, n - 1
        a(i + 1, j + 1) = of%cf(mod(i, of%mx) - mod(j, of%mx), i/of%mx - j/of%mx)
      end do
    end do
  end function

  ! Solves by elimination, bordered by the condition of the force if norm is 1. `by` is A, if it is not that of the table.
  function dense(of, norm, load, by) result(found)
    type(problem), intent(in) :: of
    integer(ip), intent(in) :: norm
    real(dp), intent(in) :: load
    real(dp), intent(in), optional :: by(:, :)
    type(answer) :: found
    real(dp), allocatable :: a(:, :), h(:), p(:), e(:), b(:, :), x(:)
    logical, allocatable :: contact(:), wrong(:)
    integer, allocatable :: list(:)
    integer :: n, i, k, step
    n = of%mx*of%my
    allocate (e(n), p(n), contact(n), wrong(n))
    h = reshape(of%hs, [n])
    a = matrix(of)
    if (present(by)) a = by
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

  ! The iteration stops at an rms update of EPS rms(p). If errors fall to 0.9 or less in an iteration, the remaining error is at most 10 updates, and
  ! in one element at most sqrt(n) times the rms.
  function pressure_tolerance(of, exact) result(tolerance)
    type(problem), intent(in) :: of
    type(answer), intent(in) :: exact
    real(dp) :: tolerance
    tolerance = 10*sqrt(real(of%mx, dp)*of%my)*EPS*maxval(exact%ps)
  end function

  ! Errors of p times the area are those of the force. Times the largest row sum of A they are those of hs + A p, and so of pen.
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

  ! Given approach and given force, both from an empty estimate, agree with the dense solution, and so with each other.
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
