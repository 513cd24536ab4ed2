//! Given forces for which Newton's method stalls: a search for their creepages, by solves with given creepages. Such a solve is called a trial.
//!
//! A trial has one solution. Its forces cut off a part of the [`Corral`], the region of creepages that may carry the given forces. The creepages of
//! the next trial are
//!
//! * those at which the natural map carries the forces ([`balanced`]), which is good if nearly all of C slips,
//! * or those of a Newton step on the forces at fixed slip area, which is good if much of C sticks,
//! * or the centre of the corral, if neither of them halves the missing force. Therefore the search ends.

use super::balance::balanced;
use super::best::Best;
use super::certificate::Certificate;
use super::corral::{Corral, PROGRESS};
use super::forces::{sum_of, sum_of_bounds, Forces};
use super::newton::{self, Manner};
use super::plane::{dot, plus, square, Vector};
use super::problem::{Problem, State};
use super::sensitivity;
use super::shift::{self, Goal, Memory};
use super::step::compliance;
use super::system::inverse;
use crate::error::Result;
use crate::methods::fields;
use crate::progress::Outcome;

/// Newton's method for given forces is tried again each time the missing force falls below this times that of the last try.
const CLOSE_RATIO: f64 = 0.1;
/// The most products of such a try.
pub const FINISHING_PRODUCTS: u64 = 30;
/// If two trials with different creepages have the same forces, the tolerance of trials is multiplied by this factor.
const TIGHTER: f64 = 0.03;
/// The least tolerance of trials.
const LEAST_INNER: f64 = 1e-14;
/// The relative residual of the linear solves for the derivatives of the forces by the creepages.
const DERIVATIVE_ACCURACY: f64 = 1e-2;
/// The largest number of trials.
const MOST_TRIALS: u32 = 400;

/// How the creepages of the next trial are chosen.
struct Trials {
    corral: Corral,
    /// Whether the natural map gives the next creepages; otherwise the Newton step on the forces does.
    by_map: bool,
    /// The number of last trials in a row that did not halve the missing force.
    bad: u32,
    /// The least missing force of all trials. Trials are compared with this and not with the last one. Otherwise, of two trials that lead to each
    /// other, every second one would count as good for ever.
    least: Option<f64>,
}

/// Searches from the given tractions, and from the creepages in the problem's offset.
pub fn solve(
    problem: &mut Problem,
    state: &mut State,
    (memory, best): (&mut Memory, &mut Best),
    forces: Forces,
    goal: Goal<'_>,
) -> Result<Outcome> {
    let Goal { tolerance, limit, certified, watch } = goal;
    let made = problem.operators.products;
    memory.tangent.fit(problem.grid.len())?;
    problem.continue_residuals()?;
    problem.refresh(state);
    let bounds = sum_of_bounds(problem);
    let mut trials = Trials::new(problem, forces, bounds);
    let (mut tried, mut inner, mut before, mut is_exact) = (1.0, tolerance, [f64::NAN; 2], false);
    for _ in 0..MOST_TRIALS {
        let left = limit.saturating_sub(problem.operators.products - made);
        if left == 0 {
            return Ok(Outcome::IterationLimit);
        }
        let of_trial = Goal { tolerance: inner, limit: left, certified, watch: &mut *watch };
        let end = by_creepages(problem, state, memory, of_trial)?;
        let residual = Certificate::of(problem, state).residual;
        if end != Outcome::Converged && !(end == Outcome::Stagnated && residual < tolerance) {
            return Ok(end);
        }
        let excess = forces.less(|| sum_of(problem, &state.q)).map(|missing| -missing);
        let missing = square(excess).sqrt() / bounds;
        best.see(problem, state, missing.max(tolerance), &mut memory.fields)?;
        if missing < tolerance {
            return Ok(Outcome::Converged);
        }
        if missing < CLOSE_RATIO * tried {
            tried = missing;
            let left = limit.saturating_sub(problem.operators.products - made).min(FINISHING_PRODUCTS);
            let goal = Goal { tolerance, limit: left, certified, watch: &mut *watch };
            let end = finish(problem, state, memory, forces, goal)?;
            if end == Outcome::Converged || end == Outcome::Cancelled {
                return Ok(end);
            }
        }
        // The forces equal those of the trial before: their change is below the tolerance of the trials.
        if excess == before && inner > LEAST_INNER {
            inner *= TIGHTER;
            continue;
        }
        before = excess;
        let next = trials.next(problem, state, memory, (forces, excess, missing))?;
        if next != problem.offset {
            problem.offset = next;
        } else if is_exact {
            break;
        } else {
            // The residual causes an error of the forces, which may exceed the missing force, as on one element alone. Then a cut may have removed
            // the wanted creepages, and the search starts again with the least tolerance.
            (is_exact, inner, trials) = (true, inner.min(LEAST_INNER), Trials::new(problem, forces, bounds));
        }
    }
    Ok(Outcome::Stagnated)
}

