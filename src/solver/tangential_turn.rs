//! The tangential problem of a step as a problem that is [coupled](Coupled) with the normal one. The tangential problem of a turn has either the
//! given forces ("by force"), or creepages held in their place (module [`by_creepages`](super::by_creepages)).

use super::tangential::{Tangent, Turn};
use super::{Options, Outcome};
use crate::contact::State;
use crate::effects::Coupled;
use crate::error::{Error, Number, Result};
use crate::friction::{length, Report, Start, Vector};
use crate::progress::Monitor;
use crate::scene::Prescribed;

/// The tangential problem of a step, and its results so far.
pub struct TangentialTurn<'a> {
    /// The solver of the tangential problem.
    pub tangent: &'a mut Tangent,
    /// The inputs that are the same in all turns.
    pub turn: Turn<'a>,
    /// The report of the last solve, but with products and seconds of all solves of the step. None before the first.
    pub found: Option<Report>,
    /// Creepages times the length rolled that replace the given forces, if turns hold creepages.
    pub held: Option<Vector>,
    /// Most products of one solve.
    pub most: usize,
    /// Whether the turns are by force, and turns with held creepages may follow.
    pub by_force: bool,
    /// The error that says why the last pressures do not carry the given forces; None if they do.
    refusal: Option<Error>,
}

/// Residuals below this are round-off.
pub const ROUND_OFF: f64 = 1e-11;
/// If the given force exceeds this part of mu N, turns with held creepages may be needed.
const NEAR_FULL_SLIP: f64 = 0.8;
/// The part of the products that turns by force then get; the rest is for turns with held creepages.
const BY_FORCE_SHARE: f64 = 0.6;
/// Tolerance of turns with held creepages, relative to that of the options. It is smaller, because forces of two series of turns are compared.
const CREEPAGES_TOLERANCE: f64 = 0.1;
/// The least such tolerance: smaller ones are below round-off.
const LEAST_TOLERANCE: f64 = 1e-13;

/// Options of turns with held creepages.
pub fn sharper(options: &Options) -> Options {
    Options {
        tolerance: (CREEPAGES_TOLERANCE * options.tolerance).max(LEAST_TOLERANCE.min(options.tolerance)),
        ..*options
    }
}

