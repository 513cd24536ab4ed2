//! The result on one grid.

use super::outlook::Outlook;
use crate::solver::{Report, Solver};

/// The result on one grid.
pub(super) struct Solved {
    pub(super) solver: Solver,
    pub(super) report: Report,
    pub(super) outlook: Outlook,
}
