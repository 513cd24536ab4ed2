! The module's procedures refuse arrays of another shape, and one of two arrays without the other. Then they write nothing.
! Results of friction have the state of the particles.
program fortran_shapes
  use, intrinsic :: iso_c_binding
  use contact_normal
  implicit none
  integer, parameter :: dp = c_double
  integer(c_int32_t), parameter :: MX = 8, MY = 6
  real(dp), target :: h(MX, MY)
  type(contact_normal_scene) :: scene
  integer :: ix, iy

  do iy = 1, MY
    do ix = 1, MX
      h(ix, iy) = 0.01_dp*((ix - 4.5_dp)**2 + (iy - 3.5_dp)**2)
    end do
  end do
  call wears()
  call flashes()
  call moduli_need_times()
  call particles()
  call too_many_grids()
  print '(a)', "all hold"

contains

  subroutine hold(condition, what)
    logical, intent(in) :: condition
    character(*), intent(in) :: what
    if (condition) return
    print '(4a)', "does not hold: ", what, "; last error: ", contact_normal_last_error_message()
    error stop 1
  end subroutine

  ! A call was refused with this message.
  subroutine refused(status, why)
    integer(c_int32_t), intent(in) :: status
    character(*), intent(in) :: why
    call hold(index(contact_normal_last_error_message(), "contact_normal_"//why) == 1, why)
    call hold(status == CONTACT_NORMAL_INVALID_ARGUMENT, why)
  end subroutine

  ! A new, valid scene.
  subroutine begin()
    call contact_normal_scene_init(scene)
    scene%mx = MX
    scene%my = MY
    scene%dx = 0.1_dp
    scene%dy = 0.1_dp
    scene%shear_modulus = 82000
    scene%poisson_ratio = 0.28_dp
    scene%approach = 0.1_dp
    call contact_normal_set_undeformed_distance(scene, h)
  end subroutine

  subroutine wears()
    type(contact_normal_wear) :: wear
    real(dp) :: q(MX, MY, 2), s(MX, MY, 2), other(MX, MY/2, 2), flat(MX, MY, 1), work(MX, MY), depth(MX, MY), passage(MY)
    real(dp) :: few(MX, MY/2), turned(MY, MX), short(MY - 1)
    q = -2
    s = 3
    other = 1
    flat = 1
    few = -1
    turned = -1
    short = -1
    work = -1
    call contact_normal_wear_init(wear)
    wear%dx = 0.1_dp
    wear%dy = 0.1_dp
    wear%coefficient = 1e-3_dp
    wear%rolling_distance = 0.1_dp
    call hold(contact_normal_frictional_wear(wear, q, s, work, depth, passage, pressure=h, coefficients=h) == CONTACT_NORMAL_OK, &
              "wear with all")
    call hold(contact_normal_frictional_wear(wear, q, s, work, depth, passage) == CONTACT_NORMAL_OK, "wear")
    call hold(all(abs(work - 12) < 1e-12_dp), "the work of both directions")
    call refused(contact_normal_frictional_wear(wear, flat, s, work), "frictional_wear: traction has another shape")
    call refused(contact_normal_frictional_wear(wear, q, other, work), "frictional_wear: slip has another shape")
    call refused(contact_normal_frictional_wear(wear, q, flat, work), "frictional_wear: slip has another shape")
    call refused(contact_normal_frictional_wear(wear, q, s, few), "frictional_wear: work has another shape")
    call refused(contact_normal_frictional_wear(wear, q, s, depth=turned), "frictional_wear: depth has another shape")
    call refused(contact_normal_frictional_wear(wear, q, s, passage=short), "frictional_wear: passage has another shape")
    call refused(contact_normal_frictional_wear(wear, q, s, work, pressure=few), "frictional_wear: pressure has another shape")
    call refused(contact_normal_frictional_wear(wear, q, s, work, coefficients=turned), &
                 "frictional_wear: coefficients has another shape")
    call hold(all(few <= -1) .and. all(turned <= -1) .and. all(short <= -1), "nothing is written")
    call hold(contact_normal_frictional_wear(wear, q, s, work) == CONTACT_NORMAL_OK, "the wear itself is as it was")
  end subroutine

  subroutine flashes()
    type(contact_normal_heat) :: heat
    real(dp) :: flux(MX, MY), temperature(MX, MY, 2), one_body(MX, MY, 1), turned(MY, MX, 2)
    flux = 1
    one_body = -1
    turned = -1
    call contact_normal_heat_init(heat)
    heat%dx = 0.1_dp
    heat%dy = 0.1_dp
    heat%conductivity = 46
    heat%diffusivity = 12
    heat%speed = [1000, 900]
    call hold(contact_normal_flash_temperature(heat, flux, temperature) == CONTACT_NORMAL_OK, "temperatures")
    call hold(contact_normal_flash_temperature(heat, flux) == CONTACT_NORMAL_OK, "none wanted")
    call refused(contact_normal_flash_temperature(heat, flux, one_body), "flash_temperature: temperature has another shape")
    call refused(contact_normal_flash_temperature(heat, flux, turned), "flash_temperature: temperature has another shape")
    call hold(all(one_body <= -1) .and. all(turned <= -1), "nothing is written")
  end subroutine

  subroutine moduli_need_times()
    type(contact_normal_visco), target :: visco
    real(dp), target :: moduli(2), times(2)
    moduli = [10000, 20000]
    times = [1, 10]
    call begin()
    call contact_normal_set_visco(scene, visco, moduli, times, moduli, times, time_step=1.0_dp)
    call hold(contact_normal_solve(scene) == CONTACT_NORMAL_OK, "bodies that relax")
    call begin()
    call contact_normal_set_visco(scene, visco, modulus_1=moduli, modulus_2=moduli, time_step=1.0_dp)
    call refused(contact_normal_solve(scene), "set_visco: time_1 is not associated")
    call begin()
    call contact_normal_set_visco(scene, visco, time_1=times, time_step=1.0_dp)
    call refused(contact_normal_solve(scene), "set_visco: modulus_1 is not associated")
    call begin()
    call contact_normal_set_visco(scene, visco, moduli, times, modulus_2=moduli, time_step=1.0_dp)
    call refused(contact_normal_solve(scene), "set_visco: time_2 is not associated")
    call begin()
    call contact_normal_set_visco(scene, visco, time_2=times, time_step=1.0_dp)
    call refused(contact_normal_solve(scene), "set_visco: modulus_2 is not associated")
  end subroutine

  ! The state of the particles after an entry of a table is that after the entry alone.
  subroutine particles()
    type(contact_normal_friction), target :: friction
    type(contact_normal_friction_results) :: results
    real(dp), target :: mu(MX, MY, 2), limit(MX, MY, 2), one_mu(MX, MY, 1), one_limit(MX, MY, 1)
    real(dp), pointer, contiguous :: nothing(:, :, :)
    real(dp) :: p(MX, MY), entries(3, 2)
    p = 1000
    call begin()
    call contact_normal_set_friction(scene, friction, 0.4_dp)
    friction%law = CONTACT_NORMAL_FRICTION_LAW_LINEAR
    friction%kinetic = 0.2_dp
    friction%falling(1) = 0.2_dp
    friction%half_speed(1) = 0.05_dp
    friction%time_step = 1
    friction%yield_limit = 100
    friction%hardening = 1000
    entries = 0
    entries(1, :) = [-0.01_dp, -0.02_dp]
    call contact_normal_friction_results_init(results)
    call contact_normal_set_friction_results(results, friction_coefficient=mu, yield_limit=limit)
    call hold(contact_normal_solve_tangential(scene, p, n=2_c_int32_t, entries=entries, results=results) == CONTACT_NORMAL_OK, &
              "a table")
    call contact_normal_friction_results_init(results)
    call contact_normal_set_friction_results(results, friction_coefficient=one_mu, yield_limit=one_limit)
    call hold(contact_normal_solve_tangential(scene, p, entries=entries(:, 2:2), results=results) == CONTACT_NORMAL_OK, "an entry")
    call hold(all(abs(mu(:, :, 2:2) - one_mu) < 1e-4_dp*0.4_dp) .and. minval(mu(:, :, 2)) < 0.39_dp &
              .and. minval(mu) > 0.2_dp, "its coefficients")
    call hold(all(abs(limit(:, :, 2:2) - one_limit) < 1e-4_dp*100) .and. maxval(limit(:, :, 2)) > 101 &
              .and. minval(limit) >= 100, "its yield limits")
    nullify (nothing)
    call contact_normal_set_friction_results(results, friction_coefficient=mu, yield_limit=nothing)
    call refused(contact_normal_solve_tangential(scene, p, results=results), "set_friction_results: yield_limit is not associated")
    call contact_normal_friction_results_init(results)
    call contact_normal_set_friction_results(results, friction_coefficient=nothing)
    call refused(contact_normal_solve_tangential(scene, p, results=results), &
                 "set_friction_results: friction_coefficient is not associated")
  end subroutine

  ! The library refuses numbers of grids whose rows exceed the memory or the range of an integer.
  subroutine too_many_grids()
    type(contact_normal_quantity_row), allocatable :: rows(:)
    integer(c_int32_t), parameter :: WANTED(1) = CONTACT_NORMAL_QUANTITY_MAX_PRESSURE
    integer(c_int32_t) :: coarser(3), k, status
    coarser = [2000000000_c_int32_t, huge(k), -1_c_int32_t]
    call begin()
    do k = 1, 3
      status = contact_normal_quantities(scene, WANTED, rows, coarser(k))
      call hold(status == CONTACT_NORMAL_INVALID_ARGUMENT .and. size(rows) == 0, "so many grids")
      call hold(index(contact_normal_last_error_message(), "it must lie in 0..12") > 0, "how many there may be")
    end do
    status = contact_normal_quantities(scene, WANTED, rows, 1_c_int32_t)
    call hold(status == CONTACT_NORMAL_OK .and. size(rows) == 2, "two grids")
  end subroutine
end program fortran_shapes
