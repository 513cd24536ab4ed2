//! The conditions of stick and slip and of contact, recomputed by the campaign's own products (`tangential`).
//!
//! The slip is `s = w + A q - u'`. For unlike bodies pressures also have tangential displacements, and tractions displacements along the normal. The
//! residual is the slip of a sticking element, and that of a slipping element without its part opposite to q.

use contact_normal::ffi::{CONTACT_NORMAL_MOTION_SHIFT, CONTACT_NORMAL_MOTION_STEADY_ROLLING};

use crate::friction_case::Case;
use crate::friction_found::{Before, Found};
use crate::tangential::{Operator, Vector};

/// Tractions of more than this part of the bound slip, by the library's documents.
pub const ON_THE_CIRCLE: f64 = 1.0 - 1e-7;

/// The least scale of lengths relative to the lengths whose difference they are, by the library's documentation.
const ROUND_OFF: f64 = 1.5e-8;

pub fn length(v: Vector) -> f64 {
    v[0].hypot(v[1])
}

/// The root mean square, without overflow or underflow.
fn rms(lengths: &[f64]) -> f64 {
    let largest = lengths.iter().copied().fold(0.0, f64::max);
    if !(largest > 0.0) {
        return largest;
    }
    largest * (lengths.iter().map(|l| (l / largest).powi(2)).sum::<f64>() / lengths.len() as f64).sqrt()
}

/// The residuals of the conditions of a call, and their scales.
pub struct Conditions {
    pub left: f64,
    pub scale: f64,
    pub rounding: f64,
    /// The largest difference between the slip of the library and that of the campaign.
    pub slip_error: f64,
    /// Displacements by tractions along the normal, and their possible round-off.
    pub along_normal: Vec<f64>,
    pub normal_rounding: f64,
}

/// Displacements of a step: by the present tractions, by the previous loads, and tangential ones by pressures.
struct Displacements {
    by_q: Vec<[f64; 3]>,
    before: Vec<Vector>,
    sideways: Vec<Vector>,
    rounding: f64,
    normal_rounding: f64,
}

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

/// The conditions of stick and slip.
pub fn conditions(case: &Case, found: &Found, before: &Before) -> Conditions {
    let slide = &case.slide;
    let is_steady = slide.motion == CONTACT_NORMAL_MOTION_STEADY_ROLLING;
    let d = displacements(case, found, before);
    let mut rounding = d.rounding;
    let (mut left, mut rigid, mut displaced, mut slip_error) = (Vec::new(), Vec::new(), Vec::new(), 0.0f64);
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
    let or_displacements = match slide.motion {
        CONTACT_NORMAL_MOTION_SHIFT => 1.0,
        CONTACT_NORMAL_MOTION_STEADY_ROLLING if slide.has_forces() => 1.0,
        // In slow rolling the scale is the round-off of the displacements.
        _ => ROUND_OFF,
    };
    // With given forces the creepages may cancel the rigid slip: its round-off is then the scale.
    let cancelled = if slide.has_forces() { ROUND_OFF * rms(&without_found) } else { 0.0 };
    let scale = rms(&rigid).max(or_displacements * rms(&displaced)).max(cancelled);
    let along_normal = d.by_q.iter().map(|u| u[2]).collect();
    Conditions { left: rms(&left), scale, rounding, slip_error, along_normal, normal_rounding: d.normal_rounding }
}

/// The largest contact area for which it is decided whether a problem is monotone.
const MOST: usize = 700;

/// Whether steady rolling is a monotone problem, which has a unique solution: `B + B'` on C is positive definite, by Cholesky's factors. It is not if
/// a step is shorter than elements that are long in its direction. Large contact areas count as monotone.
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
