//! The solutions LOW and HIGH of a problem that may have several solutions, by turns. Each turn solves Coulomb's problem with bounds from the slips
//! of the turn before (as in CONTACT). The first bounds of LOW are those of no slip, those of HIGH belong to unlimited slip.
//!
//! Bounds that rise with the slip are damped. They occur on a layer that hardens, or if particles remember smaller bounds.
//!
//! Each turn starts from the tractions of the last one. Its tolerance falls as the bounds converge. The result has the same certificate as a solve
//! without a branch. Turns may diverge or cycle. Then the result is that of the turn with the least residual.

use super::super::levels::Level;
use super::super::plane::Vector;
use super::super::problem::Problem;
use super::super::step::compliance;
use super::march::March;
use super::{bounds, RISING};
use crate::error::Result;
use crate::memory::zeros;
use crate::powers::LARGEST;
use crate::progress::Outcome;

/// The largest number of turns.
const MOST_TURNS: u32 = 400;
/// The turns end as stagnated after more than this many in a row without progress.
const PATIENCE: u32 = 60;
/// Progress is a residual below this times the least one so far.
const GAIN: f64 = 0.95;
/// The tolerance of a turn is this times the residual of the turn before, within the limits of the next two constants.
const INNER: f64 = 0.05;
/// The largest tolerance of a turn, which is that of the first one.
const FIRST_TOLERANCE: f64 = 1e-3;
/// The least tolerance of a turn, relative to the tolerance of the solve.
const TOLERANCE_SHARE: f64 = 0.3;
/// Each time the residual does not fall from one turn to the next, the damping is multiplied by this factor.
const DAMPING: f64 = 0.7;
/// The least damping.
const LEAST_DAMPING: f64 = 0.01;
/// Below this residual tractions are projected onto the circles before a turn, because the turn counts those near a circle as on it.
const PROJECTED_BELOW: f64 = 1e-6;

/// The progress of the turns.
pub struct Turns {
    /// The number of turns made.
    pub made: u32,
    /// The damping: rising bounds move by this part of their change.
    pub damping: f64,
    /// The least residual so far.
    least: f64,
    /// The number of turns since progress was made.
    since: u32,
    /// The residual after the last turn.
    last: f64,
}

impl Turns {
    pub fn new() -> Turns {
        Turns { made: 0, damping: 1.0, least: f64::INFINITY, since: 0, last: f64::INFINITY }
    }

    /// The tolerance of the next turn.
    pub fn inner(&self, tolerance: f64) -> f64 {
        (INNER * self.last).clamp(TOLERANCE_SHARE * tolerance, FIRST_TOLERANCE.max(TOLERANCE_SHARE * tolerance))
    }

    /// Records the residual after a turn. Returns the outcome if the turns end, else none.
    pub fn end(&mut self, residual: f64, tolerance: f64) -> Option<Outcome> {
        self.made += 1;
        if !(residual < self.last) {
            self.damping = (DAMPING * self.damping).max(LEAST_DAMPING);
        }
        self.since = if residual < GAIN * self.least { 0 } else { self.since + 1 };
        (self.least, self.last) = (self.least.min(residual), residual);
        match () {
            () if residual < tolerance => Some(Outcome::Converged),
            () if !residual.is_finite() || self.are_in_vain() => Some(Outcome::Stagnated),
            () => None,
        }
    }

    /// Whether the turns end without progress or by their number.
    pub fn are_in_vain(&self) -> bool {
        self.since > PATIENCE || self.made >= MOST_TURNS
    }
}

/// Sets the bounds of the first turn: those of unlimited slip if `is_high`, else those of no slip.
pub fn begin(problem: &mut Problem, march: &mut March, is_high: bool) {
    let law = march.law;
    let slip = if is_high { LARGEST } else { 0.0 };
    march.go(|k, place, before| {
        let is_inside = place.pressure > 0.0;
        let response = law.at(if is_inside { slip } else { 0.0 }, place, before);
        problem.bound[k] = if is_inside { response.bound } else { 0.0 };
        response.particle
    });
}

/// The turn with the least residual so far, and the bounds of the last turn.
pub struct BestTurn {
    /// The tractions of the best turn.
    q: Vec<Vector>,
    /// The bounds with which the best turn was solved.
    bound: Vec<f64>,
    /// The residual of the best turn; infinite before the first turn.
    residual: f64,
    /// The bounds with which the last turn was solved.
    last_bound: Vec<f64>,
}

impl BestTurn {
    /// Allocates memory for n elements.
    pub fn new(n: usize) -> Result<BestTurn> {
        let what = "the best of turns";
        let (q, bound, last_bound) = (zeros(n, what)?, zeros(n, what)?, zeros(n, what)?);
        Ok(BestTurn { q, bound, residual: f64::INFINITY, last_bound })
    }

    /// Sets the state to the best turn, and computes the bounds from its slips.
    pub fn restore(&mut self, level: &mut Level, march: &mut March) -> Result<()> {
        if !self.residual.is_finite() {
            return Ok(());
        }
        let Level { problem, state, .. } = level;
        state.q.copy_from_slice(&self.q);
        problem.bound.copy_from_slice(&self.bound);
        problem.refresh_unclipped(state);
        renew(level, march, self).map(drop)
    }
}

/// Computes the bounds from the slips of the turn that was solved. Returns the residual with these bounds.
pub fn renew(level: &mut Level, march: &mut March, best: &mut BestTurn) -> Result<f64> {
    let Level { problem, state, memory, .. } = level;
    let tangent = &mut memory.tangent;
    tangent.fit(state.q.len())?;
    if !state.is_exact {
        problem.refresh_unclipped(state);
    }
    best.last_bound.copy_from_slice(&problem.bound);
    tangent.predict(problem, state, 1.0 / compliance(problem));
    bounds::lag(problem, state, tangent, march);
    let residual = bounds::worst(problem, state, tangent);
    if residual < best.residual {
        best.q.copy_from_slice(&state.q);
        best.bound.copy_from_slice(&best.last_bound);
        best.residual = residual;
    }
    Ok(residual)
}

/// Sets the bounds of the next turn. [`renew`] has computed them from the slips of the last turn. If bounds rise steeply with the slip, they are
/// corrected for the reduction of the slips that they cause ([`bounds::follow`]), and damped. Otherwise bounds and slips would alternate.
pub fn set_bounds(level: &mut Level, march: &mut March, (turns, best): (&Turns, &BestTurn)) {
    let Level { problem, state, memory, .. } = level;
    if march.rises > RISING {
        let (rho, part) = (1.0 / compliance(problem), turns.damping);
        bounds::follow(problem, state, &memory.tangent, march, Some(rho));
        problem.bound.iter_mut().zip(&best.last_bound).for_each(|(bound, last)| *bound = last + part * (*bound - last));
    }
    if turns.last < PROJECTED_BELOW {
        bounds::onto_circles(problem, state, &memory.tangent);
    }
}

/// Moves the tractions onto their circles, with fresh displacements. Returns the larger of the residuals of the slips and of the bounds.
pub fn certify(level: &mut Level, march: &mut March) -> f64 {
    let Level { problem, state, memory, .. } = level;
    bounds::settle(problem, state, &memory.tangent, march);
    bounds::freeze(problem, state, &memory.tangent, march)
}
