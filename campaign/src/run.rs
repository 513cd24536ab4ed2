//! A case from its seed to its verdict.

use std::panic::{catch_unwind, AssertUnwindSafe};

use crate::case::Case;
use crate::random::Random;
use crate::verdict::Verdict;
use crate::{accuracy, batch, call, friction, measured, relaxing, rules, sequence, set_influence, stress};

/// The result of one case.
pub struct Run {
    pub case: Case,
    pub statuses: Vec<i32>,
    /// The further calls of the case, and their statuses.
    pub beside: Option<(String, Vec<i32>)>,
    pub verdict: Verdict,
    /// Products of AUTO without a guess, for a case without limits: those of all grids, in products on the finest.
    pub products: Option<f64>,
    /// The processor's seconds.
    pub seconds: f64,
}

/// The prefix of failures in the further calls.
pub const BESIDE: &str = "beside: ";
/// AUTO with more products than this is counted, also if it ends OK.
const MANY_PRODUCTS: f64 = 200.0;

/// A case that takes more seconds of the processor hangs. (The largest cases take some seconds.)
const TOO_LONG: f64 = 60.0;

/// The processor's seconds of this process, whatever the load of the machine.
fn seconds() -> f64 {
    // SAFETY: a struct of two integers.
    let mut time: libc::timespec = unsafe { std::mem::zeroed() };
    // SAFETY: room for the time.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Runs the case of a seed: one in 25 has a scene like those of measured surfaces.
pub fn ordinary(seed: u64) -> Run {
    if Random::new(seed ^ 0x0b12_76ed).chance(0.04) {
        return measured(seed);
    }
    run(Case::new(seed))
}

/// Runs the case of a seed with a scene like those of measured surfaces.
pub fn measured(seed: u64) -> Run {
    run(measured::case(seed))
}

fn run(case: Case) -> Run {
    let began = seconds();
    let mut run =
        Run { case, statuses: Vec::new(), beside: None, verdict: Verdict::default(), products: None, seconds: 0.0 };
    if let Err(panic) = catch_unwind(AssertUnwindSafe(|| ask(&mut run))) {
        let details = panic.downcast_ref::<String>().cloned().unwrap_or_default();
        run.verdict.fail("no panic", details);
    }
    run.seconds = seconds() - began;
    if run.seconds > TOO_LONG {
        run.verdict.fail("bounded time", format!("{:.1} s", run.seconds));
    }
    run
}

fn ask(run: &mut Run) {
    if run.case.through_handle {
        let found = sequence::run(&run.case);
        run.statuses = found.statuses;
        run.verdict.add(found.verdict);
    } else {
        single(run);
    }
    beside(run);
}

/// Makes one call, and repeats it.
fn single(run: &mut Run) {
    let case = &run.case;
    let found = call::solve(case);
    run.statuses.push(found.status);
    run.verdict.add(rules::check(case, &found));
    let how = &case.how;
    if found.status >= 0 && how.method == 0 && how.given.is_none() && how.fixed.is_none() && how.is_unhindered() {
        run.products = Some(found.report.statistics.work_units);
        if found.status == 0 && found.report.statistics.work_units > MANY_PRODUCTS {
            run.verdict.excuse("AUTO took more than 200 products");
        }
    }
    // Large cases are repeated now and then.
    if case.grid.len() < 5000 || case.seed % 4 == 0 {
        let same = call::solve(case).bits() == found.bits();
        run.verdict.unless(same, "the same call twice has the same bits", String::new);
    }
}

/// Makes the further calls of some seeds.
fn beside(run: &mut Run) {
    let case = &run.case;
    // A separate sequence, so that the random numbers of the case do not change.
    let random = &mut Random::new(case.seed ^ 0x00be_51de);
    let verdict = match random.uniform() {
        u if u < 0.04 => stress::check(random),
        u if u < 0.05 => accuracy::check(random).into(),
        u if u < 0.10 && case.grid.len() < 15000 => batch::run(case, random),
        u if u < 0.15 && case.grid.len() < 15000 => set_influence::run(case, random),
        u if u < 0.25 => {
            let asked = friction::run(random, case.is_measured);
            run.beside = Some((asked.case.kind(), asked.statuses));
            asked.verdict
        }
        u if u < 0.28 && case.grid.len() < 15000 => {
            let asked = relaxing::run(case.seed);
            run.beside = Some(("steps of bodies that relax".into(), asked.statuses));
            asked.verdict
        }
        _ => return,
    };
    run.verdict.add(verdict.within(BESIDE));
}
