//! `contact_normal_progress`: the state that the progress callback gets.

use super::ledger::copy;
use crate::solver::Progress;

/// The state of a solve after a cycle, for the progress callback.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub struct contact_normal_progress {
    /// Size of this struct in the library.
    pub struct_size: i64,
    /// Elements in x of the grid that the cycle was on.
    pub mx: i32,
    /// Elements in y.
    pub my: i32,
    /// Cycles on that grid so far. Iterations of the tangential problem, and with adhesion those on coarser grids, are told but not counted.
    pub cycles: i64,
    /// Elements that changed sides in the last cycle.
    pub active_set_changes: i64,
    /// Seconds since the solve began.
    pub seconds: f64,
    /// Work units since then.
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
