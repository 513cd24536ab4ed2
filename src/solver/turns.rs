//! The problems coupled with the normal one. Problems that displace the undeformed distance are solved in turns with it. The others are
//! solved once, with its pressures.

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

/// Most turns. For unlike bodies each turn reduces the change of the distance by a factor of 4 to 30.
const MOST_TURNS: u32 = 50;

/// The problems coupled with a normal one.
pub struct Turns<'a> {
    /// The tangential problem.
    pub friction: Option<TangentialTurn<'a>>,
    /// The problems of other effects.
    pub others: Vec<Box<dyn Coupled + 'a>>,
    /// The displacements by all problems.
    pub distances: &'a mut Distances,
}

impl<'a> Turns<'a> {
    /// All coupled problems.
    pub fn all(&mut self) -> impl Iterator<Item = &mut (dyn Coupled + 'a)> {
        let friction = self.friction.iter_mut().map(|friction| friction as &mut (dyn Coupled + 'a));
        self.others.iter_mut().map(|coupled| &mut **coupled).chain(friction)
    }

    /// The problems that displace the distance, or those that do not.
    fn that(&mut self, displace: bool) -> impl Iterator<Item = &mut (dyn Coupled + 'a)> {
        self.all().filter(move |coupled| coupled.displaces() == displace)
    }

    /// Whether any problem displaces the distance, so that turns are needed.
    pub fn displace(&mut self) -> bool {
        self.that(true).next().is_some()
    }

    /// Solves the problems that displace, or those that do not, with the pressures of a normal problem that ended with `outcome`. Returns the worst
    /// outcome.
    pub(super) fn solve(
        &mut self,
        displace: bool,
        outcome: Outcome,
        state: &State,
        monitor: &mut Monitor<'_>,
    ) -> Result<Outcome> {
        self.that(displace)
            .try_fold(outcome, |so_far, coupled| Ok(worse(so_far, coupled.solve(outcome, state, monitor)?)))
    }

    /// The undeformed distance with all displacements, and its change where pressures act (in C and at a limit), as rms relative to
    /// `h - approach`. None: no change on the whole grid.
    pub(super) fn distance(&mut self, state: &State) -> (&[f64], Option<f64>) {
        let mut displaced = std::mem::take(&mut self.distances.displaced);
        displaced.copy_from_slice(&self.distances.undisplaced);
        self.that(true).for_each(|coupled| coupled.displace(&mut displaced));
        let (mut changes, mut distances, mut differs) = (0.0, 0.0, false);
        for (i, displaced) in displaced.iter().enumerate() {
            // A single loaded element displaces others but not itself, so h may differ outside C only.
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

/// The solve of a scene in turns.
pub(super) struct InTurns<'s, 't, 'm> {
    pub(super) solver: &'s mut Solver,
    pub(super) turns: &'s mut Turns<'t>,
    pub(super) scene: &'s Scene<'s>,
    pub(super) options: &'s Options,
    pub(super) monitor: &'s mut Monitor<'m>,
    /// Cycles of the normal problem in all turns, without those of its first solve.
    cycles: usize,
}

impl<'s, 't, 'm> InTurns<'s, 't, 'm> {
    /// The turns of a scene whose normal problem is solved.
    pub(super) fn new(
        solver: &'s mut Solver,
        turns: &'s mut Turns<'t>,
        (scene, options): (&'s Scene<'s>, &'s Options),
        monitor: &'s mut Monitor<'m>,
    ) -> InTurns<'s, 't, 'm> {
        InTurns { solver, turns, scene, options, monitor, cycles: 0 }
    }

    /// Solves all problems that displace the undeformed distance in turns with the normal one, until the certificate of the normal problem holds
    /// with the last displacements (Panagiotopoulos 1975). Then solves the problems that displace nothing. The normal problem ended with `outcome`.
    pub(super) fn solve(mut self, outcome: Outcome) -> Result<Outcome> {
        if self.options.initial_guess != InitialGuess::Previous {
            // Each turn starts from the one before, not from earlier solves.
            self.solver.methods.projected_cg.forget_solutions();
        }
        let outcome = match self.turns.displace() {
            true => self.meet(outcome)?,
            false => outcome,
        };
        let outcome = self.turns.solve(false, outcome, &self.solver.state, self.monitor)?;
        self.turns.all().try_for_each(|coupled| coupled.refuse())?;
        Ok(outcome)
    }

    /// The turns with the problems that displace.
    fn meet(&mut self, outcome: Outcome) -> Result<Outcome> {
        self.turns.distances.take(&self.solver.state.h)?;
        let outcome = self.turn_about(self.options, (outcome, true))?;
        self.meet_by_creepages(outcome)
    }

    /// One series of turns, by force or with held creepages. The normal problem ended with `outcome`; `is_met` tells whether it was solved with the
    /// distances of the state.
    pub(super) fn turn_about(&mut self, options: &Options, (mut outcome, is_met): (Outcome, bool)) -> Result<Outcome> {
        let again = Options { initial_guess: InitialGuess::Previous, error_ratio: 0.0, ..*options };
        let mut extrapolation = Extrapolation::default();
        for solved in 0..=MOST_TURNS {
            let InTurns { solver, turns, .. } = self;
            let so_far = turns.solve(true, outcome, &solver.state, self.monitor)?;
            let (distance, change) = turns.distance(&solver.state);
            // Without a change the normal problem stays solved.
            let Some(change) = change.or((solved == 0 && !is_met).then_some(0.0)) else { return Ok(so_far) };
            extrapolation.turn(&solver.state.h, distance)?;
            let holds = solver.holds_with((distance, change), (self.scene, options), self.monitor);
            if holds || so_far != Outcome::Converged {
                return Ok(so_far);
            }
            if solved == MOST_TURNS {
                break;
            }
            // The caller's limit bounds the cycles of the first solve, and again those of all turns together.
            let left = options.max_cycles.saturating_sub(self.cycles);
            if left == 0 || !turns.that(true).all(|coupled| coupled.has_work_left()) {
                return Ok(Outcome::IterationLimit);
            }
            extrapolation.extrapolate(&mut turns.distances.displaced);
            outcome = self.solve_displaced(&Options { max_cycles: left, ..again })?;
        }
        log::info!("the normal problem and what displaces its distance do not agree after {MOST_TURNS} turns");
        Ok(Outcome::Stagnated)
    }

    /// Solves the normal problem again with the displaced distance.
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
    /// Makes and reports the certificate of the normal problem with the last distance, which changed by `change`. Returns whether it holds.
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

/// The worse outcome of two solves.
fn worse(one: Outcome, other: Outcome) -> Outcome {
    if one == Outcome::Converged {
        other
    } else {
        one
    }
}
