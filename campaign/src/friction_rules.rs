//! Checks the promises of the library for every result with friction, of like and unlike bodies. Refusals and early stops need an accepted reason.

use contact_normal::ffi::*;

use crate::call::Outputs;
use crate::friction_case::Case;
use crate::friction_conditions::{conditions, is_monotone, length, Conditions, ON_THE_CIRCLE};
use crate::friction_found::{Before, Found};
use crate::friction_place::Place;
use crate::grid::Grid;
use crate::refused_force::exceeded;
use crate::rules;
use crate::tangential::Operator;
use crate::verdict::Verdict;

/// A verdict whose failures describe the case.
struct Broken<'a> {
    case: &'a Case,
    verdict: Verdict,
}

impl Broken<'_> {
    /// Adds a broken promise, unless it is `kept`.
    fn unless(&mut self, kept: bool, promise: &'static str, details: impl FnOnce() -> String) {
        let case = self.case;
        self.verdict.unless(kept, promise, || format!("{}: {}", case.describe(), details()));
    }
}

/// Checks a result. `before` has the loads before the step.
pub fn check(case: &Case, found: &Found, before: &Before) -> Verdict {
    let mut broken = Broken { case, verdict: Verdict::default() };
    let status = found.status;
    if status < 0 {
        broken.unless(!found.written, "friction refused leaves outputs alone", || format!("status {status}"));
        broken.unless(!found.message.is_empty(), "friction refused says why", || format!("status {status}"));
        let details = || format!("status {status}, {}", found.message);
        if status == CONTACT_NORMAL_INFEASIBLE && !case.carries_what_is_known() {
            let exceeded = exceeded(case);
            broken.unless(exceeded.is_none(), "a force is refused if no creepage carries more", || {
                format!("{:?} carry more, {}", exceeded, found.message)
            });
        }
        match (reason(case, status), case.normal_reason(status)) {
            (Some(why), _) | (_, Some(why)) => broken.verdict.excuse(why),
            _ => broken.unless(false, "friction is refused for a reason", details),
        }
        return broken.verdict;
    }
    check_bounds(case, found, &mut broken);
    let conditions = conditions(case, found, before);
    check_slip(found, &conditions, &mut broken);
    check_contact(found, &conditions, &mut broken);
    if status > 0 && broken.verdict.failures.is_empty() {
        check_stop(found, &conditions, &mut broken);
    }
    broken.verdict
}

/// The reason for which friction may be refused with this status.
fn reason(case: &Case, status: i32) -> Option<&'static str> {
    if status == CONTACT_NORMAL_INFEASIBLE {
        return case.may_be_infeasible();
    }
    if status == CONTACT_NORMAL_INVALID_ARGUMENT && case.step_is_too_short() {
        return Some("refused: a step of steady rolling of less than a tenth of an element");
    }
    None
}

/// Checks the tangential problem of a result with a status >= 0. `certified`: the campaign has the coefficients and the slip of the call, so that the
/// conditions of stick and slip are checked as well.
pub fn answer(case: &Case, found: &Found, certified: bool) -> Verdict {
    let mut broken = Broken { case, verdict: Verdict::default() };
    let carried = check_bounds(case, found, &mut broken);
    if certified && carried > 0.0 {
        let conditions = conditions(case, found, &case.before(&found.p));
        check_slip(found, &conditions, &mut broken);
    }
    broken.verdict
}

/// Checks that values are finite, that tractions are within their bounds, that stick_slip belongs to the tractions, and the forces. Returns mu N.
fn check_bounds(case: &Case, found: &Found, broken: &mut Broken<'_>) -> f64 {
    let (status, slide) = (found.status, &case.slide);
    let report = &found.report;
    let vectors_of_report =
        report.tangential.force.iter().chain(&report.tangential.creepage).chain(&report.tangential.sensitivities);
    let numbers = found.p.iter().chain(found.q.iter().chain(&found.slip).flatten());
    let numbers = numbers.chain(vectors_of_report).chain([
        &report.tangential.moment,
        &report.tangential.residual,
        &report.tangential.gap,
    ]);
    broken.unless(numbers.copied().all(f64::is_finite), "friction returns numbers", || format!("status {status}"));
    let area = case.place.grid.element_area();
    let (mut carried, mut sum) = (0.0, [0.0; 2]);
    for i in 0..found.q.len() {
        // On a fixed area pressures may be negative. Then the bound is 0.
        let (q, bound) = (found.q[i], slide.mu[i] * found.p[i].max(0.0));
        // This also requires tractions of 0 where mu p is 0 or underflows.
        broken.unless(length(q) <= bound, "|q| <= mu p to the last bit", || {
            format!("element {i}: {q:?}, bound {bound:e}, status {status}")
        });
        let stick_slip = found.stick_slip[i];
        let expected = match found.p[i] > 0.0 {
            false => CONTACT_NORMAL_STICK_SLIP_EXTERIOR,
            true if length(q) >= bound * ON_THE_CIRCLE => CONTACT_NORMAL_STICK_SLIP_SLIP,
            true => CONTACT_NORMAL_STICK_SLIP_STICK,
        };
        let at_edge = (length(q) - bound * ON_THE_CIRCLE).abs() <= 4.0 * f64::EPSILON * bound;
        broken.unless(
            stick_slip == expected || at_edge && stick_slip > 0,
            "stick_slip is that of the tractions",
            || format!("element {i}: {stick_slip} for {expected}, {q:?}, bound {bound:e}, status {status}"),
        );
        carried += bound * area;
        sum = [0, 1].map(|k: usize| sum[k] + q[k] * area);
    }
    for (k, sum) in sum.into_iter().enumerate() {
        let reported = found.report.tangential.force[k];
        broken.unless((reported - sum).abs() <= 1e-12 * carried, "the force is the sum of tractions", || {
            format!("{reported:e} for {sum:e}, status {status}")
        });
        if status == CONTACT_NORMAL_OK && slide.prescribed[k] == CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE {
            let given = slide.amount[k];
            broken.unless((sum - given).abs() <= 1.001 * case.stop.tolerance * carried, "forces are met", || {
                format!("{sum:e} for {given:e}, {carried:e} carried")
            });
        }
    }
    carried
}

