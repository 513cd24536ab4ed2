//! Solves random scenes with friction, with random motions or tangential forces, through the C ABI, and checks each result (`friction_rules`).

use contact_normal::ffi::{CONTACT_NORMAL_ITERATION_LIMIT, CONTACT_NORMAL_OK};

use crate::friction_call::{call, frictionless, tangential, From, Handle};
use crate::friction_case::Case;
use crate::friction_found::{Before, Found};
use crate::friction_place::{Place, Stop};
use crate::friction_rules::check;
use crate::friction_sequence;
use crate::random::Random;
use crate::verdict::Verdict;

/// The number of cycles that is enough for all line contacts of unlike bodies. Some of them need more than the default, 1000 (docs/hard_cases.md).
const SLOW_CYCLES: i32 = 3000;
/// The excuse of such a line contact.
const SLOW_LINE: &str = "friction: a line of unlike bodies took more than 1000 cycles";

/// The result of a case.
pub struct Run {
    pub case: Case,
    /// The statuses of its calls.
    pub statuses: Vec<i32>,
    pub verdict: Verdict,
}

/// Makes a random case and checks it: by a sequence of calls of a handle, by two steps of a handle, or by the same call twice.
pub fn run(random: &mut Random, is_measured: bool) -> Run {
    if random.chance(0.15) {
        let (case, statuses, verdict) = friction_sequence::run(random, is_measured);
        return Run { case, statuses, verdict };
    }
    let place = Place::random(random, is_measured);
    let without = frictionless(&place, &Stop::sharp(random));
    if without.status < 0 {
        // The normal problem is refused, for example a force above the sum of the pressure limits. Cases without friction check refusals.
        let case = Case::random(random, place, &without);
        return Run { case, statuses: vec![without.status], verdict: Verdict::excused("friction: no normal problem") };
    }
    let mut case = Case::random(random, place, &without);
    let (has_handle, has_negative_pressures) = (random.chance(0.25), random.chance(0.1));
    case.slide.sensitivities = random.chance(0.2);
    let mut statuses = Vec::new();
    let mut verdict = match has_handle {
        true => with_handle(&case, &mut statuses),
        false => without_handle(&case, &mut statuses),
    };
    if has_negative_pressures {
        verdict.add(negative_pressures(random, &case, &without));
    }
    Run { case, statuses, verdict }
}

/// Makes a random case without solving it. None if its normal problem is not OK.
pub fn draw(random: &mut Random) -> Option<Case> {
    let place = Place::random(random, false);
    let without = frictionless(&place, &Stop::sharp(random));
    (without.status == CONTACT_NORMAL_OK).then(|| Case::random(random, place, &without))
}

/// Solves a case without a handle, twice, and checks the result.
fn without_handle(case: &Case, statuses: &mut Vec<i32>) -> Verdict {
    let Case { place, slide, stop, .. } = case;
    let found = call(place, slide, stop);
    statuses.push(found.status);
    if found.status == CONTACT_NORMAL_ITERATION_LIMIT && case.is_slow_line() {
        return with_more_cycles(case, statuses);
    }
    let mut verdict = check(case, &found, &case.before(&found.p));
    let same = call(place, slide, stop).bits() == found.bits();
    verdict.unless(same, "the same call with friction twice has the same bits", || case.describe());
    verdict.add(leaves_pressures(case, &found));
    verdict
}

/// Solves a line contact of unlike bodies with more cycles. The status must be OK.
fn with_more_cycles(case: &Case, statuses: &mut Vec<i32>) -> Verdict {
    let mut case = case.clone();
    case.stop.max_cycles = SLOW_CYCLES;
    let found = call(&case.place, &case.slide, &case.stop);
    statuses.push(found.status);
    let mut verdict = check(&case, &found, &case.before(&found.p));
    verdict.unless(found.status == CONTACT_NORMAL_OK, "lines of unlike bodies within 3000 cycles", || case.describe());
    verdict.excuse(SLOW_LINE);
    verdict
}

/// Solves a case with a handle, and checks the result. If it is OK, solves a second step, whose previous tractions are those of the first.
fn with_handle(case: &Case, statuses: &mut Vec<i32>) -> Verdict {
    let Case { place, slide, stop, .. } = case;
    let mut handle = match Handle::new(place, stop) {
        Ok(handle) => handle,
        Err((status, message)) => return Verdict::failed("a handle for friction", format!("{status}: {message}")),
    };
    let first = handle.solve(place, Some((slide, From::Slide)), stop);
    statuses.push(first.status);
    let mut verdict = check(case, &first, &case.before(&first.p));
    verdict.add(leaves_pressures(case, &first));
    if first.status == CONTACT_NORMAL_OK {
        let second = handle.solve(place, Some((slide, From::Handle)), stop);
        statuses.push(second.status);
        if second.status == CONTACT_NORMAL_ITERATION_LIMIT && case.is_slow_line() {
            let mut case = case.clone();
            case.stop.max_cycles = SLOW_CYCLES;
            verdict.add(with_handle(&case, statuses));
            verdict.excuse(SLOW_LINE);
            return verdict;
        }
        let before = Before { q: first.q, p: first.p };
        verdict.add(check(case, &second, &before).within("continued: "));
    }
    verdict
}

/// Checks that pressures between like bodies are those of the scene without friction.
fn leaves_pressures(case: &Case, found: &Found) -> Verdict {
    let mut verdict = Verdict::default();
    if case.place.is_alike() && case.stop.cancel_at.is_none() && found.status >= 0 {
        let alone = frictionless(&case.place, &case.stop);
        let same = alone.p.iter().zip(&found.p).all(|(a, b)| a.to_bits() == b.to_bits());
        verdict.unless(same, "friction of like bodies leaves the pressures alone", || {
            format!("{}: status {}", case.describe(), found.status)
        });
    }
    verdict
}

/// Solves the tangential problem for pressures, some of which are negative instead of 0. Checks that the tractions do not change.
fn negative_pressures(random: &mut Random, case: &Case, without: &Found) -> Verdict {
    let Case { place, slide, stop, .. } = case;
    let maybe_negative = |p: &f64| if *p > 0.0 || random.chance(0.5) { *p } else { -random.uniform() };
    let with_negative: Vec<f64> = without.p.iter().map(maybe_negative).collect();
    let [found, expected] = [&with_negative, &without.p].map(|p| tangential(place, slide, stop, p));
    let same = found.status == expected.status
        && found.q.iter().flatten().zip(expected.q.iter().flatten()).all(|(a, b)| a.to_bits() == b.to_bits());
    let mut verdict = Verdict::default();
    verdict.unless(same, "pressures that pull count as no contact", || {
        format!("{}: status {} and {}", case.describe(), found.status, expected.status)
    });
    verdict
}
