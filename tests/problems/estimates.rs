//! Estimated errors compared with true errors: for the ellipse, sphere, cone and flat punch with exact solutions, and for other surfaces with
//! solutions on finer grids.

use std::f64::consts::{FRAC_PI_2, PI};

use contact_normal::analytic::hertz;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{solve, DiscretisationError, LedgerRow, Limit, Method, Options, Outcome, Report, Solver};

use crate::performance as case;

/// E* = 1.
const UNIT: Bodies = Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0, 0.0] };

/// A problem with a closed-form solution on a square or rectangle of any number of elements.
struct Exact {
    name: &'static str,
    size: (f64, f64),
    bodies: Bodies,
    h: fn(f64, f64) -> f64,
    approach: f64,
    force: f64,
    /// `None`: the pressure is infinite.
    max_pressure: Option<f64>,
    area: f64,
}

fn ellipse() -> Exact {
    let exact = hertz(0.0016681, 0.0030671, 0.1091, (1.0 - 0.28) / 82000.0).unwrap();
    Exact {
        name: "ellipse",
        size: (20.0, 12.0),
        bodies: Bodies::same(82000.0, 0.28),
        h: |x, y| 0.0016681 * x * x + 0.0030671 * y * y,
        approach: 0.1091,
        force: exact.force,
        max_pressure: Some(exact.max_pressure),
        area: exact.area,
    }
}

fn sphere() -> Exact {
    let exact = hertz(0.5, 0.5, 0.13, 1.0).unwrap();
    Exact {
        name: "sphere",
        size: (1.0, 1.0),
        bodies: UNIT,
        h: |x, y| 0.5 * (x * x + y * y),
        approach: 0.13,
        force: exact.force,
        max_pressure: Some(exact.max_pressure),
        area: exact.area,
    }
}

/// A cone, h = r: approach = pi a/2, F = pi a^2/2 with E* = 1. The pressure is infinite at the tip (Johnson, Contact Mechanics, section 5.2, after
/// Love).
fn cone() -> Exact {
    let a = 0.37;
    Exact {
        name: "cone",
        size: (1.0, 1.0),
        bodies: UNIT,
        h: f64::hypot,
        approach: FRAC_PI_2 * a,
        force: FRAC_PI_2 * a * a,
        max_pressure: None,
        area: PI * a * a,
    }
}

/// A flat circular punch of radius a: F = 2 a d with E* = 1, for the approach d. The pressure is infinite at the edge.
fn punch() -> Exact {
    let (a, d) = (0.37, 0.1);
    Exact {
        name: "punch",
        size: (1.0, 1.0),
        bodies: UNIT,
        h: |x, y| if x.hypot(y) < 0.37 { 0.0 } else { f64::INFINITY },
        approach: d,
        force: 2.0 * a * d,
        max_pressure: None,
        area: PI * a * a,
    }
}

impl Exact {
    /// Solves on m x m elements. Returns the ledger and the report.
    fn solve(&self, m: usize, by_force: bool, options: &Options) -> (Vec<LedgerRow>, Report) {
        let (solver, report) = self.solver(m, by_force, options);
        (solver.ledger().to_vec(), report)
    }

    fn solver(&self, m: usize, by_force: bool, options: &Options) -> (Solver, Report) {
        let grid = Grid::new(m, m, self.size.0 / m as f64, self.size.1 / m as f64).unwrap();
        let centre = |i: usize, d: f64| (i as f64 + 0.5 - 0.5 * m as f64) * d;
        let h: Vec<f64> = (0..m * m).map(|i| (self.h)(centre(i % m, grid.dx), centre(i / m, grid.dy))).collect();
        let load = if by_force { Load::Force(self.force) } else { Load::Approach(self.approach) };
        let (solver, stop, report) = solve(&Scene::new(grid, &h, self.bodies, load), options).unwrap();
        assert_eq!(stop, Outcome::Converged);
        (solver, report)
    }

    /// The true error of the approach (if the force is given) or of the force (if the approach is given).
    fn error(&self, row: &LedgerRow, by_force: bool) -> f64 {
        let (found, exact) =
            if by_force { (row.measures.approach, self.approach) } else { (row.measures.force, self.force) };
        (found - exact).abs()
    }
}

const METHODS: [Method; 2] = [Method::Auto, Method::FullMultigrid];

fn estimating(method: Method) -> Options {
    Options { estimates: true, method, ..Options::default() }
}

