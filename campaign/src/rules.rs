//! What holds for every answer, by an oracle that knows nothing of the library.

use contact_normal::ffi::*;

use crate::call::Outputs;
use crate::case::Case;
use crate::grid::Load;
use crate::measures::Measures;

/// A promise that was not kept.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Which one, in a few words.
    pub promise: &'static str,
    pub details: String,
}

fn failure(promise: &'static str, details: String) -> Vec<Failure> {
    vec![Failure { promise, details }]
}

/// Checks an answer; nothing if all promises are kept.
pub fn check(case: &Case, found: &Outputs) -> Vec<Failure> {
    if found.status < 0 {
        return refused(case, found);
    }
    let mut failures = is_true(case, found);
    let must_be_solved = case.how.method == CONTACT_NORMAL_METHOD_AUTO
        && !case.effects.indefinite
        && !case.effects.unsymmetric
        && case.how.is_unhindered();
    if failures.is_empty() && must_be_solved && found.status > 0 {
        let m = Measures::of(case, found);
        if !m.holds_to_rounding(case, found) {
            failures.extend(failure("AUTO solves an elastic body's scene", m.text(found)));
        }
    }
    failures
}

/// Checks what an answer with status >= 0 says, and asks for no success.
pub fn is_true(case: &Case, found: &Outputs) -> Vec<Failure> {
    let mut failures = sound(case, found);
    if !failures.is_empty() {
        return failures;
    }
    let m = Measures::of(case, found);
    let sizes = m.text(found);
    if !(m.wrong_u <= m.rounding) {
        failures.extend(failure("u is A p", format!("off by {:.2e}, rounding is {:.2e}", m.wrong_u, m.rounding)));
    }
    if !(m.wrong_e <= 0.0) {
        failures.extend(failure("e is h - approach + u", format!("off by {:.2e}", m.wrong_e)));
    }
    if found.status == CONTACT_NORMAL_OK {
        failures.extend(solved(case, found, &m, &sizes));
    } else {
        failures.extend(stopped(case, found, &m));
    }
    failures
}

/// Numbers, no tension, limits to the last bit, nothing outside.
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
    let numbers = [report.approach, report.force, report.residual, report.violation, report.max_pressure];
    if !finite || !gaps || numbers.iter().any(|v| !v.is_finite()) {
        return failure("no NaN or infinity", format!("status {status}, residual reported {:.2e}", report.residual));
    }
    let mut failures = Vec::new();
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
        (1, _) => case.h[i].is_finite(),
        (2, Some(limit)) => found.p[i] == limit.at(i),
        _ => false,
    };
    if !(0..n).all(known) {
        failures.extend(failure("contact says what an element is", format!("status {status}")));
    }
    // What has no surface stays exterior.
    let given = |((&found, &fixed), h): ((&i32, &i32), &f64)| (found != 0) == (fixed != 0 && h.is_finite());
    if fixed.as_ref().is_some_and(|fixed| !found.contact.iter().zip(fixed).zip(&case.h).all(given)) {
        failures.extend(failure("a fixed area stays", format!("status {status}")));
    }
    if let Load::Approach(approach) = case.load {
        if report.approach != approach {
            failures
                .extend(failure("the approach is the prescribed one", format!("{} for {approach}", report.approach)));
        }
    }
    failures
}

/// Status OK.
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
        if !fixed && !(m.work.0 <= tolerance * (1.0 + 1e-9) * m.work.1 + m.rounding * pressures) {
            failures.extend(failure("OK: complementarity", format!("{:.2e}", m.work.0 / m.work.1)));
        }
    }
    if let Load::Force(prescribed) = case.load {
        let force = found.p.iter().sum::<f64>() * case.grid.element_area();
        // With tension on a fixed area the sum cancels.
        let size = found.p.iter().map(|p| p.abs()).sum::<f64>() * case.grid.element_area();
        if !((force - prescribed).abs() <= 1e-12 * size.max(prescribed)) {
            failures.extend(failure("OK: force", format!("{force:e} for {prescribed:e}")));
        }
    }
    // Two sums of the same numbers, and a residual whose e is off by rounding.
    let rounding = m.rounding * m.count.sqrt() / m.distance;
    if m.distance > 0.0 && !((found.report.residual - m.relative()).abs() <= rounding + 1e-9 * m.relative()) {
        let details = format!("reported {:.2e}, {sizes}", found.report.residual);
        failures.extend(failure("the report's residual is the residual", details));
    }
    failures
}

/// Status > 0: the best iterate.
fn stopped(case: &Case, found: &Outputs, m: &Measures) -> Vec<Failure> {
    let status = found.status;
    let mut failures = Vec::new();
    // p = 0 has 1 over any C.
    if matches!(case.load, Load::Approach(_)) && !m.residual_holds(1.0) {
        failures.extend(failure("stopped: no worse than p = 0", m.text(found)));
    }
    if status == CONTACT_NORMAL_CANCELLED && case.how.cancel_at.is_none() {
        failures.extend(failure("cancelled by nobody", m.text(found)));
    }
    failures
}

/// Status < 0.
fn refused(case: &Case, found: &Outputs) -> Vec<Failure> {
    let mut failures = Vec::new();
    let told = || format!("{}: {}", found.status, found.message);
    if found.written {
        failures.extend(failure("refused: outputs untouched", told()));
    }
    if found.message.is_empty() {
        failures.extend(failure("refused: a message", told()));
    }
    if !may_be_refused(case, found.status) {
        failures.extend(failure("refused without a reason", told()));
    }
    failures
}

/// Whether this status is one that the scene may have.
pub fn may_be_refused(case: &Case, status: i32) -> bool {
    let (effects, how) = (&case.effects, &case.how);
    match status {
        CONTACT_NORMAL_UNSUPPORTED => {
            let multigrid =
                [CONTACT_NORMAL_METHOD_MULTIGRID, CONTACT_NORMAL_METHOD_FULL_MULTIGRID].contains(&how.method);
            effects.is_unsupported_pair()
                || how.fixed.is_some() && effects.limit.is_some()
                || multigrid && effects.may_lack_multigrid()
                || how.method == CONTACT_NORMAL_METHOD_PROJECTED_CG && (effects.unsymmetric || effects.indefinite)
        }
        CONTACT_NORMAL_INFEASIBLE => is_infeasible(case),
        CONTACT_NORMAL_NOT_POSITIVE_DEFINITE => effects.indefinite || effects.unsymmetric,
        // Pressures below 0 are no guess, if the library says so.
        CONTACT_NORMAL_INVALID_ARGUMENT => how.given.as_ref().is_some_and(|given| given.iter().any(|&p| p < 0.0)),
        _ => false,
    }
}

/// A force that no pressures within the limit carry; an approach in full contact where the mean displacement is zero.
fn is_infeasible(case: &Case) -> bool {
    let finite = || (0..case.h.len()).filter(|&i| case.h[i].is_finite());
    match case.load {
        Load::Force(force) => case.effects.limit.as_ref().is_some_and(|limit| {
            let greatest = finite().map(|i| limit.at(i)).sum::<f64>() * case.grid.element_area();
            force > greatest * (1.0 - 1e-9)
        }),
        Load::Approach(approach) => {
            let mean = finite().map(|i| case.h[i]).sum::<f64>() / finite().count().max(1) as f64;
            case.effects.period == Some((true, true)) && approach >= mean - 1e-9 * mean.abs()
        }
    }
}
