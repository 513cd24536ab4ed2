! Flash temperature: a steel ball of radius 5 mm does not move, and is pressed by 50 N onto a steel disc that slides past it at 2 and 20 m/s. The
! friction coefficient mu is 0.1, and the heat flux into each element mu p v. Units are m, N, s, W and K.
program flash_temperature
  use, intrinsic :: iso_c_binding
  use contact_normal
  implicit none
  integer, parameter :: m = 80
  real(c_double), parameter :: d = 5e-6_c_double, mu = 0.1_c_double, speeds(2) = [2.0_c_double, 20.0_c_double]
  real(c_double), pointer, contiguous :: h(:, :), pressure(:, :)
  real(c_double) :: flux(m, m)
  type(contact_normal_scene) :: scene
  type(contact_normal_fields) :: fields
  type(contact_normal_heat) :: heat
  type(contact_normal_flash) :: flash
  integer :: ix, iy, k

  allocate (h(m, m), pressure(m, m))
  do iy = 1, m
    do ix = 1, m
      h(ix, iy) = (((ix - 0.5_c_double*(m + 1))*d)**2 + ((iy - 0.5_c_double*(m + 1))*d)**2)/0.01_c_double
    end do
  end do
  call contact_normal_scene_init(scene)
  scene%mx = m
  scene%my = m
  scene%dx = d
  scene%dy = d
  scene%shear_modulus = 80e9_c_double
  scene%poisson_ratio = 0.3_c_double
  scene%force = 50
  call contact_normal_set_undeformed_distance(scene, h)
  call contact_normal_fields_init(fields)
  call contact_normal_set_fields(fields, pressure=pressure)
  call check(contact_normal_solve(scene, fields=fields))
  call contact_normal_heat_init(heat)
  heat%dx = d
  heat%dy = d
  heat%conductivity = 46
  heat%diffusivity = 1.2e-5_c_double
  call contact_normal_flash_init(flash)
  print '(a)', 'speed  heat into the ball  flash temperature  where'
  do k = 1, 2
    flux = mu*speeds(k)*pressure
    heat%speed(2) = speeds(k)
    call check(contact_normal_flash_temperature(heat, flux, flash=flash))
    print '(f5.0, f20.3, f18.1, a, f5.1, a)', speeds(k), flash%share, flash%largest(1), '  x = ', 1e6_c_double*flash%x(2), &
      ' um on the disc'
  end do

contains

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status /= CONTACT_NORMAL_OK) then
      print '(a)', contact_normal_last_error_message()
      error stop 1
    end if
  end subroutine
end program