/// Tries Newton's method for the given forces, from the present state. If it does not converge, restores this state.
fn finish(
    problem: &mut Problem,
    state: &mut State,
    memory: &mut Memory,
    forces: Forces,
    goal: Goal<'_>,
) -> Result<Outcome> {
    let Memory { tangent, fields, .. } = memory;
    let (mut present, mut best) = (Best::none(), Best::none());
    present.see(problem, state, 0.0, fields)?;
    let end = newton::solve(problem, state, (tangent, fields, &mut best), (forces, Manner::Balanced), goal)?;
    if end != Outcome::Converged && present.take_up(problem, state) {
        problem.refresh(state);
    }
    present.give(fields);
    best.give(fields);
    Ok(end)
}

/// Makes a trial: solves with the creepages in the problem's offset as given ones.
fn by_creepages(problem: &mut Problem, state: &mut State, memory: &mut Memory, goal: Goal<'_>) -> Result<Outcome> {
    let Goal { tolerance, limit, certified, watch } = goal;
    if problem.rms_slip() == 0.0 {
        state.unload(&problem.threads().clone());
        return Ok(Outcome::Converged);
    }
    let made = problem.operators.products;
    if problem.operators.rolling.is_none() {
        let goal = Goal { tolerance, limit, certified, watch: &mut *watch };
        let end = shift::solve(problem, state, memory, goal)?;
        if end != Outcome::Stagnated {
            return Ok(end);
        }
    }
    let mut end = Outcome::Stagnated;
    for manner in [Manner::Plain, Manner::Balanced] {
        let left = limit.saturating_sub(problem.operators.products - made);
        let goal = Goal { tolerance, limit: left, certified, watch: &mut *watch };
        let mut best = Best::none();
        let Memory { tangent, fields, .. } = memory;
        end = newton::solve(problem, state, (tangent, fields, &mut best), (Forces::NONE, manner), goal)?;
        if end == Outcome::Stagnated && best.take_up(problem, state) {
            problem.refresh(state);
        }
        best.give(fields);
        if end != Outcome::Stagnated {
            break;
        }
    }
    Ok(end)
}

impl Trials {
    /// The corral is a square that contains the wanted creepages for sure. `bounds` is the sum of g.
    fn new(problem: &Problem, forces: Forces, bounds: f64) -> Trials {
        // An upper bound on the change of displacement in a step, by all tractions at their bounds.
        let displaced = 8.0 * problem.operators.greatest() * bounds;
        let rigid = fields::largest(problem.threads(), problem.bound.len(), |i| {
            let inside = problem.bound[i] > 0.0;
            if inside {
                square(problem.slip[i]).sqrt()
            } else {
                0.0
            }
        });
        let part = square(forces.only_given(forces.sum)).sqrt() / bounds;
        let half = problem.farthest_creepage() * 4.0 * (rigid + displaced) / (1.0 - part).max(f64::EPSILON);
        Trials { corral: Corral::new(half, forces.given), by_map: true, bad: 0, least: None }
    }

    /// Cuts the corral by the last trial, and returns the creepages of the next one. They equal the last ones if the corral is too small for others.
    fn next(
        &mut self,
        problem: &mut Problem,
        state: &State,
        memory: &mut Memory,
        (forces, excess, missing): (Forces, Vector, f64),
    ) -> Result<Vector> {
        let at = problem.offset;
        self.corral.cut(at, excess);
        let rho = 1.0 / compliance(problem);
        memory.tangent.predict(problem, state, rho);
        match self.least {
            Some(least) if missing > PROGRESS * least => (self.by_map, self.bad) = (!self.by_map, self.bad + 1),
            Some(_) => self.bad = 0,
            // The natural map is tried first if nearly all of C slips.
            None => self.by_map = problem.places.is_mostly_slip(memory.tangent.slip_count),
        }
        self.least = Some(self.least.map_or(missing, |least| least.min(missing)));
        if self.bad % 3 == 2 {
            return Ok(self.corral.centre());
        }
        for by_map in [self.by_map, !self.by_map] {
            let trial = if by_map {
                balanced(problem, state, rho, forces)
            } else {
                let slope = slope(problem, memory, forces)?;
                plus(at, 1.0, forces.only_given(slope.map(|row| dot(row, excess))))
            };
            if trial != at && self.corral.holds(trial) {
                return Ok(trial);
            }
        }
        Ok(self.corral.centre())
    }
}

/// The change of creepages per excess of force of a Newton step: the inverse of minus the derivatives of the forces by the creepages, at fixed slip
/// area.
fn slope(problem: &mut Problem, memory: &mut Memory, forces: Forces) -> Result<[Vector; 2]> {
    let Memory { tangent, fields, .. } = memory;
    let mut falls = [[0.0; 2]; 2];
    for k in (0..2).filter(|&k| forces.given[k]) {
        let mut change = fields.take(problem.grid.len())?;
        let unit = [[1.0, 0.0], [0.0, 1.0]][k];
        fields::fill(problem.threads(), &mut change, |i| problem.weighted(i, unit));
        sensitivity::solve(problem, tangent, (fields, &mut change), DERIVATIVE_ACCURACY, &mut |_| true)?;
        let by = forces.only_given(sum_of(problem, &change));
        (falls[0][k], falls[1][k]) = (-by[0], -by[1]);
        fields.give(change);
    }
    Ok(inverse(falls))
}
