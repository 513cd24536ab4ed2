//! The Newton direction: some preconditioned conjugate gradients of `A t = -e` on the free elements.
//!
//! By approach with two periods a uniform pressure displaces nothing on all elements, and little on nearly all of them: conjugate gradients
//! would take many iterations for the mean of t. So the uniform direction comes first, and all others are conjugate to it:
//!
//! ```text
//! t = a 1 on the free elements,   a = (1, r)/(1, A 1)
//! ```

use super::{dot, ProjectedNewton};
use crate::contact::{norm_of_distance, relative, AdmissibleSet};
use crate::error::Result;
use crate::methods::Task;
use crate::scene::Load;
use crate::sums::in_blocks;

/// Residual of a direction, relative to e on the free elements. The set of free elements changes before more accuracy
/// pays.
const RESIDUAL_RATIO: f64 = 0.25;
/// A residual of a direction that begins above this share of the wanted residual is not reduced below it.
const WANTED_RESIDUAL_SHARE: f64 = 0.3;
/// A uniform pressure displaces nothing if its displacement is below this part of that of each element by itself: on
/// all elements its displacement is round-off, on all but one it is as large as that of the missing one.
const ROUND_OFF: f64 = 1e-10;
/// If a uniform pressure displaces nothing, t is computed as if it displaced this share of the elements' own
/// displacement. But t reaches at least the nearest bound.
const ASSUMED_DISPLACEMENT: f64 = 1e-2;

impl ProjectedNewton {
    /// Finds t.
    pub(super) fn find_direction<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<()> {
        let by_force = matches!(task.state.load, Load::Force(_));
        self.t.fill(0.0);
        for ((r, e), &free) in self.r.iter_mut().zip(&self.distance).zip(&self.free) {
            *r = if free { -e } else { 0.0 };
        }
        let (uniform, is_free) = if by_force { (0.0, true) } else { self.begin_uniformly(task)? };
        // The rest of t has mean zero.
        let without_mean = by_force || is_free;
        let scale = norm_of_distance(task.state);
        let (mut target, mut last_rz) = (0.0, 0.0);
        for k in 0..self.most {
            if without_mean {
                remove_mean(&mut self.r, &self.free);
            }
            let norm = dot(&self.r, &self.r).sqrt();
            if k == 0 {
                // A few violating elements may have a residual below the one allowed in C. Their equations are solved nevertheless.
                let needed = WANTED_RESIDUAL_SHARE * task.goal.tolerance * scale;
                target = if norm > needed { needed.max(RESIDUAL_RATIO * norm) } else { RESIDUAL_RATIO * norm };
            }
            if !(norm > target) || task.is_interrupted() {
                break;
            }
            let rz = self.precondition(without_mean, uniform);
            let beta = if k == 0 { 0.0 } else { rz / last_rz };
            last_rz = rz;
            for (along, z) in self.along.iter_mut().zip(&self.z) {
                *along = z + if k == 0 { 0.0 } else { beta * *along };
            }
            task.problem.displace(&self.along, &mut self.along_product)?;
            let curvature = dot(&self.along, &self.along_product);
            if !(curvature > 0.0) {
                break;
            }
            self.advance(rz / curvature);
            let size = dot(&self.along, &self.along).sqrt() * rz / curvature;
            let update = size / (task.state.contact_count().max(1) as f64).sqrt();
            task.count_products();
            if !task.monitor.cycle_done(&task.state.grid, 0, update, relative(norm, scale)) {
                break;
            }
        }
        Ok(())
    }

    /// Makes t uniform if that is needed. Returns (1, A 1), or its assumed value, or 0 if t stays 0; and whether a
    /// uniform pressure displaces nothing.
    fn begin_uniformly<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<(f64, bool)> {
        let count = self.free.iter().filter(|free| **free).count();
        if !task.problem.coefficients.is_mean_free() || 2 * count <= self.free.len() {
            return Ok((0.0, false));
        }
        for (along, &free) in self.along.iter_mut().zip(&self.free) {
            *along = f64::from(u8::from(free));
        }
        task.problem.displace(&self.along, &mut self.along_product)?;
        let alone = task.problem.self_influence() * count as f64;
        let work = dot(&self.along, &self.along_product);
        let is_free = work < ROUND_OFF * alone;
        let displaced = if is_free { ASSUMED_DISPLACEMENT * alone } else { work };
        self.uniform_product.copy_from_slice(&self.along_product);
        let mut amount = in_blocks(self.r.iter().copied()) / displaced;
        if is_free && amount != 0.0 {
            let room = self.room(&task.state.p, task.set, amount > 0.0);
            amount = amount.abs().max(room).copysign(amount);
        }
        self.advance(amount);
        Ok((displaced, is_free))
    }

    /// The change, `up` or down, at which the first free element reaches a bound; 0 if none does.
    fn room<S: AdmissibleSet>(&self, p: &[f64], set: S, up: bool) -> f64 {
        let of = |(i, p): (usize, &f64)| if up { set.limit(i) - p } else { *p };
        let rooms = p.iter().enumerate().filter(|(i, _)| self.free[*i]).map(of).filter(|room| *room > 0.0);
        Some(rooms.fold(f64::INFINITY, f64::min)).filter(|room| room.is_finite()).unwrap_or(0.0)
    }

    /// z = M r on the free elements, conjugate to a uniform t. Returns (r, z).
    fn precondition(&mut self, without_mean: bool, uniform: f64) -> f64 {
        let ProjectedNewton { preconditioner, weight, free, r, z, uniform_product, .. } = self;
        z.copy_from_slice(r);
        if let Some((workspace, m)) = preconditioner {
            m.apply(z, (free, without_mean), &mut None, workspace);
        }
        finish(z, free, without_mean, (uniform, uniform_product));
        let rz = dot(r, z);
        if preconditioner.is_some() && rz > 0.0 {
            return rz;
        }
        z.iter_mut().zip(&*r).zip(weight).for_each(|((z, r), weight)| *z = *weight * r);
        finish(z, free, without_mean, (uniform, uniform_product));
        dot(r, z)
    }

    /// Moves t by `alpha` along the direction, and updates the residual.
    fn advance(&mut self, alpha: f64) {
        for i in 0..self.t.len() {
            self.t[i] += alpha * self.along[i];
            self.r[i] -= if self.free[i] { alpha * self.along_product[i] } else { 0.0 };
        }
    }
}

/// Restricts z to the free elements, makes its mean zero if that of t is, and makes it conjugate to a uniform t.
fn finish(z: &mut [f64], free: &[bool], without_mean: bool, (uniform, product): (f64, &[f64])) {
    z.iter_mut().zip(free).filter(|(_, free)| !**free).for_each(|(z, _)| *z = 0.0);
    if without_mean {
        remove_mean(z, free);
    }
    if uniform > 0.0 {
        let amount = dot(z, product) / uniform;
        z.iter_mut().zip(free).filter(|(_, free)| **free).for_each(|(z, _)| *z -= amount);
    }
}

/// Subtracts the mean on the free elements from values that are 0 elsewhere.
fn remove_mean(values: &mut [f64], free: &[bool]) {
    let count = free.iter().filter(|free| **free).count();
    let mean = in_blocks(values.iter().copied()) / count.max(1) as f64;
    values.iter_mut().zip(free).filter(|(_, free)| **free).for_each(|(value, _)| *value -= mean);
}
