//! Solves from nothing. A force that pulls, or none, is met on the stable branch: down from a state of more force.

use super::level::{Level, MakeFrozen};
use super::levels::prolong;
use super::majorise::Descent;
use super::nested::{self, coarse_goal};
use super::newton::{newton, stiffness_of_contact, End, Goal};
use super::pull::{walk, Walk};
use super::request::Start;
use super::solver::{pulls, Solver};
use super::unknowns::Unknowns;
use crate::error::{Error, Result};
use crate::progress::Monitor;

/// Bodies that no force holds are first pressed together by this part of all attraction.
const PRESSED: f64 = 0.01;
/// Factors of the pressing force, tried one after the other.
const MORE: [f64; 3] = [1.0, 10.0, 100.0];

impl Solver {
    pub(super) fn begin_anew(
        &mut self,
        goal: Goal,
        (start, make): (Start, MakeFrozen<'_>),
        monitor: &mut Monitor<'_>,
    ) -> Result<Descent> {
        if !pulls(goal) {
            let ended = nested::solve(&mut self.levels, goal, (start, make), monitor)?;
            let attracts = self.most_attraction() > 0.0;
            if ended.is_in_contact() || goal.wanted != Some(0.0) || !attracts || goal.is_interrupted(monitor) {
                return Ok(ended.end);
            }
            let mut apart = Unknowns::default();
            apart.copy_from(&self.levels[0].now)?;
            // Bodies apart carry no force, too: what holds each other is looked for from above.
            return match self.down_from_pressed(goal, make, monitor)? {
                Some(Walk::Found) => Ok(Descent::By(End::Solved)),
                Some(Walk::Interrupted) => Ok(Descent::By(End::Interrupted)),
                _ => {
                    self.levels[0].now.copy_from(&apart)?;
                    Ok(ended.end)
                }
            };
        }
        if self.is_found_from_coarse(goal, (start, make), monitor)? {
            return Ok(Descent::By(End::Solved));
        }
        // Down the stable branch of the finest grid.
        let unloaded = Goal { wanted: Some(0.0), ..goal };
        let ended = nested::solve(&mut self.levels, unloaded, (start, make), monitor)?;
        if ended.is_in_contact() && self.is_all_in_contact() {
            if let Some(held) = self.hold_all(goal, monitor)? {
                return Ok(held);
            }
            nested::solve(&mut self.levels, unloaded, (start, make), monitor)?;
        }
        let mut walk = match ended.is_in_contact() {
            true => Some(walk(&mut self.levels[0], (goal, make), monitor)?),
            false => None,
        };
        if matches!(walk, None | Some(Walk::Lost)) && !goal.is_interrupted(monitor) {
            walk = self.down_from_pressed(goal, make, monitor)?.or(walk);
        }
        match walk {
            Some(Walk::Found) => Ok(Descent::By(End::Solved)),
            Some(Walk::Interrupted) => Ok(Descent::By(End::Interrupted)),
            Some(Walk::Least { sum, approach }) => {
                let area = self.levels[0].problem.grid.element_area();
                let force = goal.wanted.unwrap_or(0.0) * area;
                Err(Error::Infeasible(format!(
                    "force is {force:e}; the attraction holds a pull of {:e} at most (the pull-off force), at an approach of {approach:e}",
                    sum * area
                )))
            }
            Some(Walk::Lost) | None => {
                let end = if goal.is_interrupted(monitor) { End::Interrupted } else { End::Failed };
                self.beyond_all_attraction(goal).map_or(Ok(Descent::By(end)), Err)
            }
        }
    }

    /// Down the stable branch from bodies that are pressed together: as strongly as they are to be pulled, or by a part of all attraction. None where no
    /// such state is found.
    fn down_from_pressed(
        &mut self,
        goal: Goal,
        make: MakeFrozen<'_>,
        monitor: &mut Monitor<'_>,
    ) -> Result<Option<Walk>> {
        let wanted = goal.wanted.map_or(0.0, f64::abs);
        let pressing = if wanted > 0.0 { wanted } else { PRESSED * self.most_attraction() };
        let mut last = None;
        for times in MORE {
            let pressed = Goal { wanted: Some(times * pressing), ..goal };
            let ended = nested::solve(&mut self.levels, pressed, (Start::Auto, make), monitor)?;
            if goal.is_interrupted(monitor) {
                return Ok(Some(Walk::Interrupted));
            }
            if ended.end == Descent::By(End::Solved) {
                last = Some(walk(&mut self.levels[0], (goal, make), monitor)?);
            }
            if !matches!(last, None | Some(Walk::Lost)) {
                break;
            }
        }
        Ok(last)
    }

    /// From contact everywhere in two periods: the approach does not change with the force, and there is no branch to go down. None where that does not
    /// last.
    fn hold_all(&mut self, goal: Goal, monitor: &mut Monitor<'_>) -> Result<Option<Descent>> {
        let (end, measured) = newton(&mut self.levels[0], goal, true, monitor)?;
        let lasts = end == End::Solved && measured.count == self.levels[0].now.u.len();
        Ok(Some(Descent::By(end)).filter(|_| lasts || end == End::Interrupted))
    }

    /// Whether all elements of two periods are in contact. The mean of their distances then stays where it is, whatever the force.
    fn is_all_in_contact(&self) -> bool {
        let Level { problem, now, .. } = &self.levels[0];
        problem.coefficients.is_mean_free() && now.contact.iter().all(|&inside| inside)
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
            "force is {:e}; all of the attraction, at a distance of 0 everywhere, holds a pull of {:e}",
            wanted * area,
            -most * area
        )))
    }

    /// Down the stable branch on the coarsest grid, which costs little, and then from grid to grid by the force. False where that does not end on the
    /// stable branch.
    fn is_found_from_coarse(
        &mut self,
        goal: Goal,
        (start, make): (Start, MakeFrozen<'_>),
        monitor: &mut Monitor<'_>,
    ) -> Result<bool> {
        let last = self.levels.len() - 1;
        if last == 0 {
            return Ok(false);
        }
        let coarse = coarse_goal(&self.levels, last, goal);
        let unloaded = Goal { wanted: Some(0.0), ..coarse };
        self.levels[last].fields = std::mem::take(&mut self.levels[0].fields);
        monitor.enter_grid();
        let ended = nested::solve(&mut self.levels[last..], unloaded, (start, make), monitor)?;
        let is_found = ended.end == Descent::By(End::Solved)
            && walk(&mut self.levels[last], (coarse, make), monitor)? == Walk::Found;
        if !is_found {
            return Ok(false);
        }
        for l in (0..last).rev() {
            let (fine, below) = self.levels.split_at_mut(l + 1);
            prolong(&mut below[0], &mut fine[l])?;
            let goal = coarse_goal(&self.levels, l, goal);
            monitor.enter_grid();
            let (end, _) = newton(&mut self.levels[l], goal, false, monitor)?;
            if end != End::Solved {
                return Ok(false);
            }
        }
        Ok(stiffness_of_contact(&mut self.levels[0], monitor)? > 0.0)
    }
}
