//! The original algorithm, Kalker's NORM (section 3 of the paper): an active set, and conjugate gradients inside.
//!
//! 1. Start from a contact area.
//! 2. Solve `h - approach + A p = 0` on it, `p = 0` outside, by conjugate gradients from `p = 0`.
//! 3. Elements with `p < 0` leave, exterior elements with `e < 0` enter.
//! 4. Repeat until the contact area stays.

mod conjugate_gradients;
mod minimal_residual;
mod step;

pub use conjugate_gradients::{conjugate_gradients, InnerStop};
pub use minimal_residual::minimal_residual;
pub use step::Norm;

use crate::error::Result;
use crate::memory::reserve;

/// Memory for inner solves, kept from one to the next.
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
        (self.residual.len() + self.direction.len() + self.product.len()) * size_of::<f64>()
    }

    /// Memory for conjugate gradients on n elements.
    pub(crate) fn reserve(&mut self, n: usize) -> Result<()> {
        for values in [&mut self.residual, &mut self.direction, &mut self.product] {
            reserve(values, n, "NORM's workspace")?;
        }
        Ok(())
    }
}
