! Effect `layer`: a steel ball of radius 500 mm is pressed by 1000 N onto a steel plate with a thin layer. The more compliant the layer is, the
! larger is the contact area.
program layer_example
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t
  use contact_normal
  implicit none
  integer(c_int32_t), parameter :: M = 64
  real(c_double), parameter :: COMPLIANCES(4) = [0e0_c_double, 1e-6_c_double, 1e-5_c_double, 1e-4_c_double]
  type(contact_normal_scene) :: scene
  type(contact_normal_layer), target :: layer
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  real(c_double), target :: h(M, M)
  integer :: ix, iy, i

  call contact_normal_scene_init(scene)
  call contact_normal_fields_init(fields)
  call contact_normal_report_init(report)
  scene%mx = M
  scene%my = M
  scene%dx = 0.1_c_double
  scene%dy = 0.1_c_double
  do iy = 1, M
    do ix = 1, M
      h(ix, iy) = (((ix - 0.5_c_double*(M + 1))*scene%dx)**2 + ((iy - 0.5_c_double*(M + 1))*scene%dy)**2)/1000
    end do
  end do
  call contact_normal_set_undeformed_distance(scene, h)
  scene%shear_modulus = 82000
  scene%poisson_ratio = 0.28_c_double
  scene%force = 1000
  print '(a)', "compliance   approach  max pressure  contact area"
  do i = 1, size(COMPLIANCES)
    call contact_normal_set_layer(scene, layer, compliance=COMPLIANCES(i))
    if (contact_normal_solve(scene, fields=fields, report=report) /= CONTACT_NORMAL_OK) then
      print '(a)', contact_normal_last_error_message()
      error stop 1
    end if
    print '(es10.1, f11.6, 2f14.2)', COMPLIANCES(i), report%normal%approach, report%normal%max_pressure, report%normal%contact_area
  end do
end program layer_example