impl<'a> TangentialTurn<'a> {
    /// The tangential problem of a step, before its first solve.
    pub fn new(tangent: &'a mut Tangent, turn: Turn<'a>) -> TangentialTurn<'a> {
        let by_force = turn.friction.has_forces() != [false; 2];
        // Held creepages do not help if the tolerance is below round-off.
        let is_attainable = turn.options.tolerance >= LEAST_TOLERANCE;
        let by_force = by_force && is_attainable && !tangent.is_of_like_bodies() && !turn.friction.has_law();
        TangentialTurn { tangent, turn, found: None, held: None, most: usize::MAX, by_force, refusal: None }
    }

    /// The number of products that remain of `max_cycles` for the present kind of turns.
    fn left(&self) -> usize {
        let done = self.found.as_ref().map_or(0, |found| found.products as usize);
        let share = if self.is_near() { BY_FORCE_SHARE } else { 1.0 };
        ((share * self.turn.options.max_cycles as f64).ceil() as usize).saturating_sub(done)
    }

    /// The last forces less the given ones, and the creepages of the last solve times the length rolled. None before the first solve.
    pub fn excess(&self) -> Option<(Vector, Vector)> {
        Some(self.tangent.excess(self.turn.friction, self.found.as_ref()?))
    }

    /// Whether the turns are by force and the force exceeds [`NEAR_FULL_SLIP`] times mu N, so that nearly all of C slips.
    pub fn is_near(&self) -> bool {
        let wanted = length(self.wanted());
        self.by_force && self.found.as_ref().is_some_and(|found| wanted > NEAR_FULL_SLIP * found.carried)
    }

    /// Whether the residual of the last solve is round-off.
    pub fn is_at_round_off(&self) -> bool {
        self.found.as_ref().is_some_and(|found| found.certificate.residual.max(found.missing) < ROUND_OFF)
    }

    /// Whether the last pressures do not carry the given forces.
    pub fn is_refused(&self) -> bool {
        self.refusal.is_some()
    }

    /// Removes and returns the error that says why the last pressures do not carry the given forces.
    pub fn take_refusal(&mut self) -> Option<Error> {
        self.refusal.take()
    }

    /// Sets the error that [`refuse`](Coupled::refuse) returns after the last turn; None: no error.
    pub fn refuse_by(&mut self, refusal: Option<Error>) {
        self.refusal = refusal;
    }

    /// Writes the largest force of all creepages that were tried into the message of `refusal`. `excess` is that force less the given one, relative
    /// to mu N.
    pub fn with_largest(&self, refusal: Error, excess: Option<f64>) -> Error {
        let carried = self.found.as_ref().map_or(0.0, |found| found.carried);
        let wanted = length(self.wanted());
        match (refusal, excess) {
            (Error::Infeasible(_), Some(excess)) if excess.is_finite() => Error::Infeasible(format!(
                "the tangential force is {}; of the creepages that were looked through none reaches more than {}",
                Number(wanted),
                Number(wanted + excess * carried)
            )),
            (refusal, _) => refusal,
        }
    }

    /// The given forces; 0 in directions without one.
    pub fn wanted(&self) -> Vector {
        self.turn.friction.prescribed.map(|prescribed| match prescribed {
            Prescribed::Force(force) => force,
            Prescribed::Creepage(_) => 0.0,
        })
    }

    /// The largest slip of the last result.
    pub fn largest_slip(&self) -> f64 {
        let slips = self.tangent.solution().into_iter().flat_map(|solution| &solution.slip);
        slips.fold(0.0, |largest: f64, slip| largest.max(length(*slip)))
    }

    /// The displacement by the tractions of full slip with the pressures of the last result.
    pub fn full_displacement(&self) -> f64 {
        self.tangent.full_displacement()
    }

    /// Accepts the last forces, which differ from the given ones by `missing` times mu N, less than the tolerance.
    pub fn accept(&mut self, missing: f64) {
        self.refusal = None;
        self.found.iter_mut().for_each(|found| found.missing = missing);
    }
}

impl Coupled for TangentialTurn<'_> {
    fn solve(&mut self, outcome: Outcome, state: &State, monitor: &mut Monitor<'_>) -> Result<Outcome> {
        let rest = Options { max_cycles: self.left().min(self.most), ..*self.turn.options };
        let rest = if self.held.is_some() { sharper(&rest) } else { rest };
        let turn = Turn { options: &rest, ..self.turn };
        let start = match self.held {
            Some(held) => Start::Held(held),
            None if self.found.is_some() => Start::Again,
            None => turn.start(),
        };
        let (ended, mut found, refusal) = self.tangent.solve_after(outcome, &turn, &state.p, start, monitor)?;
        // Pressures of a normal problem that did not converge prove nothing about the forces.
        self.refusal = refusal.filter(|_| outcome == Outcome::Converged);
        if let Some(before) = &self.found {
            (found.products, found.seconds) = (found.products + before.products, found.seconds + before.seconds);
        }
        self.found = Some(found);
        // If the pressures do not carry the forces, the tractions only serve to find the next pressures. The turn counts as converged, so that the
        // turns go on.
        Ok(if self.refusal.is_some() && ended != Outcome::Cancelled { Outcome::Converged } else { ended })
    }

    // Tractions of like bodies displace nothing along the normal.
    fn displaces(&self) -> bool {
        !self.tangent.is_of_like_bodies()
    }

    fn displace(&mut self, distance: &mut [f64]) {
        self.tangent.displace(distance);
    }

    fn has_work_left(&self) -> bool {
        self.left() > 0
    }

    fn refuse(&mut self) -> Result<()> {
        self.refusal.take().map_or(Ok(()), Err)
    }

    fn step_done(&mut self, state: &State) {
        self.tangent.keep_pressures(&state.p);
    }
}
