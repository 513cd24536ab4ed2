//! The result on one grid.

use super::outlook::{Outlook, Values};
use crate::solver::{Report, Solver};

/// The result on one grid.
pub(super) struct Solved {
    pub(super) solver: Solver,
    pub(super) report: Report,
    pub(super) outlook: Outlook,
    pub(super) values: Values,
}
