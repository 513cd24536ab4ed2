//! By approach: a direction that moves the mean of p where scaling cannot.
//!
//! Directions carry no force, and p is scaled to the least energy (module `energy`). That fails in two kinds of scenes:
//!
//! - One element carries much of the force: a grain of dust, the spike of an interferometer. Scaling then fits the depth of that element, and a
//!   hundredth of that depth is more than the roughness of all others.
//! - Two periods, near full contact: the mean of p displaces nothing, so the least energy does not determine it.
//!
//! There p moves in each step along d, as along a change of the last step (module `deflation`), and is not scaled:
//!
//! ```text
//! d = 1 on C;   w = A d: one product
//! ```
//!
//! On a line in plane strain d is the pressure of a flat punch instead (module `flat_punch`), whatever the surface.
//!
//! d is made anew when a quarter of C has left it. Elements that left take corrections in each step, so that this costs less than it saves; and
//! where C is found late, as around a spike on which the coarse grids see nothing else, d is first made then.
//!
//! Measured by approach: 180 planes of 80 x 80 with one spike, many, or plateaus, 5 to 31 iterations, 15 in the median, by force 5 to 29 and 14;
//! without d most with spikes take more than 60.

use super::iteration::Cycle;
use super::vectors::Iteration;
use crate::contact::{AdmissibleSet, State};
use crate::operator::fft::Real;
use crate::scene::Load;
use crate::sums::{in_blocks, Sums};

/// Pressures of more than so many times the mean are those of few elements.
const FEW: f64 = 8.0;
/// They carry much if what they have beyond that is this part of the force.
const MUCH: f64 = 0.01;
/// Where this part of C has changed, d is made anew.
const ANOTHER: u64 = 4;

impl<T: Real> Iteration<T> {
    /// Makes the deflation direction, where the load needs one and no change is known. Without memory for it there is none. Returns the products
    /// that this takes.
    pub(super) fn deflate<S: AdmissibleSet>(&mut self, state: &State, is_mean_free: bool) -> u64 {
        let by_approach = matches!(state.load, Load::Approach(_));
        let is_known = self.deflation.is_there() && !self.deflation.is_uniform;
        if is_known || !by_approach || S::FIXED || state.reached_limit {
            return 0;
        }
        let is_nearly_full = is_mean_free && 2 * self.segments.count() > state.p.len();
        // Below a layer that differs between elements, few carry much for another reason, and 1 is no direction.
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

    /// Whether so much of C has changed that a direction on it is to be made anew, or for the first time.
    pub(super) fn is_another_area(&self, cycle: &Cycle, iterations: u64) -> bool {
        let count = self.segments.count() as u64;
        if self.deflation.is_there() {
            let grown = if self.is_plane_strain() { count.saturating_sub(self.deflation.elements) } else { 0 };
            self.deflation.is_uniform && ANOTHER * grown.max(self.deflation.left() as u64) > count
        } else {
            iterations.is_power_of_two() && ANOTHER * cycle.changes > count
        }
    }
}

/// Whether few elements of C, which has `count` of them, carry much of the force.
fn few_carry_much(state: &State, count: usize) -> bool {
    let sum = in_blocks(state.p.iter().map(|p| p.max(0.0)));
    let (mean, mut sums) = (sum / count as f64, Sums::new());
    sums.add::<f64, 1, 0>([&state.p], [], |[p], []| [(p - FEW * mean).max(0.0)]);
    let [beyond] = sums.values();
    beyond > MUCH * sum
}
