//! Products A p with given pressures, compared with the test's own dense matrix, and the stiffness dF/dapproach of a result, compared with
//! elimination and with differences of two solves.

use std::f64::consts::PI;

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::influence::Table;
use contact_normal::scene::{Bodies, Coating, CoatingLayer, Each, Layer, Load, Patches, Period, PressureLimit, Scene};
use contact_normal::solver::{ActiveSet, Guess, InitialGuess, Options, Outcome, Solver};

use crate::support::run;

/// The displacement at a distance (x, y) from the middle of an element with unit pressure, times pi E*: Love (1929).
fn love(x: f64, y: f64, dx: f64, dy: f64) -> f64 {
    let corner = |a: f64, b: f64| {
        let r = a.hypot(b);
        a * ((b + r) / a.abs()).ln() + b * ((a + r) / b.abs()).ln()
    };
    let (l, r, b, t) = (x - 0.5 * dx, x + 0.5 * dx, y - 0.5 * dy, y + 0.5 * dy);
    corner(r, t) - corner(l, t) - corner(r, b) + corner(l, b)
}

/// The matrix A of two half-spaces, as `[i][j]`.
fn half_space(grid: &Grid, bodies: &Bodies) -> Vec<Vec<f64>> {
    let part = |k: usize| (1.0 - bodies.poisson_ratio[k]) / (2.0 * PI * bodies.shear_modulus[k]);
    let c = part(0) + part(1);
    let at = |i: usize| ((i % grid.mx) as f64 * grid.dx, (i / grid.mx) as f64 * grid.dy);
    let entry = |i: usize, j: usize| c * love(at(i).0 - at(j).0, at(i).1 - at(j).1, grid.dx, grid.dy);
    (0..grid.len()).map(|i| (0..grid.len()).map(|j| entry(i, j)).collect()).collect()
}

fn times(a: &[Vec<f64>], p: &[f64]) -> Vec<f64> {
    a.iter().map(|row| row.iter().zip(p).map(|(a, p)| a * p).sum()).collect()
}

/// The sum of s with `A s = 1` on these elements, by elimination with pivoting.
fn sum_of_solution(a: &[Vec<f64>], elements: &[usize]) -> f64 {
    let n = elements.len();
    let row = |&i: &usize| elements.iter().map(|&j| a[i][j]).chain([1.0]).collect();
    let mut rows: Vec<Vec<f64>> = elements.iter().map(row).collect();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs())).expect("a row");
        rows.swap(k, pivot);
        let of = rows[k].clone();
        for row in &mut rows[k + 1..] {
            let factor = row[k] / of[k];
            row[k..].iter_mut().zip(&of[k..]).for_each(|(value, of)| *value -= factor * of);
        }
    }
    let mut s = vec![0.0; n];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * s[j]).sum();
        s[k] = (rows[k][n] - known) / rows[k][k];
    }
    s.iter().sum()
}

fn grid() -> Grid {
    Grid::new(17, 14, 0.5, 0.6).expect("a grid")
}

/// A ball with a little waviness.
fn bump(grid: &Grid) -> Vec<f64> {
    let at = |i: usize| {
        let (x, y) = ((i % grid.mx) as f64 - 7.7, (i / grid.mx) as f64 - 6.4);
        0.01 * (x * x + 1.3 * y * y) + 0.004 * ((1.7 * x).sin() * (2.3 * y).cos())
    };
    (0..grid.len()).map(at).collect()
}

fn bodies() -> Bodies {
    Bodies { shear_modulus: [1.0, 3.0], poisson_ratio: [0.3, 0.1] }
}

fn tight() -> Options {
    Options { tolerance: 1e-12, ..Options::default() }
}

/// Pressures of both signs on all elements.
fn pressures(n: usize) -> Vec<f64> {
    (0..n).map(|i| ((i * i + 3 * i) as f64 * 0.37).sin() + 0.2).collect()
}

fn assert_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{what}: {found} for {expected}");
}

