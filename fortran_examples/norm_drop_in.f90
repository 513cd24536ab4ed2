! What norm_solve replaces: solves a contact by a small NORM with conjugate gradients and products by direct summation, as contact codes have it,
! and then by one call of norm_solve. Usage: norm_drop_in [file for the arrays]
program norm_drop_in
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use contact_normal, only: norm_solve, contact_normal_influence_half_space
  implicit none
  integer, parameter :: dp = c_double
  integer(c_int32_t), parameter :: MX = 40, MY = 40, MAXIT = 1000
  real(dp), parameter :: DX = 20.0_dp/MX, DY = 12.0_dp/MY, PEN = 0.1091_dp, EPS = 1e-9_dp
  real(dp), parameter :: SHEAR_MODULUS(2) = 82000.0_dp, POISSON_RATIO(2) = 0.28_dp
  real(dp) :: cf(-MX:MX - 1, -MY:MY - 1), hs(MX, MY), ps_norm(MX, MY), ps(MX, MY), fn_norm, fn, approach, err
  integer(c_int32_t) :: igs_norm(MX, MY), igs(MX, MY), itcg_norm, itcg, ierror
  integer(c_int64_t) :: t0, t1, t2, rate
  integer :: ix, iy

  ierror = contact_normal_influence_half_space(MX, MY, DX, DY, SHEAR_MODULUS, POISSON_RATIO, cf)
  if (ierror /= 0) error stop "no influence coefficients"
  do iy = 1, MY
    do ix = 1, MX
      hs(ix, iy) = 0.0016681_dp*((ix - 0.5_dp*(MX + 1))*DX)**2 + 0.0030671_dp*((iy - 0.5_dp*(MY + 1))*DY)**2
    end do
  end do

  call system_clock(t0, rate)
  call norm(igs_norm, ps_norm, fn_norm, itcg_norm)
  call system_clock(t1)
  approach = PEN
  igs = 0
  ps = 0
  call norm_solve(MX, MY, DX, DY, MX, MY, cf, hs, 0, approach, fn, igs, ps, EPS, MAXIT, itcg, err, ierror)
  call system_clock(t2)
  if (ierror /= 0) error stop "norm_solve failed"

  print '(a, i0, a, i0, a)', "Hertz contact on ", MX, " x ", MY, " elements"
  print '(a)', "                             NORM  norm_solve"
  print '(a, 2f12.2)', "force          N      ", fn_norm, fn
  print '(a, 2f12.3)', "max pressure   N/mm2  ", maxval(ps_norm), maxval(ps)
  print '(a, 2i12)', "contact        elements", count(igs_norm > 0), count(igs > 0)
  print '(2a)', "the same contact area, pressures within 1e-6 of the largest: ", &
    trim(merge("yes", "no ", all((igs > 0) .eqv. (igs_norm > 0)) .and. all(abs(ps - ps_norm) < 1e-6_dp*maxval(ps))))
  print '(a, i0, a, f0.6, a, i0, a, f0.6, a)', "time NORM ", itcg_norm, " iterations, ", real(t1 - t0, dp)/rate, &
    " s; norm_solve ", itcg, " cycles, ", real(t2 - t1, dp)/rate, " s"
  call write_arrays()

contains

  ! Kalker's NORM for a given approach: solves the equations on the contact area. Then elements with a negative pressure leave it, and elements that
  ! penetrate enter it, until none does.
  subroutine norm(igs, ps, fn, itcg)
    integer(c_int32_t), intent(out) :: igs(MX, MY), itcg
    real(dp), intent(out) :: ps(MX, MY), fn
    logical :: leaves(MX, MY), enters(MX, MY)
    igs = merge(1, 0, hs <= PEN)
    itcg = 0
    do
      call conjugate_gradients(igs, ps, itcg)
      leaves = igs > 0 .and. ps < 0
      enters = igs == 0 .and. hs - PEN + product_by(ps) < 0
      if (.not. (any(leaves) .or. any(enters)) .or. itcg >= MAXIT) exit
      where (leaves) igs = 0
      where (enters) igs = 1
    end do
    fn = sum(ps)*DX*DY
  end subroutine

  ! Solves A p = PEN - hs on the contact area, with p = 0 outside.
  subroutine conjugate_gradients(igs, p, itcg)
    integer(c_int32_t), intent(in) :: igs(MX, MY)
    real(dp), intent(out) :: p(MX, MY)
    integer(c_int32_t), intent(inout) :: itcg
    real(dp) :: r(MX, MY), v(MX, MY), q(MX, MY), rr, before, alpha
    p = 0
    r = merge(PEN - hs, 0.0_dp, igs > 0)
    v = r
    rr = sum(r*r)
    do while (itcg < MAXIT)
      q = merge(product_by(v), 0.0_dp, igs > 0)
      alpha = rr/sum(v*q)
      p = p + alpha*v
      r = r - alpha*q
      itcg = itcg + 1
      if (abs(alpha)*norm2(v) <= EPS*norm2(p)) exit
      before = rr
      rr = sum(r*r)
      v = r + rr/before*v
    end do
  end subroutine

  ! Computes u = A p by direct summation, with O(n^2) operations.
  function product_by(p) result(u)
    real(dp), intent(in) :: p(MX, MY)
    real(dp) :: u(MX, MY)
    integer :: jx, jy, kx, ky
    u = 0
    do jy = 1, MY
      do jx = 1, MX
        if (.not. abs(p(jx, jy)) > 0) cycle
        do ky = 1, MY
          do kx = 1, MX
            u(kx, ky) = u(kx, ky) + cf(kx - jx, ky - jy)*p(jx, jy)
          end do
        end do
      end do
    end do
  end function

  ! Writes "mx my dx dy approach", then "h p contact" of each element.
  subroutine write_arrays()
    character(1000) :: name
    integer :: unit
    if (command_argument_count() < 1) return
    call get_command_argument(1, name)
    open (newunit=unit, file=trim(name), action="write", status="replace")
    write (unit, '(i0, 1x, i0, 3es26.16e3)') MX, MY, DX, DY, approach
    do iy = 1, MY
      do ix = 1, MX
        write (unit, '(2es26.16e3, 1x, i0)') hs(ix, iy), ps(ix, iy), igs(ix, iy)
      end do
    end do
    close (unit)
  end subroutine

end program norm_drop_in
