//! The methods of a solver. A list gives their order ([`stages`](super::stages)): when one makes no progress, or has used its share of cycles, the
//! next one continues. Also their starts without a guess.

use super::best::Best;
use super::estimates;
use super::iterate::iterate;
use super::nested::FullMultigrid;
use super::options::Options;
use super::stages::{share, Stage};
use super::take_over::{has_lost_limits, put_at_limits};
use crate::contact::{admit, AdmissibleSet, Freshness, Problem, State, Survey, UNDECIDED_SHARE};
use crate::error::{Error, Result};
use crate::methods::direct::Direct;
use crate::methods::multigrid::CycleShape;
use crate::methods::norm::Norm;
use crate::methods::projected_cg::ProjectedCg;
use crate::methods::projected_newton::ProjectedNewton;
use crate::methods::{Start, Step, Task};
use crate::progress::{Outcome, UPDATE_RESIDUAL};
use crate::scene::Load;

/// Relative violation of a guess above which a start from the coarser grids is better.
const LARGEST_USEFUL: f64 = 0.3;
/// Displacements below this part of the approach are round-off of `h - approach`. No step of a method improves such a start, so it is accepted as the
/// solution if its certificate holds.
const HIDDEN_DISPLACEMENT: f64 = 8.0 * f64::EPSILON;

/// The methods of a solver, with their memory, which is kept from solve to solve.
pub struct Methods {
    pub projected_cg: ProjectedCg,
    /// The direct solve, for coefficients that have one.
    direct: Option<Direct>,
    /// The grids of the multigrid methods, set up at their first use.
    multigrid: Option<FullMultigrid>,
    projected_newton: ProjectedNewton,
    norm: Norm,
    /// The best iterate of all methods of a solve.
    pub best: Best,
    /// Smoother and sweeps of the V-cycle.
    shape: CycleShape,
}

/// What a solve does with its start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Beginning {
    /// The start satisfies the goal.
    Solved,
    /// The first method iterates from the start.
    GoOn,
    /// The start is discarded.
    FromNothing,
}

impl Methods {
    /// Creates all methods except multigrid, which is set up at its first use.
    pub fn new(problem: &Problem, options: &Options) -> Result<Methods> {
        Ok(Methods {
            projected_cg: ProjectedCg::new(problem, options.precision),
            direct: Direct::new(&problem.coefficients, &problem.grid)?,
            multigrid: None,
            projected_newton: ProjectedNewton::default(),
            norm: Norm::default(),
            best: Best::default(),
            shape: options.cycle,
        })
    }

    /// Solves by the methods `stages`. The state is the start: `from` tells where it comes from, and `survey` is its survey unless it is p = 0. With
    /// a positive `error_ratio` the tolerance of the goal may increase (see [`Options::error_ratio`]).
    pub fn solve<S: AdmissibleSet>(
        &mut self,
        task: &mut Task<'_, '_, S>,
        (from, survey): (Start, Option<Survey>),
        stages: &[Stage],
        error_ratio: f64,
    ) -> Result<Outcome> {
        self.best.forget();
        self.projected_cg.begin_anew();
        let has_direct = self.direct.is_some();
        let (mut outcome, most) = (Outcome::Stagnated, task.goal.max_cycles);
        for (i, &stage) in stages.iter().filter(|stage| **stage != Stage::Direct || has_direct).enumerate() {
            if i > 0 {
                self.hand_over(stage, task)?;
            } else {
                let mut beginning = self.take_over(stage, task, (from, survey))?;
                if beginning == Beginning::FromNothing {
                    beginning = self.start(stage, task, from, error_ratio)?;
                }
                if beginning == Beginning::Solved {
                    return Ok(Outcome::Converged);
                }
            }
            let mut cycles = None;
            let method: &mut dyn Step<S> = match stage {
                Stage::Direct => match &mut self.direct {
                    Some(direct) => direct,
                    None => continue,
                },
                Stage::ProjectedCg => &mut self.projected_cg,
                Stage::VCycles | Stage::FullMultigrid => {
                    cycles.insert(set_up_multigrid(&mut self.multigrid, task.problem, self.shape)?.cycles(0))
                }
                Stage::ProjectedNewton => &mut self.projected_newton,
                Stage::Norm => &mut self.norm,
            };
            let is_last = Some(&stage) == stages.last();
            task.goal.max_cycles = if is_last { most } else { share::<S>(stage, task.monitor.count.cycles, most) };
            outcome = iterate(method, task, &mut self.best)?;
            let has_more = task.monitor.count.cycles < most && !is_last;
            task.goal.max_cycles = most;
            if outcome != Outcome::Stagnated && !(outcome == Outcome::IterationLimit && has_more) {
                break;
            }
        }
        match outcome {
            Outcome::Converged => Ok(outcome),
            _ => self.end_with_best(outcome, task),
        }
    }

