//! What holds for every answer, by an oracle that knows nothing of the library.

use contact_normal::ffi::*;

use crate::call::Outputs;
use crate::case::Case;
use crate::grid::Load;

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

/// The conditions of an answer, recomputed.
struct Measures {
    /// 2-norms over C of `h - approach + A p` and of `h - approach`.
    residual: f64,
    distance: f64,
    /// Elements in C.
    count: f64,
    /// rms of `h - approach` over C and the elements at their limit.
    rms: f64,
    /// Largest -e outside and e at a limit.
    violation: f64,
    /// `sum of p |e|` over C, and `sum of p |u|`.
    work: (f64, f64),
    /// What rounding may do to one e.
    rounding: f64,
    /// Largest difference between the displacements returned and A p, and between the distances returned and theirs.
    wrong_u: f64,
    wrong_e: f64,
}

impl Measures {
    fn of(case: &Case, found: &Outputs) -> Measures {
        let operator = case.operator();
        let u = operator.displace(&found.p);
        let approach = found.report.approach;
        let mut m = Measures {
            residual: 0.0,
            distance: 0.0,
            count: 0.0,
            rms: 0.0,
            violation: 0.0,
            work: (0.0, 0.0),
            rounding: 0.0,
            wrong_u: 0.0,
            wrong_e: 0.0,
        };
        let mut limited = (0.0, 0.0);
        let mut largest = approach.abs();
        for (i, &u) in u.iter().enumerate() {
            let (h, p) = (case.h[i], found.p[i]);
            m.wrong_u = m.wrong_u.max((u - found.u[i]).abs());
            largest = largest.max(u.abs());
            if h.is_infinite() {
                continue;
            }
            let e = h - approach + u;
            // Two sums of three numbers.
            let by_u = h - approach + found.u[i];
            let allowed = 4.0 * f64::EPSILON * (h.abs() + approach.abs() + u.abs());
            m.wrong_e = m.wrong_e.max((by_u - found.e[i]).abs() - allowed);
            m.work.1 += p * u.abs();
            match found.contact[i] {
                0 => m.violation = m.violation.max(-e),
                1 => {
                    m.residual += e * e;
                    m.distance += (h - approach).powi(2);
                    m.count += 1.0;
                    m.work.0 += p * e.abs();
                    largest = largest.max(h.abs());
                }
                _ => {
                    m.violation = m.violation.max(e);
                    limited = (limited.0 + (h - approach).powi(2), limited.1 + 1.0);
                    largest = largest.max(h.abs());
                }
            }
        }
        m.rms = ((m.distance + limited.0) / f64::max(m.count + limited.1, 1.0)).sqrt();
        (m.residual, m.distance) = (m.residual.sqrt(), m.distance.sqrt());
        m.rounding = operator.rounding(&found.p) + 8.0 * f64::EPSILON * largest;
        m
    }

    /// In one line.
    fn text(&self, found: &Outputs) -> String {
        let (status, cycles, work) = (found.status, found.report.cycles, found.report.work_units);
        let (residual, violation, rms) = (self.relative(), self.violation, self.rms);
        format!("status {status}, {cycles} cycles, {work:.1} units: residual {residual:.2e}, violation {violation:.2e} of {rms:.2e}")
    }

    /// The residual over C, in parts of the distance.
    fn relative(&self) -> f64 {
        if self.residual == 0.0 {
            0.0
        } else {
            self.residual / self.distance
        }
    }

    /// Whether the residual is within a tolerance.
    fn residual_holds(&self, tolerance: f64) -> bool {
        // The tolerance is a double, the norms are sums of n squares.
        self.residual <= tolerance * (1.0 + 1e-12) * self.distance + self.rounding * self.count.sqrt()
    }

    /// Whether the conditions hold but for what rounding may leave of each: then nobody can do better. With a prescribed force the
    /// approach is a mean over C, a sum of so many numbers. Measured over 60000 cases: what stagnates is within four of one e's rounding
    /// on small contact areas, within 13 of it on some thousand elements.
    fn holds_to_rounding(&self, case: &Case, found: &Outputs) -> bool {
        let (tolerance, rounding) = (case.how.tolerance, (10.0 + self.count.sqrt()) * self.rounding);
        let pressures = found.p.iter().sum::<f64>();
        let free = self.violation <= tolerance * self.rms + rounding
            && self.work.0 <= tolerance * self.work.1 + rounding * pressures;
        self.residual <= tolerance * self.distance + rounding * self.count.sqrt() && (case.how.fixed.is_some() || free)
    }
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
