//! `contact_normal_progress`: the state of a solve, for the progress callback.

use super::ledger::copy;
use crate::solver::Progress;

/// The state of a solve after a cycle, for the progress callback.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub struct contact_normal_progress {
    /// The size of this struct in the library.
    pub struct_size: i64,
    /// Elements in x of the grid of the last cycle.
    pub mx: i32,
    /// Elements in y of that grid.
    pub my: i32,
    /// Cycles on that grid so far. The callback is also called after iterations of the tangential problem and, with adhesion, of coarser grids;
    /// these do not count.
    pub cycles: i64,
    /// Elements that the last cycle moved between contact area, exterior area and pressure limit.
    pub active_set_changes: i64,
    /// Seconds since the solve began.
    pub seconds: f64,
    /// Work units since the solve began.
    pub work_units: f64,
    /// rms over C of the last change of p.
    pub update: f64,
    /// Relative residual over C, as far as it is known.
    pub residual: f64,
}

impl From<&Progress> for contact_normal_progress {
    fn from(progress: &Progress) -> Self {
        let mut to = Self { struct_size: size_of::<Self>() as i64, ..Self::default() };
        copy!(progress => to: mx, my, cycles, active_set_changes, seconds, work_units, update, residual);
        to
    }
}
