! norm_solve and tang_solve, with tables and without, in any order with one handle: each call has the result of a call without a handle. Tables with
! an odd number of columns are refused.
program tang_solve_handles
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t
  use contact_normal
  implicit none
  integer, parameter :: dp = c_double
  integer(c_int32_t), parameter :: M = 16, NORM = 1, TANG = 2, TANG_BY_TABLES = 3
  real(dp), parameter :: D = 0.1_dp, G(2) = 82000.0_dp, NU(2) = 0.28_dp
  real(dp) :: h(M, M), p(M, M), mus(M, M), q(M, M, 2), cf(-M:M - 1, -M:M - 1), none(2*M, 2*M), alone(M, M, 3)
  type(contact_normal_solver) :: solver
  integer(c_int32_t) :: status, first, second, ix, iy

  do iy = 1, M
    do ix = 1, M
      h(ix, iy) = 1e-4_dp*((ix - 8.5_dp)**2 + (iy - 8.5_dp)**2)
    end do
  end do
  mus = 0.3_dp
  none = 0
  if (contact_normal_influence_half_space(M, M, D, D, G, NU, cf) /= CONTACT_NORMAL_OK) error stop "a table"
  do first = NORM, TANG_BY_TABLES
    call find(first, alone(:, :, first))
  end do
  ! Each call after each other one.
  do first = NORM, TANG_BY_TABLES
    do second = NORM, TANG_BY_TABLES
      call check(first)
      call check(second)
    end do
  end do
  call contact_normal_solver_free(solver)
  call odd_counts()
  print '(a)', "the same bits"

contains

  subroutine check(kind)
    integer(c_int32_t), intent(in) :: kind
    real(dp) :: found(M, M)
    call find(kind, found, solver)
    if (any(transfer(found, [0_c_int64_t]) /= transfer(alone(:, :, kind), [0_c_int64_t]))) then
      print '(a, 3i2)', "other bits: ", kind, first, second
      error stop 1
    end if
  end subroutine

  ! Finds the pressures, or the tractions in x for these pressures.
  subroutine find(kind, found, kept)
    integer(c_int32_t), intent(in) :: kind
    real(dp), intent(out) :: found(M, M)
    type(contact_normal_solver), intent(inout), optional :: kept
    real(dp) :: approach, force, err, slip(M, M, 2), creepage(2), forces(2)
    integer(c_int32_t) :: codes(M, M), cycles
    approach = 0.003_dp
    codes = 0
    creepage = [-1e-4_dp, 0.0_dp]
    q = 0
    select case (kind)
    case (NORM)
      call norm_solve(M, M, D, D, M, M, cf, h, 0, approach, force, codes, p, 1e-8_dp, 1000, cycles, err, status, solver=kept)
      found = p
    case (TANG)
      call tang_solve(M, M, D, D, G, NU, p, mus, 0, 0, creepage(1), creepage(2), 0.0_dp, forces(1), forces(2), D, 0.0_dp, &
        q(:, :, 1), q(:, :, 2), codes, slip(:, :, 1), slip(:, :, 2), 1e-6_dp, 1000, err, status, solver=kept)
      found = q(:, :, 1)
    case default
      call tang_solve(M, M, D, D, G, NU, p, mus, 0, 0, creepage(1), creepage(2), 0.0_dp, forces(1), forces(2), D, 0.0_dp, &
        q(:, :, 1), q(:, :, 2), codes, slip(:, :, 1), slip(:, :, 2), 1e-6_dp, 1000, err, status, solver=kept, xx=cf, yy=cf, xy=none)
      found = q(:, :, 1)
    end select
    if (status /= CONTACT_NORMAL_OK) then
      print '(a, 3i2, 2a)', "not solved: ", kind, first, second, " ", contact_normal_last_error_message()
      error stop 1
    end if
  end subroutine

  subroutine odd_counts()
    real(dp) :: odd(2*M + 1, 2*M), err, slip(M, M, 2), creepage(2), forces(2)
    integer(c_int32_t) :: codes(M, M)
    odd = 1
    creepage = 0
    call tang_solve(M, M, D, D, G, NU, p, mus, 0, 0, creepage(1), creepage(2), 0.0_dp, forces(1), forces(2), D, 0.0_dp, &
      q(:, :, 1), q(:, :, 2), codes, slip(:, :, 1), slip(:, :, 2), 1e-6_dp, 1000, err, status, xx=odd, yy=odd, xy=odd)
    if (status /= CONTACT_NORMAL_INVALID_ARGUMENT) error stop "tables with an odd count of columns"
  end subroutine
end program tang_solve_handles
