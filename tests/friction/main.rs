//! The tangential problem: every number is compared with a closed form, a quadrature, a direct sum, or the result of another program.

mod batch;
mod bounds_of_laws;
mod branches;
mod cancelling;
#[path = "../problems/families/case.rs"]
#[allow(dead_code)] // only the shapes are used
mod case;
mod cattaneo;
mod coated;
mod coated_coefficients;
mod coefficients;
mod conditions;
mod dense;
mod effects;
mod estimates;
mod estimates_of_small_shifts;
mod forces;
mod glued;
#[allow(dead_code)] // only the cases of docs/reliability_friction.md are used
mod hard;
mod ideal_layer;
mod law_slopes;
mod laws;
mod laws_by_force;
mod laws_steep;
mod laws_that_rise;
mod laws_that_rise_together;
mod layer;
mod linear_theory;
mod long_elements;
mod near_full_slip;
mod norm_and_tang;
mod onset_of_rolling;
mod own_law;
mod plastic;
mod refusals;
mod rolled_towards;
mod rolling;
mod rolling_tables;
mod row_tables;
mod same_bits;
#[path = "../../examples/friction/scenes.rs"]
#[allow(dead_code)]
mod scenes;
mod sensitivities;
mod slender_that_roll;
mod stalls;
mod steady;
mod steady_hard_cases;
#[path = "../../examples/friction/steady.rs"]
mod steady_scenes;
mod stiff_coats;
mod stopping_rule;
mod support;
mod tables;
mod threads;
mod unlike;
mod unlike_at_limit;
mod unlike_forces;
mod unlike_sensitivities;
mod unloading;
mod wear;
mod weights;
mod wheel_on_rail;
mod wheel_rail;
