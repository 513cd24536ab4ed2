//! The constants, the structs and their members by name. Made from include/contact_normal.h; do not edit.

use super::member::{members, Kind::*, Member, Struct};
use super::*;

/// Without CONTACT_NORMAL_.
#[rustfmt::skip]
pub(super) const CONSTANTS: &[(&str, i32)] = &[
    ("OK", CONTACT_NORMAL_OK), ("ITERATION_LIMIT", CONTACT_NORMAL_ITERATION_LIMIT), ("CANCELLED", CONTACT_NORMAL_CANCELLED),
    ("STAGNATED", CONTACT_NORMAL_STAGNATED), ("NULL_POINTER", CONTACT_NORMAL_NULL_POINTER), ("INVALID_ARGUMENT", CONTACT_NORMAL_INVALID_ARGUMENT),
    ("NOT_FINITE", CONTACT_NORMAL_NOT_FINITE), ("STRUCT_SIZE", CONTACT_NORMAL_STRUCT_SIZE), ("UNSUPPORTED", CONTACT_NORMAL_UNSUPPORTED),
    ("INFEASIBLE", CONTACT_NORMAL_INFEASIBLE), ("NOT_POSITIVE_DEFINITE", CONTACT_NORMAL_NOT_POSITIVE_DEFINITE),
    ("OUT_OF_MEMORY", CONTACT_NORMAL_OUT_OF_MEMORY), ("INFLUENCE_CHANGED", CONTACT_NORMAL_INFLUENCE_CHANGED), ("INTERNAL", CONTACT_NORMAL_INTERNAL),
    ("VERSION_MAJOR", CONTACT_NORMAL_VERSION_MAJOR), ("VERSION_MINOR", CONTACT_NORMAL_VERSION_MINOR), ("VERSION_PATCH", CONTACT_NORMAL_VERSION_PATCH),
    ("ABI_VERSION", CONTACT_NORMAL_ABI_VERSION), ("KIND_SCENE", CONTACT_NORMAL_KIND_SCENE), ("KIND_OPTIONS", CONTACT_NORMAL_KIND_OPTIONS),
    ("KIND_FIELDS", CONTACT_NORMAL_KIND_FIELDS), ("KIND_REPORT", CONTACT_NORMAL_KIND_REPORT), ("KIND_ACCURACY", CONTACT_NORMAL_KIND_ACCURACY),
    ("KIND_INFLUENCE", CONTACT_NORMAL_KIND_INFLUENCE), ("KIND_ROW_TABLES", CONTACT_NORMAL_KIND_ROW_TABLES), ("KIND_LAYER", CONTACT_NORMAL_KIND_LAYER),
    ("KIND_PRESSURE_LIMIT", CONTACT_NORMAL_KIND_PRESSURE_LIMIT), ("KIND_PERIOD", CONTACT_NORMAL_KIND_PERIOD),
    ("KIND_PATCHES", CONTACT_NORMAL_KIND_PATCHES), ("KIND_COATING", CONTACT_NORMAL_KIND_COATING), ("KIND_FRICTION", CONTACT_NORMAL_KIND_FRICTION),
    ("KIND_FRICTION_RESULTS", CONTACT_NORMAL_KIND_FRICTION_RESULTS), ("KIND_STRESS_OUTPUTS", CONTACT_NORMAL_KIND_STRESS_OUTPUTS),
    ("KIND_STRESS_MAXIMUM", CONTACT_NORMAL_KIND_STRESS_MAXIMUM), ("KIND_LEDGER_ROW", CONTACT_NORMAL_KIND_LEDGER_ROW),
    ("KIND_PRICE", CONTACT_NORMAL_KIND_PRICE), ("KIND_HERTZ_SOLUTION", CONTACT_NORMAL_KIND_HERTZ_SOLUTION), ("KIND_CYCLE", CONTACT_NORMAL_KIND_CYCLE),
    ("KIND_SOLVER_INFO", CONTACT_NORMAL_KIND_SOLVER_INFO), ("KIND_QUANTITY_ROW", CONTACT_NORMAL_KIND_QUANTITY_ROW),
    ("KIND_EFFECTS_ROW", CONTACT_NORMAL_KIND_EFFECTS_ROW), ("KIND_ADHESION", CONTACT_NORMAL_KIND_ADHESION), ("KIND_VISCO", CONTACT_NORMAL_KIND_VISCO),
    ("KIND_HEAT", CONTACT_NORMAL_KIND_HEAT), ("KIND_FLASH", CONTACT_NORMAL_KIND_FLASH), ("KIND_WEAR", CONTACT_NORMAL_KIND_WEAR),
    ("KIND_WORN", CONTACT_NORMAL_KIND_WORN), ("PRESCRIBED_UNSET", CONTACT_NORMAL_PRESCRIBED_UNSET),
    ("PRESCRIBED_APPROACH", CONTACT_NORMAL_PRESCRIBED_APPROACH), ("PRESCRIBED_FORCE", CONTACT_NORMAL_PRESCRIBED_FORCE),
    ("MOTION_SHIFT", CONTACT_NORMAL_MOTION_SHIFT), ("MOTION_TRANSIENT_ROLLING", CONTACT_NORMAL_MOTION_TRANSIENT_ROLLING),
    ("MOTION_STEADY_ROLLING", CONTACT_NORMAL_MOTION_STEADY_ROLLING), ("PRESCRIBED_CREEPAGE", CONTACT_NORMAL_PRESCRIBED_CREEPAGE),
    ("PRESCRIBED_TANGENTIAL_FORCE", CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE), ("FRICTION_LAW_COULOMB", CONTACT_NORMAL_FRICTION_LAW_COULOMB),
    ("FRICTION_LAW_LINEAR", CONTACT_NORMAL_FRICTION_LAW_LINEAR), ("FRICTION_LAW_RATIONAL", CONTACT_NORMAL_FRICTION_LAW_RATIONAL),
    ("FRICTION_LAW_EXPONENTIAL", CONTACT_NORMAL_FRICTION_LAW_EXPONENTIAL), ("FRICTION_BRANCH_NEAR", CONTACT_NORMAL_FRICTION_BRANCH_NEAR),
    ("FRICTION_BRANCH_LOW", CONTACT_NORMAL_FRICTION_BRANCH_LOW), ("FRICTION_BRANCH_HIGH", CONTACT_NORMAL_FRICTION_BRANCH_HIGH),
    ("STICK_SLIP_EXTERIOR", CONTACT_NORMAL_STICK_SLIP_EXTERIOR), ("STICK_SLIP_STICK", CONTACT_NORMAL_STICK_SLIP_STICK),
    ("STICK_SLIP_SLIP", CONTACT_NORMAL_STICK_SLIP_SLIP), ("STICK_SLIP_PLASTIC", CONTACT_NORMAL_STICK_SLIP_PLASTIC),
    ("LAW_EXPONENTIAL", CONTACT_NORMAL_LAW_EXPONENTIAL), ("LAW_DUGDALE", CONTACT_NORMAL_LAW_DUGDALE), ("LAW_CUBIC", CONTACT_NORMAL_LAW_CUBIC),
    ("LAW_VAN_DER_WAALS", CONTACT_NORMAL_LAW_VAN_DER_WAALS), ("START_AUTO", CONTACT_NORMAL_START_AUTO),
    ("START_FROM_CONTACT", CONTACT_NORMAL_START_FROM_CONTACT), ("START_FROM_APART", CONTACT_NORMAL_START_FROM_APART),
    ("FORM_AUTO", CONTACT_NORMAL_FORM_AUTO), ("FORM_RELAXATION", CONTACT_NORMAL_FORM_RELAXATION), ("FORM_CREEP", CONTACT_NORMAL_FORM_CREEP),
    ("FORM_BACKWARD_EULER", CONTACT_NORMAL_FORM_BACKWARD_EULER), ("METHOD_AUTO", CONTACT_NORMAL_METHOD_AUTO),
    ("METHOD_NORM", CONTACT_NORMAL_METHOD_NORM), ("METHOD_MULTIGRID", CONTACT_NORMAL_METHOD_MULTIGRID),
    ("METHOD_FULL_MULTIGRID", CONTACT_NORMAL_METHOD_FULL_MULTIGRID), ("METHOD_PROJECTED_CG", CONTACT_NORMAL_METHOD_PROJECTED_CG),
    ("SMOOTHER_AUTO", CONTACT_NORMAL_SMOOTHER_AUTO), ("SMOOTHER_GAUSS_SEIDEL", CONTACT_NORMAL_SMOOTHER_GAUSS_SEIDEL),
    ("SMOOTHER_RED_BLACK", CONTACT_NORMAL_SMOOTHER_RED_BLACK), ("SMOOTHER_JACOBI", CONTACT_NORMAL_SMOOTHER_JACOBI),
    ("SMOOTHER_FFT", CONTACT_NORMAL_SMOOTHER_FFT), ("ACTIVE_SET_FREE", CONTACT_NORMAL_ACTIVE_SET_FREE),
    ("ACTIVE_SET_FIXED", CONTACT_NORMAL_ACTIVE_SET_FIXED), ("INITIAL_GUESS_NONE", CONTACT_NORMAL_INITIAL_GUESS_NONE),
    ("INITIAL_GUESS_GIVEN", CONTACT_NORMAL_INITIAL_GUESS_GIVEN), ("INITIAL_GUESS_PREVIOUS", CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS),
    ("CRITERION_RESIDUAL", CONTACT_NORMAL_CRITERION_RESIDUAL), ("CRITERION_UPDATE", CONTACT_NORMAL_CRITERION_UPDATE),
    ("PRECISION_AUTO", CONTACT_NORMAL_PRECISION_AUTO), ("PRECISION_DOUBLE", CONTACT_NORMAL_PRECISION_DOUBLE),
    ("PRECISION_MIXED", CONTACT_NORMAL_PRECISION_MIXED), ("WARNING_BORDER", CONTACT_NORMAL_WARNING_BORDER),
    ("WARNING_ONE_ELEMENT", CONTACT_NORMAL_WARNING_ONE_ELEMENT), ("WARNING_SPIKE", CONTACT_NORMAL_WARNING_SPIKE),
    ("WARNING_ERROR_UNKNOWN", CONTACT_NORMAL_WARNING_ERROR_UNKNOWN), ("WARNING_RANGE", CONTACT_NORMAL_WARNING_RANGE),
    ("WARNING_ATTRACTION", CONTACT_NORMAL_WARNING_ATTRACTION), ("WARNING_LAW", CONTACT_NORMAL_WARNING_LAW),
    ("UNTRUSTED_FORCE", CONTACT_NORMAL_UNTRUSTED_FORCE), ("UNTRUSTED_MAX_PRESSURE", CONTACT_NORMAL_UNTRUSTED_MAX_PRESSURE),
    ("UNTRUSTED_PRESSURE", CONTACT_NORMAL_UNTRUSTED_PRESSURE), ("LIMITED_BY_UNKNOWN", CONTACT_NORMAL_LIMITED_BY_UNKNOWN),
    ("LIMITED_BY_GRID", CONTACT_NORMAL_LIMITED_BY_GRID), ("LIMITED_BY_TOLERANCE", CONTACT_NORMAL_LIMITED_BY_TOLERANCE),
    ("QUANTITY_FORCE", CONTACT_NORMAL_QUANTITY_FORCE), ("QUANTITY_MAX_PRESSURE", CONTACT_NORMAL_QUANTITY_MAX_PRESSURE),
    ("QUANTITY_CONTACT_AREA", CONTACT_NORMAL_QUANTITY_CONTACT_AREA), ("QUANTITY_MEAN_GAP", CONTACT_NORMAL_QUANTITY_MEAN_GAP),
    ("QUANTITY_STIFFNESS", CONTACT_NORMAL_QUANTITY_STIFFNESS), ("QUANTITY_TANGENTIAL_FORCE", CONTACT_NORMAL_QUANTITY_TANGENTIAL_FORCE),
    ("QUANTITY_CREEPAGE", CONTACT_NORMAL_QUANTITY_CREEPAGE), ("QUANTITY_SPIN_MOMENT", CONTACT_NORMAL_QUANTITY_SPIN_MOMENT),
    ("QUANTITY_STICK_AREA", CONTACT_NORMAL_QUANTITY_STICK_AREA), ("QUANTITY_MAX_VON_MISES", CONTACT_NORMAL_QUANTITY_MAX_VON_MISES),
    ("QUANTITY_VON_MISES_DEPTH", CONTACT_NORMAL_QUANTITY_VON_MISES_DEPTH), ("QUANTITY_MAX_SHEAR", CONTACT_NORMAL_QUANTITY_MAX_SHEAR),
    ("OBSTACLE_NONE", CONTACT_NORMAL_OBSTACLE_NONE), ("OBSTACLE_SINGULAR", CONTACT_NORMAL_OBSTACLE_SINGULAR),
    ("OBSTACLE_ROUND_OFF", CONTACT_NORMAL_OBSTACLE_ROUND_OFF), ("OBSTACLE_ELEMENTS", CONTACT_NORMAL_OBSTACLE_ELEMENTS),
    ("OBSTACLE_MEMORY", CONTACT_NORMAL_OBSTACLE_MEMORY), ("OBSTACLE_TIME", CONTACT_NORMAL_OBSTACLE_TIME),
    ("OBSTACLE_STEP", CONTACT_NORMAL_OBSTACLE_STEP), ("LACK_NONE", CONTACT_NORMAL_LACK_NONE), ("LACK_NO_FRICTION", CONTACT_NORMAL_LACK_NO_FRICTION),
    ("LACK_PRESCRIBED", CONTACT_NORMAL_LACK_PRESCRIBED), ("LACK_EFFECT", CONTACT_NORMAL_LACK_EFFECT),
    ("LACK_NO_CONTACT", CONTACT_NORMAL_LACK_NO_CONTACT), ("LACK_SINGULAR", CONTACT_NORMAL_LACK_SINGULAR),
    ("LACK_ONE_GRID", CONTACT_NORMAL_LACK_ONE_GRID), ("LACK_UNSOLVED", CONTACT_NORMAL_LACK_UNSOLVED),
    ("LACK_UNSETTLED", CONTACT_NORMAL_LACK_UNSETTLED), ("OMIT_NONE", CONTACT_NORMAL_OMIT_NONE), ("OMIT_COATING", CONTACT_NORMAL_OMIT_COATING),
    ("OMIT_PERIOD", CONTACT_NORMAL_OMIT_PERIOD), ("OMIT_PATCHES", CONTACT_NORMAL_OMIT_PATCHES), ("OMIT_LAYER", CONTACT_NORMAL_OMIT_LAYER),
    ("OMIT_PRESSURE_LIMIT", CONTACT_NORMAL_OMIT_PRESSURE_LIMIT), ("OMIT_FRICTION", CONTACT_NORMAL_OMIT_FRICTION),
    ("OMIT_COUPLING", CONTACT_NORMAL_OMIT_COUPLING), ("OMIT_SPIN", CONTACT_NORMAL_OMIT_SPIN),
    ("OMIT_FRICTION_COMPLIANCE", CONTACT_NORMAL_OMIT_FRICTION_COMPLIANCE), ("OMIT_COATING_AS_LAYER", CONTACT_NORMAL_OMIT_COATING_AS_LAYER),
    ("OMIT_ADHESION", CONTACT_NORMAL_OMIT_ADHESION), ("OMIT_FRICTION_LAW", CONTACT_NORMAL_OMIT_FRICTION_LAW),
    ("OMIT_FRICTION_LAYER", CONTACT_NORMAL_OMIT_FRICTION_LAYER), ("OMIT_VISCO", CONTACT_NORMAL_OMIT_VISCO),
    ("VERDICT_NOT_DECIDED", CONTACT_NORMAL_VERDICT_NOT_DECIDED), ("VERDICT_NEGLIGIBLE", CONTACT_NORMAL_VERDICT_NEGLIGIBLE),
    ("VERDICT_NEEDED", CONTACT_NORMAL_VERDICT_NEEDED), ("LOG_OFF", CONTACT_NORMAL_LOG_OFF), ("LOG_WARNING", CONTACT_NORMAL_LOG_WARNING),
    ("LOG_INFO", CONTACT_NORMAL_LOG_INFO),
];

