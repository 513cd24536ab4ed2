//! Bodies whose displacements depend on earlier steps. One step in time of such bodies is a normal problem with another compliance s and an
//! additional displacement H of the surfaces. s and H are known before the step:
//!
//! ```text
//! e = h + H - approach + s A p
//! e/s = (h + H)/s - approach/s + A p    divided by s: the elastic problem with all lengths divided by s
//! ```
//!
//! So pressures, forces, pressure limits and the operator A are those of the elastic problem.

use super::coupled::History;
use crate::contact::State;
use crate::visco::Report;

/// One step in time of bodies whose displacements depend on earlier steps.
pub trait Memory {
    /// The compliance s of the step, relative to the instantaneous one.
    fn compliance(&self) -> f64;

    /// Writes H of each element, which the history determines, to `displacement`.
    fn fill(&self, history: &History, displacement: &mut [f64]);

    /// Updates the history after the step. `state` holds the pressures, u = A p, and the lengths of the elastic problem, which are divided by s.
    fn step_done(&self, history: &mut History, state: &State) -> Report;
}
