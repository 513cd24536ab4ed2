//! Estimates of the discretisation errors of a solution, from one grid.
//!
//! *Force and approach.* A pressure that is constant on an element is a mean over the element. Therefore displacements at centres differ from those
//! by smooth pressures by `(1/24)(dx^2 u_xx + dy^2 u_yy)`, and in contact `u = approach - h`. By Betti's theorem, a change of h changes the approach
//! by the mean of that change with weights q: the pressures of a flat punch of force 1 on the same contact area. At the boundary of contact, where
//! pressures fall to 0 as a square root, half of the error cancels:
//!
//! ```text
//! approach* - approach = s b,    F - F* = S s b,    b = mean with q of (dx^2 h_xx + dy^2 h_yy)/24 over C,    S = dF/d(approach)
//! ```
//!
//! The asterisk marks the exact values. s = 1/2 was measured: with 32 elements across the contact, s varies by a third, because the boundary lies
//! anywhere in its elements. Along a straight outline errors do not average out and are up to a few times larger. [`Curvature`] computes b, the bend;
//! docs/accuracy.md has the measurements.
//!
//! Two errors of force and approach are of first order in the size of the elements. Pressures are infinite at an end of the surface, and the end lies
//! anywhere between two centres ([`pressures_at_ends`]). A jump of the surface also lies anywhere between two centres ([`Curvature::jumps`]).
//! Pressures are also infinite where coefficients jump, between patches or in a layer: such a jump counts as a part of an end.
//!
//! *Pressures.* Their errors are fractions of the second differences within the contact area and across its boundary:
//! [`PEAK_ERROR`] for the largest pressure, [`PRESSURES_ERROR`] for the rms. A peak whose second differences are a large part of the peak is singular
//! or not resolved, and has no estimate.
//!
//! *The contact area* is a count of elements, and its outline ([`Outline`]) gives a correction. The error of the count is the correction. The error
//! of the corrected area is a part of the correction. Straight pieces of the outline, and straight ends of the surface, add about half an element for
//! each of their elements. Ends of the surface in steps add the square root of the number of their elements.

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

/// s in the mean of the measurements: the error of the approach over the bend.
const MEAN_ERROR: f64 = 0.5;
/// s that bounds most of the measurements.
const ERROR_BOUND: f64 = 0.58;
/// The error of the approach along straight outlines, over `pressure/E*` and their length per element in contact. (A Hertz contact has a bend of
/// `(pi/32) sides d/N` times its mean pressure over E*; along straight lines the error is twice as much.)
const STRAIGHT_ERROR: f64 = 0.2;
/// Short chords have the additional relative error `(chord/SHORT_CHORD)^-2` times the scatter of the outline: among many spots of contact the
/// sharpest ones carry most of the load.
const SHORT_CHORD: f64 = 2.5;
/// Factor on this error if it is computed from the runs of elements through the rim instead of the mean chord. With this factor the estimate sufficed
/// for every height map with spikes of one element that was measured.
const RUNS_FACTOR: f64 = 0.5;
/// Error of the approach over the uncertainty of a jump of the surface. 98 of 100 positions of a jump between two centres have a smaller error.
const JUMPS_FACTOR: f64 = 0.6;
/// If the pressure at ends of the surface exceeds this part of the largest pressure, the latter has no estimate. Pressures at ends are singular: they
/// grow as the square root of the number of elements in a direction. From a quarter of the largest pressure, they need more than the three doublings
/// that a search predicts to exceed it.
const PEAK_OVER_ENDS: f64 = 0.25;
/// Shortest mean chord of the contact with an estimate, in elements. Below it, contact is on single elements.
pub(super) const LEAST_CHORD: f64 = 1.5;
/// Relative error if the grid has one element in a direction without a period.
const ONE_ELEMENT: f64 = 0.26;
/// Error of the largest pressure over the second differences there.
const PEAK_ERROR: f64 = 0.1;
/// rms error of the pressures over the rms of their second differences.
const PRESSURES_ERROR: f64 = 0.25;
/// Second differences over the peak above which the peak is singular or not resolved.
const SINGULAR_PEAK: f64 = 0.18;
/// Second differences over the peak at which the error of the peak is twice [`PEAK_ERROR`] times them.
const SHARP_PEAK: f64 = 0.08;

/// Parts of the estimated error of the force, or of the approach if the force is prescribed. All are positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Parts {
    /// The error from the bend of the surface within an element: of second order in the size of the elements.
    pub smooth: f64,
    /// The additional error from the bend at short chords: of fourth order.
    pub short: f64,
    /// The error from ends of the surface and from jumps of the coefficients: of first order.
    pub ends: f64,
    /// The error from jumps of the surface: of first order.
    pub jumps: f64,
    /// dF/d(approach).
    pub stiffness: f64,
    /// The factor from errors of the approach to these errors: dF/d(approach) if the approach is prescribed, else 1.
    per_approach: f64,
    /// The largest pressure beside a border, a hole, or a jump of the coefficients or of h.
    pub highest_at_ends: f64,
    /// The expected error from the bend, with its sign: found minus exact value.
    likely: f64,
}

