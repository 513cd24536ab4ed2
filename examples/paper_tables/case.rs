//! The test problem of the paper (section 5.1) and the runs behind its tables.

use contact_normal::grid::Grid;
use contact_normal::methods::multigrid::{CycleShape, SmootherKind};
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{solve, ActiveSet, Guess, Method, Options, Outcome, Report, Solver};

/// The coefficients of x^2 and y^2 of the undeformed distance, in 1/mm.
pub const CURVATURE: (f64, f64) = (0.0016681, 0.0030671);
/// The approach, in mm.
pub const APPROACH: f64 = 0.1091;
/// The shear modulus of steel, in N/mm2.
pub const SHEAR_MODULUS: f64 = 82000.0;
pub const POISSON_RATIO: f64 = 0.28;

/// The grid of m x m elements on `[-10, 10] x [-6, 6]` mm.
pub fn grid(m: usize) -> Grid {
    Grid::new(m, m, 20.0 / m as f64, 12.0 / m as f64).expect("a valid grid")
}

/// The undeformed distance at the element centres.
pub fn undeformed_distance(m: usize) -> Vec<f64> {
    let grid = grid(m);
    let centre = |i: usize, d: f64| (i as f64 + 0.5 - 0.5 * m as f64) * d;
    (0..grid.len())
        .map(|i| {
            let (x, y) = (centre(i % m, grid.dx), centre(i / m, grid.dy));
            CURVATURE.0 * x * x + CURVATURE.1 * y * y
        })
        .collect()
}

/// The scene with a prescribed approach.
pub fn scene(m: usize, h: &[f64]) -> Scene<'_> {
    Scene::new(grid(m), h, Bodies::same(SHEAR_MODULUS, POISSON_RATIO), Load::Approach(APPROACH))
}

/// Table 1: solves the linear system on the fixed contact area `C^1 = {h <= approach}`. Also returns the mean factor by which a cycle, or an
/// iteration, reduces the residual.
pub fn linear_system(
    m: usize,
    method: Method,
    smoother: SmootherKind,
    relaxation: f64,
    most: usize,
) -> (Outcome, Report, f64) {
    let h = undeformed_distance(m);
    let scene = scene(m, &h);
    let options = Options {
        method,
        cycle: CycleShape { smoother, relaxation, ..CycleShape::default() },
        active_set: ActiveSet::Fixed,
        max_cycles: most,
        ..Options::default()
    };
    let contact: Vec<bool> = h.iter().map(|&h| h <= APPROACH).collect();
    let guess = Guess { pressure: &vec![0.0; h.len()], contact: &contact };
    let mut solver = Solver::new(&scene, &options).expect("a valid scene");
    let (stop, report) = solver.solve(&scene, &options, Some(guess), None).expect("a solvable scene");
    let factor = report.measures.certificate.residual.powf(1.0 / report.count.cycles as f64);
    (stop, report, factor)
}

/// Tables 2 and 3: solves the whole contact problem by one of the methods.
pub fn whole_problem(m: usize, method: Method, pre_sweeps: usize, post_sweeps: usize) -> (Outcome, Report) {
    let h = undeformed_distance(m);
    let options = Options {
        method,
        cycle: CycleShape { pre_sweeps, post_sweeps, ..CycleShape::default() },
        ..Options::default()
    };
    let (_, stop, report) = solve(&scene(m, &h), &options).expect("a solvable scene");
    (stop, report)
}
