//! The solver of scenes with adhesion: a whole solve, from the request to the report.

use std::sync::Arc;

use super::begin::Search;
use super::level::{Level, MakeFrozen};
use super::levels::{levels, take_surfaces};
use super::majorise::Descent;
use super::newton::{newton, End, Goal, Pace};
use super::path::count_contact;
use super::report::{close_grid, Report};
use super::request::{InitialState, Request};
use super::robust;
use super::split::Split;
use super::stability::stability;
use super::states::PathEnd;
use super::tangent::stiffness_of_contact;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::methods::fields;
use crate::operator::Operator;
use crate::progress::{Monitor, Outcome};
use crate::scene::Load;
use crate::threads::Threads;

/// If Newton's method could not follow the initial state, the bodies count as snapped if more than this fraction of the elements in contact has
/// changed.
const SNAPPED: f64 = 0.25;

/// The grids, operators and memory for many solves on one grid.
pub struct Solver {
    /// The grids, finest first.
    levels: Vec<Level>,
}

impl Solver {
    /// A solver on a grid, with the influence coefficients and the operator of this grid.
    pub fn new(
        grid: Grid,
        coefficients: &Coefficients,
        operator: Arc<Operator<f64>>,
        threads: &Threads,
    ) -> Result<Solver> {
        Ok(Solver { levels: levels(grid, coefficients, operator, threads)? })
    }

    /// The finest grid. After a solve it holds the solution.
    pub fn finest(&self) -> &Level {
        &self.levels[0]
    }

    /// Takes the arrays of the next solve: undeformed distances, pressures and displacements. The pressures are read only if an initial state
    /// refers to them; the displacements may have any values.
    pub fn lend(&mut self, [h, p, u]: [Vec<f64>; 3]) {
        // `collect` reuses the memory of the arrays.
        let ones = |values: Vec<f64>| values.into_iter().map(|value| [value]).collect();
        let Level { surface, now, .. } = &mut self.levels[0];
        (surface.h, now.p.field, now.u) = (h, ones(p), ones(u));
    }

    /// Returns the lent arrays. After a successful solve they hold the undeformed distances, the total pressures, and their displacements.
    pub fn give_back(&mut self) -> [Vec<f64>; 3] {
        let Level { surface, now, .. } = &mut self.levels[0];
        let [p, u] = [&mut now.p.field, &mut now.u].map(|values| std::mem::take(values).into_flattened());
        [std::mem::take(&mut surface.h), p, u]
    }

    /// The law and the works of adhesion with which the total pressures of the last solve are split.
    pub fn split(&self) -> Result<Split> {
        Split::of(&self.finest().surface)
    }

    /// Bytes of the solver, without the lent arrays and the operator of the finest grid.
    pub fn bytes(&self) -> usize {
        let at_work = self.levels.iter().map(Level::bytes_at_work).max().unwrap_or(0);
        self.levels.iter().map(Level::bytes).sum::<usize>() + at_work - self.levels[0].problem.bytes_of_operator()
    }

    /// Solves with the [lent](Solver::lend) arrays. Afterwards the finest grid holds the solution, with u = A p by a fresh product.
    pub fn solve(
        &mut self,
        request: &Request<'_>,
        make: MakeFrozen<'_>,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Report)> {
        take_surfaces(&mut self.levels, request.surfaces)?;
        let area = self.levels[0].problem.grid.element_area();
        let wanted = match request.load {
            Load::Approach(_) => None,
            Load::Force(force) => Some(force / area),
        };
        let goal =
            Goal { tolerance: request.tolerance, wanted, certified: true, most: request.max_cycles, pace: Pace::Bold };
        if let Load::Approach(approach) = request.load {
            self.levels.iter_mut().for_each(|level| level.now.p.border = [approach]);
        }
        let mut search = Search { levels: &mut self.levels, start: request.start, make, monitor };
        let (end, jumped) = match request.state {
            Some(state) => search.go_on(&state, goal)?,
            None => (search.begin_anew(goal)?, false),
        };
        let end = match (end, request.pull_off) {
            // If no state is found at the load, the search for the pull-off starts only from bodies that are pressed together.
            (Descent::By(end), true) if end != End::Interrupted => search.pull_off(goal, end == End::Solved)?,
            (end, _) => end,
        };
        search.conclude((end, jumped), goal, request)
    }
}

