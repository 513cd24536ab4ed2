//! Solves without a start. A pull, or no force, is reached along a stable branch, down from a state of more force.

use super::level::{Level, MakeFrozen};
use super::majorise::Descent;
use super::nested;
use super::newton::{End, Goal};
use super::place::{Met, Place, Walk};
use super::start::Start;
use super::unknowns::Unknowns;
use super::way::Walker;
use crate::error::{Error, Result, Rounded};
use crate::progress::Monitor;

/// Without a state of less force, bodies are first pressed together by this part of the whole attraction.
const FIRST_PRESSING_FORCE: f64 = 0.01;
/// A pressing force is PRESSING_FORCE_RATIO times the size of the least known force, or times the last pressing force.
const PRESSING_FORCE_RATIO: f64 = 10.0;
/// Most ways that lead down from pressed bodies, or that begin below a lost way of a pull-off.
const MOST_WAYS: u32 = 4;
/// Pulls below this part of the whole attraction count as none, and a pull is stronger than another if it exceeds it by this part.
const LEAST_PULL: f64 = 1e-6;
/// The first way of a search for a pull may take the cycles of PULL_OFF_CYCLES solves.
const PULL_OFF_CYCLES: u64 = 3;
/// Each state of a pull-off may take 1/STATES_OF_PULL_OFF of the cycles of a solve.
const STATES_OF_PULL_OFF: u64 = 4;
/// If the way of a pull-off is lost, further ways begin below it. Each start is sought in STEPS_BELOW steps of STEP_BELOW times the length of the
/// contact.
const STEPS_BELOW: u32 = 6;
const STEP_BELOW: f64 = 0.1;
/// Cycles of a further way: FURTHER_WAY_CYCLES times the first way's, plus LEAST_WAY_CYCLES; at least the goal's.
const FURTHER_WAY_CYCLES: u64 = 4;
const LEAST_WAY_CYCLES: u64 = 500;

/// A search for the state of a goal on the finest of some grids.
pub(super) struct Search<'a, 'm, 'c> {
    pub levels: &'a mut [Level],
    /// The start of grids without a state.
    pub start: Start,
    pub make: MakeFrozen<'a>,
    pub monitor: &'m mut Monitor<'c>,
}

impl<'c> Search<'_, '_, 'c> {
    /// Solves without a state.
    pub fn begin_anew(&mut self, goal: Goal) -> Result<Descent> {
        if !goal.pulls() {
            return self.begin_pressed(goal);
        }
        if self.is_found_from_coarse(goal)? {
            return Ok(Descent::By(End::Solved));
        }
        let walk = self.down_from_no_load(goal)?;
        match self.hold_pull_off(walk, goal)? {
            Walk::Found => Ok(Descent::By(End::Solved)),
            Walk::Least { sum, approach } => {
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
            Walk::Interrupted if self.monitor.is_cancelled() => Ok(Descent::By(End::Interrupted)),
            walk => {
                let is_cut = walk == Walk::Interrupted || goal.is_interrupted(self.monitor);
                let end = if is_cut { End::Interrupted } else { End::Failed };
                self.beyond_all_attraction(goal).map_or(Ok(Descent::By(end)), Err)
            }
        }
    }

    /// Solves without a state by an approach, or by a force that does not pull.
    fn begin_pressed(&mut self, goal: Goal) -> Result<Descent> {
        let ended = nested::solve(self.levels, goal, (self.start, self.make), self.monitor)?;
        if goal.is_interrupted(self.monitor) && ended.end != Descent::By(End::Solved) {
            return Ok(ended.end);
        }
        if ended.is_in_contact() && goal.wanted.is_some() {
            let settled = self.walker(goal).settle()?;
            if settled == Walk::Found {
                return Ok(ended.end);
            }
        } else if ended.is_in_contact() || goal.wanted != Some(0.0) || !(self.most_attraction() > 0.0) {
            return Ok(ended.end);
        }
        let mut found = Unknowns::default();
        found.copy_from(&self.levels[0].now)?;
        // Bodies apart carry no force either: a state of adhering bodies is sought from above.
        let walk = self.down_all_ways(goal, false)?;
        if walk == Walk::Found {
            return Ok(Descent::By(End::Solved));
        }
        self.levels[0].now.copy_from(&found)?;
        Ok(match walk {
            Walk::Interrupted => Descent::By(End::Interrupted),
            _ if ended.is_in_contact() => Descent::By(End::Failed),
            _ => ended.end,
        })
    }

    /// A walker from the state of the finest grid.
    pub fn walker(&mut self, goal: Goal) -> Walker<'_, '_, 'c> {
        Walker::new(&mut self.levels[0], goal, self.make, self.monitor)
    }

