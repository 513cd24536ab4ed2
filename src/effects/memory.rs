//! Bodies with a memory of earlier steps: a step is a normal problem with another compliance.
//!
//! ```text
//! e = h + H - approach + s A p          s, H: known before the step
//! e/s = (h + H)/s - approach/s + A p    the problem of the set-up, in scaled lengths
//! ```
//!
//! Pressures, forces, limits and all operators are unchanged.

use super::coupled::History;
use crate::contact::State;
use crate::visco::Report;

/// A step of bodies with memory.
pub trait Memory {
    /// s.
    fn compliance(&self) -> f64;

    /// H of each element, from the history.
    fn fill(&self, history: &History, displacement: &mut [f64]);

    /// Updates the history after a step. `state` has the pressures and A p, and the distances of the problem solved.
    fn step_done(&self, history: &mut History, state: &State) -> Report;
}
