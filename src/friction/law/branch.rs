//! Solutions by name, where there are several: Coulomb's problem is solved with the bounds of the last slips, in turns (CONTACT's way).
//!
//! ```text
//! LOW:  the first bounds are those of no slip        HIGH: those of any speed
//! ```
//!
//! Each turn begins from the tractions of the last one, and its tolerance falls as the bounds settle. The result has the certificate of a solve without
//! a branch.

use super::super::levels::Level;
use super::super::problem::Problem;
use super::super::step::compliance;
use super::march::March;
use super::stages;
use crate::error::Result;
use crate::progress::Outcome;

/// Turns at most, and those without a residual below this part of the least one.
const MOST: u32 = 400;
const PATIENCE: u32 = 60;
const GAIN: f64 = 0.95;
/// A turn solves to this part of what its bounds are off by; the first one to this residual, and all below this part of the tolerance.
const INNER: f64 = 0.05;
const FIRST: f64 = 1e-3;
const ENOUGH: f64 = 0.3;
/// A length beyond all slips, whose square is a number.
const ANY: f64 = 1e150;

/// The progress of the turns.
pub struct Turns {
    pub made: u32,
    least: f64,
    since: u32,
    last: f64,
}

impl Turns {
    pub fn new() -> Turns {
        Turns { made: 0, least: f64::INFINITY, since: 0, last: f64::INFINITY }
    }

    /// The tolerance of the next turn.
    pub fn inner(&self, tolerance: f64) -> f64 {
        (INNER * self.last).clamp(ENOUGH * tolerance, FIRST.max(ENOUGH * tolerance))
    }

    /// Takes what is left after a turn; how it ends, if it does.
    pub fn end(&mut self, left: f64, tolerance: f64) -> Option<Outcome> {
        self.made += 1;
        self.since = if left < GAIN * self.least { 0 } else { self.since + 1 };
        (self.least, self.last) = (self.least.min(left), left);
        match () {
            () if left < tolerance => Some(Outcome::Converged),
            () if !left.is_finite() || self.are_in_vain() => Some(Outcome::Stagnated),
            () => None,
        }
    }

    /// Whether further turns are given up.
    pub fn are_in_vain(&self) -> bool {
        self.since > PATIENCE || self.made >= MOST
    }
}

/// The bounds of the first turn.
pub fn begin(problem: &mut Problem, march: &mut March, is_high: bool) {
    let law = march.law;
    let slip = if is_high { ANY } else { 0.0 };
    march.go(|k, place, had| {
        let response = law.at(if place.pressure > 0.0 { slip } else { 0.0 }, place, had);
        if problem.bound[k] > 0.0 {
            problem.bound[k] = response.bound;
        }
        response.particle
    });
}

/// Bounds by the slips that a turn has found; what is left with these.
pub fn renew(level: &mut Level, march: &mut March) -> Result<f64> {
    let Level { problem, state, memory, .. } = level;
    let tangent = &mut memory.tangent;
    tangent.fit(state.q.len())?;
    if !state.is_exact {
        problem.refresh_unclipped(state);
    }
    tangent.predict(problem, state, 1.0 / compliance(problem));
    stages::lag(problem, state, tangent, march);
    Ok(stages::worst(problem, state, tangent))
}

/// Elements that slip go onto the circles of the last bounds. Returns the larger residual of both certificates.
pub fn certify(level: &mut Level, march: &mut March) -> f64 {
    let Level { problem, state, memory, .. } = level;
    stages::onto_circles(problem, state, &memory.tangent);
    stages::freeze(problem, state, &memory.tangent, march)
}
