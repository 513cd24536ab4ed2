//! The memory of bodies that remember the steps before: a step is a normal problem with another compliance.
//!
//! ```text
//! e = h + H - approach + s A p          s, H: known before the step
//! e/s = (h + H)/s - approach/s + A p    the problem of the set-up, in other lengths
//! ```
//!
//! Pressures, forces and what limits them stay as they are, and so do all operators.

use super::coupled::History;
use crate::contact::State;
use crate::visco::Report;

/// A step of bodies that remember.
pub trait Memory {
    /// s.
    fn compliance(&self) -> f64;

    /// H of each element, from what the steps before left.
    fn fill(&self, history: &History, displacement: &mut [f64]);

    /// The step is done: keeps what the next one goes on from. `state` has the pressures and A p, and the distances of the problem that was solved.
    fn step_done(&self, history: &mut History, state: &State) -> Report;
}
