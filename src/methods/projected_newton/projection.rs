//! The projection of p + t on the admissible pressures that carry a prescribed force.

use super::{dot, ProjectedNewton};
use crate::contact::{AdmissibleSet, State};
use crate::scene::Load;
use crate::sums::in_blocks;

/// The largest number of steps to the constant: some Newton steps, some doublings, and at most as many bisections as a double has bits.
const STEPS: u32 = 200;

impl ProjectedNewton {
    /// Sets d = project(p + length t) - p, where p + d carries a prescribed force. Stores p + d in `along`. Returns the slope (d, e).
    pub(super) fn project<S: AdmissibleSet>(&mut self, state: &State, set: S, length: f64) -> f64 {
        let ProjectedNewton { free, distance, t, along, change, .. } = self;
        let moved = |i: usize| state.p[i] + length * t[i];
        let constant = match state.load {
            Load::Approach(_) => 0.0,
            Load::Force(force) => {
                let to = |i: usize, c: f64| if free[i] { set.project(i, moved(i) + c) } else { state.p[i] };
                let sum = |c: f64| in_blocks((0..free.len()).map(|i| to(i, c)));
                // The slope of the sum is the number of elements that a larger constant moves.
                let slope = |c: f64| (0..free.len()).filter(|&i| free[i] && is_between(set, i, moved(i) + c)).count();
                let size = (0..free.len()).filter(|&i| free[i]).map(|i| moved(i).abs()).fold(0.0, f64::max);
                constant_for(force / state.grid.element_area(), sum, slope, size)
            }
        };
        for i in 0..free.len() {
            along[i] = if free[i] { set.project(i, moved(i) + constant) } else { state.p[i] };
            change[i] = along[i] - state.p[i];
        }
        dot(change, distance)
    }
}

/// Whether p lies between both bounds of element i.
fn is_between<S: AdmissibleSet>(set: S, i: usize, p: f64) -> bool {
    p > 0.0 && p < set.limit(i)
}

/// Finds the constant for which `sum(constant)` is `wanted`. The sum is a piecewise linear, increasing function of the constant; its slope is a
/// number of elements. `size` is the size of a pressure, from which the search for a bracket starts.
pub(super) fn constant_for(wanted: f64, sum: impl Fn(f64) -> f64, slope: impl Fn(f64) -> usize, size: f64) -> f64 {
    let (mut low, mut high, mut constant) = (f64::NEG_INFINITY, f64::INFINITY, 0.0);
    let mut reach = size.max(f64::MIN_POSITIVE);
    for _ in 0..STEPS {
        let missing = wanted - sum(constant);
        if missing == 0.0 {
            break;
        }
        *(if missing > 0.0 { &mut low } else { &mut high }) = constant;
        let newton = constant + missing / slope(constant) as f64;
        let next = if newton > low && newton < high && newton.is_finite() {
            newton
        } else if low.is_finite() && high.is_finite() {
            0.5 * (low + high)
        } else {
            reach *= 2.0;
            constant + if missing > 0.0 { reach } else { -reach }
        };
        if next == constant || !(next > low && next < high) {
            break;
        }
        constant = next;
    }
    constant
}
