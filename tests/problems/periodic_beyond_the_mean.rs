//! Two periods, with approaches at and beyond the mean of h. Such approaches have a solution only with a fixed contact area or with pressure limits.
//! The conditions are checked by direct sums.

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Load, Period, PressureLimit, Scene};
use contact_normal::solver::{solve, ActiveSet, Guess, Method, Options, Outcome, Solver};

use crate::periodic_by_approach::{displacements, rough};

const M: usize = 24;
/// Approaches, relative to the mean of h.
const APPROACHES: [f64; 4] = [-0.1, 0.0, 0.05, 0.7];

fn scene(h: &[f64], approach: f64) -> Scene<'_> {
    Scene {
        period: Some(Period { x: true, y: true }),
        ..Scene::new(Grid::new(M, M, 1.0, 1.0).unwrap(), h, Bodies::same(1.0, 0.0), Load::Approach(approach))
    }
}

/// A surface with the mean 0.
fn surface() -> Vec<f64> {
    let h = rough(M, 4, 5);
    let mean = h.iter().sum::<f64>() / h.len() as f64;
    h.iter().map(|h| h - mean).collect()
}

#[test]
fn a_given_contact_area_needs_no_gap() {
    let h = surface();
    let contact: Vec<bool> = h.iter().map(|h| *h < 0.3).collect();
    let pressure = vec![0.0; h.len()];
    for method in [Method::Auto, Method::Norm, Method::ProjectedCg] {
        let options = Options { method, active_set: ActiveSet::Fixed, tolerance: 1e-9, ..Options::default() };
        let mut solver = Solver::new(&scene(&h, 0.0), &options).unwrap();
        for approach in APPROACHES {
            let guess = Some(Guess { pressure: &pressure, contact: &contact });
            let (stop, _) = solver.solve(&scene(&h, approach), &options, guess, None).unwrap();
            assert_eq!(stop, Outcome::Converged, "{method:?} {approach}");
            let p = &solver.state().p;
            let u = displacements(&scene(&h, approach), p);
            let of = |value: &dyn Fn(usize) -> f64| {
                (0..p.len()).filter(|&i| contact[i]).map(|i| value(i).powi(2)).sum::<f64>().sqrt()
            };
            let residual = of(&|i| h[i] - approach + u[i]) / of(&|i| h[i] - approach);
            // The tolerance of 1e-9, and 1 % of it for the different round-off of direct sums and FFT products.
            assert!(residual <= 1.01e-9, "{method:?} {approach}: {residual}");
            assert!((0..p.len()).all(|i| contact[i] || p[i] == 0.0));
        }
    }
}

/// If all elements are in contact, any force is possible, at one approach only.
#[test]
fn a_given_contact_area_that_is_full_takes_a_force() {
    let h = surface();
    let (contact, pressure) = (vec![true; h.len()], vec![0.0; h.len()]);
    let guess = Some(Guess { pressure: &pressure, contact: &contact });
    let options = Options { active_set: ActiveSet::Fixed, ..Options::default() };
    let mut solver = Solver::new(&scene(&h, 0.0), &options).unwrap();
    for approach in APPROACHES {
        let refused = solver.solve(&scene(&h, approach), &options, guess, None).unwrap_err();
        assert!(matches!(refused, Error::Infeasible(_)) && refused.to_string().contains("all elements"), "{refused}");
    }
    let by_force = Scene { load: Load::Force(1e3), ..scene(&h, 0.0) };
    let mut solver = Solver::new(&by_force, &options).unwrap();
    let (stop, report) = solver.solve(&by_force, &options, guess, None).unwrap();
    // The approach is the mean of h, 0, to the tolerance of the certificate.
    assert_eq!(stop, Outcome::Converged);
    assert!(report.measures.approach.abs() <= options.tolerance * 2.0, "{}", report.measures.approach);
}

