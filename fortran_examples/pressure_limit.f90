! Effect `pressure_limit`: a steel ball of radius 50 mm is pressed into a surface with a hardness of 1200 N/mm2. Where this limit is reached, the
! surface yields. The dent is the plastic penetration.
program pressure_limit_example
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use contact_normal
  implicit none
  integer(c_int32_t), parameter :: M = 64
  real(c_double), parameter :: FORCES(3) = [500, 2000, 4000]
  type(contact_normal_scene) :: scene
  type(contact_normal_pressure_limit), target :: limit
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  real(c_double), target :: h(M, M), e(M, M)
  integer(c_int32_t), target :: contact(M, M)
  integer :: ix, iy, i

  call contact_normal_scene_init(scene)
  call contact_normal_fields_init(fields)
  call contact_normal_report_init(report)
  scene%mx = M
  scene%my = M
  scene%dx = 0.05_c_double
  scene%dy = 0.05_c_double
  do iy = 1, M
    do ix = 1, M
      h(ix, iy) = (((ix - 0.5_c_double*(M + 1))*scene%dx)**2 + ((iy - 0.5_c_double*(M + 1))*scene%dy)**2)/100
    end do
  end do
  call contact_normal_set_undeformed_distance(scene, h)
  call contact_normal_set_fields(fields, contact=contact, deformed_distance=e)
  scene%shear_modulus = 82000
  scene%poisson_ratio = 0.28_c_double
  call contact_normal_set_pressure_limit(scene, limit, limit=1200.0_c_double)
  print '(a)', "   force  max pressure  contact area  at the limit      dent"
  do i = 1, size(FORCES)
    scene%force = FORCES(i)
    if (contact_normal_solve(scene, fields=fields, report=report) /= CONTACT_NORMAL_OK) then
      print '(a)', contact_normal_last_error_message()
      error stop 1
    end if
    print '(f8.0, f14.2, 2f14.4, f10.5)', scene%force, report%normal%max_pressure, report%normal%contact_area, &
      count(contact == 2)*scene%dx*scene%dy, max(0.0_c_double, maxval(-e, mask=contact == 2))
  end do
end program pressure_limit_example
