//! The preconditioner M: the inverse of a circulant near A. If elements have a layer of different compliances, M is a sum of several inverses:
//!
//! ```text
//! M = sum over levels c_l of W_l (A + c_l)^-1 W_l
//! ```
//!
//! A is here the circulant without the layer. The diagonal matrix W_l selects the elements whose compliance is near c_l (see
//! [`Layer::levels`](crate::influence::Layer::levels)), so that M is symmetric and positive definite. M is applied as E^T M E (module
//! [`extension`](crate::methods::extension)), with a separate E for each level.

use super::punches::Punches;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::memory::computed;
use crate::methods::extension::Extension;
use crate::operator::fft::Real;
use crate::operator::{zeros, Operator, Workspace};
use crate::threads::Threads;

/// One term of the sum M.
struct Part<T: Real> {
    /// The inverse of the circulant A + c_l.
    inverse: Operator<T>,
    /// The diagonal of W_l. Empty: all weights are 1.
    weights: Vec<T>,
    /// An element's influence on itself with the layer, relative to that without.
    compliance: f64,
}

/// The preconditioner M, and the memory that a sum of several inverses needs.
pub struct Preconditioner<T: Real> {
    parts: Vec<Part<T>>,
    /// For a sum: the residual r.
    right: Vec<T>,
    /// For a sum: one of its terms.
    term: Vec<T>,
    /// For a sum: the product M 1, where 1 is 1 on C.
    unit: Vec<T>,
    /// The flat punches of a line in plane strain.
    punches: Option<Punches>,
    /// Whether the punches are in use.
    has_punches: bool,
}

impl<T: Real> Preconditioner<T> {
    /// Sets up the preconditioner of an operator whose coefficients are multiplied by `factor`. None if a circulant is not positive definite.
    pub fn new(
        coefficients: &Coefficients,
        factor: f64,
        grid: &Grid,
        threads: &Threads,
    ) -> Result<Option<Preconditioner<T>>> {
        let mut parts = Vec::new();
        for (coefficients, weights) in coefficients.levels()? {
            let period = Operator::<T>::circulant_period(&coefficients, grid);
            let Some(inverse) = Operator::scaled_inverse(&coefficients, factor, grid, period, threads)? else {
                return Ok(None);
            };
            let weights = computed(weights.into_iter().map(T::of), "the preconditioner")?;
            parts.push(Part { inverse, weights, compliance: coefficients.typical_compliance() });
        }
        let mixed = if parts[0].weights.is_empty() { 0 } else { grid.len() };
        let memory = || zeros(mixed, "the preconditioner");
        let punches = if mixed == 0 { Punches::if_plane_strain(coefficients, factor, grid)? } else { None };
        Ok(Some(Preconditioner {
            right: memory()?,
            term: memory()?,
            unit: memory()?,
            has_punches: punches.is_some(),
            punches,
            parts,
        }))
    }

    /// One of the inverses. A workspace for it serves all products by M.
    pub fn inverse(&self) -> &Operator<T> {
        &self.parts[0].inverse
    }

    /// Whether the preconditioner treats the pieces of C as flat punches.
    pub(super) fn has_punches(&self) -> bool {
        self.has_punches
    }

    /// On a line in plane strain: treats the pieces of C as flat punches from now on, or no longer if `by_approach` and a uniform pressure displaces
    /// nothing. Returns whether this is a change.
    pub(super) fn use_punches(&mut self, by_approach: bool) -> bool {
        let serves = |punches: &Punches| !(by_approach && punches.is_mean_free());
        let before = std::mem::replace(&mut self.has_punches, self.punches.as_ref().is_some_and(serves));
        before != self.has_punches
    }

    /// On a line in plane strain: finds the pieces of a new C.
    pub(super) fn find_pieces(&mut self, contact: &[bool]) {
        self.punches.iter_mut().filter(|_| self.has_punches).for_each(|punches| punches.find(contact));
    }

