//! The original algorithm, Kalker's NORM (section 3 of the paper): an active-set method whose equations are solved by conjugate gradients.
//!
//! 1. Start from a contact area C.
//! 2. Solve `h - approach + A p = 0` on C, with `p = 0` outside, by conjugate gradients from `p = 0` (the *inner solve*).
//! 3. Elements with `p < 0` leave C, and exterior elements with `e < 0` enter C.
//! 4. Repeat steps 2 and 3 until C no longer changes.

mod conjugate_gradients;
mod minimal_residual;
mod step;

pub use conjugate_gradients::{conjugate_gradients, InnerStop};
pub use minimal_residual::minimal_residual;
pub use step::Norm;

use crate::error::Result;
use crate::memory::reserve;

/// The memory of inner solves. The next inner solve reuses it.
#[derive(Default)]
pub struct Workspace {
    residual: Vec<f64>,
    direction: Vec<f64>,
    product: Vec<f64>,
    krylov: minimal_residual::Krylov,
}

impl Workspace {
    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        (self.residual.len() + self.direction.len() + self.product.len()) * size_of::<f64>() + self.krylov.bytes()
    }

    /// Allocates memory for conjugate gradients on n elements.
    pub(crate) fn reserve(&mut self, n: usize) -> Result<()> {
        for values in [&mut self.residual, &mut self.direction, &mut self.product] {
            reserve(values, n, "NORM's workspace")?;
        }
        Ok(())
    }
}
