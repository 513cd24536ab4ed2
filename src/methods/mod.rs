//! The methods, each whole in its folder. To the solver's loop each of them is a [`Step`].

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

/// Where a solve starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// No pressures.
    Nothing,
    /// The caller's.
    Given,
    /// The last solution.
    Previous,
}

/// One step of a method, between two steps of the active set.
pub trait Step<S: AdmissibleSet> {
    /// Its name in messages.
    fn name(&self) -> &'static str;

    /// Gets ready for `state`: memory, and what was learnt from the solve before is forgotten.
    fn begin(&mut self, _state: &State) -> Result<()> {
        Ok(())
    }

    /// Changes p; `state.u_is` says what u is worth afterwards.
    fn step(&mut self, task: &mut Task<'_, '_, S>) -> Result<Change>;

    /// When it is given up, and when elements that change sides keep an answer from being one.
    fn policy(&self) -> Policy;
}

/// The measures of one step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Change {
    /// rms over C of the change of p; infinite where it proves nothing.
    pub update: f64,
    /// Elements that the step itself moved into or out of C.
    pub changes: u64,
    /// Whether the step can do no more on this scene.
    pub gives_up: bool,
}

/// How a method goes through the loop.
#[derive(Clone, Copy, Debug)]
pub struct Policy {
    /// Whether the loop takes steps (4.1) and (4.2) for it. NORM takes its own step 3, at once and before the next solve.
    pub exchanged_by_loop: bool,
    /// Whether the loop counts each step as a cycle. Other methods count their own iterations.
    pub step_is_cycle: bool,
    /// Steps in which the certificate holds but elements still change sides, after which the certificate decides.
    pub chatter: u32,
    /// Steps without progress after which the method is given up.
    pub patience: u32,
    /// Progress: the violation falls below this part of the least so far.
    pub progress: f64,
}
