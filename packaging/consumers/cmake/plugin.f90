! The program of ../fpm/app as a shared library, as a plugin of another program has it.
subroutine force() bind(c)
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use contact_normal
  implicit none
  integer, parameter :: M = 128
  real(c_double), parameter :: DX = 20.0_c_double/M, DY = 12.0_c_double/M
  type(contact_normal_scene) :: scene
  type(contact_normal_report) :: report
  real(c_double), target :: h(M, M)
  integer(c_int32_t) :: status
  integer :: ix, iy

  do iy = 1, M
    do ix = 1, M
      h(ix, iy) = 0.0016681_c_double*((ix - 0.5_c_double)*DX - 10)**2 + 0.0030671_c_double*((iy - 0.5_c_double)*DY - 6)**2
    end do
  end do
  call contact_normal_scene_init(scene)
  call contact_normal_report_init(report)
  scene%mx = M
  scene%my = M
  scene%dx = DX
  scene%dy = DY
  call contact_normal_set_undeformed_distance(scene, h)
  scene%shear_modulus = 82000
  scene%poisson_ratio = 0.28_c_double
  scene%approach = 0.1091_c_double
  status = contact_normal_solve(scene, report=report)
  if (status /= CONTACT_NORMAL_OK) error stop "contact_normal_solve"
  print '(a, i0, a)', "force ", nint(report%normal%force), " N"
end subroutine force
