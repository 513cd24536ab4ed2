//! Forces on unlike bodies. If turns by force do not converge, or their last pressures cannot carry the force, turns with held creepages follow.
//!
//! With a held creepage the turns of tractions and pressures converge quickly, also near full slip. The resulting forces are compared with the
//! given ones. The next creepage is that of a secant (Broyden 1965); with one force it lies between two creepages known to carry too much and too
//! little.
//!
//! *Forces beyond full slip.* Near full slip the largest force may lie at a finite creepage, as pressures change with the creepage, and with them
//! the force that they carry. So creepages about those of turns by force are tried until one reaches the force, and then creepages near the largest
//! force found (module [`creepage_peak`](super::creepage_peak)). A force that none reaches is refused.

use super::creepage_peak::Peak;
use super::creepage_trials::{Place, Trials};
use super::tangential_turn::{sharper, TangentialTurn, ROUND_OFF};
use super::turns::InTurns;
use crate::contact::Survey;
use crate::effects::Coefficient;
use crate::error::Result;
use crate::friction::{dot, length, Vector, FINISHING_PRODUCTS};
use crate::progress::Outcome;
use crate::scene::{Load, Scene};

/// If forces miss less than CLOSE_FORCES times mu N, tractions by force are tried with the same pressures, with
/// [`FINISHING_PRODUCTS`] products.
const CLOSE_FORCES: f64 = 1e-4;
/// Most creepages tried between those that bracket the force.
const MOST_TRIALS: u32 = 30;
/// Creepages that are tried, relative to those of turns by force. With two forces, those from OPPOSITE_FROM on are
/// opposite to the force.
const TRIED_RATIOS: [f64; 14] = [1.0, 1.3, 2.0, 4.0, 16.0, 64.0, 256.0, 1e3, 1e4, FAR, 0.75, 0.5, 0.25, 0.1];
const OPPOSITE_FROM: f64 = 64.0;
/// If turns by force miss more than this part of mu N, only the creepage FAR is tried: before full slip pressures carry at most some hundredths more
/// (0.9 % on a flat punch of mu = 1 or 2 on a rigid body).
const BEYOND_REACH: f64 = 3e-2;
const FAR: f64 = 1e6;
/// Largest creepage times the length rolled, over the displacement of full slip. All elements slip long before. A solve refuses 1e30 times that
/// displacement, and the pressures of a turn change it by less than the factor between.
const FARTHEST: f64 = 1e20;

/// The directions of given forces.
fn given(scene: &Scene<'_>) -> [bool; 2] {
    scene.friction.map_or([false; 2], |friction| friction.has_forces())
}

