//! Given tangential forces on unlike bodies, found by prescribed creepages.
//!
//! A turn solves the tangential problem with the last pressures, then the normal problem with the displacements by the tractions. At first the
//! tangential problems of the turns have the given forces (turns by force). If these turns do not converge, or if the last pressures cannot carry
//! the forces, turns with prescribed creepages follow (held creepages).
//!
//! With held creepages turns converge quickly, also near full slip. The resulting forces are compared with the given ones. The next creepages are
//! those of a secant method (Broyden 1965). With one given force, the next creepage also lies between two known ones, of which one carries too much
//! and the other too little.
//!
//! *Forces near full slip.* Pressures change with the creepage, and so does the largest tangential force that they carry. Therefore the largest
//! force may belong to a finite creepage. The search tries creepages around those of the turns by force until one reaches the given force, and then
//! creepages near the largest force found (module [`creepage_peak`](super::creepage_peak)). If none reaches the given force, the scene is refused.

use super::creepage_peak::Peak;
use super::creepage_trials::{Trial, Trials};
use super::tangential_turn::{sharper, TangentialTurn, ROUND_OFF};
use super::turns::InTurns;
use crate::contact::Survey;
use crate::effects::Coefficient;
use crate::error::Result;
use crate::friction::{dot, length, Vector, FINISHING_PRODUCTS};
use crate::progress::Outcome;
use crate::scene::{Load, Scene};

/// If the forces of held creepages differ from the given ones by less than this times mu N, one tangential problem with the given forces is tried. It
/// has the last pressures, and [`FINISHING_PRODUCTS`] products.
const CLOSE_FORCES: f64 = 1e-4;
/// Most creepages that are tried after the first one that reaches the force.
const MOST_TRIALS: u32 = 30;
/// Creepages of the search for one that reaches the force, relative to those of the turns by force.
const TRIED_RATIOS: [f64; 14] = [1.0, 1.3, 2.0, 4.0, 16.0, 64.0, 256.0, 1e3, 1e4, FAR, 0.75, 0.5, 0.25, 0.1];
/// If both forces are given, creepages of this ratio and more are opposite to the given force, as in full slip.
const OPPOSITE_FROM: f64 = 64.0;
/// If the pressures of the turns by force carry too little by more than this part of mu N, only the ratio FAR is tried. At smaller creepages
/// pressures carry at most a few per cent more than in full slip (0.9 % for a flat punch on a rigid body with mu = 1 or 2).
const BEYOND_REACH: f64 = 3e-2;
/// The ratio at which all elements slip.
const FAR: f64 = 1e6;
/// The largest held creepage times the length rolled, relative to the displacement by the tractions of full slip. All elements slip at much smaller
/// creepages. A tangential solve refuses slips above 1e30 times that displacement; the factor 1e10 between the two limits exceeds the change of the
/// displacement by the pressures of a turn.
const FARTHEST: f64 = 1e20;

/// Whether the force is given, in x and in y.
fn given(scene: &Scene<'_>) -> [bool; 2] {
    scene.friction.map_or([false; 2], |friction| friction.has_forces())
}

impl InTurns<'_, '_, '_> {
    /// Continues turns by force, which ended with `outcome`, by turns with held creepages if those are needed. Returns the outcome of all turns.
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
        let Some(from) = last_trial(friction) else { return Ok(outcome) };
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
        let ratios = if is_beyond { &[FAR] } else { &TRIED_RATIOS[..] };
        let mut peak = Peak::default();
        let (from, mut end) = self.search_around(from, ratios, &mut peak)?;
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

    /// Searches for creepages that reach the force: first `ratios` times those of `from`, the last trial of the turns by force, then those that
    /// `peak` proposes. Returns None if no trial reaches the force, or if the turns of one end by a limit or by the callback.
    fn search_around(&mut self, from: Trial, ratios: &[f64], peak: &mut Peak) -> Result<(Option<Trial>, Outcome)> {
        let given = given(self.scene);
        let wanted = self.turns.friction.as_ref().map_or([0.0; 2], TangentialTurn::wanted);
        let along = [0, 1].map(|k| if given[k] { from.creepage[k] } else { 0.0 });
        // All multiples of a creepage of 0 are equal.
        let ratios = if length(along) > 0.0 { ratios } else { &ratios[..1] };
        let (has_peak, mut ratios) = (ratios.len() > 1 && given != [true; 2], ratios.iter().copied());
        while let Some(ratio) = ratios.next().or_else(|| if has_peak { peak.next() } else { None }) {
            // Near full slip the force is opposite to the creepages.
            let is_far = ratio >= OPPOSITE_FROM && given == [true; 2] && length(wanted) > 0.0;
            let against = wanted.map(|force| -force / length(wanted) * length(along));
            let held = if is_far { against } else { along }.map(|c| ratio * c);
            let end = self.turns_with(held)?;
            if end != Outcome::Converged && end != Outcome::Stagnated {
                return Ok((None, end));
            }
            // Whether the forces of a trial are the given ones, or exceed them.
            let reaches = |trial: &Trial| trial.missing() <= self.options.tolerance || dot(trial.excess, wanted) >= 0.0;
            let found = self.turns.friction.as_ref().and_then(last_trial).filter(|_| end == Outcome::Converged);
            if let Some(trial) = found.filter(reaches) {
                return Ok((Some(trial), end));
            }
            peak.add(ratio, found.map_or(f64::NEG_INFINITY, |trial| dot(trial.excess, wanted) / length(wanted)));
        }
        Ok((None, Outcome::Converged))
    }

    /// Finds the creepages whose forces are the given ones, from a trial that reaches them. Stagnated: the creepages with the least missing force are
    /// solved last.
    fn bracket(&mut self, from: Trial) -> Result<Outcome> {
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
            found = match self.turns.friction.as_ref().and_then(last_trial) {
                Some(found) => found,
                None => break,
            };
        }
        // Without convergence the result is the best trial, which is solved again.
        let best = trials.best();
        if found.missing() > best.missing() {
            self.turns_with(best.creepage)?;
        }
        Ok(Outcome::Stagnated)
    }

    /// Makes turns with held creepages. Creepages above [`FARTHEST`] end as Stagnated. They are no error of the caller, who did not give them.
    fn turns_with(&mut self, creepage: Vector) -> Result<Outcome> {
        let Some(friction) = &mut self.turns.friction else { return Ok(Outcome::Stagnated) };
        if !(length(creepage) <= FARTHEST * friction.full_displacement()) {
            return Ok(Outcome::Stagnated);
        }
        friction.held = Some(creepage);
        self.turn_about(&sharper(self.options), (Outcome::Converged, false))
    }

    /// Solves the tangential problem once with the given forces and the last pressures. Returns whether this solves the tangential and the normal
    /// problem.
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

/// Whether the largest tangential force does not depend on the pressures: it is mu N, with N and mu given.
fn carries_always(scene: &Scene<'_>) -> bool {
    let is_uniform = |friction: &crate::scene::Friction<'_>| {
        matches!(friction.coefficient, Coefficient::Uniform(_))
            && friction.layer.is_none()
            && friction.weights.is_none()
    };
    matches!(scene.load, Load::Force(_)) && scene.friction.as_ref().is_some_and(is_uniform)
}

/// The creepages and the excess of the forces of the last solve; None if nothing is carried.
fn last_trial(friction: &TangentialTurn<'_>) -> Option<Trial> {
    let carried = friction.found.as_ref()?.carried;
    let (excess, creepage) = friction.excess()?;
    (carried > 0.0).then(|| Trial { creepage, excess: excess.map(|excess| excess / carried) })
}
