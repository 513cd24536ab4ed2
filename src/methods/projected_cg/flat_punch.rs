//! Lines in plane strain: which elements enter C, and the deflation direction.
//!
//! If the approach is prescribed, the mean of the residual over C is due to a missing force. The pressure of a flat punch on C removes this mean, and
//! serves as the deflation direction. The joined pieces of C (module `punches`) approximate this pressure. With two periods such a pressure displaces
//! almost nothing near full contact; then module `find_force` searches for the force that belongs to the approach.

use super::preconditioner::Preconditioner;
use super::vectors::Iteration;
use crate::contact::State;
use crate::operator::fft::Real;
use crate::scene::Load;
use crate::sums::Sums;

/// The penetration from which an element enters C, in standard deviations of the residual. Three lines of 9600 elements with two periods take 43, 66
/// and 48 products with 3, and 58, 80 and 62 with 10 (prescribed force, from a uniform pressure). With 1 they do not converge.
const ALLOWED_DEVIATIONS: f64 = 3.0;

impl<T: Real> Iteration<T> {
    /// Whether the grid is a line in plane strain.
    pub(super) fn is_plane_strain(&self) -> bool {
        self.preconditioner.as_ref().is_some_and(Preconditioner::has_punches)
    }

    /// Before the first iteration: chooses whether the preconditioner treats the pieces of C as flat punches, and sets the allowed penetration.
    pub(super) fn choose_punches(&mut self, state: &State) {
        self.allowance = 0.0;
        let Some(m) = &mut self.preconditioner else { return };
        if m.use_punches(matches!(state.load, Load::Approach(_)) && !self.deflation.is_there()) {
            self.counted = None;
        }
        if self.is_plane_strain() {
            self.residual(state);
        }
    }

    /// Sets the penetration from which exterior elements enter C: the mean of the residual over C, which is in z, plus [`ALLOWED_DEVIATIONS`]
    /// standard deviations. Smaller penetrations are as uncertain as the residual, and most elements with such a penetration would leave C at once.
    /// With a prescribed approach the mean is not 0, and may be negative. By subtracting it, distances are relative to their mean over C, as with a
    /// prescribed force.
    pub(super) fn find_allowance(&mut self) {
        let mut sums = Sums::new();
        sums.add([], [&self.z], |[], [r]| [r, r * r]);
        let ([sum, squares], count) = (sums.values(), self.segments.count().max(1) as f64);
        let mean = sum / count;
        self.allowance = mean + ALLOWED_DEVIATIONS * (squares / count - mean * mean).max(0.0).sqrt();
    }

    /// Sets the deflation direction to the pressure of a flat punch on C, with mean 1 there.
    pub(super) fn press_flat(&mut self, state: &State) {
        self.count_near(state);
        self.preconditioner.iter_mut().for_each(|m| m.press_flat(&mut self.deflation.d));
    }
}
