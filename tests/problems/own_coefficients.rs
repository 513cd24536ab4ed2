//! Influence coefficients of the caller: unsymmetric tables, tables whose circulant is not positive, tables of no elastic body, and tables in another
//! layout.

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace, Kernel, RowTables, Table};
use contact_normal::scene::{Load, Scene};
use contact_normal::solver::{solve, Criterion, Method, Options, Outcome, Solver};
use contact_normal::threads::Threads;

use crate::families::case::{paraboloid, rigid_on};
use crate::hard_cases::{certified, METHODS};

fn table_of(grid: &Grid, cx: usize, cy: usize, change: impl Fn(i64, i64, f64) -> f64) -> Table {
    let half_space = HalfSpace::new(grid.dx, grid.dy, rigid_on(1.0).compliance());
    let mut values = Vec::new();
    for ky in -(cy as i64)..cy as i64 {
        for kx in -(cx as i64)..cx as i64 {
            values.push(change(kx, ky, half_space.at(kx, ky)));
        }
    }
    Table::new(cx, cy, &values, grid).unwrap()
}

#[test]
fn a_table_of_the_half_space_gives_the_pressures_of_the_half_space() {
    let grid = Grid::new(30, 23, 0.1, 0.12).unwrap();
    let h = paraboloid(&grid, 0.3);
    let plain = Scene::new(grid, &h, rigid_on(1.0), Load::Force(0.4));
    let expected = certified(&plain, &Options { tolerance: 1e-10, ..Options::default() });
    for (cx, cy) in [(30, 23), (31, 24), (90, 200)] {
        for method in METHODS {
            let influence = Some(table_of(&grid, cx, cy, |_, _, value| value));
            let options = Options { method, tolerance: 1e-10, ..Options::default() };
            let solver = certified(&Scene { influence, ..plain.clone() }, &options);
            let size = expected.state().p.iter().copied().fold(0.0, f64::max);
            for (a, b) in solver.state().p.iter().zip(&expected.state().p) {
                assert!((a - b).abs() <= 1e-8 * size, "{method:?}: {a} for {b}");
            }
        }
    }
}

#[test]
fn a_table_without_symmetry_is_solved_as_it_is() {
    let grid = Grid::new(24, 20, 0.1, 0.1).unwrap();
    let h = paraboloid(&grid, 0.3);
    // The influence is 10 % larger on one side than on the other.
    let influence = table_of(&grid, 24, 20, |kx, _, value| value * (1.0 + 0.05 * (kx.signum() as f64)));
    let scene =
        Scene { influence: Some(influence.clone()), ..Scene::new(grid, &h, rigid_on(1.0), Load::Approach(0.1)) };
    for method in [Method::Auto, Method::Norm, Method::Multigrid, Method::FullMultigrid] {
        let solver = certified(&scene, &Options { method, tolerance: 1e-9, ..Options::default() });
        let state = solver.state();
        // The distance e with displacements by direct sums.
        let mut u = vec![0.0; grid.len()];
        super::dense::apply(&Coefficients::from(influence.clone()), &grid, &state.p, &mut u);
        for i in 0..grid.len() {
            let e = h[i] - 0.1 + u[i];
            assert!(if state.contact[i] { e.abs() <= 1e-9 } else { e > 0.0 }, "{method:?}");
        }
    }
    let error = solve(&scene, &Options { method: Method::ProjectedCg, ..Options::default() }).err();
    assert!(matches!(error, Some(Error::Unsupported(_))));
}

#[test]
fn the_update_criterion_ends_with_a_force_for_a_table_without_symmetry() {
    let grid = Grid::new(24, 24, 0.25, 0.2).unwrap();
    let ripples = |i: usize| 0.002 * (0.9 * (i % 24) as f64).sin() * (0.7 * (i / 24) as f64).cos();
    let h: Vec<f64> = paraboloid(&grid, 0.006).iter().enumerate().map(|(i, h)| h + ripples(i)).collect();
    let influence = table_of(&grid, 24, 24, |kx, _, value| value * (1.0 + 0.01 * kx as f64 / 24.0));
    for force in [0.01, 0.03, 0.1] {
        let scene =
            Scene { influence: Some(influence.clone()), ..Scene::new(grid, &h, rigid_on(1.0), Load::Force(force)) };
        let options =
            Options { method: Method::Norm, criterion: Criterion::Update, max_cycles: 5000, ..Options::default() };
        certified(&scene, &options);
    }
}

