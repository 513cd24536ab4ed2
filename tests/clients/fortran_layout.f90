! Prints the size of every derived type of the module, and the offset of every component.
program fortran_layout
  use, intrinsic :: iso_c_binding
  use contact_normal
  implicit none
  type(contact_normal_influence), target :: influence
  type(contact_normal_layer), target :: layer
  type(contact_normal_pressure_limit), target :: limit
  type(contact_normal_period), target :: period
  type(contact_normal_patches), target :: patches
  type(contact_normal_row_tables), target :: row_tables
  type(contact_normal_scene), target :: scene
  type(contact_normal_options), target :: options
  type(contact_normal_progress), target :: progress
  type(contact_normal_fields), target :: fields
  type(contact_normal_ledger_row), target :: row
  type(contact_normal_report), target :: report
  type(contact_normal_accuracy), target :: accuracy
  type(contact_normal_price), target :: price
  type(contact_normal_hertz_solution), target :: solution
  type(contact_normal_coating), target :: coating
  type(contact_normal_stress_maximum), target :: largest
  type(contact_normal_stress_outputs), target :: outputs
  integer(c_intptr_t) :: base

  base = place(c_loc(influence))
  print '(a, i0)', "contact_normal_influence ", c_sizeof(influence)
  call show("contact_normal_influence.struct_size", c_loc(influence%struct_size))
  call show("contact_normal_influence.cx", c_loc(influence%cx))
  call show("contact_normal_influence.cy", c_loc(influence%cy))
  call show("contact_normal_influence.coefficients", c_loc(influence%coefficients))
  call show("contact_normal_influence.scale", c_loc(influence%scale))

  base = place(c_loc(layer))
  print '(a, i0)', "contact_normal_layer ", c_sizeof(layer)
  call show("contact_normal_layer.struct_size", c_loc(layer%struct_size))
  call show("contact_normal_layer.compliance", c_loc(layer%compliance))
  call show("contact_normal_layer.compliances", c_loc(layer%compliances))

  base = place(c_loc(limit))
  print '(a, i0)', "contact_normal_pressure_limit ", c_sizeof(limit)
  call show("contact_normal_pressure_limit.struct_size", c_loc(limit%struct_size))
  call show("contact_normal_pressure_limit.limit", c_loc(limit%limit))
  call show("contact_normal_pressure_limit.limits", c_loc(limit%limits))

  base = place(c_loc(period))
  print '(a, i0)', "contact_normal_period ", c_sizeof(period)
  call show("contact_normal_period.struct_size", c_loc(period%struct_size))
  call show("contact_normal_period.x", c_loc(period%x))
  call show("contact_normal_period.y", c_loc(period%y))

  base = place(c_loc(patches))
  print '(a, i0)', "contact_normal_patches ", c_sizeof(patches)
  call show("contact_normal_patches.struct_size", c_loc(patches%struct_size))
  call show("contact_normal_patches.count", c_loc(patches%count))
  call show("contact_normal_patches.reserved", c_loc(patches%reserved))
  call show("contact_normal_patches.patch", c_loc(patches%patch))
  call show("contact_normal_patches.factors", c_loc(patches%factors))

  base = place(c_loc(row_tables))
  print '(a, i0)', "contact_normal_row_tables ", c_sizeof(row_tables)
  call show("contact_normal_row_tables.struct_size", c_loc(row_tables%struct_size))
  call show("contact_normal_row_tables.cx", c_loc(row_tables%cx))
  call show("contact_normal_row_tables.rows", c_loc(row_tables%rows))
  call show("contact_normal_row_tables.coefficients", c_loc(row_tables%coefficients))
  call show("contact_normal_row_tables.scale", c_loc(row_tables%scale))

  base = place(c_loc(scene))
  print '(a, i0)', "contact_normal_scene ", c_sizeof(scene)
  call show("contact_normal_scene.struct_size", c_loc(scene%struct_size))
  call show("contact_normal_scene.mx", c_loc(scene%mx))
  call show("contact_normal_scene.my", c_loc(scene%my))
  call show("contact_normal_scene.dx", c_loc(scene%dx))
  call show("contact_normal_scene.dy", c_loc(scene%dy))
  call show("contact_normal_scene.undeformed_distance", c_loc(scene%undeformed_distance))
  call show("contact_normal_scene.shear_modulus", c_loc(scene%shear_modulus))
  call show("contact_normal_scene.poisson_ratio", c_loc(scene%poisson_ratio))
  call show("contact_normal_scene.load", c_loc(scene%load))
  call show("contact_normal_scene.reserved", c_loc(scene%reserved))
  call show("contact_normal_scene.approach", c_loc(scene%approach))
  call show("contact_normal_scene.force", c_loc(scene%force))
  call show("contact_normal_scene.influence", c_loc(scene%influence))
  call show("contact_normal_scene.layer", c_loc(scene%layer))
  call show("contact_normal_scene.pressure_limit", c_loc(scene%pressure_limit))
  call show("contact_normal_scene.period", c_loc(scene%period))
  call show("contact_normal_scene.patches", c_loc(scene%patches))
  call show("contact_normal_scene.row_tables", c_loc(scene%row_tables))
  call show("contact_normal_scene.coating", c_loc(scene%coating))

  base = place(c_loc(options))
  print '(a, i0)', "contact_normal_options ", c_sizeof(options)
  call show("contact_normal_options.struct_size", c_loc(options%struct_size))
  call show("contact_normal_options.method", c_loc(options%method))
  call show("contact_normal_options.smoother", c_loc(options%smoother))
  call show("contact_normal_options.pre_sweeps", c_loc(options%pre_sweeps))
  call show("contact_normal_options.post_sweeps", c_loc(options%post_sweeps))
  call show("contact_normal_options.relaxation", c_loc(options%relaxation))
  call show("contact_normal_options.coarsest", c_loc(options%coarsest))
  call show("contact_normal_options.active_set", c_loc(options%active_set))
  call show("contact_normal_options.initial_guess", c_loc(options%initial_guess))
  call show("contact_normal_options.criterion", c_loc(options%criterion))
  call show("contact_normal_options.tolerance", c_loc(options%tolerance))
  call show("contact_normal_options.error_ratio", c_loc(options%error_ratio))
  call show("contact_normal_options.max_cycles", c_loc(options%max_cycles))
  call show("contact_normal_options.threads", c_loc(options%threads))
  call show("contact_normal_options.precision", c_loc(options%precision))
  call show("contact_normal_options.reserved", c_loc(options%reserved))
  call show("contact_normal_options.progress", c_loc(options%progress))
  call show("contact_normal_options.user", c_loc(options%user))

  base = place(c_loc(progress))
  print '(a, i0)', "contact_normal_progress ", c_sizeof(progress)
  call show("contact_normal_progress.struct_size", c_loc(progress%struct_size))
  call show("contact_normal_progress.mx", c_loc(progress%mx))
  call show("contact_normal_progress.my", c_loc(progress%my))
  call show("contact_normal_progress.cycles", c_loc(progress%cycles))
  call show("contact_normal_progress.active_set_changes", c_loc(progress%active_set_changes))
  call show("contact_normal_progress.seconds", c_loc(progress%seconds))
  call show("contact_normal_progress.work_units", c_loc(progress%work_units))
  call show("contact_normal_progress.update", c_loc(progress%update))
  call show("contact_normal_progress.residual", c_loc(progress%residual))

  base = place(c_loc(fields))
  print '(a, i0)', "contact_normal_fields ", c_sizeof(fields)
  call show("contact_normal_fields.struct_size", c_loc(fields%struct_size))
  call show("contact_normal_fields.pressure", c_loc(fields%pressure))
  call show("contact_normal_fields.deformed_distance", c_loc(fields%deformed_distance))
  call show("contact_normal_fields.displacement", c_loc(fields%displacement))
  call show("contact_normal_fields.contact", c_loc(fields%contact))

  base = place(c_loc(row))
  print '(a, i0)', "contact_normal_ledger_row ", c_sizeof(row)
  call show("contact_normal_ledger_row.mx", c_loc(row%mx))
  call show("contact_normal_ledger_row.my", c_loc(row%my))
  call show("contact_normal_ledger_row.cycles", c_loc(row%cycles))
  call show("contact_normal_ledger_row.seconds", c_loc(row%seconds))
  call show("contact_normal_ledger_row.work_units", c_loc(row%work_units))
  call show("contact_normal_ledger_row.residual", c_loc(row%residual))
  call show("contact_normal_ledger_row.approach", c_loc(row%approach))
  call show("contact_normal_ledger_row.force", c_loc(row%force))
  call show("contact_normal_ledger_row.max_pressure", c_loc(row%max_pressure))
  call show("contact_normal_ledger_row.contact_area", c_loc(row%contact_area))
  call show("contact_normal_ledger_row.corrected_area", c_loc(row%corrected_area))
  call show("contact_normal_ledger_row.error_force", c_loc(row%error_force))
  call show("contact_normal_ledger_row.error_max_pressure", c_loc(row%error_max_pressure))
  call show("contact_normal_ledger_row.error_contact_area", c_loc(row%error_contact_area))
  call show("contact_normal_ledger_row.error_corrected_area", c_loc(row%error_corrected_area))
  call show("contact_normal_ledger_row.error_pressure", c_loc(row%error_pressure))
  call show("contact_normal_ledger_row.contact_count", c_loc(row%contact_count))
  call show("contact_normal_ledger_row.untrusted", c_loc(row%untrusted))
  call show("contact_normal_ledger_row.reserved", c_loc(row%reserved))

  base = place(c_loc(report))
  print '(a, i0)', "contact_normal_report ", c_sizeof(report)
  call show("contact_normal_report.struct_size", c_loc(report%struct_size))
  call show("contact_normal_report.cycles", c_loc(report%cycles))
  call show("contact_normal_report.active_set_steps", c_loc(report%active_set_steps))
  call show("contact_normal_report.active_set_changes", c_loc(report%active_set_changes))
  call show("contact_normal_report.matrix_products", c_loc(report%matrix_products))
  call show("contact_normal_report.work_units", c_loc(report%work_units))
  call show("contact_normal_report.update", c_loc(report%update))
  call show("contact_normal_report.residual", c_loc(report%residual))
  call show("contact_normal_report.penetration", c_loc(report%penetration))
  call show("contact_normal_report.complementarity", c_loc(report%complementarity))
  call show("contact_normal_report.min_pressure", c_loc(report%min_pressure))
  call show("contact_normal_report.approach", c_loc(report%approach))
  call show("contact_normal_report.force", c_loc(report%force))
  call show("contact_normal_report.max_pressure", c_loc(report%max_pressure))
  call show("contact_normal_report.contact_area", c_loc(report%contact_area))
  call show("contact_normal_report.contact_count", c_loc(report%contact_count))
  call show("contact_normal_report.error_force", c_loc(report%error_force))
  call show("contact_normal_report.error_max_pressure", c_loc(report%error_max_pressure))
  call show("contact_normal_report.error_contact_area", c_loc(report%error_contact_area))
  call show("contact_normal_report.setup_seconds", c_loc(report%setup_seconds))
  call show("contact_normal_report.solve_seconds", c_loc(report%solve_seconds))
  call show("contact_normal_report.bytes", c_loc(report%bytes))
  call show("contact_normal_report.ledger_rows", c_loc(report%ledger_rows))
  call show("contact_normal_report.ledger_capacity", c_loc(report%ledger_capacity))
  call show("contact_normal_report.ledger", c_loc(report%ledger))
  call show("contact_normal_report.corrected_area", c_loc(report%corrected_area))
  call show("contact_normal_report.error_corrected_area", c_loc(report%error_corrected_area))
  call show("contact_normal_report.error_pressure", c_loc(report%error_pressure))
  call show("contact_normal_report.untrusted", c_loc(report%untrusted))
  call show("contact_normal_report.limited_by", c_loc(report%limited_by))
  call show("contact_normal_report.halved_seconds", c_loc(report%halved_seconds))
  call show("contact_normal_report.halved_error_force", c_loc(report%halved_error_force))
  call show("contact_normal_report.edge_count", c_loc(report%edge_count))
  call show("contact_normal_report.tolerance", c_loc(report%tolerance))

  base = place(c_loc(accuracy))
  print '(a, i0)', "contact_normal_accuracy ", c_sizeof(accuracy)
  call show("contact_normal_accuracy.struct_size", c_loc(accuracy%struct_size))
  call show("contact_normal_accuracy.target", c_loc(accuracy%target))
  call show("contact_normal_accuracy.max_seconds", c_loc(accuracy%max_seconds))
  call show("contact_normal_accuracy.max_bytes", c_loc(accuracy%max_bytes))
  call show("contact_normal_accuracy.max_elements", c_loc(accuracy%max_elements))
  call show("contact_normal_accuracy.surface", c_loc(accuracy%surface))
  call show("contact_normal_accuracy.user", c_loc(accuracy%user))
  call show("contact_normal_accuracy.mx", c_loc(accuracy%mx))
  call show("contact_normal_accuracy.my", c_loc(accuracy%my))
  call show("contact_normal_accuracy.dx", c_loc(accuracy%dx))
  call show("contact_normal_accuracy.dy", c_loc(accuracy%dy))
  call show("contact_normal_accuracy.reached", c_loc(accuracy%reached))
  call show("contact_normal_accuracy.seconds", c_loc(accuracy%seconds))
  call show("contact_normal_accuracy.max_pressure_target", c_loc(accuracy%max_pressure_target))
  call show("contact_normal_accuracy.contact_area_target", c_loc(accuracy%contact_area_target))

  base = place(c_loc(price))
  print '(a, i0)', "contact_normal_price ", c_sizeof(price)
  call show("contact_normal_price.target", c_loc(price%target))
  call show("contact_normal_price.error", c_loc(price%error))
  call show("contact_normal_price.tolerance", c_loc(price%tolerance))
  call show("contact_normal_price.seconds", c_loc(price%seconds))
  call show("contact_normal_price.seconds_one_thread", c_loc(price%seconds_one_thread))
  call show("contact_normal_price.bytes", c_loc(price%bytes))
  call show("contact_normal_price.mx", c_loc(price%mx))
  call show("contact_normal_price.my", c_loc(price%my))
  call show("contact_normal_price.dx", c_loc(price%dx))
  call show("contact_normal_price.dy", c_loc(price%dy))
  call show("contact_normal_price.obstacle", c_loc(price%obstacle))
  call show("contact_normal_price.reserved", c_loc(price%reserved))

  base = place(c_loc(solution))
  print '(a, i0)', "contact_normal_hertz_solution ", c_sizeof(solution)
  call show("contact_normal_hertz_solution.semi_axis_x", c_loc(solution%semi_axis_x))
  call show("contact_normal_hertz_solution.semi_axis_y", c_loc(solution%semi_axis_y))
  call show("contact_normal_hertz_solution.max_pressure", c_loc(solution%max_pressure))
  call show("contact_normal_hertz_solution.approach", c_loc(solution%approach))
  call show("contact_normal_hertz_solution.force", c_loc(solution%force))
  call show("contact_normal_hertz_solution.area", c_loc(solution%area))

  base = place(c_loc(coating))
  print '(a, i0)', "contact_normal_coating ", c_sizeof(coating)
  call show("contact_normal_coating.struct_size", c_loc(coating%struct_size))
  call show("contact_normal_coating.thickness", c_loc(coating%thickness))
  call show("contact_normal_coating.shear_modulus", c_loc(coating%shear_modulus))
  call show("contact_normal_coating.poisson_ratio", c_loc(coating%poisson_ratio))

  base = place(c_loc(largest))
  print '(a, i0)', "contact_normal_stress_maximum ", c_sizeof(largest)
  call show("contact_normal_stress_maximum.value", c_loc(largest%value))
  call show("contact_normal_stress_maximum.x", c_loc(largest%x))
  call show("contact_normal_stress_maximum.y", c_loc(largest%y))
  call show("contact_normal_stress_maximum.z", c_loc(largest%z))
  call show("contact_normal_stress_maximum.ix", c_loc(largest%ix))
  call show("contact_normal_stress_maximum.iy", c_loc(largest%iy))
  call show("contact_normal_stress_maximum.depth", c_loc(largest%depth))
  call show("contact_normal_stress_maximum.reserved", c_loc(largest%reserved))

  base = place(c_loc(outputs))
  print '(a, i0)', "contact_normal_stress_outputs ", c_sizeof(outputs)
  call show("contact_normal_stress_outputs.struct_size", c_loc(outputs%struct_size))
  call show("contact_normal_stress_outputs.stress", c_loc(outputs%stress))
  call show("contact_normal_stress_outputs.von_mises", c_loc(outputs%von_mises))
  call show("contact_normal_stress_outputs.maximum_shear", c_loc(outputs%maximum_shear))
  call show("contact_normal_stress_outputs.principal", c_loc(outputs%principal))
  call show("contact_normal_stress_outputs.directions", c_loc(outputs%directions))
  call show("contact_normal_stress_outputs.largest_von_mises", c_loc(outputs%largest_von_mises))
  call show("contact_normal_stress_outputs.largest_shear", c_loc(outputs%largest_shear))

contains

  function place(pointer) result(address)
    type(c_ptr), intent(in) :: pointer
    integer(c_intptr_t) :: address
    address = transfer(pointer, address)
  end function

  subroutine show(name, pointer)
    character(*), intent(in) :: name
    type(c_ptr), intent(in) :: pointer
    print '(2a, i0)', name, " ", place(pointer) - base
  end subroutine

end program fortran_layout
