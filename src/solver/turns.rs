//! The problems coupled with the normal problem. Those that displace the undeformed distance are solved in turns with the normal problem. The others
//! are solved once, with the pressures of the normal problem.

use super::beside::Distances;
use super::extrapolation::Extrapolation;
use super::take_over::take_distance;
use super::tangential_turn::TangentialTurn;
use super::{Asked, InitialGuess, Options, Solver};
use crate::contact::{lowest, Fixed, NonNegative, State, Survey};
use crate::effects::{self, Coupled};
use crate::error::Result;
use crate::progress::{Monitor, Outcome};
use crate::scene::Scene;

/// Most turns of one series. For unlike bodies the change of the distance decreases by a factor of 4 to 30 in each turn.
const MOST_TURNS: u32 = 50;

/// The problems coupled with a normal problem.
pub struct Turns<'a> {
    /// The tangential problem, if the scene has friction.
    pub friction: Option<TangentialTurn<'a>>,
    /// The problems of other effects.
    pub others: Vec<Box<dyn Coupled + 'a>>,
    /// The undeformed distance without and with the displacements by these problems.
    pub distances: &'a mut Distances,
}

impl<'a> Turns<'a> {
    /// All coupled problems.
    pub fn all(&mut self) -> impl Iterator<Item = &mut (dyn Coupled + 'a)> {
        let friction = self.friction.iter_mut().map(|friction| friction as &mut (dyn Coupled + 'a));
        self.others.iter_mut().map(|coupled| &mut **coupled).chain(friction)
    }

    /// The problems that displace the undeformed distance (`displace`), or those that do not.
    fn those(&mut self, displace: bool) -> impl Iterator<Item = &mut (dyn Coupled + 'a)> {
        self.all().filter(move |coupled| coupled.displaces() == displace)
    }

    /// Whether any problem displaces the undeformed distance, so that turns are needed.
    pub fn any_displaces(&mut self) -> bool {
        self.those(true).next().is_some()
    }

    /// Solves the problems that displace the undeformed distance (`displace`), or those that do not. `state` has the pressures of the normal problem,
    /// which ended with `outcome`. Returns `outcome`, or that of the first coupled problem that did not converge.
    pub(super) fn solve(
        &mut self,
        displace: bool,
        outcome: Outcome,
        state: &State,
        monitor: &mut Monitor<'_>,
    ) -> Result<Outcome> {
        self.those(displace)
            .try_fold(outcome, |so_far, coupled| Ok(first_failure(so_far, coupled.solve(outcome, state, monitor)?)))
    }

    /// Computes the undeformed distance plus the displacements by all coupled problems. Also returns its change from the distance in `state`: the rms
    /// over the elements in contact, relative to the rms of `h - approach` there. None: the distance does not change anywhere.
    pub(super) fn distance(&mut self, state: &State) -> (&[f64], Option<f64>) {
        let mut displaced = std::mem::take(&mut self.distances.displaced);
        displaced.copy_from_slice(&self.distances.undisplaced);
        self.those(true).for_each(|coupled| coupled.displace(&mut displaced));
        let (mut changes, mut distances, mut differs) = (0.0, 0.0, false);
        for (i, displaced) in displaced.iter().enumerate() {
            // The change may be 0 in contact and not elsewhere: the tractions of a single element displace other elements, but not itself.
            differs |= *displaced != state.h[i];
            if state.touches(i) {
                changes += (displaced - state.h[i]).powi(2);
                distances += (state.h[i] - state.approach).powi(2);
            }
        }
        let change = if changes == 0.0 { 0.0 } else { (changes / distances).sqrt() };
        self.distances.displaced = displaced;
        (&self.distances.displaced, differs.then_some(change))
    }
}

/// The solve of a scene with coupled problems.
pub(super) struct InTurns<'s, 't, 'm> {
    pub(super) solver: &'s mut Solver,
    pub(super) turns: &'s mut Turns<'t>,
    pub(super) scene: &'s Scene<'s>,
    pub(super) options: &'s Options,
    pub(super) monitor: &'s mut Monitor<'m>,
    /// Cycles of the normal problem in all turns; those of its solve before the first turn do not count.
    cycles: usize,
}

impl<'s, 't, 'm> InTurns<'s, 't, 'm> {
    /// The coupled problems of a scene whose normal problem is solved once.
    pub(super) fn new(
        solver: &'s mut Solver,
        turns: &'s mut Turns<'t>,
        (scene, options): (&'s Scene<'s>, &'s Options),
        monitor: &'s mut Monitor<'m>,
    ) -> InTurns<'s, 't, 'm> {
        InTurns { solver, turns, scene, options, monitor, cycles: 0 }
    }

