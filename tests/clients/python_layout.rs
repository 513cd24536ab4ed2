//! The Python package: its structs have the layout of the library's, its constants and prototypes are those of the header.

use std::collections::BTreeMap;
use std::mem::offset_of;

use crate::python::python_in;
use crate::support::{root, run, scratch};
use contact_normal::ffi::*;

macro_rules! layout {
    ($into:ident, $python:literal, $kind:ty, $($member:ident),+) => {
        $into.insert(format!("{} sizeof", $python), size_of::<$kind>());
        $($into.insert(format!("{}.{}", $python, stringify!($member)), offset_of!($kind, $member));)+
    };
}

#[test]
fn ctypes_structs_have_the_layout_of_the_library() {
    let mut ours: BTreeMap<String, usize> = BTreeMap::new();
    layout!(ours, "Influence", contact_normal_influence, struct_size, cx, cy, coefficients, scale);
    layout!(
        ours,
        "Scene",
        contact_normal_scene,
        struct_size,
        mx,
        my,
        dx,
        dy,
        undeformed_distance,
        shear_modulus,
        poisson_ratio,
        load,
        reserved,
        approach,
        force,
        influence,
        layer,
        pressure_limit,
        period,
        patches,
        row_tables,
        coating,
        friction
    );
    layout!(
        ours,
        "Friction",
        contact_normal_friction,
        struct_size,
        coefficient,
        coefficients,
        motion,
        continues,
        prescribed,
        creepage,
        spin,
        spin_centre,
        force,
        rolling_distance,
        rolling_direction,
        spin_offset,
        previous_traction,
        rigid_slip,
        influence,
        influence_cx,
        influence_cy,
        influence_scale,
        sensitivities,
        reserved,
        influence_cross
    );
    layout!(ours, "Coating", contact_normal_coating, struct_size, thickness, shear_modulus, poisson_ratio);
    layout!(ours, "RowTables", contact_normal_row_tables, struct_size, cx, rows, coefficients, scale);
    layout!(ours, "Patches", contact_normal_patches, struct_size, count, reserved, patch, factors);
    layout!(ours, "StressMaximum", contact_normal_stress_maximum, value, x, y, z, ix, iy, depth, reserved);
    layout!(
        ours,
        "StressOutputs",
        contact_normal_stress_outputs,
        struct_size,
        stress,
        von_mises,
        maximum_shear,
        principal,
        directions,
        largest_von_mises,
        largest_shear
    );
    layout!(ours, "Layer", contact_normal_layer, struct_size, compliance, compliances);
    layout!(ours, "PressureLimit", contact_normal_pressure_limit, struct_size, limit, limits);
    layout!(ours, "Period", contact_normal_period, struct_size, x, y);
    layout!(
        ours,
        "Options",
        contact_normal_options,
        struct_size,
        method,
        smoother,
        pre_sweeps,
        post_sweeps,
        relaxation,
        coarsest,
        active_set,
        initial_guess,
        criterion,
        tolerance,
        error_ratio,
        max_cycles,
        threads,
        precision,
        reserved,
        progress,
        user
    );
    layout!(
        ours,
        "Fields",
        contact_normal_fields,
        struct_size,
        pressure,
        deformed_distance,
        displacement,
        contact,
        traction,
        slip,
        adhesion
    );
    layout!(
        ours,
        "LedgerRow",
        contact_normal_ledger_row,
        mx,
        my,
        cycles,
        seconds,
        work_units,
        residual,
        approach,
        force,
        max_pressure,
        contact_area,
        corrected_area,
        error_force,
        error_max_pressure,
        error_contact_area,
        error_corrected_area,
        error_pressure,
        contact_count,
        untrusted,
        reserved
    );
    layout!(
        ours,
        "Report",
        contact_normal_report,
        struct_size,
        cycles,
        active_set_steps,
        active_set_changes,
        matrix_products,
        work_units,
        update,
        residual,
        violation,
        complementarity,
        min_pressure,
        approach,
        force,
        max_pressure,
        contact_area,
        contact_count,
        error_force,
        error_max_pressure,
        error_contact_area,
        setup_seconds,
        solve_seconds,
        bytes,
        ledger_rows,
        ledger_capacity,
        ledger,
        corrected_area,
        error_corrected_area,
        error_pressure,
        untrusted,
        limited_by,
        halved_seconds,
        halved_error_force,
        edge_count,
        tolerance,
        tangential_force,
        tangential_moment,
        creepage,
        tangential_residual,
        tangential_gap,
        stick_count,
        slip_count,
        tangential_products,
        tangential_seconds,
        sensitivities,
        error_tangential
    );
    layout!(
        ours,
        "Progress",
        contact_normal_progress,
        struct_size,
        mx,
        my,
        cycles,
        active_set_changes,
        seconds,
        work_units,
        update,
        residual
    );
    layout!(
        ours,
        "FrictionResults",
        contact_normal_friction_results,
        struct_size,
        force,
        moment,
        creepage,
        residual,
        gap,
        products,
        stick_count,
        slip_count,
        status,
        traction,
        slip,
        adhesion
    );
    layout!(
        ours,
        "Accuracy",
        contact_normal_accuracy,
        struct_size,
        target,
        max_seconds,
        max_bytes,
        max_elements,
        surface,
        user,
        mx,
        my,
        dx,
        dy,
        reached,
        seconds,
        max_pressure_target,
        contact_area_target
    );
    layout!(
        ours,
        "Price",
        contact_normal_price,
        target,
        error,
        tolerance,
        seconds,
        seconds_one_thread,
        bytes,
        mx,
        my,
        dx,
        dy,
        obstacle,
        reserved
    );
    layout!(
        ours,
        "HertzSolution",
        contact_normal_hertz_solution,
        semi_axis_x,
        semi_axis_y,
        max_pressure,
        approach,
        force,
        area
    );
    let script = "
import ctypes, contact_normal._structs
for name, kind in vars(contact_normal._structs).items():
    if isinstance(kind, type) and issubclass(kind, ctypes.Structure):
        print(f'{name} sizeof:{ctypes.sizeof(kind)}')
        for member, _ in kind._fields_:
            print(f'{name}.{member}:{getattr(kind, member).offset}')
";
    let printed = run(python_in(&scratch("python_layout")).args(["-c", script]));
    let theirs: BTreeMap<String, usize> = printed
        .lines()
        .map(|line| line.split_once(':').expect("name:number"))
        .map(|(name, number)| (name.to_owned(), number.parse().expect("a number")))
        .collect();
    assert_eq!(theirs, ours);
}

