//! Fourier transforms of rows and columns. Any length is transformed by rustfft. Lengths `2^a 3^b 5^c` also have stages of this crate, which
//! transform one row or column in each SIMD lane.

pub(crate) mod any_length;
pub(crate) mod butterflies;
pub(crate) mod column_pass;
pub(crate) mod even_plan;
pub(crate) mod factors;
pub(crate) mod lane_columns;
pub(crate) mod lane_passes;
pub(crate) mod lane_rows;
pub(crate) mod lanes;
pub(crate) mod row_pass;
pub(crate) mod row_plan;
pub mod row_transform;
pub(crate) mod stage_plan;
pub(crate) mod stages;

pub use crate::lengths::{good_length, length_for_stages};
pub use crate::passes::Real;
pub use crate::real::Complex;
pub use any_length::ColumnTransform;
