//! Batches of problems in one call. Each result is checked and must have the bits of a single call. A refused problem must not affect the others.

use crate::call::{self, Handle};
use crate::case::{Case, How};
use crate::random::Random;
use crate::rules::check;
use crate::verdict::Verdict;

/// Solves a case and one to four similar ones in one call. Sometimes one of them is invalid.
pub fn run(case: &Case, random: &mut Random) -> Verdict {
    let mut first = case.clone();
    // All problems of a batch share these options.
    first.how = How {
        threads: 1 + i32::from(random.chance(0.3)),
        given: None,
        fixed: None,
        cancel_at: None,
        ..case.how.clone()
    };
    let Ok(mut handle) = Handle::new(&first) else { return Verdict::default() };
    let mut cases = vec![first.clone()];
    for _ in 0..random.integer(1, 4) {
        let mut next = first.next(random);
        next.how = first.how.clone();
        cases.push(next);
    }
    let spoiled = random.chance(0.3).then(|| random.integer(0, cases.len() - 1));
    if let Some(k) = spoiled {
        cases[k].h[0] = f64::NAN;
    }
    let (status, found) = handle.solve_batch(&cases);
    let mut verdict = Verdict::default();
    let statuses: Vec<i32> = found.iter().map(|outputs| outputs.status).collect();
    let expected = statuses.iter().find(|s| **s < 0).or(statuses.iter().find(|s| **s > 0)).copied().unwrap_or(0);
    if status != expected {
        verdict.fail("a batch has the first status", format!("{status} of {statuses:?}"));
    }
    for (k, (case, outputs)) in cases.iter().zip(&found).enumerate() {
        if Some(k) == spoiled {
            if outputs.status >= 0 || outputs.written {
                let details = format!("status {}, written {}", outputs.status, outputs.written);
                verdict.fail("a batch refuses what is no scene", details);
            }
            continue;
        }
        verdict.add(check(case, outputs).within(&format!("{}: problem {k} of a batch: ", case.describe())));
        let alone = call::solve(case);
        if outputs.status != alone.status || (alone.status >= 0 && outputs.bits() != alone.bits()) {
            let details = format!("{}: problem {k}: status {} and {}", case.describe(), outputs.status, alone.status);
            verdict.fail("a batch gives the bits of single calls", details);
        }
    }
    verdict
}
