//! Solves random scenes with adhesion through the C ABI, by one call or in two steps of a handle. Each result is checked with a product of the
//! campaign. If the library refuses a tensile force, the force must exceed the pull-off force that the library finds.

use std::ptr::null_mut;

use contact_normal::ffi::*;

use crate::adhesion_call::{ask, Asked, Found};
use crate::adhesion_case::{traction, Case};
use crate::call::{bare_scene, last_error};
use crate::effect_structs::effect_structs;
use crate::grid::Load;
use crate::half_space::compliance;
use crate::init::initialised;
use crate::operator::Operator;
use crate::random::Random;
use crate::verdict::Verdict;

/// Twice the tolerance of the library. The library's residuals are norms over all elements, and some of the checks here are for the worst element.
const TOLERANCE: f64 = 2e-6;

/// The scale of total pressures is at least this part of the contact pressures. Otherwise the scale would be round-off if contact pressures and
/// attraction cancel.
const CANCELLED: f64 = 1e-3;

/// The result of a case.
pub struct Run {
    pub case: Case,
    /// The statuses of its calls.
    pub statuses: Vec<i32>,
    pub verdict: Verdict,
    /// The work units of the first call, if it was OK.
    pub products: Option<f64>,
}

/// Makes a random case and solves it. Then solves it again, or in two steps of a handle, and checks all results.
pub fn run(random: &mut Random) -> Run {
    let case = Case::random(random);
    let mut verdict = Verdict::default();
    let found = ask(&case, case.load, &Asked::Solve);
    verdict.add(judge(&case, case.load, &found));
    let mut statuses = vec![found.status];
    let products = (found.status == CONTACT_NORMAL_OK).then_some(found.report.statistics.work_units);
    match case.step {
        Some(step) => verdict.add(with_handle(&case, step, &mut statuses)),
        None if case.grid.len() < 5000 => {
            let same = ask(&case, case.load, &Asked::Solve).bits() == found.bits();
            verdict.unless(same, "the same call twice has the same bits", || case.describe());
        }
        None => {}
    }
    if let (CONTACT_NORMAL_INFEASIBLE, Load::Force(force)) = (found.status, case.load) {
        verdict.add(is_too_much(&case, force, &found.message, &mut statuses));
    }
    Run { case, statuses, verdict, products }
}

/// Solves a case in two steps of a handle, and checks both. In the second step the approach changes by `step`.
fn with_handle(case: &Case, step: f64, statuses: &mut Vec<i32>) -> Verdict {
    let structs = effect_structs(&case.effects);
    let mut scene = bare_scene(&case.grid, &case.h, (case.shear_modulus, case.poisson_ratio), case.load);
    structs.point_from(&mut scene, &case.effects);
    let mut adhesion = initialised(contact_normal_adhesion_init);
    adhesion.work_of_adhesion = case.work.at(0);
    scene.adhesion = &adhesion;
    let mut handle = null_mut();
    // SAFETY: the scene has the arrays that it declares.
    let status = unsafe { contact_normal_solver_new(&scene, std::ptr::null(), &mut handle) };
    if status == CONTACT_NORMAL_INFEASIBLE && case.effects.period == Some((true, true)) {
        return Verdict::excused("two periods in full contact, by approach");
    }
    if status != CONTACT_NORMAL_OK {
        return Verdict::failed("a handle for adhesion", format!("{}: {}", case.describe(), last_error()));
    }
    let first = ask(case, case.load, &Asked::Handle(handle, false));
    let mut verdict = judge(case, case.load, &first).within("handle: ");
    statuses.push(first.status);
    if first.status == CONTACT_NORMAL_OK {
        let load = Load::Approach(first.report.normal.approach + step);
        let second = ask(case, load, &Asked::Handle(handle, true));
        verdict.add(judge(case, load, &second).within("a step: "));
        statuses.push(second.status);
        if second.status >= CONTACT_NORMAL_OK {
            verdict.add(stays(case, handle, &second));
        }
    }
    // SAFETY: made above.
    unsafe { contact_normal_solver_free(handle) };
    verdict
}

