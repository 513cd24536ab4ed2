! Solves a gap that the Python package made from measured heights, or from the profiles of a wheel and a rail, and wrote by Gap.write.
! Usage: gap ../data/gaps/wheel_rail.txt 80000 [file for the arrays]: presses the surfaces of steel bodies together by a force. Lengths are in mm,
! forces in N.
program gap
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use, intrinsic :: iso_fortran_env, only: error_unit
  use contact_normal
  implicit none
  integer(c_int32_t) :: mx, my
  real(c_double) :: dx, dy, force
  real(c_double), allocatable, target :: h(:, :), p(:, :)
  integer(c_int32_t), allocatable, target :: contact(:, :)
  type(contact_normal_scene) :: scene
  type(contact_normal_options) :: options
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report

  call read_gap()
  allocate (p(mx, my), contact(mx, my))
  call contact_normal_scene_init(scene)
  call contact_normal_options_init(options)
  call contact_normal_fields_init(fields)
  call contact_normal_report_init(report)
  scene%mx = mx; scene%my = my; scene%dx = dx; scene%dy = dy
  scene%shear_modulus = 82000
  scene%poisson_ratio = 0.28_c_double
  scene%force = force
  options%tolerance = 1e-9_c_double
  call contact_normal_set_undeformed_distance(scene, h)
  call contact_normal_set_fields(fields, pressure=p, contact=contact)
  call check(contact_normal_solve(scene, options, fields, report))

  print '(a, i0, a, i0, a, i0, a)', "gap of ", mx, " x ", my, " elements, ", count(h > huge(h)), " without a surface"
  print '(a, f12.4)', "force            N      ", report%normal%force
  print '(a, f12.6)', "approach         mm     ", report%normal%approach
  print '(a, f12.1)', "largest pressure N/mm2  ", report%normal%max_pressure
  print '(a, f12.2)', "contact area     %      ", 100*count(contact > 0)/real(mx*my, c_double)
  call write_arrays()
  deallocate (h, p, contact)

contains

  ! Reads two lines that begin with "#", a line "mx my dx dy", and one undeformed distance per element, x first; "inf": no surface.
  subroutine read_gap()
    character(1000) :: name
    integer :: unit, ix, iy, failed
    call get_command_argument(2, name)
    read (name, *, iostat=failed) force
    if (failed /= 0 .or. scan(trim(adjustl(name)), ',;/ ') > 0) then
      write (error_unit, '(a)') "usage: gap gap.txt force [file for the arrays]", "force is a number, in N"
      stop 1
    end if
    call get_command_argument(1, name)
    open (newunit=unit, file=trim(name), action="read", status="old", iostat=failed)
    if (failed /= 0) then
      write (error_unit, '(2a)') trim(name), ": cannot be read"
      stop 1
    end if
    read (unit, '(/)')
    read (unit, *) mx, my, dx, dy
    allocate (h(mx, my))
    do iy = 1, my
      do ix = 1, mx
        read (unit, *) h(ix, iy)
      end do
    end do
    close (unit)
  end subroutine

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status == CONTACT_NORMAL_OK) return
    print '(4a)', contact_normal_status_text(status), ": ", contact_normal_last_error_message()
    stop 1
  end subroutine

  ! Writes "mx my dx dy approach", then "h p contact" of each element.
  subroutine write_arrays()
    character(1000) :: name
    integer :: unit, ix, iy
    if (command_argument_count() < 3) return
    call get_command_argument(3, name)
    open (newunit=unit, file=trim(name), action="write", status="replace")
    write (unit, '(i0, 1x, i0, 3es26.16e3)') mx, my, dx, dy, report%normal%approach
    do iy = 1, my
      do ix = 1, mx
        write (unit, '(2es26.16e3, 1x, i0)') h(ix, iy), p(ix, iy), contact(ix, iy)
      end do
    end do
    close (unit)
  end subroutine

end program gap
