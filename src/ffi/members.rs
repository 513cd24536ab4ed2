//! The constants, the structs and their members by name. Made from include/contact_normal.h; do not edit.

use super::member::{constants, structs, Member, Struct};
use super::*;

/// The constants of the header. Each comes with its name without `CONTACT_NORMAL_`.
#[rustfmt::skip]
pub(super) const CONSTANTS: &[(&str, i32)] = constants! {
    CONTACT_NORMAL_OK CONTACT_NORMAL_ITERATION_LIMIT CONTACT_NORMAL_CANCELLED CONTACT_NORMAL_STAGNATED CONTACT_NORMAL_NULL_POINTER
    CONTACT_NORMAL_INVALID_ARGUMENT CONTACT_NORMAL_NOT_FINITE CONTACT_NORMAL_STRUCT_SIZE CONTACT_NORMAL_UNSUPPORTED CONTACT_NORMAL_INFEASIBLE
    CONTACT_NORMAL_NOT_POSITIVE_DEFINITE CONTACT_NORMAL_OUT_OF_MEMORY CONTACT_NORMAL_INFLUENCE_CHANGED CONTACT_NORMAL_INTERNAL
    CONTACT_NORMAL_VERSION_MAJOR CONTACT_NORMAL_VERSION_MINOR CONTACT_NORMAL_VERSION_PATCH CONTACT_NORMAL_ABI_VERSION CONTACT_NORMAL_KIND_SCENE
    CONTACT_NORMAL_KIND_OPTIONS CONTACT_NORMAL_KIND_FIELDS CONTACT_NORMAL_KIND_REPORT CONTACT_NORMAL_KIND_ACCURACY CONTACT_NORMAL_KIND_INFLUENCE
    CONTACT_NORMAL_KIND_ROW_TABLES CONTACT_NORMAL_KIND_LAYER CONTACT_NORMAL_KIND_PRESSURE_LIMIT CONTACT_NORMAL_KIND_PERIOD CONTACT_NORMAL_KIND_PATCHES
    CONTACT_NORMAL_KIND_COATING CONTACT_NORMAL_KIND_FRICTION CONTACT_NORMAL_KIND_FRICTION_RESULTS CONTACT_NORMAL_KIND_STRESS_OUTPUTS
    CONTACT_NORMAL_KIND_STRESS_MAXIMUM CONTACT_NORMAL_KIND_LEDGER_ROW CONTACT_NORMAL_KIND_PRICE CONTACT_NORMAL_KIND_HERTZ_SOLUTION
    CONTACT_NORMAL_KIND_CYCLE CONTACT_NORMAL_KIND_SOLVER_INFO CONTACT_NORMAL_KIND_QUANTITY_ROW CONTACT_NORMAL_KIND_EFFECTS_ROW
    CONTACT_NORMAL_KIND_ADHESION CONTACT_NORMAL_KIND_VISCO CONTACT_NORMAL_KIND_HEAT CONTACT_NORMAL_KIND_FLASH CONTACT_NORMAL_KIND_WEAR
    CONTACT_NORMAL_KIND_WORN CONTACT_NORMAL_PRESCRIBED_UNSET CONTACT_NORMAL_PRESCRIBED_APPROACH CONTACT_NORMAL_PRESCRIBED_FORCE
    CONTACT_NORMAL_MOTION_SHIFT CONTACT_NORMAL_MOTION_TRANSIENT_ROLLING CONTACT_NORMAL_MOTION_STEADY_ROLLING CONTACT_NORMAL_PRESCRIBED_CREEPAGE
    CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE CONTACT_NORMAL_FRICTION_LAW_COULOMB CONTACT_NORMAL_FRICTION_LAW_LINEAR
    CONTACT_NORMAL_FRICTION_LAW_RATIONAL CONTACT_NORMAL_FRICTION_LAW_EXPONENTIAL CONTACT_NORMAL_FRICTION_BRANCH_NEAR
    CONTACT_NORMAL_FRICTION_BRANCH_LOW CONTACT_NORMAL_FRICTION_BRANCH_HIGH CONTACT_NORMAL_STICK_SLIP_EXTERIOR CONTACT_NORMAL_STICK_SLIP_STICK
    CONTACT_NORMAL_STICK_SLIP_SLIP CONTACT_NORMAL_STICK_SLIP_PLASTIC CONTACT_NORMAL_LAW_EXPONENTIAL CONTACT_NORMAL_LAW_DUGDALE
    CONTACT_NORMAL_LAW_CUBIC CONTACT_NORMAL_LAW_VAN_DER_WAALS CONTACT_NORMAL_START_AUTO CONTACT_NORMAL_START_FROM_CONTACT
    CONTACT_NORMAL_START_FROM_APART CONTACT_NORMAL_FORM_AUTO CONTACT_NORMAL_FORM_RELAXATION CONTACT_NORMAL_FORM_CREEP
    CONTACT_NORMAL_FORM_BACKWARD_EULER CONTACT_NORMAL_METHOD_AUTO CONTACT_NORMAL_METHOD_NORM CONTACT_NORMAL_METHOD_MULTIGRID
    CONTACT_NORMAL_METHOD_FULL_MULTIGRID CONTACT_NORMAL_METHOD_PROJECTED_CG CONTACT_NORMAL_SMOOTHER_AUTO CONTACT_NORMAL_SMOOTHER_GAUSS_SEIDEL
    CONTACT_NORMAL_SMOOTHER_RED_BLACK CONTACT_NORMAL_SMOOTHER_JACOBI CONTACT_NORMAL_SMOOTHER_FFT CONTACT_NORMAL_ACTIVE_SET_FREE
    CONTACT_NORMAL_ACTIVE_SET_FIXED CONTACT_NORMAL_INITIAL_GUESS_NONE CONTACT_NORMAL_INITIAL_GUESS_GIVEN CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS
    CONTACT_NORMAL_CRITERION_RESIDUAL CONTACT_NORMAL_CRITERION_UPDATE CONTACT_NORMAL_PRECISION_AUTO CONTACT_NORMAL_PRECISION_DOUBLE
    CONTACT_NORMAL_PRECISION_MIXED CONTACT_NORMAL_WARNING_BORDER CONTACT_NORMAL_WARNING_ONE_ELEMENT CONTACT_NORMAL_WARNING_SPIKE
    CONTACT_NORMAL_WARNING_ERROR_UNKNOWN CONTACT_NORMAL_WARNING_RANGE CONTACT_NORMAL_WARNING_ATTRACTION CONTACT_NORMAL_WARNING_LAW
    CONTACT_NORMAL_UNTRUSTED_FORCE CONTACT_NORMAL_UNTRUSTED_MAX_PRESSURE CONTACT_NORMAL_UNTRUSTED_PRESSURE CONTACT_NORMAL_LIMITED_BY_UNKNOWN
    CONTACT_NORMAL_LIMITED_BY_GRID CONTACT_NORMAL_LIMITED_BY_TOLERANCE CONTACT_NORMAL_QUANTITY_FORCE CONTACT_NORMAL_QUANTITY_MAX_PRESSURE
    CONTACT_NORMAL_QUANTITY_CONTACT_AREA CONTACT_NORMAL_QUANTITY_MEAN_GAP CONTACT_NORMAL_QUANTITY_STIFFNESS CONTACT_NORMAL_QUANTITY_TANGENTIAL_FORCE
    CONTACT_NORMAL_QUANTITY_CREEPAGE CONTACT_NORMAL_QUANTITY_SPIN_MOMENT CONTACT_NORMAL_QUANTITY_STICK_AREA CONTACT_NORMAL_QUANTITY_MAX_VON_MISES
    CONTACT_NORMAL_QUANTITY_VON_MISES_DEPTH CONTACT_NORMAL_QUANTITY_MAX_SHEAR CONTACT_NORMAL_OBSTACLE_NONE CONTACT_NORMAL_OBSTACLE_SINGULAR
    CONTACT_NORMAL_OBSTACLE_ROUND_OFF CONTACT_NORMAL_OBSTACLE_ELEMENTS CONTACT_NORMAL_OBSTACLE_MEMORY CONTACT_NORMAL_OBSTACLE_TIME
    CONTACT_NORMAL_OBSTACLE_STEP CONTACT_NORMAL_LACK_NONE CONTACT_NORMAL_LACK_NO_FRICTION CONTACT_NORMAL_LACK_PRESCRIBED CONTACT_NORMAL_LACK_EFFECT
    CONTACT_NORMAL_LACK_NO_CONTACT CONTACT_NORMAL_LACK_SINGULAR CONTACT_NORMAL_LACK_ONE_GRID CONTACT_NORMAL_LACK_UNSOLVED
    CONTACT_NORMAL_LACK_UNSETTLED CONTACT_NORMAL_OMIT_NONE CONTACT_NORMAL_OMIT_COATING CONTACT_NORMAL_OMIT_PERIOD CONTACT_NORMAL_OMIT_PATCHES
    CONTACT_NORMAL_OMIT_LAYER CONTACT_NORMAL_OMIT_PRESSURE_LIMIT CONTACT_NORMAL_OMIT_FRICTION CONTACT_NORMAL_OMIT_COUPLING CONTACT_NORMAL_OMIT_SPIN
    CONTACT_NORMAL_OMIT_FRICTION_COMPLIANCE CONTACT_NORMAL_OMIT_COATING_AS_LAYER CONTACT_NORMAL_OMIT_ADHESION CONTACT_NORMAL_OMIT_FRICTION_LAW
    CONTACT_NORMAL_OMIT_FRICTION_LAYER CONTACT_NORMAL_OMIT_VISCO CONTACT_NORMAL_VERDICT_NOT_DECIDED CONTACT_NORMAL_VERDICT_NEGLIGIBLE
    CONTACT_NORMAL_VERDICT_NEEDED CONTACT_NORMAL_LOG_OFF CONTACT_NORMAL_LOG_WARNING CONTACT_NORMAL_LOG_INFO
};

