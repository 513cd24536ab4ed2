! The optional arguments of norm_solve against the dense solution: scale, layer, diag, patches and factors; and a handle that is kept between calls.
! Prints one line per case that holds, and stops at the first one that does not.
include 'norm_solve_dense.f90'

program norm_solve_options
  use cases
  implicit none
  integer(ip), parameter :: MX = 14, MY = 11
  type(problem) :: of
  real(dp) :: diag(MX, MY), factors(2, 2)
  integer(ip) :: patches(MX, MY), ix, iy

  of = paraboloid(MX, MY, 0.3_dp, 0.4_dp, 1)
  do iy = 1, MY
    do ix = 1, MX
      diag(ix, iy) = of%cf(0, 0)*(mod(ix, 3) + 2*mod(iy, 2))
      patches(ix, iy) = merge(0, 1, ix <= MX/2)
    end do
  end do
  factors = reshape([1.0_dp, 0.3_dp, 0.3_dp, 1.0_dp], [2, 2])

  call effects()
  call refusals()
  call handles()

contains

  subroutine effects()
    real(dp), allocatable :: a(:, :), by(:, :)
    integer :: i, j
    allocate (a(MX*MY, MX*MY), by(MX*MY, MX*MY))
    a(:, :) = matrix(of)
    call agrees("scale", 2.5_dp*a, scale=2.5_dp)
    call agrees("layer", a + diagonal(spread([0.7_dp*of%cf(0, 0)], 1, MX*MY)), layer=0.7_dp*of%cf(0, 0))
    call agrees("diag", a + diagonal(reshape(diag, [MX*MY])), diag=diag)
    call agrees("diag and layer", a + diagonal(reshape(diag, [MX*MY]) + of%cf(0, 0)), diag=diag, layer=of%cf(0, 0))
    by(:, :) = a
    do j = 1, MX*MY
      do i = 1, MX*MY
        by(i, j) = a(i, j)*factors(1 + patch_of(i), 1 + patch_of(j))
      end do
    end do
    call agrees("patches", by, patches=patches, factors=factors)
    call agrees("all of them", 0.5_dp*by + diagonal(reshape(diag, [MX*MY])), scale=0.5_dp, diag=diag, patches=patches, &
                factors=factors)
  end subroutine

  pure function patch_of(element) result(patch)
    integer, intent(in) :: element
    integer :: patch
    patch = patches(1 + mod(element - 1, MX), 1 + (element - 1)/MX)
  end function

  function diagonal(values) result(d)
    real(dp), intent(in) :: values(MX*MY)
    real(dp) :: d(MX*MY, MX*MY)
    integer :: k
    d = 0
    do k = 1, MX*MY
      d(k, k) = values(k)
    end do
  end function

  function found_by(norm, load, scale, layer, diag, patches, factors, solver) result(found)
    integer(ip), intent(in) :: norm
    real(dp), intent(in) :: load
    real(dp), intent(in), optional :: scale, layer, diag(:, :), factors(:, :)
    integer(ip), intent(in), optional :: patches(:, :)
    type(contact_normal_solver), intent(inout), optional :: solver
    type(answer) :: found
    allocate (found%ps(of%mx, of%my), found%igs(of%mx, of%my))
    found%igs = 0
    found%ps = 0
    if (norm == 0) found%pen = load
    if (norm == 1) found%fn = load
    call norm_solve(of%mx, of%my, of%dx, of%dy, of%cx, of%cy, of%cf, of%hs, norm, found%pen, found%fn, found%igs, &
                    found%ps, EPS, 1000, found%itcg, found%err, found%ierror, scale=scale, layer=layer, diag=diag, &
                    patches=patches, factors=factors, solver=solver)
  end function

  ! Both loads, with and without a handle.
  subroutine agrees(name, by, scale, layer, diag, patches, factors)
    character(*), intent(in) :: name
    real(dp), intent(in) :: by(:, :)
    real(dp), intent(in), optional :: scale, layer, diag(:, :), factors(:, :)
    integer(ip), intent(in), optional :: patches(:, :)
    type(contact_normal_solver) :: solver
    type(answer) :: exact, found, kept
    integer(ip) :: norm
    real(dp) :: load
    exact = dense(of, 0, of%pen, by)
    do norm = 0, 1
      load = merge(of%pen, exact%fn, norm == 0)
      found = found_by(norm, load, scale, layer, diag, patches, factors)
      ! agree() uses the row sum of the table for the error of the approach. The scales and diagonals here are at most 5 times it.
      call agree(name, of, found, exact)
      kept = found_by(norm, load, scale, layer, diag, patches, factors, solver)
      call same(name, found, kept)
    end do
    call contact_normal_solver_free(solver)
    print '(a)', name
  end subroutine

  subroutine same(name, a, b)
    character(*), intent(in) :: name
    type(answer), intent(in) :: a, b
    call hold(a%ierror == 0 .and. b%ierror == 0, name//": status")
    call hold(all(transfer(a%ps, [0_c_int64_t]) == transfer(b%ps, [0_c_int64_t])), name//": the bits of a handle")
  end subroutine

  subroutine refusals()
    type(answer) :: found
    found = found_by(0, of%pen, scale=-1.0_dp)
    call refused(found, -2, "scale", "scale is refused")
    found = found_by(0, of%pen, layer=-1.0_dp)
    call refused(found, -2, "layer", "layer is refused")
    found = found_by(0, of%pen, diag=-diag)
    call refused(found, -2, "layer", "diag is refused")
    found = found_by(0, of%pen, patches=patches)
    call refused(found, -1, "factors", "patches alone")
    found = found_by(0, of%pen, factors=factors)
    call refused(found, -1, "patch", "factors alone")
    found = found_by(0, of%pen, patches=patches, factors=factors(:, 1:1))
    call hold(found%ierror == -2, "factors that are not square")
    print '(a)', "refusals"
  end subroutine

  subroutine refused(found, status, named, what)
    type(answer), intent(in) :: found
    integer(ip), intent(in) :: status
    character(*), intent(in) :: named, what
    call hold(found%ierror == status, what//": status")
    call hold(index(contact_normal_last_error_message(), named) > 0, what//": message")
  end subroutine

  ! A handle of another set-up is set up again. A handle that refuses a call works afterwards.
  subroutine handles()
    type(contact_normal_solver) :: solver
    type(answer) :: one, other
    call same("first", found_by(0, of%pen), found_by(0, of%pen, solver=solver))
    call same("another load", found_by(1, 0.5_dp), found_by(1, 0.5_dp, solver=solver))
    call same("another scale", found_by(0, of%pen, scale=3.0_dp), found_by(0, of%pen, scale=3.0_dp, solver=solver))
    call same("a layer", found_by(0, of%pen, diag=diag), found_by(0, of%pen, diag=diag, solver=solver))
    one = found_by(1, -1.0_dp, solver=solver)
    call refused(one, -2, "force", "a refusal with a handle")
    call same("after a refusal", found_by(0, of%pen), found_by(0, of%pen, solver=solver))
    one = found_by(0, of%pen, solver=solver)
    of%cf = 1.5_dp*of%cf
    other = found_by(0, of%pen, solver=solver)
    call same("another table", found_by(0, of%pen), other)
    call hold(maxval(other%ps) < 0.8_dp*maxval(one%ps), "another table: the case")
    of = paraboloid(20, 17, 0.3_dp, 0.4_dp, 2)
    call same("another grid", found_by(0, of%pen), found_by(0, of%pen, solver=solver))
    call contact_normal_solver_free(solver)
    print '(a)', "handles"
  end subroutine

end program norm_solve_options
