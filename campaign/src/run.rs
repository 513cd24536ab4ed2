//! Runs the case of a seed, and all checks of it.

use std::panic::{catch_unwind, AssertUnwindSafe};

use crate::case::Case;
use crate::random::Random;
use crate::verdict::Verdict;
use crate::{accuracy, batch, call, friction, measured, relaxing, rules, sequence, set_influence, stress};

/// The result of one case.
pub struct Run {
    pub case: Case,
    /// The statuses of the calls of the case.
    pub statuses: Vec<i32>,
    /// The kind of the further calls with friction or viscoelastic bodies, if the seed has some, and their statuses.
    pub beside: Option<(String, Vec<i32>)>,
    pub verdict: Verdict,
    /// The work units of AUTO, if the call has no guess, no fixed area, 1000 cycles and is not cancelled.
    pub products: Option<f64>,
    /// The processor time in seconds.
    pub seconds: f64,
}

/// The prefix of the details of failures in further calls.
pub const BESIDE: &str = "beside: ";
/// A call of AUTO with more products than this counts as an excuse, although it is OK.
const MANY_PRODUCTS: f64 = 200.0;

/// A case with a longer processor time, in seconds, counts as hanging. The largest cases take some seconds.
const TOO_LONG: f64 = 60.0;

/// The processor time of this process, in seconds.
fn seconds() -> f64 {
    // SAFETY: zero is a valid value of a struct of two integers.
    let mut time: libc::timespec = unsafe { std::mem::zeroed() };
    // SAFETY: the call writes one struct, to `time`.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Runs the case of a seed. One case in 25 has a surface like measured ones.
pub fn ordinary(seed: u64) -> Run {
    if Random::new(seed ^ 0x0b12_76ed).chance(0.04) {
        return measured(seed);
    }
    run(Case::new(seed))
}

/// Runs the case of a seed with a surface like measured ones.
pub fn measured(seed: u64) -> Run {
    run(measured::case(seed))
}

/// Runs a case. A panic and a long processor time are failures.
fn run(case: Case) -> Run {
    let began = seconds();
    let mut run =
        Run { case, statuses: Vec::new(), beside: None, verdict: Verdict::default(), products: None, seconds: 0.0 };
    if let Err(panic) = catch_unwind(AssertUnwindSafe(|| make_calls(&mut run))) {
        let details = panic.downcast_ref::<String>().cloned().unwrap_or_default();
        run.verdict.fail("no panic", details);
    }
    run.seconds = seconds() - began;
    if run.seconds > TOO_LONG {
        run.verdict.fail("bounded time", format!("{:.1} s", run.seconds));
    }
    run
}

/// Makes the calls of a case.
fn make_calls(run: &mut Run) {
    if run.case.through_handle {
        let found = sequence::run(&run.case);
        run.statuses = found.statuses;
        run.verdict.add(found.verdict);
    } else {
        single(run);
    }
    beside(run);
}

/// Makes one call without a handle and checks the result. Most calls are repeated, and must have the same bits.
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
    // One large case in four is repeated.
    if case.grid.len() < 5000 || case.seed % 4 == 0 {
        let same = call::solve(case).bits() == found.bits();
        run.verdict.unless(same, "the same call twice has the same bits", String::new);
    }
}

/// Makes further calls, for some seeds: other functions of the library, or scenes with friction or viscoelastic bodies.
fn beside(run: &mut Run) {
    let case = &run.case;
    // A separate sequence of random numbers, so that the case stays the same.
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
