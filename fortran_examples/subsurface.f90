! Stresses below the surface: on the axis of a ball (Hertz), compared with the exact ones. Then the ball slides, and the largest von Mises stress
! is elsewhere (at x = 0.27 a, z = 0.44 a for a friction coefficient of 0.25, Hamilton 1983).
program subsurface
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use contact_normal
  implicit none
  integer(c_int32_t), parameter :: N = 32, M = 2*N + 1, DEPTHS = 101
  real(c_double), parameter :: D = 1.0_c_double/N, NU = 0.3_c_double     ! a = 1, p0 = 1
  type(contact_normal_scene) :: scene
  type(contact_normal_stress_outputs) :: outputs
  type(contact_normal_stress_maximum), target :: largest
  real(c_double) :: p(M, M), q(M, M), z(DEPTHS), exact, radial
  real(c_double), allocatable, target :: stress(:, :, :, :), shear(:, :, :)
  integer :: ix, iy, i

  call contact_normal_scene_init(scene)
  scene%mx = M
  scene%my = M
  scene%dx = D
  scene%dy = D
  scene%poisson_ratio = NU
  do iy = 1, M
    do ix = 1, M
      p(ix, iy) = sqrt(max(0.0_c_double, 1 - ((ix - N - 1)*D)**2 - ((iy - N - 1)*D)**2))
    end do
  end do
  q = 0.25_c_double*p
  z = [(0.02_c_double*(i - 1), i = 1, DEPTHS)]

  allocate(stress(M, M, DEPTHS, 6), shear(M, M, DEPTHS))
  call contact_normal_stress_outputs_init(outputs)
  call contact_normal_set_stress_outputs(outputs, stress=stress, maximum_shear=shear, largest_shear=largest)
  call check(contact_normal_subsurface_stress(scene, 1, p, depths=z, n=DEPTHS, outputs=outputs))
  print '(a)', "Under the middle of a ball:", "  z/a      szz/p0     exact    shear/p0     exact"
  do i = 1, DEPTHS, 12
    exact = -1/(1 + z(i)**2)
    radial = -(1 + NU)
    if (z(i) > 0) radial = -(1 + NU)*(1 - z(i)*atan(1/z(i)))
    radial = radial - exact/2
    print '(f5.2, f12.4, f10.4, f12.4, f10.4)', z(i), stress(N + 1, N + 1, i, 3), exact, shear(N + 1, N + 1, i), &
      abs(exact - radial)/2
  end do
  print '(a, f7.4, a, f5.2, a)', "largest shear", largest%value, " p0 at z =", largest%z, " a"

  call contact_normal_stress_outputs_init(outputs)
  call contact_normal_set_stress_outputs(outputs, largest_von_mises=largest)
  call check(contact_normal_subsurface_stress(scene, 1, p, q, depths=z, n=DEPTHS, outputs=outputs))
  print '(a)', "Sliding in x with friction .25:"
  print '(a, f7.4, a, f5.2, a, f5.2, a)', "largest von Mises stress", largest%value, " p0 at x =", largest%x, &
    " a, z =", largest%z, " a"
  deallocate(stress, shear)

contains

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status == CONTACT_NORMAL_OK) return
    print '(a)', contact_normal_last_error_message()
    error stop 1
  end subroutine

end program subsurface
