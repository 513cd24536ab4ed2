//! Normal and tangential problem in turns. Of unlike bodies each changes the other.

use super::superposition::Smaller;
use super::tangential::{Tangent, Turn};
use super::{InitialGuess, Options, Solver};
use crate::error::Result;
use crate::friction::{self, Start};
use crate::progress::{Monitor, Outcome};
use crate::scene::Scene;

/// Turns of the normal and the tangential problem of unlike bodies at most: each brings them together by 4 to 30 times.
const MOST_TURNS: u32 = 50;

impl Solver {
    /// The tangential problem, if the scene has friction. Of unlike bodies normal and tangential problem are solved in turns until the
    /// tractions do not change the normal one any more (Panagiotopoulos 1975).
    pub(super) fn solve_friction(
        &mut self,
        scene: &Scene<'_>,
        options: &Options,
        stop: Outcome,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Option<friction::Report>)> {
        let mut kept = self.friction.take();
        let Some(friction) = scene.friction.as_ref() else {
            if let Some(before) = &mut kept {
                before.forget();
            }
            self.friction = kept;
            return Ok((stop, None));
        };
        let threads = self.problem.threads.clone();
        let mut tangent = match kept {
            Some(kept) if kept.suits(friction) => kept,
            _ => Box::new(Tangent::new(scene, options, &threads)?),
        };
        let turn = Turn { scene, friction, options, threads: &threads };
        let outcome = self.take_turns(&mut tangent, &turn, stop, monitor);
        if outcome.is_ok() {
            tangent.keep_pressures(&self.state.p);
        }
        self.friction = Some(tangent);
        outcome.map(|(stop, found)| (stop, Some(found)))
    }

    fn take_turns(
        &mut self,
        tangent: &mut Tangent,
        turn: &Turn<'_>,
        mut stop: Outcome,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, friction::Report)> {
        let smaller = if tangent.is_of_like_bodies() { self.smaller_load(turn, stop, monitor)? } else { None };
        let start = smaller.as_ref().map_or(Start::Before, Smaller::start);
        let (mut tangential_stop, mut found) = tangent.solve_after(stop, turn, &self.state.p, start, monitor)?;
        if let Some(smaller) = smaller {
            if tangential_stop == Outcome::Converged && monitor.is_cancelled() {
                tangential_stop = Outcome::Cancelled;
            }
            (found.products, found.seconds) = (found.products + smaller.products, found.seconds + smaller.seconds);
        }
        let options = Options { initial_guess: InitialGuess::Previous, error_ratio: 0.0, ..*turn.options };
        for _ in 0..MOST_TURNS {
            let Some((distance, change)) = tangent.distance(turn.scene, &self.state) else {
                return Ok((worse(stop, tangential_stop), found));
            };
            if change <= turn.options.tolerance || worse(stop, tangential_stop) != Outcome::Converged {
                return Ok((worse(stop, tangential_stop), found));
            }
            monitor.ledger.rows.pop();
            monitor.enter_grid();
            let scene = Scene { undeformed_distance: distance, ..turn.scene.clone() };
            (stop, _) = self.solve_normal(&scene, &options, None, monitor)?;
            let (products, seconds) = (found.products, found.seconds);
            (tangential_stop, found) = tangent.solve_after(stop, turn, &self.state.p, Start::Again, monitor)?;
            (found.products, found.seconds) = (found.products + products, found.seconds + seconds);
        }
        log::info!("normal and tangential problem of unlike bodies do not agree after {MOST_TURNS} turns");
        Ok((worse(Outcome::Stagnated, tangential_stop), found))
    }
}

/// What is to be said of two solves.
fn worse(one: Outcome, other: Outcome) -> Outcome {
    if one == Outcome::Converged {
        other
    } else {
        one
    }
}
