//! The test effect `foundation`, compared with a dense solution of the test, together with every other effect, and where it is refused.

use std::f64::consts::PI;

use super::Foundation;
use crate::error::Error;
use crate::grid::Grid;
use crate::influence::{RowTables, Table};
use crate::scene::{Bodies, Coating, Each, Friction, Layer, Load, Patches, Period, Prescribed, PressureLimit, Scene};
use crate::solver::{solve, solve_to_accuracy, Accuracy, Method, Options, Outcome, Problem, Solver};
use crate::stress;

const MX: usize = 14;
const MY: usize = 12;
const SIDE: f64 = 0.1;
const BODIES: Bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3; 2] };
const FOUNDATION: Foundation = Foundation { at_once: 0.06, later: 0.05, step: 0.5, continues: false };

fn grid() -> Grid {
    Grid::new(MX, MY, SIDE, SIDE).expect("a grid")
}

/// A ball of radius 2, a little off the centre.
fn ball() -> Vec<f64> {
    let place = |i: usize| ((i % MX) as f64 - 6.2, (i / MX) as f64 - 5.4);
    (0..MX * MY).map(|i| place(i).0.hypot(place(i).1).powi(2) * SIDE * SIDE / 4.0).collect()
}

/// The displacement at an offset by a unit pressure on an element, for both bodies (Love 1929).
fn love(kx: f64, ky: f64) -> f64 {
    let corner = |x: f64, y: f64| x * (y + x.hypot(y)).ln() + y * (x + x.hypot(y)).ln();
    let (x, y, a) = (kx * SIDE, ky * SIDE, 0.5 * SIDE);
    let rectangle = corner(x + a, y + a) - corner(x - a, y + a) - corner(x + a, y - a) + corner(x - a, y - a);
    2.0 * (1.0 - 0.3) / (2.0 * PI) * rectangle
}

/// The pressures with `h - approach + (A + c) p = 0` on the contact area, which is found by elimination and exchange of elements.
fn dense(h: &[f64], approach: f64, c: f64) -> Vec<f64> {
    let entry = |i: usize, j: usize| {
        let away = |a: usize, b: usize| a as f64 - b as f64;
        love(away(i % MX, j % MX), away(i / MX, j / MX)) + if i == j { c } else { 0.0 }
    };
    let mut contact: Vec<usize> = (0..h.len()).filter(|&i| h[i] < approach).collect();
    for _ in 0..50 {
        let rows = contact.iter().map(|&i| contact.iter().map(|&j| entry(i, j)).chain([approach - h[i]]).collect());
        let solution = eliminate(rows.collect());
        let mut p = vec![0.0; h.len()];
        contact.iter().zip(&solution).for_each(|(&i, value)| p[i] = *value);
        let e = |i: usize| h[i] - approach + contact.iter().map(|&j| entry(i, j) * p[j]).sum::<f64>();
        let next: Vec<usize> =
            (0..h.len()).filter(|i| if contact.contains(i) { p[*i] > 0.0 } else { e(*i) < 0.0 }).collect();
        if next == contact {
            return p;
        }
        contact = next;
    }
    panic!("the exchange of elements does not end");
}

/// Solves by Gaussian elimination. The last column is the right-hand side, and the matrix is positive definite.
fn eliminate(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    for k in 0..n {
        let pivot = rows[k].clone();
        for row in &mut rows[k + 1..] {
            let factor = row[k] / pivot[k];
            row.iter_mut().zip(&pivot).skip(k).for_each(|(to, from)| *to -= factor * from);
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * x[j]).sum();
        x[k] = (rows[k][n] - known) / rows[k][k];
    }
    x
}

fn norm(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|value| value * value).sum::<f64>().sqrt()
}

