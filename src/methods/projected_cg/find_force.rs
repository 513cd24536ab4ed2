//! Lines in plane strain with two periods and a prescribed approach: the search for the force that belongs to the approach.
//!
//! On such a line a uniform pressure displaces nothing. Near full contact the force changes by far more than the approach, and an iteration that
//! changes pressures and force at once takes 110 to 390 products. With a prescribed force it takes 20 to 60, as on other lines. So the problem is
//! solved for several forces, each to a low accuracy. The next force follows from a secant (module `mean_gap` tells why in m):
//!
//! ```text
//! F_(k+1) = F_k + (m - m_k) (F_k - F_(k-1))/(m_k - m_(k-1)),   m = ln(mean of h - approach)
//! ```
//!
//! *The approach that belongs to a force.* It is a weighted mean of h + u over C, with weights of sum 1. Its error is the product of two errors: that
//! of p, and that of the weights as the pressure of a flat punch on C. The change of p with the force is nearly such a pressure, and gives the
//! weights.
//!
//! *The start for the next force.* p is extrapolated along its change with the force. For the first force that is larger a uniform pressure is added
//! instead, because it displaces nothing. Elements then leave C, which is faster than if they entered.
//!
//! *Near the wanted force* the approach is prescribed, and p moves along its change with the force in each step (module `along`).
//!
//! On 600 random lines of 64 to 8000 elements, with tolerances from 1e-4 to 1e-8, the median is 51 products; 98 % take fewer than 155, and none more
//! than 355. With unweighted means over C and without extrapolation the median is 152, and 10 % take more than 300.

use super::deflation::Last;
use super::level_task::LevelTask;
use super::mean_gap::Found;
use super::End;
use crate::contact::{norm_of_distance, AdmissibleSet, Freshness, State};
use crate::error::Result;
use crate::memory::{computed, reserve};
use crate::methods::fields::Stored;
use crate::progress::Goal;
use crate::scene::Load;
use crate::sums::{in_blocks, mean};

/// The relative residual to which the first force is solved.
const FIRST_RESIDUAL: f64 = 0.1;
/// The residual of the next forces, relative to the distance between the found and the wanted approach.
const RESIDUAL_PER_DISTANCE: f64 = 0.3;
/// The force changes by at most this factor at once. 60 lines of 3000 and 9600 elements then take at most 85 products; with a factor of 4, 400.
const LARGEST_FORCE_RATIO: f64 = 2.0;
/// The largest extrapolation of p, relative to its last change.
const LARGEST_EXTRAPOLATION: f64 = 4.0;
/// A force is near the wanted one if m has to change by at most the first number times its last change, and by less than the second number.
const NEAR_FORCE: (f64, f64) = (0.3, 0.5);
/// The allowed error of the approach, relative to the tolerance.
const APPROACH_ERROR: f64 = 0.5;
/// The largest number of forces in one call.
const MOST_FORCES: usize = 20;
/// The largest number of iterations along the change of p, at first.
const MOST_ALONG: u64 = 40;
/// More such iterations follow if these reduced the residual to less than this part.
const ALONG_GAIN: f64 = 0.1;
/// The round-off of u in single precision, in the residual and in the approach.
const ROUNDING: f64 = f32::ROUND_OFF;
/// A uniform pressure is added if more than this part of all elements is in C.
const UNIFORM_SHARE: f64 = 0.25;

/// The solution for one force.
#[derive(Default)]
struct Known {
    p: Vec<f64>,
    force: f64,
    approach: f64,
    /// The relative residual to which it was solved.
    residual: f64,
}

/// The search for the force.
#[derive(Default)]
pub(super) struct FindForce {
    /// The last force with a mean gap, and its m.
    last: Option<(f64, f64)>,
    /// The least force without a mean gap.
    full: Option<f64>,
    /// An earlier solution, which differs from the last one by more than the residual.
    before: Known,
    /// The residual to which the next force is solved.
    tolerance: Option<f64>,
    /// Whether steps along the change of p met the goal or reduced the residual by much.
    is_near: bool,
    /// Whether steps along the change of p failed.
    has_failed: bool,
}

impl FindForce {
    /// Whether a task is solved by a search for the force.
    pub(super) fn serves<S: AdmissibleSet>(task: &LevelTask<'_, '_, S>, goal: &Goal) -> bool {
        let by_approach = matches!(task.state.load, Load::Approach(_));
        let carries = || in_blocks(task.state.p.iter().copied()) > 0.0;
        by_approach && !S::FIXED && !S::LIMITED && !goal.by_update() && task.level.is_mean_free_line() && carries()
    }