/// Asserts the ratios of estimated to true errors: none is below 0.3, and the median is 0.5 to 3. (A single ratio may be large where errors of
/// opposite sign cancel.)
fn assert_honest(mut ratios: Vec<f64>, what: &str) {
    ratios.sort_by(f64::total_cmp);
    let (least, median) = (ratios[0], ratios[ratios.len() / 2]);
    println!("{what}: {} ratios, from {least:.2}, median {median:.2}", ratios.len());
    assert!(least >= 0.3 && (0.5..=3.0).contains(&median), "{what}: from {least}, median {median}");
}

/// The estimates of every grid of the ledger with 64 or more elements in x are compared.
#[test]
fn estimates_of_force_approach_and_largest_pressure_are_right_to_a_factor_of_3() {
    let (mut forces, mut pressures) = (Vec::new(), Vec::new());
    for exact in [ellipse(), sphere(), cone()] {
        for (by_force, method) in [false, true].into_iter().flat_map(|by| METHODS.map(|method| (by, method))) {
            for m in if method == Method::Auto { [64, 96, 128, 200, 256, 512].iter() } else { [64, 128, 256].iter() } {
                let (rows, report) = exact.solve(*m, by_force, &estimating(method));
                assert_eq!(report.limit, Limit::Grid);
                for row in rows.iter().filter(|row| row.mx >= 64) {
                    let what = format!("{} {m}, by force: {by_force}, {method:?}, level {}", exact.name, row.mx);
                    assert_eq!(row.error.untrusted & DiscretisationError::FORCE, 0, "{what}");
                    forces.push(row.error.force.expect("an estimate") / exact.error(row, by_force));
                    match exact.max_pressure {
                        Some(p) => {
                            assert_eq!(row.error.untrusted & DiscretisationError::MAX_PRESSURE, 0, "{what}");
                            pressures.push(
                                row.error.max_pressure.expect("an estimate") / (row.measures.max_pressure - p).abs(),
                            );
                        }
                        // The exact peak is infinite: there is no estimate, and the report says so.
                        None => {
                            assert!(row.error.max_pressure.is_none(), "{what}");
                            assert_ne!(row.error.untrusted & DiscretisationError::MAX_PRESSURE, 0, "{what}");
                        }
                    }
                }
            }
        }
    }
    assert_honest(forces, "force and approach");
    assert_honest(pressures, "largest pressure");
}

/// The estimated rms error of the pressures is compared with the true one, for a sphere and a flat punch. The exact pressure of an element is the
/// mean of a closed form, Johnson (4.24) or (3.34), over 8 x 8 points.
#[test]
fn estimates_of_the_pressures_are_right_to_a_factor_of_3() {
    let (a, p0) = (0.26_f64.sqrt() / 2.0_f64.sqrt(), 2.0 / PI * (0.13_f64).sqrt());
    let of_sphere = |r: f64| p0 * (1.0 - (r / a).powi(2)).max(0.0).sqrt();
    let of_punch = |r: f64| if r < 0.37 { 0.1 / PI / (0.37_f64.powi(2) - r * r).sqrt() } else { 0.0 };
    let mut ratios = Vec::new();
    for (exact, pressure) in [(sphere(), &of_sphere as &dyn Fn(f64) -> f64), (punch(), &of_punch)] {
        assert!((pressure(0.0) - exact.max_pressure.unwrap_or(0.1 / PI / 0.37)).abs() < 1e-12 * p0, "{}", exact.name);
        for m in [64, 100, 128, 256] {
            let (solver, report) = exact.solver(m, false, &estimating(Method::Auto));
            let (p, d) = (&solver.state().p, 1.0 / m as f64);
            let (mut errors, mut squares) = (0.0, 0.0);
            for (i, p) in p.iter().enumerate() {
                let at = |k: usize, i: usize| (i as f64 + (k as f64 + 0.5) / 8.0) * d - 0.5;
                let sum: f64 = (0..64).map(|k| pressure(at(k % 8, i % m).hypot(at(k / 8, i / m)))).sum();
                errors += (p - sum / 64.0).powi(2);
                squares += p * p;
            }
            let ratio = report.error.pressure.expect("an estimate") / f64::sqrt(errors / squares);
            println!("{} {m}: {ratio:.2}", exact.name);
            ratios.push(ratio);
        }
    }
    assert_honest(ratios, "pressures");
}

