//! Elements at their pressure limit are in contact. This matters in searches for an accuracy, in corrected contact areas, and for each method.

use contact_normal::grid::Grid;
use contact_normal::influence::Table;
use contact_normal::scene::{Bodies, Each, Load, PressureLimit, Scene};

use contact_normal::solver::{quantities, solve, solve_to_accuracy, Accuracy, Method, Options, Outcome, Quantity};

const BODIES: Bodies = Bodies { shear_modulus: [1.0, 1.0], poisson_ratio: [0.3, 0.3] };

/// x^2 + y^2 on a square of side 2.
fn bowl(m: usize) -> (Grid, Vec<f64>) {
    let d = 2.0 / m as f64;
    let at = |k: usize| (k as f64 - 0.5 * (m as f64 - 1.0)) * d;
    let h = (0..m * m).map(|i| at(i % m).powi(2) + at(i / m).powi(2)).collect();
    (Grid::new(m, m, d, d).expect("a grid"), h)
}

fn limited<'a>((grid, h): &'a (Grid, Vec<f64>), load: Load, limit: f64) -> Scene<'a> {
    Scene { pressure_limit: Some(PressureLimit(Each::Uniform(limit))), ..Scene::new(*grid, h, BODIES, load) }
}

/// All elements of a punch are at their limit. The force is the limit times the area, so that no finer grid is needed.
#[test]
fn a_search_ends_where_all_of_the_contact_is_at_its_limit() {
    let grid = Grid::new(32, 32, 1.0, 1.0).expect("a grid");
    let h: Vec<f64> = (0..32 * 32)
        .map(|i| if (8..24).contains(&(i % 32)) && (8..24).contains(&(i / 32)) { 0.0 } else { f64::INFINITY })
        .collect();
    let punch = (grid, h);
    let accuracy = Accuracy { max_elements: 300_000, ..Accuracy::new(2e-2) };
    let scene = limited(&punch, Load::Approach(1.0), 1e-3);
    let found = solve_to_accuracy(&scene, &Options::default(), &accuracy, None, None).expect("a solvable scene");
    assert_eq!(found.stop, Outcome::Converged, "{}", found.reason);
    assert!((found.report.measures.force / 0.256 - 1.0).abs() < 1e-12);
}

/// The corrected area is that of the elements in contact, less a part of an element for each change between contact and gap along rows and columns.
/// The part does not depend on the limit.
#[test]
fn corrected_areas_count_elements_at_their_limit() {
    let part = |m: usize, load: Load, limit: f64| {
        let surface = bowl(m);
        let scene = limited(&surface, load, limit);
        let options = Options { estimates: true, ..Options::default() };
        let (solver, outcome, report) = solve(&scene, &options).expect("a solvable scene");
        assert_eq!(outcome, Outcome::Converged);
        let p = &solver.state().p;
        let touches = |i: usize| p[i] > 0.0;
        let along = (0..m * m).filter(|i| i % m > 0 && touches(*i) != touches(i - 1)).count();
        let across = (m..m * m).filter(|i| touches(*i) != touches(i - m)).count();
        let count = p.iter().filter(|p| **p > 0.0).count();
        (count as f64 - report.measures.corrected_area / scene.grid.element_area()) / (along + across) as f64
    };
    let plain = part(48, Load::Force(0.06), f64::INFINITY);
    for (load, limit) in [(Load::Force(0.06), 0.3), (Load::Approach(0.2), 0.3), (Load::Approach(0.2), 1e-4)] {
        let limited = part(48, load, limit);
        assert!((limited / plain - 1.0).abs() < 1e-12, "{load:?} {limit}: {limited} {plain}");
    }
}

/// All pressures of a punch are at their limit. A little more approach changes none of them, so that the stiffness is 0.
#[test]
fn the_stiffness_is_zero_where_all_of_the_contact_is_at_its_limit() {
    let grid = Grid::new(16, 16, 1.0, 1.0).expect("a grid");
    let h: Vec<f64> = (0..256).map(|i| if (4..12).contains(&(i % 16)) { 0.0 } else { f64::INFINITY }).collect();
    let punch = (grid, h);
    let scene = limited(&punch, Load::Approach(1.0), 1e-3);
    let (_, rows) = quantities(&scene, &Options::default(), &[Quantity::Stiffness], 1, None).expect("rows");
    assert!(rows.iter().all(|row| row.value == Some(0.0)), "{rows:?}");
    assert_eq!((rows[1].error, rows[1].lack), (Some(0.0), None));
}