/// Checks that a refused solve leaves the last result in the handle, with its contact pressures.
fn stays(case: &Case, handle: *mut contact_normal_solver, last: &Found) -> Verdict {
    let structs = effect_structs(&case.effects);
    let mut scene = bare_scene(&case.grid, &case.h, (case.shear_modulus, case.poisson_ratio), Load::Force(f64::MAX));
    structs.point_from(&mut scene, &case.effects);
    let (mut p, mut q) = (vec![0.0; last.p.len()], vec![0.0; last.q.len()]);
    let mut fields = initialised(contact_normal_fields_init);
    (fields.pressure, fields.contact_pressure) = (p.as_mut_ptr(), q.as_mut_ptr());
    // SAFETY: a handle that no one else uses, and structs with the arrays that they declare.
    let statuses = unsafe {
        let refused =
            contact_normal_solver_solve(handle, &scene, std::ptr::null(), std::ptr::null_mut(), std::ptr::null_mut());
        [refused, contact_normal_solver_fields(handle, &mut fields)]
    };
    let mut verdict = Verdict::default();
    let is_refused = statuses[0] < 0 && statuses[1] == CONTACT_NORMAL_OK;
    verdict.unless(is_refused, "the largest force is refused", || format!("{}: {statuses:?}", case.describe()));
    verdict.unless(p == last.p && q == last.q, "a refused solve leaves the last result", || case.describe());
    verdict
}

/// Checks that a tensile force that the library refuses exceeds the pull-off force that the library finds.
fn is_too_much(case: &Case, force: f64, message: &str, statuses: &mut Vec<i32>) -> Verdict {
    let found = ask(case, Load::Force(0.0), &Asked::PullOff);
    statuses.push(found.status);
    if found.status != CONTACT_NORMAL_OK {
        return Verdict::excused("no pull-off force was found");
    }
    let mut verdict = judge(case, Load::Approach(found.report.normal.approach), &found).within("pull-off: ");
    let least = found.report.normal.force;
    verdict.unless(force < least * (1.0 - 1e-3), "a pull that is refused is more than the pull-off force", || {
        format!("{}: {least:e}; {message}", case.describe())
    });
    verdict
}

/// The verdict on a call by its status. A result with status OK is checked.
fn judge(case: &Case, load: Load, found: &Found) -> Verdict {
    match found.status {
        CONTACT_NORMAL_OK => certify(case, load, found),
        CONTACT_NORMAL_INFEASIBLE if matches!(load, Load::Force(force) if force < 0.0) => Verdict::default(),
        // In full contact, pressures do not change the mean distance.
        CONTACT_NORMAL_INFEASIBLE if case.effects.period == Some((true, true)) && matches!(load, Load::Approach(_)) => {
            Verdict::excused("two periods in full contact, by approach")
        }
        CONTACT_NORMAL_ITERATION_LIMIT | CONTACT_NORMAL_STAGNATED if case.kappa > 0.5 => {
            Verdict::excused("elements too coarse for the range: not solved")
        }
        status => Verdict::failed(
            "a scene with adhesion is solved",
            format!("{status}: {}: {}", case.describe(), found.message),
        ),
    }
}

