//! What one solve with adhesion is asked for.

use super::levels::Surfaces;
use super::start::Start;
use crate::scene::Load;

/// The state from which a solve starts.
#[derive(Clone, Copy, Debug)]
pub struct InitialState<'a> {
    /// Total pressures. `None`: the array lent by [`Solver::lend`](super::Solver::lend) holds them already.
    pub pressure: Option<&'a [f64]>,
    /// The contact area C.
    pub contact: &'a [bool],
    /// The approach at which the search for a given force starts. It is not read if the approach is given.
    pub approach: f64,
}

/// What one solve is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// The surfaces and their attraction.
    pub surfaces: Surfaces<'a>,
    /// A given approach or a given force. The force may be negative, which is a pull.
    pub load: Load,
    /// Whether to search for the pull-off force. The search starts at the state that belongs to `load`.
    pub pull_off: bool,
    /// Where the solve starts if `state` is `None`.
    pub start: Start,
    /// The state from which the solve starts.
    pub state: Option<InitialState<'a>>,
    /// Whether to compute dF/dapproach.
    pub stiffness: bool,
    /// Whether to compute the stability margin 1 - lambda (module `stability`).
    pub stability: bool,
    /// The tolerance of each relative residual (`Measured`).
    pub tolerance: f64,
    /// The largest number of cycles on the finest grid in one solve. A search for a pull or for the pull-off force may take more (module
    /// `begin`).
    pub max_cycles: u64,
}
