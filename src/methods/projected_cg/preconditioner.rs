//! The preconditioner: the inverse of a circulant near A; where A has a diagonal of its own, a mix of several.
//!
//! ```text
//! M = sum over levels c_l of W_l (A + c_l)^-1 W_l
//! ```
//!
//! W_l, diagonal, picks the elements whose compliance is near c_l (see [`Layer::levels`](crate::influence::Layer::levels)), so that
//! M is symmetric and positive definite.

use super::extension::Extension;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::memory::computed;
use crate::operator::fft::Real;
use crate::operator::{zeros, Operator, Workspace};
use crate::threads::Threads;

/// One circulant, and its weights; none: 1.
struct Part<T: Real> {
    inverse: Operator<T>,
    weights: Vec<T>,
}

/// M, and the memory that a mix needs.
pub struct Preconditioner<T: Real> {
    parts: Vec<Part<T>>,
    /// Of a mix: r, a term of the sum, and M 1.
    right: Vec<T>,
    term: Vec<T>,
    unit: Vec<T>,
}

impl<T: Real> Preconditioner<T> {
    /// Of an operator, the coefficients of which are taken times `factor`; none if the circulant is not positive.
    pub fn new(
        influence: &Coefficients,
        factor: f64,
        grid: &Grid,
        threads: &Threads,
    ) -> Result<Option<Preconditioner<T>>> {
        let mut parts = Vec::new();
        for (influence, weights) in influence.levels()? {
            let period = Operator::<T>::circulant_period(&influence, grid);
            let Some(inverse) = Operator::scaled_inverse(&influence, factor, grid, period, threads)? else {
                return Ok(None);
            };
            parts.push(Part { inverse, weights: computed(weights.into_iter().map(T::of), "the preconditioner")? });
        }
        let mixed = if parts[0].weights.is_empty() { 0 } else { grid.len() };
        let memory = || zeros(mixed, "the preconditioner");
        Ok(Some(Preconditioner { right: memory()?, term: memory()?, unit: memory()?, parts }))
    }

    /// An operator, the workspace of which products by M need.
    pub fn inverse(&self) -> &Operator<T> {
        &self.parts[0].inverse
    }

    /// z = E^T M E z, z being zero outside C, by the extension E. With a prescribed force a mix is no multiple of 1 on a uniform
    /// residual, so that the approach, that is the residual's constant, is chosen such that z has mean zero:
    /// `z = M z - (1, M z)/(1, M 1) M 1`.
    pub fn apply(
        &mut self,
        z: &mut Vec<T>,
        (contact, by_force): (&[bool], bool),
        extension: &mut Extension<T>,
        workspace: &mut Workspace<T>,
    ) {
        let Preconditioner { parts, right, term, unit } = self;
        if right.is_empty() {
            return extension.around(z, contact, |z| parts[0].inverse.apply_in_place(z, workspace));
        }
        extension.around(z, contact, |z| mix(parts, z, workspace, [right, term]));
        if !by_force {
            return;
        }
        unit.iter_mut().zip(contact).for_each(|(unit, &inside)| *unit = if inside { T::one() } else { T::zero() });
        extension.around(unit, contact, |unit| mix(parts, unit, workspace, [right, term]));
        let sum = |values: &[T]| -> f64 {
            values.iter().zip(contact).map(|(value, &inside)| if inside { value.to_double() } else { 0.0 }).sum()
        };
        let amount = T::of(sum(z) / sum(unit));
        z.iter_mut().zip(&*unit).for_each(|(z, unit)| *z = *z - amount * *unit);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let parts: usize = self.parts.iter().map(|part| part.inverse.bytes() + size_of_val(&part.weights[..])).sum();
        parts + 3 * size_of_val(&self.right[..])
    }
}

/// z = M z of a mix.
fn mix<T: Real>(parts: &[Part<T>], z: &mut [T], workspace: &mut Workspace<T>, [right, term]: [&mut [T]; 2]) {
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
