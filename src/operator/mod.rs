//! The operator of the contact problem: `u = A p`.

#[allow(unsafe_code)] // the kernel
pub mod columns;
pub mod dense;
pub mod fft;
mod patches;
mod row_tables;
mod toeplitz;

pub(crate) use crate::memory::{reserve, zeros};
pub use toeplitz::{Toeplitz, Workspace};

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