/// As a mean over many grids the corrected area has less than half of the error of the counted area, and its estimate is right to a factor of 2.
#[test]
fn areas_are_estimated_from_their_outline() {
    let (mut counted, mut corrected, mut estimated) = (0.0, 0.0, 0.0);
    for exact in [ellipse(), sphere(), cone()] {
        for m in 50..70 {
            let (rows, _) = exact.solve(m, false, &estimating(Method::Auto));
            let (found, error) = (rows[rows.len() - 1].measures, rows[rows.len() - 1].error);
            counted += (found.contact_area / exact.area - 1.0).abs();
            corrected += (found.corrected_area / exact.area - 1.0).abs();
            estimated += error.contact_area.expect("an estimate") / exact.area;
        }
    }
    assert!(corrected < 0.5 * counted, "{corrected} of {counted}");
    assert!((0.5..2.0).contains(&(estimated / counted)), "{estimated} of {counted}");
}

/// At the edge of a flat punch pressures are infinite, and the force depends on how the circle of the edge lies on the elements. So these estimates
/// are marked as not to be trusted.
#[test]
fn what_is_singular_is_not_trusted() {
    let (rows, report) = punch().solve(256, false, &estimating(Method::Auto));
    let error = rows[rows.len() - 1].error;
    assert_ne!(error.untrusted & DiscretisationError::MAX_PRESSURE, 0);
    assert!(error.max_pressure.is_none() && report.error == error);
}

/// These surfaces have no exact solution. The reference has elements of a quarter of the side.
#[test]
fn estimates_on_rough_surfaces_and_wheel_and_rail_are_not_below_a_third_of_the_error() {
    let tight = Options { tolerance: 1e-8, ..estimating(Method::Auto) };
    let mut pairs: Vec<(case::Case, case::Case)> =
        [64, 128, 256].map(|m| (case::rough(m), case::rough(4 * m))).into_iter().collect();
    for name in ["y0_10kN", "y4_82kN", "y10_10kN"] {
        pairs.extend(
            [1, 2].map(|refinement| (case::wheel_rail(name, refinement), case::wheel_rail(name, 4 * refinement))),
        );
    }
    let (mut runs, mut flagged) = (0, 0);
    for (coarse, fine) in &pairs {
        let load = solve(&fine.scene(), &tight).unwrap().2.measures;
        // Solved by force and by approach, with the values of the reference.
        for load in [Load::Force(load.force), Load::Approach(load.approach)] {
            let found = solve(&coarse.scene_with(load), &tight).unwrap().2;
            let exact = solve(&fine.scene_with(load), &tight).unwrap().2.measures;
            runs += 2;
            for (error, found, exact) in [
                (found.error.force, found.measures.found(load), exact.found(load)),
                (found.error.max_pressure, found.measures.max_pressure, exact.max_pressure),
            ] {
                let Some(error) = error else {
                    // Only rough surfaces have no estimate, for their peak, which the grid does not resolve.
                    assert!(coarse.name.starts_with("rough"), "{}", coarse.name);
                    flagged += 1;
                    continue;
                };
                let effectivity = error / (found - exact).abs();
                assert!(effectivity >= 0.3, "{} {load:?}: {effectivity}", coarse.name);
            }
        }
    }
    println!("not trusted: {flagged} of {runs}");
    assert!(flagged < runs / 2, "{flagged} of {runs}");
}

#[test]
fn an_error_ratio_costs_less_and_loses_nothing_that_the_grid_could_show() {
    for exact in [ellipse(), sphere()] {
        for (by_force, method) in [false, true].into_iter().flat_map(|by| METHODS.map(|method| (by, method))) {
            let tight = Options { tolerance: 1e-8, ..estimating(method) };
            let (all, full) = exact.solve(256, by_force, &tight);
            let (enough, report) = exact.solve(256, by_force, &Options { error_ratio: 0.1, ..tight });
            let [all, enough] = [all, enough].map(|rows| exact.error(&rows[rows.len() - 1], by_force));
            let what = format!("{}, by force: {by_force}, {method:?}", exact.name);
            assert!((enough / all - 1.0).abs() <= 0.15, "{what}: {enough} and {all}");
            assert!(
                report.count.cycles < full.count.cycles,
                "{what}: {} and {}",
                report.count.cycles,
                full.count.cycles
            );
        }
    }
}

#[test]
fn nothing_is_estimated_unless_asked_for() {
    let (rows, report) = ellipse().solve(64, false, &Options::default());
    let unknown = DiscretisationError::default();
    assert!(rows.iter().all(|row| row.error == unknown) && report.error == unknown);
    assert_eq!(report.limit, Limit::Unknown);
    let (_, with) = ellipse().solve(64, false, &estimating(Method::Auto));
    // The result is the same to the last bit.
    assert_eq!(report.measures.force.to_bits(), with.measures.force.to_bits());
}