/// Five elements with most of the force at their limits: no method may cycle or stagnate.
#[test]
fn each_method_solves_a_force_beside_limits() {
    let grid = Grid::new(1, 5, 1.0, 1.0).expect("a grid");
    let h = vec![-1.28618693, 1.14791553, -0.10418187, -0.43295519, -0.73690526];
    let rows = (grid, h);
    let scene = limited(&rows, Load::Force(0.25), 0.1);
    let of = |method| solve(&scene, &Options { method, ..Options::default() }).expect("a solvable scene");
    let (auto, ..) = of(Method::Auto);
    for method in [Method::Norm, Method::ProjectedCg, Method::Multigrid, Method::FullMultigrid] {
        let (solver, outcome, report) = of(method);
        assert_eq!(outcome, Outcome::Converged, "{method:?}: {:e}", report.measures.certificate.residual);
        for (p, q) in solver.state().p.iter().zip(&auto.state().p) {
            assert!((p - q).abs() < 1e-6, "{method:?}: {p} {q}");
        }
    }
}

/// Steep rough surfaces with unsymmetric coefficients. From p = 0 and with a given force, NORM once failed to reach the elements that end at their
/// limit, although it did with a given approach.
#[test]
fn norm_solves_forces_beside_limits_with_coefficients_that_are_not_symmetric() {
    let m = 16;
    let grid = Grid::new(m, m, 1.0, 1.0).expect("a grid");
    let bodies = Bodies { shear_modulus: [1.0, f64::INFINITY], poisson_ratio: [0.3; 2] };
    let limit = Some(PressureLimit(Each::Uniform(0.03)));
    let mut solved = 0;
    for seed in 1..=10 {
        let h = crate::measured_surfaces::rough(m, m, 0.8, seed);
        let kernel = Scene::new(grid, &h, bodies, Load::Approach(0.0)).coefficients().expect("coefficients");
        let (c, cells) = (m as i64, 0..(4 * m * m) as i64);
        let lean = |k: i64| 1.0 + 1e-3 * ((k % (2 * c) - c) as f64).tanh();
        let table: Vec<f64> = cells.map(|k| lean(k) * kernel.at(k % (2 * c) - c, k / (2 * c) - c)).collect();
        let influence = Some(Table::new(m, m, &table, &grid).expect("a table"));
        let of = |load: Load| {
            let plain = Scene::new(grid, &h, bodies, load);
            let scene = Scene { influence: influence.clone(), pressure_limit: limit, ..plain };
            let (solver, outcome, _) =
                solve(&scene, &Options { tolerance: 1e-6, ..Options::default() }).expect("a solve");
            (outcome, solver.state().approach, solver.state().force())
        };
        let force = 0.05 * 0.03 * (m * m) as f64;
        let (outcome, approach, _) = of(Load::Force(force));
        if outcome == Outcome::Converged {
            solved += 1;
            let (again, _, carried) = of(Load::Approach(approach));
            assert_eq!(again, Outcome::Converged, "seed {seed}");
            assert!((carried / force - 1.0).abs() < 1e-3, "seed {seed}: {carried} for {force}");
        }
    }
    println!("{solved} of 10");
    assert!(solved >= 9, "{solved}");
}

/// With a pressure limit there is no estimate of the error, and so `error_ratio` cannot loosen the tolerance. Neither can NORM's start.
#[test]
fn no_tolerance_follows_from_an_error_that_is_not_known() {
    let surface = bowl(64);
    let tight = Options { tolerance: 1e-9, error_ratio: 1.0, ..Options::default() };
    let of = |scene: &Scene<'_>, method| solve(scene, &Options { method, ..tight }).expect("a solvable scene").2;
    let limited = limited(&surface, Load::Force(0.06), 0.1);
    assert_eq!(of(&limited, Method::Auto).tolerance, 1e-9);
    let plain = Scene { pressure_limit: None, ..limited.clone() };
    assert_eq!(of(&plain, Method::Norm).tolerance, 1e-9);
    assert!(of(&plain, Method::Auto).tolerance > 1e-6);
}
