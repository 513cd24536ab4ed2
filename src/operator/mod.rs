//! The operator of the contact problem: `u = A p`.

mod butterflies;
mod circulant;
#[allow(unsafe_code)] // the kernel
pub mod columns;
mod convolution;
pub mod dense;
mod even_columns;
mod even_plan;
pub mod fft;
mod half_stages;
mod lane_passes;
mod lane_rows;
mod lanes;
#[allow(clippy::module_inception)]
mod operator;
mod periods;
mod row_tables;
pub mod row_transform;
mod rows;
mod set_up;
mod set_up_columns;
mod set_up_lanes;
mod spectrum;
mod stage_plan;
mod stages;
mod workspace;

pub(crate) use crate::memory::{reserve, zeros};
pub use operator::Operator;
pub(crate) use periods::even_periods;
pub use periods::Reach;
pub use set_up::SetUp;
pub use stage_plan::length_for_stages;
pub use workspace::{Needs, Workspace};

/// Arithmetic of the inner work; results are always computed in double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// Whichever is faster.
    #[default]
    Auto,
    /// Double precision throughout.
    Double,
    /// Single precision inside, where it helps.
    Mixed,
}
