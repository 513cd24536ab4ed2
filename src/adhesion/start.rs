//! The options for the start of a solve without an initial state.

/// Where a solve without an initial state starts. This matters because several states may belong to one approach. The option is read only if the
/// approach is given; with a given force the solve uses `Auto`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// First solves the coarsest grid, on which the range of the attraction is longest. The first step there has no attraction. Each finer grid
    /// starts from the solution of the coarser one.
    #[default]
    Auto,
    /// First solves the coarsest grid for a larger approach, and then decreases the approach to the given one, so that elements in contact tend
    /// to stay in contact.
    Contact,
    /// Solves the finest grid alone, from bodies without pressures, so that elements come into contact only if there is no nearer state in which
    /// they are apart.
    Apart,
}
