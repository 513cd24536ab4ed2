! Calls and wrappers of the module that no example uses: the solver handle, callbacks, messages, the ledger, own coefficients, optional arguments.
module callbacks
  use, intrinsic :: iso_c_binding
  use contact_normal
  implicit none
  integer :: messages = 0
contains
  function cancel_at_once(progress, user) bind(C) result(cancel)
    type(contact_normal_progress), intent(in) :: progress
    type(c_ptr), value :: user
    integer(c_int32_t) :: cancel
    integer(c_int32_t), pointer :: calls
    call c_f_pointer(user, calls)
    calls = calls + 1
    cancel = merge(1, 0, progress%mx > 0 .and. progress%cycles > 0)
  end function
  function cancelling_surface(mx, my, dx, dy, h, user) bind(C) result(cancel)
    integer(c_int32_t), value :: mx, my
    real(c_double), value :: dx, dy
    real(c_double), intent(inout) :: h(mx, my)
    type(c_ptr), value :: user
    integer(c_int32_t) :: cancel
    integer(c_int32_t), pointer :: calls
    call c_f_pointer(user, calls)
    calls = calls + 1
    h = dx*dy
    cancel = 1
  end function
  subroutine count_messages(level, message)
    integer(c_int32_t), intent(in) :: level
    character(*), intent(in) :: message
    if (level > 0 .and. len(message) > 0) messages = messages + 1
  end subroutine
end module callbacks

