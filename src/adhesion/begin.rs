//! Solves without an initial state. A state under a pull, or without a force, is reached along a stable branch, with the force decreasing from a
//! state of larger force.

use super::level::{Level, MakeFrozen};
use super::majorise::Descent;
use super::nested;
use super::newton::{End, Goal};
use super::path::Continuation;
use super::start::Start;
use super::states::{PathEnd, SavedState, StateSums};
use super::unknowns::Unknowns;
use crate::error::{Error, Result, Rounded};
use crate::progress::Monitor;

/// The first force that presses bodies together if neither a known pull nor a wanted force sets its size, as a fraction of the sum of the
/// attraction at a distance of 0.
const FIRST_PRESSING_FORCE: f64 = 0.01;
/// Otherwise the first pressing force is PRESSING_FORCE_RATIO times the strongest known pull or times a wanted pressing force. Each further one
/// is this ratio times the strongest known pull, or times the one before.
const PRESSING_FORCE_RATIO: f64 = 10.0;
/// The largest number of paths that lead down from bodies pressed together, and of paths that begin below the end of a lost path.
const MOST_PATHS: u32 = 4;
/// A pull weaker than this fraction of the sum of the attraction counts as none. A pull counts as stronger than another one if it exceeds it by
/// this fraction.
const LEAST_PULL: f64 = 1e-6;
/// The first path of a search for a pull may take the cycles of PULL_OFF_CYCLES solves.
const PULL_OFF_CYCLES: u64 = 3;
/// Each state on the path of a pull-off may take 1/STATES_OF_PULL_OFF of the cycles of a solve.
const STATES_OF_PULL_OFF: u64 = 4;
/// If the path of a pull-off is lost, further paths begin below its end. Their starting state is sought at up to STEPS_BELOW approaches, each
/// STEP_BELOW times the length of the contact (`length` in `pull`) below the one before.
const STEPS_BELOW: u32 = 6;
const STEP_BELOW: f64 = 0.1;
/// A further path may take FURTHER_PATH_CYCLES times the cycles of the first path plus LEAST_PATH_CYCLES, or those of a solve if that is more.
const FURTHER_PATH_CYCLES: u64 = 4;
const LEAST_PATH_CYCLES: u64 = 500;

/// A search for the state of a goal on the finest of some grids.
pub(super) struct Search<'a, 'm, 'c> {
    /// The grids, finest first.
    pub levels: &'a mut [Level],
    /// The start without an initial state.
    pub start: Start,
    /// Makes the solver of contact problems with frozen attraction.
    pub make: MakeFrozen<'a>,
    /// Counts cycles and products, and tells whether the caller cancelled.
    pub monitor: &'m mut Monitor<'c>,
}

impl<'c> Search<'_, '_, 'c> {
    /// Solves without an initial state.
    pub fn begin_anew(&mut self, goal: Goal) -> Result<Descent> {
        if !goal.pulls() {
            return self.begin_pressed(goal);
        }
        if self.is_found_from_coarse(goal)? {
            return Ok(Descent::By(End::Solved));
        }
        let path_end = self.down_from_no_load(goal)?;
        match self.hold_pull_off(path_end, goal)? {
            PathEnd::Found => Ok(Descent::By(End::Solved)),
            PathEnd::Least { sum, approach } => {
                let area = self.levels[0].problem.grid.element_area();
                let force = Rounded(goal.wanted.unwrap_or(0.0) * area);
                let [pull, approach] = [Rounded(sum * area), Rounded(approach)];
                let found = if sum < 0.0 {
                    format!("holds a pull of {pull} (the pull-off force), at an approach of {approach}")
                } else {
                    "does not pull: nothing holds the bodies without a pressing force".into()
                };
                Err(Error::Infeasible(format!(
                    "force is {force}; the strongest state that was found, on the ways down from no load and from bodies pressed together, \
                     {found}"
                )))
            }
            PathEnd::Interrupted if self.monitor.is_cancelled() => Ok(Descent::By(End::Interrupted)),
            path_end => {
                let is_cut = path_end == PathEnd::Interrupted || goal.is_interrupted(self.monitor);
                let end = if is_cut { End::Interrupted } else { End::Failed };
                self.beyond_all_attraction(goal).map_or(Ok(Descent::By(end)), Err)
            }
        }
    }

