//! The methods of solution. Each implements [`Step`], which the solver's loop calls. `extension`, `fgmres` and `fields` are tools that several
//! methods share.

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

/// The pressures from which a solve starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// p = 0.
    Nothing,
    /// The caller's guess.
    Given,
    /// The last solution.
    Previous,
}

/// One step of a method. Between two such steps the loop exchanges elements by steps (4.1) and (4.2).
pub trait Step<S: AdmissibleSet> {
    /// The method's name in messages.
    fn name(&self) -> &'static str;

    /// Prepares a solve of `state`: allocates memory and discards what the last solve left.
    fn begin(&mut self, _state: &State) -> Result<()> {
        Ok(())
    }

    /// Changes p, and sets `state.u_is` to how accurately u then equals A p.
    fn step(&mut self, task: &mut Task<'_, '_, S>) -> Result<Change>;

    /// The conditions under which the loop gives this method up, or accepts a state although elements still enter or leave C.
    fn policy(&self) -> Policy;
}

/// What one step has changed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Change {
    /// rms over C of the change of p; infinite if the step has no such measure of convergence.
    pub update: f64,
    /// The number of elements that the step itself moved into or out of C.
    pub changes: u64,
    /// Whether the step can make no more progress on this scene.
    pub gives_up: bool,
}

/// The rules by which the loop treats a method.
#[derive(Clone, Copy, Debug)]
pub struct Policy {
    /// Whether the loop exchanges elements by steps (4.1) and (4.2). If not, the method does (NORM in its step 3, before the next inner solve).
    pub exchanged_by_loop: bool,
    /// Whether the loop counts each step as a cycle. If not, the method counts its own iterations.
    pub step_is_cycle: bool,
    /// The number of steps in which the certificate may hold while elements still enter or leave C. After more such steps the certificate alone
    /// decides.
    pub chatter: u32,
    /// The method is given up after more than this number of steps without progress.
    pub patience: u32,
    /// A step makes progress if its violation is below this part of the smallest violation so far.
    pub progress: f64,
}