fn with(foundation: Foundation, scene: Scene<'_>) -> Scene<'_> {
    Scene { foundation: Some(foundation), ..scene }
}

#[test]
fn steps_are_those_of_a_dense_solution_by_every_method() {
    let h = ball();
    let Foundation { at_once, later, step, .. } = FOUNDATION;
    for method in [Method::Auto, Method::Norm, Method::ProjectedCg, Method::Multigrid, Method::FullMultigrid] {
        let options = Options { method, tolerance: 1e-9, ..Options::default() };
        let mut solver: Option<Solver> = None;
        // The v of the last step, and its possible error in the library.
        let (mut v, mut off) = (vec![0.0; h.len()], 0.0);
        for (k, approach) in [0.05, 0.05, 0.08, 0.03].into_iter().enumerate() {
            let foundation = Foundation { continues: k > 0, ..FOUNDATION };
            let scene = with(foundation, Scene::new(grid(), &h, BODIES, Load::Approach(approach)));
            let solver = solver.get_or_insert_with(|| Solver::new(&scene, &options).expect("a solver"));
            let (stop, _) = solver.solve(&scene, &options, None, None).expect("a step");
            assert_eq!(stop, Outcome::Converged, "{method:?} {k}");
            // The step is implicit in v: it adds the memory v/(1 + r) to h, and an instantaneous compliance d r/(1 + r).
            let with_memory: Vec<f64> = h.iter().zip(&v).map(|(h, v)| h + v / (1.0 + step)).collect();
            let p = dense(&with_memory, approach, at_once + later * step / (1.0 + step));
            // The eigenvalues of A + c are at least c, so that the residual over c bounds the error of p. The error of v adds to it.
            let state = solver.state();
            let distance = norm((0..h.len()).filter(|&i| state.contact[i]).map(|i| state.h[i] - approach));
            let allowed = (1e-9 * distance + off / (1.0 + step)) / at_once + 1e-12 * norm(p.iter().copied());
            let error = norm(state.p.iter().zip(&p).map(|(found, p)| found - p));
            assert!(error <= allowed, "{method:?} {k}: {error:e} {allowed:e}");
            assert!(norm(p.iter().copied()) > 1e4 * allowed, "{method:?} {k}: nothing is compared");
            v.iter_mut().zip(&p).for_each(|(v, p)| *v = (*v + step * later * p) / (1.0 + step));
            off = (off + step * later * allowed) / (1.0 + step);
        }
    }
}

/// Asserts the contact conditions of a result by direct sums over the coefficients of the scene, with the v of a step from rest and with
/// displacements `beside` by other effects.
fn assert_conditions(name: &str, scene: &Scene<'_>, solver: &Solver, beside: &[f64]) {
    let (state, coefficients) = (solver.state(), scene.coefficients().expect("coefficients"));
    let limit = scene.pressure_limit.map_or(f64::INFINITY, |limit| limit.0.at(0));
    let Foundation { later, step, .. } = FOUNDATION;
    let (mut residual, mut distance, mut deepest, mut violation) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    for (i, h) in scene.undeformed_distance.iter().enumerate() {
        let p = state.p[i];
        assert!(p >= 0.0 && p <= limit && (h.is_finite() || p == 0.0), "{name}: {p}");
        let loaded = (0..state.p.len()).filter(|&j| state.p[j] != 0.0);
        let u: f64 = loaded.map(|j| coefficients.entry(&scene.grid, i, j) * state.p[j]).sum();
        let d = h + beside[i] + later * step / (1.0 + step) * p - state.approach;
        if p == limit {
            violation = violation.max(d + u);
        } else if p > 0.0 {
            (residual, distance, deepest) = (residual + (d + u).powi(2), distance + d * d, deepest.max(d.abs()));
        } else {
            violation = violation.max(-(d + u));
        }
    }
    // The default tolerance is 1e-6; sums of 168 terms have a round-off below 1e-12.
    assert!(residual.sqrt() <= (1e-6 + 1e-12) * distance.sqrt(), "{name}: {residual:e} {distance:e}");
    assert!(violation <= (1e-6 + 1e-12) * deepest, "{name}: {violation:e}");
    let force = state.p.iter().sum::<f64>() * scene.grid.element_area();
    assert!((force - 0.05).abs() <= 1e-12, "{name}: force {force}");
}

#[test]
fn beside_every_other_effect_conditions_hold_or_the_foundation_is_refused() {
    let (grid, h) = (grid(), ball());
    let mut hole = h.clone();
    hole[5 * MX + 6] = f64::INFINITY;
    let patch: Vec<i32> = (0..h.len()).map(|i| i32::from(i % MX > 6)).collect();
    let decays = |k: f64| love(k, 0.0) * (-0.2 * k.abs()).exp();
    let offset = |i: usize, m: usize| i as f64 - m as f64;
    let table = |i: usize| decays(offset(i % (2 * MX), MX).hypot(offset(i / (2 * MX), MY)));
    let table: Vec<f64> = (0..4 * h.len()).map(table).collect();
    let table = Table::new(MX, MY, &table, &grid).expect("a table");
    let of_rows = |i: usize| {
        let (jy, iy, kx) = (i / (2 * MX) / MY, i / (2 * MX) % MY, i % (2 * MX));
        let answers = |y: usize| 1.0 - 0.03 * y as f64;
        decays(offset(kx, MX).hypot(offset(iy, jy))) * answers(iy) * answers(jy)
    };
    let row_tables: Vec<f64> = (0..MY * MY * 2 * MX).map(of_rows).collect();
    let row_tables = RowTables::new(MX, MY, &row_tables, &grid).expect("tables");
    let push = [Prescribed::Force(-0.005), Prescribed::Creepage(0.001)];
    let friction = Friction { prescribed: push, ..Friction::new(0.3) };
    let plain = with(FOUNDATION, Scene::new(grid, &h, BODIES, Load::Force(0.05)));
    let scenes = [
        ("alone", plain.clone()),
        ("influence", Scene { influence: Some(table), ..plain.clone() }),
        ("row_tables", Scene { row_tables: Some(row_tables), ..plain.clone() }),
        ("coating", Scene { coating: Some(Coating::of_body_1(0.2, 0.3, 0.4)), ..plain.clone() }),
        ("period in x", Scene { period: Some(Period { x: true, y: false }), ..plain.clone() }),
        ("periods", Scene { period: Some(Period { x: true, y: true }), ..plain.clone() }),
        (
            "patches",
            Scene {
                patches: Some(Patches { count: 2, patch: &patch, factors: &[1.0, 0.2, 0.2, 1.0] }),
                ..plain.clone()
            },
        ),
        ("pressure_limit", Scene { pressure_limit: Some(PressureLimit(Each::Uniform(0.08))), ..plain.clone() }),
        ("excluded elements", Scene { undeformed_distance: &hole, ..plain.clone() }),
        ("friction", Scene { friction: Some(friction), ..plain.clone() }),
        ("layer", Scene { layer: Some(Layer(Each::Uniform(0.05))), ..plain.clone() }),
    ];
    let mut alone = Vec::new();
    for (name, scene) in &scenes {
        if *name == "layer" {
            let Err(Error::Unsupported(message)) = solve(scene, &Options::default()) else { panic!("{name}: solved") };
            assert!(message.contains("foundation and layer"), "{message}");
            continue;
        }
        let (solver, stop, report) = solve(scene, &Options::default()).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(stop, Outcome::Converged, "{name}");
        assert_conditions(name, scene, &solver, &vec![0.0; h.len()]);
        // The foundation changes the pressures, and so does the other effect.
        let without = Scene { foundation: None, ..scene.clone() };
        let (other, ..) = solve(&without, &Options::default()).unwrap_or_else(|e| panic!("{name}: {e}"));
        let p = &solver.state().p;
        let change = |other: &[f64]| p.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(change(&other.state().p) > 1e-3, "{name}: as if there were no foundation");
        match *name {
            "alone" => alone = p.clone(),
            "friction" => {
                let pushed = report.friction.expect("a report of friction").force;
                assert!((pushed[0] + 0.005).abs() <= 1e-9, "{pushed:?}");
                assert_eq!(*p, alone, "tractions of like bodies change no pressure");
            }
            _ => assert!(change(&alone) > 1e-3, "{name}: as if it were not there"),
        }
    }
}

#[test]
fn with_unlike_bodies_both_displace_the_distance() {
    let (grid, h) = (grid(), ball());
    let bodies = Bodies { shear_modulus: [1.0, 3.0], poisson_ratio: [0.1, 0.4] };
    let push = [Prescribed::Force(-0.004), Prescribed::Creepage(0.0)];
    let friction = Friction { prescribed: push, ..Friction::new(0.5) };
    let scene = with(FOUNDATION, Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(0.05)) });
    let (solver, stop, _) = solve(&scene, &Options::default()).expect("a solution");
    assert_eq!(stop, Outcome::Converged);
    // The displacement along the normal by tractions, -(Axz qx + Ayz qy), with Axz, Ayz = -K/(pi G) times the integrals of x/r^2 and y/r^2
    // (tests/friction/unlike.rs has them by quadrature).
    let unlike = crate::friction::Compliance::of(&bodies).unlike;
    let traction = &solver.friction().expect("tractions").traction;
    let by_tractions = |i: usize| {
        let sum = |(j, [qx, qy]): (usize, &[f64; 2])| {
            let away = |a: usize, b: usize| a as f64 - b as f64;
            let [x, y] = crate::friction::cross::integrals(away(i % MX, j % MX), away(i / MX, j / MX), SIDE, SIDE);
            unlike / PI * (x * qx + y * qy)
        };
        traction.iter().enumerate().map(sum).sum::<f64>()
    };
    let beside: Vec<f64> = (0..h.len()).map(by_tractions).collect();
    assert!(beside.iter().any(|u| u.abs() > 1e-4), "tractions displace nothing along the normal");
    assert_conditions("unlike bodies", &scene, &solver, &beside);
    // Derivatives are refused, because they would not include the foundation.
    let friction = Friction { sensitivities: true, ..friction };
    let scene = Scene { friction: Some(friction), ..scene };
    let Err(Error::Unsupported(message)) = solve(&scene, &Options::default()) else { panic!("not refused") };
    assert!(message.contains("sensitivities") && message.contains("foundation"), "{message}");
}

