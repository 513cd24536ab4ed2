//! The further problems of a scene: friction, and effects that are coupled with the normal problem.

use super::beside::Beside;
use super::tangential::{Tangent, Turn};
use super::tangential_turn::TangentialTurn;
use super::turns::{InTurns, Turns};
use super::{Options, Solver};
use crate::effects::{self, Continues};
use crate::error::{invalid, Error, Result};
use crate::friction::Report;
use crate::progress::{Monitor, Outcome};
use crate::scene::{Friction, Scene};

impl Solver {
    /// Checks that a step that continues has a previous state.
    pub(super) fn check_continues(&self, scene: &Scene<'_>) -> Result<()> {
        for (k, name, Continues { from, .. }) in effects::continuing(scene) {
            let has_step = match name {
                // Tractions of `solve_tangential` have no normal problem.
                Friction::NAME => match &self.friction {
                    Some(tangent) => tangent.last_step().is_some(),
                    None => self.step_before.is_some(),
                },
                _ => {
                    let history = &self.beside.histories[k];
                    (self.has_result || history.is_given) && history.has_step()
                }
            };
            if !has_step {
                return invalid(format!("{name} continues, but this solver holds no {from} yet"));
            }
        }
        Ok(())
    }

    /// Solves the further problems of a scene, after the normal problem ended with `outcome`. Returns the report of friction with the outcome.
    pub(super) fn solve_beside(
        &mut self,
        scene: &Scene<'_>,
        options: &Options,
        outcome: Outcome,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Option<Report>)> {
        let mut tangent = match scene.friction {
            Some(_) => Some(self.take_tangent(scene, options)?),
            None => None,
        };
        let mut beside = std::mem::take(&mut self.beside);
        let solved = match effects::beside(scene).next() {
            Some(_) => self.solve_step(tangent.as_deref_mut(), &mut beside, (scene, options), outcome, monitor),
            None => Ok((outcome, None)),
        };
        if solved.is_ok() {
            effects::keep(scene, &mut beside.histories);
        }
        self.beside = beside;
        match (tangent, &solved) {
            (Some(tangent), _) => self.friction = Some(tangent),
            (None, Ok(_)) => self.friction.iter_mut().for_each(|before| before.pass_over()),
            (None, Err(_)) => {}
        }
        solved
    }

    /// Solves the further problems, with the requested derivatives. An error restores the last tractions. A cancelled
    /// solve stays cancelled.
    fn solve_step(
        &mut self,
        tangent: Option<&mut Tangent>,
        beside: &mut Beside,
        (scene, options): (&Scene<'_>, &Options),
        outcome: Outcome,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Option<Report>)> {
        let threads = self.problem.threads.clone();
        check_derivatives(scene, tangent.as_deref())?;
        let last = tangent.as_deref().map_or(Ok(None), Tangent::last)?;
        // Derivatives of unlike bodies are computed after the iteration between both problems.
        let follow = tangent.as_deref().is_some_and(|tangent| !tangent.is_of_like_bodies());
        let during =
            scene.friction.map(|friction| Friction { sensitivities: friction.sensitivities && !follow, ..friction });
        let friction = tangent.zip(during.as_ref()).map(|(tangent, friction)| {
            TangentialTurn::new(tangent, Turn { scene, friction, options, threads: &threads })
        });
        let others = effects::coupled(scene, &mut beside.histories)?;
        let mut turns = Turns { friction, others, distances: &mut beside.distances };
        let solved = InTurns::new(self, &mut turns, (scene, options), monitor).solve(outcome).and_then(|outcome| {
            self.add_derivatives(&mut turns, scene, monitor)?;
            Ok(outcome)
        });
        match solved {
            Ok(outcome) => {
                turns.all().for_each(|coupled| coupled.step_done(&self.state));
                let outcome = if monitor.is_cancelled() { Outcome::Cancelled } else { outcome };
                Ok((outcome, turns.friction.and_then(|friction| friction.found)))
            }
            Err(error) => {
                if let Some(friction) = turns.friction {
                    friction.tangent.go_back(last);
                }
                Err(error)
            }
        }
    }

    /// The derivatives of the tangential forces of unlike bodies, if they are requested.
    fn add_derivatives(&mut self, turns: &mut Turns<'_>, scene: &Scene<'_>, monitor: &mut Monitor<'_>) -> Result<()> {
        let Some(TangentialTurn { tangent, turn, found: Some(found), .. }) = &mut turns.friction else { return Ok(()) };
        let wanted = scene.friction.as_ref().filter(|friction| friction.sensitivities && !tangent.is_of_like_bodies());
        match wanted {
            Some(friction) if !monitor.is_cancelled() => {
                self.add_sensitivities(tangent, &Turn { friction, ..*turn }, found, monitor)
            }
            _ => Ok(()),
        }
    }
}

/// Rejects derivatives of unlike bodies' forces if an effect adds displacements, which the derivatives do not include.
fn check_derivatives(scene: &Scene<'_>, tangent: Option<&Tangent>) -> Result<()> {
    let wanted = scene.friction.is_some_and(|friction| friction.sensitivities)
        && tangent.is_some_and(|tangent| !tangent.is_of_like_bodies());
    let is_other = |name: &&str| wanted && *name != Friction::NAME;
    match effects::beside(scene).find(is_other) {
        Some(name) => Err(Error::Unsupported(format!(
            "friction->sensitivities are asked for of unlike bodies, and {name} is given; this version does not solve them together"
        ))),
        None => Ok(()),
    }
}
