! An error in the call of a setter is reported by the next call of the library, and no output is written. Arrays may have any bounds.
program fortran_setters
  use, intrinsic :: iso_c_binding
  use contact_normal
  implicit none
  integer, parameter :: dp = c_double
  integer(c_int32_t), parameter :: M = 8
  real(dp), pointer, contiguous :: nothing(:, :) => null(), nothing_3(:, :, :) => null(), nothing_4(:, :, :, :) => null()
  integer(c_int32_t), pointer, contiguous :: no_integers(:, :) => null()
  real(dp), target :: h(M, M), p(M, M), few(3, 3), odd(2*M, 2*M - 1), even(-M:M - 1, -M:M - 1), cube(2*M, M, M - 1)
  integer(c_int32_t), target :: patch(M, M)
  type(contact_normal_scene) :: scene
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  type(contact_normal_options) :: options
  type(contact_normal_friction), target :: friction
  type(contact_normal_layer), target :: layer
  type(contact_normal_layer), pointer :: no_layer => null()
  type(contact_normal_pressure_limit), target :: limit
  type(contact_normal_influence), target :: influence, tables(-1:3), two_tables(2)
  type(contact_normal_row_tables), target :: rows, two_rows(2), three_rows(-2:0)
  type(contact_normal_patches), target :: patches
  type(contact_normal_ledger_row), target :: ledger(0:7)
  type(contact_normal_ledger_row), pointer, contiguous :: no_ledger(:) => null()
  type(contact_normal_cycle), pointer :: no_cycle => null()
  type(contact_normal_period), pointer :: no_period => null()
  integer :: ix, iy

  do iy = 1, M
    do ix = 1, M
      h(ix, iy) = 0.01_dp*((ix - 4.5_dp)**2 + (iy - 4.5_dp)**2)
    end do
  end do
  few = 1
  odd = 0
  even = 0
  cube = 0
  patch = 0

  call a_scene_needs_a_load()
  call coatings()
  call begin()
  call contact_normal_set_undeformed_distance(scene, nothing)
  call refused("set_undeformed_distance: h is not associated")
  call contact_normal_set_influence(scene, influence, M, M, even)
  call contact_normal_set_influence(scene, influence, M, M, few)
  call refused("set_influence: coefficients has another shape")
  call contact_normal_set_layer(scene, layer, compliances=nothing)
  call refused("set_layer: compliances is not associated")
  call contact_normal_set_layer(scene, no_layer, 1e-5_dp)
  call refused("set_layer: layer is not associated")
  call contact_normal_set_pressure_limit(scene, limit, limits=nothing)
  call refused("set_pressure_limit: limits is not associated")
  call contact_normal_set_period(scene, no_period, .true., .false.)
  call refused("set_period: period is not associated")
  call contact_normal_set_patches(scene, patches, patch, few(:, 1:2))
  call refused("set_patches: factors has another shape")
  call contact_normal_set_patches(scene, patches, no_integers, few)
  call refused("set_patches: patch is not associated")
  call contact_normal_set_row_tables(scene, rows, M, cube)
  call refused("set_row_tables: coefficients has another shape")
  call contact_normal_set_row_tables(scene, rows, M, nothing_3)
  call refused("set_row_tables: coefficients is not associated")
  call contact_normal_set_friction(scene, friction, coefficients=nothing)
  call refused("set_friction: coefficients is not associated")
  call contact_normal_set_friction(scene, friction, 0.3_dp, slip_x=h, slip_y=nothing)
  call refused("set_friction: slip_y is not associated")
  call contact_normal_set_friction(scene, friction, 0.3_dp, previous_coefficient=h, previous_yield_limit=nothing)
  call refused("set_friction: previous_yield_limit is not associated")
  call contact_normal_set_friction(scene, friction, 0.3_dp, compliances=nothing)
  call refused("set_friction: compliances is not associated")
  call contact_normal_set_friction(scene, friction, 0.3_dp)
  call contact_normal_set_tangential_influence(friction, two_tables, even, even, even)
  call refused("set_tangential_influence: tables has another shape")
  call contact_normal_set_friction(scene, friction, 0.3_dp)
  call contact_normal_set_tangential_influence(friction, tables, even, odd, even)
  call refused("set_tangential_influence: yy has another shape")
  call contact_normal_set_friction(scene, friction, 0.3_dp)
  call contact_normal_set_tangential_row_tables(friction, two_rows, M, cube, cube, cube)
  call refused("set_tangential_row_tables: tables has another shape")
  call contact_normal_set_friction(scene, friction, 0.3_dp)
  call contact_normal_set_tangential_row_tables(friction, three_rows, M, nothing_3, cube, cube)
  call refused("set_tangential_row_tables: xx is not associated")

  ! The other arrays of a call.
  call contact_normal_set_fields(fields, pressure=p, displacement=nothing)
  call refused("set_fields: displacement is not associated")
  call contact_normal_set_friction_fields(fields, traction_x=h, stick_slip=no_integers)
  call refused("set_friction_fields: stick_slip is not associated")
  call contact_normal_set_ledger(report, no_ledger)
  call refused("set_ledger: ledger is not associated")
  call contact_normal_set_cycle(options, no_cycle, pre_sweeps=2_c_int32_t)
  call refused("set_cycle: cycle is not associated")

  call tables_of_any_bounds()
  call a_ledger_of_any_bounds()
  call stresses()
  call tables_of_forces()
  call batches()
  print '(a)', "all hold"

