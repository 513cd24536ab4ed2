//! Normal and tangential problem in turns. Of unlike bodies each changes the other.

use super::take_over::take_distance;
use super::tangential::{Tangent, Turn};
use super::{InitialGuess, Options, Solver};
use crate::contact::{lowest, Fixed, NonNegative, Survey};
use crate::error::Result;
use crate::friction::{self, Start};
use crate::progress::{Monitor, Outcome};
use crate::scene::{Friction, Scene};

/// Turns of the normal and the tangential problem of unlike bodies at most: each brings them together by 4 to 30 times.
const MOST_TURNS: u32 = 50;

impl Solver {
    /// The tangential problem, if the scene has friction. Of unlike bodies normal and tangential problem are solved in turns until the
    /// certificate of the normal one holds with the tractions found last (Panagiotopoulos 1975).
    pub(super) fn solve_friction(
        &mut self,
        scene: &Scene<'_>,
        options: &Options,
        stop: Outcome,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Option<friction::Report>)> {
        let Some(friction) = scene.friction.as_ref() else {
            self.friction.iter_mut().for_each(|before| before.forget());
            return Ok((stop, None));
        };
        let threads = self.problem.threads.clone();
        let mut tangent = self.take_tangent(scene, options)?;
        let turn = Turn { scene, friction, options, threads: &threads };
        let outcome = tangent.last().and_then(|last| {
            let outcome = self.solve_step(&mut tangent, &turn, stop, monitor);
            match outcome.is_ok() {
                true => tangent.keep_pressures(&self.state.p),
                false => tangent.go_back(last),
            }
            outcome
        });
        self.friction = Some(tangent);
        outcome.map(|(stop, found)| (stop, Some(found)))
    }

    /// Both problems, and what was asked for beside. What was cancelled stays so.
    fn solve_step(
        &mut self,
        tangent: &mut Tangent,
        turn: &Turn<'_>,
        stop: Outcome,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, friction::Report)> {
        tangent.take_distance(&self.state.h);
        // Of unlike bodies derivatives follow when the turns are over.
        let follow = turn.friction.sensitivities && !tangent.is_of_like_bodies();
        let friction = &Friction { sensitivities: turn.friction.sensitivities && !follow, ..*turn.friction };
        let (stop, mut found) = self.take_turns(tangent, &Turn { friction, ..*turn }, stop, monitor)?;
        if follow && !monitor.is_cancelled() {
            self.add_sensitivities(tangent, turn, &mut found, monitor)?;
        }
        Ok((if monitor.is_cancelled() { Outcome::Cancelled } else { stop }, found))
    }

    fn take_turns(
        &mut self,
        tangent: &mut Tangent,
        turn: &Turn<'_>,
        mut stop: Outcome,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, friction::Report)> {
        let (mut tangential_stop, mut found) = tangent.solve_after(stop, turn, &self.state.p, turn.start(), monitor)?;
        if turn.options.initial_guess != InitialGuess::Previous {
            // Turns go on from each other, not from what was solved before.
            self.methods.projected_cg.forget_solutions();
        }
        let again = Options { initial_guess: InitialGuess::Previous, error_ratio: 0.0, ..*turn.options };
        let mut cycles = 0;
        for solved in 0..=MOST_TURNS {
            let so_far = worse(stop, tangential_stop);
            let Some((distance, change)) = tangent.distance(&self.state) else {
                return Ok((so_far, found));
            };
            // Tractions that displace nothing leave the normal problem as it was found.
            let Some(change) = change else {
                return Ok((so_far, found));
            };
            if self.holds_with(distance, change, turn, monitor) || so_far != Outcome::Converged {
                return Ok((so_far, found));
            }
            if solved == MOST_TURNS {
                break;
            }
            // The work of all turns together is bounded by what the caller said.
            let most = turn.options.max_cycles;
            let (left, left_normal) = (most.saturating_sub(found.products as usize), most.saturating_sub(cycles));
            if left == 0 || left_normal == 0 {
                return Ok((Outcome::IterationLimit, found));
            }
            monitor.ledger.rows.pop();
            monitor.enter_grid();
            let scene = Scene { undeformed_distance: distance, ..turn.scene.clone() };
            let options = Options { max_cycles: left_normal, ..again };
            (stop, _) = self.solve_normal((&scene, lowest(distance)), &options, None, monitor)?;
            cycles += monitor.count.cycles as usize;
            let (products, seconds) = (found.products, found.seconds);
            let rest = Options { max_cycles: left, ..*turn.options };
            let turn = Turn { options: &rest, ..*turn };
            (tangential_stop, found) = tangent.solve_after(stop, &turn, &self.state.p, Start::Again, monitor)?;
            (found.products, found.seconds) = (found.products + products, found.seconds + seconds);
        }
        log::info!("normal and tangential problem of unlike bodies do not agree after {MOST_TURNS} turns");
        Ok((Outcome::Stagnated, found))
    }

    /// Takes the normal certificate of the pressures with the distance that the last tractions make, which changed it by `change`: that is
    /// reported. Says whether it holds.
    fn holds_with(&mut self, distance: &[f64], change: f64, turn: &Turn<'_>, monitor: &mut Monitor<'_>) -> bool {
        let Solver { problem, state, .. } = self;
        take_distance(state, distance, &problem.threads);
        state.fit_approach(&problem.threads);
        let survey = Survey::by(state, &problem.threads);
        let goal = turn.options.goal();
        let holds = match turn.scene.pressure_limit {
            _ if turn.options.is_fixed() => goal.holds(&survey, 0.0, Fixed),
            None => goal.holds(&survey, 0.0, NonNegative),
            Some(limit) => goal.holds(&survey, 0.0, limit),
        };
        monitor.ledger.rows.pop();
        monitor.survey = Some(survey);
        monitor.close_grid(state);
        holds && (!goal.by_update() || change <= goal.tolerance)
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