#[test]
fn constants_and_prototypes_are_those_of_the_header() {
    let header = std::fs::read_to_string(root().join("include/contact_normal.h")).expect("the header");
    let script = "
import contact_normal, contact_normal._library
for name, value in vars(contact_normal).items():
    if name.isupper() and isinstance(value, int) and not name.startswith('_'):
        print('#define CONTACT_NORMAL_' + name, value)
for name in contact_normal._library.PROTOTYPES:
    print('contact_normal_' + name + '(')
";
    let mut theirs: Vec<String> =
        run(python_in(&scratch("python_constants")).args(["-c", script])).lines().map(str::to_owned).collect();
    let mut ours: Vec<String> = header
        .lines()
        .filter(|line| line.starts_with("#define CONTACT_NORMAL_") && line.split(' ').count() == 3)
        .map(str::to_owned)
        .collect();
    // A prototype begins in the first column; members and comments do not.
    ours.extend(
        header
            .lines()
            .filter(|line| line.contains("contact_normal_") && !line.starts_with([' ', '#', '*', '}', '/']))
            .filter(|line| !line.starts_with("typedef"))
            .filter_map(|line| line.split_once('('))
            .map(|(before, _)| format!("{}(", before.rsplit([' ', '*']).next().expect("a name"))),
    );
    theirs.sort();
    ours.sort();
    let only = |these: &[String], those: &[String]| -> Vec<String> {
        these.iter().filter(|name| !those.contains(name)).cloned().collect()
    };
    assert_eq!((only(&theirs, &ours), only(&ours, &theirs)), (vec![], vec![]), "only in Python, only in the header");
}
