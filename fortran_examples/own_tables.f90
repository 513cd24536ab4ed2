! Friction with influence coefficients that the program computes: five tables by Kalker's formulas for half-spaces, for a steel ball on a softer body.
program own_tables
  use, intrinsic :: iso_c_binding, only: c_double, c_int32_t, c_loc, c_null_ptr
  use contact_normal
  implicit none
  integer, parameter :: dp = c_double
  integer(c_int32_t), parameter :: M = 24
  real(dp), parameter :: D = 0.09_dp, PI = acos(-1.0_dp), G(2) = [82000.0_dp, 20000.0_dp], NU(2) = [0.28_dp, 0.2_dp]
  real(dp), pointer, contiguous :: h(:, :), qx(:, :), qy(:, :), tables(:, :, :)
  type(contact_normal_scene), pointer :: scene
  type(contact_normal_friction), pointer :: friction
  type(contact_normal_influence), target :: named(5)
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
  real(dp), pointer, contiguous :: xx(:, :), yy(:, :), xy(:, :), xz(:, :), yz(:, :)
  real(dp) :: both, nu_of_both, k
  integer(c_int32_t) :: status
  integer :: i, ix, iy, own

  allocate (h(M, M), qx(M, M), qy(M, M), tables(-M:M - 1, -M:M - 1, 5), scene, friction)
  do iy = 1, M
    do ix = 1, M
      h(ix, iy) = (((ix - 0.5_dp*(M + 1))*D)**2 + ((iy - 0.5_dp*(M + 1))*D)**2)/100
    end do
  end do
  ! G, nu and K of both bodies together. The tables hold the coefficients times G.
  both = 2/sum(1/G)
  nu_of_both = 0.5_dp*both*sum(NU/G)
  k = 0.25_dp*both*((1 - 2*NU(1))/G(1) - (1 - 2*NU(2))/G(2))
  do i = 1, 5
    do iy = -M, M - 1
      do ix = -M, M - 1
        tables(ix, iy, i) = (corner(i, ix + 0.5_dp, iy + 0.5_dp) - corner(i, ix - 0.5_dp, iy + 0.5_dp) &
          - corner(i, ix + 0.5_dp, iy - 0.5_dp) + corner(i, ix - 0.5_dp, iy - 0.5_dp))/PI
      end do
    end do
  end do
  tables(:, :, 4:5) = k*tables(:, :, 4:5)
  xx => tables(:, :, 1)
  yy => tables(:, :, 2)
  xy => tables(:, :, 3)
  xz => tables(:, :, 4)
  yz => tables(:, :, 5)

  do own = 0, 1
    call contact_normal_scene_init(scene)
    scene%mx = M
    scene%my = M
    scene%dx = D
    scene%dy = D
    scene%undeformed_distance = c_loc(h)
    scene%shear_modulus = G
    scene%poisson_ratio = NU
    scene%force = 500
    call contact_normal_set_friction(scene, friction, coefficient=0.3_dp)
    friction%creepage = [-1.2e-3_dp, 0.0_dp]
    if (own == 1) call contact_normal_set_tangential_influence(friction, named, xx, yy, xy, scale=1/both, xz=xz, yz=yz)
    call contact_normal_fields_init(fields)
    call contact_normal_set_friction_fields(fields, traction_x=qx, traction_y=qy)
    call contact_normal_report_init(report)
    status = contact_normal_solve(scene, fields=fields, report=report)
    if (status /= CONTACT_NORMAL_OK) error stop "contact_normal_solve failed"
    print '(a, f7.4, a, i0, a, i0, a)', merge("own tables: Fx/(mu N)", "half-space: Fx/(mu N)", own == 1), &
      report%tangential%force(1)/(0.3_dp*report%normal%force), ", ", &
      report%tangential%stick_count, " elements stick, ", report%tangential%slip_count, " slip"
  end do
  deallocate (h, qx, qy, tables, scene, friction)

contains

  ! The primitive of a coefficient, with (x, y) in elements. The coefficient is a sum over the corners of an element, with signs.
  real(dp) function corner(i, x_in_elements, y_in_elements) result(value)
    integer, intent(in) :: i
    real(dp), intent(in) :: x_in_elements, y_in_elements
    real(dp) :: x, y, r, a, b
    x = x_in_elements*D
    y = y_in_elements*D
    r = hypot(x, y)
    a = x*asinh(y/abs(x))
    b = y*asinh(x/abs(y))
    select case (i)
    case (1)
      value = (1 - nu_of_both)*a + b
    case (2)
      value = a + (1 - nu_of_both)*b
    case (3)
      value = -nu_of_both*r
    case (4)
      value = -(y*log(r) + x*atan(y/x))
    case default
      value = -(x*log(r) + y*atan(x/y))
    end select
  end function
end program own_tables