program fortran_module
  use callbacks
  implicit none
  integer, parameter :: dp = c_double
  integer(c_int32_t), parameter :: M = 24
  type(contact_normal_scene) :: scene
  type(contact_normal_influence), target :: influence
  type(contact_normal_options) :: options
  type(contact_normal_cycle), target :: cycle
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  type(contact_normal_ledger_row), target :: ledger(8)
  type(contact_normal_solver) :: solver
  type(contact_normal_accuracy) :: accuracy
  type(contact_normal_price) :: prices(2)
  type(contact_normal_solver_info) :: info
  integer(c_int64_t) :: kept
  integer(c_int32_t) :: status
  type(contact_normal_fields) :: none_wanted
  real(dp), target :: h(M, M), p(M, M), u(M, M), e(M*M), cf(-M:M - 1, -M:M - 1)
  real(dp) :: half_space(M, M)
  integer(c_int32_t), target :: contact(M, M), calls
  integer, parameter :: COUNT_OF_BATCH = 5
  type(contact_normal_scene) :: scenes(COUNT_OF_BATCH)
  type(contact_normal_fields) :: all_fields(COUNT_OF_BATCH)
  type(contact_normal_report) :: reports(COUNT_OF_BATCH)
  real(dp), target :: pressures(M, M, COUNT_OF_BATCH)
  integer(c_int32_t) :: statuses(COUNT_OF_BATCH)
  integer :: i, j

  print '(a)', contact_normal_version_string()
  call hold(contact_normal_library_abi_version() >= CONTACT_NORMAL_ABI_VERSION, "the ABI's version")
  call hold(contact_normal_status_text(CONTACT_NORMAL_CANCELLED) == "cancelled by a callback or by options->stop", "text")

  ! A structure without _init is refused, not misread.
  call hold(contact_normal_solve(scene, fields=fields) == CONTACT_NORMAL_STRUCT_SIZE, "a scene without _init")
  call hold(index(contact_normal_last_error_message(), "contact_normal_scene_init") > 0, "its message")

  call contact_normal_scene_init(scene)
  call contact_normal_options_init(options)
  call contact_normal_fields_init(fields)
  call contact_normal_report_init(report)
  scene%mx = M
  scene%my = M
  scene%dx = 1.0_dp/M
  scene%dy = 1.0_dp/M
  scene%shear_modulus = [1.0_dp, 2.0_dp]
  scene%poisson_ratio = [0.25_dp, 0.3_dp]
  scene%approach = 0.1_dp
  h = reshape([((((i - 12.5_dp)/M)**2 + ((j - 12.5_dp)/M)**2, i=1, M), j=1, M)], [M, M])
  call contact_normal_set_undeformed_distance(scene, h)
  call contact_normal_set_fields(fields, pressure=p, contact=contact, displacement=u, deformed_distance=e)
  call contact_normal_set_ledger(report, ledger)

  ! Without options: the defaults. Then with all arguments.
  call hold(contact_normal_solve(scene, fields=fields) == CONTACT_NORMAL_OK, "a solve without options and report")
  half_space = p
  call hold(contact_normal_solve(scene, options, fields, report) == CONTACT_NORMAL_OK, "a solve with all of them")
  call hold(all(abs(p - half_space) <= 0), "the same pressures")
  call hold(all(abs(reshape(h, [M*M]) - scene%approach + reshape(u, [M*M]) - e) <= 1e-15_dp), "e = h - approach + u")
  call hold(report%normal%contact_count == count(contact > 0), "the count of elements in contact")
  call hold(report%ledger_rows >= 2 .and. ledger(report%ledger_rows)%mx == M .and. ledger(1)%mx < M, "the ledger")

  ! An accuracy from the array; then with a surface that cancels at once.
  call contact_normal_accuracy_init(accuracy)
  accuracy%target = 1e-2_dp
  call hold(contact_normal_solve_to_accuracy(scene, accuracy=accuracy) == CONTACT_NORMAL_OK, "an accuracy")
  call hold(accuracy%mx >= M .and. accuracy%reached >= 0 .and. accuracy%reached <= 1e-2_dp, "is reached")
  call hold(contact_normal_solve_to_accuracy(scene, options, accuracy, solver, report) == CONTACT_NORMAL_OK, "with all")
  call hold(contact_normal_solver_fields(solver, none_wanted) == CONTACT_NORMAL_STRUCT_SIZE, "fields without _init")
  call contact_normal_fields_init(none_wanted)
  call hold(contact_normal_solver_fields(solver, none_wanted) == CONTACT_NORMAL_OK, "no fields wanted")
  call hold(contact_normal_solver_query(solver, info) == CONTACT_NORMAL_OK, "what the solver is")
  call hold(info%mx == accuracy%mx .and. info%has_result == 1 .and. info%bytes > 0, "its grid and its result")
  call products(solver, int(accuracy%mx), int(accuracy%my))
  call contact_normal_solver_free(solver, status)
  call hold(status == CONTACT_NORMAL_OK, "it is freed")
  call by_name()
  call hold(contact_normal_release() == CONTACT_NORMAL_OK, "a release")
  call hold(contact_normal_kept(bytes=kept) == CONTACT_NORMAL_OK, "how much is kept")
  call hold(kept == 0, "nothing is kept")
  call hold(contact_normal_has("friction"), "what the library has")
  call hold(.not. contact_normal_has("magnetism"), "what it has not")
  ! The costs of accuracies: the second is more expensive. The largest pressure has its own costs.
  call hold(contact_normal_cost_of_accuracy(scene, [1e-2_dp, 1e-3_dp], prices) == CONTACT_NORMAL_OK, "a price list")
  call hold(all(prices%obstacle == CONTACT_NORMAL_OBSTACLE_NONE .and. prices%seconds > 0 .and. prices%mx > 0), "its rows")
  call hold(prices(2)%mx >= prices(1)%mx .and. prices(2)%tolerance < prices(1)%tolerance, "in order")
  call hold(contact_normal_cost_of_accuracy(scene, [1e-2_dp], prices, CONTACT_NORMAL_QUANTITY_MAX_PRESSURE, options, &
                                            accuracy) == CONTACT_NORMAL_OK .and. prices(1)%error <= 1e-2_dp, "with all")
  calls = 0
  accuracy%user = c_loc(calls)
  call contact_normal_set_surface(accuracy, cancelling_surface)
  call hold(contact_normal_solve_to_accuracy(scene, options, accuracy, solver) == CONTACT_NORMAL_CANCELLED, "cancelled")
  call hold(calls == 1 .and. accuracy%mx == 0, "one call, no grid")
  call hold(contact_normal_solver_fields(solver, none_wanted) == CONTACT_NORMAL_NULL_POINTER, "no solver")
  call contact_normal_set_surface(accuracy)
  call hold(contact_normal_solve_to_accuracy(scene, options, accuracy) == CONTACT_NORMAL_OK, "no surface any more")

  ! The half-space's own coefficients, as a table.
  call hold(contact_normal_influence_half_space(M, M, scene%dx, scene%dy, scene%shear_modulus, scene%poisson_ratio, &
                                                cf) == CONTACT_NORMAL_OK, "coefficients")
  options%tolerance = 1e-10_dp
  call hold(contact_normal_solve(scene, options, fields) == CONTACT_NORMAL_OK, "the half-space")
  half_space = p
  call contact_normal_set_influence(scene, influence, M, M, cf)
  call hold(contact_normal_solve(scene, options, fields) == CONTACT_NORMAL_OK, "the table")
  ! Residuals of 1e-10, times the condition number of A on 24 x 24 elements, below 100.
  call hold(all(abs(p - half_space) <= 1e-8_dp*maxval(p)), "the same from the table")

  ! A handle for several solves.
  call hold(contact_normal_solver_new(scene, options, solver) == CONTACT_NORMAL_OK, "a solver")
  options%initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS
  do i = 1, 3
    call hold(contact_normal_solver_solve(solver, scene, options, fields, report) == CONTACT_NORMAL_OK, "its solve")
  end do
  call hold(report%statistics%cycles <= 2, "cycles from its own solution")
  call contact_normal_solver_free(solver)
  call contact_normal_solver_free(solver)
  call hold(contact_normal_solver_solve(solver, scene, options, fields) == CONTACT_NORMAL_NULL_POINTER, "a freed one")

  ! A batch on two threads, with one refused problem; then the same problems one by one.
  options%initial_guess = CONTACT_NORMAL_INITIAL_GUESS_NONE
  options%threads = 2
  call hold(contact_normal_solver_new(scene, options, solver) == CONTACT_NORMAL_OK, "a solver of two threads")
  do i = 1, COUNT_OF_BATCH
    scenes(i) = scene
    scenes(i)%approach = 0.02_dp*i
    call contact_normal_fields_init(all_fields(i))
    call contact_normal_set_fields(all_fields(i), pressure=pressures(:, :, i))
    call contact_normal_report_init(reports(i))
  end do
  scenes(3)%load = 7
  pressures = -1
  call hold(contact_normal_solver_solve_batch(solver, scenes, options, all_fields, reports, statuses) &
            == CONTACT_NORMAL_INVALID_ARGUMENT, "the status of the refused problem")
  call hold(index(contact_normal_last_error_message(), "problem 2: load is 7") == 1, "which one it was")
  call hold(all(statuses == [0, 0, CONTACT_NORMAL_INVALID_ARGUMENT, 0, 0]), "all statuses")
  call hold(all(pressures(:, :, 3) <= -1), "no pressures of the refused one")
  do i = 1, COUNT_OF_BATCH
    if (i == 3) cycle
    call hold(contact_normal_solver_solve(solver, scenes(i), options, fields, report) == CONTACT_NORMAL_OK, "one by one")
    call hold(all(abs(p - pressures(:, :, i)) <= 0), "the same pressures as one by one")
    call hold(reports(i)%normal%contact_count == report%normal%contact_count, "the same contact")
  end do
  scenes(3)%load = CONTACT_NORMAL_PRESCRIBED_APPROACH
  call hold(contact_normal_solver_solve_batch(solver, scenes, options) == CONTACT_NORMAL_OK, "a batch for nothing but the status")
  call contact_normal_solver_free(solver)
  options%threads = 1

  ! A callback that cancels, and its user pointer.
  calls = 0
  options%initial_guess = CONTACT_NORMAL_INITIAL_GUESS_NONE
  options%user = c_loc(calls)
  call contact_normal_set_progress(options, cancel_at_once)
  call hold(contact_normal_solve(scene, options, fields) == CONTACT_NORMAL_CANCELLED, "a cancelled solve")
  call hold(calls == 1, "one call")
  call contact_normal_set_progress(options)
  call hold(contact_normal_solve(scene, options, fields) == CONTACT_NORMAL_OK, "no callback any more")

  ! A message: a table that is not symmetric is solved by V-cycles, which diverge with plain Jacobi, so that NORM takes over.
  do i = -M, M - 1
    cf(i, :) = cf(i, :)*(1 + 0.03_dp*i/M)
  end do
  call hold(contact_normal_set_log(count_messages, CONTACT_NORMAL_LOG_INFO) == CONTACT_NORMAL_OK, "a log")
  call contact_normal_set_cycle(options, cycle, smoother=CONTACT_NORMAL_SMOOTHER_JACOBI, relaxation=1.9_dp)
  call hold(contact_normal_solve(scene, options, fields) == CONTACT_NORMAL_OK, "NORM takes over")
  call hold(messages > 0, "a message")
  call hold(contact_normal_set_log(level=CONTACT_NORMAL_LOG_OFF) == CONTACT_NORMAL_OK, "no log any more")
  call table_of_forces()
  print '(a)', "all hold"

