//! The promises of the library for every result, checked with the campaign's own matrix A, which is independent of the library.

use contact_normal::ffi::*;

use crate::call::Outputs;
use crate::case::Case;
use crate::effects::Definiteness;
use crate::grid::Load;
use crate::measures::{pairwise, Measures};
use crate::verdict::{Failure, Verdict};

/// One broken promise, as a list.
fn failure(promise: &'static str, details: String) -> Vec<Failure> {
    vec![Failure { promise, details }]
}

/// Checks a result. The verdict has the broken promises and, for a result that is no solution, the excuse.
pub fn check(case: &Case, found: &Outputs) -> Verdict {
    if found.status < 0 {
        return refused(case, found);
    }
    let failures = is_true(case, found);
    if found.status == CONTACT_NORMAL_OK || !failures.is_empty() {
        return failures.into();
    }
    let m = Measures::of(case, found);
    match excuse(case, found, &m) {
        Some(why) => Verdict::excused(why),
        None => Verdict::failed("AUTO solves an elastic body's scene", m.text(found)),
    }
}

/// The excuse of a solve that stopped early, if it has one. AUTO has none for elastic bodies, unless the solve was cancelled or had few cycles, or
/// only round-off is left.
fn excuse(case: &Case, found: &Outputs, m: &Measures) -> Option<&'static str> {
    let (how, definiteness) = (&case.how, case.effects.definiteness);
    match found.status {
        CONTACT_NORMAL_CANCELLED => Some("cancelled by the callback"),
        CONTACT_NORMAL_ITERATION_LIMIT if !how.is_unhindered() => Some("few cycles were given, and used up"),
        _ if !how.is_unhindered() => Some("stagnated within few cycles"),
        _ if definiteness == Definiteness::Indefinite => Some("stopped early: coefficients of no elastic body"),
        _ if definiteness == Definiteness::Unsymmetric => Some("stopped early: coefficients that are not symmetric"),
        _ if m.holds_to_rounding(case, found) => Some("stagnated where round-off is left"),
        _ => match how.method {
            CONTACT_NORMAL_METHOD_NORM => Some("NORM stopped early"),
            CONTACT_NORMAL_METHOD_MULTIGRID => Some("MULTIGRID stopped early"),
            CONTACT_NORMAL_METHOD_FULL_MULTIGRID => Some("FULL_MULTIGRID stopped early"),
            CONTACT_NORMAL_METHOD_PROJECTED_CG => Some("PROJECTED_CG stopped early"),
            _ => None,
        },
    }
}

/// Whether the contact conditions hold to the tolerance plus round-off, so that no solver could do better.
pub fn is_at_rounding(case: &Case, found: &Outputs) -> bool {
    Measures::of(case, found).holds_to_rounding(case, found)
}

/// Checks pressures whose problem has changed since they were computed: values are finite and within their bounds, and u = A p. Other conditions need
/// not hold.
pub fn is_admissible(case: &Case, found: &Outputs) -> Vec<Failure> {
    let mut failures = sound(case, found);
    if failures.is_empty() {
        let m = Measures::of(case, found);
        if !(m.error_of_u <= m.rounding) {
            failures
                .extend(failure("u is A p", format!("off by {:.2e}, rounding is {:.2e}", m.error_of_u, m.rounding)));
        }
    }
    failures
}

/// Checks a result with status >= 0. It need not be a solution, but its values and its status must be true.
pub fn is_true(case: &Case, found: &Outputs) -> Vec<Failure> {
    let mut failures = sound(case, found);
    if !failures.is_empty() {
        return failures;
    }
    let m = Measures::of(case, found);
    let sizes = m.text(found);
    if !(m.error_of_u <= m.rounding) {
        failures.extend(failure("u is A p", format!("off by {:.2e}, rounding is {:.2e}", m.error_of_u, m.rounding)));
    }
    if !(m.excess_error_of_e <= 0.0) {
        failures.extend(failure(
            "e is h - approach + u",
            format!("off by {:.2e} more than round-off, {sizes}, {} in contact", m.excess_error_of_e, m.count),
        ));
    }
    if found.status == CONTACT_NORMAL_OK {
        failures.extend(solved(case, found, &m, &sizes));
    } else {
        failures.extend(stopped(case, found, &m));
    }
    failures
}

