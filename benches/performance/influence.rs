//! Costs of replacing the table of influence coefficients of a solver handle, as CONTACT does in each step: the call itself, and together with
//! what the next solve computes from the table.

use contact_normal::grid::Grid;
use contact_normal::influence::{RowTables, Table};
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{Guess, InitialGuess, Options, Outcome, Solver};

use crate::case::{ellipse, Case};
use crate::measure::{in_turns, median, shown, Product};
use crate::summary;

/// The limit of this cost, in products.
const AT_MOST: f64 = 2.5;

/// Prints the costs of another table, for an even table and one that is not even.
pub fn another_table(sizes: &[usize]) {
    println!("\n### Another table of coefficients on a handle, in products\n");
    println!("| case | table | product | set_influence | and what the next solve computes of it | at most | |");
    println!("|---|---|---|---|---|---|---|");
    for &m in sizes {
        for (name, skew) in [("even", 0.0), ("not even", 1e-8)] {
            row(&ellipse(m), name, skew);
        }
    }
}

/// The coefficients of the half-space times `1 + skew sign(kx)`: without a skew they are even in x.
fn table(case: &Case, skew: f64) -> Vec<f64> {
    let (mx, my) = (case.grid.mx as i64, case.grid.my as i64);
    let half_space = case.scene().coefficients().expect("coefficients");
    let offsets = (0..4 * mx * my).map(|i| (i % (2 * mx) - mx, i / (2 * mx) - my));
    offsets.map(|(kx, ky)| (1.0 + skew * kx.signum() as f64) * half_space.at(kx, ky)).collect()
}

fn row(case: &Case, name: &str, skew: f64) {
    let values = table(case, skew);
    let new = || Table::new(case.grid.mx, case.grid.my, &values, &case.grid).expect("a table");
    let scene = Scene { influence: Some(new()), ..case.scene() };
    let options = Options { threads: 1, ..Options::default() };
    let mut solvers = [0; 3].map(|_| Solver::new(&scene, &options).expect("a solver"));
    let mut product = Product::new(&scene, 1);
    let solve = |solver: &mut Solver| {
        assert_eq!(solver.solve(&case.scene(), &options, None, None).expect("a solution").0, Outcome::Converged);
    };
    let [set, both, alone] = &mut solvers;
    let times = in_turns(&mut [
        &mut || product.run(),
        &mut || set.set_influence(new()).expect("a table"),
        &mut || {
            both.set_influence(new()).expect("a table");
            solve(both);
        },
        &mut || solve(alone),
    ]);
    let [product, set, both, alone] = [0, 1, 2, 3].map(|i| median(&times[i]));
    summary::note(summary::TABLE, (both - alone) / product);
    println!(
        "| {} | {name} | {} | {:.1} | {:.1} | {AT_MOST} | {} |",
        case.name,
        shown(product),
        set / product,
        (both - alone) / product,
        if both - alone <= AT_MOST * product { "met" } else { "MISSED" }
    );
}

/// Columns of elements of the groove.
const COLUMNS: usize = 60;
/// Rows of elements of the groove.
const ROWS: usize = 100;
/// The limit of the time of a call, in seconds.
const GROOVE: f64 = 5e-3;

/// Measures a call with a table for each loaded row that starts from the solution. Its time is that of copying, checking and transforming the
/// tables.
pub fn row_tables() {
    let grid = Grid::new(COLUMNS, ROWS, 0.2, 0.1).expect("a grid");
    let half_space =
        Scene::new(grid, &[], Bodies::same(82000.0, 0.28), Load::Approach(0.0)).coefficients().expect("them");
    let (rows, columns) = (ROWS as i64, COLUMNS as i64);
    let pairs = (0..rows).flat_map(|jy| (0..rows).map(move |iy| (jy, iy)));
    let offsets = pairs.flat_map(|(jy, iy)| (-columns..columns).map(move |kx| (jy, iy, kx)));
    // The compliance of the body grows a little from row to row.
    let values: Vec<f64> = offsets
        .map(|(jy, iy, kx)| (1.0 + 1e-3 * (jy + iy) as f64 / rows as f64) * half_space.at(kx, iy - jy))
        .collect();
    let centre = |i: usize, m: usize, d: f64| (i as f64 + 0.5 - 0.5 * m as f64) * d;
    let place = |i: usize| (centre(i % COLUMNS, COLUMNS, grid.dx), centre(i / COLUMNS, ROWS, grid.dy));
    let h: Vec<f64> = (0..grid.len()).map(place).map(|(x, y)| 0.003 * x * x + 0.004 * y * y).collect();
    let mut scene = Scene::new(grid, &h, Bodies::same(82000.0, 0.28), Load::Approach(0.02));
    let new = || Some(RowTables::new(COLUMNS, ROWS, &values, &grid).expect("tables"));
    scene.row_tables = new();
    let options = Options { threads: 1, ..Options::default() };
    let mut first = Solver::new(&scene, &options).expect("a solver");
    assert_eq!(first.solve(&scene, &options, None, None).expect("a solution").0, Outcome::Converged);
    let guess = Guess { pressure: &first.state().p, contact: &first.state().contact };
    let given = Options { initial_guess: InitialGuess::Given, ..options };
    let times = in_turns(&mut [&mut || {
        scene.row_tables = new();
        let mut solver = Solver::new(&scene, &given).expect("a solver");
        let (stop, _) = solver.solve(&scene, &given, Some(guess), None).expect("a solution");
        assert_eq!(stop, Outcome::Converged);
    }]);
    let call = median(&times[0]);
    summary::note(summary::GROOVE, 1e3 * call);
    let mark = if call <= GROOVE { "met" } else { "MISSED" };
    println!("\n### A call with tables of {ROWS} rows, {COLUMNS} columns, from the solution\n");
    println!("{}, at most {}: {mark}.", shown(call), shown(GROOVE));
}
