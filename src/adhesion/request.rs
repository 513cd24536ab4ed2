//! A request.

use super::levels::Surfaces;
use crate::scene::Load;

/// Where a solve from nothing begins: several states may belong to one approach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// On coarser grids with longer ranges, from the contact without attraction.
    #[default]
    Auto,
    /// From a larger approach: what is in contact stays so.
    Contact,
    /// From bodies apart: what is not in contact does not snap in before it must.
    Apart,
}

/// A state to go on from.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    /// Total pressures; none: those that were lent.
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
    /// Whether the least force is to be found, from the load on.
    pub pull_off: bool,
    /// Where it begins, if there is no state.
    pub start: Start,
    /// Where it goes on from.
    pub state: Option<State<'a>>,
    /// Whether dF/dapproach is asked for.
    pub stiffness: bool,
    /// Whether it is asked for how near the state is to a snap.
    pub stability: bool,
    /// Of each measure.
    pub tolerance: f64,
    /// Cycles on the finest grid at most.
    pub max_cycles: u64,
}