#[test]
fn a_product_is_that_of_the_dense_matrix_and_leaves_the_result_alone() {
    let (grid, bodies) = (grid(), bodies());
    let h = bump(&grid);
    let compliances: Vec<f64> = (0..grid.len()).map(|i| 0.1 + 0.01 * i as f64).collect();
    let patch: Vec<i32> = (0..grid.len()).map(|i| i32::from(i % grid.mx > 8)).collect();
    let factors = [1.0, 0.4, 0.4, 1.0];
    let plain = Scene::new(grid, &h, bodies, Load::Approach(0.3));
    let scene = Scene {
        layer: Some(Layer(Each::PerElement(&compliances))),
        patches: Some(Patches { count: 2, patch: &patch, factors: &factors }),
        ..plain.clone()
    };
    let mut matrix = half_space(&grid, &bodies);
    let p = pressures(grid.len());
    let check = |scene: &Scene<'_>, matrix: &[Vec<f64>], what: &str| {
        let (mut solver, _) = run(scene, &Options::default());
        let before = solver.state().p.clone();
        let mut u = vec![f64::NAN; grid.len()];
        solver.product(&p, &mut u).expect("a product");
        let largest = u.iter().fold(0.0f64, |largest, u| largest.max(u.abs()));
        for (i, expected) in times(matrix, &p).into_iter().enumerate() {
            // The closed form of the test is a difference of logarithms, with an error of 1e-12 at these offsets.
            assert!((u[i] - expected).abs() <= 1e-11 * largest, "{what}: {} for {expected}", u[i]);
        }
        assert_eq!(solver.state().p, before, "{what}");
        // The next solve does not count the product, and has the same bits as without it.
        let again = |solver: &mut Solver| solver.solve(scene, &Options::default(), None, None).expect("a result").1;
        let with = again(&mut solver);
        let (mut other, _) = run(scene, &Options::default());
        let without = again(&mut other);
        assert_eq!(with.count.matrix_products, without.count.matrix_products, "{what}");
        assert_eq!(solver.state().p, other.state().p, "{what}");
    };
    check(&plain, &matrix, "plain");
    for (i, row) in matrix.iter_mut().enumerate() {
        row.iter_mut().enumerate().for_each(|(j, a)| *a *= factors[(2 * patch[i] + patch[j]) as usize]);
        row[i] += compliances[i];
    }
    check(&scene, &matrix, "layer and patches");
}

#[test]
fn what_is_no_pressure_is_refused() {
    let grid = grid();
    let h = bump(&grid);
    let (mut solver, _) = run(&Scene::new(grid, &h, bodies(), Load::Approach(0.3)), &Options::default());
    let mut u = vec![1.0; grid.len()];
    let mut p = pressures(grid.len());
    assert!(matches!(solver.product(&p[1..], &mut u), Err(Error::InvalidArgument(_))));
    assert!(matches!(solver.product(&p, &mut u[1..]), Err(Error::InvalidArgument(_))));
    p[3] = f64::NAN;
    assert!(matches!(solver.product(&p, &mut u), Err(Error::NotFinite(_))));
    assert!(u.iter().all(|u| *u == 1.0));
}

/// With two periods and a coating the library solves for a given force without the compression by the mean pressure. A product A p includes the
/// compression, whatever the load is.
#[test]
fn a_product_has_the_compression_whatever_the_load_is() {
    let grid = Grid::new(16, 16, 0.5, 0.5).expect("a grid");
    let h: Vec<f64> = (0..256).map(|i| 0.1 * (1.0 - (2.0 * PI * (i % 16) as f64 / 16.0).cos())).collect();
    let layer = CoatingLayer { thickness: 0.7, shear_modulus: 0.3, poisson_ratio: 0.2 };
    let products = [Load::Force(2.0), Load::Approach(0.05)].map(|load| {
        let plain = Scene::new(grid, &h, bodies(), load);
        let coating = Some(Coating { layers: [Some(layer), None] });
        let scene = Scene { coating, period: Some(Period { x: true, y: true }), ..plain };
        let mut solver = Solver::new(&scene, &Options::default()).expect("a solver");
        let mut u = vec![0.0; grid.len()];
        solver.product(&[1.0; 256], &mut u).expect("a product");
        u
    });
    // A uniform pressure p compresses a layer of thickness t by p t/M, M the oedometric modulus.
    let modulus = 2.0 * layer.shear_modulus * (1.0 - layer.poisson_ratio) / (1.0 - 2.0 * layer.poisson_ratio);
    for u in products.iter().flatten() {
        assert_near(*u, layer.thickness / modulus, 1e-9, "compression");
    }
}

#[test]
fn the_stiffness_is_that_of_the_dense_equations() {
    let (grid, bodies) = (grid(), bodies());
    let h = bump(&grid);
    let matrix = half_space(&grid, &bodies);
    let unsymmetric: Vec<f64> = (-14i64..14)
        .flat_map(|ky| (-17i64..17).map(move |kx| (kx, ky)))
        .map(|(kx, ky)| {
            let lean = if kx > 0 { 0.9 } else { 1.0 };
            lean * love(kx as f64 * grid.dx, ky as f64 * grid.dy, grid.dx, grid.dy)
        })
        .collect();
    let entry = |i: usize, j: usize| {
        let offset = |i: usize, j: usize, m: usize| (i as i64 - j as i64 + m as i64) as usize;
        let (kx, ky) = (offset(i % 17, j % 17, 17), offset(i / 17, j / 17, 14));
        unsymmetric[ky * 34 + kx]
    };
    let of_table: Vec<Vec<f64>> = (0..grid.len()).map(|i| (0..grid.len()).map(|j| entry(i, j)).collect()).collect();
    let plain = Scene::new(grid, &h, bodies, Load::Approach(0.4));
    let table = Some(Table::new(17, 14, &unsymmetric, &grid).expect("a table"));
    let scenes = [
        ("plain", plain.clone(), &matrix),
        ("force", Scene { load: Load::Force(1.0), ..plain.clone() }, &matrix),
        ("limit", Scene { pressure_limit: Some(PressureLimit(Each::Uniform(0.15))), ..plain.clone() }, &matrix),
        ("table", Scene { influence: table, ..plain.clone() }, &of_table),
    ];
    for (what, scene, matrix) in scenes {
        let (mut solver, _) = run(&scene, &tight());
        let before = (solver.state().p.clone(), solver.state().approach);
        let (stop, found) = solver.stiffness().expect("a stiffness");
        assert_eq!(stop, Outcome::Converged, "{what}");
        assert!(found.residual <= 1e-9, "{what}: {}", found.residual);
        let limited = |i: usize| solver.state().at_limit.get(i).copied().unwrap_or(false);
        let elements: Vec<usize> = (0..grid.len()).filter(|&i| solver.state().contact[i] && !limited(i)).collect();
        assert!(elements.len() > 10, "{what}");
        assert_eq!((0..grid.len()).any(limited), what == "limit");
        let expected = sum_of_solution(matrix, &elements) * grid.element_area();
        assert_near(found.value, expected, 1e-8, what);
        assert_eq!((solver.state().p.clone(), solver.state().approach), before, "{what}");
    }
}

