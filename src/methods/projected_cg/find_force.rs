//! Lines in plane strain with two periods, by approach: the force that has the approach.
//!
//! The mean of the pressure displaces nothing there. Near full contact the force changes by far more than the approach, and iterations that change
//! both at once take 110 to 390 products. With a force they take 20 to 60, as on other lines. So the force follows from a secant,
//!
//! ```text
//! F_(k+1) = F_k + (approach - a_k) (F_k - F_(k-1))/(a_k - a_(k-1)),   a_k: the approach of F_k
//! ```
//!
//! and each force is solved from the pressures of the last. The error of a_k is of second order in that of the pressures. So all forces but the last are
//! solved loosely.

use super::step::ProjectedCg;
use super::End;
use crate::contact::{norm_of_distance, AdmissibleSet, Freshness, State};
use crate::error::Result;
use crate::progress::{Goal, Monitor};
use crate::scene::Load;
use crate::sums::in_blocks;

/// The residual to which the first force is solved; the next ones to what the approach is off.
const LOOSE: f64 = 1e-2;
/// The first change of the force, relative to it: as much as the approach is off, within this range.
const FIRST: (f64, f64) = (1e-3, 0.03);
/// Later changes are at most by this factor.
const FURTHEST: f64 = 2.0;
/// What the approach may be off beside the residual, as a part of the tolerance.
const ENOUGH: f64 = 0.5;
/// Forces at most.
const MOST: usize = 20;

impl ProjectedCg {
    /// Whether the force is to be found for the approach.
    pub(super) fn finds_force<S: AdmissibleSet>(&self, state: &State, goal: &Goal) -> bool {
        let by_approach = matches!(state.load, Load::Approach(_));
        let presses = || in_blocks(state.p.iter().copied()) > 0.0;
        by_approach && !S::FIXED && !S::LIMITED && !goal.by_update() && self.finest.is_mean_free_line() && presses()
    }

    /// Solves by approach as by several forces.
    pub(super) fn find_force<S: AdmissibleSet>(
        &mut self,
        (state, set): (&mut State, S),
        goal: &Goal,
        finest: usize,
        monitor: &mut Monitor<'_>,
    ) -> Result<End> {
        let prescribed = state.load;
        let Load::Approach(approach) = prescribed else { return Ok(End::Stagnated) };
        let mut force = in_blocks(state.p.iter().copied()) * state.grid.element_area();
        let (mut last, mut u_is, mut end) = (self.secant, state.u_is, End::Stagnated);
        let before = monitor.count.cycles;
        let mut tolerance = goal.tolerance.max(LOOSE);
        for _ in 0..MOST {
            let max_cycles = goal.max_cycles.saturating_sub(monitor.count.cycles - before);
            state.load = Load::Force(force);
            let inner = Goal { tolerance, max_cycles, ..*goal };
            let run = self.finest.run(state, set, (u_is, None), &inner, finest, monitor);
            (state.load, u_is) = (prescribed, Freshness::Stale);
            let (found, missing) = (state.approach, approach - state.approach);
            state.approach = approach;
            end = run?;
            let size = norm_of_distance(state) / (state.contact_count() as f64).sqrt();
            let is_enough = missing.abs() <= ENOUGH * goal.tolerance * size;
            if end != End::Met || tolerance <= goal.tolerance && is_enough {
                break;
            }
            if is_enough {
                (tolerance, end) = (goal.tolerance, End::Stagnated);
                continue;
            }
            let off = missing.abs() / size;
            let next = match last.filter(|(_, found_before)| *found_before != found) {
                Some((force_before, found_before)) => force + missing * (force - force_before) / (found - found_before),
                None => force * (1.0 + off.clamp(FIRST.0, FIRST.1).copysign(missing)),
            };
            last = Some((force, found));
            self.secant = last;
            end = End::Stagnated;
            if !next.is_finite() {
                break;
            }
            force = next.clamp(force / FURTHEST, FURTHEST * force);
            tolerance = goal.tolerance.max(tolerance.min(off));
        }
        Ok(end)
    }
}
