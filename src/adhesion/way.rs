//! A way along a branch, by the approach. Each state begins on the line through the two before it, and Newton's method takes cautious steps, to a tolerance
//! that tells one force from another. Where that fails, or the contact changes by much, steps are halved. Where short steps fail, too, the branch ends: the
//! bodies snap. Far beyond the end of a branch descent is faster than next to it, so that snaps take long steps.

use super::level::{Level, MakeFrozen};
use super::majorise::Descent;
use super::newton::{newton, End, Goal, Pace};
use super::place::{Place, Walk};
use super::robust;
use crate::error::Result;
use crate::progress::Monitor;

/// Each measure of the states on a way, and of those in small steps.
const ON_THE_WAY: f64 = 1e-3;
const IN_SMALL_STEPS: f64 = 1e-4;
/// Steps of Newton's method, of one state.
const TRIED: u64 = 14;
/// Halvings of a step, and doublings of one over a snap.
const HALVINGS: u32 = 2;
const LEAPS: u32 = 2;
/// A snap may take this factor times the cycles of a state on the way.
const LONGER: u64 = 4;
/// After so few steps of Newton's method the next step is longer, by this factor.
const EASY: u64 = 6;
const GROWTH: f64 = 1.5;
/// The first step after a snap is this part of others.
const AFTER_SNAP: f64 = 0.25;
/// The contact has snapped where this part of it changes, and so many elements more; in one small step.
const SNAPPED: (f64, f64) = (0.5, 8.0);
const SNAPPED_CLOSE: (f64, f64) = (0.25, 4.0);

/// Goes from state to state on one grid.
pub struct Walker<'a, 'm, 'c> {
    pub level: &'a mut Level,
    pub goal: Goal,
    pub make: MakeFrozen<'a>,
    pub monitor: &'m mut Monitor<'c>,
    /// Cycles of each state on the way at most: more are a state that is not found.
    pub each: u64,
}

/// Where a walk is.
pub struct Way {
    pub here: Place,
    before: Place,
    /// Whether the line through both leads on.
    has_before: bool,
    /// Elements in contact here.
    count: usize,
    /// Whether steps are small.
    is_close: bool,
    /// The next step, and the longest one.
    pub step: f64,
    pub longest: f64,
}

impl Way {
    /// From what a level holds.
    pub fn from(level: &Level, sum: f64, longest: f64, is_close: bool) -> Result<Way> {
        let (here, before) = (Place::of(level, sum)?, Place::of(level, sum)?);
        Ok(Way { here, before, has_before: false, count: count_contact(level), is_close, step: longest, longest })
    }

    /// How far a way that comes to an approach with this sum is from another sum, on the line from where it is: 0 if it is there, and infinite if it leads away.
    pub fn distance_to(&self, wanted: f64, (sum, approach): (f64, f64)) -> f64 {
        let slope = (self.here.sum - sum) / (self.here.approach() - approach);
        match sum - wanted {
            left if left <= 0.0 => 0.0,
            left if slope > 0.0 => left / slope,
            _ => f64::INFINITY,
        }
    }

    /// Goes on to what the level holds.
    pub fn take(&mut self, level: &Level, sum: f64) -> Result<()> {
        let count = count_contact(level);
        // The line does not lead over a snap.
        self.has_before = !self.is_snap(count);
        if !self.has_before {
            self.step = AFTER_SNAP * self.longest;
        }
        self.count = count;
        std::mem::swap(&mut self.here, &mut self.before);
        self.here.take(level, sum)
    }

    /// Whether so many elements in contact are those of another branch.
    fn is_snap(&self, count: usize) -> bool {
        let (part, few) = if self.is_close { SNAPPED_CLOSE } else { SNAPPED };
        self.count.abs_diff(count) as f64 > part * self.count as f64 + few
    }
}

fn count_contact(level: &Level) -> usize {
    level.now.contact.iter().filter(|&&inside| inside).count()
}

impl<'a, 'm, 'c> Walker<'a, 'm, 'c> {
    /// On a grid, from what it holds; each state may take all cycles of the goal.
    pub fn new(level: &'a mut Level, goal: Goal, make: MakeFrozen<'a>, monitor: &'m mut Monitor<'c>) -> Self {
        Walker { level, goal, make, monitor, each: u64::MAX }
    }