impl Search<'_, '_, '_> {
    /// Solves from an initial state, along the branch of that state. Returns how the solve ended, and whether the bodies have snapped. If the
    /// branch does not contain a stable state for the goal, the solve begins anew without an initial state.
    fn go_on(&mut self, state: &InitialState<'_>, goal: Goal) -> Result<(Descent, bool)> {
        let level = &mut self.levels[0];
        if let Some(pressure) = state.pressure {
            level.now.p.field.as_flattened_mut().copy_from_slice(pressure);
        }
        level.now.contact.copy_from_slice(state.contact);
        let before = count_contact(level);
        if goal.wanted.is_some() {
            level.now.p.border = [state.approach];
        }
        level.refresh()?;
        level.count_products(self.monitor);
        if state.pressure.is_some() && goal.wanted.is_some() {
            approach_contact(level);
        }
        let (end, settled, jumped) = if !goal.pulls() {
            let ended = robust::solve(level, goal, (true, self.make), self.monitor)?;
            let jumped = ended.is_lost && is_snap(before, ended.measured.count);
            let settled = match goal.wanted.is_some() && ended.is_in_contact() {
                true => self.continuation(goal).settle()?,
                false => PathEnd::Found,
            };
            (ended.end, settled, jumped)
        } else {
            let (end, _) = newton(level, goal, true, self.monitor)?;
            let settled = match end {
                End::Solved => self.continuation(goal).settle()?,
                End::Interrupted => PathEnd::Interrupted,
                _ => PathEnd::Lost,
            };
            (Descent::By(end), settled, false)
        };
        match settled {
            PathEnd::Found => return Ok((end, jumped)),
            PathEnd::Interrupted => return Ok((Descent::By(End::Interrupted), jumped)),
            _ => {}
        }
        let end = self.begin_anew(goal)?;
        Ok((end, is_snap(before, count_contact(&self.levels[0]))))
    }

    /// Finds the state of the least force (the pull-off). If `is_state`, the search also starts from the current state.
    fn pull_off(&mut self, goal: Goal, is_state: bool) -> Result<Descent> {
        let goal = Goal { wanted: None, ..goal };
        Ok(match self.down_all_paths(goal, is_state)? {
            PathEnd::Least { .. } | PathEnd::Found => Descent::By(End::Solved),
            PathEnd::Interrupted => Descent::By(End::Interrupted),
            PathEnd::Lost | PathEnd::Joined => Descent::By(End::Failed),
        })
    }

    /// Computes the residuals and the report of the state at the end. A state that is not solved gets a fresh product before.
    fn conclude(
        &mut self,
        (mut end, jumped): (Descent, bool),
        goal: Goal,
        request: &Request<'_>,
    ) -> Result<(Outcome, Report)> {
        let Search { levels, monitor, .. } = self;
        let (level, wanted) = (&mut levels[0], goal.wanted);
        if end == Descent::Parted && wanted == Some(0.0) {
            // The force is 0 and no element attracts: the solution has no pressures.
            level.now.unload(&level.problem.threads);
            end = Descent::By(End::Solved);
        }
        if end == Descent::By(End::Solved) && level.leaves_nothing() {
            // No element touches or attracts, so any remaining pressures are left over from earlier iterates.
            level.now.unload(&level.problem.threads);
        }
        if end != Descent::By(End::Solved) {
            level.refresh()?;
            level.count_products(monitor);
        }
        let mut measured = level.measure(false, wanted);
        if request.pull_off {
            // The search for the pull-off only starts at the load, so that the force of the load is not missing.
            measured.force = 0.0;
        }
        let mut report = Report::of(level, &measured);
        report.jumped = jumped;
        let is_state = measured.is_state(request.tolerance);
        report.is_short = end == Descent::By(End::Interrupted) && goal.pulls() && is_state && measured.pressures < 0.0;
        let is_solved = end == Descent::By(End::Solved);
        if request.stiffness && is_solved && !monitor.is_cancelled() {
            let area = level.problem.grid.element_area();
            report.stiffness = Some(area * stiffness_of_contact(level, monitor)?);
        }
        if request.stability && is_solved && !monitor.is_cancelled() {
            report.stability = stability(level, monitor)?;
        }
        close_grid(level, &measured, monitor);
        if let Some(advice) = report.advice() {
            log::warn!("{advice}");
        }
        let outcome = match end {
            Descent::By(End::Solved) => Outcome::Converged,
            Descent::By(End::Interrupted) => monitor.interrupted(),
            Descent::By(End::Failed) | Descent::Parted => Outcome::Stagnated,
        };
        Ok((if monitor.is_cancelled() { Outcome::Cancelled } else { outcome }, report))
    }
}

/// Sets the approach such that the mean distance of the elements in contact is 0, if there are any. Given pressures come without an approach.
fn approach_contact(level: &mut Level) {
    let Level { surface, now, problem, .. } = level;
    let (n, contact) = (now.contact.len(), &now.contact);
    let of_element = |i: usize| if contact[i] { [surface.distance(i, now), 1.0] } else { [0.0; 2] };
    let [distance, count] = fields::sum(&problem.threads, n, of_element);
    if count > 0.0 && distance.is_finite() {
        now.p.border = [now.approach() + distance / count];
    }
}

/// Whether the number of elements in contact has changed by more than the fraction [`SNAPPED`].
fn is_snap(before: usize, now: usize) -> bool {
    before.abs_diff(now) as f64 > SNAPPED * before.max(now) as f64
}