    /// The walker of the first way of a search for a pull. This way has many states, and a snap after the strongest.
    fn first_walker(&mut self, goal: Goal, spent: u64) -> Walker<'_, '_, 'c> {
        if goal.wanted.is_some() && !goal.pulls() {
            return self.walker(goal);
        }
        let left = goal.most.saturating_mul(PULL_OFF_CYCLES).saturating_sub(spent);
        let most = self.monitor.count.cycles.saturating_add(left);
        let each = if goal.wanted.is_some() { u64::MAX } else { goal.most / STATES_OF_PULL_OFF + 1 };
        Walker { each, ..self.walker(Goal { most, ..goal }) }
    }

    /// The first way down. It may be lost if elements are too coarse for the range and snap one after the other. Then another way begins at a
    /// state below, found without a start. Returns the cycles of all ways as well.
    fn walk_first(&mut self, goal: Goal) -> Result<(Walk, u64)> {
        let before = self.monitor.count.cycles;
        let mut ended = self.first_walker(goal, 0).walk(None)?;
        let mut spent = self.monitor.count.cycles - before;
        for _ in 0..MOST_WAYS {
            if ended != Walk::Lost || goal.wanted.is_some() {
                break;
            }
            let lost = Place::of(&self.levels[0], Met::of(&self.levels[0]).sum)?;
            if !self.is_found_below(goal, &mut spent)? {
                self.levels[0].now.copy_from(&lost.at)?;
                return Ok((Walk::Lost, spent));
            }
            let before = self.monitor.count.cycles;
            ended = self.first_walker(goal, spent).walk(None)?;
            spent += self.monitor.count.cycles - before;
            let is_less = match ended {
                Walk::Least { sum, .. } => sum < lost.sum,
                _ => Met::of(&self.levels[0]).sum < lost.sum,
            };
            if !is_less {
                self.levels[0].now.copy_from(&lost.at)?;
                return Ok((if ended == Walk::Interrupted { ended } else { Walk::Lost }, spent));
            }
        }
        Ok((ended, spent))
    }

    /// Whether a state in contact is found below the state of the finest grid, without a start.
    fn is_found_below(&mut self, goal: Goal, spent: &mut u64) -> Result<bool> {
        let from = self.levels[0].now.approach();
        let step = self.walker(goal).first_step(STEP_BELOW)?;
        let each = Goal { wanted: None, most: goal.most / STATES_OF_PULL_OFF + 1, ..goal };
        for k in (1..=STEPS_BELOW).filter(|_| step > 0.0) {
            self.levels.iter_mut().for_each(|level| level.now.p.border = [from - f64::from(k) * step]);
            let ended = nested::solve(self.levels, each, (Start::Auto, self.make), self.monitor)?;
            // The count of the finest grid begins anew in each solve.
            *spent += self.monitor.count.cycles;
            if ended.is_in_contact() || self.monitor.is_cancelled() {
                return Ok(ended.is_in_contact());
            }
        }
        Ok(false)
    }

    /// Follows the stable branch of the finest grid down from its state without a load.
    pub fn down_from_no_load(&mut self, goal: Goal) -> Result<Walk> {
        let unloaded = Goal { wanted: Some(0.0), ..goal };
        let ended = nested::solve(self.levels, unloaded, (self.start, self.make), self.monitor)?;
        self.down_all_ways(goal, ended.is_in_contact())
    }

    /// Follows the stable branch down from the finest grid's state, if `is_state`, and from bodies pressed together. The latter serves bodies
    /// of which one asperity or none adheres without a load. The pressing force grows until no stronger pull is found. The finest grid then
    /// has the state of the least force.
    pub fn down_all_ways(&mut self, goal: Goal, is_state: bool) -> Result<Walk> {
        let (mut least, mut met, mut most) = (None::<Place>, None, goal.most);
        // `before`: the last state of a lost way, or the state without a load. `without`: the end if no least force was found.
        let (mut before, mut without) = (None, Walk::Lost);
        if is_state {
            met = Some(Met::of(&self.levels[0]));
            let (walk, spent) = self.walk_first(goal)?;
            match walk {
                Walk::Least { sum, .. } => least = Some(Place::of(&self.levels[0], sum)?),
                Walk::Lost | Walk::Met => {
                    met = None;
                    before = Some(Place::of(&self.levels[0], Met::of(&self.levels[0]).sum)?);
                }
                ended => return Ok(ended),
            }
            most = goal.most.max(FURTHER_WAY_CYCLES * spent + LEAST_WAY_CYCLES);
        } else {
            before = Some(Place::of(&self.levels[0], Met::of(&self.levels[0]).sum)?);
        }
        let mut pressing = self.first_pressing(least.as_ref(), goal);
        for _ in 0..MOST_WAYS {
            let pressed = Goal { wanted: Some(pressing), most, ..goal };
            let ended = nested::solve(self.levels, pressed, (Start::Auto, self.make), self.monitor)?;
            let walk = match ended.end {
                Descent::By(End::Solved) => self.walker(Goal { most, ..goal }).walk(met)?,
                Descent::By(End::Interrupted) if least.is_some() => Walk::Interrupted,
                _ => Walk::Lost,
            };
            // A way that is cut short may have led to the wanted force.
            if self.monitor.is_cancelled() || walk == Walk::Interrupted && (least.is_none() || goal.pulls()) {
                without = Walk::Interrupted;
                break;
            }
            pressing *= PRESSING_FORCE_RATIO;
            match walk {
                Walk::Found => return Ok(Walk::Found),
                Walk::Least { sum, .. } if least.as_ref().is_none_or(|least| sum < (1.0 + LEAST_PULL) * least.sum) => {
                    met = Some(Met::of(&self.levels[0]));
                    pressing = if self.is_pull(sum) { PRESSING_FORCE_RATIO * sum.abs() } else { pressing };
                    least = Some(Place::of(&self.levels[0], sum)?);
                }
                Walk::Lost if least.is_none() => {}
                _ => break,
            }
        }
        let Some(least) = least else {
            if let Some(place) = before.filter(|place| !(Met::of(&self.levels[0]).sum < place.sum)) {
                self.levels[0].now.copy_from(&place.at)?;
            }
            return Ok(without);
        };
        self.levels[0].now.copy_from(&least.at)?;
        let found = Walk::Least { sum: least.sum, approach: least.approach() };
        Ok(if without == Walk::Interrupted { without } else { found })
    }

    /// The first pressing force, by the state of the least force if one is known.
    fn first_pressing(&self, least: Option<&Place>, goal: Goal) -> f64 {
        match (least.filter(|least| self.is_pull(least.sum)), goal.wanted.unwrap_or(0.0)) {
            (Some(least), _) => PRESSING_FORCE_RATIO * least.sum.abs(),
            (None, wanted) if wanted > 0.0 => PRESSING_FORCE_RATIO * wanted,
            (None, wanted) if wanted < 0.0 => wanted.abs().min(self.most_attraction()),
            _ => FIRST_PRESSING_FORCE * self.most_attraction(),
        }
    }

    /// Whether a sum of p is a pull, and not the remaining attraction of bodies that have parted.
    fn is_pull(&self, sum: f64) -> bool {
        sum < -LEAST_PULL * self.most_attraction()
    }

    /// The sum of all attraction, at a distance of 0 everywhere.
    fn most_attraction(&self) -> f64 {
        let surface = &self.levels[0].surface;
        let of_element = |i: usize| if surface.h[i].is_finite() { surface.traction(i, 0.0) } else { 0.0 };
        (0..surface.h.len()).map(of_element).sum()
    }

    /// Why no state holds a pull of more than all attraction at a distance of 0.
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