/// The structs that a dump may hold.
#[rustfmt::skip]
const STRUCTS: &[Struct] = structs! {
    contact_normal_coating {
        struct_size thickness shear_modulus poisson_ratio
    }
    contact_normal_influence {
        struct_size cx cy coefficients scale
    }
    contact_normal_layer {
        struct_size compliance compliances
    }
    contact_normal_pressure_limit {
        struct_size limit limits
    }
    contact_normal_period {
        struct_size x y
    }
    contact_normal_patches {
        struct_size count reserved patch factors
    }
    contact_normal_row_tables {
        struct_size cx rows coefficients scale
    }
    contact_normal_friction {
        struct_size coefficient coefficients motion continues prescribed creepage spin spin_centre force rolling_distance rolling_direction
        spin_offset previous_traction rigid_slip influence influence_cross sensitivities reserved initial_traction compliance compliances
        creepage_weight row_tables law reserved_for_law kinetic falling half_speed speed time_step memory_distance memory_speed yield_limit hardening
        previous_coefficient previous_yield_limit branch reserved_for_branch
    }
    contact_normal_adhesion {
        struct_size law start work_of_adhesion works_of_adhesion range smear stiffness stability shear_strength
    }
    contact_normal_visco {
        struct_size branches modulus time time_step form continues
    }
    contact_normal_scene {
        struct_size mx my dx dy undeformed_distance shear_modulus poisson_ratio load reserved approach force influence layer pressure_limit period
        patches row_tables coating friction adhesion visco
    }
    contact_normal_cycle {
        struct_size smoother pre_sweeps post_sweeps coarsest relaxation
    }
    contact_normal_options {
        struct_size method active_set initial_guess criterion tolerance error_ratio max_cycles threads precision reserved progress user cycle
        max_seconds stop dump neglect_below
    }
    contact_normal_fields {
        struct_size pressure deformed_distance displacement contact traction slip stick_slip contact_pressure attraction friction_coefficient
        yield_limit
    }
    contact_normal_ledger_row {
        struct_size mx my cycles seconds work_units residual approach force max_pressure contact_area corrected_area error_force error_max_pressure
        error_contact_area error_corrected_area error_pressure contact_count untrusted reserved
    }
    contact_normal_report {
        struct_size ledger_rows ledger_capacity ledger warnings reserved normal.approach normal.force normal.max_pressure normal.min_pressure
        normal.contact_area normal.corrected_area normal.contact_count normal.edge_count normal.tolerance normal.residual normal.violation
        normal.complementarity normal.update normal.reserved tangential.force tangential.moment tangential.creepage tangential.residual tangential.gap
        tangential.stick_count tangential.slip_count tangential.sensitivities tangential.update tangential.law_slope tangential.reserved
        accuracy.error_force accuracy.error_max_pressure accuracy.error_contact_area accuracy.error_corrected_area accuracy.error_pressure
        accuracy.error_tangential accuracy.untrusted accuracy.limited_by accuracy.halved_seconds accuracy.halved_error_force accuracy.neglected
        accuracy.neglected_error accuracy.reserved statistics.cycles statistics.active_set_steps statistics.active_set_changes
        statistics.matrix_products statistics.work_units statistics.tangential_products statistics.setup_seconds statistics.solve_seconds
        statistics.tangential_seconds statistics.bytes statistics.reserved adhesion.repulsive_force adhesion.adhesive_force adhesion.elastic_energy
        adhesion.adhesive_energy adhesion.law_residual adhesion.range adhesion.resolution adhesion.border_share adhesion.stiffness adhesion.stability
        adhesion.jumped adhesion.reserved_integer adhesion.reserved visco.time visco.step_error visco.time_error visco.compliance visco.reserved
    }
    contact_normal_friction_results {
        struct_size force moment creepage residual gap products stick_count slip_count status traction slip stick_slip friction_coefficient
        yield_limit
    }
    contact_normal_accuracy {
        struct_size target max_seconds max_bytes max_elements surface user mx my dx dy reached seconds max_pressure_target contact_area_target
        mean_gap_target stiffness_target tangential_force_target creepage_target spin_moment_target stick_area_target max_von_mises_target
        von_mises_depth_target max_shear_target
    }
    contact_normal_price {
        struct_size target error tolerance seconds seconds_one_thread bytes mx my dx dy obstacle reserved time_error work_units
    }
    contact_normal_stress_maximum {
        struct_size value x y z ix iy depth reserved
    }
    contact_normal_stress_outputs {
        struct_size stress von_mises maximum_shear principal directions largest_von_mises largest_shear
    }
};

/// The struct of this name.
pub(super) fn structure(name: &str) -> Option<&'static Struct> {
    STRUCTS.iter().find(|each| each.name == name)
}