    /// Ends a solve without convergence: restores the best iterate by a fresh product. If that satisfies the goal, the outcome is Converged.
    fn end_with_best<S: AdmissibleSet>(&mut self, outcome: Outcome, task: &mut Task<'_, '_, S>) -> Result<Outcome> {
        let indefinite =
            outcome == Outcome::Stagnated && task.problem.given && has_negative_energy(task.problem, task.state)?;
        let survey = self.best.restore(task)?;
        if indefinite {
            return Err(Error::NotPositiveDefinite(
                "influence coefficients: p'Ap is negative for some pressures p; it must be positive".into(),
            ));
        }
        let is_met = outcome != Outcome::Cancelled && !task.goal.by_update() && is_solved(task, survey);
        Ok(if is_met { Outcome::Converged } else { outcome })
    }

    /// Judges the start by its survey, and prepares it for the first method.
    fn take_over<S: AdmissibleSet>(
        &mut self,
        stage: Stage,
        task: &mut Task<'_, '_, S>,
        (from, survey): (Start, Option<Survey>),
    ) -> Result<Beginning> {
        let Some(survey) = survey else { return Ok(Beginning::FromNothing) };
        if !task.goal.by_update() && is_solved(task, survey) {
            return Ok(Beginning::Solved);
        }
        let (state, set) = (&mut *task.state, task.set);
        let violation = survey.violation(set);
        let on_coarser_grids = matches!(stage, Stage::Direct | Stage::ProjectedCg) && !S::FIXED;
        if on_coarser_grids && !(violation <= LARGEST_USEFUL) {
            admit(state, set);
            return Ok(Beginning::FromNothing);
        }
        // With limits pressures do not scale with the load, so they are not extrapolated from the last solutions.
        if on_coarser_grids && from == Start::Previous && !S::LIMITED {
            // This sets the contact area as well.
            self.projected_cg.predict(state, &task.problem.threads)?;
        } else if survey.violation > 0.0 {
            admit(state, set);
        }
        Ok(Beginning::GoOn)
    }

    /// Prepares the state for `stage`, which is not the first method. It starts from the best iterate, or from all elements at their limits if the best
    /// iterate has lost them. NORM starts anew if its violation exceeds [`LARGEST_USEFUL`]. PROJECTED_CG follows a direct solve, from its last state.
    fn hand_over<S: AdmissibleSet>(&mut self, stage: Stage, task: &mut Task<'_, '_, S>) -> Result<()> {
        if stage != Stage::ProjectedCg {
            log::info!("no further progress on this scene: {stage:?} takes over");
            self.best.restore(task)?;
            let worthless = !(task.survey().violation(task.set) <= LARGEST_USEFUL);
            if has_lost_limits(task.problem, task.state, task.set) {
                put_at_limits(task.problem, task.state, task.set)?;
                task.count_products();
            } else if worthless && stage == Stage::Norm && S::LIMITED {
                start_norm_at_limits(task);
            } else if worthless && stage == Stage::Norm && !S::FIXED {
                self.start(stage, task, Start::Nothing, 0.0)?;
            }
        }
        Ok(())
    }

