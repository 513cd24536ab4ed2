//! Continuation along a branch of states, with the approach as the parameter. Each state starts from the line through the two states before it.
//! Newton's method takes cautious steps, to a tolerance that distinguishes the forces of neighbouring states. If it fails, or if the contact area
//! changes by much, the step of the approach is halved. If short steps also fail, the branch ends and the bodies snap. Descent is faster far
//! beyond the end of a branch than next to it; therefore the step over a snap is long.

use super::level::{Level, MakeFrozen};
use super::majorise::Descent;
use super::newton::{newton, End, Goal, Pace};
use super::robust;
use super::states::{PathEnd, SavedState};
use crate::error::Result;
use crate::progress::Monitor;

/// The tolerance of each residual of the states on a path, and of states in small steps.
const PATH_TOLERANCE: f64 = 1e-3;
const SMALL_STEP_TOLERANCE: f64 = 1e-4;
/// The largest number of Newton steps for one state.
const MOST_NEWTON_STEPS: u64 = 14;
/// The largest number of halvings of a step along a branch, and of doublings of a step over a snap.
const HALVINGS: u32 = 2;
const SNAP_DOUBLINGS: u32 = 2;
/// A step over a snap may take this many times the cycles of a state on the path.
const SNAP_CYCLES: u64 = 4;
/// If a state takes at most EASY_STEPS Newton steps, the next step along the branch is GROWTH times as long.
const EASY_STEPS: u64 = 6;
pub const GROWTH: f64 = 1.5;
/// The first step after a snap, as a fraction of the longest step.
const AFTER_SNAP: f64 = 0.25;
/// The contact has snapped if the number of elements in contact changes by more than this fraction of it plus this number.
const SNAPPED: (f64, f64) = (0.5, 8.0);

/// Continues from state to state on one grid, towards a goal.
pub struct Continuation<'a, 'm, 'c> {
    /// The grid with the current state.
    pub level: &'a mut Level,
    /// The goal. Its force, if one is wanted, ends the path.
    pub goal: Goal,
    /// Makes the solver of contact problems with frozen attraction.
    pub make: MakeFrozen<'a>,
    /// Counts cycles and products, and tells whether the caller cancelled.
    pub monitor: &'m mut Monitor<'c>,
    /// The largest number of cycles for each state on the path. A state that needs more counts as not found.
    pub each: u64,
}

/// The current point of a path: the last two states, and the next step.
pub struct Path {
    /// The last state.
    pub here: SavedState,
    /// The state before.
    before: SavedState,
    /// Whether the line through both states can be extrapolated.
    has_before: bool,
    /// The number of elements in contact in the last state.
    count: usize,
    /// Whether the path consists of small steps, whose states have the smaller tolerance.
    is_close: bool,
    /// The length of the next step, as a decrease of the approach.
    pub step: f64,
    /// The length of the longest step.
    pub longest: f64,
}

impl Path {
    /// A path that starts at the state of a level, with the sum of p. `is_close`: with small steps.
    pub fn from(level: &Level, sum: f64, longest: f64, is_close: bool) -> Result<Path> {
        let (here, before) = (SavedState::of(level, sum)?, SavedState::of(level, sum)?);
        Ok(Path { here, before, has_before: false, count: count_contact(level), is_close, step: longest, longest })
    }

    /// The distance in approach from a state with this sum and approach to the state with the sum `wanted`, on the line from `here` through the
    /// former. It is 0 if the sum is reached, and infinite if the line leads away.
    pub fn distance_to(&self, wanted: f64, (sum, approach): (f64, f64)) -> f64 {
        let slope = (self.here.sum - sum) / (self.here.approach() - approach);
        match sum - wanted {
            left if left <= 0.0 => 0.0,
            left if slope > 0.0 => left / slope,
            _ => f64::INFINITY,
        }
    }

    /// Makes the state of the level the last one of the path.
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

    /// Whether a contact area of `count` elements indicates another branch.
    fn is_snap(&self, count: usize) -> bool {
        let (part, few) = SNAPPED;
        self.count.abs_diff(count) as f64 > part * self.count as f64 + few
    }
}

/// The number of elements in contact.
pub fn count_contact(level: &Level) -> usize {
    level.now.contact.iter().filter(|&&inside| inside).count()
}

impl<'a, 'm, 'c> Continuation<'a, 'm, 'c> {
    /// A continuation from the state of a grid. Each state may take all cycles of the goal.
    pub fn new(level: &'a mut Level, goal: Goal, make: MakeFrozen<'a>, monitor: &'m mut Monitor<'c>) -> Self {
        Continuation { level, goal, make, monitor, each: u64::MAX }
    }

