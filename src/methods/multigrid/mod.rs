//! The multigrid method (section 4.2 of the paper): grids, transfers between them, smoothers, and the V-cycle.

mod coarsest;
mod cycle;
mod hierarchy;
pub mod smoother;
mod step;
pub mod transfer;

pub use cycle::{CycleShape, Multigrid};
pub use hierarchy::{coarsen, Level};
pub use smoother::SmootherKind;
pub use step::{Cycles, Workspace};
