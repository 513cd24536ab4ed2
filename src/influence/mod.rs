//! Influence coefficients: the displacement at the centre of element I by a unit pressure on element J.
//!
//! ```text
//! A_IJ = F(patch of I, patch of J) c(ix - jx, iy - jy) + [I = J] c_I
//!        coupling                  kernel               diagonal
//! ```
//!
//! [`Coefficients`] is this sum. The kernel depends on the offset only, so that A is block Toeplitz: it is that of the elastic half-space
//! ([`HalfSpace`]), of bodies with coatings ([`Coated`]), the sum over all images of a periodic scene ([`Periodic`]), or the caller's table
//! ([`Table`], without assumptions). [`RowTables`] are Toeplitz in x only: their [`Kernel::at`] is a mean over rows. The diagonal is a compliant
//! [`Layer`], the coupling that of contact [`Patches`]; a plain scene has neither.

mod coated;
mod coefficients;
mod diagonal;
mod extremes;
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
pub(crate) use table::LARGEST_RATIO;
