//! Projected, preconditioned conjugate gradients. They solve the whole problem on one grid, and are the fastest method known for it. Nested iteration
//! calls them on each grid.

mod along;
mod coarse_grids;
mod deflation;
mod deflation_passes;
mod energy;
mod exchange;
mod find_force;
mod flat_punch;
mod formulas;
mod inner;
mod iteration;
mod level;
mod level_task;
mod limits;
mod mean_gap;
mod part;
mod passes;
mod preconditioner;
mod predictor;
mod punches;
mod scaling;
mod search;
mod segments;
mod step;
mod step_sums;
mod truncation;
mod uniform;
mod vectors;
mod window;

pub use coarse_grids::shift_to_mean;
pub use iteration::{Cycle, End};
pub use preconditioner::Preconditioner;
pub use predictor::Predictor;
pub use step::ProjectedCg;
pub use vectors::Iteration;