    /// Solves at an approach, from the state of the level. Returns the sum of p, or `None` if no state is found.
    pub fn solve_at(&mut self, approach: f64) -> Result<Option<f64>> {
        self.level.now.p.border = [approach];
        let most = self.goal.most.min(self.monitor.count.cycles.saturating_add(self.each));
        let by_approach = Goal { wanted: None, most, pace: Pace::Cautious, ..self.goal };
        let ended = robust::solve(self.level, by_approach, (true, self.make), self.monitor)?;
        Ok((ended.end == Descent::By(End::Solved)).then_some(ended.measured.pressures))
    }

    /// How the path ends if no state is found: interrupted or lost.
    pub fn lost(&self) -> PathEnd {
        if self.goal.is_interrupted(self.monitor) {
            PathEnd::Interrupted
        } else {
            PathEnd::Lost
        }
    }
}

impl Continuation<'_, '_, '_> {
    /// Computes the next state of a path in the level, and returns its sum of p; `None` if no state is found. The approach of the state is at or
    /// above `approach`, or beyond it after a snap.
    pub fn step_to(&mut self, path: &mut Path, approach: f64) -> Result<Option<f64>> {
        let mut by = approach - path.here.approach();
        for halving in 0..=HALVINGS {
            let approach = if halving == 0 { approach } else { path.here.approach() + by };
            let cycles = self.monitor.count.cycles;
            let found = self.advance(path, approach)?;
            if self.goal.is_interrupted(self.monitor) {
                return Ok(None);
            }
            if found.is_some() {
                let is_easy = self.monitor.count.cycles - cycles <= EASY_STEPS;
                let wide = if halving == 0 { path.step } else { 0.0 };
                log::debug!("adhesion: {found:?} at an approach of {approach:e}, {} in contact", path.count);
                path.step = if is_easy { wide.max(GROWTH * by.abs()).min(path.longest) } else { by.abs() };
                return Ok(found);
            }
            path.has_before = false;
            by *= 0.5;
        }
        self.snap(path)
    }

    /// Computes a state at an approach by Newton's method, from the line through the last two states. `None` if the method fails or the contact
    /// area indicates another branch.
    fn advance(&mut self, path: &Path, approach: f64) -> Result<Option<f64>> {
        let Path { here, before, .. } = path;
        let now = &mut self.level.now;
        now.copy_from(&here.unknowns)?;
        if path.has_before {
            let part = (approach - here.approach()) / (here.approach() - before.approach());
            now.go_along(&before.unknowns, part, &self.level.problem.threads);
        }
        now.p.border = [approach];
        let most = self.goal.most.min(self.monitor.count.cycles.saturating_add(MOST_NEWTON_STEPS.min(self.each)));
        let enough = match self.goal.wanted {
            // The force of the state is compared with the prescribed force.
            Some(_) => 0.0,
            None if path.is_close => SMALL_STEP_TOLERANCE,
            None => PATH_TOLERANCE,
        };
        let tolerance = self.goal.tolerance.max(enough);
        let goal = Goal { wanted: None, tolerance, certified: false, most, pace: Pace::Cautious };
        let (end, measured) = newton(self.level, goal, !path.has_before, self.monitor)?;
        let is_found = end == End::Solved && !path.is_snap(measured.count);
        Ok(is_found.then_some(measured.pressures))
    }

    /// Steps over the end of a branch, with more cycles than a state on the branch may take.
    fn snap(&mut self, path: &Path) -> Result<Option<f64>> {
        let each = self.each;
        self.each = each.saturating_mul(SNAP_CYCLES);
        let found = self.step_over(path);
        self.each = each;
        found
    }

    /// Finds a state beyond the end of a branch, by longer and longer steps.
    fn step_over(&mut self, path: &Path) -> Result<Option<f64>> {
        let mut by = path.longest;
        for doubling in 0..=SNAP_DOUBLINGS {
            self.level.now.copy_from(&path.here.unknowns)?;
            let found = self.solve_at(path.here.approach() - by)?;
            log::debug!("adhesion: after a snap {found:?}, {by:e} beyond an approach of {:e}", path.here.approach());
            if self.goal.is_interrupted(self.monitor) {
                return Ok(None);
            }
            // Bodies that are apart after a step of more than the first length may still touch after a shorter one. Such a state is not accepted.
            if found.is_some() && (doubling == 0 || self.level.now.contact.contains(&true)) {
                return Ok(found);
            }
            by *= 2.0;
        }
        Ok(None)
    }
}