impl Parts {
    /// Estimates the errors of a state. None if contact is on single elements, or if an error is not finite.
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
        // All errors are estimated as errors of the approach first.
        let (per_approach, sign, found) = match state.load {
            Load::Force(_) => (1.0, -1.0, curvature.depth),
            Load::Approach(_) => (stiffness, 1.0, force),
        };
        let pressure = force / (count as f64 * state.grid.element_area());
        let along_lines =
            STRAIGHT_ERROR * pressure / problem.modulus() * outline.straight_length(&state.grid) / count as f64;
        // For many spots of contact the error depends on the chord of the sharpest, not on the mean chord.
        let of_runs = (curvature.bend.abs() / (chord * chord)).max(RUNS_FACTOR * curvature.short);
        let short = ERROR_BOUND * per_approach * outline.scatter(count, repeats) * SHORT_CHORD * SHORT_CHORD * of_runs;
        let smooth = ERROR_BOUND * per_approach * (curvature.bend.abs() + along_lines);
        let (ends, highest) = ends(problem, state, outline);
        let highest_at_ends = highest.max(curvature.highest_at_jumps);
        let ends = per_approach * ends + one_element(problem, state) * found.abs();
        let jumps =
            if problem.exact_jumps { 0.0 } else { JUMPS_FACTOR * per_approach * curvature.jumps / count as f64 };
        let likely = sign * MEAN_ERROR * per_approach * curvature.bend;
        let parts = Parts { smooth, short, ends, jumps, stiffness, per_approach, highest_at_ends, likely };
        (parts.error().is_finite() && stiffness.is_finite()).then_some(parts)
    }

    /// The sum of all errors.
    pub fn error(&self) -> f64 {
        self.of_bend() + self.of_first_order()
    }

    /// The sum of the errors from the bend.
    pub fn of_bend(&self) -> f64 {
        self.smooth + self.short
    }

    /// The sum of the errors from ends and jumps.
    pub fn of_first_order(&self) -> f64 {
        self.ends + self.jumps
    }
}

/// The error of the approach from ends of the surface and jumps of the coefficients, and the largest singular pressure there.
fn ends(problem: &Problem, state: &State, outline: &Outline) -> (f64, f64) {
    if outline.ends(problem.coefficients.repeats(&state.grid)) == 0 && !problem.coefficients.may_jump() {
        return (0.0, 0.0);
    }
    let (sum, highest) = pressures_at_ends(problem, state);
    (sum / state.force(), highest)
}

/// The relative error of force or approach from directions that have one element and no period.
fn one_element(problem: &Problem, state: &State) -> f64 {
    let (x, y) = problem.coefficients.repeats(&state.grid);
    let is_one = |m: usize, repeats: bool| if m == 1 && !repeats { ONE_ELEMENT } else { 0.0 };
    is_one(state.grid.mx, x) + is_one(state.grid.my, y)
}

/// dF/d(approach): the force over `displaced`, the mean displacement with the pressures of a flat punch as weights. For half-spaces without a layer
/// the stiffness is at least that of a circle of the same area, in series with the compression by the mean pressure. If the mean displacement is not
/// positive, the result may be NaN: this happens near full contact with two periods, and with a layer.
fn stiffness(problem: &Problem, force: f64, displaced: f64, area: f64) -> f64 {
    let found = if displaced > 0.0 { force / displaced } else { f64::NAN };
    if problem.coefficients.has_layer() || problem.coefficients.repeats(&problem.grid) == (true, true) {
        return found;
    }
    let compressed = problem.coefficients.kernel().constant() / problem.grid.element_area();
    let of_circle = 2.0 * problem.modulus() * (area / std::f64::consts::PI).sqrt();
    // `max` ignores a NaN of `found`.
    found.max(1.0 / (1.0 / of_circle + compressed).max(0.0))
}

/// Estimates the relative discretisation error of the force, or of the approach if the force is prescribed, from a state near the solution. 0 if
/// there is no estimate: with asymmetric coefficients, elements at their limit, or contact on single elements.
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

/// Writes the estimated errors of all rows of the ledger. They follow from the state `finest` of the last row, its outline, its curvature and the
/// parts of its error. Returns which error limits the accuracy, and cost and error of the next finer grid. `seconds` are those of the solve.
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
    // On finer grids a kink of the surface at the peak must not add more than the estimated error.
    let settles = |at: usize, bend: f64| kink::missed(problem, finest, at) <= missed(bend);
    let peak = Curvature::of_peak(problem, finest, measures.max_pressure)
        .filter(|(at, bend)| is_peak && *bend <= SINGULAR_PEAK && settles(*at, *bend))
        .map(|(_, bend)| missed(bend));
    let pressure = parts.map(|_| PRESSURES_ERROR * curvature.pressure);
    let untrusted = untrusted(parts.is_some(), peak.is_some(), pressure.is_some());
    let residual = measures.certificate.residual;
    let found = measures.found(finest.load);
    // An error of the force by a part implies an error of the area by the same part.
    let bent = parts.filter(|parts| parts.of_bend() > 0.0);
    let of_force = bent.map_or(0.0, |parts| parts.of_bend() / parts.per_approach * parts.stiffness / measures.force);
    let lines = outline_off(problem, outline) * finest.grid.element_area() + of_force * measures.contact_area;
    // While the force is 0, `of_force` is infinite.
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

/// The bits of `untrusted`: one for each error without an estimate. Logs the reasons.
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
