//! Newton's method, projected on the admissible pressures, for problems on which a faster method cycles (Bertsekas, *Projected Newton
//! methods for optimization problems with simple constraints*, 1982). Every step lowers the energy `(p, A p)/2 + (p, h - approach)`, so no
//! state recurs.
//!
//! ```text
//! free elements: p > 0 or e < 0; with limits also p < p_max or e > 0
//! solve A t = -e on the free elements approximately, by a few conjugate gradients             (module `direction`)
//! if t takes an element at a bound beyond it, the element is not free; compute t again        (module `bounds`)
//! d = project(p + t) - p                                                                      (module `projection`)
//! s = -(d, e)/(d, A d), at most 1;   p = p + s d
//! ```
//!
//! If the force is prescribed, t has mean zero on the free elements, and the projection adds a constant there so that p carries the force.
//!
//! If bounds cut off much of t, s is small. Then d is computed again from a shorter t, and the next direction takes fewer conjugate gradients: long
//! waves of t would move many elements to a bound at which they do not stay.

mod bounds;
mod direction;
mod projection;

use self::bounds::{find_contact, find_free, keep_at_bounds, snap};
use crate::contact::{AdmissibleSet, Freshness, Problem, State};
use crate::error::Result;
use crate::memory::zeros;
use crate::methods::projected_cg::Preconditioner;
use crate::methods::{Change, Policy, Step, Task};
use crate::operator::Workspace;
use crate::sums::in_blocks;

/// The name of the memory in messages.
const MEMORY: &str = "the workspace of the projected Newton method";

/// The largest number of conjugate gradients for one t.
const MOST_GRADIENTS: u32 = 16;
/// A step is short if s is below this value. If s is at least 1/2, all of d lowers the energy as well, because the energy along d is a parabola.
const SHORT_STEP: f64 = 0.5;
/// t is computed at most this many times more, without the elements that it would take beyond a bound. After that all elements at a bound stay there.
const MOST_RECOMPUTED: u32 = 3;
/// Steps lower the energy, but not always the violation: with limits that differ a thousandfold the violation may stagnate for over a hundred steps.
const PATIENCE: u32 = 400;
/// The factor by which t is shortened if d leads uphill.
const STEP_RATIO: f64 = 0.25;
/// The shortest t, relative to the first. If this t leads uphill, t is round-off.
const ROUND_OFF: f64 = 1e-9;

/// The projected Newton method, and its memory, which the next solve reuses. A must be symmetric.
#[derive(Default)]
pub struct ProjectedNewton {
    /// The preconditioner M. None if the circulant is not positive definite: then `weight` replaces M.
    preconditioner: Option<(Workspace<f64>, Preconditioner<f64>)>,
    /// The inverse of A's diagonal.
    weight: Vec<f64>,
    /// Whether each element is free.
    free: Vec<bool>,
    /// e on elements with a surface, 0 elsewhere.
    distance: Vec<f64>,
    /// The Newton direction.
    t: Vec<f64>,
    /// Conjugate gradients: the residual r.
    r: Vec<f64>,
    /// Conjugate gradients: the preconditioned residual z = M r.
    z: Vec<f64>,
    /// Conjugate gradients: the direction. In the projection: p + d.
    along: Vec<f64>,
    /// The product of A with the direction of conjugate gradients.
    along_product: Vec<f64>,
    /// The product of A with 1 on the free elements.
    uniform_product: Vec<f64>,
    /// The change d of p.
    change: Vec<f64>,
    /// The product A d.
    change_product: Vec<f64>,
    /// The largest number of conjugate gradients for the next t.
    most_gradients: u32,
    /// Whether this solve has made a step.
    began: bool,
}

/// A step from p to p + part d, and the change of energy by the step.
#[derive(Clone, Copy, Debug)]
struct Length {
    part: f64,
    energy: f64,
}

impl<S: AdmissibleSet> Step<S> for ProjectedNewton {
    fn name(&self) -> &'static str {
        "the projected Newton method"
    }

    fn policy(&self) -> Policy {
        Policy { exchanged_by_loop: true, step_is_cycle: false, chatter: 0, patience: PATIENCE, progress: 1.0 }
    }

    fn begin(&mut self, state: &State) -> Result<()> {
        let n = state.p.len();
        if self.free.len() != n {
            for values in self.vectors() {
                *values = zeros(n, MEMORY)?;
            }
            self.free = zeros(n, MEMORY)?;
        }
        (self.most_gradients, self.began) = (MOST_GRADIENTS, false);
        Ok(())
    }

    fn step(&mut self, task: &mut Task<'_, '_, S>) -> Result<Change> {
        if !std::mem::replace(&mut self.began, true) {
            self.set_up(task.problem)?;
            take_over(task)?;
        }
        // The loop has admitted elements with p = 0 to C. They are free, but must not determine the approach.
        find_contact(task.state, task.set);
        task.state.fit_approach(&task.problem.threads);
        find_free(task.state, task.set, &mut self.distance, &mut self.free);
        let slope = self.downhill(task)?;
        if !(slope < 0.0) {
            // Up to round-off no direction leads downhill. The loop's certificate decides.
            task.problem.refresh(task.state, task.set)?;
            let update = if slope == 0.0 { 0.0 } else { f64::INFINITY };
            return Ok(Change { update, gives_up: true, ..Change::default() });
        }
        let length = self.search(task, slope)?;
        let changes = self.take(task.state, task.set, length.part);
        let state = &mut *task.state;
        state.u_is = Freshness::Near;
        task.monitor.count.active_set_steps += 1;
        task.monitor.count.active_set_changes += changes;
        let squares = length.part * length.part * dot(&self.change, &self.change);
        Ok(Change { update: (squares / state.contact_count().max(1) as f64).sqrt(), ..Change::default() })
    }
}