/// Checks the conditions of contact with adhesion, with a product of the campaign.
fn certify(case: &Case, load: Load, found: &Found) -> Verdict {
    let c = compliance(case.shear_modulus, case.poisson_ratio);
    let operator = Operator::new(&case.grid, c, &case.effects);
    let u = operator.displace(&found.p);
    let (approach, range) = (found.report.normal.approach, found.report.adhesion.range);
    let self_influence = operator.diagonal();
    let largest = found.p.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
    let (mut inside, mut distances, mut outside, mut all, mut count, mut pressures) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    // The squares of `CANCELLED` times the contact pressures: the least scale of total pressures.
    let mut repulsive = 0.0;
    let (mut penetration, mut pulled): (f64, f64) = (0.0, 0.0);
    for (i, p) in found.p.iter().enumerate() {
        all += p * p;
        if case.h[i].is_infinite() {
            outside += p * p;
            continue;
        }
        let e = case.h[i] - approach + u[i];
        let q = p + traction(case, range, i, e);
        if found.contact[i] == 1 {
            (inside, distances, count) = (inside + e * e, distances + (case.h[i] - approach).powi(2), count + 1.0);
            (pressures, repulsive) = (pressures + p * p, repulsive + (CANCELLED * q).powi(2));
            pulled = pulled.max(-q);
        } else {
            outside += q * q;
            penetration = penetration.max(-e);
        }
    }
    let rounding = operator.rounding(&found.p) + 2.0 * f64::EPSILON * approach.abs();
    let n = f64::max(count, 1.0);
    let scale = (distances / n).sqrt().max(self_influence * (f64::max(pressures, repulsive) / n).sqrt());
    let scale = if count > 0.0 { scale } else { scale.max(self_influence * (all / found.p.len() as f64).sqrt()) };
    let ratio = |value: f64, of: f64| if value == 0.0 { 0.0 } else { value / of };
    // The library sets the attraction to 0 beyond 40 ranges.
    let (nothing, root) = (1e-16 * case.work.at(0) / range, (found.p.len() as f64).sqrt());
    let mut verdict = Verdict::default();
    for (what, value, most) in [
        ("e in contact", (inside / n).sqrt(), TOLERANCE * scale + rounding),
        ("-e outside", penetration, TOLERANCE * scale + rounding),
        (
            "the law outside",
            outside.sqrt(),
            TOLERANCE * f64::max(all, repulsive).sqrt() + (rounding / self_influence + nothing) * root,
        ),
        ("contact pressures", pulled, 1e-4 * largest + rounding / self_influence),
    ] {
        let details = || format!("{what} {:e}: {}", ratio(value, most), case.describe());
        verdict.unless(value <= most, "the conditions of adhesion hold", details);
    }
    if matches!(load, Load::Approach(_)) && count as usize == found.p.len() {
        verdict.add(mean_distance(case, approach, &operator, (distances / n).sqrt()));
    }
    verdict.add(forces(case, load, found));
    verdict
}

/// Checks the approach in full contact. If a uniform pressure causes no displacement, the approach is the mean of h, whatever the pressures are.
fn mean_distance(case: &Case, approach: f64, operator: &Operator, rms: f64) -> Verdict {
    let (mut verdict, n) = (Verdict::default(), case.h.len());
    let displaced = operator.displace(&vec![1.0; n]);
    if displaced.iter().all(|u| u.abs() <= 1e-9 * operator.diagonal()) {
        let mean = case.h.iter().map(|h| h - approach).sum::<f64>() / n as f64;
        let allowed = TOLERANCE * rms + 16.0 * f64::EPSILON * approach.abs();
        verdict.unless(mean.abs() <= allowed, "not all touch above the mean distance", || case.describe());
    }
    verdict
}

/// Checks that the pressures carry the prescribed force, and that tractions are within their bound.
fn forces(case: &Case, load: Load, found: &Found) -> Verdict {
    let mut verdict = Verdict::default();
    let area = case.grid.element_area();
    let (sum, size) = found.p.iter().fold((0.0, 0.0), |(sum, size), p| (sum + p * area, size + p.abs() * area));
    let size = f64::max(size, CANCELLED * found.report.adhesion.repulsive_force);
    // Bodies that are apart by many ranges attract each other by less than this force.
    let nothing = 1e-16 * case.work.at(0) / found.report.adhesion.range * area;
    if let Load::Force(force) = load {
        verdict.unless((sum - force).abs() <= TOLERANCE * size + nothing, "the force is carried", || {
            format!("{sum:e} for {force:e}: {}", case.describe())
        });
    }
    if let Some((mu, strength, _)) = case.friction {
        let worst = (0..found.q.len()).find(|&i| {
            let q = found.q[i];
            let bound = if q > 0.0 { mu * q + strength } else { 0.0 };
            found.tractions[0][i].hypot(found.tractions[1][i]) > bound * (1.0 + 1e-12)
        });
        verdict.unless(worst.is_none(), "tractions obey the bound of contact pressures", || case.describe());
    }
    verdict
}