    /// Begins the search anew, on another grid or for another solve.
    pub(super) fn begin(&mut self) {
        *self = FindForce {
            before: Known { p: std::mem::take(&mut self.before.p), ..Known::default() },
            ..FindForce::default()
        };
        self.before.p.clear();
    }

    /// Bytes of the earlier solution.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.before.p[..])
    }

    /// Solves for the approach by solves for several forces, each with at most `at_once` iterations.
    pub(super) fn run<S: AdmissibleSet>(
        &mut self,
        task: &mut LevelTask<'_, '_, S>,
        goal: &Goal,
        at_once: u64,
    ) -> Result<End> {
        if self.is_near {
            return self.run_along(task, goal);
        }
        let (before, mean) = (task.monitor.count.cycles, mean(&task.state.h));
        let mut rounding = if task.state.u_is == Freshness::Exact { 0.0 } else { ROUNDING };
        for _ in 0..MOST_FORCES {
            let most = goal.max_cycles.saturating_sub(task.monitor.count.cycles - before);
            let residual = goal.tolerance.max(self.tolerance.unwrap_or(FIRST_RESIDUAL));
            let inner = Goal { tolerance: residual, max_cycles: most.min(at_once), ..*goal };
            let (end, found) = self.run_force(task, &inner, mean)?;
            let is_enough = found.off() <= f64::max(rounding, APPROACH_ERROR * goal.tolerance);
            let goes_on = end == End::Met || end == End::Limit && most > at_once;
            if !goes_on || is_enough && residual <= f64::max(rounding, goal.tolerance) {
                self.tolerance = Some(goal.tolerance);
                return Ok(end);
            }
            rounding = ROUNDING;
            if end == End::Met && self.goes_along(&found) {
                let along = Goal { max_cycles: most.min(MOST_ALONG), ..*goal };
                let end = self.run_along(task, &along)?;
                self.is_near |= end == End::Limit && task.monitor.count.residual < ALONG_GAIN * residual;
                self.has_failed = !self.is_near;
                if !matches!(end, End::Stagnated | End::Breakdown) {
                    return Ok(end);
                }
            }
            if is_enough {
                self.tolerance = Some(goal.tolerance);
            } else if end == End::Met && residual > goal.tolerance && found.may_be_loose() {
                self.tolerance = Some(FIRST_RESIDUAL * residual);
            } else {
                self.tolerance = Some(residual.min(RESIDUAL_PER_DISTANCE * found.off()).max(ROUNDING));
                if !self.change(task.state, &found)? {
                    return Ok(End::Stagnated);
                }
            }
        }
        Ok(End::Stagnated)
    }

    /// Solves for the force that p carries, and finds the approach that belongs to this force. `mean` is the mean of h.
    fn run_force<S: AdmissibleSet>(
        &mut self,
        task: &mut LevelTask<'_, '_, S>,
        goal: &Goal,
        mean: f64,
    ) -> Result<(End, Found)> {
        let state = &mut *task.state;
        let (prescribed, wanted, u_is) = (state.load, state.approach, state.u_is);
        let force = in_blocks(state.p.iter().copied()) * state.grid.element_area();
        state.load = Load::Force(force);
        let end = task.run(u_is, None, goal);
        let state = &mut *task.state;
        (state.load, state.u_is) = (prescribed, Freshness::Stale);
        let end = end?;
        task.level.take_displacements(state);
        let approach = self.approach_of(state);
        state.approach = wanted;
        let size = norm_of_distance(state) / (state.contact_count() as f64).sqrt();
        let mean = Some(mean).filter(|mean| mean.is_finite() && wanted < *mean);
        Ok((end, Found { wanted, force, approach, residual: goal.tolerance, size, mean }))
    }

    /// Whether steps along the change of p follow, because the force is near the wanted one and the change of p is accurate enough.
    fn goes_along(&self, found: &Found) -> bool {
        let Known { p, approach, .. } = &self.before;
        let (m, missing) = (found.m(found.approach), found.m(found.wanted) - found.m(found.approach));
        let is_near = missing.abs() <= NEAR_FORCE.0 * (m - found.m(*approach)).abs();
        let is_near = is_near && (found.mean.is_none() || missing.abs() < NEAR_FORCE.1);
        !p.is_empty() && !self.has_failed && !found.is_full() && is_near && self.clearness(found) > 1.0
    }

    /// How clearly the last solution differs from the earlier one: the change of the approach, relative to the larger of both residuals.
    fn clearness(&self, found: &Found) -> f64 {
        let Known { approach, residual, .. } = &self.before;
        (found.approach - approach).abs() / (found.residual.max(*residual) * found.size)
    }

    /// Chooses the next force: by the secant, between forces with and without a mean gap, or as a first change.
    fn next_force(&mut self, found: &Found) -> f64 {
        let (force, m) = (found.force, found.m(found.approach));
        if found.is_full() {
            self.full = Some(self.full.map_or(force, |full| full.min(force)));
            return self.last.map_or(force / LARGEST_FORCE_RATIO, |last| 0.5 * (last.0 + force));
        }
        let slope = self.last.map(|last| (force - last.0) / (m - last.1));
        let next = match slope.filter(|slope| *slope < 0.0 && slope.is_finite()) {
            Some(slope) => force + slope * (found.m(found.wanted) - m),
            None => found.first_change(),
        };
        self.last = Some((force, m));
        let next = next.clamp(force / LARGEST_FORCE_RATIO, LARGEST_FORCE_RATIO * force);
        match self.full.filter(|full| *full <= next && force < *full) {
            Some(full) => 0.5 * (force + full),
            None => next,
        }
    }

    /// Iterates with the prescribed approach, where p moves along its last change in each step. Restores p if the iteration fails.
    fn run_along<S: AdmissibleSet>(&mut self, task: &mut LevelTask<'_, '_, S>, goal: &Goal) -> Result<End> {
        // The pressures to restore if the iteration fails.
        let start = computed(task.state.p.iter().copied(), "pressures by approach")?;
        let last = Last { p: &self.before.p, u: None };
        let end = task.run(task.state.u_is, Some(last), goal)?;
        let state = &mut *task.state;
        state.u_is = Freshness::Stale;
        self.is_near = end == End::Met;
        if matches!(end, End::Stagnated | End::Breakdown) {
            state.p.copy_from_slice(&start);
            state.contact.iter_mut().zip(&start).for_each(|(inside, p)| *inside = *p > 0.0);
        }
        Ok(end)
    }

    /// The approach that belongs to the force that p carries: the mean of h + u over C, weighted by the change of p.
    fn approach_of(&self, state: &State) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (i, before) in self.before.p.iter().enumerate().filter(|(i, _)| state.contact[*i]) {
            let change = state.p[i] - before;
            (sum, weights) = (sum + change * (state.h[i] + state.u[i]), weights + change);
        }
        Some(sum / weights).filter(|approach| approach.is_finite()).unwrap_or(state.approach)
    }

    /// Sets p to the start for the next force. Returns false if no next force is found.
    fn change(&mut self, state: &mut State, found: &Found) -> Result<bool> {
        if !(found.force > 0.0 && found.force.is_finite()) {
            return Ok(false);
        }
        let (force, next) = (found.force, self.next_force(found));
        if !next.is_finite() {
            return Ok(false);
        }
        let (n, is_first) = (state.p.len(), self.before.p.is_empty());
        let by = Some((next - force) / (force - self.before.force)).filter(|by| by.abs() <= LARGEST_EXTRAPOLATION);
        let by = if is_first { 0.0 } else { by.unwrap_or(0.0) };
        let many = UNIFORM_SHARE * (n as f64) < state.contact_count() as f64;
        let keeps = is_first || found.off() > found.residual * self.clearness(found).min(1.0);
        reserve(&mut self.before.p, n, "pressures of the force before")?;
        self.before.p.resize(n, 0.0);
        for (p, before) in state.p.iter_mut().zip(&mut self.before.p) {
            let now = *p;
            *p = (now + by * (now - *before)).max(0.0);
            *before = if keeps { now } else { *before };
        }
        if keeps {
            let Found { approach, residual, .. } = *found;
            (self.before.force, self.before.approach, self.before.residual) = (force, approach, residual);
        }
        if is_first && many && next > force {
            let more = (next - force) / (n as f64 * state.grid.element_area());
            state.p.iter_mut().for_each(|p| *p += more);
            state.contact.fill(true);
            state.u_is = Freshness::Near;
            return Ok(true);
        }
        let carried = in_blocks(state.p.iter().copied()) * state.grid.element_area();
        if !(carried > 0.0 && carried.is_finite()) {
            return Ok(false);
        }
        for (p, inside) in state.p.iter_mut().zip(&mut state.contact) {
            *p *= next / carried;
            *inside = *p > 0.0;
        }
        Ok(true)
    }
}