impl ProjectedNewton {
    /// Bytes of the vectors and of the preconditioner.
    pub fn bytes(&self) -> usize {
        let preconditioner = self.preconditioner.as_ref().map_or(0, |(workspace, m)| m.bytes() + workspace.bytes());
        preconditioner + 10 * self.t.len() * size_of::<f64>() + self.free.len()
    }

    /// All vectors of doubles.
    fn vectors(&mut self) -> [&mut Vec<f64>; 10] {
        let ProjectedNewton { weight, distance, t, r, z, along, along_product, .. } = self;
        let ProjectedNewton { uniform_product, change, change_product, .. } = self;
        [weight, distance, t, r, z, along, along_product, uniform_product, change, change_product]
    }

    /// Sets up the preconditioner, and the inverse of A's diagonal.
    fn set_up(&mut self, problem: &Problem) -> Result<()> {
        let Problem { coefficients, grid, threads, .. } = problem;
        self.preconditioner = match Preconditioner::new(coefficients, 1.0, grid, threads)? {
            None => None,
            Some(m) => Some((m.inverse().workspace()?, m)),
        };
        for (i, weight) in self.weight.iter_mut().enumerate() {
            *weight = 1.0 / coefficients.entry(grid, i, i);
        }
        Ok(())
    }

    /// Computes t and d so that d leads downhill. Returns the slope (d, e), which is not negative if no such d is found.
    fn downhill<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<f64> {
        let mut tries = 0;
        let mut slope = loop {
            tries += 1;
            self.find_direction(task)?;
            let slope = self.project(task.state, task.set, 1.0);
            if slope < 0.0 || !keep_at_bounds((task.state, task.set), &self.t, &mut self.free, tries > MOST_RECOMPUTED)
            {
                break slope;
            }
        };
        let mut length = 1.0;
        while !(slope < 0.0 || length < ROUND_OFF) {
            length *= STEP_RATIO;
            slope = self.project(task.state, task.set, length);
        }
        self.t.iter_mut().for_each(|t| *t *= length);
        Ok(slope)
    }

    /// Chooses the step along d, or along the d of a shorter t if this lowers the energy more.
    fn search<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>, slope: f64) -> Result<Length> {
        task.problem.displace(&self.change, &mut self.change_product)?;
        let first = self.length(slope);
        let mut found = first;
        if first.part < SHORT_STEP {
            // The first d is kept in vectors that are free now.
            std::mem::swap(&mut self.change, &mut self.r);
            std::mem::swap(&mut self.change_product, &mut self.z);
            let slope = self.project(task.state, task.set, 2.0 * first.part);
            task.problem.displace(&self.change, &mut self.change_product)?;
            found = self.length(slope);
            if !(found.energy < first.energy) {
                std::mem::swap(&mut self.change, &mut self.r);
                std::mem::swap(&mut self.change_product, &mut self.z);
                found = first;
            }
        }
        self.most_gradients = match first.part < SHORT_STEP {
            true => (self.most_gradients / 2).max(1),
            false => (2 * self.most_gradients).min(MOST_GRADIENTS),
        };
        // Unless the step is short, all of d lowers the energy as well, and takes elements to their bounds.
        let part = if found.part >= SHORT_STEP { 1.0 } else { found.part };
        Ok(Length { part, ..found })
    }

    /// The part of d, at most 1, that lowers the energy most.
    fn length(&self, slope: f64) -> Length {
        let curvature = dot(&self.change, &self.change_product);
        let part = if curvature > 0.0 { (-slope / curvature).min(1.0) } else { 1.0 };
        Length { part, energy: part * (slope + 0.5 * part * curvature) }
    }

    /// Sets p = p + part d, u = u + part A d, and C = {0 < p < limit}. Returns the number of elements that entered or left C.
    fn take<S: AdmissibleSet>(&mut self, state: &mut State, set: S, part: f64) -> u64 {
        for i in 0..state.p.len() {
            // p + (project(p + t) - p) may miss a bound by round-off.
            let to = if part == 1.0 { self.along[i] } else { state.p[i] + part * self.change[i] };
            state.p[i] = set.project(i, to);
            state.u[i] += part * self.change_product[i];
        }
        snap(state, set);
        find_contact(state, set)
    }
}

/// Makes p admissible and lets it carry a prescribed force. Sets C = {0 < p < limit} and u = A p.
fn take_over<S: AdmissibleSet>(task: &mut Task<'_, '_, S>) -> Result<()> {
    let (state, set) = (&mut *task.state, task.set);
    let project = |(i, p): (usize, &mut f64)| *p = if p.is_finite() { set.project(i, *p) } else { 0.0 };
    state.p.iter_mut().enumerate().for_each(project);
    state.carry_force(set, &task.problem.threads);
    find_contact(state, set);
    task.problem.refresh(task.state, task.set)
}

/// The inner product (a, b).
fn dot(a: &[f64], b: &[f64]) -> f64 {
    in_blocks(a.iter().zip(b).map(|(a, b)| a * b))
}

#[cfg(test)]
#[path = "../../../tests/unit/projected_newton.rs"]
mod tests;
