//! Forces that are given, where Newton's method stalls: by solves with creepages that are given, between creepages that are known to
//! carry too much and too little.
//!
//! Such a solve has one solution, and its forces cut off a part of the [`Corral`]. The next creepages are those by which the natural map
//! carries the forces ([`balanced`]), best where nearly all slips, or those of the linear system, the border's inverse with Broyden's
//! updates, best where much sticks; where neither halves what is missing, those in the middle. That ends.

use super::balance::balanced;
use super::best::Best;
use super::corral::Corral;
use super::forces::{sum_of, sum_of_bounds, Forces};
use super::newton::{self, Manner};
use super::problem::{dot, plus, square, Problem, State};
use super::shift::{self, Goal, Memory};
use super::step::compliance;
use super::system::TangentSystem;
use super::vectors;
use super::Vector;
use crate::error::Result;
use crate::progress::Outcome;

/// Where more than this part of C slips the natural map is tried first.
const MOSTLY_SLIP: f64 = 0.8;
/// A trial is good if it leaves at most this part of what was missing.
const PROGRESS: f64 = 0.5;
/// Trials at most.
const MOST_TRIALS: u32 = 400;

/// Where trials come from.
struct Trials {
    corral: Corral,
    by_map: bool,
    /// Trials in succession that were not good.
    bad: u32,
    /// Creepages by what forces exceed, as far as that is known.
    slope: Option<[Vector; 2]>,
    /// The last creepages, what forces exceeded there, and what was missing.
    last: Option<(Vector, Vector, f64)>,
}

/// Solves from what the state and the offset hold.
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
    for _ in 0..MOST_TRIALS {
        let limit = limit.saturating_sub(problem.operators.products - made);
        if limit == 0 {
            return Ok(Outcome::IterationLimit);
        }
        let end = by_creepages(problem, state, memory, Goal { tolerance, limit, certified, watch: &mut *watch })?;
        let sum = sum_of(problem, &state.q);
        let excess = forces.only_given([sum[0] - forces.sum[0], sum[1] - forces.sum[1]]);
        let missing = square(excess).sqrt() / bounds;
        if end != Outcome::Converged {
            return Ok(end);
        }
        best.see(problem, state, missing.max(tolerance), &mut memory.fields)?;
        if missing < tolerance {
            return Ok(Outcome::Converged);
        }
        let next = trials.next(problem, state, memory, (forces, excess, missing))?;
        if next == problem.offset {
            break;
        }
        problem.offset = next;
    }
    Ok(Outcome::Stagnated)
}

/// Solves with the creepages that the offset holds.
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
    for manner in [Manner::Plain, Manner::Bold] {
        let left = limit.saturating_sub(problem.operators.products - made);
        let goal = Goal { tolerance, limit: left, certified, watch: &mut *watch };
        let mut best = Best::none();
        let Memory { tangent, fields, .. } = memory;
        end = newton::solve(problem, state, (tangent, fields, &mut best), (Forces::NONE, manner), goal)?;
        if end == Outcome::Stagnated {
            best.take_up(problem, state);
        }
        best.give(fields);
        if end != Outcome::Stagnated {
            break;
        }
    }
    Ok(end)
}

impl Trials {
    fn new(problem: &Problem, forces: Forces, bounds: f64) -> Trials {
        // What all tractions together displace at most, of both components, here and a step ahead.
        let displaced = 8.0 * problem.operators.greatest() * bounds;
        let rigid = vectors::largest(problem.threads(), problem.bound.len(), |i| {
            let inside = problem.bound[i] > 0.0;
            if inside {
                square(problem.slip[i]).sqrt()
            } else {
                0.0
            }
        });
        let part = square(forces.only_given(forces.sum)).sqrt() / bounds;
        let half = 4.0 * (rigid + displaced) / (1.0 - part).max(f64::EPSILON);
        Trials { corral: Corral::new(half, forces.given), by_map: true, bad: 0, slope: None, last: None }
    }

    /// The creepages to try next; those of now where there are no others.
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
        match self.last {
            Some((_, _, before)) if missing > PROGRESS * before => {
                (self.by_map, self.bad, self.slope) = (!self.by_map, self.bad + 1, None);
            }
            Some((from, exceeded, _)) => {
                self.bad = 0;
                let (dc, de) = (plus(at, -1.0, from), plus(excess, -1.0, exceeded));
                self.slope = self.slope.map(|slope| updated(slope, dc, de));
            }
            None => self.by_map = memory.tangent.slip_count as f64 > MOSTLY_SLIP * problem.count() as f64,
        }
        self.last = Some((at, excess, missing));
        let by_map = balanced(problem, state, rho, forces);
        let slope = match self.slope {
            Some(slope) => slope,
            None => border_slope(problem, memory, forces)?,
        };
        self.slope = Some(slope);
        let by_slope = plus(at, 1.0, forces.only_given(slope.map(|row| dot(row, excess))));
        let ordered = if self.by_map { [by_map, by_slope] } else { [by_slope, by_map] };
        let is_good = |trial: &Vector| *trial != at && self.corral.holds(*trial);
        let trial = if self.bad % 3 == 2 { None } else { ordered.into_iter().find(is_good) };
        Ok(trial.unwrap_or_else(|| self.corral.centre()))
    }
}

/// How creepages go with what forces exceed, by the preconditioner.
fn border_slope(problem: &mut Problem, memory: &mut Memory, forces: Forces) -> Result<[Vector; 2]> {
    let Memory { tangent, fields, .. } = memory;
    let system = TangentSystem::new(problem, tangent, forces, fields)?;
    let (x, y) = (system.creepages([1.0, 0.0]), system.creepages([0.0, 1.0]));
    system.give(fields);
    Ok([[x[0], y[0]], [x[1], y[1]]])
}

/// Broyden's update of a slope, by which creepages went by dc as what forces exceed went by de: forces fall as creepages grow.
fn updated(slope: [Vector; 2], dc: Vector, de: Vector) -> [Vector; 2] {
    let predicted = slope.map(|row| -dot(row, de));
    let left = [0, 1].map(|k| slope[0][k] * dc[0] + slope[1][k] * dc[1]);
    let along = dot(dc, predicted);
    if !(along.abs() > 0.0) {
        return slope;
    }
    [0, 1].map(|i| plus(slope[i], (dc[i] - predicted[i]) / along, left))
}