impl InTurns<'_, '_, '_> {
    /// Continues turns by force, which ended with `outcome`, by turns with creepages if needed.
    pub(super) fn meet_by_creepages(&mut self, outcome: Outcome) -> Result<Outcome> {
        let tried = |friction: &&mut TangentialTurn<'_>| {
            friction.is_near() || outcome == Outcome::Stagnated && friction.by_force
        };
        let Some(friction) = self.turns.friction.as_mut().filter(tried) else { return Ok(outcome) };
        let is_refused = friction.is_refused();
        if outcome == Outcome::Cancelled
            || outcome == Outcome::Converged && !is_refused
            || is_refused && carries_always(self.scene)
        {
            return Ok(outcome);
        }
        let Some(from) = place(friction) else { return Ok(outcome) };
        let normal = self.monitor.survey.as_ref().map_or(f64::INFINITY, Survey::relative_residual);
        let is_done = outcome == Outcome::IterationLimit || normal < ROUND_OFF;
        if outcome != Outcome::Converged && friction.is_at_round_off() && is_done {
            return Ok(outcome);
        }
        friction.by_force = false;
        if outcome == Outcome::Converged && from.missing() <= self.options.tolerance {
            friction.accept(from.missing());
            return Ok(outcome);
        }
        log::info!("turns by force leave {:e} of mu N, turns with creepages go on", from.missing());
        let mut refusal = friction.take_refusal();
        let is_beyond = refusal.is_some() && from.missing() > BEYOND_REACH;
        let parts = if is_beyond { &[FAR] } else { &TRIED_RATIOS[..] };
        let mut peak = Peak::default();
        let (from, mut end) = self.look_about(from, parts, &mut peak)?;
        if let (Some(from), Outcome::Converged) = (from, end) {
            refusal = None;
            end = self.bracket(from)?;
        } else if end == Outcome::Converged && refusal.is_none() {
            end = Outcome::Stagnated;
        }
        if let Some(friction) = &mut self.turns.friction {
            if end == Outcome::Converged {
                friction.refuse_by(refusal.map(|refusal| friction.with_largest(refusal, peak.largest())));
            }
            friction.held = None;
        }
        Ok(end)
    }

    /// A place that reaches the force, among creepages about those of turns by force; none if there is none, or if the search does not converge.
    fn look_about(&mut self, from: Place, parts: &[f64], peak: &mut Peak) -> Result<(Option<Place>, Outcome)> {
        let given = given(self.scene);
        let wanted = self.turns.friction.as_ref().map_or([0.0; 2], TangentialTurn::wanted);
        let along = [0, 1].map(|k| if given[k] { from.creepage[k] } else { 0.0 });
        // For a creepage of 0 all parts are equal.
        let parts = if length(along) > 0.0 { parts } else { &parts[..1] };
        let (has_peak, mut parts) = (parts.len() > 1 && given != [true; 2], parts.iter().copied());
        while let Some(part) = parts.next().or_else(|| if has_peak { peak.next() } else { None }) {
            // Far away both forces are opposite to the creepages.
            let is_far = part >= OPPOSITE_FROM && given == [true; 2] && length(wanted) > 0.0;
            let against = wanted.map(|force| -force / length(wanted) * length(along));
            let held = if is_far { against } else { along }.map(|c| part * c);
            let end = self.turns_with(held)?;
            if end != Outcome::Converged && end != Outcome::Stagnated {
                return Ok((None, end));
            }
            // The force is reached or exceeded.
            let reaches = |at: &Place| at.missing() <= self.options.tolerance || dot(at.excess, wanted) >= 0.0;
            let found = self.turns.friction.as_ref().and_then(place).filter(|_| end == Outcome::Converged);
            if let Some(place) = found.filter(reaches) {
                return Ok((Some(place), end));
            }
            peak.add(part, found.map_or(f64::NEG_INFINITY, |place| dot(place.excess, wanted) / length(wanted)));
        }
        Ok((None, Outcome::Converged))
    }

    /// Finds the creepages that carry the force, from a place that reaches it.
    fn bracket(&mut self, from: Place) -> Result<Outcome> {
        let scale = self.turns.friction.as_ref().map_or(0.0, TangentialTurn::largest_slip);
        let (mut found, mut trials) = (from, Trials::new(from, given(self.scene), scale));
        for _ in 0..MOST_TRIALS {
            if found.missing() <= self.options.tolerance {
                return Ok(Outcome::Converged);
            }
            if found.missing() < CLOSE_FORCES && self.finish()? {
                return Ok(Outcome::Converged);
            }
            let next = trials.next(found);
            log::info!("creepages {:?} leave {:e} of mu N", found.creepage, found.missing());
            if next == found.creepage {
                break;
            }
            let end = self.turns_with(next)?;
            if end != Outcome::Converged {
                return Ok(end);
            }
            found = match self.turns.friction.as_ref().and_then(place) {
                Some(found) => found,
                None => break,
            };
        }
        // A solve that does not converge returns the best.
        let best = trials.best();
        if found.missing() > best.missing() {
            self.turns_with(best.creepage)?;
        }
        Ok(Outcome::Stagnated)
    }

    /// Turns with held creepages. Creepages that are too large find nothing and are not refused, as the caller did not give them.
    fn turns_with(&mut self, creepage: Vector) -> Result<Outcome> {
        let Some(friction) = &mut self.turns.friction else { return Ok(Outcome::Stagnated) };
        if !(length(creepage) <= FARTHEST * friction.full_displacement()) {
            return Ok(Outcome::Stagnated);
        }
        friction.held = Some(creepage);
        self.turn_about(&sharper(self.options), (Outcome::Converged, false))
    }

    /// Solves for tractions by force with the last pressures. Returns whether both problems are then solved.
    fn finish(&mut self) -> Result<bool> {
        let InTurns { solver, turns, monitor, .. } = self;
        if let Some(friction) = &mut turns.friction {
            (friction.held, friction.most) = (None, FINISHING_PRODUCTS as usize);
        }
        let end = turns.solve(true, Outcome::Converged, &solver.state, monitor)?;
        let (distance, change) = turns.distance(&solver.state);
        let holds = solver.holds_with((distance, change.unwrap_or(0.0)), (self.scene, self.options), monitor);
        let is_refused = turns.friction.as_mut().is_some_and(|friction| {
            friction.most = usize::MAX;
            friction.take_refusal().is_some()
        });
        Ok(end == Outcome::Converged && !is_refused && holds)
    }
}

/// Whether all pressures carry the same tangential force.
fn carries_always(scene: &Scene<'_>) -> bool {
    let is_uniform = |friction: &crate::scene::Friction<'_>| {
        matches!(friction.coefficient, Coefficient::Uniform(_))
            && friction.layer.is_none()
            && friction.weights.is_none()
    };
    matches!(scene.load, Load::Force(_)) && scene.friction.as_ref().is_some_and(is_uniform)
}

/// The place of the last solve.
fn place(friction: &TangentialTurn<'_>) -> Option<Place> {
    let carried = friction.found.as_ref()?.carried;
    let (excess, creepage) = friction.excess()?;
    (carried > 0.0).then(|| Place { creepage, excess: excess.map(|excess| excess / carried) })
}
