//! Projected, preconditioned conjugate gradients: the fastest way known to solve the whole problem on one grid, under nested
//! iteration over the grids.

mod iteration;
mod preconditioner;
mod runs;
mod window;

pub use iteration::{Cycle, End, Iteration, Stopping};
pub use window::Window;
