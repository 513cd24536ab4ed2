//! The methods, each a [`Step`] of the solver's loop, and what several of them use: `extension`, `fgmres`, `fields`.

pub mod direct;
pub mod extension;
pub(crate) mod fgmres;
pub(crate) mod fields;
pub mod multigrid;
pub mod norm;
pub mod projected_cg;
pub mod projected_newton;
mod task;

pub use task::Task;

use crate::contact::{AdmissibleSet, State};
use crate::error::Result;

/// The start of a solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// p = 0.
    Nothing,
    /// The caller's guess.
    Given,
    /// The last solution.
    Previous,
}

/// One step of a method, between two steps of the active set.
pub trait Step<S: AdmissibleSet> {
    /// The name in messages.
    fn name(&self) -> &'static str;

    /// Prepares for `state`: allocates memory and discards the last solve.
    fn begin(&mut self, _state: &State) -> Result<()> {
        Ok(())
    }

    /// Changes p, and sets the freshness `state.u_is` of u.
    fn step(&mut self, task: &mut Task<'_, '_, S>) -> Result<Change>;

    /// The conditions under which the loop gives the method up, or accepts a state although elements change sides.
    fn policy(&self) -> Policy;
}

/// The measures of one step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Change {
    /// rms over C of the change of p; infinite if the step has no such measure of convergence.
    pub update: f64,
    /// Elements that the step itself moved into or out of C.
    pub changes: u64,
    /// Whether the step can make no more progress on this scene.
    pub gives_up: bool,
}

/// The policy of the loop for a method.
#[derive(Clone, Copy, Debug)]
pub struct Policy {
    /// Whether the loop makes steps (4.1) and (4.2). NORM makes its own step 3, at once and before the next solve.
    pub exchanged_by_loop: bool,
    /// Whether the loop counts each step as a cycle. Other methods count their own iterations.
    pub step_is_cycle: bool,
    /// Steps in which the certificate holds but elements still change sides, after which the certificate decides.
    pub chatter: u32,
    /// Steps without progress after which the method is given up.
    pub patience: u32,
    /// Part of the least violation so far below which a violation is progress.
    pub progress: f64,
}