    /// Solves the problems that displace the undeformed distance in turns with the normal problem (Panagiotopoulos 1975), until the certificate of
    /// the normal problem holds with the last displacements. Then solves the other problems. The normal problem ended with `outcome`.
    pub(super) fn solve(mut self, outcome: Outcome) -> Result<Outcome> {
        if self.options.initial_guess != InitialGuess::Previous {
            // Each turn starts from the turn before. Solutions of earlier solves must not affect the bits.
            self.solver.methods.projected_cg.forget_solutions();
        }
        let outcome = match self.turns.any_displaces() {
            true => self.solve_in_turns(outcome)?,
            false => outcome,
        };
        let outcome = self.turns.solve(false, outcome, &self.solver.state, self.monitor)?;
        self.turns.all().try_for_each(|coupled| coupled.refuse())?;
        Ok(outcome)
    }

    /// Makes turns with the problems that displace the undeformed distance: first by force, then with held creepages if needed.
    fn solve_in_turns(&mut self, outcome: Outcome) -> Result<Outcome> {
        self.turns.distances.take(&self.solver.state.h)?;
        let outcome = self.turn_about(self.options, (outcome, true))?;
        self.meet_by_creepages(outcome)
    }

    /// Makes one series of turns, by force or with held creepages. The normal problem ended with `outcome`. `is_met` tells whether it was solved with
    /// the distance in the state; if not, its certificate is checked even if the distance does not change.
    pub(super) fn turn_about(&mut self, options: &Options, (mut outcome, is_met): (Outcome, bool)) -> Result<Outcome> {
        let again = Options { initial_guess: InitialGuess::Previous, error_ratio: 0.0, ..*options };
        let mut extrapolation = Extrapolation::default();
        for solved in 0..=MOST_TURNS {
            let InTurns { solver, turns, .. } = self;
            let so_far = turns.solve(true, outcome, &solver.state, self.monitor)?;
            let (distance, change) = turns.distance(&solver.state);
            // If the distance does not change, the certificate of the normal problem still holds.
            let Some(change) = change.or((solved == 0 && !is_met).then_some(0.0)) else { return Ok(so_far) };
            extrapolation.turn(&solver.state.h, distance)?;
            let holds = solver.holds_with((distance, change), (self.scene, options), self.monitor);
            if holds || so_far != Outcome::Converged {
                return Ok(so_far);
            }
            if solved == MOST_TURNS {
                break;
            }
            // `max_cycles` bounds the cycles of the first solve, and once more those of all turns together.
            let left = options.max_cycles.saturating_sub(self.cycles);
            if left == 0 || !turns.those(true).all(|coupled| coupled.has_work_left()) {
                return Ok(Outcome::IterationLimit);
            }
            extrapolation.extrapolate(&mut turns.distances.displaced);
            outcome = self.solve_displaced(&Options { max_cycles: left, ..again })?;
        }
        log::info!("the normal problem and what displaces its distance do not agree after {MOST_TURNS} turns");
        Ok(Outcome::Stagnated)
    }

    /// Solves the normal problem again, with the displaced distance.
    fn solve_displaced(&mut self, options: &Options) -> Result<Outcome> {
        let InTurns { solver, monitor, .. } = self;
        monitor.ledger.rows.pop();
        monitor.enter_grid();
        let distance = &self.turns.distances.displaced[..];
        let scene = &Scene { undeformed_distance: distance, ..self.scene.clone() };
        let asked = Asked::new((scene, lowest(distance)), options);
        let (outcome, _) = solver.solve_normal(asked, monitor)?;
        let outcome = solver.meet_compressed(asked, monitor, outcome)?;
        self.cycles += monitor.count.cycles as usize;
        Ok(outcome)
    }
}

impl Solver {
    /// Surveys the last pressures with another distance, which differs by the relative `change`, and replaces the last row of the ledger. Returns
    /// whether the criterion holds.
    pub(super) fn holds_with(
        &mut self,
        (distance, change): (&[f64], f64),
        (scene, options): (&Scene<'_>, &Options),
        monitor: &mut Monitor<'_>,
    ) -> bool {
        let Solver { problem, state, .. } = self;
        take_distance(state, distance, &problem.threads);
        state.fit_approach(&problem.threads);
        let survey = Survey::by(state, &problem.threads);
        let goal = options.goal();
        let by = self.compression(scene.load);
        let holds = match effects::limits(scene) {
            _ if by != 0.0 => self.holds_compressed(by, options).0,
            _ if options.is_fixed() => goal.holds(&survey, 0.0, Fixed),
            None => goal.holds(&survey, 0.0, NonNegative),
            Some(limit) => goal.holds(&survey, 0.0, limit),
        };
        monitor.ledger.rows.pop();
        monitor.survey = Some(survey);
        monitor.close_grid(&self.state);
        holds && (!goal.by_update() || change <= goal.tolerance)
    }
}

/// The first outcome that is not Converged.
fn first_failure(one: Outcome, other: Outcome) -> Outcome {
    if one == Outcome::Converged {
        other
    } else {
        one
    }
}
