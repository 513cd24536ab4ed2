//! The tangential problem of a step, as one that is [coupled](Coupled) with the normal problem.

use super::tangential::{Tangent, Turn};
use super::{Options, Outcome};
use crate::contact::State;
use crate::effects::Coupled;
use crate::error::{Error, Result};
use crate::friction::{Report, Start};
use crate::progress::Monitor;

/// Its solver, and the results so far.
pub struct TangentialTurn<'a> {
    /// Its solver.
    pub tangent: &'a mut Tangent,
    /// The step.
    pub turn: Turn<'a>,
    /// Of the last solve, with the products and the seconds of all.
    pub found: Option<Report>,
    /// Why the last pressures do not carry the forces that are given.
    refusal: Option<Error>,
}

impl<'a> TangentialTurn<'a> {
    /// Of which nothing is solved yet.
    pub fn new(tangent: &'a mut Tangent, turn: Turn<'a>) -> TangentialTurn<'a> {
        TangentialTurn { tangent, turn, found: None, refusal: None }
    }

    /// Iterations that the options leave.
    fn left(&self) -> usize {
        let done = self.found.as_ref().map_or(0, |found| found.products as usize);
        self.turn.options.max_cycles.saturating_sub(done)
    }
}

impl Coupled for TangentialTurn<'_> {
    fn solve(&mut self, stop: Outcome, state: &State, monitor: &mut Monitor<'_>) -> Result<Outcome> {
        let rest = Options { max_cycles: self.left(), ..*self.turn.options };
        let turn = Turn { options: &rest, ..self.turn };
        let start = if self.found.is_some() { Start::Again } else { turn.start() };
        let (outcome, mut found, refusal) = self.tangent.solve_after(stop, &turn, &state.p, start, monitor)?;
        // Those of a normal problem that is not solved refuse nothing.
        self.refusal = refusal.filter(|_| stop == Outcome::Converged);
        if let Some(before) = &self.found {
            (found.products, found.seconds) = (found.products + before.products, found.seconds + before.seconds);
        }
        self.found = Some(found);
        // Tractions that only lead to the next pressures need no more than that.
        Ok(if self.refusal.is_some() && outcome != Outcome::Cancelled { Outcome::Converged } else { outcome })
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
