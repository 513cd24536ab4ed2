//! Named solutions of a problem with several. Coulomb's problem is solved in turns, each with the bounds of the last slips (as in CONTACT).
//!
//! ```text
//! LOW:  the first bounds are those of no slip        HIGH: those of unlimited slip
//! ```
//!
//! Bounds that rise with the slip are damped. They occur on a layer that hardens, or with a memory of smaller bounds.
//!
//! Each turn starts from the tractions of the last one. Its tolerance falls as the bounds converge. The result has the certificate of a solve without
//! a branch. Turns may diverge or cycle. Then the result is that of the turn with the least residual.

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

/// The most turns, and the most turns in a row without a residual below the fraction `GAIN` of the least one.
const MOST_TURNS: u32 = 400;
const PATIENCE: u32 = 60;
const GAIN: f64 = 0.95;
/// The tolerance of a turn: this fraction of the error of its bounds, but at most `FIRST_TOLERANCE`, as in the first
/// turn, and at least the fraction `TOLERANCE_SHARE` of the tolerance.
const INNER: f64 = 0.05;
const FIRST_TOLERANCE: f64 = 1e-3;
const TOLERANCE_SHARE: f64 = 0.3;
/// If a residual grows from turn to turn, the steps of rising bounds are reduced by this factor from then on, down to the least factor.
const DAMPING: f64 = 0.7;
const LEAST_DAMPING: f64 = 0.01;
/// Below this residual tractions are projected onto the circles before a turn, because the turn counts those near a circle as on it.
const PROJECTED_BELOW: f64 = 1e-6;

/// The progress of the turns.
pub struct Turns {
    pub made: u32,
    /// The fraction of their change by which rising bounds move.
    pub damping: f64,
    least: f64,
    since: u32,
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

    /// Takes the residual after a turn. Returns the outcome if the turns end.
    pub fn end(&mut self, left: f64, tolerance: f64) -> Option<Outcome> {
        self.made += 1;
        if !(left < self.last) {
            self.damping = (DAMPING * self.damping).max(LEAST_DAMPING);
        }
        self.since = if left < GAIN * self.least { 0 } else { self.since + 1 };
        (self.least, self.last) = (self.least.min(left), left);
        match () {
            () if left < tolerance => Some(Outcome::Converged),
            () if !left.is_finite() || self.are_in_vain() => Some(Outcome::Stagnated),
            () => None,
        }
    }

    /// Whether further turns are useless.
    pub fn are_in_vain(&self) -> bool {
        self.since > PATIENCE || self.made >= MOST_TURNS
    }
}

/// The bounds of the first turn.
pub fn begin(problem: &mut Problem, march: &mut March, is_high: bool) {
    let law = march.law;
    let slip = if is_high { LARGEST } else { 0.0 };
    march.go(|k, place, had| {
        let is_inside = place.pressure > 0.0;
        let response = law.at(if is_inside { slip } else { 0.0 }, place, had);
        problem.bound[k] = if is_inside { response.bound } else { 0.0 };
        response.particle
    });
}

/// The turn with the least residual so far.
pub struct Best {
    /// Its tractions, and their bounds.
    q: Vec<Vector>,
    bound: Vec<f64>,
    left: f64,
    /// The bounds of the last turn.
    last: Vec<f64>,
}

impl Best {
    /// Memory for n elements, without a turn.
    pub fn new(n: usize) -> Result<Best> {
        let what = "the best of turns";
        Ok(Best { q: zeros(n, what)?, bound: zeros(n, what)?, left: f64::INFINITY, last: zeros(n, what)? })
    }

    /// Restores it as the last turn, and renews its bounds.
    pub fn restore(&mut self, level: &mut Level, march: &mut March) -> Result<()> {
        if !self.left.is_finite() {
            return Ok(());
        }
        let Level { problem, state, .. } = level;
        state.q.copy_from_slice(&self.q);
        problem.bound.copy_from_slice(&self.bound);
        problem.refresh_unclipped(state);
        renew(level, march, self).map(drop)
    }
}

/// Computes the bounds from the slips of a turn. Returns the residual with these bounds.
pub fn renew(level: &mut Level, march: &mut March, best: &mut Best) -> Result<f64> {
    let Level { problem, state, memory, .. } = level;
    let tangent = &mut memory.tangent;
    tangent.fit(state.q.len())?;
    if !state.is_exact {
        problem.refresh_unclipped(state);
    }
    best.last.copy_from_slice(&problem.bound);
    tangent.predict(problem, state, 1.0 / compliance(problem));
    bounds::lag(problem, state, tangent, march);
    let left = bounds::worst(problem, state, tangent);
    if left < best.left {
        best.q.copy_from_slice(&state.q);
        best.bound.copy_from_slice(&best.last);
        best.left = left;
    }
    Ok(left)
}

/// Sets the bounds of the next turn. Bounds that rise with the slip move only as far as the slips follow, and by a fraction of that.
/// Otherwise their changes and those of the slips would alternate.
pub fn go_on(level: &mut Level, march: &mut March, (turns, best): (&Turns, &Best)) {
    let Level { problem, state, memory, .. } = level;
    if march.rises > RISING {
        let (rho, part) = (1.0 / compliance(problem), turns.damping);
        bounds::follow(problem, state, &memory.tangent, march, Some(rho));
        problem.bound.iter_mut().zip(&best.last).for_each(|(bound, last)| *bound = last + part * (*bound - last));
    }
    if turns.last < PROJECTED_BELOW {
        bounds::onto_circles(problem, state, &memory.tangent);
    }
}

/// Recomputes the state. Returns the larger of the residuals of the slips and of the bounds.
pub fn certify(level: &mut Level, march: &mut March) -> f64 {
    let Level { problem, state, memory, .. } = level;
    bounds::settle(problem, state, &memory.tangent, march);
    bounds::freeze(problem, state, &memory.tangent, march)
}
