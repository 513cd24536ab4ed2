//! The residuals of the conditions of stick and slip, recomputed with products of the campaign (`tangential`).
//!
//! The slip is `s = w + A q - u'`, with the rigid slip w and the displacements u' before the step. Between unlike bodies pressures also cause
//! tangential displacements, and tractions normal ones. The residual of a sticking element is its slip. That of a slipping element is its slip
//! without the part that is opposite to q.

use contact_normal::ffi::{CONTACT_NORMAL_MOTION_SHIFT, CONTACT_NORMAL_MOTION_STEADY_ROLLING};

use crate::friction_case::Case;
use crate::friction_found::{Before, Found};
use crate::tangential::{Operator, Vector};

/// An element slips if its traction is at least this part of its bound, by the library's documentation.
pub const ON_THE_CIRCLE: f64 = 1.0 - 1e-7;

/// The least scale of slips, relative to the displacements or rigid slips whose difference they are, by the library's documentation.
const ROUND_OFF: f64 = 1.5e-8;

/// The length of a vector.
pub fn length(v: Vector) -> f64 {
    v[0].hypot(v[1])
}

/// The root mean square of lengths, without overflow or underflow.
fn rms(lengths: &[f64]) -> f64 {
    let largest = lengths.iter().copied().fold(0.0, f64::max);
    if !(largest > 0.0) {
        return largest;
    }
    largest * (lengths.iter().map(|l| (l / largest).powi(2)).sum::<f64>() / lengths.len() as f64).sqrt()
}

/// The residual of the conditions of a result, its scale, and its round-off.
pub struct Conditions {
    /// The rms of the residuals of the elements in contact whose bound is not 0.
    pub left: f64,
    /// The scale of the residual.
    pub scale: f64,
    /// The possible round-off of the slip of an element.
    pub rounding: f64,
    /// The largest difference between the slip of the library and that of the campaign.
    pub slip_error: f64,
    /// The displacements along the normal by tractions.
    pub along_normal: Vec<f64>,
    /// The possible round-off of these displacements.
    pub normal_rounding: f64,
}

/// The displacements of a step.
struct Displacements {
    /// The displacements in x, in y and along the normal by the present tractions.
    by_q: Vec<[f64; 3]>,
    /// The tangential displacements before the step by tractions, at the positions of the particles before the step.
    before: Vec<Vector>,
    /// The change of the tangential displacements by pressures.
    sideways: Vec<Vector>,
    /// The possible round-off of the tangential displacements.
    rounding: f64,
    /// The possible round-off of the normal displacements by tractions.
    normal_rounding: f64,
}

/// Computes the displacements of a step. `before` has the loads before it.
fn displacements(case: &Case, found: &Found, before: &Before) -> Displacements {
    let step = case.slide.step(&case.place.grid);
    let is_steady = case.slide.motion == CONTACT_NORMAL_MOTION_STEADY_ROLLING;
    let here = Operator::new(&case.place, [0.0; 2]);
    let elsewhere = (step != [0.0; 2]).then(|| Operator::new(&case.place, step));
    let there = elsewhere.as_ref().unwrap_or(&here);
    let (q, p) = if is_steady { (&found.q, &found.p) } else { (&before.q, &before.p) };
    let lengths = |q: &[Vector]| q.iter().map(|q| length(*q)).collect::<Vec<_>>();
    let (now, then) = (lengths(&found.q), lengths(q));
    let normal_rounding = if here.couples() { here.rounding(now.iter().copied()) } else { 0.0 };
    let mut rounding = here.rounding(now.into_iter()) + there.rounding(then.into_iter());
    let mut sideways = here.by_pressures(&found.p);
    if here.couples() {
        rounding += here.rounding(found.p.iter().copied()) + there.rounding(p.iter().copied());
        let earlier = there.by_pressures(p);
        sideways.iter_mut().zip(earlier).for_each(|(u, before)| *u = [u[0] - before[0], u[1] - before[1]]);
    }
    let before = there.by_tractions(q).into_iter().map(|[x, y, _]| [x, y]).collect();
    Displacements { by_q: here.by_tractions(&found.q), before, sideways, rounding, normal_rounding }
}

