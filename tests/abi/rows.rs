//! Bad input, one case in each row: the words of the message, the status, and the change of a valid call.

use std::ptr::{null, null_mut};

use crate::call::{Call, CX, CY, MX};
use contact_normal::ffi::*;

pub const NULL: i32 = CONTACT_NORMAL_NULL_POINTER;
pub const INVALID: i32 = CONTACT_NORMAL_INVALID_ARGUMENT;
pub const NOT_FINITE: i32 = CONTACT_NORMAL_NOT_FINITE;
pub const SIZE: i32 = CONTACT_NORMAL_STRUCT_SIZE;
pub const INFEASIBLE: i32 = CONTACT_NORMAL_INFEASIBLE;
pub const UNSUPPORTED: i32 = CONTACT_NORMAL_UNSUPPORTED;
pub const NOT_POSITIVE: i32 = CONTACT_NORMAL_NOT_POSITIVE_DEFINITE;
pub const INF: f64 = f64::INFINITY;
pub const NAN: f64 = f64::NAN;
pub const UNSET: i32 = CONTACT_NORMAL_PRESCRIBED_UNSET;
pub const APPROACH: i32 = CONTACT_NORMAL_PRESCRIBED_APPROACH;
pub const FORCE: i32 = CONTACT_NORMAL_PRESCRIBED_FORCE;
/// The factors of two patches.
pub const HALF: [f64; 4] = [1.0, 0.5, 0.5, 1.0];

/// Argument and value as in the message, the status, and the change that makes a valid call bad.
pub type Row = (&'static [&'static str], i32, fn(&mut Call));