    /// On a line in plane strain: sets d to the pressure of a flat punch on the last C, with the mean 1 on C.
    pub(super) fn press_flat(&mut self, d: &mut [T]) {
        self.punches.iter_mut().for_each(|punches| punches.press_flat(d));
    }

    /// Replaces z by E^T M E z on C; z is zero outside C.
    ///
    /// If directions carry no force (`without_force`), the caller subtracts the mean of the result. A sum of several inverses, however, maps a
    /// uniform residual to a field that is not uniform. Then a constant is subtracted from the residual instead (with a prescribed force, a change of
    /// the approach), such that the result has the mean zero: `z = M z - (1, M z)/(1, M 1) M 1`.
    pub fn apply(
        &mut self,
        z: &mut Vec<T>,
        (contact, without_force): (&[bool], bool),
        extension: &mut Option<Extension<T, 1>>,
        workspace: &mut Workspace<T>,
    ) {
        let Preconditioner { parts, right, term, unit, punches, has_punches } = self;
        if let [Part { inverse, weights, compliance }] = &parts[..] {
            if let Some(punches) = punches.as_mut().filter(|_| *has_punches) {
                punches.take_means(z);
                inverse.apply_in_place(z, workspace);
                return punches.give_forces(z, without_force);
            }
            if weights.is_empty() {
                return extended(extension, z, *compliance, |z| inverse.apply_in_place(z, workspace));
            }
        }
        mix(parts, z, extension, workspace, (right, term));
        if !without_force {
            return;
        }
        unit.iter_mut().zip(contact).for_each(|(unit, &inside)| *unit = if inside { T::one() } else { T::zero() });
        mix(parts, unit, extension, workspace, (right, term));
        let sum = |values: &[T]| -> f64 {
            values.iter().zip(contact).map(|(value, &inside)| if inside { value.to_double() } else { 0.0 }).sum()
        };
        let amount = T::of(sum(z) / sum(unit));
        z.iter_mut().zip(&*unit).for_each(|(z, unit)| *z = *z - amount * *unit);
    }

    /// Replaces z by M z, without an extension of residuals beyond C.
    pub fn apply_alone(&mut self, z: &mut [T], workspace: &mut Workspace<T>) {
        let Preconditioner { parts, right, term, .. } = self;
        match &parts[..] {
            [Part { inverse, weights, .. }] if weights.is_empty() => inverse.apply_in_place(z, workspace),
            _ => mix(parts, z, &mut None, workspace, (right, term)),
        }
    }

    /// Bytes of the inverses, the weights and the memory of a sum.
    pub fn bytes(&self) -> usize {
        let parts: usize = self.parts.iter().map(|part| part.inverse.bytes() + size_of_val(&part.weights[..])).sum();
        parts + 3 * size_of_val(&self.right[..]) + self.punches.as_ref().map_or(0, Punches::bytes)
    }
}

/// Replaces z by E^T M E z for a sum of several inverses. Each term has a separate extension.
fn mix<T: Real>(
    parts: &[Part<T>],
    z: &mut [T],
    extension: &mut Option<Extension<T, 1>>,
    workspace: &mut Workspace<T>,
    (right, term): (&mut [T], &mut Vec<T>),
) {
    right.copy_from_slice(z);
    z.fill(T::zero());
    for Part { inverse, weights, compliance } in parts {
        for ((term, r), w) in term.iter_mut().zip(&*right).zip(weights) {
            *term = *r * *w;
        }
        extended(extension, term, *compliance, |term| inverse.apply_in_place(term, workspace));
        for ((z, term), w) in z.iter_mut().zip(&*term).zip(weights) {
            *z += *term * *w;
        }
    }
}

/// Replaces z by E^T M E z, where `apply` applies M. Without an extension, E is 1.
fn extended<T: Real>(
    extension: &mut Option<Extension<T, 1>>,
    z: &mut Vec<T>,
    compliance: f64,
    apply: impl FnOnce(&mut [T]),
) {
    match extension {
        Some(extension) => extension.around(z, compliance, apply),
        None => apply(z),
    }
}