contains

  ! The entries of a table equal single solves. A refused entry is named.
  subroutine table_of_forces()
    integer(c_int32_t), parameter :: n = 3
    type(contact_normal_scene) :: ball
    type(contact_normal_friction), target :: friction
    type(contact_normal_friction_results) :: results
    type(contact_normal_report) :: normal, one
    real(dp), target :: distance(M, M), force(2, n), moment(n), traction(M, M, 2, n)
    real(dp) :: entries(3, n)
    integer(c_int32_t), target :: status(n)
    integer :: ix, iy, k
    do iy = 1, M
      do ix = 1, M
        distance(ix, iy) = 1e-4_dp*((ix - 12.5_dp)**2 + (iy - 12.5_dp)**2)
      end do
    end do
    call contact_normal_scene_init(ball)
    call contact_normal_set_undeformed_distance(ball, distance)
    ball%mx = M
    ball%my = M
    ball%dx = 0.1_dp
    ball%dy = 0.1_dp
    ball%shear_modulus = 82000
    ball%poisson_ratio = 0.28_dp
    ball%load = CONTACT_NORMAL_PRESCRIBED_FORCE
    ball%force = 1000
    call contact_normal_set_friction(ball, friction, coefficient=0.3_dp)
    do k = 1, n
      entries(:, k) = [-1e-3_dp*k, 2e-4_dp, 1e-4_dp]
    end do
    call contact_normal_friction_results_init(results)
    call contact_normal_set_friction_results(results, force=force, moment=moment, status=status, traction=traction)
    call contact_normal_report_init(normal)
    call contact_normal_report_init(one)
    call hold(contact_normal_solve_tangential(ball, n=n, entries=entries, results=results, report=normal) == &
      CONTACT_NORMAL_OK, "a table")
    call hold(all(status == CONTACT_NORMAL_OK) .and. abs(normal%normal%force - 1000) < 1e-2_dp, "its statuses and its normal force")
    do k = 1, n
      friction%creepage = entries(1:2, k)
      friction%spin = entries(3, k)
      call hold(contact_normal_solve(ball, report=one) == CONTACT_NORMAL_OK, "an entry alone")
      ! With a residual of 1e-6 the error is some 1e-7 of mu N.
      call hold(all(abs(force(:, k) - one%tangential%force) <= 1e-5_dp*300), "the forces of an entry")
      call hold(abs(moment(k) - one%tangential%moment) <= 1e-5_dp*300, "the moment of an entry")
      call hold(abs(sum(traction(:, :, 1, k))*0.01_dp - force(1, k)) <= 1e-9_dp*300, "the tractions of an entry")
    end do
    friction%prescribed(1) = CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE
    entries(1, 2) = 1e9_dp
    call hold(contact_normal_solve_tangential(ball, n=n, entries=entries, results=results) == CONTACT_NORMAL_INFEASIBLE, &
      "a force that friction does not carry")
    call hold(index(contact_normal_last_error_message(), "entry 1: ") == 1, "the entry is named")
    call hold(all(status == [CONTACT_NORMAL_OK, CONTACT_NORMAL_INFEASIBLE, CONTACT_NORMAL_OK]), "the others are solved")
  end subroutine

  ! A p of the solver's pressures equals its displacements. A larger approach needs a larger force.
  subroutine products(solver, mx, my)
    type(contact_normal_solver), intent(in) :: solver
    integer, intent(in) :: mx, my
    type(contact_normal_fields) :: found
    real(c_double), target, allocatable :: pressure(:, :), displacement(:, :)
    real(c_double), allocatable :: product(:, :)
    real(c_double) :: stiffness, residual
    allocate (pressure(mx, my), displacement(mx, my), product(mx, my))
    call contact_normal_fields_init(found)
    call contact_normal_set_fields(found, pressure=pressure, displacement=displacement)
    call hold(contact_normal_solver_fields(solver, found) == CONTACT_NORMAL_OK, "its pressures")
    call hold(contact_normal_solver_product(solver, pressure, product) == CONTACT_NORMAL_OK, "a product")
    call hold(all(abs(product - displacement) <= 1e-12_c_double*maxval(displacement)), "is that of the result")
    call hold(contact_normal_solver_stiffness(solver, stiffness) == CONTACT_NORMAL_OK, "a stiffness")
    call hold(contact_normal_solver_stiffness(solver, stiffness, residual) == CONTACT_NORMAL_OK, "with its residual")
    call hold(stiffness > 0 .and. residual >= 0 .and. residual <= 1e-6_c_double, "both of them")
  end subroutine

  ! Options and constants by name, as in an input file, and a dump.
  subroutine by_name()
    type(contact_normal_options) :: named
    type(contact_normal_cycle) :: cycle_named
    integer(c_int32_t) :: value
    logical :: is_there
    call contact_normal_options_init(named)
    call contact_normal_cycle_init(cycle_named)
    call hold(contact_normal_set_option(named, "tolerance ", "1d-9") == CONTACT_NORMAL_OK, "an option")
    call hold(contact_normal_set_option(named, "method", "norm") == CONTACT_NORMAL_OK, "one with a name")
    call hold(abs(named%tolerance - 1e-9_c_double) < 1e-20_c_double .and. named%method == CONTACT_NORMAL_METHOD_NORM, "set")
    call hold(contact_normal_set_option(named, "methud", "norm") == CONTACT_NORMAL_INVALID_ARGUMENT, "none of this name")
    call hold(index(contact_normal_last_error_message(), "is it method?") > 0, "the one that is meant")
    call hold(contact_normal_set_cycle_option(cycle_named, "smoother", "FFT") == CONTACT_NORMAL_OK, "of a cycle")
    call hold(cycle_named%smoother == CONTACT_NORMAL_SMOOTHER_FFT, "is set")
    call hold(contact_normal_constant("METHOD_NORM", value) == CONTACT_NORMAL_OK .and. value == 1, "a constant")
    named%max_cycles = 1
    named%tolerance = 1e-14_c_double
    call contact_normal_set_dump(named, "fortran_module.dump")
    call hold(contact_normal_solve(scene, named, fields) > 0, "a solve that stops early")
    inquire (file="fortran_module.dump", exist=is_there)
    call hold(is_there, "its dump")
    call contact_normal_set_dump(named, " ")
    call hold(contact_normal_solve(scene, named, fields) > 0, "without a dump")
    call hold(index(contact_normal_last_error_message(), "is in") == 0, "there is none")
  end subroutine

  subroutine hold(condition, what)
    logical, intent(in) :: condition
    character(*), intent(in) :: what
    if (condition) return
    print '(4a)', "FAILED: ", what, " ", contact_normal_last_error_message()
    error stop 1
  end subroutine

end program fortran_module
