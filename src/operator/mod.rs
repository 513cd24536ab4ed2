//! The operator of the contact problem, `u = A p`: products by FFT, and the inverse of a circulant as a preconditioner.

mod circulant;
pub mod dense;
#[allow(clippy::module_inception)]
mod operator;
mod periods;
mod workspace;

pub(crate) use crate::memory::{reserve, zeros};
pub use operator::Operator;
pub(crate) use periods::even_periods;
pub use periods::Reach;
pub use toeplitz::fft;
pub use toeplitz::fft::{length_for_stages, row_transform};
pub use toeplitz::SetUp;
pub use workspace::{Needs, Workspace};

/// The precision of the iteration inside a method. Results and certificates are always computed in double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// The precision that is faster.
    #[default]
    Auto,
    /// Double precision throughout.
    Double,
    /// Single precision for the iteration, in the methods that support it.
    Mixed,
}
