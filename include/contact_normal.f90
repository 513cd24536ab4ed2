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
!   * norm_solve, at the end, is one call with plain arrays that needs none of this; it is there as a module procedure
!     and, for programs that do not use the module, as an external subroutine.
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
    contact_normal_set_friction_fields

  procedure(contact_normal_log_callback), pointer, save :: log_target => null()

contains

  function fortran_string(text) result(string)
    type(c_ptr), intent(in) :: text
    character(:), allocatable :: string
    character(kind=c_char), pointer :: letters(:)
    integer :: i
    call c_f_pointer(text, letters, [c_strlen(text)])
    allocate (character(size(letters)) :: string)
    do i = 1, size(letters)
      string(i:i) = letters(i)
    end do
  end function

  ! A short text for a status. Since 0.1.
  function contact_normal_status_text(status) result(text)
    integer(c_int32_t), intent(in) :: status
    character(:), allocatable :: text
    text = fortran_string(c_status_text(status))
  end function

  ! The message of the last call on this thread that did not return OK, or "". Since 0.1.
  function contact_normal_last_error_message() result(message)
    character(:), allocatable :: message
    message = fortran_string(c_last_error())
  end function

  ! The version of the library, as "0.2.0". Since 0.1.
  function contact_normal_version_string() result(version)
    character(:), allocatable :: version
    version = fortran_string(c_version())
  end function

  ! Attaches h(mx, my). Since 0.1.
  subroutine contact_normal_set_undeformed_distance(scene, h)
    type(contact_normal_scene), intent(inout) :: scene
    real(c_double), pointer, contiguous, intent(in) :: h(..)
    scene%undeformed_distance = c_loc(h)
  end subroutine

  ! The scene uses own coefficients(-cx:cx-1, -cy:cy-1) instead of the half-space, times `scale` (1 if it is not given);
  ! `influence` keeps what is said about them. Since 0.1.
  subroutine contact_normal_set_influence(scene, influence, cx, cy, coefficients, scale)
    type(contact_normal_scene), intent(inout) :: scene
    type(contact_normal_influence), pointer, intent(in) :: influence
    integer(c_int32_t), intent(in) :: cx, cy
    real(c_double), pointer, contiguous, intent(in) :: coefficients(..)
    real(c_double), intent(in), optional :: scale
    call contact_normal_influence_init(influence)
    if (present(scale)) influence%scale = scale
    influence%cx = cx
    influence%cy = cy
    influence%coefficients = c_loc(coefficients)
    scene%influence = c_loc(influence)
  end subroutine

  ! The scene has a layer of one compliance, or of one per element (mx, my); `layer` keeps what is said about it. Since 0.1.
  subroutine contact_normal_set_layer(scene, layer, compliance, compliances)
    type(contact_normal_scene), intent(inout) :: scene
    type(contact_normal_layer), pointer, intent(in) :: layer
    real(c_double), intent(in), optional :: compliance
    real(c_double), pointer, contiguous, intent(in), optional :: compliances(..)
    call contact_normal_layer_init(layer)
    if (present(compliance)) layer%compliance = compliance
    if (present(compliances)) layer%compliances = c_loc(compliances)
    scene%layer = c_loc(layer)
  end subroutine

  ! Pressures have one limit, or one per element (mx, my). Since 0.1.
  subroutine contact_normal_set_pressure_limit(scene, pressure_limit, limit, limits)
    type(contact_normal_scene), intent(inout) :: scene
    type(contact_normal_pressure_limit), pointer, intent(in) :: pressure_limit
    real(c_double), intent(in), optional :: limit
    real(c_double), pointer, contiguous, intent(in), optional :: limits(..)
    call contact_normal_pressure_limit_init(pressure_limit)
    if (present(limit)) pressure_limit%limit = limit
    if (present(limits)) pressure_limit%limits = c_loc(limits)
    scene%pressure_limit = c_loc(pressure_limit)
  end subroutine

  ! The scene repeats itself in x, in y or in both. Since 0.1.
  subroutine contact_normal_set_period(scene, period, x, y)
    type(contact_normal_scene), intent(inout) :: scene
    type(contact_normal_period), pointer, intent(in) :: period
    logical, intent(in) :: x, y
    call contact_normal_period_init(period)
    period%x = merge(1_c_int32_t, 0_c_int32_t, x)
    period%y = merge(1_c_int32_t, 0_c_int32_t, y)
    scene%period = c_loc(period)
  end subroutine

  ! patch(mx, my), from 0 on, is the patch of each element; factors(n, n) scale the influence of one on another. Since 0.1.
  subroutine contact_normal_set_patches(scene, patches, patch, factors)
    type(contact_normal_scene), intent(inout) :: scene
    type(contact_normal_patches), pointer, intent(in) :: patches
    integer(c_int32_t), pointer, contiguous, intent(in) :: patch(..)
    real(c_double), pointer, contiguous, intent(in) :: factors(:, :)
    call contact_normal_patches_init(patches)
    patches%count = size(factors, 1, kind=c_int32_t)
    patches%patch = c_loc(patch)
    patches%factors = c_loc(factors)
    scene%patches = c_loc(patches)
  end subroutine

  ! The scene uses own coefficients(-cx:cx-1, my, my), of offset, row and loaded row, instead of the half-space, times
  ! `scale` (1 if it is not given). Since 0.1.
  subroutine contact_normal_set_row_tables(scene, row_tables, cx, coefficients, scale)
    type(contact_normal_scene), intent(inout) :: scene
    type(contact_normal_row_tables), pointer, intent(in) :: row_tables
    integer(c_int32_t), intent(in) :: cx
    real(c_double), pointer, contiguous, intent(in) :: coefficients(:, :, :)
    real(c_double), intent(in), optional :: scale
    call contact_normal_row_tables_init(row_tables)
    if (present(scale)) row_tables%scale = scale
    row_tables%cx = cx
    row_tables%rows = size(coefficients, 3, kind=c_int32_t)
    row_tables%coefficients = c_loc(coefficients)
    scene%row_tables = c_loc(row_tables)
  end subroutine

  ! Body 1 or 2 has a coating; the elastic constants of the scene are those of the body below. Since 0.2.
  subroutine contact_normal_set_coating(scene, body, coating, thickness, shear_modulus, poisson_ratio)
    type(contact_normal_scene), intent(inout) :: scene
    integer, intent(in) :: body
    type(contact_normal_coating), pointer, intent(in) :: coating
    real(c_double), intent(in) :: thickness, shear_modulus, poisson_ratio
    call contact_normal_coating_init(coating)
    coating%thickness = thickness
    coating%shear_modulus = shear_modulus
    coating%poisson_ratio = poisson_ratio
    scene%coating(body) = c_loc(coating)
  end subroutine

  ! The scene has friction of one coefficient, or of one per element (mx, my), a shift of 0: set the other components of `friction`
  ! after this. `previous_x` and `previous_y`: the tractions before; `slip_x` and `slip_y`: a rigid slip. Since 0.2.
  subroutine contact_normal_set_friction(scene, friction, coefficient, coefficients, previous_x, previous_y, slip_x, slip_y)
    type(contact_normal_scene), intent(inout) :: scene
    type(contact_normal_friction), pointer, intent(in) :: friction
    real(c_double), intent(in), optional :: coefficient
    real(c_double), pointer, contiguous, intent(in), optional :: coefficients(..)
    real(c_double), pointer, contiguous, intent(in), optional :: previous_x(..), previous_y(..), slip_x(..), slip_y(..)
    call contact_normal_friction_init(friction)
    if (present(coefficient)) friction%coefficient = coefficient
    if (present(coefficients)) friction%coefficients = c_loc(coefficients)
    if (present(previous_x)) friction%previous_traction(1) = c_loc(previous_x)
    if (present(previous_y)) friction%previous_traction(2) = c_loc(previous_y)
    if (present(slip_x)) friction%rigid_slip(1) = c_loc(slip_x)
    if (present(slip_y)) friction%rigid_slip(2) = c_loc(slip_y)
    scene%friction = c_loc(friction)
  end subroutine

  ! Attaches the arrays of friction that are wanted, (mx, my) each. Since 0.2.
  subroutine contact_normal_set_friction_fields(fields, traction_x, traction_y, slip_x, slip_y, adhesion)
    type(contact_normal_fields), intent(inout) :: fields
    real(c_double), pointer, contiguous, intent(in), optional :: traction_x(..), traction_y(..), slip_x(..), slip_y(..)
    integer(c_int32_t), pointer, contiguous, intent(in), optional :: adhesion(..)
    if (present(traction_x)) fields%traction(1) = c_loc(traction_x)
    if (present(traction_y)) fields%traction(2) = c_loc(traction_y)
    if (present(slip_x)) fields%slip(1) = c_loc(slip_x)
    if (present(slip_y)) fields%slip(2) = c_loc(slip_y)
    if (present(adhesion)) fields%adhesion = c_loc(adhesion)
  end subroutine

  ! Attaches the arrays that are wanted, (mx, my) each; those not given stay as they are. Since 0.1.
  subroutine contact_normal_set_fields(fields, pressure, contact, displacement, deformed_distance)
    type(contact_normal_fields), intent(inout) :: fields
    real(c_double), pointer, contiguous, intent(in), optional :: pressure(..), displacement(..), deformed_distance(..)
    integer(c_int32_t), pointer, contiguous, intent(in), optional :: contact(..)
    if (present(pressure)) fields%pressure = c_loc(pressure)
    if (present(contact)) fields%contact = c_loc(contact)
    if (present(displacement)) fields%displacement = c_loc(displacement)
    if (present(deformed_distance)) fields%deformed_distance = c_loc(deformed_distance)
  end subroutine

  ! Attaches what is wanted at n depths: stress(mx, my, n, 6) with the components xx, yy, zz, xy, xz, yz, von_mises and maximum_shear
  ! (mx, my, n), principal(mx, my, n, 3), directions(3, mx, my, n, 3), and the largest values. What is not given is not computed.
  ! `outputs` must be initialised. Since 0.2.
  subroutine contact_normal_set_stress_outputs(outputs, stress, von_mises, maximum_shear, principal, directions, &
      largest_von_mises, largest_shear)
    type(contact_normal_stress_outputs), intent(inout) :: outputs
    real(c_double), pointer, contiguous, intent(in), optional :: stress(:, :, :, :), von_mises(:, :, :), maximum_shear(:, :, :)
    real(c_double), pointer, contiguous, intent(in), optional :: principal(:, :, :, :), directions(:, :, :, :, :)
    type(contact_normal_stress_maximum), pointer, intent(in), optional :: largest_von_mises, largest_shear
    integer :: k
    if (present(stress)) then
      do k = 1, 6
        outputs%stress(k) = c_loc(stress(1, 1, 1, k))
      end do
    end if
    if (present(von_mises)) outputs%von_mises = c_loc(von_mises)
    if (present(maximum_shear)) outputs%maximum_shear = c_loc(maximum_shear)
    if (present(principal)) then
      do k = 1, 3
        outputs%principal(k) = c_loc(principal(1, 1, 1, k))
      end do
    end if
    if (present(directions)) then
      do k = 1, 3
        outputs%directions(k) = c_loc(directions(1, 1, 1, 1, k))
      end do
    end if
    if (present(largest_von_mises)) outputs%largest_von_mises = c_loc(largest_von_mises)
    if (present(largest_shear)) outputs%largest_shear = c_loc(largest_shear)
  end subroutine

  ! Attaches room for the ledger. Since 0.1.
  subroutine contact_normal_set_ledger(report, ledger)
    type(contact_normal_report), intent(inout) :: report
    type(contact_normal_ledger_row), pointer, contiguous, intent(in) :: ledger(:)
    report%ledger = c_loc(ledger)
    report%ledger_capacity = size(ledger, kind=c_int64_t)
  end subroutine

  ! Sets the progress callback; without one: none. Since 0.1.
  subroutine contact_normal_set_progress(options, callback)
    type(contact_normal_options), intent(inout) :: options
    procedure(contact_normal_progress_callback), optional :: callback
    options%progress = c_null_funptr
    if (present(callback)) options%progress = c_funloc(callback)
  end subroutine

  ! Sets where the undeformed distance of each grid comes from; without a callback: the scene's is refined. Since 0.1.
  subroutine contact_normal_set_surface(accuracy, callback)
    type(contact_normal_accuracy), intent(inout) :: accuracy
    procedure(contact_normal_surface_callback), optional :: callback
    accuracy%surface = c_null_funptr
    if (present(callback)) accuracy%surface = c_funloc(callback)
  end subroutine

  ! Sends log messages up to `level` to `callback`; without one: none. For the whole process; call it while no other
  ! thread is inside the library. Since 0.1.
  function contact_normal_set_log(callback, level) result(status)
    procedure(contact_normal_log_callback), optional :: callback
    integer(c_int32_t), intent(in) :: level
    integer(c_int32_t) :: status
    if (present(callback)) then
      log_target => callback
      status = c_set_log(c_funloc(forward_log), level, c_null_ptr)
    else
      status = c_set_log(c_null_funptr, level, c_null_ptr)
    end if
  end function

  subroutine forward_log(level, message, user) bind(C)
    integer(c_int32_t), value, intent(in) :: level
    type(c_ptr), value, intent(in) :: message, user
    if (c_associated(user)) return     ! never: set_log passes none
    call log_target(level, fortran_string(message))
  end subroutine

  ! Sets up a solver for the grid, bodies and coefficients of `scene`. `solver` must not hold one already. Since 0.1.
  function contact_normal_solver_new(scene, options, solver) result(status)
    type(contact_normal_scene), intent(in) :: scene
    type(contact_normal_options), intent(in), optional :: options
    type(contact_normal_solver), intent(inout) :: solver
    integer(c_int32_t) :: status
    status = c_solver_new(scene, options, solver%handle)
  end function

  ! All later solves with it use these coefficients: what contact_normal_set_influence has filled. Only for a solver that was
  ! set up with coefficients of its own. Since 0.2.
  function contact_normal_solver_set_influence(solver, influence) result(status)
    type(contact_normal_solver), intent(in) :: solver
    type(contact_normal_influence), intent(in) :: influence
    integer(c_int32_t) :: status
    status = c_solver_set_influence(solver%handle, influence)
  end function

  ! Solves with it. Since 0.1.
  function contact_normal_solver_solve(solver, scene, options, fields, report) result(status)
    type(contact_normal_solver), intent(in) :: solver
    type(contact_normal_scene), intent(in) :: scene
    type(contact_normal_options), intent(in), optional :: options
    type(contact_normal_fields), intent(inout), optional :: fields
    type(contact_normal_report), intent(inout), optional :: report
    integer(c_int32_t) :: status
    status = c_solver_solve(solver%handle, scene, options, fields, report)
  end function

  ! Solves one problem for each of the scenes, as many at a time as the solver was set up with threads. A problem that is
  ! refused does not keep the others from being solved; the result is the status of the first that was refused (< 0), or
  ! else of the first that stopped early, or else OK. The message names it, counted from 0. Since 0.1.
  function contact_normal_solver_solve_batch(solver, scenes, options, fields, reports, statuses) result(status)
    type(contact_normal_solver), intent(in) :: solver
    type(contact_normal_scene), intent(in) :: scenes(:)
    type(contact_normal_options), intent(in), optional :: options
    type(contact_normal_fields), intent(inout), optional :: fields(size(scenes))
    type(contact_normal_report), intent(inout), optional :: reports(size(scenes))
    integer(c_int32_t), intent(inout), optional :: statuses(size(scenes))
    integer(c_int32_t) :: status
    status = c_solver_solve_batch(solver%handle, size(scenes, kind=c_int32_t), scenes, options, fields, reports, statuses)
  end function

  ! Predicts what each relative error of `targets` costs: rows(i) is that of targets(i). `quantity`: CONTACT_NORMAL_QUANTITY_...,
  ! by default the force or the approach. Of `accuracy` limits and surface are read. Since 0.2.
  function contact_normal_cost_of_accuracy(scene, targets, rows, quantity, options, accuracy) result(status)
    type(contact_normal_scene), intent(in) :: scene
    real(c_double), intent(in) :: targets(:)
    type(contact_normal_price), intent(inout) :: rows(:)
    integer(c_int32_t), intent(in), optional :: quantity
    type(contact_normal_options), intent(in), optional :: options
    type(contact_normal_accuracy), intent(in), optional :: accuracy
    type(contact_normal_price) :: list(size(targets))
    real(c_double) :: wanted(size(targets))
    integer(c_int32_t) :: status, what
    what = CONTACT_NORMAL_QUANTITY_FORCE
    if (present(quantity)) what = quantity
    wanted = targets
    status = c_cost_of_accuracy(scene, options, accuracy, what, min(size(targets), size(rows)), wanted, list)
    if (status >= 0) rows(:min(size(targets), size(rows))) = list(:min(size(targets), size(rows)))
  end function

  ! Solves on finer and finer grids until accuracy%target is met; accuracy%mx, my, dx, dy are the grid that was used. `solver`
  ! must not hold one already; it gets the result, for contact_normal_solver_fields. Since 0.1.
  function contact_normal_solve_to_accuracy(scene, options, accuracy, solver, report) result(status)
    type(contact_normal_scene), intent(in) :: scene
    type(contact_normal_options), intent(in), optional :: options
    type(contact_normal_accuracy), intent(inout) :: accuracy
    type(contact_normal_solver), intent(inout), optional :: solver
    type(contact_normal_report), intent(inout), optional :: report
    integer(c_int32_t) :: status
    if (present(solver)) then
      status = c_solve_to_accuracy(scene, options, accuracy, solver%handle, report)
    else
      status = c_solve_to_accuracy(scene, options, accuracy, report=report)
    end if
  end function

  ! Copies the last result of a solver. Since 0.1.
  function contact_normal_solver_fields(solver, fields) result(status)
    type(contact_normal_solver), intent(in) :: solver
    type(contact_normal_fields), intent(inout) :: fields
    integer(c_int32_t) :: status
    status = c_solver_fields(solver%handle, fields)
  end function

  ! Frees it; doing so twice is harmless. Since 0.1.
  subroutine contact_normal_solver_free(solver)
    type(contact_normal_solver), intent(inout) :: solver
    call c_solver_free(solver%handle)
    solver%handle = c_null_ptr
  end subroutine

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
