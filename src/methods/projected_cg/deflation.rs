//! By approach: a direction that moves the mean of p where scaling cannot.
//!
//! Directions carry no force, and p is scaled to the least energy (module `energy`). That fails in two kinds of scenes:
//!
//! - One element carries much of the force: a grain of dust, the spike of an interferometer. Scaling then fits the depth of that element, a hundredth
//!   of which is more than the roughness of all others.
//! - Two periods, near full contact: A displaces nothing by the mean of p, so that the least energy says nothing of it.
//!
//! There p moves in each step along d, as along a known change (module `known`):
//!
//! ```text
//! d = min(p, CUT mean of p) on C, or 1 on C with two periods;   w = A d: one product
//! ```
//!
//! Measured in iterations: planes of 128 x 128 with a spike of 700 to 10000 rms of the roughness 13 to 16, without d 44 to 231 or no end; waves with
//! two periods at 80 to 98 hundredths of the force of full contact 9 to 122, without d half of them have no end.

use super::vectors::Iteration;
use crate::contact::{AdmissibleSet, State};
use crate::error::Result;
use crate::operator::fft::Real;
use crate::scene::Load;
use crate::sums::Sums;

/// Pressures of more than so many times the mean are those of few elements.
const FEW: f64 = 8.0;
/// They carry much if what they have beyond that is this part of the force.
const MUCH: f64 = 0.01;
/// Pressures of d are at most so many times the mean.
const CUT: f64 = 3.0;

impl<T: Real> Iteration<T> {
    /// Makes the deflation direction, where the load needs one and no change is known. Returns the products that this takes.
    pub fn deflate<S: AdmissibleSet>(&mut self, state: &State, is_mean_free: bool) -> Result<u64> {
        let by_approach = matches!(state.load, Load::Approach(_));
        if self.known.is_there() || !by_approach || S::FIXED || state.reached_limit {
            return Ok(0);
        }
        let is_nearly_full = is_mean_free && 2 * state.contact_count() > state.p.len();
        let most = if is_nearly_full { None } else { cut(state) };
        if !is_nearly_full && most.is_none() {
            return Ok(0);
        }
        self.known.reserve(state.p.len())?;
        self.known.is_deflation = true;
        let direction = |p: f64| most.map_or(1.0, |most| p.clamp(0.0, most));
        for ((d, p), inside) in self.known.d.iter_mut().zip(&state.p).zip(&state.contact) {
            *d = T::of(if *inside { direction(*p) } else { 0.0 });
        }
        self.operator.apply(&self.known.d, &mut self.known.w, &mut self.workspace);
        self.known.measure();
        Ok(1)
    }
}

/// The pressure at which p is to be cut off; none where no few elements carry much of the force.
fn cut(state: &State) -> Option<f64> {
    let mut sums = Sums::new();
    sums.add::<f64, 1, 0>([&state.p], [], |[p], []| [p.max(0.0), f64::from(u8::from(p > 0.0))]);
    let [sum, count] = sums.values();
    let (mean, mut sums) = (sum / count, Sums::new());
    sums.add::<f64, 1, 0>([&state.p], [], |[p], []| [(p - FEW * mean).max(0.0)]);
    let [beyond] = sums.values();
    (beyond > MUCH * sum).then_some(CUT * mean)
}
