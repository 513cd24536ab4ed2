! contact-normal: the elastic normal contact problem by full multigrid, for Fortran. (Fortran 2018, for the optional
! arguments of bind(C) procedures and for arrays of any rank.)
!
! Compile this file with your program and link the library:
!   gfortran contact_normal.f90 my_program.f90 -lcontact_normal
! contact_normal_exports.inc, contact_normal_norm_solve.inc and contact_normal_tang_solve.inc, which it includes, stand beside
! it.
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

  ! Statuses.
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_OK = 0, CONTACT_NORMAL_ITERATION_LIMIT = 1, &
    CONTACT_NORMAL_CANCELLED = 2, CONTACT_NORMAL_STAGNATED = 3, CONTACT_NORMAL_NULL_POINTER = -1, &
    CONTACT_NORMAL_INVALID_ARGUMENT = -2, CONTACT_NORMAL_NOT_FINITE = -3, CONTACT_NORMAL_STRUCT_SIZE = -4, &
    CONTACT_NORMAL_UNSUPPORTED = -5, CONTACT_NORMAL_INFEASIBLE = -6, CONTACT_NORMAL_NOT_POSITIVE_DEFINITE = -7, &
    CONTACT_NORMAL_OUT_OF_MEMORY = -8, CONTACT_NORMAL_INTERNAL = -99
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_ABI_VERSION = 1
  ! scene%load
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_PRESCRIBED_APPROACH = 0, CONTACT_NORMAL_PRESCRIBED_FORCE = 1
  ! options%method
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_METHOD_AUTO = 0, CONTACT_NORMAL_METHOD_NORM = 1, &
    CONTACT_NORMAL_METHOD_MULTIGRID = 2, CONTACT_NORMAL_METHOD_FULL_MULTIGRID = 3, &
    CONTACT_NORMAL_METHOD_PROJECTED_CG = 4
  ! options%smoother
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_SMOOTHER_AUTO = 0, CONTACT_NORMAL_SMOOTHER_GAUSS_SEIDEL = 1, &
    CONTACT_NORMAL_SMOOTHER_RED_BLACK = 2, CONTACT_NORMAL_SMOOTHER_JACOBI = 3, CONTACT_NORMAL_SMOOTHER_FFT = 4
  ! options%active_set
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_ACTIVE_SET_FREE = 0, CONTACT_NORMAL_ACTIVE_SET_FIXED = 1
  ! options%initial_guess
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_INITIAL_GUESS_NONE = 0, &
    CONTACT_NORMAL_INITIAL_GUESS_GIVEN = 1, CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS = 2
  ! options%criterion
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_CRITERION_RESIDUAL = 0, CONTACT_NORMAL_CRITERION_UPDATE = 1
  ! options%precision
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_PRECISION_AUTO = 0, CONTACT_NORMAL_PRECISION_DOUBLE = 1, &
    CONTACT_NORMAL_PRECISION_MIXED = 2
  ! Bits of untrusted, in reports and ledger rows
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_UNTRUSTED_FORCE = 1, CONTACT_NORMAL_UNTRUSTED_MAX_PRESSURE = 2, &
    CONTACT_NORMAL_UNTRUSTED_PRESSURE = 4
  ! report%limited_by
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_LIMITED_BY_UNKNOWN = 0, CONTACT_NORMAL_LIMITED_BY_GRID = 1, &
    CONTACT_NORMAL_LIMITED_BY_TOLERANCE = 2

  ! Quantities of a price list, and price%obstacle
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_QUANTITY_FORCE = 0, CONTACT_NORMAL_QUANTITY_MAX_PRESSURE = 1, &
    CONTACT_NORMAL_QUANTITY_CONTACT_AREA = 2
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_OBSTACLE_NONE = 0, CONTACT_NORMAL_OBSTACLE_SINGULAR = 1, &
    CONTACT_NORMAL_OBSTACLE_ROUND_OFF = 2, CONTACT_NORMAL_OBSTACLE_ELEMENTS = 3, CONTACT_NORMAL_OBSTACLE_MEMORY = 4, &
    CONTACT_NORMAL_OBSTACLE_TIME = 5
  ! friction%motion
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_MOTION_SHIFT = 0, CONTACT_NORMAL_MOTION_TRANSIENT_ROLLING = 1, &
    CONTACT_NORMAL_MOTION_STEADY_ROLLING = 2
  ! friction%prescribed
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_PRESCRIBED_CREEPAGE = 0, &
    CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE = 1
  ! Values of fields%adhesion
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_ADHESION_EXTERIOR = 0, CONTACT_NORMAL_ADHESION_STICK = 1, &
    CONTACT_NORMAL_ADHESION_SLIP = 2
  ! contact_normal_set_log
  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_LOG_OFF = 0, CONTACT_NORMAL_LOG_WARNING = 1, &
    CONTACT_NORMAL_LOG_INFO = 2

  ! Own influence coefficients; filled by contact_normal_set_influence. Since 0.1.
  type, bind(C), public :: contact_normal_influence
    integer(c_int64_t) :: struct_size = 0      ! 0 until _init: such a structure is refused, not misread
    integer(c_int32_t) :: cx = 0, cy = 0
    type(c_ptr) :: coefficients = c_null_ptr
    real(c_double) :: scale = 1
  end type

  ! A thin compliant layer; filled by contact_normal_set_layer. Since 0.1.
  type, bind(C), public :: contact_normal_layer
    integer(c_int64_t) :: struct_size = 0
    real(c_double) :: compliance = 0
    type(c_ptr) :: compliances = c_null_ptr
  end type

  ! A limit of the pressures; filled by contact_normal_set_pressure_limit. Since 0.1.
  type, bind(C), public :: contact_normal_pressure_limit
    integer(c_int64_t) :: struct_size = 0
    real(c_double) :: limit = 0
    type(c_ptr) :: limits = c_null_ptr
  end type

  ! Directions in which the scene repeats itself; filled by contact_normal_set_period. Since 0.1.
  type, bind(C), public :: contact_normal_period
    integer(c_int64_t) :: struct_size = 0
    integer(c_int32_t) :: x = 0, y = 0
  end type

  ! Patches whose interaction is scaled; filled by contact_normal_set_patches. Since 0.1.
  type, bind(C), public :: contact_normal_patches
    integer(c_int64_t) :: struct_size = 0
    integer(c_int32_t) :: count = 0, reserved = 0
    type(c_ptr) :: patch = c_null_ptr, factors = c_null_ptr
  end type

  ! A coating of one body; filled by contact_normal_set_coating. Since 0.2.
  type, bind(C), public :: contact_normal_coating
    integer(c_int64_t) :: struct_size = 0
    real(c_double) :: thickness = 0
    real(c_double) :: shear_modulus = 0
    real(c_double) :: poisson_ratio = 0
  end type

  ! Own coefficients, one table per loaded row; filled by contact_normal_set_row_tables. Since 0.1.
  type, bind(C), public :: contact_normal_row_tables
    integer(c_int64_t) :: struct_size = 0
    integer(c_int32_t) :: cx = 0, rows = 0
    type(c_ptr) :: coefficients = c_null_ptr
    real(c_double) :: scale = 1
  end type

  ! Friction; filled by contact_normal_set_friction. Since 0.2.
  type, bind(C), public :: contact_normal_friction
    integer(c_int64_t) :: struct_size = 0
    real(c_double) :: coefficient = 0
    type(c_ptr) :: coefficients = c_null_ptr
    integer(c_int32_t) :: motion = CONTACT_NORMAL_MOTION_SHIFT
    integer(c_int32_t) :: continues = 0
    integer(c_int32_t) :: prescribed(2) = CONTACT_NORMAL_PRESCRIBED_CREEPAGE
    real(c_double) :: creepage(2) = 0
    real(c_double) :: spin = 0
    real(c_double) :: spin_centre(2) = 0
    real(c_double) :: force(2) = 0
    real(c_double) :: rolling_distance = 0
    real(c_double) :: rolling_direction = 0
    real(c_double) :: spin_offset = 0
    type(c_ptr) :: previous_traction(2) = c_null_ptr
    type(c_ptr) :: rigid_slip(2) = c_null_ptr
    type(c_ptr) :: influence(3) = c_null_ptr
    integer(c_int32_t) :: influence_cx = 0, influence_cy = 0
    real(c_double) :: influence_scale = 0
    integer(c_int32_t) :: sensitivities = 0
    integer(c_int32_t) :: reserved = 0
    type(c_ptr) :: influence_cross(2) = c_null_ptr
  end type

  ! What is simulated. Since 0.1.
  type, bind(C), public :: contact_normal_scene
    integer(c_int64_t) :: struct_size = 0
    integer(c_int32_t) :: mx = 0, my = 0
    real(c_double) :: dx = 0, dy = 0
    type(c_ptr) :: undeformed_distance = c_null_ptr       ! contact_normal_set_undeformed_distance
    real(c_double) :: shear_modulus(2) = 0
    real(c_double) :: poisson_ratio(2) = 0
    integer(c_int32_t) :: load = CONTACT_NORMAL_PRESCRIBED_APPROACH
    integer(c_int32_t) :: reserved = 0
    real(c_double) :: approach = 0, force = 0
    type(c_ptr) :: influence = c_null_ptr                 ! contact_normal_set_influence
    type(c_ptr) :: layer = c_null_ptr                     ! contact_normal_set_layer
    type(c_ptr) :: pressure_limit = c_null_ptr            ! contact_normal_set_pressure_limit
    type(c_ptr) :: period = c_null_ptr                    ! contact_normal_set_period
    type(c_ptr) :: patches = c_null_ptr                   ! contact_normal_set_patches
    type(c_ptr) :: row_tables = c_null_ptr                ! contact_normal_set_row_tables
    type(c_ptr) :: coating(2) = c_null_ptr                ! contact_normal_set_coating
    type(c_ptr) :: friction = c_null_ptr                  ! contact_normal_set_friction
  end type

  ! How it is solved. Since 0.1.
  type, bind(C), public :: contact_normal_options
    integer(c_int64_t) :: struct_size = 0
    integer(c_int32_t) :: method = CONTACT_NORMAL_METHOD_AUTO
    integer(c_int32_t) :: smoother = CONTACT_NORMAL_SMOOTHER_AUTO
    integer(c_int32_t) :: pre_sweeps = 0
    integer(c_int32_t) :: post_sweeps = 0
    real(c_double) :: relaxation = 0
    integer(c_int32_t) :: coarsest = 0
    integer(c_int32_t) :: active_set = CONTACT_NORMAL_ACTIVE_SET_FREE
    integer(c_int32_t) :: initial_guess = CONTACT_NORMAL_INITIAL_GUESS_NONE
    integer(c_int32_t) :: criterion = CONTACT_NORMAL_CRITERION_RESIDUAL
    real(c_double) :: tolerance = 0
    real(c_double) :: error_ratio = 0
    integer(c_int32_t) :: max_cycles = 0
    integer(c_int32_t) :: threads = 0
    integer(c_int32_t) :: precision = CONTACT_NORMAL_PRECISION_AUTO
    integer(c_int32_t) :: reserved = 0
    type(c_funptr) :: progress = c_null_funptr            ! contact_normal_set_progress
    type(c_ptr) :: user = c_null_ptr                      ! anything; passed to the progress callback
  end type

  ! What the progress callback is told. Since 0.1.
  type, bind(C), public :: contact_normal_progress
    integer(c_int64_t) :: struct_size = 0
    integer(c_int32_t) :: mx = 0
    integer(c_int32_t) :: my = 0
    integer(c_int64_t) :: cycles = 0
    integer(c_int64_t) :: active_set_changes = 0
    real(c_double) :: seconds = 0
    real(c_double) :: work_units = 0
    real(c_double) :: update = 0
    real(c_double) :: residual = 0
  end type

  ! The caller's arrays; attached by contact_normal_set_fields. Since 0.1.
  type, bind(C), public :: contact_normal_fields
    integer(c_int64_t) :: struct_size = 0
    type(c_ptr) :: pressure = c_null_ptr
    type(c_ptr) :: deformed_distance = c_null_ptr
    type(c_ptr) :: displacement = c_null_ptr
    type(c_ptr) :: contact = c_null_ptr
    type(c_ptr) :: traction(2) = c_null_ptr
    type(c_ptr) :: slip(2) = c_null_ptr
    type(c_ptr) :: adhesion = c_null_ptr
  end type

  ! One row of the ledger. Since 0.1.
  type, bind(C), public :: contact_normal_ledger_row
    integer(c_int32_t) :: mx = 0
    integer(c_int32_t) :: my = 0
    integer(c_int64_t) :: cycles = 0
    real(c_double) :: seconds = 0
    real(c_double) :: work_units = 0
    real(c_double) :: residual = 0
    real(c_double) :: approach = 0
    real(c_double) :: force = 0
    real(c_double) :: max_pressure = 0
    real(c_double) :: contact_area = 0
    real(c_double) :: corrected_area = 0
    real(c_double) :: error_force = 0
    real(c_double) :: error_max_pressure = 0
    real(c_double) :: error_contact_area = 0
    real(c_double) :: error_corrected_area = 0
    real(c_double) :: error_pressure = 0
    integer(c_int64_t) :: contact_count = 0
    integer(c_int32_t) :: untrusted = 0                   ! CONTACT_NORMAL_UNTRUSTED_... bits
    integer(c_int32_t) :: reserved = 0
  end type

  ! What a solve found and what it cost. Since 0.1.
  type, bind(C), public :: contact_normal_report
    integer(c_int64_t) :: struct_size = 0
    integer(c_int64_t) :: cycles = 0
    integer(c_int64_t) :: active_set_steps = 0
    integer(c_int64_t) :: active_set_changes = 0
    integer(c_int64_t) :: matrix_products = 0
    real(c_double) :: work_units = 0
    real(c_double) :: update = 0
    real(c_double) :: residual = 0
    real(c_double) :: violation = 0
    real(c_double) :: complementarity = 0
    real(c_double) :: min_pressure = 0
    real(c_double) :: approach = 0
    real(c_double) :: force = 0
    real(c_double) :: max_pressure = 0
    real(c_double) :: contact_area = 0
    integer(c_int64_t) :: contact_count = 0
    real(c_double) :: error_force = 0
    real(c_double) :: error_max_pressure = 0
    real(c_double) :: error_contact_area = 0
    real(c_double) :: setup_seconds = 0
    real(c_double) :: solve_seconds = 0
    integer(c_int64_t) :: bytes = 0
    integer(c_int64_t) :: ledger_rows = 0
    integer(c_int64_t) :: ledger_capacity = 0
    type(c_ptr) :: ledger = c_null_ptr                    ! contact_normal_set_ledger
    real(c_double) :: corrected_area = -1
    real(c_double) :: error_corrected_area = -1
    real(c_double) :: error_pressure = -1
    integer(c_int32_t) :: untrusted = 0                   ! CONTACT_NORMAL_UNTRUSTED_... bits
    integer(c_int32_t) :: limited_by = 0                  ! CONTACT_NORMAL_LIMITED_BY_...
    real(c_double) :: halved_seconds = -1
    real(c_double) :: halved_error_force = -1
    integer(c_int64_t) :: edge_count = 0
    real(c_double) :: tolerance = 0
    real(c_double) :: tangential_force(2) = 0             ! with friction, as are the following
    real(c_double) :: tangential_moment = 0
    real(c_double) :: creepage(2) = 0
    real(c_double) :: tangential_residual = 0
    real(c_double) :: tangential_gap = 0
    integer(c_int64_t) :: stick_count = 0
    integer(c_int64_t) :: slip_count = 0
    real(c_double) :: tangential_products = 0
    real(c_double) :: tangential_seconds = 0
    real(c_double) :: sensitivities(9) = 0
    real(c_double) :: error_tangential(2) = -1
  end type

  ! The accuracy that is asked for, what it may cost, and the grid that it took. Since 0.1.
  type, bind(C), public :: contact_normal_accuracy
    integer(c_int64_t) :: struct_size = 0
    real(c_double) :: target = 0
    real(c_double) :: max_seconds = 0
    integer(c_int64_t) :: max_bytes = 0
    integer(c_int64_t) :: max_elements = 0
    type(c_funptr) :: surface = c_null_funptr             ! contact_normal_set_surface
    type(c_ptr) :: user = c_null_ptr                      ! anything; passed to the surface callback
    integer(c_int32_t) :: mx = 0
    integer(c_int32_t) :: my = 0
    real(c_double) :: dx = 0
    real(c_double) :: dy = 0
    real(c_double) :: reached = -1
    real(c_double) :: seconds = 0
    real(c_double) :: max_pressure_target = 0
    real(c_double) :: contact_area_target = 0
  end type

  ! One row of the price list: what one accuracy costs, predicted. Since 0.2.
  type, bind(C), public :: contact_normal_price
    real(c_double) :: target = 0
    real(c_double) :: error = -1
    real(c_double) :: tolerance = 0
    real(c_double) :: seconds = -1
    real(c_double) :: seconds_one_thread = -1
    integer(c_int64_t) :: bytes = 0
    integer(c_int32_t) :: mx = 0
    integer(c_int32_t) :: my = 0
    real(c_double) :: dx = 0
    real(c_double) :: dy = 0
    integer(c_int32_t) :: obstacle = 0                    ! CONTACT_NORMAL_OBSTACLE_...
    integer(c_int32_t) :: reserved = 0
  end type

  ! The exact Hertz solution. Since 0.1.
  type, bind(C), public :: contact_normal_hertz_solution
    real(c_double) :: semi_axis_x = 0
    real(c_double) :: semi_axis_y = 0
    real(c_double) :: max_pressure = 0
    real(c_double) :: approach = 0
    real(c_double) :: force = 0
    real(c_double) :: area = 0
  end type

  ! The largest value of a field of stresses, and where it is: its depth counted from 0, as the element (ix, iy) is. Since 0.2.
  type, bind(C), public :: contact_normal_stress_maximum
    real(c_double) :: value = 0
    real(c_double) :: x = 0
    real(c_double) :: y = 0
    real(c_double) :: z = 0
    integer(c_int32_t) :: ix = 0
    integer(c_int32_t) :: iy = 0
    integer(c_int32_t) :: depth = 0
    integer(c_int32_t) :: reserved = 0
  end type

  ! What is wanted of subsurface stresses: see contact_normal_set_stress_outputs. Since 0.2.
  type, bind(C), public :: contact_normal_stress_outputs
    integer(c_int64_t) :: struct_size = 0
    type(c_ptr) :: stress(6) = c_null_ptr
    type(c_ptr) :: von_mises = c_null_ptr
    type(c_ptr) :: maximum_shear = c_null_ptr
    type(c_ptr) :: principal(3) = c_null_ptr
    type(c_ptr) :: directions(3) = c_null_ptr
    type(c_ptr) :: largest_von_mises = c_null_ptr
    type(c_ptr) :: largest_shear = c_null_ptr
  end type

  ! Where the results of contact_normal_friction_batch go: see contact_normal_set_friction_results. Since 0.2.
  type, bind(C), public :: contact_normal_friction_results
    integer(c_int64_t) :: struct_size = 0
    type(c_ptr) :: force = c_null_ptr
    type(c_ptr) :: moment = c_null_ptr
    type(c_ptr) :: creepage = c_null_ptr
    type(c_ptr) :: residual = c_null_ptr
    type(c_ptr) :: gap = c_null_ptr
    type(c_ptr) :: products = c_null_ptr
    type(c_ptr) :: stick_count = c_null_ptr
    type(c_ptr) :: slip_count = c_null_ptr
    type(c_ptr) :: status = c_null_ptr
    type(c_ptr) :: traction = c_null_ptr
    type(c_ptr) :: slip = c_null_ptr
    type(c_ptr) :: adhesion = c_null_ptr
  end type

  ! Operators and workspace for many solves. Copies share what they stand for: free one of them. Since 0.1.
  type, public :: contact_normal_solver
    private
    type(c_ptr) :: handle = c_null_ptr
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
    contact_normal_cost_of_accuracy, contact_normal_solve_to_accuracy, contact_normal_solver_fields, contact_normal_solver_new, &
    contact_normal_solver_solve, contact_normal_solver_solve_batch, contact_normal_solver_set_influence, &
    contact_normal_solver_free, norm_solve, tang_solve, &
    contact_normal_set_layer, contact_normal_set_pressure_limit, contact_normal_set_period, contact_normal_set_patches, &
    contact_normal_set_row_tables, contact_normal_set_coating, contact_normal_set_friction, &
    contact_normal_set_friction_fields, contact_normal_set_friction_results, contact_normal_set_tangential_influence

  procedure(contact_normal_log_callback), pointer, save :: log_target => null()

contains

  include 'contact_normal_procedures.inc'

  include 'contact_normal_norm_solve.inc'

  include 'contact_normal_tang_solve.inc'

end module contact_normal

! norm_solve for programs that do not use the module, Fortran 77 included: the same arguments, INTEGER and
! DOUBLE PRECISION (not with -fdefault-integer-8). Since 0.1.
subroutine norm_solve(mx, my, dx, dy, cx, cy, cf, hs, norm, pen, fn, igs, ps, eps, maxit, itcg, err, ierror)
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
subroutine tang_solve(mx, my, dx, dy, gg, poiss, ps, mus, motion, force, cksi, ceta, cphi, fx, fy, dq, chi, px, py, igs, &
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
