/* The size of every struct of the ABI and the offset of every member, as a C compiler sees them. */
#include <stddef.h>
#include <stdio.h>

#include "contact_normal.h"

#define SIZE(type) printf("%s %u\n", #type, (unsigned)sizeof(type))
#define OFFSET(type, member) printf("%s.%s %u\n", #type, #member, (unsigned)offsetof(type, member))

int main(void)
{
    SIZE(contact_normal_influence);
    OFFSET(contact_normal_influence, struct_size);
    OFFSET(contact_normal_influence, cx);
    OFFSET(contact_normal_influence, cy);
    OFFSET(contact_normal_influence, coefficients);
    SIZE(contact_normal_scene);
    OFFSET(contact_normal_scene, struct_size);
    OFFSET(contact_normal_scene, mx);
    OFFSET(contact_normal_scene, my);
    OFFSET(contact_normal_scene, dx);
    OFFSET(contact_normal_scene, dy);
    OFFSET(contact_normal_scene, undeformed_distance);
    OFFSET(contact_normal_scene, shear_modulus);
    OFFSET(contact_normal_scene, poisson_ratio);
    OFFSET(contact_normal_scene, load);
    OFFSET(contact_normal_scene, reserved);
    OFFSET(contact_normal_scene, approach);
    OFFSET(contact_normal_scene, force);
    OFFSET(contact_normal_scene, influence);
    SIZE(contact_normal_progress);
    OFFSET(contact_normal_progress, struct_size);
    OFFSET(contact_normal_progress, mx);
    OFFSET(contact_normal_progress, my);
    OFFSET(contact_normal_progress, cycles);
    OFFSET(contact_normal_progress, active_set_changes);
    OFFSET(contact_normal_progress, seconds);
    OFFSET(contact_normal_progress, work_units);
    OFFSET(contact_normal_progress, update);
    OFFSET(contact_normal_progress, residual);
    SIZE(contact_normal_options);
    OFFSET(contact_normal_options, struct_size);
    OFFSET(contact_normal_options, method);
    OFFSET(contact_normal_options, smoother);
    OFFSET(contact_normal_options, pre_sweeps);
    OFFSET(contact_normal_options, post_sweeps);
    OFFSET(contact_normal_options, relaxation);
    OFFSET(contact_normal_options, coarsest);
    OFFSET(contact_normal_options, active_set);
    OFFSET(contact_normal_options, initial_guess);
    OFFSET(contact_normal_options, criterion);
    OFFSET(contact_normal_options, tolerance);
    OFFSET(contact_normal_options, error_ratio);
    OFFSET(contact_normal_options, max_cycles);
    OFFSET(contact_normal_options, threads);
    OFFSET(contact_normal_options, precision);
    OFFSET(contact_normal_options, reserved);
    OFFSET(contact_normal_options, progress);
    OFFSET(contact_normal_options, user);
    SIZE(contact_normal_fields);
    OFFSET(contact_normal_fields, struct_size);
    OFFSET(contact_normal_fields, pressure);
    OFFSET(contact_normal_fields, deformed_distance);
    OFFSET(contact_normal_fields, displacement);
    OFFSET(contact_normal_fields, contact);
    SIZE(contact_normal_ledger_row);
    OFFSET(contact_normal_ledger_row, mx);
    OFFSET(contact_normal_ledger_row, my);
    OFFSET(contact_normal_ledger_row, cycles);
    OFFSET(contact_normal_ledger_row, seconds);
    OFFSET(contact_normal_ledger_row, work_units);
    OFFSET(contact_normal_ledger_row, residual);
    OFFSET(contact_normal_ledger_row, approach);
    OFFSET(contact_normal_ledger_row, force);
    OFFSET(contact_normal_ledger_row, max_pressure);
    OFFSET(contact_normal_ledger_row, contact_area);
    OFFSET(contact_normal_ledger_row, error_force);
    OFFSET(contact_normal_ledger_row, error_max_pressure);
    OFFSET(contact_normal_ledger_row, error_contact_area);
    SIZE(contact_normal_report);
    OFFSET(contact_normal_report, struct_size);
    OFFSET(contact_normal_report, cycles);
    OFFSET(contact_normal_report, active_set_steps);
    OFFSET(contact_normal_report, active_set_changes);
    OFFSET(contact_normal_report, matrix_products);
    OFFSET(contact_normal_report, work_units);
    OFFSET(contact_normal_report, update);
    OFFSET(contact_normal_report, residual);
    OFFSET(contact_normal_report, penetration);
    OFFSET(contact_normal_report, complementarity);
    OFFSET(contact_normal_report, min_pressure);
    OFFSET(contact_normal_report, approach);
    OFFSET(contact_normal_report, force);
    OFFSET(contact_normal_report, max_pressure);
    OFFSET(contact_normal_report, contact_area);
    OFFSET(contact_normal_report, contact_count);
    OFFSET(contact_normal_report, error_force);
    OFFSET(contact_normal_report, error_max_pressure);
    OFFSET(contact_normal_report, error_contact_area);
    OFFSET(contact_normal_report, setup_seconds);
    OFFSET(contact_normal_report, solve_seconds);
    OFFSET(contact_normal_report, bytes);
    OFFSET(contact_normal_report, ledger_rows);
    OFFSET(contact_normal_report, ledger_capacity);
    OFFSET(contact_normal_report, ledger);
    SIZE(contact_normal_accuracy);
    OFFSET(contact_normal_accuracy, struct_size);
    OFFSET(contact_normal_accuracy, target);
    OFFSET(contact_normal_accuracy, max_seconds);
    OFFSET(contact_normal_accuracy, max_bytes);
    OFFSET(contact_normal_accuracy, max_elements);
    OFFSET(contact_normal_accuracy, surface);
    OFFSET(contact_normal_accuracy, user);
    OFFSET(contact_normal_accuracy, mx);
    OFFSET(contact_normal_accuracy, my);
    OFFSET(contact_normal_accuracy, dx);
    OFFSET(contact_normal_accuracy, dy);
    OFFSET(contact_normal_accuracy, reached);
    OFFSET(contact_normal_accuracy, seconds);
    SIZE(contact_normal_hertz_solution);
    OFFSET(contact_normal_hertz_solution, semi_axis_x);
    OFFSET(contact_normal_hertz_solution, semi_axis_y);
    OFFSET(contact_normal_hertz_solution, max_pressure);
    OFFSET(contact_normal_hertz_solution, approach);
    OFFSET(contact_normal_hertz_solution, force);
    OFFSET(contact_normal_hertz_solution, area);
    return 0;
}
