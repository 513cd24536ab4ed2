//! Friction: random motions and forces, with the conditions of stick and slip recomputed by direct sums (`friction_conditions`).
//!
//! Every case of like bodies has to be solved but those of steady rolling that are not monotone, whose solution may be none or many.

use contact_normal::ffi::*;

use crate::friction_call::{call, frictionless};
use crate::friction_case::{Case, Place};
use crate::friction_conditions::{conditions, is_monotone, length, Conditions, Operator, Vector, ON_THE_CIRCLE};
use crate::friction_found::Found;
use crate::grid::Grid;
use crate::random::Random;
use crate::verdict::Failure;

/// A list of what was not kept.
struct Broken<'a> {
    case: &'a Case,
    failures: Vec<Failure>,
}

impl Broken<'_> {
    fn unless(&mut self, kept: bool, promise: &'static str, details: impl FnOnce() -> String) {
        if !kept {
            let details = format!("{}: {}", self.case.describe(), details());
            self.failures.push(Failure { promise, details });
        }
    }
}

/// One answer. `before`: the tractions before the step.
fn check_answer(case: &Case, found: &Found, before: &[Vector], broken: &mut Broken<'_>) {
    let status = found.status;
    if status < 0 {
        broken.unless(!found.written, "friction refused leaves outputs alone", || format!("status {status}"));
        broken.unless(!found.message.is_empty(), "friction refused says why", || format!("status {status}"));
        let reason = status == CONTACT_NORMAL_INFEASIBLE && case.may_be_infeasible();
        broken.unless(reason, "friction is refused for a reason", || format!("status {status}, {}", found.message));
        return;
    }
    if check_bounds(case, found, broken) > 0.0 && case.place.is_alike() {
        check_conditions(case, found, before, broken);
    }
}

/// Numbers, tractions within their bounds, stick and slip, and the forces; returns mu N.
fn check_bounds(case: &Case, found: &Found, broken: &mut Broken<'_>) -> f64 {
    let (status, slide) = (found.status, &case.slide);
    let report = &found.report;
    let of_report = report.tangential_force.iter().chain(&report.creepage).chain(&report.sensitivities);
    let numbers = found.p.iter().chain(found.q.iter().chain(&found.slip).flatten());
    let numbers = numbers.chain(of_report).chain([&report.tangential_moment, &report.tangential_residual]);
    broken.unless(numbers.copied().all(f64::is_finite), "friction returns numbers", || format!("status {status}"));
    let area = case.place.grid.element_area();
    let (mut carried, mut sum) = (0.0, [0.0; 2]);
    for i in 0..found.q.len() {
        // Within an area that is fixed some elements may pull.
        let (q, bound) = (found.q[i], slide.mu[i] * found.p[i].max(0.0));
        // mu p of 0 and of numbers below the smallest have tractions of 0.
        broken.unless(length(q) <= bound, "|q| <= mu p to the last bit", || {
            format!("element {i}: {q:?}, bound {bound:e}, status {status}")
        });
        let adhesion = found.adhesion[i];
        let expected = match found.p[i] > 0.0 {
            false => CONTACT_NORMAL_ADHESION_EXTERIOR,
            true if length(q) >= bound * ON_THE_CIRCLE => CONTACT_NORMAL_ADHESION_SLIP,
            true => CONTACT_NORMAL_ADHESION_STICK,
        };
        let at_edge = (length(q) - bound * ON_THE_CIRCLE).abs() <= 4.0 * f64::EPSILON * bound;
        broken.unless(adhesion == expected || at_edge && adhesion > 0, "adhesion is that of the tractions", || {
            format!("element {i}: {adhesion} for {expected}, {q:?}, bound {bound:e}, status {status}")
        });
        carried += bound * area;
        sum = [0, 1].map(|k| sum[k] + q[k] * area);
    }
    for (k, sum) in sum.into_iter().enumerate() {
        let reported = found.report.tangential_force[k];
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

fn check_conditions(case: &Case, found: &Found, before: &[Vector], broken: &mut Broken<'_>) {
    let Conditions { left, scale, rounding, slip_error } = conditions(case, found, before);
    let (status, allowed) = (found.status, case.stop.tolerance * scale);
    if status == CONTACT_NORMAL_OK {
        broken.unless(
            left <= 1.000001 * allowed + rounding,
            "OK: what is left of the slip is within the tolerance",
            || {
                format!(
                    "{left:e} left of {scale:e}, rounding {rounding:e}, reported {:e}",
                    found.report.tangential_residual
                )
            },
        );
        broken.unless(slip_error <= rounding, "the slip is w + A q - u'", || format!("{slip_error:e}, {rounding:e}"));
    } else if case.stop.is_unhindered() && allowed > 10.0 * rounding {
        let is_steady = case.slide.motion == CONTACT_NORMAL_MOTION_STEADY_ROLLING;
        broken.unless(is_steady && !is_monotone(case, found), "friction of like bodies is solved", || {
            format!("status {status}, {left:e} left of {scale:e}, rounding {rounding:e}: {}", found.message)
        });
    }
}

/// What does not hold of an answer with status >= 0. `certified`: the coefficients and the slip are those that this module knows.
pub fn answer(case: &Case, found: &Found, certified: bool) -> Vec<Failure> {
    let mut broken = Broken { case, failures: Vec::new() };
    let carried = check_bounds(case, found, &mut broken);
    if certified && case.place.is_alike() && carried > 0.0 {
        check_conditions(case, found, &case.slide.before(), &mut broken);
    }
    broken.failures
}

/// Own tables xx, yy and xy over the offsets `-mx..mx` by `-my..my` of a place.
pub fn tables(place: &Place) -> Vec<Vec<f64>> {
    let Grid { mx, my, .. } = place.grid;
    let wider = Grid { mx: mx + 1, my: my + 1, ..place.grid };
    let operator = Operator::new(&Place::new(wider, place.shear_modulus, place.poisson_ratio), [0.0; 2]);
    let offsets = || (0..2 * my).flat_map(|y| (0..2 * mx).map(move |x| y * (2 * mx + 1) + x));
    (0..3).map(|k| offsets().map(|at| operator.table[at][k]).collect()).collect()
}

/// A random case: the statuses of its calls, and what was not kept.
pub fn check(random: &mut Random) -> (Case, Vec<i32>, Vec<Failure>) {
    let place = Place::random(random);
    let without = frictionless(&place, &crate::friction_case::Stop::unhindered(random));
    let mut case = Case::random(random, place, &without);
    let twice = random.chance(0.25);
    case.slide.sensitivities = random.chance(0.2);
    let mut broken = Broken { case: &case, failures: Vec::new() };
    let found = call(&case, twice);
    let before = case.slide.before();
    check_answer(&case, &found[0], &before, &mut broken);
    if let [first, second] = &found[..] {
        // From the tractions that the handle holds, where both calls came to an end.
        if first.status == CONTACT_NORMAL_OK {
            check_answer(&case, second, &first.q, &mut broken);
        }
    } else {
        let again = call(&case, false);
        let same = again[0].bits() == found[0].bits();
        broken.unless(same, "the same call with friction twice has the same bits", String::new);
    }
    if case.place.is_alike() && case.stop.cancel_at.is_none() && found[0].status >= 0 {
        let alone = frictionless(&case.place, &case.stop);
        let same = alone.p.iter().zip(&found[0].p).all(|(a, b)| a.to_bits() == b.to_bits());
        broken.unless(same, "friction of like bodies leaves the pressures alone", || format!("{}", found[0].status));
    }
    let failures = broken.failures;
    let statuses = found.iter().map(|found| found.status).collect();
    (case, statuses, failures)
}
