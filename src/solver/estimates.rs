//! Estimated errors of a solution, from one grid.
//!
//! *Force and approach.* The displacement at centres by constant pressures on elements differs from that by smooth pressures by
//! `(1/24)(dx^2 u_xx + dy^2 u_yy)` (each element is a mean over itself), and in contact `u = approach - h`. A change of h changes the approach by
//! its mean with weights q, the pressures of a flat punch of force 1 on the same contact area (Betti). At the boundary of contact, where
//! pressures fall to 0 as a square root, half of this cancels:
//!
//! ```text
//! approach* - approach = s b,    F - F* = S s b,    b = mean with q of (dx^2 h_xx + dy^2 h_yy)/24 over C,    S = dF/d(approach)
//! ```
//!
//! with s = 1/2, measured. On 32 elements across s varies by a third, because the boundary lies anywhere in its elements. Along a straight outline
//! errors do not average out and are up to a few times larger. ([`Curvature`] computes b; docs/accuracy.md has the measurements.)
//!
//! At ends of the surface pressures are infinite, and the end lies anywhere between two centres ([`pressures_at_ends`]). A jump of the surface also
//! lies anywhere between two centres ([`Curvature::jumps`]). Both errors are of first order in the size of the elements. Pressures are also infinite
//! where coefficients jump, between patches or in a layer. Such a jump counts as a part of an end.
//!
//! *Pressures.* Their errors are fractions of the second differences within the contact area and across its boundary:
//! [`PEAK_ERROR`] for the largest pressure, [`PRESSURES_ERROR`] in the rms. A peak with a large relative second
//! difference is singular or not resolved. It has no estimate.
//!
//! *The contact area* is estimated from its outline ([`Outline`]). The correction is the error of counting. A fraction of the correction is the error
//! of the corrected area. Straight pieces and straight ends of the surface have an error of half an element. Ends in steps have the square root of
//! their number.

mod areas;
mod curvature;
mod ends;
mod jumps;
mod kink;

use areas::{correction_off, outline_off};
pub use curvature::Curvature;
pub use ends::{at_ends, beyond_ends, pressures_at_ends};
pub use jumps::at_jumps;

use super::falling::Falling;
use super::report::{Halving, Limit};
use super::seconds::GROWTH;
use crate::contact::{Outline, Problem, State};
use crate::grid::doubling;
use crate::progress::{DiscretisationError, LedgerRow};
use crate::scene::Load;

/// s: the error of approaches over the bend, in the mean, and as a bound for most.
const MEAN_ERROR: f64 = 0.5;
const ERROR_BOUND: f64 = 0.58;
/// The error for straight outlines, in `pressure/E*` (a Hertz contact has a bend of `(pi/32) sides d/N` of its mean pressure over E*; along straight
/// lines twice as much). The chord for the error of few elements: `(chord/2.5)^-2`, times the scatter, because among many spots of contact the
/// sharpest carry most.
const STRAIGHT_ERROR: f64 = 0.2;
const SHORT_CHORD: f64 = 2.5;
/// Factor on the error from single runs of elements instead of the mean chord: with it no map with spikes of one element misses its target.
const RUNS_FACTOR: f64 = 0.5;
/// Error of forces over the uncertainty of a jump: 98 of 100 have less, wherever the jump lies.
const JUMPS_FACTOR: f64 = 0.6;
/// Pressure at ends of the surface over the peak above which the peak has no estimate: pressures at ends are singular and grow as the square root of
/// the number of elements. With a quarter, the peak remains the largest pressure for the three doublings that a search predicts.
const PEAK_OVER_ENDS: f64 = 0.25;
/// Shortest chord with an estimate, in elements. Below it, contact is on single elements.
pub(super) const LEAST_CHORD: f64 = 1.5;
/// Relative error of a direction of one element without a period.
const ONE_ELEMENT: f64 = 0.26;
/// Error over second differences of the pressures, of the largest and in the rms; and the relative differences of a singular and a sharp peak.
const PEAK_ERROR: f64 = 0.1;
const PRESSURES_ERROR: f64 = 0.25;
const SINGULAR_PEAK: f64 = 0.18;
const SHARP_PEAK: f64 = 0.08;

/// Errors of the force (or the approach) on a grid, positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Parts {
    /// The error by the bend: of second order in the size of the elements.
    pub smooth: f64,
    /// The error by the bend at short chords: of fourth order.
    pub short: f64,
    /// The error by ends of the surface and jumps of the coefficients: of first order.
    pub ends: f64,
    /// The error by jumps of the surface: of first order.
    pub jumps: f64,
    /// dF/d(approach).
    pub stiffness: f64,
    /// The factor on errors of the approach.
    by: f64,
    /// The largest pressure beside a border, a hole, or a jump of the coefficients or of h.
    pub highest_at_ends: f64,
    /// The mean of `smooth`, with its sign.
    likely: f64,
}

