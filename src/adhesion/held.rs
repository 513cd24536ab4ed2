//! The stable state under a prescribed force. If an equilibrium under this force is unstable, the stable one lies at a larger approach.

use super::begin::Search;
use super::levels::prolong;
use super::majorise::Descent;
use super::nested::{self, coarse_goal};
use super::newton::{newton, End, Goal};
use super::place::{Met, Place, Walk};
use super::tangent::is_stable;
use super::way::{Walker, GROWTH};
use crate::error::Result;

/// Most secant steps between two states.
const MOST_SECANTS: u32 = 40;
/// Least distance of a secant step from both states, relative to the distance between them.
const SECANT_MARGIN: f64 = 0.02;
/// Most steps of growing approach; each is [`GROWTH`] times as long as the one before.
const MOST_STEPS: u32 = 80;
/// The first of these steps, relative to the length of the contact.
const FIRST_STEP: f64 = 0.02;
/// A prescribed pull is also sought on the branches of a pull-off if it is weaker than this many times the strongest
/// pull found.
const PULL_MARGIN: f64 = 1.02;

impl Walker<'_, '_, '_> {
    /// Keeps the level's equilibrium of the wanted force if it is stable. Otherwise climbs to the stable one.
    pub fn settle(&mut self) -> Result<Walk> {
        let Some(wanted) = self.goal.wanted else { return Ok(Walk::Found) };
        if is_stable(self.level, true, self.monitor)? {
            return Ok(Walk::Found);
        }
        log::debug!("adhesion: an equilibrium at an approach of {:e} is not stable", self.level.now.approach());
        self.climb(wanted)
    }

    /// Increases the approach from the level's state, whose sum is at most the wanted one, to the stable state of the wanted force.
    pub fn climb(&mut self, mut sum_low: f64) -> Result<Walk> {
        let Some(wanted) = self.goal.wanted else { return Ok(Walk::Lost) };
        let mut step = self.first_step(FIRST_STEP)?;
        if !(step > 0.0) {
            return Ok(Walk::Lost);
        }
        let mut best = Place::of(self.level, sum_low)?;
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
        self.level.now.copy_from(&best.at)?;
        Ok(self.lost())
    }

    /// The state of the wanted force, between the `best` state of more force and a state of less.
    pub fn between(&mut self, best: &mut Place, (mut sum_low, mut low): (f64, f64)) -> Result<Walk> {
        let Some(wanted) = self.goal.wanted else { return Ok(Walk::Lost) };
        for secant in 0..MOST_SECANTS {
            if self.goal.is_interrupted(self.monitor) {
                self.level.now.copy_from(&best.at)?;
                return Ok(Walk::Interrupted);
            }
            let part = ((best.sum - wanted) / (best.sum - sum_low)).clamp(SECANT_MARGIN, 1.0 - SECANT_MARGIN);
            // Every third step bisects: secants may stall near one end.
            let part = if secant % 3 == 2 { 0.5 } else { part };
            let approach = best.approach() + part * (low - best.approach());
            self.level.now.copy_from(&best.at)?;
            self.level.now.p.border = [approach];
            let (end, _) = newton(self.level, self.goal, true, self.monitor)?;
            let (reached, slack) = (self.level.now.approach(), best.approach() - low);
            let is_near = reached <= best.approach() + slack && reached >= low - slack;
            if end == End::Solved && is_near && is_stable(self.level, true, self.monitor)? {
                return Ok(Walk::Found);
            }
            self.level.now.copy_from(&best.at)?;
            match self.solve_at(approach)? {
                Some(sum) if sum > wanted => best.take(self.level, sum)?,
                Some(sum) => (sum_low, low) = (sum, approach),
                None => {
                    self.level.now.copy_from(&best.at)?;
                    return Ok(self.lost());
                }
            }
        }
        Ok(Walk::Lost)
    }
}

impl Search<'_, '_, '_> {
    /// Follows the stable branch down on the coarsest grid, which is cheap, then solves for the force from grid to grid. Returns false if there is
    /// one grid only, if a solve fails, or if the result is not stable.
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
            && Walker::new(&mut self.levels[last], coarse, self.make, self.monitor).walk(None)? == Walk::Found;
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

    /// Seeks a state for a pull slightly stronger than the strongest one of the walk `known`. Elements that are coarse for the range separate
    /// one by one, so the strongest pull depends on the steps of the walk. A pull-off takes other steps, because it does not stop at a force. If
    /// it holds the prescribed pull, `climb` finds the state of that pull. If it only holds more than `known`, its end replaces `known`.
    pub fn hold_pull_off(&mut self, known: Walk, goal: Goal) -> Result<Walk> {
        let Some(wanted) =
            goal.wanted.filter(|wanted| matches!(known, Walk::Least { sum, .. } if *wanted > PULL_MARGIN * sum))
        else {
            return Ok(known);
        };
        let strongest = Place::of(&self.levels[0], Met::of(&self.levels[0]).sum)?;
        let walk = self.down_from_no_load(Goal { wanted: None, ..goal })?;
        match (walk, known) {
            (Walk::Least { sum, .. }, _) if sum <= wanted => {
                let most = self.monitor.count.cycles.saturating_add(goal.most);
                self.walker(Goal { most, ..goal }).climb(sum)
            }
            (Walk::Least { sum, .. }, Walk::Least { sum: least, .. }) if sum < least => Ok(walk),
            (Walk::Interrupted, _) => {
                let level = &mut self.levels[0];
                level.refresh()?;
                level.count_products(self.monitor);
                let measured = level.measure(false, None);
                if !(measured.is_state(goal.tolerance) && measured.pressures < strongest.sum) {
                    level.now.copy_from(&strongest.at)?;
                }
                Ok(walk)
            }
            _ => Ok(known),
        }
    }
}
