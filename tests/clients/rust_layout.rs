//! The sizes of the structs, and the offsets of their members, as Rust has them. Made from include/contact_normal.h; do not edit.

use std::mem::offset_of;

use contact_normal::ffi::*;

macro_rules! layout {
    ($($struct:ident { $($member:ident)* })*) => {
        /// "struct" and its size, then "struct.member" and its offset.
        pub fn layout() -> Vec<(&'static str, usize)> {
            vec![$(
                (stringify!($struct), size_of::<$struct>()),
                $((concat!(stringify!($struct), ".", stringify!($member)), offset_of!($struct, $member)),)*
            )*]
        }
    };
}

layout! {
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
    contact_normal_progress {
        struct_size mx my cycles active_set_changes seconds work_units update residual
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
    contact_normal_report_normal {
        approach force max_pressure min_pressure contact_area corrected_area contact_count edge_count tolerance residual violation complementarity
        update reserved
    }
    contact_normal_report_tangential {
        force moment creepage residual gap stick_count slip_count sensitivities update law_slope reserved
    }
    contact_normal_report_accuracy {
        error_force error_max_pressure error_contact_area error_corrected_area error_pressure error_tangential untrusted limited_by halved_seconds
        halved_error_force neglected neglected_error reserved
    }
    contact_normal_report_statistics {
        cycles active_set_steps active_set_changes matrix_products work_units tangential_products setup_seconds solve_seconds tangential_seconds bytes
        reserved
    }
    contact_normal_report_adhesion {
        repulsive_force adhesive_force elastic_energy adhesive_energy law_residual range resolution border_share stiffness stability jumped
        reserved_integer reserved
    }
    contact_normal_report_visco {
        time step_error time_error compliance reserved
    }
    contact_normal_report {
        struct_size ledger_rows ledger_capacity ledger warnings reserved normal tangential accuracy statistics adhesion visco
    }
    contact_normal_solver_info {
        struct_size mx my dx dy threads has_result bytes
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
    contact_normal_quantity_row {
        struct_size quantity lack mx my value error seconds work_units
    }
    contact_normal_effects_row {
        struct_size omitted also_omitted quantity verdict lack reserved value change change_error seconds seconds_without bytes bytes_without
    }
    contact_normal_hertz_solution {
        struct_size semi_axis_x semi_axis_y max_pressure approach force area
    }
    contact_normal_stress_maximum {
        struct_size value x y z ix iy depth reserved
    }
    contact_normal_stress_outputs {
        struct_size stress von_mises maximum_shear principal directions largest_von_mises largest_shear
    }
    contact_normal_heat {
        struct_size mx my dx dy heat_flux conductivity diffusivity speed share threads reserved
    }
    contact_normal_flash {
        struct_size share largest x y
    }
    contact_normal_wear {
        struct_size mx my dx dy traction slip pressure coefficient coefficients hardness steps rolling_distance
    }
    contact_normal_worn {
        struct_size work volume largest_depth x y
    }
}
