//! The result of a search on one grid.

use super::outlook::{Outlook, Values};
use crate::solver::{Report, Solver};

/// The result of a search on one grid.
pub(super) struct Solved {
    /// The solver of the grid, with its result.
    pub(super) solver: Solver,
    /// The report of the solve.
    pub(super) report: Report,
    /// The errors of the result and their decrease on finer grids.
    pub(super) outlook: Outlook,
    /// The values of the wanted quantities.
    pub(super) values: Values,
}
