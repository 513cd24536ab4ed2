//! The production method as a step: projected conjugate gradients on the window around the contact area, in single precision
//! directions, until the recursively updated residual meets the goal. Only the loop's certificate, a fresh product on the full grid in
//! double precision, decides.
//!
//! A solve without a guess starts on the coarser grids (`coarse_grids`), a step in time from the last solutions (`predictor`).

use std::sync::Arc;

use super::coarse_grids::CoarseGrids;
use super::find_force::FindForce;
use super::level::Level;
use super::level_task::LevelTask;
use super::predictor::Predictor;
use super::End;
use crate::contact::{norm_of_distance, residual_norm, AdmissibleSet, Freshness, Problem, State};
use crate::error::Result;
use crate::memory::{release, reserve, rests};
use crate::methods::{Change, Policy, Step, Task};
use crate::operator::{Operator, Precision};
use crate::progress::Goal;
use crate::rectangle::Rectangle;
use crate::scene::Load;
use crate::threads::Threads;

/// The tolerance of the iteration over the goal's. The certificate must hold with deferred corrections and round-off of single precision, and on a
/// full contact of flat bodies, where A is worst conditioned, p must be within ten tolerances (tests/random_problems.rs). Work over 40 cases at 0.5,
/// 0.75, 0.9: 1, 0.98, 0.96.
const AIM: f64 = 0.75;
/// The ratio for tolerances below the round-off of single precision, which then adds noise to p in addition to the residual. In eight seeds of that
/// test, 3200 solves, 2 exceed ten tolerances (largest 10.5), with 0.75 about 18 (largest 20).
const FINE_AIM: f64 = 0.5;
/// Bound on the noise in p, in tolerances, with which the first u on the finest grid is in single precision. Errors of transforms are about a tenth
/// of `EPSILON u`: the error of the largest pressure is then below ten tolerances.
const NOISE: f64 = 25.0;
/// Most iterations before a certificate. With the [patience](Step::policy) of three certificates, an iteration that does not halve its violation in
/// 180 iterations ends. Convergent ones need fewer for all digits, or halve it in about 40.
const MOST_ITERATIONS: u64 = 60;
/// An iteration that stagnates above this residual does so by the contact area, which a fresh u does not change; below, by round-off.
const STALLED: f64 = 0.1;
/// Residual at which the first iteration on the finest grid ends if contact is scattered: elements that enter from outside the window raise the
/// residual to about this, so that smaller residuals are wasted.
const SCATTERED_RESIDUAL: f64 = 1e-2;
/// Largest ratio of the residual by a fresh product to the recursive one for a valid last update.
const VALID_UPDATE_RATIO: f64 = 2.0;

/// The method's windows, operators and coarser grids.
pub struct ProjectedCg {
    pub(super) finest: Level,
    /// None before the first use.
    coarse: Option<CoarseGrids>,
    predictor: Predictor,
    /// With criterion UPDATE: p before the last step.
    before: Vec<f64>,
    /// Whether the solve began with a prediction.
    predicted: bool,
    /// Whether the solve begins on the finest grid from the coarser ones.
    is_new: bool,
    precision: Precision,
    find_force: FindForce,
    /// The relative recursive residual at the end of the last step.
    recursive: f64,
}

impl ProjectedCg {
    /// The method without operators, which are set up at first use.
    pub fn new(problem: &Problem, precision: Precision) -> ProjectedCg {
        ProjectedCg {
            finest: Level::new(problem.grid, problem.coefficients.clone(), precision, &problem.threads),
            coarse: None,
            predictor: Predictor::default(),
            before: Vec::new(),
            predicted: false,
            is_new: false,
            precision,
            find_force: FindForce::default(),
            recursive: 0.0,
        }
    }

    /// Forgets the windows, so that the bits of the next result do not depend on the solve before.
    pub fn forget_windows(&mut self) {
        self.finest.forget_window();
        self.coarse.iter_mut().for_each(CoarseGrids::forget_windows);
    }

    /// A copy of the state from which a step in time continues, besides the last solution.
    pub fn last(&self) -> Result<(Predictor, Option<Rectangle>)> {
        Ok((self.predictor.copy()?, self.finest.current_window()))
    }

    /// The window of the last iteration.
    pub fn current_window(&self) -> Option<Rectangle> {
        self.finest.current_window()
    }

    /// Makes `window` the last window.
    pub fn go_back_to(&mut self, window: Option<Rectangle>) {
        self.finest.go_back_to(window);
    }

    /// Restores the state of a step in time.
    pub fn go_back(&mut self, (predictor, window): (Predictor, Option<Rectangle>)) {
        self.predictor = predictor;
        self.finest.go_back_to(window);
    }

    /// Takes the problem's other coefficients, and keeps memory and plans; operators are updated when needed.
    pub fn renew(&mut self, problem: &Problem) {
        self.finest.renew(problem.coefficients.clone());
        self.coarse.iter_mut().for_each(CoarseGrids::forget_coefficients);
        self.predictor.forget_coefficients();
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let coarse = self.coarse.as_ref().map_or(0, CoarseGrids::bytes);
        coarse
            + self.finest.bytes()
            + self.find_force.bytes()
            + self.before.len() * size_of::<f64>()
            + self.predictor.bytes()
    }