    /// Solves without an initial state for a given approach, or for a given force that does not pull.
    fn begin_pressed(&mut self, goal: Goal) -> Result<Descent> {
        let ended = nested::solve(self.levels, goal, (self.start, self.make), self.monitor)?;
        if goal.is_interrupted(self.monitor) && ended.end != Descent::By(End::Solved) {
            return Ok(ended.end);
        }
        if ended.is_in_contact() && goal.wanted.is_some() {
            let settled = self.continuation(goal).settle()?;
            if settled == PathEnd::Found {
                return Ok(ended.end);
            }
        } else if ended.is_in_contact() || goal.wanted != Some(0.0) || !(self.most_attraction() > 0.0) {
            return Ok(ended.end);
        }
        let mut found = Unknowns::default();
        found.copy_from(&self.levels[0].now)?;
        // Without a force the bodies may also be apart. A state in which they adhere is sought on paths from larger forces.
        let path_end = self.down_all_paths(goal, false)?;
        if path_end == PathEnd::Found {
            return Ok(Descent::By(End::Solved));
        }
        self.levels[0].now.copy_from(&found)?;
        Ok(match path_end {
            PathEnd::Interrupted => Descent::By(End::Interrupted),
            _ if ended.is_in_contact() => Descent::By(End::Failed),
            _ => ended.end,
        })
    }

