//! Projected, preconditioned conjugate gradients: the fastest way known to solve the whole problem on one grid, under nested
//! iteration over the grids.

mod boxes;
mod cells;
mod coarse_grids;
mod debts;
mod deflation;
mod energy;
mod exchange;
mod extension;
mod formulas;
mod inner;
mod iteration;
mod known;
mod known_passes;
mod level;
mod limits;
mod part;
mod passes;
mod preconditioner;
mod predictor;
mod scaling;
mod search;
mod segments;
mod step;
mod vectors;
mod window;

pub use iteration::{Cycle, End};
pub use predictor::Predictor;
pub use step::ProjectedCg;
pub use vectors::Iteration;
pub use window::Window;
