//! Influence coefficients: the displacement at the centre of element I by a unit pressure on element J.
//!
//! ```text
//! A_IJ = F(patch of I, patch of J) c(ix - jx, iy - jy) + [I = J] c_I
//!        coupling                  kernel               diagonal
//! ```
//!
//! [`Coefficients`] is this sum. The kernel depends only on the offset between the elements, so that A is block Toeplitz. There are these
//! kernels:
//!
//! * [`HalfSpace`]: the elastic half-space;
//! * [`Coated`] and [`CoatedPeriodic`]: bodies with coatings, without and with two periods;
//! * [`Periodic`]: the half-space's coefficients, summed over all images of a periodic scene;
//! * [`Table`]: the caller's coefficients, without any assumption;
//! * [`RowTables`]: the caller's coefficients for each loaded row. A is Toeplitz in x only, and [`Kernel::at`] is a mean over the rows.
//!
//! The diagonal is a compliant [`Layer`], and the coupling holds the factors between contact [`Patches`]. A plain scene has neither.

mod coated;
mod coefficients;
mod diagonal;
mod gauss;
mod given;
mod half_space;
mod images;
mod kernel;
pub(crate) mod means;
mod patches;
mod periodic;
mod row_tables;
pub mod special;
mod table;
mod table_properties;

pub use coated::{radial, Across, Along, Base, Coat, Coated, CoatedBody, CoatedPeriodic, Radial, Response, Transfer};
pub use coefficients::Coefficients;
pub use diagonal::Layer;
pub(crate) use gauss::{gauss, gauss_each, rule};
pub use half_space::HalfSpace;
pub(crate) use half_space::{integral_at, MOST_TERMS, SERIES};
pub use kernel::Kernel;
pub use patches::Patches;
pub use periodic::Periodic;
pub use row_tables::RowTables;
pub use table::Table;
pub(crate) use table::{offset_beyond, LARGEST_RATIO};
