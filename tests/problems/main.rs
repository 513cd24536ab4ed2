//! Results of the library: every number is compared with a closed form, a direct sum or a recomputed certificate.

// These cases are shared with the examples and benchmarks.
#[path = "../../examples/accuracy/judge.rs"]
#[allow(dead_code)]
mod judge;
#[path = "../../examples/paper_tables/case.rs"]
#[allow(dead_code)]
mod paper;
#[path = "../../benches/performance/case.rs"]
#[allow(dead_code)]
mod performance;
#[path = "../../campaign/src/random.rs"]
#[allow(dead_code)]
mod random;
#[path = "../../examples/smoothers/rough.rs"]
mod rough;
#[path = "../../examples/accuracy/surfaces.rs"]
mod surfaces;

mod accuracy;
mod accuracy_target;
mod batch;
mod bearing_area;
mod beside_limits;
mod bill;
mod bill_of_areas;
mod bill_of_unsolved;
mod bodies_apart;
mod coated_period;
mod coating;
mod coating_on_rigid;
mod coefficients;
mod counted_costs;
mod dashpots;
mod dense;
mod effects;
mod ends_of_range;
mod estimates;
mod estimates_at_edges;
mod estimates_of_kinds;
mod every_grid;
mod families;
mod fft_smoother;
mod fresh_products;
mod full_contact;
mod hard_cases;
mod heat;
mod hertz;
mod influence;
mod kinds_of_surfaces;
mod kinks;
mod layer;
mod limits_that_differ;
mod line_contact;
mod line_scans;
mod linear;
mod long_rows;
mod meaningless;
mod measured_surfaces;
mod operator;
mod own_coefficients;
mod paper_tables;
mod patches;
mod periodic;
mod periodic_beyond_the_mean;
mod periodic_by_approach;
mod pressure_limit;
mod properties;
mod pulled_contact;
mod quantities;
mod random_problems;
mod refine;
mod refused_coarse_grids;
mod rough_surface;
mod row_tables;
mod slow_quantities;
mod smoothers;
mod special;
mod starts_at_limits;
mod steps_of_the_surface;
mod stress_of_patches;
mod stress_on_edges;
mod subsurface_stress;
mod support;
mod threads;
mod visco;
mod visco_prices;
mod visco_rolling;
mod visco_steps;
mod wheel_rail;
mod white_noise;