contains

  subroutine hold(condition, what)
    logical, intent(in) :: condition
    character(*), intent(in) :: what
    if (condition) return
    print '(4a)', "does not hold: ", what, "; last error: ", contact_normal_last_error_message()
    error stop 1
  end subroutine

  ! Everything anew, valid.
  subroutine begin()
    call contact_normal_scene_init(scene)
    call contact_normal_fields_init(fields)
    call contact_normal_report_init(report)
    call contact_normal_options_init(options)
    scene%mx = M
    scene%my = M
    scene%dx = 0.1_dp
    scene%dy = 0.1_dp
    scene%shear_modulus = 82000
    scene%approach = 0.1_dp
    call contact_normal_set_undeformed_distance(scene, h)
  end subroutine

  function solved() result(status)
    integer(c_int32_t) :: status
    status = contact_normal_solve(scene, options, fields, report)
  end function

  ! The solve is refused with this message. Then the scene begins again.
  subroutine refused(why)
    character(*), intent(in) :: why
    call hold(solved() == CONTACT_NORMAL_INVALID_ARGUMENT, why)
    call hold(index(contact_normal_last_error_message(), "contact_normal_"//why) == 1, why)
    call begin()
    call hold(solved() == CONTACT_NORMAL_OK, "anew")
  end subroutine

  subroutine a_scene_needs_a_load()
    type(contact_normal_scene) :: fresh
    call begin()
    call contact_normal_scene_init(fresh)
    scene%approach = fresh%approach
    call hold(solved() == CONTACT_NORMAL_INVALID_ARGUMENT, "no load")
    call hold(index(contact_normal_last_error_message(), "the scene has no load: set scene->approach or") == 1, &
              "what to set")
    scene%force = 10
    call hold(solved() == CONTACT_NORMAL_OK .and. abs(report%normal%force - 10) < 1e-9_dp, "a force alone")
  end subroutine

  subroutine coatings()
    type(contact_normal_coating), target :: coating
    integer :: body
    integer :: k
    do k = 0, 3
      body = k
      call begin()
      call contact_normal_set_coating(scene, body, coating, 0.1_dp, 8200.0_dp, 0.3_dp)
      call hold(.not. (c_associated(scene%row_tables) .or. c_associated(scene%friction)), "nothing beside the coatings")
      if (body == 1 .or. body == 2) then
        call hold(solved() == CONTACT_NORMAL_OK .and. c_associated(scene%coating(body)), "a coating")
      else
        call refused("set_coating: body is "//achar(iachar("0") + body)//"; it must be 1 or 2")
      end if
    end do
    call begin()
    call contact_normal_set_coating(scene, -7, coating, 0.1_dp, 8200.0_dp, 0.3_dp)
    call refused("set_coating: body is -7; it must be 1 or 2")
    ! The message has the first fault.
    call contact_normal_set_coating(scene, 3, coating, 0.1_dp, 8200.0_dp, 0.3_dp)
    call contact_normal_set_layer(scene, no_layer, 1e-5_dp)
    call refused("set_coating: body is 3; it must be 1 or 2")
  end subroutine

  subroutine tables_of_any_bounds()
    call hold(contact_normal_influence_half_space(M, M, 0.1_dp, 0.1_dp, scene%shear_modulus, scene%poisson_ratio, even) == 0, &
              "a table")
    call contact_normal_set_friction(scene, friction, 0.3_dp)
    friction%creepage(1) = 1e-3_dp
    call contact_normal_set_tangential_influence(friction, tables, even, even, zeros_of_a_table())
    call hold(solved() == CONTACT_NORMAL_OK, "tables with bounds of their own")
    call hold(tables(-1)%cx == M .and. tables(1)%cx == M, "the first three of them")
    call begin()
    call contact_normal_set_friction(scene, friction, 0.3_dp)
    friction%creepage(1) = 1e-3_dp
    call contact_normal_set_tangential_row_tables(friction, three_rows, M, even_rows(), even_rows(), zeros_of_rows())
    call hold(solved() == CONTACT_NORMAL_OK, "tables per row")
    call hold(three_rows(-2)%rows == M .and. three_rows(0)%cx == M, "three of them")
    call begin()
  end subroutine

  function even_rows() result(rows_of_even)
    real(dp), pointer, contiguous :: rows_of_even(:, :, :)
    real(dp), target, save :: kept(2*M, M, M)
    integer :: row, loaded
    do loaded = 1, M
      do row = 1, M
        kept(:, row, loaded) = even(:, row - loaded)
      end do
    end do
    rows_of_even => kept
  end function

  function zeros_of_rows() result(zeros)
    real(dp), pointer, contiguous :: zeros(:, :, :)
    real(dp), target, save :: kept(2*M, M, M) = 0
    zeros => kept
  end function

  function zeros_of_a_table() result(zeros)
    real(dp), pointer, contiguous :: zeros(:, :)
    real(dp), target, save :: kept(2*M, 2*M) = 0
    zeros => kept
  end function

  subroutine a_ledger_of_any_bounds()
    call contact_normal_set_ledger(report, ledger)
    call hold(solved() == CONTACT_NORMAL_OK .and. report%ledger_rows > 0, "a ledger from 0 on")
    call hold(ledger(report%ledger_rows - 1)%mx == M, "its last row")
    call begin()
  end subroutine

  subroutine stresses()
    type(contact_normal_stress_outputs) :: outputs
    type(contact_normal_stress_maximum), pointer :: no_maximum
    real(dp), target :: stress(-3:4, 0:M - 1, 0:1, 6), plain(M, M, 2, 6), five(M, M, 2, 5), vectors(2, M, M, 2, 3)
    real(dp), target :: principal(0:M - 1, M, 2:3, 0:2), ordered(M, M, 2, 3)
    p = 1
    call contact_normal_stress_outputs_init(outputs)
    call contact_normal_set_stress_outputs(outputs, stress=plain, principal=ordered)
    call hold(below(outputs) == CONTACT_NORMAL_OK, "stresses")
    call contact_normal_set_stress_outputs(outputs, stress=stress, principal=principal)
    call hold(below(outputs) == CONTACT_NORMAL_OK, "stresses with bounds of their own")
    call hold(all(abs(stress - plain) <= 0) .and. all(abs(principal - ordered) <= 0), "the same")
    call contact_normal_set_stress_outputs(outputs, stress=five)
    call not_written(outputs, "set_stress_outputs: stress has another shape")
    call contact_normal_set_stress_outputs(outputs, directions=vectors)
    call not_written(outputs, "set_stress_outputs: directions has another shape")
    call contact_normal_set_stress_outputs(outputs, principal=nothing_4)
    call not_written(outputs, "set_stress_outputs: principal is not associated")
    nullify (no_maximum)
    call contact_normal_set_stress_outputs(outputs, stress=plain, largest_shear=no_maximum)
    call not_written(outputs, "set_stress_outputs: largest_shear is not associated")
  end subroutine

  function below(outputs) result(status)
    type(contact_normal_stress_outputs), intent(inout) :: outputs
    integer(c_int32_t) :: status
    status = contact_normal_subsurface_stress(scene, 1_c_int32_t, p, depths=[0.0_dp, 0.1_dp], n=2_c_int32_t, outputs=outputs)
  end function

  subroutine not_written(outputs, why)
    type(contact_normal_stress_outputs), intent(inout) :: outputs
    character(*), intent(in) :: why
    call hold(below(outputs) == CONTACT_NORMAL_INVALID_ARGUMENT, why)
    call hold(index(contact_normal_last_error_message(), "contact_normal_"//why) == 1, why)
    call contact_normal_stress_outputs_init(outputs)
  end subroutine

  subroutine tables_of_forces()
    type(contact_normal_friction_results) :: results
    integer(c_int32_t), parameter :: n = 3
    real(dp), target :: force(2, n), wrong(n, 2), traction(M, M, 2, n), flat(M, M, 1, n)
    real(dp) :: entries(3, n)
    entries = 1e-3_dp
    call contact_normal_set_friction(scene, friction, 0.3_dp)
    call contact_normal_friction_results_init(results)
    call contact_normal_set_friction_results(results, force=force, traction=traction)
    call hold(contact_normal_solve_tangential(scene, n=n, entries=entries, results=results) == CONTACT_NORMAL_OK, "a table")
    call contact_normal_set_friction_results(results, force=wrong)
    call hold(contact_normal_solve_tangential(scene, n=n, entries=entries, results=results) < 0, "forces of another shape")
    call hold(index(contact_normal_last_error_message(), "force has another shape") > 0, "are named")
    call contact_normal_friction_results_init(results)
    call contact_normal_set_friction_results(results, traction=flat)
    call hold(contact_normal_solve_tangential(scene, n=n, entries=entries, results=results) < 0, "tractions of another shape")
    call hold(index(contact_normal_last_error_message(), "traction has another shape") > 0, "are named")
    call begin()
  end subroutine

  subroutine batches()
    type(contact_normal_solver) :: solver
    type(contact_normal_scene) :: scenes(3)
    type(contact_normal_fields) :: two(2), three(3)
    integer(c_int32_t) :: statuses(3), few_statuses(2)
    integer :: k
    scenes = scene
    do k = 1, 2
      call contact_normal_fields_init(two(k))
    end do
    do k = 1, 3
      call contact_normal_fields_init(three(k))
    end do
    call hold(contact_normal_solver_new(scene, solver=solver) == CONTACT_NORMAL_OK, "a solver")
    call hold(contact_normal_solver_solve_batch(solver, scenes, fields=three, statuses=statuses) == CONTACT_NORMAL_OK, "a batch")
    call hold(contact_normal_solver_solve_batch(solver, scenes, fields=two, statuses=statuses) &
              == CONTACT_NORMAL_INVALID_ARGUMENT, "two")
    call hold(index(contact_normal_last_error_message(), "solver_solve_batch: fields has another shape") > 0, "fields of three")
    call hold(contact_normal_solver_solve_batch(solver, scenes, statuses=few_statuses) &
              == CONTACT_NORMAL_INVALID_ARGUMENT, "statuses")
    call contact_normal_solver_free(solver)
  end subroutine
end program fortran_setters
