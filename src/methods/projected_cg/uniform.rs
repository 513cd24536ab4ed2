//! With a prescribed approach: a deflation direction that changes the mean of p where scaling cannot.
//!
//! Search directions carry no force, and p is scaled to the least energy (module `energy`). Scaling fails in two kinds of scenes:
//!
//! - One element carries much of the force, like a grain of dust or a spike in data of an interferometer. Scaling then fits the depth of that
//!   element, and a hundredth of this depth exceeds the roughness of all other elements.
//! - The scene has two periods and is near full contact. The mean of p displaces nothing, so the least energy does not determine the mean.
//!
//! In these scenes p is not scaled. In each step p moves along d, as along a change of the last step (module `deflation`):
//!
//! ```text
//! d = 1 on C;   w = A d: one product
//! ```
//!
//! On a line in plane strain d is the pressure of a flat punch instead (module `flat_punch`), for any surface.
//!
//! d is set up again when a quarter of its elements has left C. This saves time, because the elements that left need corrections in each step. C may
//! be found late, for instance around a spike that dominates coarse grids. Then d is set up when C has changed much.
//!
//! 180 planes of 80 x 80 elements with one spike, many spikes, or plateaus take 5 to 31 iterations by approach (median 15), and 5 to 29 by force
//! (median 14). Without d most of the planes with spikes take more than 60 by approach.

use super::iteration::Cycle;
use super::vectors::Iteration;
use crate::contact::{AdmissibleSet, State};
use crate::operator::fft::Real;
use crate::scene::Load;
use crate::sums::{in_blocks, Sums};

/// A pressure above this many mean pressures is concentrated.
const CONCENTRATED_RATIO: f64 = 8.0;
/// Few elements carry much of the force if the excess of concentrated pressures carries more than this part of the force.
const CONCENTRATED_FORCE: f64 = 0.01;
/// d is set up, or set up again, when more than 1/CHANGED_DIVISOR of the elements of C have changed.
const CHANGED_DIVISOR: u64 = 4;

impl<T: Real> Iteration<T> {
    /// Sets up the deflation direction d = 1 on C, or a flat punch's pressure, if the scene needs d, no change of the last step serves as d, and
    /// there is memory. Returns the number of products that this takes.
    pub(super) fn deflate<S: AdmissibleSet>(&mut self, state: &State, is_mean_free: bool) -> u64 {
        let by_approach = matches!(state.load, Load::Approach(_));
        let is_known = self.deflation.is_there() && !self.deflation.is_uniform;
        if is_known || !by_approach || S::FIXED || S::LIMITED && state.reached_limit {
            return 0;
        }
        let is_nearly_full = is_mean_free && 2 * self.segments.count() > state.p.len();
        // If a layer's compliance differs between elements, few elements carry much of the force for another reason, and d = 1 is of no use.
        let is_of_few =
            !is_nearly_full && !self.operator.has_diagonal() && few_carry_much(state, self.segments.count());
        let is_plane_strain = self.is_plane_strain();
        if !(is_nearly_full || is_of_few || is_plane_strain) || self.deflation.reserve(state.p.len()).is_err() {
            return 0;
        }
        self.deflation.is_uniform = true;
        for (d, inside) in self.deflation.d.iter_mut().zip(&state.contact) {
            *d = T::of(f64::from(u8::from(*inside)));
        }
        if is_plane_strain {
            self.press_flat(state);
        }
        self.operator.apply(&self.deflation.d, &mut self.deflation.w, &mut self.workspace);
        self.deflation.elements = self.segments.count() as u64;
        self.deflation.measure();
        1
    }

    /// Whether C has changed so much that [`deflate`](Iteration::deflate) is called again. Without a direction, C is examined after 1, 2, 4, 8, ...
    /// iterations.
    pub(super) fn is_another_area(&self, cycle: &Cycle, iterations: u64) -> bool {
        let count = self.segments.count() as u64;
        if self.deflation.is_there() {
            let grown = if self.is_plane_strain() { count.saturating_sub(self.deflation.elements) } else { 0 };
            self.deflation.is_uniform && CHANGED_DIVISOR * grown.max(self.deflation.left() as u64) > count
        } else {
            iterations.is_power_of_two() && CHANGED_DIVISOR * cycle.changes > count
        }
    }
}

/// Whether few of the `count` elements of C carry much of the force.
fn few_carry_much(state: &State, count: usize) -> bool {
    let sum = in_blocks(state.p.iter().map(|p| p.max(0.0)));
    let (mean, mut sums) = (sum / count as f64, Sums::new());
    sums.add::<f64, 1, 0>([&state.p], [], |[p], []| [(p - CONCENTRATED_RATIO * mean).max(0.0)]);
    let [beyond] = sums.values();
    beyond > CONCENTRATED_FORCE * sum
}