/// Checks the conditions of stick and slip, if the status is OK.
fn check_slip(found: &Found, conditions: &Conditions, broken: &mut Broken<'_>) {
    let Conditions { left, scale, rounding, slip_error, .. } = *conditions;
    if found.status != CONTACT_NORMAL_OK {
        return;
    }
    let allowed = broken.case.stop.tolerance * scale;
    broken.unless(
        left <= 1.000001 * allowed + rounding,
        "OK: what is left of the slip is within the tolerance",
        || {
            let reported = found.report.tangential.residual;
            format!("{left:e} left of {scale:e}, rounding {rounding:e}, reported {reported:e}")
        },
    );
    broken.unless(slip_error <= rounding, "the slip is w + A q - u'", || format!("{slip_error:e}, {rounding:e}"));
}

/// Checks the conditions of contact, with the displacements along the normal by tractions.
fn check_contact(found: &Found, conditions: &Conditions, broken: &mut Broken<'_>) {
    let case = broken.case;
    let normal = case.place.normal(&case.stop, &conditions.along_normal, conditions.normal_rounding);
    let outputs = outputs(found);
    // If the alternation between the normal and the tangential problem of unlike bodies does not converge, the pressures belong to the tractions of
    // the iteration before.
    let failures = match found.status == CONTACT_NORMAL_OK || case.place.is_alike() {
        true => rules::is_true(&normal, &outputs),
        false => rules::is_admissible(&normal, &outputs),
    };
    for failure in failures {
        broken.unless(false, failure.promise, || failure.details);
    }
}

/// The results of the normal problem.
fn outputs(found: &Found) -> Outputs {
    let Found { status, message, p, u, e, contact, report, overrun, written, .. } = found;
    Outputs {
        status: *status,
        message: message.clone(),
        p: p.clone(),
        u: u.clone(),
        e: e.clone(),
        contact: contact.clone(),
        report: *report,
        overrun: *overrun,
        written: *written,
    }
}

/// Checks that there is an accepted reason for a status > 0.
fn check_stop(found: &Found, conditions: &Conditions, broken: &mut Broken<'_>) {
    let (case, status) = (broken.case, found.status);
    let Conditions { left, scale, rounding, ref along_normal, normal_rounding, .. } = *conditions;
    let is_steady = case.slide.motion == CONTACT_NORMAL_MOTION_STEADY_ROLLING;
    let normal = case.place.normal(&case.stop, along_normal, normal_rounding);
    let why = match status {
        CONTACT_NORMAL_CANCELLED => Some("friction: cancelled by the callback"),
        _ if !case.stop.is_unhindered() => Some("friction: stopped within few cycles"),
        _ if case.stop.tolerance * scale <= 10.0 * rounding => Some("friction: a tolerance below ten times round-off"),
        _ if is_steady && !is_monotone(case, found) => Some("friction: steady rolling that is not monotone"),
        _ if !case.place.is_alike() && case.has_much_friction() => Some("friction: unlike bodies, mu > 1"),
        _ if !case.place.is_alike() && nearly_slips(case, found) => {
            Some("friction: unlike bodies by 0.999 of what they carry at the end, or more")
        }
        _ if rules::is_at_rounding(&normal, &outputs(found)) => {
            Some("friction: the normal problem is left to round-off")
        }
        _ => None,
    };
    match why {
        Some(why) => broken.verdict.excuse(why),
        None => broken.unless(false, "friction is solved", || {
            let message = &found.message;
            format!("status {status}, {left:e} left of {scale:e}, rounding {rounding:e}: {message}")
        }),
    }
}

/// Whether the given forces are nearly those of full slip with the last pressures. The alternation between the normal and the tangential problem may
/// then switch between pressures that carry the forces and pressures that do not.
fn nearly_slips(case: &Case, found: &Found) -> bool {
    let carried: f64 = case.slide.mu.iter().zip(&found.p).map(|(mu, p)| mu * p.max(0.0)).sum();
    case.slide.force() >= (1.0 - 1e-3) * carried * case.place.grid.element_area()
}

/// The tables xx, yy and xy of the half-spaces of a place, at the offsets `-mx..mx` by `-my..my`.
pub fn tables(place: &Place) -> Vec<Vec<f64>> {
    let Grid { mx, my, .. } = place.grid;
    let wider = Grid { mx: mx + 1, my: my + 1, ..place.grid };
    let operator = Operator::new(&Place::new(wider, place.shear_modulus, place.poisson_ratio), [0.0; 2]);
    let offsets = || (0..2 * my).flat_map(|y| (0..2 * mx).map(move |x| y * (2 * mx + 1) + x));
    (0..3).map(|k| offsets().map(|at| operator.table[at][k]).collect()).collect()
}
