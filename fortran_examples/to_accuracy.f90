! An accuracy instead of a grid: the paper's ellipse, refined from 16 x 16 elements until the estimated error of the force is 0.1 %. The exact
! solution of Hertz shows the true error. Usage: to_accuracy [file for the arrays]
module ellipse
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_ptr, c_associated
  implicit none
  real(c_double), parameter :: CURVATURE_X = 0.0016681_c_double, CURVATURE_Y = 0.0030671_c_double

contains

  ! The callback of the library: writes the undeformed distance of any grid over [-10, 10] x [-6, 6] mm.
  function surface(mx, my, dx, dy, h, user) bind(C) result(cancel)
    integer(c_int32_t), value :: mx, my
    real(c_double), value :: dx, dy
    real(c_double), intent(inout) :: h(mx, my)
    type(c_ptr), value :: user
    integer(c_int32_t) :: cancel
    integer :: ix, iy
    cancel = 0
    if (c_associated(user)) cancel = 1       ! never, because `user` is not set
    do iy = 1, my
      do ix = 1, mx
        h(ix, iy) = CURVATURE_X*((ix - 0.5_c_double*(mx + 1))*dx)**2 + CURVATURE_Y*((iy - 0.5_c_double*(my + 1))*dy)**2
      end do
    end do
  end function

end module ellipse

program to_accuracy
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_int64_t, c_null_ptr
  use contact_normal
  use ellipse
  implicit none
  type(contact_normal_scene) :: scene
  type(contact_normal_options) :: options
  type(contact_normal_accuracy) :: accuracy
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  type(contact_normal_solver) :: solver
  type(contact_normal_hertz_solution) :: exact
  type(contact_normal_ledger_row), target :: rows(16)
  real(c_double), allocatable, target :: pressure(:, :)
  integer(c_int32_t), allocatable, target :: contact(:, :)
  integer :: i

  call contact_normal_scene_init(scene)
  scene%mx = 16
  scene%my = 16
  scene%dx = 20.0_c_double/16
  scene%dy = 12.0_c_double/16
  scene%shear_modulus = 82000        ! N/mm2
  scene%poisson_ratio = 0.28_c_double
  scene%approach = 0.1091_c_double

  call contact_normal_options_init(options)
  options%tolerance = 1e-8_c_double
  call contact_normal_accuracy_init(accuracy)
  accuracy%target = 1e-3_c_double
  accuracy%max_elements = 1024_c_int64_t**2
  call contact_normal_set_surface(accuracy, surface)
  call contact_normal_report_init(report)
  call contact_normal_set_ledger(report, rows)
  call check(contact_normal_solve_to_accuracy(scene, options, accuracy, solver, report))
  call contact_normal_hertz_solution_init(exact)
  call check(contact_normal_hertz(CURVATURE_X, CURVATURE_Y, scene%shear_modulus, scene%poisson_ratio, &
                                  CONTACT_NORMAL_PRESCRIBED_APPROACH, scene%approach, exact))

  ! The arrays of the last grid, whose size is known only now.
  allocate (pressure(accuracy%mx, accuracy%my), contact(accuracy%mx, accuracy%my))
  call contact_normal_fields_init(fields)
  call contact_normal_set_fields(fields, pressure=pressure, contact=contact)
  call check(contact_normal_solver_fields(solver, fields))
  call contact_normal_solver_free(solver)

  print '(a, es7.1)', "Hertz contact, the force to be good to ", accuracy%target
  print '(a, i0, a, i0)', "elements              ", accuracy%mx, " x ", accuracy%my
  print '(a, f0.0)', "force                 ", report%normal%force
  print '(2a)', "met by the estimate   ", merge("yes", "no ", accuracy%reached <= accuracy%target)
  print '(2a)', "met in fact           ", merge("yes", "no ", abs(report%normal%force/exact%force - 1) <= accuracy%target)
  print '(2a)', "pressures sum to it   ", &
    merge("yes", "no ", abs(sum(pressure)*accuracy%dx*accuracy%dy - report%normal%force) <= 1e-9_c_double*report%normal%force)
  print '(a)', "grid             force   estimated error"
  do i = 1, int(min(report%ledger_rows, size(rows, kind=c_int64_t)))
    if (rows(i)%error_force >= 0) then
      print '(i4, a, i4, f12.0, es18.1)', rows(i)%mx, " x", rows(i)%my, rows(i)%force, rows(i)%error_force
    else
      print '(i4, a, i4, f12.0, a18)', rows(i)%mx, " x", rows(i)%my, rows(i)%force, "not known"
    end if
  end do
  print '(a, f8.4, a)', "time", accuracy%seconds, " s"
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
    real(c_double) :: h(accuracy%mx, accuracy%my)
    integer :: ix, iy, unit
    if (command_argument_count() < 1) return
    call get_command_argument(1, name)
    if (surface(accuracy%mx, accuracy%my, accuracy%dx, accuracy%dy, h, c_null_ptr) /= 0) error stop 1
    open (newunit=unit, file=trim(name), action="write", status="replace")
    write (unit, '(i0, 1x, i0, 3es26.16e3)') accuracy%mx, accuracy%my, accuracy%dx, accuracy%dy, report%normal%approach
    do iy = 1, accuracy%my
      do ix = 1, accuracy%mx
        write (unit, '(2es26.16e3, 1x, i0)') h(ix, iy), pressure(ix, iy), contact(ix, iy)
      end do
    end do
    close (unit)
  end subroutine

end program to_accuracy
