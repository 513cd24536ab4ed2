//! How wrong an answer is: errors estimated from what coarser grids find.
//!
//! Let v be a value on the grid, v_a and v_b those that the same surface, sampled, has with elements a and b > a times as large. Where
//! the error is `v - v* = C d^q` in the size d of the elements,
//!
//! ```text
//! v_a - v = (a^q - 1) (v - v*),    (v_b - v)/(v_a - v) = (b^q - 1)/(a^q - 1)
//! ```
//!
//! the second gives the order q, the first the error (Richardson 1911; Roache 1998). For smooth bodies q is 2 in force, approach and
//! largest pressure, but each value jitters by how the rim of the contact area lies on the elements. So a and b are large
//! (4 and 8 or more: what the jitter does to v_a - v is small), and an order of 1.2 or more counts as 2. Where pressures are singular at an
//! edge, it is 1 at most. An order below 1/2, or none, is no convergence: the estimate is not trusted. Rough surfaces on which no grid
//! resolves the shortest waves are so in their largest pressure. That one may also miss a peak between the elements: [`missed_peak`].
//!
//! The contact area is estimated from its own outline ([`Outline`]): the correction is the error of counting, and a part of it
//! (measured: docs/accuracy.md) that of the corrected area.

use super::report::{Halving, Limit};
use crate::contact::{Outline, State};
use crate::methods::projected_cg::Sample;
use crate::progress::{DiscretisationError, LedgerRow};
use crate::scene::Load;

/// Orders from which on theory's own is taken, and below which nothing converges.
const CLEAN: f64 = 0.6;
const NO_ORDER: f64 = 0.5;
/// Part of the correction of the contact area by which it is off.
const CORRECTION_OFF: f64 = 0.3;
/// Seconds grow with this power of the number of elements (docs/performance.md).
pub const SECONDS_EXPONENT: f64 = 1.13;

/// q of `(b^q - 1)/(a^q - 1) = ratio`; none where it is not positive, at most 4.
fn order(ratio: f64, a: f64, b: f64) -> Option<f64> {
    let of = |q: f64| (b.powf(q) - 1.0) / (a.powf(q) - 1.0);
    let (mut low, mut high) = (1e-3, 4.0);
    if !(ratio > of(low)) {
        return None;
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        *(if of(middle) < ratio { &mut low } else { &mut high }) = middle;
    }
    Some(low)
}

/// The order to take, when differences `near` to the grid of elements a times as large and `far` to that of b (if there is one) are seen, and
/// theory's is `highest`. None: not to be trusted.
fn trusted_order(near: (f64, f64), far: Option<(f64, f64)>, highest: f64) -> Option<f64> {
    let Some((b, far)) = far else { return Some(highest) };
    let (a, near) = near;
    let seen = order(far / near, a, b)?;
    if seen >= CLEAN * highest {
        Some(highest)
    } else {
        Some(seen).filter(|q| *q >= NO_ORDER)
    }
}

/// The error of `value`, with its sign, and its order.
fn richardson(value: f64, near: (f64, f64), far: Option<(f64, f64)>, highest: f64) -> Option<(f64, f64)> {
    let difference = |(size, found): (f64, f64)| (size, found - value);
    let q = trusted_order(difference(near), far.map(difference), highest)?;
    let error = (near.1 - value) / (near.0.powf(q) - 1.0);
    error.is_finite().then_some((error, q))
}

/// Relative discretisation error that samples suggest for the force (or the approach) on the finest grid before that is solved.
pub fn predict(near: &Sample, far: &Sample) -> f64 {
    let error_near = (far.found - near.found) / ((far.size / near.size).powi(2) - 1.0);
    known((error_near / near.found).abs() / (near.size * near.size))
}

/// The same from the last two rows of a ledger: their step is 3/4 of the coarser one's error, which falls by 4 with every grid.
pub fn predict_from_ledger(rows: &[LedgerRow], load: Load) -> f64 {
    let [.., before, last] = rows else { return 0.0 };
    let (before, last) = (before.measures.found(load), last.measures.found(load));
    known(((before - last) / last).abs() / 12.0)
}

/// 0 for what is not known.
fn known(error: f64) -> f64 {
    if error.is_finite() {
        error
    } else {
        0.0
    }
}

