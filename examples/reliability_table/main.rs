//! Prints the tables of docs/reliability_table.md and docs/reliability_friction.md: the residual and the number of products of each case, for every
//! method or motion.
//!
//! `cargo run --release --locked --example reliability_table`, or for the second table alone `... -- friction`.

#[path = "../../tests/problems/dense.rs"]
mod dense;
#[allow(dead_code)] // This example uses a part of the tests' module only.
#[path = "../../tests/problems/families/mod.rs"]
mod families;
mod friction;

use contact_normal::error::Error;
use contact_normal::scene::Load;
use contact_normal::solver::{Method, Options, Outcome};
use families::certificate::{recompute, run, Found};
use families::{all, case, Case};

const METHODS: [(&str, Method); 4] = [
    ("AUTO", Method::Auto),
    ("FULL_MULTIGRID", Method::FullMultigrid),
    ("MULTIGRID", Method::Multigrid),
    ("NORM", Method::Norm),
];

fn main() {
    if std::env::args().nth(1).as_deref() != Some("friction") {
        print_normal();
        println!();
    }
    friction::print();
}

fn print_normal() {
    let names: Vec<&str> = METHODS.iter().map(|(name, _)| *name).collect();
    println!("| case | grid | load | {} |", names.join(" | "));
    println!("|---|---|---|{}", "---|".repeat(names.len()));
    let mut solved = [0; METHODS.len()];
    let mut count = 0;
    for (family, cases) in all() {
        println!("| **{family}** |||{}", "|".repeat(names.len()));
        for case in cases {
            count += 1;
            let mut cells = Vec::new();
            for (k, (_, method)) in METHODS.iter().enumerate() {
                let outcome = run(&case, *method);
                solved[k] += usize::from(is_solved(&case, &outcome));
                cells.push(cell(&case, &outcome));
            }
            let load = match case.load {
                Load::Approach(approach) => format!("approach {}", shown(approach)),
                Load::Force(force) => format!("force {}", shown(force)),
            };
            println!("| {} | {} x {} | {load} | {} |", case.name, case.grid.mx, case.grid.my, cells.join(" | "));
        }
    }
    let sums: Vec<String> = solved.iter().map(|solved| format!("{solved} of {count}")).collect();
    println!("| **solved** | | | {} |", sums.join(" | "));
}

/// Whether the status is OK and the certificate, recomputed from the returned arrays, holds.
fn is_solved(case: &Case, outcome: &Result<Found, Error>) -> bool {
    outcome.as_ref().is_ok_and(|found| {
        let measures = recompute(case, found);
        let worst = measures.residual.max(measures.violation).max(measures.complementarity);
        found.stop == Outcome::Converged && worst <= Options::default().tolerance + measures.round_off
    })
}

/// A cell of the table: the residual and the work units, after the status if that is not OK.
fn cell(case: &Case, outcome: &Result<Found, Error>) -> String {
    let found = match outcome {
        Ok(found) => found,
        Err(Error::NotPositiveDefinite(_)) => return "**NOT_POSITIVE_DEFINITE**".into(),
        Err(error) => return format!("**{error}**"),
    };
    let numbers = format!("{:.0e}, {:.1}", recompute(case, found).residual, found.report.count.work_units);
    match found.stop {
        _ if is_solved(case, outcome) => numbers,
        Outcome::Converged => format!("**WRONG** {numbers}"),
        Outcome::IterationLimit => format!("**ITERATION_LIMIT** {numbers}"),
        Outcome::Cancelled => format!("**CANCELLED** {numbers}"),
        Outcome::Stagnated => format!("**STAGNATED** {numbers}"),
    }
}

/// A number with three decimals, in exponential notation if it would be too long for the table.
fn shown(value: f64) -> String {
    if value.abs() < 1e9 {
        format!("{value:.3}")
    } else {
        format!("{value:.3e}")
    }
}