/// Scene and options: refused by a solve, with or without a handle, and by the set-up of a handle.
#[rustfmt::skip]
pub const SET_UP: &[Row] = &[
    (&["scene"], NULL, |c| c.without = "scene"),
    (&["undeformed_distance"], NULL, |c| c.scene.known.undeformed_distance = null()),
    (&["coefficients"], NULL, |c| c.use_table().coefficients = null()),

    (&["mx", "0"], INVALID, |c| c.scene.known.mx = 0),
    (&["mx", "-6"], INVALID, |c| c.scene.known.mx = -6),
    (&["my", "0"], INVALID, |c| c.scene.known.my = 0),
    (&["my", "-2147483648"], INVALID, |c| c.scene.known.my = i32::MIN),
    (&["mx * my", "65536 * 32768"], INVALID, |c| (c.scene.known.mx, c.scene.known.my) = (65536, 32768)),
    (&["mx * my", "2147483647"], INVALID, |c| (c.scene.known.mx, c.scene.known.my) = (i32::MAX, i32::MAX)),
    (&["dx", "0"], INVALID, |c| c.scene.known.dx = 0.0),
    (&["dx", "-0.2"], INVALID, |c| c.scene.known.dx = -0.2),
    (&["dx", "NaN"], NOT_FINITE, |c| c.scene.known.dx = NAN),
    (&["dx", "inf"], NOT_FINITE, |c| c.scene.known.dx = INF),
    (&["dy", "0"], INVALID, |c| c.scene.known.dy = 0.0),
    (&["dy", "-0.2"], INVALID, |c| c.scene.known.dy = -0.2),
    (&["dy", "NaN"], NOT_FINITE, |c| c.scene.known.dy = NAN),
    (&["dy", "-inf"], NOT_FINITE, |c| c.scene.known.dy = -INF),
    (&["undeformed_distance", "(0, 0)", "NaN"], NOT_FINITE, |c| c.h[0] = NAN),
    (&["undeformed_distance", "(5, 4)", "NaN"], NOT_FINITE, |c| *c.h.last_mut().unwrap() = NAN),
    (&["undeformed_distance", "(1, 1)", "-inf"], NOT_FINITE, |c| c.h[MX + 1] = -INF),
    (&["shear_modulus[0]", "0"], INVALID, |c| c.scene.known.shear_modulus[0] = 0.0),
    (&["shear_modulus[1]", "-1"], INVALID, |c| c.scene.known.shear_modulus[1] = -1.0),
    (&["shear_modulus[1]", "-inf"], INVALID, |c| c.scene.known.shear_modulus[1] = -INF),
    (&["shear_modulus[0]", "NaN"], NOT_FINITE, |c| c.scene.known.shear_modulus[0] = NAN),
    (&["shear_modulus[1]", "NaN"], NOT_FINITE, |c| c.scene.known.shear_modulus[1] = NAN),
    (&["shear_modulus", "infinite", "both"], INVALID, |c| c.scene.known.shear_modulus = [INF; 2]),
    (&["poisson_ratio[0]", "-1"], INVALID, |c| c.scene.known.poisson_ratio[0] = -1.0),
    (&["poisson_ratio[1]", "0.51"], INVALID, |c| c.scene.known.poisson_ratio[1] = 0.51),
    (&["poisson_ratio[0]", "NaN"], NOT_FINITE, |c| c.scene.known.poisson_ratio[0] = NAN),
    (&["poisson_ratio[1]", "inf"], NOT_FINITE, |c| c.scene.known.poisson_ratio[1] = INF),
    // Poisson's ratio of a rigid body has no effect, but a NaN is still a mistake.
    (&["poisson_ratio[1]", "NaN"], NOT_FINITE, |c| {
        (c.scene.known.shear_modulus[1], c.scene.known.poisson_ratio[1]) = (INF, NAN);
    }),
    (&["load", "7"], INVALID, |c| c.scene.known.load = 7),
    (&["load", "-1"], INVALID, |c| c.scene.known.load = -1),
    (&["two loads", "approach 0.03", "force 100", "PRESCRIBED_FORCE"], INVALID, |c| c.scene.known.load = UNSET),
    (&["reserved", "3"], INVALID, |c| c.scene.known.reserved = 3),
    (&["approach", "NaN"], NOT_FINITE, |c| c.scene.known.approach = NAN),
    (&["approach", "inf"], NOT_FINITE, |c| c.scene.known.approach = INF),
    (&["force", "-5"], INVALID, |c| (c.scene.known.load, c.scene.known.force) = (FORCE, -5.0)),
    (&["force", "NaN"], NOT_FINITE, |c| (c.scene.known.load, c.scene.known.force) = (FORCE, NAN)),
    (&["force", "inf"], NOT_FINITE, |c| (c.scene.known.load, c.scene.known.force) = (FORCE, INF)),
    (&["force", "100", "undeformed_distance"], INFEASIBLE, |c| {
        c.scene.known.load = FORCE;
        c.h.fill(INF);
    }),

    (&["influence", "cx", "0"], INVALID, |c| c.use_table().cx = 0),
    (&["influence", "cy", "-7"], INVALID, |c| c.use_table().cy = -7),
    (&["influence", "cx", "5", "mx = 6"], INVALID, |c| c.use_table().cx = 5),
    (&["influence", "cy", "4", "my = 5"], INVALID, |c| c.use_table().cy = 4),
    (&["influence", "cx * cy", "2147483647"], INVALID, |c| (c.use_table().cx, c.use_table().cy) = (i32::MAX, i32::MAX)),
    (&["coefficients", "(-3, 2)", "NaN"], NOT_FINITE, |c| c.set_coefficient(-3, 2, NAN)),
    (&["coefficients", "(5, -4)", "inf"], NOT_FINITE, |c| c.set_coefficient(5, -4, INF)),
    (&["coefficients", "(0, 0)", "-0.001"], NOT_POSITIVE, |c| c.set_coefficient(0, 0, -0.001)),
    (&["coefficients", "(0, 0)", "0"], NOT_POSITIVE, |c| c.set_coefficient(0, 0, 0.0)),

    (&["layer->compliance", "-0.5"], INVALID, |c| c.use_layer().compliance = -0.5),
    (&["layer->compliance", "NaN"], NOT_FINITE, |c| c.use_layer().compliance = NAN),
    (&["layer->compliance", "inf"], NOT_FINITE, |c| c.use_layer().compliance = INF),
    (&["layer->compliances", "(1, 1)", "-2"], INVALID, |c| c.set_compliance(MX + 1, -2.0)),
    (&["layer->compliances", "(5, 4)", "NaN"], NOT_FINITE, |c| c.set_compliance(29, NAN)),
    (&["pressure_limit->limit", "0"], INVALID, |c| c.use_limit().limit = 0.0),
    (&["pressure_limit->limit", "-inf"], INVALID, |c| c.use_limit().limit = -INF),
    (&["pressure_limit->limit", "NaN"], NOT_FINITE, |c| c.use_limit().limit = NAN),
    (&["pressure_limit->limits", "(2, 0)", "-3"], INVALID, |c| c.set_limit(2, -3.0)),
    (&["pressure_limit->limits", "(0, 1)", "NaN"], NOT_FINITE, |c| c.set_limit(MX, NAN)),
    // 30 elements of 0.5 by 0.25 at a limit of 2 carry 7.5.
    (&["force", "100", "pressure_limit", "7.5"], INFEASIBLE, |c| { c.scene.known.load = FORCE; c.use_limit().limit = 2.0; }),
    (&["period->x", "2"], INVALID, |c| c.use_period(2, 0)),
    (&["period->y", "-1"], INVALID, |c| c.use_period(1, -1)),
    (&["period->x", "period->y", "0"], INVALID, |c| c.use_period(0, 0)),
    (&["patches->patch"], NULL, |c| c.use_patches(HALF).patch = null()),
    (&["patches->factors"], NULL, |c| c.use_patches(HALF).factors = null()),
    (&["patches->count", "0"], INVALID, |c| c.use_patches(HALF).count = 0),
    (&["patches->count", "65"], INVALID, |c| c.use_patches(HALF).count = 65),
    (&["patches->count", "2147483647"], INVALID, |c| c.use_patches(HALF).count = i32::MAX),
    (&["patches->reserved", "1"], INVALID, |c| c.use_patches(HALF).reserved = 1),
    (&["patches->patch", "(5, 4)", "2"], INVALID, |c| { c.use_patches(HALF); c.patch[29] = 2; }),
    (&["patches->patch", "(0, 0)", "-2"], INVALID, |c| { c.use_patches(HALF); c.patch[0] = -2; }),
    (&["patches->factors", "(0, 1)", "NaN"], NOT_FINITE, |c| { c.use_patches([1.0, NAN, NAN, 1.0]); }),
    (&["patches->factors", "(0, 1)", "-0.5"], INVALID, |c| { c.use_patches([1.0, -0.5, -0.5, 1.0]); }),
    (&["patches->factors", "(1, 0)", "symmetric"], INVALID, |c| { c.use_patches([1.0, 0.5, 0.4, 1.0]); }),
    (&["patches->factors", "(1, 1)", "0.9"], INVALID, |c| { c.use_patches([1.0, 0.5, 0.5, 0.9]); }),
    (&["patches", "period"], UNSUPPORTED, |c| { c.use_patches(HALF); c.use_period(1, 0); }),
    (&["influence", "period"], UNSUPPORTED, |c| { c.use_table(); c.use_period(1, 0); }),
    (&["row_tables->coefficients"], NULL, |c| c.use_row_tables().coefficients = null()),
    (&["row_tables->cx", "0"], INVALID, |c| c.use_row_tables().cx = 0),
    (&["row_tables->cx", "5", "mx = 6"], INVALID, |c| c.use_row_tables().cx = 5),
    (&["row_tables->rows", "-1"], INVALID, |c| c.use_row_tables().rows = -1),
    (&["row_tables->rows", "4", "my = 5"], INVALID, |c| c.use_row_tables().rows = 4),
    (&["row_tables->rows", "2147483647", "my = 5"], INVALID, |c| (c.use_row_tables().cx, c.use_row_tables().rows) = (i32::MAX, i32::MAX)),
    // The grid has so many rows that there is no memory address for the tables.
    (&["rows * rows * 2 cx", "2000000000"], INVALID, |c| {
        (c.scene.known.mx, c.scene.known.my, c.use_row_tables().rows) = (1, 2_000_000_000, 2_000_000_000);
    }),
    (&["row_tables->coefficients", "jy 4", "iy 1", "offset -3", "NaN"], NOT_FINITE, |c| c.set_in_row(4, 1, -3, NAN)),
    (&["row_tables->coefficients", "jy 0", "iy 0", "offset 5", "inf"], NOT_FINITE, |c| c.set_in_row(0, 0, 5, INF)),
    (&["row_tables->coefficients", "jy 3", "iy 3", "offset 0", "-2"], NOT_POSITIVE, |c| c.set_in_row(3, 3, 0, -2.0)),
    (&["influence", "row_tables"], UNSUPPORTED, |c| { c.use_table(); c.use_row_tables(); }),
    (&["row_tables", "period"], UNSUPPORTED, |c| { c.use_row_tables(); c.use_period(1, 0); }),
    (&["friction->coefficient", "-0.1"], INVALID, |c| c.use_friction().coefficient = -0.1),
    (&["friction->coefficient", "NaN"], NOT_FINITE, |c| c.use_friction().coefficient = NAN),
    (&["friction->coefficients", "(0, 0)", "-2"], INVALID, |c| { c.each[0] = -2.0; c.use_friction().coefficients = c.each.as_ptr(); }),
    (&["friction->coefficients", "(5, 4)", "inf"], NOT_FINITE, |c| { c.each[29] = INF; c.use_friction().coefficients = c.each.as_ptr(); }),
    (&["friction->motion", "7"], INVALID, |c| c.use_friction().motion = 7),
    (&["friction->rolling_distance", "tenth"], INVALID, |c| { let f = c.use_friction(); (f.motion, f.rolling_distance) = (2, 1e-3); }),
    (&["friction->rolling_distance", "million"], INVALID, |c| { let f = c.use_friction(); (f.motion, f.rolling_distance) = (2, 1e30); }),
    (&["friction->rolling_distance", "million"], INVALID, |c| { let f = c.use_friction(); (f.motion, f.rolling_distance) = (1, 1e20); }),
    (&["friction->continues", "2"], INVALID, |c| c.use_friction().continues = 2),
    (&["friction->sensitivities", "2"], INVALID, |c| c.use_friction().sensitivities = 2),
    (&["friction->reserved", "1"], INVALID, |c| c.use_friction().reserved = 1),
    (&["friction->prescribed[1]", "-1"], INVALID, |c| c.use_friction().prescribed[1] = -1),
    (&["friction->creepage[0]", "NaN"], NOT_FINITE, |c| c.use_friction().creepage[0] = NAN),
    (&["friction->spin", "inf"], NOT_FINITE, |c| c.use_friction().spin = INF),
    (&["friction->spin_centre[1]", "NaN"], NOT_FINITE, |c| c.use_friction().spin_centre[1] = NAN),
    (&["friction->spin_offset", "NaN"], NOT_FINITE, |c| c.use_friction().spin_offset = NAN),
    (&["friction->force[0]", "inf"], NOT_FINITE, |c| { let f = c.use_friction(); (f.prescribed[0], f.force[0]) = (CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE, INF); }),
    (&["friction->rolling_distance", "-1"], INVALID, |c| c.use_friction().rolling_distance = -1.0),
    (&["friction->rolling_direction", "7"], INVALID, |c| c.use_friction().rolling_direction = 7.0),
    (&["previous_traction"], NULL, |c| { let each = c.each.as_ptr(); c.use_friction().previous_traction[1] = each; }),
    (&["rigid_slip"], NULL, |c| { let each = c.each.as_ptr(); c.use_friction().rigid_slip[0] = each; }),
    (&["friction->rigid_slip[0]", "(2, 0)", "NaN"], NOT_FINITE, |c| { c.each[2] = NAN; let each = c.each.as_ptr(); c.use_friction().rigid_slip = [each; 2]; }),
    (&["continues", "previous_traction"], INVALID, |c| { let each = c.each.as_ptr(); let f = c.use_friction(); (f.continues, f.previous_traction) = (1, [each; 2]); }),
    (&["friction", "influence"], UNSUPPORTED, |c| { c.use_table(); c.use_friction(); }),
    (&["friction->influence[1]"], NULL, |c| c.use_tangential_tables().influence[1] = std::ptr::null()),
    (&["friction->influence->cx", "5"], INVALID, |c| { c.use_tangential_tables(); c.tangential.iter_mut().for_each(|table| table.cx = 5); }),
    (&["friction->influence[0]->cy", "-7"], INVALID, |c| { c.use_tangential_tables(); c.tangential[0].cy = -7; }),
    (&["friction->influence[1]->cx", "9", "8"], INVALID, |c| { c.use_tangential_tables(); c.tangential[1].cx = 9; }),
    (&["friction->influence[2]->scale", "2", "1"], INVALID, |c| { c.use_tangential_tables(); c.tangential[2].scale = 2.0; }),
    (&["friction->influence[2]->coefficients"], NULL, |c| { c.use_tangential_tables(); c.tangential[2].coefficients = std::ptr::null(); }),
    (&["friction->influence[1]->struct_size", "0"], SIZE, |c| { c.use_tangential_tables(); c.tangential[1].struct_size = 0; }),
    (&["friction->influence_cross[1]"], NULL, |c| { let table = &raw const c.tangential[2]; c.use_tangential_tables().influence_cross[0] = table; }),
    (&["friction->influence->scale", "-1"], INVALID, |c| { c.use_tangential_tables(); c.tangential.iter_mut().for_each(|table| table.scale = -1.0); }),
    (&["friction->influence[0]", "(1, 0)", "even"], UNSUPPORTED, |c| { c.table[2 * CX * CY + CX + 1] *= 1.1; c.use_tangential_tables(); }),
    (&["friction->influence[0]", "(-1, 0)", "NaN"], NOT_FINITE, |c| { c.table[2 * CX * CY + CX - 1] = NAN; c.use_tangential_tables(); }),
    (&["friction->influence", "whole elements"], UNSUPPORTED, |c| { let f = c.use_tangential_tables(); (f.motion, f.rolling_direction) = (1, 0.5); }),
    (&["friction", "row_tables"], UNSUPPORTED, |c| { c.use_row_tables(); c.use_friction(); }),
    (&["friction->row_tables[1]"], NULL, |c| c.use_tangential_row_tables().row_tables[1] = std::ptr::null()),
    (&["friction->row_tables->cx", "5"], INVALID, |c| { c.use_tangential_row_tables(); c.tangential_rows.iter_mut().for_each(|table| table.cx = 5); }),
    (&["friction->row_tables[0]->rows", "-7"], INVALID, |c| { c.use_tangential_row_tables(); c.tangential_rows[0].rows = -7; }),
    (&["friction->row_tables[1]->cx", "9", "8"], INVALID, |c| { c.use_tangential_row_tables(); c.tangential_rows[1].cx = 9; }),
    (&["friction->row_tables[2]->scale", "2", "1"], INVALID, |c| { c.use_tangential_row_tables(); c.tangential_rows[2].scale = 2.0; }),
    (&["friction->row_tables[2]->coefficients"], NULL, |c| { c.use_tangential_row_tables(); c.tangential_rows[2].coefficients = std::ptr::null(); }),
    (&["friction->row_tables[1]->struct_size", "0"], SIZE, |c| { c.use_tangential_row_tables(); c.tangential_rows[1].struct_size = 0; }),
    (&["friction->row_tables", "along x"], UNSUPPORTED, |c| { let f = c.use_tangential_row_tables(); (f.motion, f.rolling_direction) = (1, 0.5); }),
    (&["friction->row_tables[0]", "symmetric"], UNSUPPORTED, |c| { c.use_tangential_row_tables(); c.tables[2 * CX + CX + 1] *= 1.1; }),
    (&["friction->influence", "friction->row_tables"], UNSUPPORTED, |c| { let tables = c.use_tangential_tables().influence; c.use_tangential_row_tables().influence = tables; }),
    (&["friction->row_tables", "friction->influence_cross"], UNSUPPORTED, |c| { let tables = c.use_tangential_tables().influence; let f = c.use_tangential_row_tables(); (f.influence, f.influence_cross) = ([std::ptr::null(); 3], [tables[0], tables[1]]); }),
    (&["friction", "period"], UNSUPPORTED, |c| { c.use_friction(); c.use_period(1, 0); }),
    (&["friction", "patches"], UNSUPPORTED, |c| { c.use_friction(); c.use_patches(HALF); }),
    // The approach is beyond the mean of the distance, 0.0691...
    (&["approach", "0.5", "mean plane"], INFEASIBLE, |c| { c.scene.known.approach = 0.5; c.use_period(1, 1); }),

    (&["method", "17"], INVALID, |c| c.options.known.method = 17),
    (&["smoother", "-1"], INVALID, |c| c.use_cycle().smoother = -1),
    (&["active_set", "2"], INVALID, |c| c.options.known.active_set = 2),
    (&["initial_guess", "3"], INVALID, |c| c.options.known.initial_guess = 3),
    (&["criterion", "2"], INVALID, |c| c.options.known.criterion = 2),
    (&["precision", "3"], INVALID, |c| c.options.known.precision = 3),
    (&["reserved", "-1"], INVALID, |c| c.options.known.reserved = -1),
    (&["tolerance", "0"], INVALID, |c| c.options.known.tolerance = 0.0),
    (&["tolerance", "-1e-6"], INVALID, |c| c.options.known.tolerance = -1e-6),
    (&["tolerance", "1", "between 0 and 1"], INVALID, |c| c.options.known.tolerance = 1.0),
    (&["tolerance", "2.5"], INVALID, |c| c.options.known.tolerance = 2.5),
    (&["tolerance", "10000000000"], INVALID, |c| c.options.known.tolerance = 1e10),
    (&["tolerance", "1.5"], INVALID, |c| (c.options.known.criterion, c.options.known.tolerance) = (1, 1.5)),
    (&["tolerance", "NaN"], NOT_FINITE, |c| c.options.known.tolerance = NAN),
    (&["tolerance", "inf"], NOT_FINITE, |c| c.options.known.tolerance = INF),
    (&["error_ratio", "-1"], INVALID, |c| c.options.known.error_ratio = -1.0),
    (&["error_ratio", "NaN"], NOT_FINITE, |c| c.options.known.error_ratio = NAN),
    (&["max_cycles", "0"], INVALID, |c| c.options.known.max_cycles = 0),
    (&["max_cycles", "-3"], INVALID, |c| c.options.known.max_cycles = -3),
    (&["relaxation", "-0.5"], INVALID, |c| c.use_cycle().relaxation = -0.5),
    (&["relaxation", "2"], INVALID, |c| c.use_cycle().relaxation = 2.0),
    (&["relaxation", "NaN"], NOT_FINITE, |c| c.use_cycle().relaxation = NAN),
    (&["pre_sweeps", "-1"], INVALID, |c| c.use_cycle().pre_sweeps = -1),
    (&["post_sweeps", "-2"], INVALID, |c| c.use_cycle().post_sweeps = -2),
    (&["post_sweeps", "2147483647"], INVALID, |c| c.use_cycle().post_sweeps = i32::MAX),
    (&["pre_sweeps", "post_sweeps", "0"], INVALID, |c| {
        let cycle = c.use_cycle();
        (cycle.pre_sweeps, cycle.post_sweeps) = (0, 0);
    }),
    (&["coarsest", "0"], INVALID, |c| c.use_cycle().coarsest = 0),
    (&["coarsest", "17"], INVALID, |c| c.use_cycle().coarsest = 17),
    (&["threads", "-1"], INVALID, |c| c.options.known.threads = -1),
    // So many threads must be refused without trying: a million of them might take the machine down.
    (&["threads", "1025"], INVALID, |c| c.options.known.threads = 1025),
    (&["threads", "2147483647"], INVALID, |c| c.options.known.threads = i32::MAX),
];