#[test]
fn a_table_whose_circulant_is_not_positive_is_solved_all_the_same() {
    // A product of damped cosines is positive definite, because its transform is a product of Lorentzians. Its circulant, wrapped around half a
    // period, is not.
    let grid = Grid::new(16, 16, 1.0, 1.0).unwrap();
    let h = paraboloid(&grid, 0.01);
    let wave = |k: i64| (0.9 * k as f64).cos() * (-0.05 * k.abs() as f64).exp();
    let influence =
        table_of(&grid, 16, 16, |kx, ky, _| wave(kx) * wave(ky) + if (kx, ky) == (0, 0) { 0.5 } else { 0.0 });
    let full = Coefficients::from(influence.clone());
    let circulant = contact_normal::operator::Operator::<f64>::inverse_circulant(&full, &grid, (18, 18), &Threads::One);
    assert!(circulant.unwrap().is_none(), "the table does not test what it should");
    for load in [Load::Approach(0.3), Load::Force(5.0)] {
        let scene = Scene { influence: Some(influence.clone()), ..Scene::new(grid, &h, rigid_on(1.0), load) };
        let norm = certified(&scene, &Options { method: Method::Norm, tolerance: 1e-9, ..Options::default() });
        let auto = certified(&scene, &Options { tolerance: 1e-9, ..Options::default() });
        let size = norm.state().p.iter().copied().fold(0.0, f64::max);
        for (a, b) in auto.state().p.iter().zip(&norm.state().p) {
            assert!((a - b).abs() <= 1e-6 * size);
        }
    }
}

#[test]
fn an_indefinite_table_is_refused() {
    let grid = Grid::new(12, 12, 1.0, 1.0).unwrap();
    let h = vec![0.0; grid.len()];
    let influence = table_of(&grid, 12, 12, |kx, ky, _| if (kx, ky) == (0, 0) { 1.0 } else { -0.9 });
    for method in [Method::Auto, Method::Norm] {
        let scene =
            Scene { influence: Some(influence.clone()), ..Scene::new(grid, &h, rigid_on(1.0), Load::Approach(1.0)) };
        let error = solve(&scene, &Options { method, ..Options::default() }).err();
        assert!(matches!(error, Some(Error::NotPositiveDefinite(_))), "{method:?}: {error:?}");
    }
}

/// Tables in other layouts: padded behind, or with offset (0, 0) first; and rows in which the coefficient of an element on itself is not the largest.
/// Of a pair of opposite offsets one coefficient alone may be larger.
#[test]
fn coefficients_larger_than_that_of_an_element_on_itself_are_refused() {
    let grid = Grid::new(12, 9, 1.0, 1.0).unwrap();
    let h = vec![0.0; grid.len()];
    let solved = |influence: Option<Table>, row_tables: Option<RowTables>| {
        let plain = Scene::new(grid, &h, rigid_on(1.0), Load::Approach(1.0));
        solve(&Scene { influence, row_tables, ..plain }, &Options::default()).map(|(_, outcome, _)| outcome)
    };
    let of = |at: &dyn Fn(i64, i64) -> f64| solved(Some(table_of(&grid, 12, 9, |kx, ky, _| at(kx, ky))), None);
    let half_space = &HalfSpace::new(1.0, 1.0, rigid_on(1.0).compliance());
    let wrapped = |k: i64, c: i64| if k < 0 { k + c } else { k - c };
    let behind = of(&|kx, ky| half_space.at(kx + 1, ky + 1));
    let first = of(&|kx, ky| half_space.at(wrapped(kx, 12), wrapped(ky, 9)));
    let pulled = of(&|kx, ky| if (kx, ky) == (0, 0) { 1.0 } else { -1e100 });
    for refused in [behind, first, pulled] {
        let message = refused.unwrap_err();
        assert!(matches!(&message, Error::NotPositiveDefinite(text) if text.contains("[cy][cx]")), "{message}");
    }
    let leans = of(&|kx, ky| half_space.at(kx, ky) * (1.0 + 0.9 * kx.signum() as f64));
    assert_eq!(leans.unwrap(), Outcome::Converged);
    let rows = |own: f64| {
        let row = |k: i64| {
            let at =
                move |kx: i64| half_space.at(kx, k / 9 - k % 9) * if k / 9 == k % 9 && kx == 0 { own } else { 1.0 };
            (-12..12).map(at)
        };
        let values: Vec<f64> = (0..81).flat_map(row).collect();
        solved(None, Some(RowTables::new(12, 9, &values, &grid).unwrap()))
    };
    assert_eq!(rows(1.0).unwrap(), Outcome::Converged);
    assert!(matches!(rows(0.2).unwrap_err(), Error::NotPositiveDefinite(text) if text.contains("itself")));
    // A solver does not accept such a table in the place of a good one, either.
    let [good, shifted] = [0, 1].map(|by| table_of(&grid, 12, 9, |kx, ky, _| half_space.at(kx + by, ky + by)));
    let scene = Scene { influence: Some(good), ..Scene::new(grid, &h, rigid_on(1.0), Load::Approach(1.0)) };
    let mut solver = Solver::new(&scene, &Options::default()).unwrap();
    assert!(matches!(solver.set_influence(shifted), Err(Error::NotPositiveDefinite(_))));
}