    /// A continuation from the state of the finest grid.
    pub fn continuation(&mut self, goal: Goal) -> Continuation<'_, '_, 'c> {
        Continuation::new(&mut self.levels[0], goal, self.make, self.monitor)
    }

    /// The continuation along the first path of a search for a pull. This path has many states, and a snap after the strongest pull. `spent`: the
    /// cycles of the search so far.
    fn first_continuation(&mut self, goal: Goal, spent: u64) -> Continuation<'_, '_, 'c> {
        if goal.wanted.is_some() && !goal.pulls() {
            return self.continuation(goal);
        }
        let left = goal.most.saturating_mul(PULL_OFF_CYCLES).saturating_sub(spent);
        let most = self.monitor.count.cycles.saturating_add(left);
        let each = if goal.wanted.is_some() { u64::MAX } else { goal.most / STATES_OF_PULL_OFF + 1 };
        Continuation { each, ..self.continuation(Goal { most, ..goal }) }
    }

    /// Follows the first path down. The path may be lost if elements are too coarse for the range and snap one after the other. Then another path
    /// begins at a state of smaller approach, which is found without an initial state. Returns the end of the last path, and the cycles of all.
    fn follow_first(&mut self, goal: Goal) -> Result<(PathEnd, u64)> {
        let before = self.monitor.count.cycles;
        let mut ended = self.first_continuation(goal, 0).follow(None)?;
        let mut spent = self.monitor.count.cycles - before;
        for _ in 0..MOST_PATHS {
            if ended != PathEnd::Lost || goal.wanted.is_some() {
                break;
            }
            let lost = SavedState::of(&self.levels[0], StateSums::of(&self.levels[0]).sum)?;
            if !self.is_found_below(goal, &mut spent)? {
                self.levels[0].now.copy_from(&lost.unknowns)?;
                return Ok((PathEnd::Lost, spent));
            }
            let before = self.monitor.count.cycles;
            ended = self.first_continuation(goal, spent).follow(None)?;
            spent += self.monitor.count.cycles - before;
            let is_less = match ended {
                PathEnd::Least { sum, .. } => sum < lost.sum,
                _ => StateSums::of(&self.levels[0]).sum < lost.sum,
            };
            if !is_less {
                self.levels[0].now.copy_from(&lost.unknowns)?;
                return Ok((if ended == PathEnd::Interrupted { ended } else { PathEnd::Lost }, spent));
            }
        }
        Ok((ended, spent))
    }

    /// Seeks a state in contact at smaller approaches than that of the finest grid, without an initial state. Returns whether one is found. Adds
    /// the cycles to `spent`.
    fn is_found_below(&mut self, goal: Goal, spent: &mut u64) -> Result<bool> {
        let from = self.levels[0].now.approach();
        let step = self.continuation(goal).first_step(STEP_BELOW)?;
        let each = Goal { wanted: None, most: goal.most / STATES_OF_PULL_OFF + 1, ..goal };
        for k in (1..=STEPS_BELOW).filter(|_| step > 0.0) {
            self.levels.iter_mut().for_each(|level| level.now.p.border = [from - f64::from(k) * step]);
            let ended = nested::solve(self.levels, each, (Start::Auto, self.make), self.monitor)?;
            // Nested iteration counts the cycles of the finest grid from 0.
            *spent += self.monitor.count.cycles;
            if ended.is_in_contact() || self.monitor.is_cancelled() {
                return Ok(ended.is_in_contact());
            }
        }
        Ok(false)
    }

    /// Solves without a load, and follows the stable branch of the finest grid down from this state.
    pub fn down_from_no_load(&mut self, goal: Goal) -> Result<PathEnd> {
        let unloaded = Goal { wanted: Some(0.0), ..goal };
        let ended = nested::solve(self.levels, unloaded, (self.start, self.make), self.monitor)?;
        self.down_all_paths(goal, ended.is_in_contact())
    }

    /// Follows the stable branch down from the state of the finest grid, if `is_state`, and from bodies pressed together. The latter finds pulls
    /// of bodies of which only one asperity, or none, adheres without a load. The pressing force grows until no stronger pull is found. At the
    /// end the finest grid has the state of the least force.
    pub fn down_all_paths(&mut self, goal: Goal, is_state: bool) -> Result<PathEnd> {
        let (mut least, mut meeting, mut most) = (None::<SavedState>, None, goal.most);
        // `before`: the last state of a lost path, or the initial state. `without`: the result if no least force is found.
        let (mut before, mut without) = (None, PathEnd::Lost);
        if is_state {
            meeting = Some(StateSums::of(&self.levels[0]));
            let (path_end, spent) = self.follow_first(goal)?;
            match path_end {
                PathEnd::Least { sum, .. } => least = Some(SavedState::of(&self.levels[0], sum)?),
                PathEnd::Lost | PathEnd::Joined => {
                    meeting = None;
                    before = Some(SavedState::of(&self.levels[0], StateSums::of(&self.levels[0]).sum)?);
                }
                ended => return Ok(ended),
            }
            most = goal.most.max(FURTHER_PATH_CYCLES * spent + LEAST_PATH_CYCLES);
        } else {
            before = Some(SavedState::of(&self.levels[0], StateSums::of(&self.levels[0]).sum)?);
        }
        let mut pressing = self.first_pressing(least.as_ref(), goal);
        for _ in 0..MOST_PATHS {
            let pressed = Goal { wanted: Some(pressing), most, ..goal };
            let ended = nested::solve(self.levels, pressed, (Start::Auto, self.make), self.monitor)?;
            let path_end = match ended.end {
                Descent::By(End::Solved) => self.continuation(Goal { most, ..goal }).follow(meeting)?,
                Descent::By(End::Interrupted) if least.is_some() => PathEnd::Interrupted,
                _ => PathEnd::Lost,
            };
            // A path that is cut short by the cycles might have led to the wanted force.
            if self.monitor.is_cancelled() || path_end == PathEnd::Interrupted && (least.is_none() || goal.pulls()) {
                without = PathEnd::Interrupted;
                break;
            }
            pressing *= PRESSING_FORCE_RATIO;
            match path_end {
                PathEnd::Found => return Ok(PathEnd::Found),
                PathEnd::Least { sum, .. }
                    if least.as_ref().is_none_or(|least| sum < (1.0 + LEAST_PULL) * least.sum) =>
                {
                    meeting = Some(StateSums::of(&self.levels[0]));
                    pressing = if self.is_pull(sum) { PRESSING_FORCE_RATIO * sum.abs() } else { pressing };
                    least = Some(SavedState::of(&self.levels[0], sum)?);
                }
                PathEnd::Lost if least.is_none() => {}
                _ => break,
            }
        }
        let Some(least) = least else {
            if let Some(state) = before.filter(|state| !(StateSums::of(&self.levels[0]).sum < state.sum)) {
                self.levels[0].now.copy_from(&state.unknowns)?;
            }
            return Ok(without);
        };
        self.levels[0].now.copy_from(&least.unknowns)?;
        let found = PathEnd::Least { sum: least.sum, approach: least.approach() };
        Ok(if without == PathEnd::Interrupted { without } else { found })
    }

    /// The first pressing force, as a sum of pressures. It depends on the least force, if one is known, and on the wanted force.
    fn first_pressing(&self, least: Option<&SavedState>, goal: Goal) -> f64 {
        match (least.filter(|least| self.is_pull(least.sum)), goal.wanted.unwrap_or(0.0)) {
            (Some(least), _) => PRESSING_FORCE_RATIO * least.sum.abs(),
            (None, wanted) if wanted > 0.0 => PRESSING_FORCE_RATIO * wanted,
            (None, wanted) if wanted < 0.0 => wanted.abs().min(self.most_attraction()),
            _ => FIRST_PRESSING_FORCE * self.most_attraction(),
        }
    }

    /// Whether a sum of p is a pull, and not the attraction that remains between bodies that have parted.
    fn is_pull(&self, sum: f64) -> bool {
        sum < -LEAST_PULL * self.most_attraction()
    }

    /// The sum of the attraction of all elements at a distance of 0.
    fn most_attraction(&self) -> f64 {
        let surface = &self.levels[0].surface;
        let of_element = |i: usize| if surface.h[i].is_finite() { surface.traction(i, 0.0) } else { 0.0 };
        (0..surface.h.len()).map(of_element).sum()
    }

    /// The error of a pull that exceeds the attraction of all elements at a distance of 0; `None` if the pull is weaker.
    fn beyond_all_attraction(&self, goal: Goal) -> Option<Error> {
        let area = self.levels[0].problem.grid.element_area();
        let most = self.most_attraction();
        let wanted = goal.wanted.filter(|wanted| -wanted > most)?;
        Some(Error::Infeasible(format!(
            "force is {}; all of the attraction, at a distance of 0 everywhere, holds a pull of {}",
            Rounded(wanted * area),
            Rounded(-most * area)
        )))
    }
}
