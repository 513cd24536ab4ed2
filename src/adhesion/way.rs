//! Continuation along a branch of states, by the approach. Each state starts from the line through the two before it. Newton's method takes cautious
//! steps, to a tolerance that distinguishes the forces of neighbouring states. If it fails, or if the contact changes by much, the step is halved. If
//! short steps fail too, the branch ends and the bodies snap. Descent is faster far beyond the end of a branch than next to it. So snaps take long
//! steps.

use super::level::{Level, MakeFrozen};
use super::majorise::Descent;
use super::newton::{newton, End, Goal, Pace};
use super::place::{Place, Walk};
use super::robust;
use crate::error::Result;
use crate::progress::Monitor;

/// The tolerance of each measure of the states on a way, and of states in small steps.
const WAY_TOLERANCE: f64 = 1e-3;
const SMALL_STEP_TOLERANCE: f64 = 1e-4;
/// The most Newton steps for one state.
const MOST_NEWTON_STEPS: u64 = 14;
/// The most halvings of a step, and doublings of a step over a snap.
const HALVINGS: u32 = 2;
const SNAP_DOUBLINGS: u32 = 2;
/// A snap may take this many times the cycles of a state on the way.
const SNAP_CYCLES: u64 = 4;
/// If a state took at most EASY_STEPS Newton steps, the next step along the branch is GROWTH times as long.
const EASY_STEPS: u64 = 6;
pub const GROWTH: f64 = 1.5;
/// The first step after a snap is this fraction of the longest step.
const AFTER_SNAP: f64 = 0.25;
/// The contact has snapped if its number of elements changes by more than this fraction plus this number.
const SNAPPED: (f64, f64) = (0.5, 8.0);

/// Continues from state to state on one grid.
pub struct Walker<'a, 'm, 'c> {
    pub level: &'a mut Level,
    pub goal: Goal,
    pub make: MakeFrozen<'a>,
    pub monitor: &'m mut Monitor<'c>,
    /// The most cycles for each state on the way. A state that needs more counts as not found.
    pub each: u64,
}

/// The current point of a continuation.
pub struct Way {
    pub here: Place,
    before: Place,
    /// Whether both states give a line to extrapolate.
    has_before: bool,
    /// Elements in contact in the current state.
    count: usize,
    /// Whether steps are small.
    is_close: bool,
    /// The next step, and the longest one.
    pub step: f64,
    pub longest: f64,
}

impl Way {
    /// Starts from the state of a level.
    pub fn from(level: &Level, sum: f64, longest: f64, is_close: bool) -> Result<Way> {
        let (here, before) = (Place::of(level, sum)?, Place::of(level, sum)?);
        Ok(Way { here, before, has_before: false, count: count_contact(level), is_close, step: longest, longest })
    }

    /// Distance in approach from a state with this sum and approach to the wanted sum, on the line from here: 0 if it is reached, and infinite
    /// if the line leads away.
    pub fn distance_to(&self, wanted: f64, (sum, approach): (f64, f64)) -> f64 {
        let slope = (self.here.sum - sum) / (self.here.approach() - approach);
        match sum - wanted {
            left if left <= 0.0 => 0.0,
            left if slope > 0.0 => left / slope,
            _ => f64::INFINITY,
        }
    }

    /// Moves on to the state of the level.
    pub fn take(&mut self, level: &Level, sum: f64) -> Result<()> {
        let count = count_contact(level);
        // There is no extrapolation over a snap.
        self.has_before = !self.is_snap(count);
        if !self.has_before {
            self.step = AFTER_SNAP * self.longest;
        }
        self.count = count;
        std::mem::swap(&mut self.here, &mut self.before);
        self.here.take(level, sum)
    }

    /// Whether a contact of `count` elements indicates another branch.
    fn is_snap(&self, count: usize) -> bool {
        let (part, few) = SNAPPED;
        self.count.abs_diff(count) as f64 > part * self.count as f64 + few
    }
}

/// The elements in contact.
pub fn count_contact(level: &Level) -> usize {
    level.now.contact.iter().filter(|&&inside| inside).count()
}

impl<'a, 'm, 'c> Walker<'a, 'm, 'c> {
    /// Starts from the state of a grid. Each state may take all cycles of the goal.
    pub fn new(level: &'a mut Level, goal: Goal, make: MakeFrozen<'a>, monitor: &'m mut Monitor<'c>) -> Self {
        Walker { level, goal, make, monitor, each: u64::MAX }
    }

    /// Solves at an approach, from the state of the level. Returns the sum of p; none if no state is found.
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
    /// Computes the next state of a way in the level. Its approach is at or above `approach`, or beyond it after a snap. None if no state is found.
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
                let is_easy = self.monitor.count.cycles - cycles <= EASY_STEPS;
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

    /// Computes a state at an approach, from the line through the last two. None if Newton's method fails or the contact is on another branch.
    fn advance(&mut self, way: &Way, approach: f64) -> Result<Option<f64>> {
        let Way { here, before, .. } = way;
        let now = &mut self.level.now;
        now.copy_from(&here.at)?;
        if way.has_before {
            let part = (approach - here.approach()) / (here.approach() - before.approach());
            now.go_along(&before.at, part, &self.level.problem.threads);
        }
        now.p.border = [approach];
        let most = self.goal.most.min(self.monitor.count.cycles.saturating_add(MOST_NEWTON_STEPS.min(self.each)));
        let enough = match self.goal.wanted {
            // Forces are compared with the prescribed force.
            Some(_) => 0.0,
            None if way.is_close => SMALL_STEP_TOLERANCE,
            None => WAY_TOLERANCE,
        };
        let tolerance = self.goal.tolerance.max(enough);
        let goal = Goal { wanted: None, tolerance, certified: false, most, pace: Pace::Cautious };
        let (end, measured) = newton(self.level, goal, !way.has_before, self.monitor)?;
        let is_found = end == End::Solved && !way.is_snap(measured.count);
        Ok(is_found.then_some(measured.pressures))
    }

    /// Crosses the end of a branch. That may take more cycles than a state on the branch.
    fn snap(&mut self, way: &Way) -> Result<Option<f64>> {
        let each = self.each;
        self.each = each.saturating_mul(SNAP_CYCLES);
        let found = self.leap(way);
        self.each = each;
        found
    }

    /// Finds a state beyond the end, by longer and longer steps.
    fn leap(&mut self, way: &Way) -> Result<Option<f64>> {
        let mut by = way.longest;
        for leap in 0..=SNAP_DOUBLINGS {
            self.level.now.copy_from(&way.here.at)?;
            let found = self.solve_at(way.here.approach() - by)?;
            log::debug!("adhesion: after a snap {found:?}, {by:e} beyond an approach of {:e}", way.here.approach());
            if self.goal.is_interrupted(self.monitor) {
                return Ok(None);
            }
            // Bodies that are apart after a leap of more than one step may still touch after a shorter one.
            if found.is_some() && (leap == 0 || self.level.now.contact.contains(&true)) {
                return Ok(found);
            }
            by *= 2.0;
        }
        Ok(None)
    }
}
