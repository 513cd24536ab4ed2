//! Solutions by name, where there are several: Coulomb's problem is solved with the bounds of the last slips, in turns (CONTACT's way).
//!
//! ```text
//! LOW:  the first bounds are those of no slip        HIGH: those of any speed
//! ```
//!
//! Bounds that rise with the slip, on a layer that hardens or by a memory of less, are damped.
//!
//! Each turn begins from the tractions of the last one, and its tolerance falls as the bounds settle. The result has the certificate of a solve without
//! a branch. Turns may have no end, or go around: then the result is that of the turn that left least.

use super::super::levels::Level;
use super::super::plane::Vector;
use super::super::problem::Problem;
use super::super::step::compliance;
use super::march::March;
use super::{bounds, STEEP};
use crate::error::Result;
use crate::memory::zeros;
use crate::progress::Outcome;

/// Turns at most, and those without a residual below this part of the least one.
const MOST: u32 = 400;
const PATIENCE: u32 = 60;
const GAIN: f64 = 0.95;
/// A turn solves to this part of what its bounds are off by; the first one to this residual, and all below this part of the tolerance.
const INNER: f64 = 0.05;
const FIRST: f64 = 1e-3;
const ENOUGH: f64 = 0.3;
/// Where a turn leaves more than the one before, bounds that rise go from then on by this part of the way that they went, but by so much at least.
const DAMPED: f64 = 0.7;
const LEAST_DAMPING: f64 = 0.01;
/// From this residual on tractions go onto the circles before a turn: it takes those that are near a circle as on it.
const NEAR: f64 = 1e-6;
/// A length beyond all slips, whose square is a number.
const ANY: f64 = 1e150;

/// The progress of the turns.
pub struct Turns {
    pub made: u32,
    /// The part of their change by which bounds that rise go.
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
        (INNER * self.last).clamp(ENOUGH * tolerance, FIRST.max(ENOUGH * tolerance))
    }

    /// Takes what is left after a turn; how it ends, if it does.
    pub fn end(&mut self, left: f64, tolerance: f64) -> Option<Outcome> {
        self.made += 1;
        if !(left < self.last) {
            self.damping = (DAMPED * self.damping).max(LEAST_DAMPING);
        }
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
        let is_inside = place.pressure > 0.0;
        let response = law.at(if is_inside { slip } else { 0.0 }, place, had);
        problem.bound[k] = if is_inside { response.bound } else { 0.0 };
        response.particle
    });
}

/// The turn that left least so far.
pub struct Best {
    /// Its tractions, and the bounds that they were found with.
    q: Vec<Vector>,
    bound: Vec<f64>,
    left: f64,
    /// The bounds of the last turn.
    last: Vec<f64>,
}

impl Best {
    /// None yet, of n elements.
    pub fn new(n: usize) -> Result<Best> {
        let what = "the best of turns";
        Ok(Best { q: zeros(n, what)?, bound: zeros(n, what)?, left: f64::INFINITY, last: zeros(n, what)? })
    }

    /// Takes it for the last turn, whose bounds are renewed again.
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

/// Bounds by the slips that a turn has found; what is left with these.
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

/// The bounds of the next turn where this one left too much. Those that rise with the slip go no farther than slips follow, and by a part
/// of that: their changes and those of slips chase each other otherwise.
pub fn go_on(level: &mut Level, march: &mut March, (turns, best): (&Turns, &Best)) {
    let Level { problem, state, memory, .. } = level;
    if march.rises > STEEP {
        let (rho, part) = (1.0 / compliance(problem), turns.damping);
        bounds::follow(problem, state, &memory.tangent, march, Some(rho));
        problem.bound.iter_mut().zip(&best.last).for_each(|(bound, last)| *bound = last + part * (*bound - last));
    }
    if turns.last < NEAR {
        bounds::onto_circles(problem, state, &memory.tangent);
    }
}

/// A fresh state. Returns the larger residual of both certificates.
pub fn certify(level: &mut Level, march: &mut March) -> f64 {
    let Level { problem, state, memory, .. } = level;
    bounds::settle(problem, state, &memory.tangent, march);
    bounds::freeze(problem, state, &memory.tangent, march)
}
