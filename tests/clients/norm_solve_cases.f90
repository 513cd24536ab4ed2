! norm_solve against an independent dense solution (norm_solve_dense.f90), and its promises about estimates, codes, garbage and refusals. Prints one
! line per case that holds, and stops at the first one that does not. It is also compiled with -ffast-math and with floating-point traps, so it never
! computes with the NaNs that it passes.
include 'norm_solve_dense.f90'

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
    ! Excluded elements, also in the middle.
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
    ! The bodies touch with a force of 0: contact without pressure, or no contact.
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
      ! A start from its own solution, with codes in it. One iteration finds that nothing is left to do, or a second one at most.
      start = found
      where (start%igs > 0) start%igs = 2
      start%igs(12, 10) = 3
      found = solved(of, norm, merge(exact%pen, exact%fn, norm == 0), start)
      call agree("restart", of, found, exact)
      call hold(found%itcg <= 2, "restart: iterations")
      call hold(found%igs(12, 10) == 3 .and. all(found%igs == start%igs), "restart: codes")
      print '(a, i0)', "a restart from the solution, norm ", norm
      ! A start from a contact area that is too small on one side and too large on the other, with garbage where igs is 0.
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
    ! An estimate whose elements cannot be in contact.
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

! A code without the module and without an interface.
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
