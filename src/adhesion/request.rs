//! The request of a solve with adhesion.

use super::levels::Surfaces;
use super::start::Start;
use crate::scene::Load;

/// A state to start from.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    /// Total pressures; none: those lent to the solver.
    pub pressure: Option<&'a [f64]>,
    /// The contact area.
    pub contact: &'a [bool],
    /// The approach, where the force is given.
    pub approach: f64,
}

/// One solve.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// The surfaces and their attraction.
    pub surfaces: Surfaces<'a>,
    /// Approach or force, which may pull.
    pub load: Load,
    /// Whether the least force is sought, from the load on.
    pub pull_off: bool,
    /// The start without a state.
    pub start: Start,
    /// The state to start from.
    pub state: Option<State<'a>>,
    /// Whether dF/dapproach is computed.
    pub stiffness: bool,
    /// Whether the distance of the state from a snap is computed.
    pub stability: bool,
    /// The tolerance of each measure.
    pub tolerance: f64,
    /// Most cycles on the finest grid.
    pub max_cycles: u64,
}
