//! The campaign: random scenes through the C ABI of contact-normal, each answer certified by an oracle of the campaign's own.
//!
//! `case` makes a scene from a seed, `call` has the library solve it, `operator` (with `half_space`) sums displacements directly,
//! `rules` has the promises, `bytes` (with `bytes_friction`) turns random bytes into calls, `sequence` what a handle promises beyond them, `account` what was run and
//! what failed. Some seeds are asked more beside their case: `batch`, `set_influence`, `accuracy` (a ball to an accuracy), `stress`,
//! `friction`. Nothing of
//! the library is used but the C ABI's functions: a change of its core does not touch this.

pub mod account;
pub mod accuracy;
pub mod batch;
pub mod bytes;
mod bytes_call;
pub mod bytes_friction;
mod bytes_reader;
pub mod call;
pub mod case;
pub mod coating;
mod effect_structs;
pub mod effects;
pub mod friction;
pub mod friction_call;
pub mod friction_case;
mod friction_conditions;
mod friction_found;
pub mod grid;
pub mod half_space;
mod init;
mod measures;
pub mod operator;
pub mod random;
pub mod rules;
pub mod scales;
pub mod sequence;
pub mod set_influence;
pub mod stress;
pub mod surface;

use std::panic::{catch_unwind, AssertUnwindSafe};
use std::time::Instant;

use case::Case;
use random::Random;
use rules::Failure;

/// What came of one case.
pub struct Run {
    pub case: Case,
    pub statuses: Vec<i32>,
    pub failures: Vec<Failure>,
    pub seconds: f64,
}

/// A case of the campaign's sizes that takes longer hangs. (The largest take a second, with all cores busy.)
const TOO_LONG: f64 = 20.0;

/// Runs the case of a seed.
pub fn run(seed: u64) -> Run {
    let case = Case::new(seed);
    let began = Instant::now();
    let ask = || {
        let (statuses, mut failures) = if case.through_handle { sequence(&case) } else { single(&case) };
        failures.extend(beside(&case));
        (statuses, failures)
    };
    let outcome = catch_unwind(AssertUnwindSafe(ask));
    let (statuses, mut failures) = outcome.unwrap_or_else(|panic| {
        let details = panic.downcast_ref::<String>().cloned().unwrap_or_default();
        (Vec::new(), vec![Failure { promise: "no panic", details }])
    });
    let seconds = began.elapsed().as_secs_f64();
    if seconds > TOO_LONG {
        failures.push(Failure { promise: "bounded time", details: format!("{seconds:.1} s") });
    }
    Run { case, statuses, failures, seconds }
}

/// What some seeds are asked beside their case.
fn beside(case: &Case) -> Vec<Failure> {
    // By numbers of their own: those of the case stay what they were.
    let random = &mut Random::new(case.seed ^ 0x00be_51de);
    match random.uniform() {
        u if u < 0.04 => stress::check(random),
        u if u < 0.05 => accuracy::check(random),
        u if u < 0.10 => batch::run(case, random),
        u if u < 0.15 => set_influence::run(case, random),
        u if u < 0.25 => friction::check(random).2,
        _ => Vec::new(),
    }
}

fn sequence(case: &Case) -> (Vec<i32>, Vec<Failure>) {
    let found = sequence::run(case);
    (found.statuses, found.failures)
}

fn single(case: &Case) -> (Vec<i32>, Vec<Failure>) {
    let found = call::solve(case);
    let mut failures = rules::check(case, &found);
    if call::solve(case).bits() != found.bits() {
        failures.push(Failure { promise: "the same call twice has the same bits", details: String::new() });
    }
    (vec![found.status], failures)
}
