! contact-normal: the elastic normal contact problem by full multigrid, for Fortran. (Fortran 2018, for the optional
! arguments of bind(C) procedures and for arrays of any rank.)
!
! Compile this file with your program and link the library:
!   gfortran contact_normal.f90 my_program.f90 -lcontact_normal
! The files contact_normal_....inc, which it includes, stand beside it.
!
! It mirrors contact_normal.h, which says what each member and each call does; what differs in Fortran is said here.
!   * Arrays are a(mx, my), x first. A call returns a status: 0 OK; > 0 stopped early, outputs hold the best iterate;
!     < 0 refused, outputs untouched, and contact_normal_last_error_message() says which argument breaks which rule.
!   * Every structure is filled by its _init before its components are set.
!   * Where C takes NULL, the argument is optional.
!   * Arrays are attached to structures by the contact_normal_set_... subroutines. They must have the TARGET or POINTER
!     attribute and be contiguous, which the compiler checks, and live as long as the structure is used.
!   * norm_solve and tang_solve, at the end, are one call each with plain arrays that needs none of this; they are there as
!     module procedures and, for programs that do not use the module, as external subroutines.
module contact_normal
  use, intrinsic :: iso_c_binding
  implicit none
  private

  include 'contact_normal_types.inc'

  ! Operators and workspace for many solves. Copies share what they stand for: free one of them. Since 0.1.
  type, public :: contact_normal_solver
    private
    type(c_ptr) :: handle = c_null_ptr
    logical :: has_tables = .false.      ! of tang_solve
  end type

  abstract interface
    ! Called after each cycle; non-zero cancels. `user` is options%user. Since 0.1.
    function contact_normal_progress_callback(progress, user) bind(C) result(cancel)
      import :: contact_normal_progress, c_int32_t, c_ptr
      type(contact_normal_progress), intent(in) :: progress
      type(c_ptr), value :: user
      integer(c_int32_t) :: cancel
    end function
    ! Writes every h of the grid that is named; non-zero cancels. `user` is accuracy%user. Since 0.1.
    function contact_normal_surface_callback(mx, my, dx, dy, h, user) bind(C) result(cancel)
      import :: c_int32_t, c_double, c_ptr
      integer(c_int32_t), value :: mx, my
      real(c_double), value :: dx, dy
      real(c_double), intent(inout) :: h(mx, my)
      type(c_ptr), value :: user
      integer(c_int32_t) :: cancel
    end function
    ! Called with each log message. Since 0.1.
    subroutine contact_normal_log_callback(level, message)
      import :: c_int32_t
      integer(c_int32_t), intent(in) :: level
      character(*), intent(in) :: message
    end subroutine
  end interface
  public :: contact_normal_progress_callback, contact_normal_surface_callback, contact_normal_log_callback

  include 'contact_normal_exports.inc'
  public :: contact_normal_status_text, contact_normal_last_error_message, contact_normal_version_string, &
    contact_normal_set_undeformed_distance, contact_normal_set_influence, contact_normal_set_fields, &
    contact_normal_set_stress_outputs, &
    contact_normal_set_ledger, contact_normal_set_progress, contact_normal_set_surface, contact_normal_set_log, &
    contact_normal_cost_of_accuracy, contact_normal_solve_to_accuracy, contact_normal_quantities, contact_normal_effects_bill, &
    contact_normal_flash_temperature, contact_normal_frictional_wear, &
    contact_normal_solver_fields, contact_normal_solver_new, &
    contact_normal_solver_solve, contact_normal_solver_solve_batch, contact_normal_solver_set_influence, &
    contact_normal_solve_tangential, &
    contact_normal_solver_free, norm_solve, tang_solve, &
    contact_normal_set_layer, contact_normal_set_pressure_limit, contact_normal_set_period, contact_normal_set_patches, &
    contact_normal_set_row_tables, contact_normal_set_coating, contact_normal_set_friction, &
    contact_normal_set_friction_fields, contact_normal_set_friction_results, contact_normal_set_tangential_influence, &
    contact_normal_set_tangential_row_tables, contact_normal_set_adhesion, contact_normal_set_visco, &
    contact_normal_set_cycle, contact_normal_has, contact_normal_solver_query, &
    contact_normal_constant, contact_normal_set_option, contact_normal_set_cycle_option, contact_normal_set_dump, &
    contact_normal_solver_product, contact_normal_solver_stiffness

  procedure(contact_normal_log_callback), pointer, save :: log_target => null()

  ! Places in the lists of src/ffi/marks.rs: what was wrong, and in a call of which procedure.
  integer(c_int32_t), parameter :: WRONG_BODY = 1, NOT_ASSOCIATED = 2, WRONG_SHAPE = 3
  integer(c_int32_t), parameter :: SET_UNDEFORMED_DISTANCE = 1, SET_INFLUENCE = 2, SET_LAYER = 3, SET_PRESSURE_LIMIT = 4, &
    SET_PERIOD = 5, SET_PATCHES = 6, SET_ROW_TABLES = 7, SET_COATING = 8, SET_CYCLE = 9, SET_FRICTION = 10, &
    SET_TANGENTIAL_INFLUENCE = 11, SET_FRICTION_FIELDS = 12, SET_FRICTION_RESULTS = 13, SET_FIELDS = 14, &
    SET_STRESS_OUTPUTS = 15, SET_LEDGER = 16, SOLVER_SOLVE_BATCH = 17, SET_TANGENTIAL_ROW_TABLES = 18, SET_ADHESION = 19, &
    SET_VISCO = 20, FLASH_TEMPERATURE = 21, FRICTIONAL_WEAR = 22

  interface attach
    procedure attach_doubles, attach_integers
  end interface