/// Outputs and initial guesses: refused by a solve, with or without a handle.
#[rustfmt::skip]
pub const SOLVES: &[Row] = &[
    (&["no load", "set scene->approach or scene->force"], INVALID, |c| {
        (c.scene.known.load, c.scene.known.approach, c.scene.known.force) = (UNSET, NAN, NAN);
    }),
    (&["ledger", "ledger_capacity"], NULL, |c| c.report.known.ledger = null_mut()),
    (&["ledger_capacity", "-1"], INVALID, |c| c.report.known.ledger_capacity = -1),
    (&["contact", "FIXED"], NULL, |c| { c.fix_contact(); c.fields.known.contact = null_mut(); }),
    (&["contact", "empty"], INVALID, |c| { c.fix_contact(); c.contact.fill(0); }),
    // The only element of the fixed area has no surface.
    (&["contact", "empty"], INVALID, |c| { c.fix_contact(); c.contact[1..].fill(0); c.h[0] = INF; }),
    (&["pressure", "GIVEN"], NULL, |c| { c.options.known.initial_guess = 1; c.fields.known.pressure = null_mut(); }),
    (&["pressure", "NaN"], NOT_FINITE, |c| { c.options.known.initial_guess = 1; c.pressure[7] = NAN; }),
    (&["pressure", "-inf"], NOT_FINITE, |c| { c.options.known.initial_guess = 1; c.pressure[0] = -INF; }),
];
