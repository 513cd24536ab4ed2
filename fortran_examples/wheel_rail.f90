! A real wheel on a real rail under a given force: reads the undeformed distances and the result of the program CONTACT, and solves the contact with
! norm_solve.
! Usage: wheel_rail data/wheel_rail/y0_10kN.txt [file for the arrays]
program wheel_rail
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use, intrinsic :: iso_fortran_env, only: error_unit
  use contact_normal
  implicit none
  integer(c_int32_t) :: mx, my, itcg, ierror
  real(c_double) :: dx, dy, approach, force, shear_modulus, poisson_ratio, pen, fn, err
  real(c_double), allocatable :: h(:, :), reference(:, :), ps(:, :), cf(:, :)
  integer(c_int32_t), allocatable :: in_contact(:, :), igs(:, :)

  call read_case()

  ! The influence coefficients of two equal bodies, and no initial estimate.
  allocate (cf(-mx:mx - 1, -my:my - 1), ps(mx, my), igs(mx, my))
  ierror = contact_normal_influence_half_space(mx, my, dx, dy, [shear_modulus, shear_modulus], &
                                               [poisson_ratio, poisson_ratio], cf)
  call check(ierror)
  ps = 0
  igs = 0
  fn = force
  call norm_solve(mx, my, dx, dy, mx, my, cf, h, 1, pen, fn, igs, ps, 1e-8_c_double, 1000, itcg, err, ierror)
  call check(ierror)

  print '(a, i0, a, i0, a, f0.1, a)', "wheel on rail, ", mx, " x ", my, " elements, force ", force, " N"
  print '(a)', "                          computed     CONTACT"
  print '(a, 2f12.6)', "approach       mm     ", pen, approach
  print '(a, 2f12.2)', "max pressure   N/mm2  ", maxval(ps), maxval(reference)
  print '(a, 2i12)', "contact        elements", count(igs > 0), count(in_contact > 0)
  ! The reference has a tolerance of 1e-7.
  print '(2a)', "pressures differ by less than 1e-6 of the largest: ", &
    trim(merge("yes", "no ", all(abs(ps - reference) < 1e-6_c_double*maxval(reference))))
  call write_arrays()
  deallocate (h, reference, in_contact, cf, ps, igs)

contains

  subroutine read_case()
    character(1000) :: name
    integer :: unit, ix, iy, failed
    call get_command_argument(1, name)
    open (newunit=unit, file=trim(name), action="read", status="old", iostat=failed)
    if (failed /= 0) then
      write (error_unit, '(a)') "usage: wheel_rail data/wheel_rail/y0_10kN.txt [file for the arrays]"
      stop 1
    end if
    read (unit, '(//)')
    read (unit, *) mx, my, dx, dy, approach, force, shear_modulus, poisson_ratio
    allocate (h(mx, my), reference(mx, my), in_contact(mx, my))
    do iy = 1, my
      do ix = 1, mx
        read (unit, *) h(ix, iy), reference(ix, iy), in_contact(ix, iy)
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
    if (command_argument_count() < 2) return
    call get_command_argument(2, name)
    open (newunit=unit, file=trim(name), action="write", status="replace")
    write (unit, '(i0, 1x, i0, 3es26.16e3)') mx, my, dx, dy, pen
    do iy = 1, my
      do ix = 1, mx
        write (unit, '(2es26.16e3, 1x, i0)') h(ix, iy), ps(ix, iy), igs(ix, iy)
      end do
    end do
    close (unit)
  end subroutine

end program wheel_rail
