! How wrong is the answer? The ledger of the paper's problem, with the estimated errors of the force and the true ones (Hertz).
! Usage: ledger [file for the arrays]
program ledger_example
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use contact_normal
  implicit none
  integer(c_int32_t), parameter :: M = 128
  real(c_double), parameter :: CURVATURE_X = 0.0016681_c_double, CURVATURE_Y = 0.0030671_c_double
  type(contact_normal_scene) :: scene
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  type(contact_normal_ledger_row), target :: ledger(32)
  type(contact_normal_hertz_solution) :: exact
  real(c_double), target :: h(M, M), pressure(M, M)
  integer(c_int32_t), target :: contact(M, M)
  integer :: ix, iy, i

  call contact_normal_scene_init(scene)
  scene%mx = M
  scene%my = M
  scene%dx = 20.0_c_double/M
  scene%dy = 12.0_c_double/M
  scene%shear_modulus = 82000        ! N/mm2
  scene%poisson_ratio = 0.28_c_double
  scene%approach = 0.1091_c_double
  do iy = 1, M
    do ix = 1, M
      h(ix, iy) = CURVATURE_X*((ix - 0.5_c_double*(M + 1))*scene%dx)**2 &
        + CURVATURE_Y*((iy - 0.5_c_double*(M + 1))*scene%dy)**2
    end do
  end do
  call contact_normal_set_undeformed_distance(scene, h)
  call contact_normal_fields_init(fields)
  call contact_normal_set_fields(fields, pressure=pressure, contact=contact)
  call contact_normal_report_init(report)
  call contact_normal_set_ledger(report, ledger)
  call check(contact_normal_solve(scene, fields=fields, report=report))
  call contact_normal_hertz_solution_init(exact)
  call check(contact_normal_hertz(CURVATURE_X, CURVATURE_Y, scene%shear_modulus, scene%poisson_ratio, &
                                  CONTACT_NORMAL_PRESCRIBED_APPROACH, scene%approach, exact))

  print '(a)', "     grid    work     force N   estimated error  true error"
  do i = 1, int(report%ledger_rows)
    associate (row => ledger(i))
      print '(i4, " x", i4, f8.2, f12.1, es14.0e2, es14.0e2)', row%mx, row%my, row%work_units, row%force, row%error_force, &
        abs(row%force - exact%force)
    end associate
  end do
  print '(a, l1)', "limited by the grid: ", report%accuracy%limited_by == CONTACT_NORMAL_LIMITED_BY_GRID
  print '(a, f8.4, a, f8.4, a)', "time", report%statistics%setup_seconds + report%statistics%solve_seconds, &
    " s; with elements of half the size about ", &
    report%accuracy%halved_seconds, " s"
  call write_arrays()

contains

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status == CONTACT_NORMAL_OK) return
    print '(4a)', contact_normal_status_text(status), ": ", contact_normal_last_error_message()
    error stop 1
  end subroutine

  ! Writes "mx my dx dy approach", then "h p contact" of each element.
  subroutine write_arrays()
    character(1000) :: name
    integer :: unit
    if (command_argument_count() < 1) return
    call get_command_argument(1, name)
    open (newunit=unit, file=trim(name), action="write", status="replace")
    write (unit, '(i0, 1x, i0, 3es26.16e3)') scene%mx, scene%my, scene%dx, scene%dy, report%normal%approach
    do iy = 1, M
      do ix = 1, M
        write (unit, '(2es26.16e3, 1x, i0)') h(ix, iy), pressure(ix, iy), contact(ix, iy)
      end do
    end do
    close (unit)
  end subroutine

end program ledger_example
