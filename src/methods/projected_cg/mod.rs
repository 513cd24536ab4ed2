//! Projected, preconditioned conjugate gradients: the production method. It solves for pressures and contact area together (module `iteration`), and
//! is the fastest method of this library. Nested iteration uses it on each grid (module `coarse_grids`).

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
