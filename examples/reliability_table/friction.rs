//! The table of friction: the residual and the number of products of every hard case in every motion.

#[allow(dead_code)] // This example uses a part of the tests' module only.
#[path = "../../tests/friction/hard/mod.rs"]
mod hard;

use contact_normal::solver::Outcome;
use hard::cases::{all, MOTIONS};
use hard::certificate::{judge, Verdict};

/// Solves all cases, and prints the table.
pub fn print() {
    let names: Vec<&str> = MOTIONS.iter().map(|(name, _)| *name).collect();
    println!("| case | grid | {} |", names.join(" | "));
    println!("|---|---|{}", "---|".repeat(names.len()));
    let mut solved = [0; MOTIONS.len()];
    let mut count = 0;
    for (family, cases) in all() {
        println!("| **{family}** ||{}", "|".repeat(names.len()));
        for case in cases {
            count += usize::from(case.refusal.is_none());
            let verdicts = MOTIONS.map(|(_, motion)| judge(&case, motion));
            for (solved, verdict) in solved.iter_mut().zip(&verdicts) {
                *solved += usize::from(matches!(verdict, Verdict::Solved { .. }));
            }
            println!("| {} | {} x {} | {} |", case.name, case.grid.mx, case.grid.my, verdicts.map(cell).join(" | "));
        }
    }
    let sums: Vec<String> = solved.iter().map(|solved| format!("{solved} of {count}")).collect();
    println!("| **solved** | | {} |", sums.join(" | "));
}

/// A cell of the table: the residual and the products, after the status if that is not the expected one.
fn cell(verdict: Verdict) -> String {
    match verdict {
        Verdict::Solved { residual, products } => format!("{residual:.0e}, {products:.1}"),
        Verdict::Wrong { residual, products, why } => format!("**WRONG** {residual:.0e}, {products:.1}: {why}"),
        Verdict::Stopped { outcome, residual, products } => {
            let name = match outcome {
                Outcome::IterationLimit => "ITERATION_LIMIT",
                Outcome::Cancelled => "CANCELLED",
                _ => "STAGNATED",
            };
            format!("**{name}** {residual:.0e}, {products:.1}")
        }
        Verdict::Refused(status) => status.into(),
        Verdict::RefusedOtherwise(why) => format!("**{why}**"),
    }
}
