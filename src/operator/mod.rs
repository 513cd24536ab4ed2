//! The operator of the contact problem: `u = A p`.

pub mod columns;
pub mod dense;
pub mod fft;
mod toeplitz;

pub use toeplitz::{Toeplitz, Workspace};
pub(crate) use toeplitz::zeros;