    /// A start without a guess: from the coarser grids.
    pub fn start<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<()> {
        let began = task.monitor.seconds();
        let coarse = coarse_grids(&mut self.coarse, task.problem, self.precision)?;
        task.monitor.coarse_seconds += task.monitor.seconds() - began;
        task.state.u_is = coarse.start(task)?;
        let single = self.precision != Precision::Double;
        let near = task.state.u_is == Freshness::Near && !task.monitor.is_cancelled();
        self.is_new = near;
        let noisy = near && single && coarse.noise(task.problem) > NOISE * task.goal.tolerance;
        if rests(task.state.p.len()) {
            self.coarse = None;
            release();
        }
        if noisy {
            let whole = self.whole_operator(task.problem, task.state)?;
            self.on_finest(task, whole.as_deref()).correct()?;
            self.finest.rest();
            task.problem.refresh(task.state, task.set)?;
            task.count_products();
        }
        Ok(())
    }

    /// Begins another solve.
    pub fn begin_anew(&mut self) {
        (self.predicted, self.is_new) = (false, false);
        self.find_force.begin();
    }

    /// A step in time: extrapolates `state` from the last solution.
    pub fn predict(&mut self, state: &mut State, threads: &Threads) -> Result<()> {
        let finest = &self.finest;
        state.u_is = self.predictor.predict(state, |state| finest.window(state), threads)?;
        self.predicted = true;
        Ok(())
    }

    /// Forgets the solution before the last.
    pub fn forget_solutions(&mut self) {
        self.predictor = Predictor::default();
    }

    /// The problem's operator for any p, if the window is the whole grid and the problem needs this operator: the window's operator is a copy.
    fn whole_operator(&self, problem: &mut Problem, state: &State) -> Result<Option<Arc<Operator<f64>>>> {
        match self.finest.fills_grid(state) {
            true => problem.operator_if_needed(&state.p),
            false => Ok(None),
        }
    }

    /// The task on the finest grid.
    fn on_finest<'a, 'm, S: AdmissibleSet>(
        &'a mut self,
        task: &'a mut Task<'_, 'm, S>,
        whole: Option<&'a Operator<f64>>,
    ) -> LevelTask<'a, 'm, S> {
        let Task { problem, state, set, monitor, .. } = task;
        LevelTask { level: &mut self.finest, state, set: *set, whole, finest: problem.grid.len(), monitor }
    }

    /// The update of the last step; infinite if u was in single precision or a correction was deferred.
    fn update(&self, state: &State, was: Freshness, last: f64) -> f64 {
        if was != Freshness::Exact {
            return f64::INFINITY;
        }
        let believed = residual_norm(state) <= VALID_UPDATE_RATIO * self.recursive * norm_of_distance(state);
        if believed {
            last
        } else {
            rms_change(state, &self.before)
        }
    }
}

fn coarse_grids<'a>(
    coarse: &'a mut Option<CoarseGrids>,
    problem: &Problem,
    precision: Precision,
) -> Result<&'a mut CoarseGrids> {
    match coarse {
        Some(coarse) => {
            coarse.renew(&problem.grid, &problem.coefficients)?;
            Ok(coarse)
        }
        none => Ok(none.insert(CoarseGrids::new(&problem.grid, &problem.coefficients, precision, &problem.threads)?)),
    }
}

impl<S: AdmissibleSet> Step<S> for ProjectedCg {
    fn name(&self) -> &'static str {
        "PROJECTED_CG"
    }

    fn policy(&self) -> Policy {
        Policy { exchanged_by_loop: true, step_is_cycle: false, chatter: 0, patience: 3, progress: 0.5 }
    }

    fn step(&mut self, task: &mut Task<'_, '_, S>) -> Result<Change> {
        let Task { problem, state, set, goal, monitor, .. } = task;
        let was = state.u_is;
        if goal.by_update() {
            reserve(&mut self.before, state.p.len(), "the pressures before")?;
            self.before.clone_from(&state.p);
        }
        let aim = if goal.tolerance < f64::from(f32::EPSILON) { FINE_AIM } else { AIM };
        let tolerance = if goal.by_update() { goal.tolerance } else { aim * goal.tolerance };
        let max_cycles = goal.max_cycles.saturating_sub(monitor.count.cycles).min(MOST_ITERATIONS);
        let looks = std::mem::take(&mut self.is_new) && !goal.by_update() && self.finest.is_scattered(state);
        let tolerance = if looks { tolerance.max(SCATTERED_RESIDUAL) } else { tolerance };
        let inner = Goal { tolerance, max_cycles, ..*goal };
        let by_approach = self.predicted && matches!(state.load, Load::Approach(_));
        let whole = self.whole_operator(problem, state)?;
        let last = Some(self.predictor.last()).filter(|_| by_approach && was == Freshness::Exact);
        let (level, whole, finest) = (&mut self.finest, whole.as_deref(), problem.grid.len());
        let mut on_finest = LevelTask { level, state, set: *set, whole, finest, monitor };
        let end = if FindForce::serves(&on_finest, &inner) {
            let max_cycles = goal.max_cycles.saturating_sub(on_finest.monitor.count.cycles).min(4 * MOST_ITERATIONS);
            self.find_force.run(&mut on_finest, &Goal { max_cycles, ..inner }, u64::MAX)?
        } else {
            on_finest.run(was, last, &inner)?
        };
        self.finest.rest();
        state.u_is = Freshness::Stale;
        let gives_up = end == End::Stagnated && monitor.count.residual > STALLED;
        if gives_up || goal.by_update() {
            problem.refresh(state, *set)?;
        }
        if !goal.by_update() {
            return Ok(Change { gives_up, ..Change::default() });
        }
        self.recursive = monitor.count.residual;
        let update = self.update(state, was, monitor.count.update);
        Ok(Change { update, gives_up, ..Change::default() })
    }
}

/// rms over C of the change of p.
fn rms_change(state: &State, before: &[f64]) -> f64 {
    let sum: f64 = state.p.iter().zip(before).map(|(p, before)| (p - before) * (p - before)).sum();
    (sum / state.contact_count().max(1) as f64).sqrt()
}