/// Checks that all values are finite, that pressures are not negative and within their limits to the last bit, and that there are none outside C.
fn sound(case: &Case, found: &Outputs) -> Vec<Failure> {
    let n = case.grid.len();
    let status = found.status;
    if !(0..=3).contains(&status) {
        return failure("known status", format!("{status}"));
    }
    let finite = found.p.iter().chain(&found.u).all(|v| v.is_finite());
    let gaps =
        (0..n).all(|i| if case.h[i].is_infinite() { found.e[i] == f64::INFINITY } else { found.e[i].is_finite() });
    let report = &found.report;
    let numbers = [
        report.normal.approach,
        report.normal.force,
        report.normal.residual,
        report.normal.violation,
        report.normal.max_pressure,
        report.accuracy.error_force,
        report.accuracy.error_max_pressure,
        report.accuracy.error_contact_area,
        report.accuracy.error_corrected_area,
        report.accuracy.error_pressure,
    ];
    if !finite || !gaps || numbers.iter().any(|v| !v.is_finite()) {
        return failure(
            "no NaN or infinity",
            format!("status {status}, residual reported {:.2e}", report.normal.residual),
        );
    }
    let mut failures = Vec::new();
    if let Some(overrun) = found.overrun.filter(|n| *n > 0 || found.status != CONTACT_NORMAL_CANCELLED) {
        let details = format!("status {}, {overrun} callbacks after the one that cancelled", found.status);
        failures.extend(failure("cancelled once stays cancelled", details));
    }
    let fixed = &case.how.fixed;
    if fixed.is_none() && found.p.iter().any(|&p| p < 0.0) {
        failures.extend(failure("p >= 0", format!("status {status}")));
    }
    let over = |i: usize| case.effects.limit.as_ref().map_or(0.0, |limit| found.p[i] / limit.at(i));
    let excess = (0..n).map(over).fold(0.0, f64::max);
    if excess > 1.0 {
        failures.extend(failure("p <= limit", format!("status {status}: {excess} times the limit")));
    }
    let outside = |i: usize| found.contact[i] == 0 && found.p[i] != 0.0;
    if (0..n).any(outside) {
        failures.extend(failure("p = 0 outside", format!("status {status}")));
    }
    let known = |i: usize| match (found.contact[i], &case.effects.limit) {
        (0, _) => true,
        (1, _) => case.h[i].is_finite() || fixed.is_some(),
        (2, Some(limit)) => found.p[i] == limit.at(i),
        _ => false,
    };
    if !(0..n).all(known) {
        failures.extend(failure("contact says what an element is", format!("status {status}")));
    }
    // An excluded element (h infinite) has no pressure, whatever its code in `contact` is.
    if (0..n).any(|i| case.h[i].is_infinite() && found.p[i] != 0.0) {
        failures.extend(failure("p = 0 where there is no surface", format!("status {status}")));
    }
    let given = |((&found, &fixed), h): ((&i32, &i32), &f64)| h.is_infinite() || (found != 0) == (fixed != 0);
    if fixed.as_ref().is_some_and(|fixed| !found.contact.iter().zip(fixed).zip(&case.h).all(given)) {
        failures.extend(failure("a fixed area stays", format!("status {status}")));
    }
    if let Load::Approach(approach) = case.load {
        if report.normal.approach != approach {
            failures.extend(failure(
                "the approach is the prescribed one",
                format!("{} for {approach}", report.normal.approach),
            ));
        }
    }
    failures
}

/// Checks a result with status OK.
fn solved(case: &Case, found: &Outputs, m: &Measures, sizes: &str) -> Vec<Failure> {
    let mut failures = Vec::new();
    let tolerance = case.how.tolerance;
    let by_update = case.how.criterion == CONTACT_NORMAL_CRITERION_UPDATE;
    let fixed = case.how.fixed.is_some();
    if by_update {
        if !m.residual_holds(tolerance.max(1e-2)) {
            failures.extend(failure("OK by update: residual", sizes.into()));
        }
    } else {
        if !m.residual_holds(tolerance) {
            failures.extend(failure("OK: residual", sizes.into()));
        }
        if !fixed && !(m.violation <= tolerance * (1.0 + 1e-12) * m.rms + m.rounding) {
            failures.extend(failure("OK: violation", sizes.into()));
        }
        let pressures = found.p.iter().sum::<f64>();
        if !fixed && !(m.complementarity <= tolerance * (1.0 + 1e-9) * m.elastic_work + m.rounding * pressures) {
            failures.extend(failure("OK: complementarity", format!("{:.2e}", m.complementarity / m.elastic_work)));
        }
    }
    if let Load::Force(prescribed) = case.load {
        let force = pairwise(&found.p) * case.grid.element_area();
        // On a fixed area pressures may be negative, and cancel in the force. So the error is relative to the sum of |p|.
        let sizes: Vec<f64> = found.p.iter().map(|p| p.abs()).collect();
        let size = pairwise(&sizes) * case.grid.element_area();
        if !((force - prescribed).abs() <= 1e-12 * size.max(prescribed)) {
            failures.extend(failure("OK: force", format!("{force:e} for {prescribed:e}")));
        }
    }
    if m.count == 0.0 && found.report.normal.residual != 0.0 {
        let details = format!("reported {:.2e}, no element in contact", found.report.normal.residual);
        failures.extend(failure("the report's residual is the residual", details));
    }
    // Both residuals are norms of the same e, added in different orders (1e-9). Each e has round-off.
    let rounding = m.rounding * m.count.sqrt() / m.distance;
    if m.distance > 0.0 && !((found.report.normal.residual - m.relative()).abs() <= rounding + 1e-9 * m.relative()) {
        let details = format!("reported {:.2e}, {sizes}", found.report.normal.residual);
        failures.extend(failure("the report's residual is the residual", details));
    }
    failures
}