/// Computes the residual of the conditions of stick and slip. `before` has the loads before the step.
pub fn conditions(case: &Case, found: &Found, before: &Before) -> Conditions {
    let slide = &case.slide;
    let is_steady = slide.motion == CONTACT_NORMAL_MOTION_STEADY_ROLLING;
    let d = displacements(case, found, before);
    let mut rounding = d.rounding;
    let (mut left, mut rigid, mut displaced, mut slip_error) = (Vec::new(), Vec::new(), Vec::new(), 0.0f64);
    // Rigid slips without the creepages that the library found for given forces.
    let (mut without_found, creepage) = (Vec::new(), found.report.tangential.creepage);
    let given = [0, 1].map(|k| if slide.is_force(k) { 0.0 } else { creepage[k] });
    for i in 0..found.q.len() {
        let (q, bound) = (found.q[i], slide.mu[i] * found.p[i]);
        if !(found.p[i] > 0.0) {
            continue;
        }
        let (rigid_slip, largest) = slide.rigid_slip(&case.place.grid, i, creepage);
        let w = [0, 1].map(|k: usize| rigid_slip[k] + d.sideways[i][k]);
        rounding = rounding.max(8.0 * f64::EPSILON * largest + d.rounding);
        let s = [0, 1].map(|k: usize| w[k] + d.by_q[i][k] - d.before[i][k]);
        slip_error = slip_error.max(length([0, 1].map(|k: usize| s[k] - found.slip[i][k])));
        if !(bound > 0.0) {
            continue;
        }
        let mut rest = s;
        if length(q) >= bound * ON_THE_CIRCLE {
            let outward = q.map(|value| value / length(q));
            let along = (s[0] * outward[0] + s[1] * outward[1]).min(0.0);
            rest = [0, 1].map(|k: usize| s[k] - along * outward[k]);
        }
        left.push(length(rest));
        rigid.push(length(w));
        let (given_slip, _) = slide.rigid_slip(&case.place.grid, i, given);
        without_found.push(length([0, 1].map(|k: usize| given_slip[k] + d.sideways[i][k])));
        let step = [0, 1].map(|k: usize| d.by_q[i][k] - if is_steady { d.before[i][k] } else { 0.0 });
        displaced.push(length(step));
    }
    // The part of the displacements that the scale is at least.
    let part_of_displacements = match slide.motion {
        CONTACT_NORMAL_MOTION_SHIFT => 1.0,
        CONTACT_NORMAL_MOTION_STEADY_ROLLING if slide.has_forces() => 1.0,
        // In slow rolling the rigid slip may be smaller than the round-off of the displacements.
        _ => ROUND_OFF,
    };
    // With given forces the creepages may cancel the rigid slip. The scale is then its round-off.
    let cancelled = if slide.has_forces() { ROUND_OFF * rms(&without_found) } else { 0.0 };
    let scale = rms(&rigid).max(part_of_displacements * rms(&displaced)).max(cancelled);
    let along_normal = d.by_q.iter().map(|u| u[2]).collect();
    Conditions { left: rms(&left), scale, rounding, slip_error, along_normal, normal_rounding: d.normal_rounding }
}

/// The largest number of elements in contact for which [`is_monotone`] computes the factors.
const MOST: usize = 700;

/// Whether steady rolling is a monotone problem, which has a unique solution. With the matrix B of the displacements of a step by tractions on C,
/// this holds if `B + B^T` is positive definite, so that Cholesky's factors exist. It does not hold if a step is shorter than elements that are long
/// in its direction. Larger contact areas than [`MOST`] count as monotone.
pub fn is_monotone(case: &Case, found: &Found) -> bool {
    let contact: Vec<usize> = (0..found.q.len()).filter(|&i| case.slide.mu[i] * found.p[i] > 0.0).collect();
    if contact.len() > MOST {
        return true;
    }
    let step = case.slide.step(&case.place.grid);
    let (here, there) = (Operator::new(&case.place, [0.0; 2]), Operator::new(&case.place, step));
    let n = 2 * contact.len();
    let entry = |row: usize, column: usize| {
        let [here, there] = [&here, &there].map(|operator| operator.between(contact[row / 2], contact[column / 2]));
        let k = if row % 2 == column % 2 { row % 2 } else { 2 };
        here[k] - there[k]
    };
    let mut factor = vec![0.0; n * n];
    for row in 0..n {
        for column in 0..=row {
            let (of_row, of_column) = (&factor[row * n..][..column], &factor[column * n..][..column]);
            let rest =
                entry(row, column) + entry(column, row) - of_row.iter().zip(of_column).map(|(a, b)| a * b).sum::<f64>();
            if row == column && !(rest > 0.0) {
                return false;
            }
            factor[row * n + column] = if row == column { rest.sqrt() } else { rest / factor[column * n + column] };
        }
    }
    true
}
