! A progress callback that solves with another handle, and one that uses the handle in use: the first call is served, the second refused.
module of_host
  use, intrinsic :: iso_c_binding
  use contact_normal
  implicit none
  integer(c_int32_t), parameter :: M = 16
  real(c_double), parameter :: D = 0.1_c_double, G(2) = 82000, NU(2) = 0.28_c_double
  type(contact_normal_solver) :: handle, other
  type(contact_normal_options) :: options
  type(contact_normal_scene) :: scene
  real(c_double), target :: h(M, M)
  real(c_double) :: ps(M, M), mus(M, M), fx
  integer(c_int32_t) :: inner, outer, calls
  integer, parameter :: ANOTHER = 1, A_NORMAL_PROBLEM = 2, THE_SAME = 3
  integer :: within

contains

  recursive subroutine roll(solver, status, how)
    type(contact_normal_solver), intent(inout) :: solver
    integer(c_int32_t), intent(out) :: status
    type(contact_normal_options), intent(in), optional :: how
    real(c_double) :: px(M, M), py(M, M), sx(M, M), sy(M, M), cksi, ceta, fy, err
    integer(c_int32_t) :: igs(M, M)
    px = 0
    py = 0
    cksi = -1e-3_c_double
    ceta = 0
    call tang_solve(M, M, D, D, G, NU, ps, mus, 2_c_int32_t, 0_c_int32_t, cksi, ceta, 0.0_c_double, fx, fy, 0.0_c_double, &
                    0.0_c_double, px, py, igs, sx, sy, 1e-6_c_double, 1000_c_int32_t, err, status, solver=solver, options=how)
  end subroutine

  ! Makes one call within the call.
  function calls_within(progress, user) bind(C) result(cancel)
    type(contact_normal_progress), intent(in) :: progress
    type(c_ptr), value :: user
    integer(c_int32_t) :: cancel
    cancel = merge(1_c_int32_t, 0_c_int32_t, progress%mx < 0 .or. c_associated(user))
    calls = calls + 1
    if (calls > 1) return
    select case (within)
    case (ANOTHER)
      call roll(other, inner)
    case (A_NORMAL_PROBLEM)
      inner = contact_normal_solver_solve(other, scene)
    case (THE_SAME)
      call roll(handle, inner)
    end select
  end function

  ! A step whose callback makes a call.
  subroutine roll_with(what)
    integer, intent(in) :: what
    within = what
    calls = 0
    call roll(handle, outer, options)
    call check(calls > 0 .and. outer == CONTACT_NORMAL_OK, 'the outer call')
  end subroutine

  subroutine check(condition, what)
    logical, intent(in) :: condition
    character(*), intent(in) :: what
    if (condition) return
    print '(2a)', 'fails: ', what
    error stop
  end subroutine
end module

program fortran_callbacks
  use of_host
  implicit none
  integer :: ix, iy
  integer(c_intptr_t) :: in_use

  do iy = 1, M
    do ix = 1, M
      h(ix, iy) = 1e-3_c_double*((ix - 8.5_c_double)**2 + (iy - 8.5_c_double)**2)
      ps(ix, iy) = 900*sqrt(max(0.0_c_double, 1 - ((ix - 8.5_c_double)**2 + (iy - 8.5_c_double)**2)/30))
    end do
  end do
  mus = 0.3_c_double
  call contact_normal_scene_init(scene)
  scene%mx = M
  scene%my = M
  scene%dx = 1
  scene%dy = 1
  scene%shear_modulus = 1
  scene%poisson_ratio = 0.3_c_double
  scene%approach = 0.02_c_double
  call contact_normal_set_undeformed_distance(scene, h)

  call contact_normal_options_init(options)
  call contact_normal_set_progress(options, calls_within)

  ! With another handle: a step of TANG within a step of TANG.
  call roll_with(ANOTHER)
  call check(inner == CONTACT_NORMAL_OK, 'another handle')
  call contact_normal_solver_free(other)

  ! The normal problem with another handle.
  call check(contact_normal_solver_new(scene, solver=other) == CONTACT_NORMAL_OK, 'a handle')
  call roll_with(A_NORMAL_PROBLEM)
  call check(inner == CONTACT_NORMAL_OK, 'a normal problem')

  ! The handle in use is refused, and remains valid.
  in_use = transfer(handle, in_use)
  call roll_with(THE_SAME)
  call check(inner == CONTACT_NORMAL_INVALID_ARGUMENT, 'a handle in use is refused')
  call check(transfer(handle, in_use) == in_use, 'the handle stays')
  call contact_normal_solver_free(handle)
  call contact_normal_solver_free(other)
  print '(a)', 'all hold'
end program
