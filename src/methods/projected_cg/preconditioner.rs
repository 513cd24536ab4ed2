//! The preconditioner: the inverse of a circulant near A. If A contains the diagonal of a layer, it is a mix of several inverses.
//!
//! ```text
//! M = sum over levels c_l of W_l (A + c_l)^-1 W_l
//! ```
//!
//! The diagonal matrix W_l selects the elements whose compliance is near c_l (see [`Layer::levels`](crate::influence::Layer::levels)), so that M is
//! symmetric and positive definite. It is applied as E^T M E (module [`extension`](crate::methods::extension)), with a separate E for each level.

use super::punches::Punches;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::memory::computed;
use crate::methods::extension::Extension;
use crate::operator::fft::Real;
use crate::operator::{zeros, Operator, Workspace};
use crate::threads::Threads;

/// One circulant and its weights. Without weights they are 1.
struct Part<T: Real> {
    inverse: Operator<T>,
    weights: Vec<T>,
    /// An element's coefficient on itself, relative to that without a layer.
    compliance: f64,
}

/// M, and the memory that a mix needs.
pub struct Preconditioner<T: Real> {
    parts: Vec<Part<T>>,
    /// For a mix: r, a term of the sum, and M 1.
    right: Vec<T>,
    term: Vec<T>,
    unit: Vec<T>,
    /// The flat punches of a line in plane strain.
    punches: Option<Punches>,
    /// Whether the punches are in use.
    has_punches: bool,
}

impl<T: Real> Preconditioner<T> {
    /// The preconditioner of an operator whose coefficients are multiplied by `factor`. None if the circulant is not positive.
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

    /// An operator that determines the workspace of products by M.
    pub fn inverse(&self) -> &Operator<T> {
        &self.parts[0].inverse
    }

    /// Whether it treats the components of C as flat punches.
    pub(super) fn has_punches(&self) -> bool {
        self.has_punches
    }

    /// Treats the components of C as flat punches from now on, for a line in plane strain. With a prescribed approach it does not if a punch may
    /// displace nothing. Returns whether this is a change.
    pub(super) fn use_punches(&mut self, by_approach: bool) -> bool {
        let serves = |punches: &Punches| !(by_approach && punches.is_mean_free());
        let before = std::mem::replace(&mut self.has_punches, self.punches.as_ref().is_some_and(serves));
        before != self.has_punches
    }

    /// For a line in plane strain: finds the components of a new C.
    pub(super) fn find_pieces(&mut self, contact: &[bool]) {
        self.punches.iter_mut().filter(|_| self.has_punches).for_each(|punches| punches.find(contact));
    }

    /// For a line in plane strain: sets d to the pressure of a flat punch on the last C, with mean 1 there.
    pub(super) fn press_flat(&mut self, d: &mut [T]) {
        self.punches.iter_mut().for_each(|punches| punches.press_flat(d));
    }

    /// z = E^T M E z, z being zero outside C. Directions carry no force. A mix maps a uniform residual to a field that is not
    /// uniform. So the residual's constant (with a prescribed force, the approach) is chosen such that z has mean zero:
    /// `z = M z - (1, M z)/(1, M 1) M 1`.
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

    /// z = M z, without an extension of residuals beyond C.
    pub fn apply_alone(&mut self, z: &mut [T], workspace: &mut Workspace<T>) {
        let Preconditioner { parts, right, term, .. } = self;
        match &parts[..] {
            [Part { inverse, weights, .. }] if weights.is_empty() => inverse.apply_in_place(z, workspace),
            _ => mix(parts, z, &mut None, workspace, (right, term)),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let parts: usize = self.parts.iter().map(|part| part.inverse.bytes() + size_of_val(&part.weights[..])).sum();
        parts + 3 * size_of_val(&self.right[..]) + self.punches.as_ref().map_or(0, Punches::bytes)
    }
}

/// z = M z for a mix. Each term has its own extension.
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

/// z = E^T M E z. Without an extension z = M z.
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
