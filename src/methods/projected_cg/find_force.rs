//! Lines in plane strain with two periods, by approach: the search for the force of the approach.
//!
//! The mean of the pressure displaces nothing there. Near full contact the force changes by far more than the approach, and iterations that change
//! both at once take 110 to 390 products. With a force they take 20 to 60, as on other lines. So the force follows from a secant,
//!
//! ```text
//! F_(k+1) = F_k + (m - m_k) (F_k - F_(k-1))/(m_k - m_(k-1)),   m = ln(mean of h - approach)
//! ```
//!
//! and each force is solved loosely (module `mean_gap`: why m).
//!
//! *Approach of a force.* A mean of e over C, with weights of sum 1, is the approach of the solution up to the product of two errors: that of
//! p, and that of the weights as pressures of a flat punch on C. The change of p with the force is such a pressure.
//!
//! *Start of a force.* p is extrapolated along its change with the force. For the first larger force a uniform pressure, which displaces
//! nothing, is added instead. Elements then leave C, which is faster than entering it.
//!
//! *Near the force* p moves along its change in each step by approach (module `along`).
//!
//! Measured on 600 random lines of 64 to 8000 elements, tolerances from 1e-4 to 1e-8: median 51 products, 98 % below 155, at most 355. With
//! approaches as means over C and no extrapolation: median 152, 10 % above 300.

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

/// Residual of the solve of the first force; of the next ones, relative to the distance between approaches.
const FIRST_RESIDUAL: f64 = 0.1;
const RESIDUAL_PER_DISTANCE: f64 = 0.3;
/// The force changes by at most this factor. 60 lines of 3000 and 9600 elements take at most 85 products; with 4, 400.
const LARGEST_FORCE_RATIO: f64 = 2.0;
/// Largest extrapolation of p, relative to its last change.
const LARGEST_EXTRAPOLATION: f64 = 4.0;
/// A force is near if m has to change by at most the first number times its last change, and by less than the second.
const NEAR_FORCE: (f64, f64) = (0.3, 0.5);
/// Allowed error of the approach, relative to the tolerance.
const APPROACH_ERROR: f64 = 0.5;
/// Most forces, and most iterations along the change of p. More follow if these reduced the residual to this part.
const MOST_FORCES: usize = 20;
const MOST_ALONG: u64 = 40;
const ALONG_GAIN: f64 = 0.1;
/// Round-off of u in single precision, in the residual and in the approach.
const ROUNDING: f64 = f32::ROUND_OFF;
/// The part of the elements in C above which a uniform pressure is added.
const UNIFORM_SHARE: f64 = 0.25;

/// Pressures of a force, with its approach and residual.
#[derive(Default)]
struct Known {
    p: Vec<f64>,
    force: f64,
    approach: f64,
    residual: f64,
}

/// A search for the force.
#[derive(Default)]
pub(super) struct FindForce {
    /// The last force with a gap, and its m.
    last: Option<(f64, f64)>,
    /// The least force without a gap.
    full: Option<f64>,
    /// An earlier solution, from which the last one differs by more than its residual.
    before: Known,
    /// The residual to which the next force is solved.
    tolerance: Option<f64>,
    /// Whether steps along the change of p met the goal or reduced the residual by much, and whether they failed.
    is_near: bool,
    has_failed: bool,
}

impl FindForce {
    /// Whether the approach is solved by a search for the force.
    pub(super) fn serves<S: AdmissibleSet>(task: &LevelTask<'_, '_, S>, goal: &Goal) -> bool {
        let by_approach = matches!(task.state.load, Load::Approach(_));
        let presses = || in_blocks(task.state.p.iter().copied()) > 0.0;
        by_approach && !S::FIXED && !S::LIMITED && !goal.by_update() && task.level.is_mean_free_line() && presses()
    }

    /// Begins another grid or another solve.
    pub(super) fn begin(&mut self) {
        *self = FindForce {
            before: Known { p: std::mem::take(&mut self.before.p), ..Known::default() },
            ..FindForce::default()
        };
        self.before.p.clear();
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.before.p[..])
    }

    /// Solves by approach with several forces, at most `at_once` iterations for each.
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

    /// Solves by the force that p carries, and finds its approach. `mean`: the mean of h.
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

    /// Whether steps along the change of p follow.
    fn goes_along(&self, found: &Found) -> bool {
        let Known { p, approach, .. } = &self.before;
        let (m, missing) = (found.m(found.approach), found.m(found.wanted) - found.m(found.approach));
        let is_near = missing.abs() <= NEAR_FORCE.0 * (m - found.m(*approach)).abs();
        let is_near = is_near && (found.mean.is_none() || missing.abs() < NEAR_FORCE.1);
        !p.is_empty() && !self.has_failed && !found.is_full() && is_near && self.clearness(found) > 1.0
    }

    /// The change of the approach from the earlier solution, relative to their residuals.
    fn clearness(&self, found: &Found) -> f64 {
        let Known { approach, residual, .. } = &self.before;
        (found.approach - approach).abs() / (found.residual.max(*residual) * found.size)
    }

    /// The next force.
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

    /// Iterates by approach, along the change of p in each step. Restores p on failure.
    fn run_along<S: AdmissibleSet>(&mut self, task: &mut LevelTask<'_, '_, S>, goal: &Goal) -> Result<End> {
        // The pressures to restore on failure.
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

    /// The approach of the force.
    fn approach_of(&self, state: &State) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (i, before) in self.before.p.iter().enumerate().filter(|(i, _)| state.contact[*i]) {
            let change = state.p[i] - before;
            (sum, weights) = (sum + change * (state.h[i] + state.u[i]), weights + change);
        }
        Some(sum / weights).filter(|approach| approach.is_finite()).unwrap_or(state.approach)
    }

    /// Sets p for the next force; false if there is none.
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
