//! Newton's method, projected on the admissible pressures: the method that takes over where a faster one goes round in circles (Bertsekas,
//! *Projected Newton methods for optimization problems with simple constraints*, 1982). Every step lowers the energy
//! `(p, A p)/2 + (p, h - approach)`, so no state comes back.
//!
//! ```text
//! free elements: p > 0 or e < 0; with limits also p < p_max or e > 0
//! A t = -e on them, in part: some conjugate gradients             (module `direction`)
//! elements whose t leads out of their bound are not free: t anew   (module `bounds`)
//! d = project(p + t) - p                                          (module `projection`)
//! s = -(d, e)/(d, A d), at most 1;   p = p + s d
//! ```
//!
//! With a prescribed force, t has mean zero on the free elements, and the projection adds a constant there with which the force is carried.
//!
//! Where bounds cut much of t off, s is small: then d is projected again from a shorter t, and the next direction has fewer conjugate gradients.
//! Long waves of t would push many elements to a bound at which they do not stay.

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

const MEMORY: &str = "the workspace of the projected Newton method";

/// Conjugate gradients of one direction at most.
const MOST: u32 = 16;
/// A step of a smaller part of d is a short one. At half of it and beyond, all of d lowers the energy, too.
const SHORT: f64 = 0.5;
/// Directions anew without the elements that t leads out of a bound; after that all elements at a bound stay there.
const TRIES: u32 = 3;
/// Every step lowers the energy, but not the violation: with limits that differ by a thousand times it may stand still for more than a hundred steps.
const PATIENCE: u32 = 400;
/// Each time that p + t leads uphill, t is taken times this.
const SHORTER: f64 = 0.25;
/// A t that leads uphill when it is so much shorter is round-off.
const ROUND_OFF: f64 = 1e-9;

/// The method, and its memory, kept from one solve to the next. A must be symmetric.
#[derive(Default)]
pub struct ProjectedNewton {
    /// None: the circulant is not positive, and W, the inverse of A's diagonal, stands for it.
    preconditioner: Option<(Workspace<f64>, Preconditioner<f64>)>,
    weight: Vec<f64>,
    free: Vec<bool>,
    /// e on elements with a surface.
    distance: Vec<f64>,
    t: Vec<f64>,
    /// Of the conjugate gradients: the residual, the preconditioned one, the direction and its product, and that of 1 on the free elements.
    r: Vec<f64>,
    z: Vec<f64>,
    along: Vec<f64>,
    along_product: Vec<f64>,
    uniform_product: Vec<f64>,
    /// d and A d.
    change: Vec<f64>,
    change_product: Vec<f64>,
    /// Of the next direction.
    most: u32,
    began: bool,
}

/// A step from p to p + part d, and the energy that it takes.
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
        (self.most, self.began) = (MOST, false);
        Ok(())
    }

    fn step(&mut self, task: &mut Task<'_, '_, S>) -> Result<Change> {
        if !std::mem::replace(&mut self.began, true) {
            self.set_up(task.problem)?;
            take_over(task)?;
        }
        // The loop admits elements whose p is 0 still: they are free, but the approach is not theirs.
        find_contact(task.state, task.set);
        task.state.fit_approach(&task.problem.threads);
        find_free(task.state, task.set, &mut self.distance, &mut self.free);
        let slope = self.downhill(task)?;
        if !(slope < 0.0) {
            // Nothing is downhill, or round-off hides it: the loop's certificate decides.
            task.refresh()?;
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
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let preconditioner = self.preconditioner.as_ref().map_or(0, |(workspace, m)| m.bytes() + workspace.bytes());
        preconditioner + 10 * self.t.len() * size_of::<f64>() + self.free.len()
    }

    fn vectors(&mut self) -> [&mut Vec<f64>; 10] {
        let ProjectedNewton { weight, distance, t, r, z, along, along_product, .. } = self;
        let ProjectedNewton { uniform_product, change, change_product, .. } = self;
        [weight, distance, t, r, z, along, along_product, uniform_product, change, change_product]
    }

    /// The preconditioner, and W.
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

    /// t, and d, that lead downhill, as d's slope says. It is not negative where there are none.
    fn downhill<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<f64> {
        let mut tries = 0;
        let mut slope = loop {
            tries += 1;
            self.find_direction(task)?;
            let slope = self.project(task.state, task.set, 1.0);
            if slope < 0.0 || !keep_at_bounds((task.state, task.set), &self.t, &mut self.free, tries > TRIES) {
                break slope;
            }
        };
        let mut length = 1.0;
        while !(slope < 0.0 || length < ROUND_OFF) {
            length *= SHORTER;
            slope = self.project(task.state, task.set, length);
        }
        self.t.iter_mut().for_each(|t| *t *= length);
        Ok(slope)
    }

    /// How far along d, or along a d from a shorter t where that lowers the energy more.
    fn search<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>, slope: f64) -> Result<Length> {
        task.problem.displace(&self.change, &mut self.change_product)?;
        let first = self.length(slope);
        let mut found = first;
        if first.part < SHORT {
            // The first d is kept where nothing else is needed now.
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
        self.most = if first.part < SHORT { (self.most / 2).max(1) } else { (2 * self.most).min(MOST) };
        // All of d lowers the energy, too, and takes elements to their bounds.
        let part = if found.part >= SHORT { 1.0 } else { found.part };
        Ok(Length { part, ..found })
    }

    /// The part of d, of which the product is known, that lowers the energy most.
    fn length(&self, slope: f64) -> Length {
        let curvature = dot(&self.change, &self.change_product);
        let part = if curvature > 0.0 { (-slope / curvature).min(1.0) } else { 1.0 };
        Length { part, energy: part * (slope + 0.5 * part * curvature) }
    }

    /// p = p + part d, u with it, and C = {0 < p < limit}. Returns how many elements changed sides.
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

/// Admissible pressures that carry a prescribed force, C where they are positive, u = A p.
fn take_over<S: AdmissibleSet>(task: &mut Task<'_, '_, S>) -> Result<()> {
    let (state, set) = (&mut *task.state, task.set);
    let project = |(i, p): (usize, &mut f64)| *p = if p.is_finite() { set.project(i, *p) } else { 0.0 };
    state.p.iter_mut().enumerate().for_each(project);
    state.carry_force(set, &task.problem.threads);
    find_contact(state, set);
    task.refresh()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    in_blocks(a.iter().zip(b).map(|(a, b)| a * b))
}

#[cfg(test)]
#[path = "../../../tests/unit/projected_newton.rs"]
mod tests;