/// Checks a result with status > 0. It is the best iterate.
fn stopped(case: &Case, found: &Outputs, m: &Measures) -> Vec<Failure> {
    let status = found.status;
    let mut failures = Vec::new();
    // With p = 0, e is `h - approach`, and the relative residual is 1 over any C.
    if matches!(case.load, Load::Approach(_)) && !m.residual_holds(1.0) {
        failures.extend(failure("stopped: no worse than p = 0", m.text(found)));
    }
    if status == CONTACT_NORMAL_CANCELLED && found.overrun.is_none() {
        failures.extend(failure("cancelled by nobody", m.text(found)));
    }
    failures
}

/// Checks a result with status < 0: the library refused the call.
fn refused(case: &Case, found: &Outputs) -> Verdict {
    let mut verdict = Verdict::default();
    let details = || format!("{}: {}", found.status, found.message);
    verdict.unless(!found.written, "refused: outputs untouched", details);
    verdict.unless(!found.message.is_empty(), "refused: a message", details);
    match reason(case, found.status) {
        Some(why) => verdict.excuse(why),
        None => verdict.fail("refused without a reason", details()),
    }
    verdict
}

/// The reason for which the library may refuse this scene with this status, if there is one.
pub fn reason(case: &Case, status: i32) -> Option<&'static str> {
    let (effects, how) = (&case.effects, &case.how);
    let multigrid = [CONTACT_NORMAL_METHOD_MULTIGRID, CONTACT_NORMAL_METHOD_FULL_MULTIGRID].contains(&how.method);
    let cg = how.method == CONTACT_NORMAL_METHOD_PROJECTED_CG;
    let is_definite = effects.definiteness == Definiteness::PositiveDefinite;
    let reasons: &[(bool, &'static str)] = match status {
        CONTACT_NORMAL_UNSUPPORTED => &[
            (effects.is_unsupported_pair(), "refused: a pair of effects"),
            (how.fixed.is_some() && effects.limit.is_some(), "refused: a fixed area with a limit"),
            (multigrid && effects.may_lack_multigrid(), "refused: an effect without multigrid"),
            (cg && !is_definite, "refused: PROJECTED_CG of what is not symmetric"),
        ],
        CONTACT_NORMAL_INFEASIBLE => &[
            (exceeds_limit(case), "refused: more force than the limit carries"),
            (is_in_full_contact(case), "refused: two periods in full contact, by approach"),
        ],
        CONTACT_NORMAL_NOT_POSITIVE_DEFINITE => &[(!is_definite, "refused: coefficients of no elastic body")],
        // The library may refuse a guess with negative pressures.
        CONTACT_NORMAL_INVALID_ARGUMENT => {
            let negative = how.given.as_ref().is_some_and(|given| given.iter().any(|&p| p < 0.0));
            &[(negative, "refused: a guess below 0")]
        }
        _ => &[],
    };
    reasons.iter().find(|(holds, _)| *holds).map(|(_, why)| *why)
}

/// Whether the force is larger than the limit allows on all elements together. 1e-9: the library adds the limits in another order.
fn exceeds_limit(case: &Case) -> bool {
    let Load::Force(force) = case.load else { return false };
    case.effects.limit.as_ref().is_some_and(|limit| {
        let carried = (0..case.h.len()).filter(|&i| case.h[i].is_finite()).map(|i| limit.at(i));
        force > carried.sum::<f64>() * case.grid.element_area() * (1.0 - 1e-9)
    })
}

/// Whether a scene with two periods has an approach that would lead to full contact. The mean displacement is then zero, so that the approach cannot
/// exceed the mean distance.
fn is_in_full_contact(case: &Case) -> bool {
    let Load::Approach(approach) = case.load else { return false };
    let finite = || case.h.iter().filter(|h| h.is_finite());
    let mean = finite().sum::<f64>() / finite().count().max(1) as f64;
    case.effects.period == Some((true, true)) && approach >= mean - 1e-9 * mean.abs()
}