impl Parts {
    /// The errors of a state; none if contact is on single elements.
    pub fn of(problem: &Problem, state: &State, curvature: &Curvature, outline: &Outline) -> Option<Parts> {
        let count = state.contact_count();
        let repeats = problem.coefficients.repeats(&state.grid);
        let chord = outline.chord(count, repeats);
        if count == 0 || chord < LEAST_CHORD {
            return None;
        }
        let force = state.force();
        // The mean displacement of full contact with two periods is 0. The computed one is round-off, and dF/d(approach) would be arbitrary. With a
        // given force no error depends on it.
        let is_full = repeats == (true, true) && count == state.grid.len();
        let stiffness = match state.load {
            Load::Force(_) if is_full => 0.0,
            _ => stiffness(problem, force, curvature.displaced, count as f64 * state.grid.element_area()),
        };
        // Errors of the approach determine the errors of all quantities.
        let (by, sign, found) = match state.load {
            Load::Force(_) => (1.0, -1.0, curvature.depth),
            Load::Approach(_) => (stiffness, 1.0, force),
        };
        let pressure = force / (count as f64 * state.grid.element_area());
        let along_lines =
            STRAIGHT_ERROR * pressure / problem.modulus() * outline.straight_length(&state.grid) / count as f64;
        // For many spots of contact the error depends on the chord of the sharpest, not on the mean chord.
        let of_runs = (curvature.bend.abs() / (chord * chord)).max(RUNS_FACTOR * curvature.short);
        let short = ERROR_BOUND * by * outline.scatter(count, repeats) * SHORT_CHORD * SHORT_CHORD * of_runs;
        let smooth = ERROR_BOUND * by * (curvature.bend.abs() + along_lines);
        let (ends, highest) = ends(problem, state, outline);
        let highest_at_ends = highest.max(curvature.highest_at_jumps);
        let ends = by * ends + one_element(problem, state) * found.abs();
        let jumps = if problem.exact_jumps { 0.0 } else { JUMPS_FACTOR * by * curvature.jumps / count as f64 };
        let likely = sign * MEAN_ERROR * by * curvature.bend;
        let parts = Parts { smooth, short, ends, jumps, stiffness, by, highest_at_ends, likely };
        (parts.error().is_finite() && stiffness.is_finite()).then_some(parts)
    }

    /// The sum of all errors.
    pub fn error(&self) -> f64 {
        self.of_bend() + self.of_first_order()
    }

    /// The errors by the bend.
    pub fn of_bend(&self) -> f64 {
        self.smooth + self.short
    }

    /// The errors by ends and jumps.
    pub fn of_first_order(&self) -> f64 {
        self.ends + self.jumps
    }
}

/// The error of the approach by ends of the surface and jumps of the coefficients, and the largest pressure there.
fn ends(problem: &Problem, state: &State, outline: &Outline) -> (f64, f64) {
    if outline.ends(problem.coefficients.repeats(&state.grid)) == 0 && !problem.coefficients.may_jump() {
        return (0.0, 0.0);
    }
    let (sum, highest) = pressures_at_ends(problem, state);
    (sum / state.force(), highest)
}

/// The relative error of a direction of one element without a period.
fn one_element(problem: &Problem, state: &State) -> f64 {
    let (x, y) = problem.coefficients.repeats(&state.grid);
    let is_one = |m: usize, repeats: bool| if m == 1 && !repeats { ONE_ELEMENT } else { 0.0 };
    is_one(state.grid.mx, x) + is_one(state.grid.my, y)
}

/// dF/d(approach): the force over the mean displacement, with a flat punch's pressures as weights. For half-spaces without a layer it is at
/// least that of a circle of the same area, in series with the compression by the mean pressure. It is not finite unless the mean displacement is
/// positive. That fails near full contact of two periods, or with a layer.
fn stiffness(problem: &Problem, force: f64, displaced: f64, area: f64) -> f64 {
    let found = if displaced > 0.0 { force / displaced } else { f64::NAN };
    if problem.coefficients.has_layer() || problem.coefficients.repeats(&problem.grid) == (true, true) {
        return found;
    }
    let compressed = problem.coefficients.kernel().constant() / problem.grid.element_area();
    let of_circle = 2.0 * problem.modulus() * (area / std::f64::consts::PI).sqrt();
    // `max` ignores NaN.
    found.max(1.0 / (1.0 / of_circle + compressed).max(0.0))
}

/// Relative discretisation error of the force (or the approach), from a state near the solution. 0 if it is unknown, as with limits that are reached
/// and for row tables.
pub fn predict(problem: &Problem, state: &State) -> f64 {
    if !problem.symmetric || state.has_limited() {
        return 0.0;
    }
    let outline = Outline::of(state);
    let curvature = Curvature::of(problem, state, &outline);
    let found = match state.load {
        Load::Approach(_) => state.force(),
        Load::Force(_) => state.approach,
    };
    let error = Parts::of(problem, state, &curvature, &outline).map_or(0.0, |parts| parts.error() / found.abs());
    if error.is_finite() {
        error
    } else {
        0.0
    }
}

