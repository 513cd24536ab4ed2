//! The Newton direction t: a few iterations of preconditioned conjugate gradients for `A t = -e` on the free elements.
//!
//! With a prescribed approach and two periods a uniform pressure on all elements displaces nothing, and on nearly all elements little. Conjugate
//! gradients would take many iterations for the mean of t. So the first direction is uniform, and all others are conjugate to it:
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

/// The residual of `A t = -e`, relative to e on the free elements, at which the iteration stops. The set of free elements changes before more
/// accuracy pays.
const RESIDUAL_RATIO: f64 = 0.25;
/// The residual of `A t = -e` is not reduced below this part of the residual that the goal allows, unless it begins below.
const WANTED_RESIDUAL_SHARE: f64 = 0.3;
/// A uniform pressure counts as displacing nothing if its displacement is below this part of the displacement of each element by its own pressure. On
/// all elements its displacement is round-off; on all but one it is as large as the displacement by that one.
const ROUND_OFF: f64 = 1e-10;
/// If a uniform pressure displaces nothing, t is computed as if it displaced each element by this part of the displacement by the element's own
/// pressure. But t reaches at least the nearest bound.
const ASSUMED_DISPLACEMENT: f64 = 1e-2;

impl ProjectedNewton {
    /// Computes the direction t on the free elements.
    pub(super) fn find_direction<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<()> {
        let by_force = matches!(task.state.load, Load::Force(_));
        self.t.fill(0.0);
        for ((r, e), &free) in self.r.iter_mut().zip(&self.distance).zip(&self.free) {
            *r = if free { -e } else { 0.0 };
        }
        let (uniform, displaces_nothing) = if by_force { (0.0, true) } else { self.begin_uniformly(task)? };
        // All further directions have the mean zero.
        let without_mean = by_force || displaces_nothing;
        let scale = norm_of_distance(task.state);
        let (mut target, mut last_rz) = (0.0, 0.0);
        for k in 0..self.most_gradients {
            if without_mean {
                remove_mean(&mut self.r, &self.free);
            }
            let norm = dot(&self.r, &self.r).sqrt();
            if k == 0 {
                // If few elements violate their bounds, the residual may be below the one that is allowed in C. Their equations are solved
                // nevertheless.
                let allowed = WANTED_RESIDUAL_SHARE * task.goal.tolerance * scale;
                target = if norm > allowed { allowed.max(RESIDUAL_RATIO * norm) } else { RESIDUAL_RATIO * norm };
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

    /// Sets t to a uniform value if the scene needs that (see the module). Returns (1, A 1), or its assumed value, or 0 if t stays 0; and whether a
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
        let displaces_nothing = work < ROUND_OFF * alone;
        let displaced = if displaces_nothing { ASSUMED_DISPLACEMENT * alone } else { work };
        self.uniform_product.copy_from_slice(&self.along_product);
        let mut amount = in_blocks(self.r.iter().copied()) / displaced;
        if displaces_nothing && amount != 0.0 {
            let room = self.room(&task.state.p, task.set, amount > 0.0);
            amount = amount.abs().max(room).copysign(amount);
        }
        self.advance(amount);
        Ok((displaced, displaces_nothing))
    }

    /// The smallest uniform change of p, `up` or down, at which a free element reaches a bound; 0 if none does.
    fn room<S: AdmissibleSet>(&self, p: &[f64], set: S, up: bool) -> f64 {
        let of = |(i, p): (usize, &f64)| if up { set.limit(i) - p } else { *p };
        let rooms = p.iter().enumerate().filter(|(i, _)| self.free[*i]).map(of).filter(|room| *room > 0.0);
        Some(rooms.fold(f64::INFINITY, f64::min)).filter(|room| room.is_finite()).unwrap_or(0.0)
    }

    /// Sets z = M r on the free elements, conjugate to the uniform direction. Returns (r, z). If (r, z) is not positive, the inverse of A's diagonal
    /// replaces M.
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

    /// Moves t by `alpha` along the direction of conjugate gradients, and updates the residual.
    fn advance(&mut self, alpha: f64) {
        for i in 0..self.t.len() {
            self.t[i] += alpha * self.along[i];
            self.r[i] -= if self.free[i] { alpha * self.along_product[i] } else { 0.0 };
        }
    }
}

/// Restricts z to the free elements, subtracts its mean if `without_mean`, and makes z conjugate to the uniform direction if there is one.
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