    /// Makes a start without a guess for `stage`. For most methods this start has a discretisation error that can be estimated, so a positive
    /// `error_ratio` may increase the tolerance of the goal. Returns Solved if the start is the solution.
    fn start<S: AdmissibleSet>(
        &mut self,
        stage: Stage,
        task: &mut Task<'_, '_, S>,
        from: Start,
        error_ratio: f64,
    ) -> Result<Beginning> {
        let (self_influence, threads) = (task.problem.self_influence(), &task.problem.threads);
        match stage {
            Stage::Direct | Stage::ProjectedCg if !S::FIXED => {
                // The state holds a guess that was judged useless.
                if from != Start::Nothing {
                    task.state.unload();
                }
                match task.state.start_on_bearing_area(task.set, (self_influence, UNDECIDED_SHARE), threads) {
                    Some(most) if most <= HIDDEN_DISPLACEMENT * task.state.approach.abs() => {
                        task.problem.refresh(task.state, task.set)?;
                        task.count_products();
                        if is_solved(task, task.survey()) {
                            return Ok(Beginning::Solved);
                        }
                    }
                    Some(_) => {}
                    None => {
                        self.projected_cg.start(task)?;
                        if has_lost_limits(task.problem, task.state, task.set) {
                            put_at_limits(task.problem, task.state, task.set)?;
                            task.count_products();
                        }
                    }
                }
            }
            Stage::Norm if S::LIMITED && !S::FIXED && !task.problem.symmetric => start_norm_at_limits(task),
            Stage::FullMultigrid if !S::FIXED => {
                task.state.unload();
                let multigrid = set_up_multigrid(&mut self.multigrid, task.problem, self.shape)?;
                multigrid.start(task, &mut self.norm)?;
            }
            _ => {
                task.state.unload();
                task.state.start(self_influence);
            }
        }
        // The other methods start from p = 0, from which no error can be estimated.
        let is_near = matches!(stage, Stage::Direct | Stage::ProjectedCg | Stage::FullMultigrid);
        if error_ratio > 0.0 && is_near && !S::FIXED {
            let predicted = estimates::predict(task.problem, task.state);
            // A solution with a larger residual than UPDATE_RESIDUAL is useless, however coarse the grid.
            let enough = (error_ratio * predicted).min(UPDATE_RESIDUAL);
            task.goal.tolerance = task.goal.tolerance.max(enough);
        }
        Ok(Beginning::GoOn)
    }

    /// Drops all references to the operator, before it gets other coefficients. Call [`renew`](Self::renew) before the next solve.
    pub fn forget_operator(&mut self) {
        self.multigrid = None;
    }

    /// Sets up the methods for the new coefficients of `problem`.
    pub fn renew(&mut self, problem: &Problem) -> Result<()> {
        self.projected_cg.renew(problem);
        self.direct = Direct::new(&problem.coefficients, &problem.grid)?;
        Ok(())
    }

    /// Discards the best iterate, which may belong to another admissible set.
    pub fn forget_iterates(&mut self) {
        self.best = Best::default();
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let multigrid = self.multigrid.as_ref().map_or(0, FullMultigrid::bytes);
        let direct = self.direct.as_ref().map_or(0, Direct::bytes);
        let newton = self.projected_newton.bytes();
        self.projected_cg.bytes() + direct + multigrid + newton + self.norm.bytes() + self.best.bytes()
    }
}

/// Whether the state, with this survey, satisfies the goal. If so, the monitor gets the survey.
fn is_solved<S: AdmissibleSet>(task: &mut Task<'_, '_, S>, survey: Survey) -> bool {
    let holds = task.goal.holds(&survey, 0.0, task.set) && task.carries();
    if holds {
        task.monitor.survey = Some(survey);
    }
    holds
}

/// The start of NORM with limits. With a prescribed force it is the bearing area, because NORM from p = 0 does not find the elements that end at their limit.
fn start_norm_at_limits<S: AdmissibleSet>(task: &mut Task<'_, '_, S>) {
    let (self_influence, threads) = (task.problem.self_influence(), &task.problem.threads);
    task.state.unload();
    let (by_force, any_share) = (matches!(task.state.load, Load::Force(_)), (self_influence, f64::INFINITY));
    if !by_force || task.state.start_on_bearing_area(task.set, any_share, threads).is_none() {
        task.state.start(self_influence);
    }
}

/// Whether `p'Ap < 0`, by a fresh product. If an iteration diverges because A is indefinite, such a direction dominates p.
fn has_negative_energy(problem: &mut Problem, state: &mut State) -> Result<bool> {
    problem.displace(&state.p, &mut state.u)?;
    state.u_is = Freshness::Exact;
    Ok(state.p.iter().zip(&state.u).map(|(p, u)| p * u).sum::<f64>() < 0.0)
}

/// Returns the multigrid, which is set up at the first call.
fn set_up_multigrid<'a>(
    multigrid: &'a mut Option<FullMultigrid>,
    problem: &mut Problem,
    shape: CycleShape,
) -> Result<&'a mut FullMultigrid> {
    match multigrid {
        Some(multigrid) => Ok(multigrid),
        none => Ok(none.insert(FullMultigrid::new(problem, shape)?)),
    }
}