/// Writes the errors of all rows, of which the last is that of `finest`; `samples`: of a, then b, or a alone, or none. What limits
/// the answer, and what the next finer grid would bring.
pub fn estimate(
    ledger: &mut [LedgerRow],
    finest: &State,
    outline: &Outline,
    samples: &[Sample],
    seconds: f64,
) -> (Limit, Halving) {
    let Some(last) = ledger.last().copied() else { return Default::default() };
    let (near, far) = (samples.first(), samples.get(1));
    let highest = if outline.edges > 0 { 1.0 } else { 2.0 };
    let measures = last.measures;
    let found = measures.found(finest.load);
    let of = |value: f64, part: fn(&Sample) -> f64| {
        near.and_then(|near| richardson(value, (near.size, part(near)), far.map(|far| (far.size, part(far))), highest))
    };
    let force = of(found, |sample| sample.found);
    let max_pressure = of(measures.max_pressure, |sample| sample.max_pressure);
    // The distance is an rms over the field; its order is at most 1, from the square root at the rim.
    let pressure = near.and_then(|near| {
        let q = trusted_order((near.size, near.distance), far.map(|far| (far.size, far.distance)), 1.0)?;
        Some((near.distance / (near.size.powf(q) - 1.0), q)).filter(|(error, _)| error.is_finite())
    });
    let untrusted = if near.is_some() { untrusted(force, max_pressure, pressure) } else { 0 };
    let (area, residual) = (measures.corrected_area, measures.certificate.residual);
    for row in ledger.iter_mut() {
        let row_size = (finest.grid.len() as f64 / (row.mx * row.my) as f64).sqrt();
        // From the extrapolated value, and what the last residual may hide of that
        let off = |value: f64, last: f64, estimate: Option<(f64, f64)>| match estimate {
            Some((error, _)) => (value - (last - error)).abs() + residual * last.abs(),
            None => -1.0,
        };
        let correction = (row.measures.contact_area - row.measures.corrected_area).abs();
        row.error = DiscretisationError {
            force: off(row.measures.found(finest.load), found, force),
            max_pressure: off(row.measures.max_pressure, measures.max_pressure, max_pressure),
            contact_area: (row.measures.contact_area - area).abs(),
            corrected_area: CORRECTION_OFF * correction,
            pressure: pressure.map_or(-1.0, |(error, q)| error * row_size.powf(q) + residual),
            untrusted,
        };
    }
    if let (Some(row), Some(_)) = (ledger.last_mut(), max_pressure) {
        row.error.max_pressure = row.error.max_pressure.max(missed_peak(finest, measures.max_pressure));
    }

    let Some((error, q)) = force else { return Default::default() };
    let hidden = residual * found.abs();
    let halved = error.abs() / 2.0_f64.powf(q);
    let halving = Halving { seconds: 4.0_f64.powf(SECONDS_EXPONENT) * seconds, force: halved + hidden };
    let limit = if error.abs() >= hidden { Limit::Grid } else { Limit::Tolerance };
    (limit, halving)
}

/// The bits of the errors that cannot be estimated; says so in the log.
fn untrusted(force: Option<(f64, f64)>, max_pressure: Option<(f64, f64)>, pressure: Option<(f64, f64)>) -> u32 {
    let mut untrusted = 0;
    for (estimate, bit, what) in [
        (force, DiscretisationError::FORCE, "force or approach"),
        (max_pressure, DiscretisationError::MAX_PRESSURE, "largest pressure"),
        (pressure, DiscretisationError::PRESSURE, "pressures"),
    ] {
        if estimate.is_none() {
            untrusted |= bit;
            log::info!("the error of the {what} cannot be estimated: coarser grids do not converge to it");
        }
    }
    untrusted
}

/// What the largest pressure may miss of a peak between the elements: half of the most, `(d^2 p)/8` of the second differences there.
/// Samples that happen to agree do not show it.
fn missed_peak(state: &State, max_pressure: f64) -> f64 {
    let (mx, my) = (state.grid.mx, state.grid.my);
    let Some(peak) = state.p.iter().position(|p| *p == max_pressure) else { return 0.0 };
    let (x, y) = (peak % mx, peak / mx);
    let beside = |lower: usize, upper: usize| 2.0 * state.p[peak] - state.p[lower] - state.p[upper];
    let along = if x > 0 && x + 1 < mx { beside(peak - 1, peak + 1) } else { 0.0 };
    let across = if y > 0 && y + 1 < my { beside(peak - mx, peak + mx) } else { 0.0 };
    (along + across) / 16.0
}

#[cfg(test)]
#[path = "../../tests/unit/estimates.rs"]
mod tests;