contains

  include 'contact_normal_inits.inc'

  include 'contact_normal_procedures.inc'

  include 'contact_normal_setters.inc'

  include 'contact_normal_setters_friction.inc'

  include 'contact_normal_setters_outputs.inc'

  include 'contact_normal_norm_solve.inc'

  include 'contact_normal_tang_solve.inc'

end module contact_normal

! norm_solve for programs that do not use the module, Fortran 77 included: the same arguments, INTEGER and
! DOUBLE PRECISION (not with -fdefault-integer-8). Since 0.1.
recursive subroutine norm_solve(mx, my, dx, dy, cx, cy, cf, hs, norm, pen, fn, igs, ps, eps, maxit, itcg, err, ierror)
  use, intrinsic :: iso_c_binding, only: c_int32_t, c_double
  use contact_normal, only: solve => norm_solve
  implicit none
  integer(c_int32_t), intent(in) :: mx, my, cx, cy, norm, maxit
  real(c_double), intent(in) :: dx, dy, eps, cf(*), hs(*)
  real(c_double), intent(inout) :: pen, fn, ps(*), err
  integer(c_int32_t), intent(inout) :: igs(*), itcg
  integer(c_int32_t), intent(out) :: ierror
  call solve(mx, my, dx, dy, cx, cy, cf, hs, norm, pen, fn, igs, ps, eps, maxit, itcg, err, ierror)
end subroutine norm_solve

! tang_solve for such programs: the same arguments. Since 0.2.
recursive subroutine tang_solve(mx, my, dx, dy, gg, poiss, ps, mus, motion, force, cksi, ceta, cphi, fx, fy, dq, chi, px, py, igs, &
    ssx, ssy, eps, maxit, err, ierror)
  use, intrinsic :: iso_c_binding, only: c_int32_t, c_double
  use contact_normal, only: solve => tang_solve
  implicit none
  integer(c_int32_t), intent(in) :: mx, my, motion, force, maxit
  real(c_double), intent(in) :: dx, dy, gg(2), poiss(2), ps(*), mus(*), cphi, dq, chi, eps
  real(c_double), intent(inout) :: cksi, ceta, fx, fy, px(*), py(*), ssx(*), ssy(*), err
  integer(c_int32_t), intent(inout) :: igs(*)
  integer(c_int32_t), intent(out) :: ierror
  call solve(mx, my, dx, dy, gg, poiss, ps, mus, motion, force, cksi, ceta, cphi, fx, fy, dq, chi, px, py, igs, &
             ssx, ssy, eps, maxit, err, ierror)
end subroutine tang_solve