    /// The sum of p at an approach, from what the level holds; none where no state is found.
    pub fn solve_at(&mut self, approach: f64) -> Result<Option<f64>> {
        self.level.now.p.border = [approach];
        let most = self.goal.most.min(self.monitor.count.cycles.saturating_add(self.each));
        let by_approach = Goal { wanted: None, most, pace: Pace::Cautious, ..self.goal };
        let ended = robust::solve(self.level, by_approach, (true, self.make), self.monitor)?;
        Ok((ended.end == Descent::By(End::Solved)).then_some(ended.measured.pressures))
    }

    /// Why no state was found.
    pub fn lost(&self) -> Walk {
        if self.goal.is_interrupted(self.monitor) {
            Walk::Interrupted
        } else {
            Walk::Lost
        }
    }
}

impl Walker<'_, '_, '_> {
    /// The next state of a way, which the level then holds, at an approach or above it; beyond it after a snap. None where none is found.
    pub fn step_to(&mut self, way: &mut Way, approach: f64) -> Result<Option<f64>> {
        let mut by = approach - way.here.approach();
        for halving in 0..=HALVINGS {
            let approach = if halving == 0 { approach } else { way.here.approach() + by };
            let cycles = self.monitor.count.cycles;
            let found = self.advance(way, approach)?;
            if self.goal.is_interrupted(self.monitor) {
                return Ok(None);
            }
            if found.is_some() {
                let is_easy = self.monitor.count.cycles - cycles <= EASY;
                let wide = if halving == 0 { way.step } else { 0.0 };
                log::debug!("adhesion: {found:?} at an approach of {approach:e}, {} in contact", way.count);
                way.step = if is_easy { wide.max(GROWTH * by.abs()).min(way.longest) } else { by.abs() };
                return Ok(found);
            }
            way.has_before = false;
            by *= 0.5;
        }
        self.snap(way)
    }

    /// A state at an approach, from the line through the last two. None where Newton's method fails, or the contact is another one.
    fn advance(&mut self, way: &Way, approach: f64) -> Result<Option<f64>> {
        let Way { here, before, .. } = way;
        let now = &mut self.level.now;
        now.copy_from(&here.at)?;
        if way.has_before {
            let part = (approach - here.approach()) / (here.approach() - before.approach());
            now.go_along(&before.at, part, &self.level.problem.threads);
        }
        now.p.border = [approach];
        let most = self.goal.most.min(self.monitor.count.cycles.saturating_add(TRIED.min(self.each)));
        let enough = match self.goal.wanted {
            // Forces are compared with the one that is wanted.
            Some(_) => 0.0,
            None if way.is_close => IN_SMALL_STEPS,
            None => ON_THE_WAY,
        };
        let tolerance = self.goal.tolerance.max(enough);
        let goal = Goal { wanted: None, tolerance, certified: false, most, pace: Pace::Cautious };
        let (end, measured) = newton(self.level, goal, !way.has_before, self.monitor)?;
        let is_found = end == End::Solved && !way.is_snap(measured.count);
        Ok(is_found.then_some(measured.pressures))
    }

    /// Over the end of a branch, which may take more cycles than a state on it.
    fn snap(&mut self, way: &Way) -> Result<Option<f64>> {
        let each = self.each;
        self.each = each.saturating_mul(LONGER);
        let found = self.leap(way);
        self.each = each;
        found
    }

    /// To a state beyond, by longer and longer steps.
    fn leap(&mut self, way: &Way) -> Result<Option<f64>> {
        let mut by = way.longest;
        for leap in 0..=LEAPS {
            self.level.now.copy_from(&way.here.at)?;
            let found = self.solve_at(way.here.approach() - by)?;
            log::debug!("adhesion: after a snap {found:?}, {by:e} beyond an approach of {:e}", way.here.approach());
            if self.goal.is_interrupted(self.monitor) {
                return Ok(None);
            }
            // Bodies that are apart after more than a step may have been in contact after less.
            if found.is_some() && (leap == 0 || self.level.now.contact.contains(&true)) {
                return Ok(found);
            }
            by *= 2.0;
        }
        Ok(None)
    }
}
