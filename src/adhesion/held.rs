//! Finds the stable state under a prescribed force. If an equilibrium under this force is unstable, the stable one lies at a larger approach.

use super::begin::Search;
use super::levels::prolong;
use super::majorise::Descent;
use super::nested::{self, coarse_goal};
use super::newton::{newton, End, Goal};
use super::path::{Continuation, GROWTH};
use super::states::{PathEnd, SavedState, StateSums};
use super::tangent::is_stable;
use crate::error::Result;

/// The largest number of secant steps between two states.
const MOST_SECANTS: u32 = 40;
/// The smallest distance of a secant step from both states, relative to the distance between them.
const SECANT_MARGIN: f64 = 0.02;
/// The largest number of steps of increasing approach. Each is [`GROWTH`] times as long as the one before.
const MOST_STEPS: u32 = 80;
/// The first of these steps, relative to the length of the contact.
const FIRST_STEP: f64 = 0.02;
/// A prescribed pull is also sought on the paths of a pull-off if it is weaker than this many times the strongest pull that was found.
const PULL_MARGIN: f64 = 1.02;

impl Continuation<'_, '_, '_> {
    /// Keeps the level's equilibrium under the wanted force if it is stable. Otherwise climbs to the stable one.
    pub fn settle(&mut self) -> Result<PathEnd> {
        let Some(wanted) = self.goal.wanted else { return Ok(PathEnd::Found) };
        if is_stable(self.level, true, self.monitor)? {
            return Ok(PathEnd::Found);
        }
        log::debug!("adhesion: an equilibrium at an approach of {:e} is not stable", self.level.now.approach());
        self.climb(wanted)
    }

    /// Increases the approach from the state of the level, whose sum of p is at most the wanted one, to the stable state under the wanted force.
    pub fn climb(&mut self, mut sum_low: f64) -> Result<PathEnd> {
        let Some(wanted) = self.goal.wanted else { return Ok(PathEnd::Lost) };
        let mut step = self.first_step(FIRST_STEP)?;
        if !(step > 0.0) {
            return Ok(PathEnd::Lost);
        }
        let mut best = SavedState::of(self.level, sum_low)?;
        let mut low = best.approach();
        for _ in 0..MOST_STEPS {
            let approach = low + step;
            let Some(sum) = self.solve_at(approach)? else { break };
            if sum > wanted {
                best.take(self.level, sum)?;
                return self.between(&mut best, (sum_low, low));
            }
            (low, sum_low) = (approach, sum);
            step *= GROWTH;
        }
        self.level.now.copy_from(&best.unknowns)?;
        Ok(self.lost())
    }

    /// Finds the stable state under the wanted force between the state `best`, of larger force, and a state of smaller force, given by its sum
    /// and approach.
    pub fn between(&mut self, best: &mut SavedState, (mut sum_low, mut low): (f64, f64)) -> Result<PathEnd> {
        let Some(wanted) = self.goal.wanted else { return Ok(PathEnd::Lost) };
        for secant in 0..MOST_SECANTS {
            if self.goal.is_interrupted(self.monitor) {
                self.level.now.copy_from(&best.unknowns)?;
                return Ok(PathEnd::Interrupted);
            }
            let part = ((best.sum - wanted) / (best.sum - sum_low)).clamp(SECANT_MARGIN, 1.0 - SECANT_MARGIN);
            // Every third step bisects, because secants may stall near one end.
            let part = if secant % 3 == 2 { 0.5 } else { part };
            let approach = best.approach() + part * (low - best.approach());
            self.level.now.copy_from(&best.unknowns)?;
            self.level.now.p.border = [approach];
            let (end, _) = newton(self.level, self.goal, true, self.monitor)?;
            let (reached, slack) = (self.level.now.approach(), best.approach() - low);
            let is_near = reached <= best.approach() + slack && reached >= low - slack;
            if end == End::Solved && is_near && is_stable(self.level, true, self.monitor)? {
                return Ok(PathEnd::Found);
            }
            self.level.now.copy_from(&best.unknowns)?;
            match self.solve_at(approach)? {
                Some(sum) if sum > wanted => best.take(self.level, sum)?,
                Some(sum) => (sum_low, low) = (sum, approach),
                None => {
                    self.level.now.copy_from(&best.unknowns)?;
                    return Ok(self.lost());
                }
            }
        }
        Ok(PathEnd::Lost)
    }
}

impl Search<'_, '_, '_> {
    /// Follows the stable branch down on the coarsest grid, which is cheap, and then solves for the force from grid to grid. Returns false if
    /// there is only one grid, if a solve fails, or if the result is not stable.
    pub fn is_found_from_coarse(&mut self, goal: Goal) -> Result<bool> {
        let last = self.levels.len() - 1;
        if last == 0 {
            return Ok(false);
        }
        let coarse = coarse_goal(self.levels, last, goal);
        let unloaded = Goal { wanted: Some(0.0), ..coarse };
        self.levels[last].fields = std::mem::take(&mut self.levels[0].fields);
        self.monitor.enter_grid();
        let ended = nested::solve(&mut self.levels[last..], unloaded, (self.start, self.make), self.monitor)?;
        let is_found = ended.end == Descent::By(End::Solved)
            && Continuation::new(&mut self.levels[last], coarse, self.make, self.monitor).follow(None)?
                == PathEnd::Found;
        if !is_found {
            return Ok(false);
        }
        for l in (0..last).rev() {
            let (fine, below) = self.levels.split_at_mut(l + 1);
            prolong(&mut below[0], &mut fine[l])?;
            let goal = coarse_goal(self.levels, l, goal);
            self.monitor.enter_grid();
            let (end, _) = newton(&mut self.levels[l], goal, false, self.monitor)?;
            if end != End::Solved {
                return Ok(false);
            }
        }
        is_stable(&mut self.levels[0], true, self.monitor)
    }

    /// Seeks a state for a pull that is slightly stronger than the strongest one of `known`, the end of the earlier paths. Elements that are
    /// coarse for the range separate one by one, so that the strongest pull depends on the steps of a path. The paths of a pull-off have other
    /// steps, because they do not stop at a force. If the pull-off holds the prescribed pull, `climb` finds the state under this pull. If it only
    /// holds more than `known`, its end replaces `known`.
    pub fn hold_pull_off(&mut self, known: PathEnd, goal: Goal) -> Result<PathEnd> {
        let Some(wanted) =
            goal.wanted.filter(|wanted| matches!(known, PathEnd::Least { sum, .. } if *wanted > PULL_MARGIN * sum))
        else {
            return Ok(known);
        };
        let strongest = SavedState::of(&self.levels[0], StateSums::of(&self.levels[0]).sum)?;
        let path_end = self.down_from_no_load(Goal { wanted: None, ..goal })?;
        match (path_end, known) {
            (PathEnd::Least { sum, .. }, _) if sum <= wanted => {
                let most = self.monitor.count.cycles.saturating_add(goal.most);
                self.continuation(Goal { most, ..goal }).climb(sum)
            }
            (PathEnd::Least { sum, .. }, PathEnd::Least { sum: least, .. }) if sum < least => Ok(path_end),
            (PathEnd::Interrupted, _) => {
                let level = &mut self.levels[0];
                level.refresh()?;
                level.count_products(self.monitor);
                let measured = level.measure(false, None);
                if !(measured.is_state(goal.tolerance) && measured.pressures < strongest.sum) {
                    level.now.copy_from(&strongest.unknowns)?;
                }
                Ok(path_end)
            }
            _ => Ok(known),
        }
    }
}