#[test]
fn the_stiffness_is_the_difference_of_two_solves() {
    let grid = Grid::new(24, 20, 0.5, 0.6).expect("a grid");
    let h = bump(&grid);
    let coating =
        Coating { layers: [Some(CoatingLayer { thickness: 0.8, shear_modulus: 0.2, poisson_ratio: 0.4 }), None] };
    let plain = Scene::new(grid, &h, bodies(), Load::Approach(0.4));
    let period = |x, y| Some(Period { x, y });
    let scenes = [
        ("plain", plain.clone()),
        ("layer", Scene { layer: Some(Layer(Each::Uniform(0.3))), ..plain.clone() }),
        ("coating", Scene { coating: Some(coating), ..plain.clone() }),
        ("limit", Scene { pressure_limit: Some(PressureLimit(Each::Uniform(0.12))), ..plain.clone() }),
        ("period", Scene { period: period(true, false), ..plain.clone() }),
        ("periods", Scene { period: period(true, true), ..plain.clone() }),
        ("coated periods", Scene { coating: Some(coating), period: period(true, true), ..plain.clone() }),
    ];
    for (what, scene) in scenes {
        let step = 1e-6;
        let at = |approach: f64| {
            let (solver, report) = run(&Scene { load: Load::Approach(approach), ..scene.clone() }, &tight());
            (solver.state().contact.clone(), report.measures.force)
        };
        let (mut solver, _) = run(&scene, &tight());
        let found = solver.stiffness().expect("a stiffness").1;
        let [(before, less), (after, more)] = [0.4 - step, 0.4 + step].map(at);
        assert_eq!(before, after, "{what}: the contact area stays");
        // The two forces have an accuracy of 1e-12, and differ by 1e-6 of their size: 1e-5 is ample.
        assert_near(found.value, (more - less) / (2.0 * step), 1e-5, what);
    }
}

#[test]
fn without_contact_or_a_result_there_is_no_stiffness() {
    let grid = Grid::new(8, 8, 1.0, 1.0).expect("a grid");
    let h = vec![0.0; 64];
    let scene = Scene::new(grid, &h, bodies(), Load::Approach(-1.0));
    let mut solver = Solver::new(&scene, &Options::default()).expect("a solver");
    assert!(matches!(solver.stiffness(), Err(Error::InvalidArgument(_))));
    solver.solve(&scene, &Options::default(), None, None).expect("a result");
    assert_eq!(solver.stiffness().expect("a stiffness").1.value, 0.0);
    let full = Scene { period: Some(Period { x: true, y: true }), load: Load::Force(3.0), ..scene };
    let (mut solver, _) = run(&full, &Options::default());
    assert!(matches!(solver.stiffness(), Err(Error::Infeasible(_))));
}

/// On a fixed contact area all its elements follow the approach, also those in tension. Units have no effect on the stiffness.
#[test]
fn a_fixed_area_and_any_units_have_the_same_stiffness() {
    let grid = grid();
    let h = bump(&grid);
    let contact: Vec<bool> = (0..grid.len()).map(|i| (4..13).contains(&(i % 17)) && i / 17 > 3).collect();
    let elements: Vec<usize> = (0..grid.len()).filter(|&i| contact[i]).collect();
    let expected = sum_of_solution(&half_space(&grid, &bodies()), &elements) * grid.element_area();
    for unit in [1.0, 2f64.powi(-40), 2f64.powi(60)] {
        let moduli = bodies().shear_modulus.map(|modulus| unit * modulus);
        let scene = Scene::new(grid, &h, Bodies { shear_modulus: moduli, ..bodies() }, Load::Approach(0.4));
        let options = Options { active_set: ActiveSet::Fixed, initial_guess: InitialGuess::None, ..tight() };
        let mut solver = Solver::new(&scene, &options).expect("a solver");
        let guess = Guess { pressure: &vec![0.0; grid.len()], contact: &contact };
        solver.solve(&scene, &options, Some(guess), None).expect("a result");
        assert_near(solver.stiffness().expect("a stiffness").1.value / unit, expected, 1e-8, "a fixed area");
    }
}
