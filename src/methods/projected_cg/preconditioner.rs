//! The preconditioner: the inverse of a circulant near A; where A has a diagonal of its own, a mix of several.
//!
//! ```text
//! M = sum over levels c_l of W_l (A + c_l)^-1 W_l
//! ```
//!
//! W_l, diagonal, picks the elements whose compliance is near c_l (see [`Layered::levels`](crate::influence::Layered::levels)), so that
//! M is symmetric and positive definite.

use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Influence;
use crate::operator::fft::Real;
use crate::operator::{zeros, Toeplitz, Workspace};
use crate::threads::Threads;

/// One circulant, and its weights; none: 1.
struct Part<T: Real> {
    inverse: Toeplitz<T>,
    weights: Vec<T>,
}

/// M, and the memory that it needs.
pub struct Preconditioner<T: Real> {
    parts: Vec<Part<T>>,
    workspace: Workspace<T>,
    /// Of a mix: r, a term of the sum, and M 1.
    right: Vec<T>,
    term: Vec<T>,
    unit: Vec<T>,
}

impl<T: Real> Preconditioner<T> {
    /// Of an operator; none if the circulant is not positive.
    pub fn new(influence: &Influence, grid: &Grid, threads: &Threads) -> Result<Option<Preconditioner<T>>> {
        let levels = match influence {
            Influence::Layered(layered) if layered.more().is_some() => layered.levels(),
            plain => vec![(plain.clone(), Vec::new())],
        };
        let mut parts = Vec::new();
        for (influence, weights) in levels {
            let period = Toeplitz::<T>::circulant_period(&influence, grid);
            let Some(inverse) = Toeplitz::inverse_circulant(&influence, grid, period, threads)? else {
                return Ok(None);
            };
            parts.push(Part { inverse, weights: weights.into_iter().map(T::of).collect() });
        }
        let mixed = if parts[0].weights.is_empty() { 0 } else { grid.len() };
        let memory = || zeros(mixed, "the preconditioner");
        Ok(Some(Preconditioner {
            workspace: parts[0].inverse.workspace()?,
            right: memory()?,
            term: memory()?,
            unit: memory()?,
            parts,
        }))
    }

    /// z = M z. With a prescribed force `carried_by` is the contact area: a mix is no multiple of 1 on a uniform residual, so that
    /// the approach, that is the residual's constant, is chosen such that z has mean zero: `z = M z - (1, M z)/(1, M 1) M 1`.
    pub fn apply(&mut self, z: &mut [T], carried_by: Option<&[bool]>) {
        if self.right.is_empty() {
            return self.parts[0].inverse.apply_in_place(z, &mut self.workspace);
        }
        self.mix(z);
        let Some(contact) = carried_by else { return };
        let mut unit = std::mem::take(&mut self.unit);
        unit.iter_mut().zip(contact).for_each(|(unit, &inside)| *unit = if inside { T::one() } else { T::zero() });
        self.mix(&mut unit);
        let sum = |values: &[T]| -> f64 {
            values.iter().zip(contact).map(|(value, &inside)| if inside { value.to_double() } else { 0.0 }).sum()
        };
        let amount = T::of(sum(z) / sum(&unit));
        z.iter_mut().zip(&unit).for_each(|(z, unit)| *z = *z - amount * *unit);
        self.unit = unit;
    }

    /// z = M z of a mix.
    fn mix(&mut self, z: &mut [T]) {
        let Preconditioner { parts, workspace, right, term, .. } = self;
        right.copy_from_slice(z);
        z.fill(T::zero());
        for part in parts {
            for ((term, r), w) in term.iter_mut().zip(&*right).zip(&part.weights) {
                *term = *r * *w;
            }
            part.inverse.apply_in_place(term, workspace);
            for ((z, term), w) in z.iter_mut().zip(&*term).zip(&part.weights) {
                *z += *term * *w;
            }
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let parts: usize = self.parts.iter().map(|part| part.inverse.bytes() + size_of_val(&part.weights[..])).sum();
        parts + self.workspace.bytes() + 3 * size_of_val(&self.right[..])
    }
}