#[test]
fn the_foundation_is_refused_where_its_properties_say_so() {
    let (grid, h, options) = (grid(), ball(), Options::default());
    let rest = with(FOUNDATION, Scene::new(grid, &h, BODIES, Load::Force(0.05)));
    let on = with(Foundation { continues: true, ..FOUNDATION }, rest.clone());
    let refused = |message: String, with: &[&str]| {
        assert!(with.iter().all(|with| message.contains(with)), "{message}");
    };
    let mut solver = Solver::new(&rest, &options).expect("a solver");
    // A step that continues is refused if there is no last step, or if the last one was without the foundation.
    for _ in 0..2 {
        let Err(Error::InvalidArgument(message)) = solver.solve(&on, &options, None, None) else { panic!("solved") };
        refused(message, &["foundation", "creep"]);
        let without = Scene { foundation: None, ..rest.clone() };
        let Err(Error::InvalidArgument(message)) = solver.solve(&without, &options, None, None) else {
            panic!("solved")
        };
        refused(message, &["foundation"]);
    }
    let problems = [Problem { scene: on.clone(), guess: None }];
    let found = solver.solve_batch(&problems, &options, |_, found, _| found.map(|_| ()));
    let Err(Error::InvalidArgument(message)) = &found.expect("a batch")[0] else { panic!("solved") };
    refused(message.clone(), &["foundation->continues", "batch"]);
    let accuracy = Accuracy::new(1e-2);
    let Err(Error::Unsupported(message)) = solve_to_accuracy(&rest, &options, &accuracy, None, None) else {
        panic!("solved")
    };
    refused(message, &["foundation"]);
    let Err(Error::Unsupported(message)) = stress::of_scene(&rest, 1, [Some(&h), None, None]) else { panic!("known") };
    refused(message, &["foundation"]);
    let other = with(Foundation { at_once: 0.07, ..FOUNDATION }, rest);
    let Err(Error::InvalidArgument(message)) = solver.solve(&other, &options, None, None) else { panic!("solved") };
    refused(message, &["foundation->at_once", "0.07"]);
}

#[test]
fn a_step_that_is_refused_on_the_way_leaves_the_memory_as_it_was() {
    let (grid, h, options) = (grid(), ball(), Options::default());
    let scene = |continues: bool, force: Option<f64>| {
        let push = |force: f64| [Prescribed::Force(force), Prescribed::Creepage(0.0)];
        let friction = force.map(|force| Friction { prescribed: push(force), ..Friction::new(0.3) });
        let plain = Scene { friction, ..Scene::new(grid, &h, BODIES, Load::Force(0.05)) };
        with(Foundation { continues, ..FOUNDATION }, plain)
    };
    let steps = |refused: bool| {
        let mut solver = Solver::new(&scene(false, None), &options).expect("a solver");
        solver.solve(&scene(false, None), &options, None, None).expect("a step");
        if refused {
            // This force exceeds mu N, which is known only after the normal problem is solved.
            let outcome = solver.solve(&scene(true, Some(-0.05)), &options, None, None);
            assert!(matches!(outcome, Err(Error::Infeasible(_))), "{outcome:?}");
        }
        solver.solve(&scene(true, None), &options, None, None).expect("a step");
        solver.state().p.clone()
    };
    assert_eq!(steps(true), steps(false));
}