/// Writes the errors of all rows, from the curvature and error parts of `finest`, the last row. Returns the limiting error and the
/// gain by the next finer grid.
pub fn estimate(
    ledger: &mut [LedgerRow],
    (problem, finest, outline): (&Problem, &State, &Outline),
    (curvature, parts): (&Curvature, Option<Parts>),
    seconds: f64,
) -> (Limit, Halving) {
    let Some(last) = ledger.last().copied().filter(|last| last.measures.contact_count > 0) else {
        return Default::default();
    };
    let measures = last.measures;
    let at_ends = parts.map_or(0.0, |parts| parts.highest_at_ends);
    let is_peak = at_ends <= PEAK_OVER_ENDS * measures.max_pressure;
    let missed = |bend: f64| PEAK_ERROR * bend * (1.0 + (bend / SHARP_PEAK).powi(2)) * measures.max_pressure;
    let settles = |at: usize, bend: f64| kink::missed(problem, finest, at) <= missed(bend);
    let peak = Curvature::of_peak(problem, finest, measures.max_pressure)
        .filter(|(at, bend)| is_peak && *bend <= SINGULAR_PEAK && settles(*at, *bend))
        .map(|(_, bend)| missed(bend));
    let pressure = parts.map(|_| PRESSURES_ERROR * curvature.pressure);
    let untrusted = untrusted(parts.is_some(), peak.is_some(), pressure.is_some());
    let residual = measures.certificate.residual;
    let found = measures.found(finest.load);
    // An error of the force implies an error of the area.
    let carried = parts.filter(|parts| parts.of_bend() > 0.0);
    let carried = carried.map_or(0.0, |parts| parts.of_bend() / parts.by * parts.stiffness / measures.force);
    let lines = outline_off(problem, outline) * finest.grid.element_area() + carried * measures.contact_area;
    // Before pressures carry a force, `carried` is infinite.
    let whole = finest.grid.len() as f64 * finest.grid.element_area();
    let area = |error: f64| error.is_finite().then_some(error.min(whole));
    let correction_off = correction_off(problem, finest);
    let count = ledger.len();
    for (i, row) in ledger.iter_mut().enumerate() {
        let is_last = i + 1 == count;
        let size = (finest.grid.len() as f64 / (row.mx * row.my) as f64).sqrt();
        // Coarser rows: the difference from the finest value minus its likely error.
        let force = parts.map(|parts| match is_last {
            true => parts.error(),
            false => (row.measures.found(finest.load) - (found - parts.likely)).abs() + parts.of_first_order(),
        });
        let highest = peak.map(|missed| missed + (row.measures.max_pressure - measures.max_pressure).abs());
        let correction = (row.measures.contact_area - row.measures.corrected_area).abs();
        let off = if is_last { correction } else { (row.measures.contact_area - measures.corrected_area).abs() };
        let hidden = |value: f64| residual * value.abs();
        row.error = DiscretisationError {
            force: force.map(|error| error + hidden(found)),
            max_pressure: highest.map(|error| error + hidden(measures.max_pressure)),
            contact_area: area(off + lines * size),
            corrected_area: area(correction_off * correction + lines * size),
            pressure: pressure.map(|error| error * size + residual),
            untrusted,
        };
    }
    let Some(parts) = parts else { return Default::default() };
    let hidden = residual * found.abs();
    let falling = Falling { by_sixteen: parts.short, by_four: parts.smooth, by_two: parts.of_first_order(), hidden };
    let more = doubling(finest.grid.refines(problem.coefficients.repeats(&finest.grid)));
    let halving = Halving { seconds: Some(more.powf(GROWTH) * seconds), error: Some(falling) };
    let limit = if parts.error() >= hidden { Limit::Grid } else { Limit::Tolerance };
    (limit, halving)
}

/// The bits of the errors without an estimate, which are logged.
fn untrusted(force: bool, max_pressure: bool, pressure: bool) -> u32 {
    let mut untrusted = 0;
    for (known, bit, what, why) in [
        (force, DiscretisationError::FORCE, "force or approach", "contact is on single elements"),
        (
            max_pressure,
            DiscretisationError::MAX_PRESSURE,
            "largest pressure",
            "it is singular, at its peak or at an end of the surface, or not resolved",
        ),
        (pressure, DiscretisationError::PRESSURE, "pressures", "contact is on single elements"),
    ] {
        if !known {
            untrusted |= bit;
            log::info!("the error of the {what} cannot be estimated: {why}");
        }
    }
    untrusted
}