/// Beyond the mean of h the mean of e is negative. Elements at their limit may have a negative e, so that the others need not.
#[test]
fn limits_give_way_beyond_the_mean() {
    let h = surface();
    let one: Vec<f64> = (0..h.len()).map(|i| if i == 100 { 0.5 } else { f64::INFINITY }).collect();
    let limits =
        [PressureLimit(Each::Uniform(0.2)), PressureLimit(Each::Uniform(5.0)), PressureLimit(Each::PerElement(&one))];
    for (k, limit) in limits.into_iter().enumerate() {
        for approach in APPROACHES {
            let scene = Scene { pressure_limit: Some(limit), ..scene(&h, approach) };
            let what = format!("limit {k}, approach {approach}");
            let options = Options { tolerance: 1e-8, ..Options::default() };
            let (solver, stop, _) = solve(&scene, &options).unwrap();
            assert_eq!(stop, Outcome::Converged, "{what}");
            let p = &solver.state().p;
            let u = displacements(&scene, p);
            let most = |i: usize| match limit {
                PressureLimit(Each::Uniform(limit)) => limit,
                PressureLimit(Each::PerElement(limits)) => limits[i],
            };
            let scale = (0..p.len()).map(|i| (h[i] - approach).powi(2)).sum::<f64>().sqrt();
            // The tolerance of 1e-8, which one element alone may have.
            for i in 0..p.len() {
                let e = (h[i] - approach + u[i]) / scale;
                assert!(p[i] >= 0.0 && p[i] <= most(i), "{what}: {} of {}", p[i], most(i));
                assert!(p[i] == 0.0 || e <= 1e-8, "{what}: element {i} carries {} at the distance {e}", p[i]);
                assert!(p[i] == most(i) || e >= -1e-8, "{what}: element {i} penetrates by {e}");
            }
        }
    }
    let none = Scene { pressure_limit: Some(PressureLimit(Each::Uniform(f64::INFINITY))), ..scene(&h, 0.1) };
    assert!(matches!(solve(&none, &Options::default()), Err(Error::Infeasible(_))));
}

/// Balls with noise, at approaches slightly above the mean of h. The limits are 10 to 1e4 times the pressures that flatten the surface. Some elements
/// reach their limits, although without limits contact would be nearly full.
#[test]
fn high_limits_are_reached_slightly_beyond_the_mean() {
    let options = Options::default();
    let mut most = 0.0_f64;
    for m in [8, 16, 24, 32] {
        let noise = rough(m, 7, 5);
        let place = |k: usize| (k as f64 - 0.5 * (m as f64 - 1.0)) / m as f64;
        let ball = |k: usize| 0.4 * m as f64 * (place(k % m).powi(2) + place(k / m).powi(2)) + 1e-3 * noise[k];
        let h: Vec<f64> = (0..m * m).map(ball).collect();
        let mean = h.iter().sum::<f64>() / h.len() as f64;
        let deviation = (h.iter().map(|h| (h - mean).powi(2)).sum::<f64>() / h.len() as f64).sqrt();
        let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
        let bodies = Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0; 2] };
        let period = Some(Period { x: true, y: true });
        for (above, limit) in
            [(0.003, 1e3), (0.02, 7e3), (0.034, 2.9e3), (0.07, 200.0), (0.09, 19.0), (0.16, 7e3), (0.5, 50.0)]
        {
            let limit = PressureLimit(Each::Uniform(limit * deviation / m as f64));
            let load = Load::Approach(mean + above * deviation);
            let scene = Scene { period, pressure_limit: Some(limit), ..Scene::new(grid, &h, bodies, load) };
            let (solver, stop, report) = solve(&scene, &options).unwrap();
            let count = solver.state().at_limit.iter().filter(|is| **is).count();
            assert!(stop == Outcome::Converged && count > 0, "{m} {above} {limit:?}: {stop:?}, {count} at the limit");
            most = most.max(report.count.work_units);
        }
    }
    println!("at most {most} products");
    // The bound is twice the largest number of products that was measured.
    assert!(most <= 300.0, "{most}");
}

/// At the mean itself full contact solves with any uniform pressure added. The solution is that of approaches slightly below, by all methods.
#[test]
fn at_the_mean_no_limit_is_reached() {
    let wave = |k: usize| 1.0 - (2.0 * std::f64::consts::PI * (k % 16) as f64 / 16.0).cos();
    let h: Vec<f64> = (0..256).map(wave).collect();
    for method in [Method::Auto, Method::Norm] {
        let grid = Grid::new(16, 16, 1.0, 1.0).unwrap();
        let period = Some(Period { x: true, y: true });
        let pressure_limit = Some(PressureLimit(Each::Uniform(1e4)));
        let load = Load::Approach(1.0);
        let scene = Scene { period, pressure_limit, ..Scene::new(grid, &h, Bodies::same(1.0, 0.0), load) };
        let (solver, stop, _) = solve(&scene, &Options { method, ..Options::default() }).unwrap();
        assert_eq!(stop, Outcome::Converged);
        assert!(!solver.state().at_limit.contains(&true), "{method:?}");
    }
}
