//! The problems that a scene has besides the normal one: friction, and effects that are coupled with the normal problem.

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
    /// Refuses a step that continues an earlier one if this solver holds none.
    pub(super) fn check_continues(&self, scene: &Scene<'_>) -> Result<()> {
        for (k, name, Continues { from, .. }) in effects::continuing(scene) {
            let has_step = match name {
                // The step before may be one of `solve_tangential`, which makes no result of the normal problem. So `has_result` is not asked.
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

    /// Solves the coupled problems of a scene, after the normal problem ended with `outcome`, and keeps their state for a next step. Returns the
    /// outcome of all problems and the report of friction.
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

    /// Solves the coupled problems, in turns with the normal one if needed, and computes the requested derivatives of friction. After an error the
    /// last tractions are restored.
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
        // For unlike bodies the derivatives are computed after the turns, not in each of them.
        let is_unlike = tangent.as_deref().is_some_and(|tangent| !tangent.is_of_like_bodies());
        let in_turns =
            scene.friction.map(|friction| Friction { sensitivities: friction.sensitivities && !is_unlike, ..friction });
        let friction = tangent.zip(in_turns.as_ref()).map(|(tangent, friction)| {
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

    /// Computes the derivatives of the tangential forces of unlike bodies, if they are requested.
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

/// Refuses derivatives of the forces of unlike bodies if the scene has another coupled effect: the derivatives do not include its displacements.
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
