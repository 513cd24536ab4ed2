//! What another table of coefficients costs on a handle (CONTACT's step): the call itself, and with what the next solve computes of it.

use contact_normal::influence::Table;
use contact_normal::scene::Scene;
use contact_normal::solver::{Options, Outcome, Solver};

use crate::case::{ellipse, Case};
use crate::measure::{in_turns, median, shown, Product};

/// What it may cost in products.
const AT_MOST: f64 = 2.5;

/// The table.
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

/// The half-space's coefficients, in which offsets `(kx, .)` and `(-kx, .)` differ by a part `skew`.
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
    println!(
        "| {} | {name} | {} | {:.1} | {:.1} | {AT_MOST} | {} |",
        case.name,
        shown(product),
        set / product,
        (both - alone) / product,
        if both - alone <= AT_MOST * product { "met" } else { "MISSED" }
    );
}