#[rustfmt::skip]
pub(super) const STRUCTS: &[Struct] = &[
    Struct { name: "contact_normal_coating", members: members!(contact_normal_coating:
        ("struct_size", struct_size, 0, Int64) ("thickness", thickness, 0, Double) ("shear_modulus", shear_modulus, 0, Double)
        ("poisson_ratio", poisson_ratio, 0, Double)
    ) },
    Struct { name: "contact_normal_influence", members: members!(contact_normal_influence:
        ("struct_size", struct_size, 0, Int64) ("cx", cx, 0, Int32) ("cy", cy, 0, Int32) ("coefficients", coefficients, 0, Array)
        ("scale", scale, 0, Double)
    ) },
    Struct { name: "contact_normal_layer", members: members!(contact_normal_layer:
        ("struct_size", struct_size, 0, Int64) ("compliance", compliance, 0, Double) ("compliances", compliances, 0, Array)
    ) },
    Struct { name: "contact_normal_pressure_limit", members: members!(contact_normal_pressure_limit:
        ("struct_size", struct_size, 0, Int64) ("limit", limit, 0, Double) ("limits", limits, 0, Array)
    ) },
    Struct { name: "contact_normal_period", members: members!(contact_normal_period:
        ("struct_size", struct_size, 0, Int64) ("x", x, 0, Int32) ("y", y, 0, Int32)
    ) },
    Struct { name: "contact_normal_patches", members: members!(contact_normal_patches:
        ("struct_size", struct_size, 0, Int64) ("count", count, 0, Int32) ("reserved", reserved, 0, Int32) ("patch", patch, 0, Array)
        ("factors", factors, 0, Array)
    ) },
    Struct { name: "contact_normal_row_tables", members: members!(contact_normal_row_tables:
        ("struct_size", struct_size, 0, Int64) ("cx", cx, 0, Int32) ("rows", rows, 0, Int32) ("coefficients", coefficients, 0, Array)
        ("scale", scale, 0, Double)
    ) },
    Struct { name: "contact_normal_friction", members: members!(contact_normal_friction:
        ("struct_size", struct_size, 0, Int64) ("coefficient", coefficient, 0, Double) ("coefficients", coefficients, 0, Array)
        ("motion", motion, 0, Int32) ("continues", continues, 0, Int32) ("prescribed[0]", prescribed, 0, Int32)
        ("prescribed[1]", prescribed, 4, Int32) ("creepage[0]", creepage, 0, Double) ("creepage[1]", creepage, 8, Double) ("spin", spin, 0, Double)
        ("spin_centre[0]", spin_centre, 0, Double) ("spin_centre[1]", spin_centre, 8, Double) ("force[0]", force, 0, Double)
        ("force[1]", force, 8, Double) ("rolling_distance", rolling_distance, 0, Double) ("rolling_direction", rolling_direction, 0, Double)
        ("spin_offset", spin_offset, 0, Double) ("previous_traction[0]", previous_traction, 0, Array)
        ("previous_traction[1]", previous_traction, 8, Array) ("rigid_slip[0]", rigid_slip, 0, Array) ("rigid_slip[1]", rigid_slip, 8, Array)
        ("influence[0]", influence, 0, Structs("contact_normal_influence")) ("influence[1]", influence, 8, Structs("contact_normal_influence"))
        ("influence[2]", influence, 16, Structs("contact_normal_influence"))
        ("influence_cross[0]", influence_cross, 0, Structs("contact_normal_influence"))
        ("influence_cross[1]", influence_cross, 8, Structs("contact_normal_influence")) ("sensitivities", sensitivities, 0, Int32)
        ("reserved", reserved, 0, Int32) ("initial_traction[0]", initial_traction, 0, Array) ("initial_traction[1]", initial_traction, 8, Array)
        ("compliance", compliance, 0, Double) ("compliances", compliances, 0, Array) ("creepage_weight[0]", creepage_weight, 0, Array)
        ("creepage_weight[1]", creepage_weight, 8, Array) ("row_tables[0]", row_tables, 0, Structs("contact_normal_row_tables"))
        ("row_tables[1]", row_tables, 8, Structs("contact_normal_row_tables")) ("row_tables[2]", row_tables, 16, Structs("contact_normal_row_tables"))
        ("law", law, 0, Int32) ("reserved_for_law", reserved_for_law, 0, Int32) ("kinetic", kinetic, 0, Double) ("falling[0]", falling, 0, Double)
        ("falling[1]", falling, 8, Double) ("half_speed[0]", half_speed, 0, Double) ("half_speed[1]", half_speed, 8, Double)
        ("speed", speed, 0, Double) ("time_step", time_step, 0, Double) ("memory_distance", memory_distance, 0, Double)
        ("memory_speed", memory_speed, 0, Double) ("yield_limit", yield_limit, 0, Double) ("hardening", hardening, 0, Double)
        ("previous_coefficient", previous_coefficient, 0, Array) ("previous_yield_limit", previous_yield_limit, 0, Array) ("branch", branch, 0, Int32)
        ("reserved_for_branch", reserved_for_branch, 0, Int32)
    ) },
    Struct { name: "contact_normal_adhesion", members: members!(contact_normal_adhesion:
        ("struct_size", struct_size, 0, Int64) ("law", law, 0, Int32) ("start", start, 0, Int32) ("work_of_adhesion", work_of_adhesion, 0, Double)
        ("works_of_adhesion", works_of_adhesion, 0, Array) ("range", range, 0, Double) ("smear", smear, 0, Double) ("stiffness", stiffness, 0, Int32)
        ("stability", stability, 0, Int32) ("shear_strength", shear_strength, 0, Double)
    ) },
    Struct { name: "contact_normal_visco", members: members!(contact_normal_visco:
        ("struct_size", struct_size, 0, Int64) ("branches[0]", branches, 0, Int32) ("branches[1]", branches, 4, Int32)
        ("modulus[0]", modulus, 0, Array) ("modulus[1]", modulus, 8, Array) ("time[0]", time, 0, Array) ("time[1]", time, 8, Array)
        ("time_step", time_step, 0, Double) ("form", form, 0, Int32) ("continues", continues, 0, Int32)
    ) },
    Struct { name: "contact_normal_scene", members: members!(contact_normal_scene:
        ("struct_size", struct_size, 0, Int64) ("mx", mx, 0, Int32) ("my", my, 0, Int32) ("dx", dx, 0, Double) ("dy", dy, 0, Double)
        ("undeformed_distance", undeformed_distance, 0, Array) ("shear_modulus[0]", shear_modulus, 0, Double)
        ("shear_modulus[1]", shear_modulus, 8, Double) ("poisson_ratio[0]", poisson_ratio, 0, Double) ("poisson_ratio[1]", poisson_ratio, 8, Double)
        ("load", load, 0, Int32) ("reserved", reserved, 0, Int32) ("approach", approach, 0, Double) ("force", force, 0, Double)
        ("influence", influence, 0, Structs("contact_normal_influence")) ("layer", layer, 0, Structs("contact_normal_layer"))
        ("pressure_limit", pressure_limit, 0, Structs("contact_normal_pressure_limit")) ("period", period, 0, Structs("contact_normal_period"))
        ("patches", patches, 0, Structs("contact_normal_patches")) ("row_tables", row_tables, 0, Structs("contact_normal_row_tables"))
        ("coating[0]", coating, 0, Structs("contact_normal_coating")) ("coating[1]", coating, 8, Structs("contact_normal_coating"))
        ("friction", friction, 0, Structs("contact_normal_friction")) ("adhesion", adhesion, 0, Structs("contact_normal_adhesion"))
        ("visco", visco, 0, Structs("contact_normal_visco"))
    ) },
    Struct { name: "contact_normal_progress", members: members!(contact_normal_progress:
        ("struct_size", struct_size, 0, Int64) ("mx", mx, 0, Int32) ("my", my, 0, Int32) ("cycles", cycles, 0, Int64)
        ("active_set_changes", active_set_changes, 0, Int64) ("seconds", seconds, 0, Double) ("work_units", work_units, 0, Double)
        ("update", update, 0, Double) ("residual", residual, 0, Double)
    ) },
    Struct { name: "contact_normal_cycle", members: members!(contact_normal_cycle:
        ("struct_size", struct_size, 0, Int64) ("smoother", smoother, 0, Int32) ("pre_sweeps", pre_sweeps, 0, Int32)
        ("post_sweeps", post_sweeps, 0, Int32) ("coarsest", coarsest, 0, Int32) ("relaxation", relaxation, 0, Double)
    ) },
    Struct { name: "contact_normal_options", members: members!(contact_normal_options:
        ("struct_size", struct_size, 0, Int64) ("method", method, 0, Int32) ("active_set", active_set, 0, Int32)
        ("initial_guess", initial_guess, 0, Int32) ("criterion", criterion, 0, Int32) ("tolerance", tolerance, 0, Double)
        ("error_ratio", error_ratio, 0, Double) ("max_cycles", max_cycles, 0, Int32) ("threads", threads, 0, Int32) ("precision", precision, 0, Int32)
        ("reserved", reserved, 0, Int32) ("progress", progress, 0, OfTheHost) ("user", user, 0, OfTheHost)
        ("cycle", cycle, 0, Structs("contact_normal_cycle")) ("max_seconds", max_seconds, 0, Double) ("stop", stop, 0, Array)
        ("dump", dump, 0, OfTheHost) ("neglect_below", neglect_below, 0, Double)
    ) },
    Struct { name: "contact_normal_fields", members: members!(contact_normal_fields:
        ("struct_size", struct_size, 0, Int64) ("pressure", pressure, 0, Array) ("deformed_distance", deformed_distance, 0, Array)
        ("displacement", displacement, 0, Array) ("contact", contact, 0, Array) ("traction[0]", traction, 0, Array)
        ("traction[1]", traction, 8, Array) ("slip[0]", slip, 0, Array) ("slip[1]", slip, 8, Array) ("stick_slip", stick_slip, 0, Array)
        ("contact_pressure", contact_pressure, 0, Array) ("attraction", attraction, 0, Array) ("friction_coefficient", friction_coefficient, 0, Array)
        ("yield_limit", yield_limit, 0, Array)
    ) },
    Struct { name: "contact_normal_ledger_row", members: members!(contact_normal_ledger_row:
        ("struct_size", struct_size, 0, Int64) ("mx", mx, 0, Int32) ("my", my, 0, Int32) ("cycles", cycles, 0, Int64) ("seconds", seconds, 0, Double)
        ("work_units", work_units, 0, Double) ("residual", residual, 0, Double) ("approach", approach, 0, Double) ("force", force, 0, Double)
        ("max_pressure", max_pressure, 0, Double) ("contact_area", contact_area, 0, Double) ("corrected_area", corrected_area, 0, Double)
        ("error_force", error_force, 0, Double) ("error_max_pressure", error_max_pressure, 0, Double)
        ("error_contact_area", error_contact_area, 0, Double) ("error_corrected_area", error_corrected_area, 0, Double)
        ("error_pressure", error_pressure, 0, Double) ("contact_count", contact_count, 0, Int64) ("untrusted", untrusted, 0, Int32)
        ("reserved", reserved, 0, Int32)
    ) },
    Struct { name: "contact_normal_report_normal", members: members!(contact_normal_report_normal:
        ("approach", approach, 0, Double) ("force", force, 0, Double) ("max_pressure", max_pressure, 0, Double)
        ("min_pressure", min_pressure, 0, Double) ("contact_area", contact_area, 0, Double) ("corrected_area", corrected_area, 0, Double)
        ("contact_count", contact_count, 0, Int64) ("edge_count", edge_count, 0, Int64) ("tolerance", tolerance, 0, Double)
        ("residual", residual, 0, Double) ("violation", violation, 0, Double) ("complementarity", complementarity, 0, Double)
        ("update", update, 0, Double) ("reserved[0]", reserved, 0, Double) ("reserved[1]", reserved, 8, Double) ("reserved[2]", reserved, 16, Double)
        ("reserved[3]", reserved, 24, Double) ("reserved[4]", reserved, 32, Double) ("reserved[5]", reserved, 40, Double)
        ("reserved[6]", reserved, 48, Double) ("reserved[7]", reserved, 56, Double)
    ) },
    Struct { name: "contact_normal_report_tangential", members: members!(contact_normal_report_tangential:
        ("force[0]", force, 0, Double) ("force[1]", force, 8, Double) ("moment", moment, 0, Double) ("creepage[0]", creepage, 0, Double)
        ("creepage[1]", creepage, 8, Double) ("residual", residual, 0, Double) ("gap", gap, 0, Double) ("stick_count", stick_count, 0, Int64)
        ("slip_count", slip_count, 0, Int64) ("sensitivities[0]", sensitivities, 0, Double) ("sensitivities[1]", sensitivities, 8, Double)
        ("sensitivities[2]", sensitivities, 16, Double) ("sensitivities[3]", sensitivities, 24, Double)
        ("sensitivities[4]", sensitivities, 32, Double) ("sensitivities[5]", sensitivities, 40, Double)
        ("sensitivities[6]", sensitivities, 48, Double) ("sensitivities[7]", sensitivities, 56, Double)
        ("sensitivities[8]", sensitivities, 64, Double) ("update", update, 0, Double) ("law_slope", law_slope, 0, Double)
        ("reserved[0]", reserved, 0, Double) ("reserved[1]", reserved, 8, Double) ("reserved[2]", reserved, 16, Double)
        ("reserved[3]", reserved, 24, Double) ("reserved[4]", reserved, 32, Double) ("reserved[5]", reserved, 40, Double)
    ) },
    Struct { name: "contact_normal_report_accuracy", members: members!(contact_normal_report_accuracy:
        ("error_force", error_force, 0, Double) ("error_max_pressure", error_max_pressure, 0, Double)
        ("error_contact_area", error_contact_area, 0, Double) ("error_corrected_area", error_corrected_area, 0, Double)
        ("error_pressure", error_pressure, 0, Double) ("error_tangential[0]", error_tangential, 0, Double)
        ("error_tangential[1]", error_tangential, 8, Double) ("untrusted", untrusted, 0, Int32) ("limited_by", limited_by, 0, Int32)
        ("halved_seconds", halved_seconds, 0, Double) ("halved_error_force", halved_error_force, 0, Double) ("neglected", neglected, 0, Int64)
        ("neglected_error", neglected_error, 0, Double) ("reserved[0]", reserved, 0, Double) ("reserved[1]", reserved, 8, Double)
        ("reserved[2]", reserved, 16, Double) ("reserved[3]", reserved, 24, Double) ("reserved[4]", reserved, 32, Double)
        ("reserved[5]", reserved, 40, Double)
    ) },
    Struct { name: "contact_normal_report_statistics", members: members!(contact_normal_report_statistics:
        ("cycles", cycles, 0, Int64) ("active_set_steps", active_set_steps, 0, Int64) ("active_set_changes", active_set_changes, 0, Int64)
        ("matrix_products", matrix_products, 0, Int64) ("work_units", work_units, 0, Double) ("tangential_products", tangential_products, 0, Double)
        ("setup_seconds", setup_seconds, 0, Double) ("solve_seconds", solve_seconds, 0, Double) ("tangential_seconds", tangential_seconds, 0, Double)
        ("bytes", bytes, 0, Int64) ("reserved[0]", reserved, 0, Double) ("reserved[1]", reserved, 8, Double) ("reserved[2]", reserved, 16, Double)
        ("reserved[3]", reserved, 24, Double) ("reserved[4]", reserved, 32, Double) ("reserved[5]", reserved, 40, Double)
        ("reserved[6]", reserved, 48, Double) ("reserved[7]", reserved, 56, Double)
    ) },
    Struct { name: "contact_normal_report_adhesion", members: members!(contact_normal_report_adhesion:
        ("repulsive_force", repulsive_force, 0, Double) ("adhesive_force", adhesive_force, 0, Double) ("elastic_energy", elastic_energy, 0, Double)
        ("adhesive_energy", adhesive_energy, 0, Double) ("law_residual", law_residual, 0, Double) ("range", range, 0, Double)
        ("resolution", resolution, 0, Double) ("border_share", border_share, 0, Double) ("stiffness", stiffness, 0, Double)
        ("stability", stability, 0, Double) ("jumped", jumped, 0, Int32) ("reserved_integer", reserved_integer, 0, Int32)
        ("reserved[0]", reserved, 0, Double) ("reserved[1]", reserved, 8, Double) ("reserved[2]", reserved, 16, Double)
        ("reserved[3]", reserved, 24, Double) ("reserved[4]", reserved, 32, Double)
    ) },
    Struct { name: "contact_normal_report_visco", members: members!(contact_normal_report_visco:
        ("time", time, 0, Double) ("step_error", step_error, 0, Double) ("time_error", time_error, 0, Double) ("compliance", compliance, 0, Double)
        ("reserved[0]", reserved, 0, Double) ("reserved[1]", reserved, 8, Double) ("reserved[2]", reserved, 16, Double)
        ("reserved[3]", reserved, 24, Double)
    ) },
    Struct { name: "contact_normal_report", members: members!(contact_normal_report:
        ("struct_size", struct_size, 0, Int64) ("ledger_rows", ledger_rows, 0, Int64) ("ledger_capacity", ledger_capacity, 0, Int64)
        ("ledger", ledger, 0, Structs("contact_normal_ledger_row")) ("warnings", warnings, 0, Int32) ("reserved", reserved, 0, Int32)
        ("normal.approach", normal.approach, 0, Double) ("normal.force", normal.force, 0, Double)
        ("normal.max_pressure", normal.max_pressure, 0, Double) ("normal.min_pressure", normal.min_pressure, 0, Double)
        ("normal.contact_area", normal.contact_area, 0, Double) ("normal.corrected_area", normal.corrected_area, 0, Double)
        ("normal.contact_count", normal.contact_count, 0, Int64) ("normal.edge_count", normal.edge_count, 0, Int64)
        ("normal.tolerance", normal.tolerance, 0, Double) ("normal.residual", normal.residual, 0, Double)
        ("normal.violation", normal.violation, 0, Double) ("normal.complementarity", normal.complementarity, 0, Double)
        ("normal.update", normal.update, 0, Double) ("normal.reserved[0]", normal.reserved, 0, Double)
        ("normal.reserved[1]", normal.reserved, 8, Double) ("normal.reserved[2]", normal.reserved, 16, Double)
        ("normal.reserved[3]", normal.reserved, 24, Double) ("normal.reserved[4]", normal.reserved, 32, Double)
        ("normal.reserved[5]", normal.reserved, 40, Double) ("normal.reserved[6]", normal.reserved, 48, Double)
        ("normal.reserved[7]", normal.reserved, 56, Double) ("tangential.force[0]", tangential.force, 0, Double)
        ("tangential.force[1]", tangential.force, 8, Double) ("tangential.moment", tangential.moment, 0, Double)
        ("tangential.creepage[0]", tangential.creepage, 0, Double) ("tangential.creepage[1]", tangential.creepage, 8, Double)
        ("tangential.residual", tangential.residual, 0, Double) ("tangential.gap", tangential.gap, 0, Double)
        ("tangential.stick_count", tangential.stick_count, 0, Int64) ("tangential.slip_count", tangential.slip_count, 0, Int64)
        ("tangential.sensitivities[0]", tangential.sensitivities, 0, Double) ("tangential.sensitivities[1]", tangential.sensitivities, 8, Double)
        ("tangential.sensitivities[2]", tangential.sensitivities, 16, Double) ("tangential.sensitivities[3]", tangential.sensitivities, 24, Double)
        ("tangential.sensitivities[4]", tangential.sensitivities, 32, Double) ("tangential.sensitivities[5]", tangential.sensitivities, 40, Double)
        ("tangential.sensitivities[6]", tangential.sensitivities, 48, Double) ("tangential.sensitivities[7]", tangential.sensitivities, 56, Double)
        ("tangential.sensitivities[8]", tangential.sensitivities, 64, Double) ("tangential.update", tangential.update, 0, Double)
        ("tangential.law_slope", tangential.law_slope, 0, Double) ("tangential.reserved[0]", tangential.reserved, 0, Double)
        ("tangential.reserved[1]", tangential.reserved, 8, Double) ("tangential.reserved[2]", tangential.reserved, 16, Double)
        ("tangential.reserved[3]", tangential.reserved, 24, Double) ("tangential.reserved[4]", tangential.reserved, 32, Double)
        ("tangential.reserved[5]", tangential.reserved, 40, Double) ("accuracy.error_force", accuracy.error_force, 0, Double)
        ("accuracy.error_max_pressure", accuracy.error_max_pressure, 0, Double)
        ("accuracy.error_contact_area", accuracy.error_contact_area, 0, Double)
        ("accuracy.error_corrected_area", accuracy.error_corrected_area, 0, Double) ("accuracy.error_pressure", accuracy.error_pressure, 0, Double)
        ("accuracy.error_tangential[0]", accuracy.error_tangential, 0, Double) ("accuracy.error_tangential[1]", accuracy.error_tangential, 8, Double)
        ("accuracy.untrusted", accuracy.untrusted, 0, Int32) ("accuracy.limited_by", accuracy.limited_by, 0, Int32)
        ("accuracy.halved_seconds", accuracy.halved_seconds, 0, Double) ("accuracy.halved_error_force", accuracy.halved_error_force, 0, Double)
        ("accuracy.neglected", accuracy.neglected, 0, Int64) ("accuracy.neglected_error", accuracy.neglected_error, 0, Double)
        ("accuracy.reserved[0]", accuracy.reserved, 0, Double) ("accuracy.reserved[1]", accuracy.reserved, 8, Double)
        ("accuracy.reserved[2]", accuracy.reserved, 16, Double) ("accuracy.reserved[3]", accuracy.reserved, 24, Double)
        ("accuracy.reserved[4]", accuracy.reserved, 32, Double) ("accuracy.reserved[5]", accuracy.reserved, 40, Double)
        ("statistics.cycles", statistics.cycles, 0, Int64) ("statistics.active_set_steps", statistics.active_set_steps, 0, Int64)
        ("statistics.active_set_changes", statistics.active_set_changes, 0, Int64)
        ("statistics.matrix_products", statistics.matrix_products, 0, Int64) ("statistics.work_units", statistics.work_units, 0, Double)
        ("statistics.tangential_products", statistics.tangential_products, 0, Double)
        ("statistics.setup_seconds", statistics.setup_seconds, 0, Double) ("statistics.solve_seconds", statistics.solve_seconds, 0, Double)
        ("statistics.tangential_seconds", statistics.tangential_seconds, 0, Double) ("statistics.bytes", statistics.bytes, 0, Int64)
        ("statistics.reserved[0]", statistics.reserved, 0, Double) ("statistics.reserved[1]", statistics.reserved, 8, Double)
        ("statistics.reserved[2]", statistics.reserved, 16, Double) ("statistics.reserved[3]", statistics.reserved, 24, Double)
        ("statistics.reserved[4]", statistics.reserved, 32, Double) ("statistics.reserved[5]", statistics.reserved, 40, Double)
        ("statistics.reserved[6]", statistics.reserved, 48, Double) ("statistics.reserved[7]", statistics.reserved, 56, Double)
        ("adhesion.repulsive_force", adhesion.repulsive_force, 0, Double) ("adhesion.adhesive_force", adhesion.adhesive_force, 0, Double)
        ("adhesion.elastic_energy", adhesion.elastic_energy, 0, Double) ("adhesion.adhesive_energy", adhesion.adhesive_energy, 0, Double)
        ("adhesion.law_residual", adhesion.law_residual, 0, Double) ("adhesion.range", adhesion.range, 0, Double)
        ("adhesion.resolution", adhesion.resolution, 0, Double) ("adhesion.border_share", adhesion.border_share, 0, Double)
        ("adhesion.stiffness", adhesion.stiffness, 0, Double) ("adhesion.stability", adhesion.stability, 0, Double)
        ("adhesion.jumped", adhesion.jumped, 0, Int32) ("adhesion.reserved_integer", adhesion.reserved_integer, 0, Int32)
        ("adhesion.reserved[0]", adhesion.reserved, 0, Double) ("adhesion.reserved[1]", adhesion.reserved, 8, Double)
        ("adhesion.reserved[2]", adhesion.reserved, 16, Double) ("adhesion.reserved[3]", adhesion.reserved, 24, Double)
        ("adhesion.reserved[4]", adhesion.reserved, 32, Double) ("visco.time", visco.time, 0, Double)
        ("visco.step_error", visco.step_error, 0, Double) ("visco.time_error", visco.time_error, 0, Double)
        ("visco.compliance", visco.compliance, 0, Double) ("visco.reserved[0]", visco.reserved, 0, Double)
        ("visco.reserved[1]", visco.reserved, 8, Double) ("visco.reserved[2]", visco.reserved, 16, Double)
        ("visco.reserved[3]", visco.reserved, 24, Double)
    ) },
    Struct { name: "contact_normal_solver_info", members: members!(contact_normal_solver_info:
        ("struct_size", struct_size, 0, Int64) ("mx", mx, 0, Int32) ("my", my, 0, Int32) ("dx", dx, 0, Double) ("dy", dy, 0, Double)
        ("threads", threads, 0, Int32) ("has_result", has_result, 0, Int32) ("bytes", bytes, 0, Int64)
    ) },
    Struct { name: "contact_normal_friction_results", members: members!(contact_normal_friction_results:
        ("struct_size", struct_size, 0, Int64) ("force", force, 0, Array) ("moment", moment, 0, Array) ("creepage", creepage, 0, Array)
        ("residual", residual, 0, Array) ("gap", gap, 0, Array) ("products", products, 0, Array) ("stick_count", stick_count, 0, Array)
        ("slip_count", slip_count, 0, Array) ("status", status, 0, Array) ("traction", traction, 0, Array) ("slip", slip, 0, Array)
        ("stick_slip", stick_slip, 0, Array) ("friction_coefficient", friction_coefficient, 0, Array) ("yield_limit", yield_limit, 0, Array)
    ) },
    Struct { name: "contact_normal_accuracy", members: members!(contact_normal_accuracy:
        ("struct_size", struct_size, 0, Int64) ("target", target, 0, Double) ("max_seconds", max_seconds, 0, Double)
        ("max_bytes", max_bytes, 0, Int64) ("max_elements", max_elements, 0, Int64) ("surface", surface, 0, OfTheHost) ("user", user, 0, OfTheHost)
        ("mx", mx, 0, Int32) ("my", my, 0, Int32) ("dx", dx, 0, Double) ("dy", dy, 0, Double) ("reached", reached, 0, Double)
        ("seconds", seconds, 0, Double) ("max_pressure_target", max_pressure_target, 0, Double)
        ("contact_area_target", contact_area_target, 0, Double) ("mean_gap_target", mean_gap_target, 0, Double)
        ("stiffness_target", stiffness_target, 0, Double) ("tangential_force_target", tangential_force_target, 0, Double)
        ("creepage_target", creepage_target, 0, Double) ("spin_moment_target", spin_moment_target, 0, Double)
        ("stick_area_target", stick_area_target, 0, Double) ("max_von_mises_target", max_von_mises_target, 0, Double)
        ("von_mises_depth_target", von_mises_depth_target, 0, Double) ("max_shear_target", max_shear_target, 0, Double)
    ) },
    Struct { name: "contact_normal_price", members: members!(contact_normal_price:
        ("struct_size", struct_size, 0, Int64) ("target", target, 0, Double) ("error", error, 0, Double) ("tolerance", tolerance, 0, Double)
        ("seconds", seconds, 0, Double) ("seconds_one_thread", seconds_one_thread, 0, Double) ("bytes", bytes, 0, Int64) ("mx", mx, 0, Int32)
        ("my", my, 0, Int32) ("dx", dx, 0, Double) ("dy", dy, 0, Double) ("obstacle", obstacle, 0, Int32) ("reserved", reserved, 0, Int32)
        ("time_error", time_error, 0, Double) ("work_units", work_units, 0, Double)
    ) },
    Struct { name: "contact_normal_quantity_row", members: members!(contact_normal_quantity_row:
        ("struct_size", struct_size, 0, Int64) ("quantity", quantity, 0, Int32) ("lack", lack, 0, Int32) ("mx", mx, 0, Int32) ("my", my, 0, Int32)
        ("value", value, 0, Double) ("error", error, 0, Double) ("seconds", seconds, 0, Double) ("work_units", work_units, 0, Double)
    ) },
    Struct { name: "contact_normal_effects_row", members: members!(contact_normal_effects_row:
        ("struct_size", struct_size, 0, Int64) ("omitted", omitted, 0, Int32) ("also_omitted", also_omitted, 0, Int32)
        ("quantity", quantity, 0, Int32) ("verdict", verdict, 0, Int32) ("lack", lack, 0, Int32) ("reserved", reserved, 0, Int32)
        ("value", value, 0, Double) ("change", change, 0, Double) ("change_error", change_error, 0, Double) ("seconds", seconds, 0, Double)
        ("seconds_without", seconds_without, 0, Double) ("bytes", bytes, 0, Double) ("bytes_without", bytes_without, 0, Double)
    ) },
    Struct { name: "contact_normal_hertz_solution", members: members!(contact_normal_hertz_solution:
        ("struct_size", struct_size, 0, Int64) ("semi_axis_x", semi_axis_x, 0, Double) ("semi_axis_y", semi_axis_y, 0, Double)
        ("max_pressure", max_pressure, 0, Double) ("approach", approach, 0, Double) ("force", force, 0, Double) ("area", area, 0, Double)
    ) },
    Struct { name: "contact_normal_stress_maximum", members: members!(contact_normal_stress_maximum:
        ("struct_size", struct_size, 0, Int64) ("value", value, 0, Double) ("x", x, 0, Double) ("y", y, 0, Double) ("z", z, 0, Double)
        ("ix", ix, 0, Int32) ("iy", iy, 0, Int32) ("depth", depth, 0, Int32) ("reserved", reserved, 0, Int32)
    ) },
    Struct { name: "contact_normal_stress_outputs", members: members!(contact_normal_stress_outputs:
        ("struct_size", struct_size, 0, Int64) ("stress[0]", stress, 0, Array) ("stress[1]", stress, 8, Array) ("stress[2]", stress, 16, Array)
        ("stress[3]", stress, 24, Array) ("stress[4]", stress, 32, Array) ("stress[5]", stress, 40, Array) ("von_mises", von_mises, 0, Array)
        ("maximum_shear", maximum_shear, 0, Array) ("principal[0]", principal, 0, Array) ("principal[1]", principal, 8, Array)
        ("principal[2]", principal, 16, Array) ("directions[0]", directions, 0, Array) ("directions[1]", directions, 8, Array)
        ("directions[2]", directions, 16, Array) ("largest_von_mises", largest_von_mises, 0, Structs("contact_normal_stress_maximum"))
        ("largest_shear", largest_shear, 0, Structs("contact_normal_stress_maximum"))
    ) },
    Struct { name: "contact_normal_heat", members: members!(contact_normal_heat:
        ("struct_size", struct_size, 0, Int64) ("mx", mx, 0, Int32) ("my", my, 0, Int32) ("dx", dx, 0, Double) ("dy", dy, 0, Double)
        ("heat_flux", heat_flux, 0, Array) ("conductivity[0]", conductivity, 0, Double) ("conductivity[1]", conductivity, 8, Double)
        ("diffusivity[0]", diffusivity, 0, Double) ("diffusivity[1]", diffusivity, 8, Double) ("speed[0]", speed, 0, Double)
        ("speed[1]", speed, 8, Double) ("share", share, 0, Double) ("threads", threads, 0, Int32) ("reserved", reserved, 0, Int32)
    ) },
    Struct { name: "contact_normal_flash", members: members!(contact_normal_flash:
        ("struct_size", struct_size, 0, Int64) ("share", share, 0, Double) ("largest[0]", largest, 0, Double) ("largest[1]", largest, 8, Double)
        ("x[0]", x, 0, Double) ("x[1]", x, 8, Double) ("y[0]", y, 0, Double) ("y[1]", y, 8, Double)
    ) },
    Struct { name: "contact_normal_wear", members: members!(contact_normal_wear:
        ("struct_size", struct_size, 0, Int64) ("mx", mx, 0, Int32) ("my", my, 0, Int32) ("dx", dx, 0, Double) ("dy", dy, 0, Double)
        ("traction[0]", traction, 0, Array) ("traction[1]", traction, 8, Array) ("slip[0]", slip, 0, Array) ("slip[1]", slip, 8, Array)
        ("pressure", pressure, 0, Array) ("coefficient", coefficient, 0, Double) ("coefficients", coefficients, 0, Array)
        ("hardness", hardness, 0, Double) ("steps", steps, 0, Double) ("rolling_distance", rolling_distance, 0, Double)
    ) },
    Struct { name: "contact_normal_worn", members: members!(contact_normal_worn:
        ("struct_size", struct_size, 0, Int64) ("work", work, 0, Double) ("volume", volume, 0, Double) ("largest_depth", largest_depth, 0, Double)
        ("x", x, 0, Double) ("y", y, 0, Double)
    ) },
];
