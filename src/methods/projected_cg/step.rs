//! The production method as a [`Step`] of the loop: projected conjugate gradients on the window around the contact area, usually with directions in
//! single precision, until the recursive residual meets the goal. The loop's certificate then decides, by a fresh product on the full grid in double
//! precision.
//!
//! A solve without a guess starts on the coarser grids (module `coarse_grids`), a step in time from the last two solutions (module `predictor`).

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

/// The tolerance of the iteration, relative to that of the goal. The certificate must hold despite deferred corrections and the round-off of single
/// precision. On a full contact of flat bodies, where A is worst conditioned, p must be within ten tolerances (tests/random_problems.rs). With 0.5,
/// 0.75 and 0.9 the work in 40 cases is in the ratio 1 : 0.98 : 0.96.
const AIM: f64 = 0.75;
/// The same for tolerances below the round-off of single precision, which then adds noise to p in addition to the residual. In that test with eight
/// seeds (3200 solves), the error of p exceeds ten tolerances twice (largest error 10.5), but with 0.75 about 18 times (largest error 20).
const FINE_AIM: f64 = 0.5;
/// If u in single precision causes a noise in p of more than this many tolerances, the first u on the finest grid is computed in double precision.
/// Errors of transforms are about a tenth of `EPSILON u`, so otherwise the error of the largest pressure is below ten tolerances.
const NOISE: f64 = 25.0;
/// The largest number of iterations before a certificate. The loop's [patience](Step::policy) is three certificates. So an iteration ends that does
/// not halve its violation in 180 iterations. Those that converge reach all digits in fewer iterations, or halve the violation in about 40.
const MOST_ITERATIONS: u64 = 60;
/// If an iteration stagnates above this residual, the cause is the contact area, which a fresh u does not change. Below, the cause is round-off.
const STALLED: f64 = 0.1;
/// If contact is scattered, the first iteration on the finest grid ends at this residual: elements that then enter from outside the window raise the
/// residual to about this value, so that a smaller residual would be wasted.
const SCATTERED_RESIDUAL: f64 = 1e-2;
/// The last update of p is valid if the residual by a fresh product is at most this many times the recursive residual.
const VALID_UPDATE_RATIO: f64 = 2.0;

/// The method's window on the finest grid, its coarser grids, and its memory.
pub struct ProjectedCg {
    pub(super) finest: Level,
    /// The coarser grids. None before they are first used.
    coarse: Option<CoarseGrids>,
    predictor: Predictor,
    /// With criterion UPDATE: p before the last step.
    before: Vec<f64>,
    /// Whether the solve began with a prediction.
    predicted: bool,
    /// Whether the next step is the first on the finest grid after the coarser grids.
    is_new: bool,
    precision: Precision,
    find_force: FindForce,
    /// The relative recursive residual at the end of the last step.
    recursive: f64,
}

impl ProjectedCg {
    /// Creates the method. Its operators are set up when they are first needed.
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

    /// Forgets the windows of all grids, so that the bits of the next result do not depend on the solve before.
    pub fn forget_windows(&mut self) {
        self.finest.forget_window();
        self.coarse.iter_mut().for_each(CoarseGrids::forget_windows);
    }

    /// A copy of what the next step in time needs besides the last solution: the solution before the last, and the window.
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

    /// Restores a copy that [`last`](ProjectedCg::last) returned.
    pub fn go_back(&mut self, (predictor, window): (Predictor, Option<Rectangle>)) {
        self.predictor = predictor;
        self.finest.go_back_to(window);
    }

    /// Takes changed coefficients of the problem. Memory and plans are kept, and operators are updated when they are needed.
    pub fn renew(&mut self, problem: &Problem) {
        self.finest.renew(problem.coefficients.clone());
        self.coarse.iter_mut().for_each(CoarseGrids::forget_coefficients);
        self.predictor.forget_coefficients();
    }

    /// Bytes of all grids and of the predictor.
    pub fn bytes(&self) -> usize {
        let coarse = self.coarse.as_ref().map_or(0, CoarseGrids::bytes);
        coarse
            + self.finest.bytes()
            + self.find_force.bytes()
            + self.before.len() * size_of::<f64>()
            + self.predictor.bytes()
    }

    /// Starts a solve without a guess: sets the state to the solution of the coarser grids.
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

    /// Begins another solve, without a prediction.
    pub fn begin_anew(&mut self) {
        (self.predicted, self.is_new) = (false, false);
        self.find_force.begin();
    }

    /// Begins a step in time: extrapolates `state` from the last two solutions.
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

    /// The problem's operator for any p, if the window is the whole grid and the problem needs this operator, too. The window's operator is then made
    /// from it.
    fn whole_operator(&self, problem: &mut Problem, state: &State) -> Result<Option<Arc<Operator<f64>>>> {
        match self.finest.fills_grid(state) {
            true => problem.operator_if_needed(&state.p),
            false => Ok(None),
        }
    }

    /// The task of the iteration on the finest grid.
    fn on_finest<'a, 'm, S: AdmissibleSet>(
        &'a mut self,
        task: &'a mut Task<'_, 'm, S>,
        whole: Option<&'a Operator<f64>>,
    ) -> LevelTask<'a, 'm, S> {
        let Task { problem, state, set, monitor, .. } = task;
        LevelTask { level: &mut self.finest, state, set: *set, whole, finest: problem.grid.len(), monitor }
    }

    /// The rms over C of the last change of p. It is that of the last iteration, `last`, if the fresh residual confirms the recursive one; otherwise
    /// it is that of the whole step. It is infinite if the u from which the step started, of accuracy `u_was`, was not exact.
    fn update(&self, state: &State, u_was: Freshness, last: f64) -> f64 {
        if u_was != Freshness::Exact {
            return f64::INFINITY;
        }
        let is_confirmed = residual_norm(state) <= VALID_UPDATE_RATIO * self.recursive * norm_of_distance(state);
        if is_confirmed {
            last
        } else {
            rms_change(state, &self.before)
        }
    }
}

/// Returns the coarser grids with the problem's coefficients, and creates them at the first call.
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
        let u_was = state.u_is;
        if goal.by_update() {
            reserve(&mut self.before, state.p.len(), "the pressures before")?;
            self.before.clone_from(&state.p);
        }
        let aim = if goal.tolerance < f64::from(f32::EPSILON) { FINE_AIM } else { AIM };
        let tolerance = if goal.by_update() { goal.tolerance } else { aim * goal.tolerance };
        let max_cycles = goal.max_cycles.saturating_sub(monitor.count.cycles).min(MOST_ITERATIONS);
        let is_scattered = std::mem::take(&mut self.is_new) && !goal.by_update() && self.finest.is_scattered(state);
        let tolerance = if is_scattered { tolerance.max(SCATTERED_RESIDUAL) } else { tolerance };
        let inner = Goal { tolerance, max_cycles, ..*goal };
        let by_approach = self.predicted && matches!(state.load, Load::Approach(_));
        let whole = self.whole_operator(problem, state)?;
        let last = Some(self.predictor.last()).filter(|_| by_approach && u_was == Freshness::Exact);
        let (level, whole, finest) = (&mut self.finest, whole.as_deref(), problem.grid.len());
        let mut on_finest = LevelTask { level, state, set: *set, whole, finest, monitor };
        let end = if FindForce::serves(&on_finest, &inner) {
            let max_cycles = goal.max_cycles.saturating_sub(on_finest.monitor.count.cycles).min(4 * MOST_ITERATIONS);
            self.find_force.run(&mut on_finest, &Goal { max_cycles, ..inner }, u64::MAX)?
        } else {
            on_finest.run(u_was, last, &inner)?
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
        let update = self.update(state, u_was, monitor.count.update);
        Ok(Change { update, gives_up, ..Change::default() })
    }
}

/// The change of p from `before`, as an rms over C.
fn rms_change(state: &State, before: &[f64]) -> f64 {
    let sum: f64 = state.p.iter().zip(before).map(|(p, before)| (p - before) * (p - before)).sum();
    (sum / state.contact_count().max(1) as f64).sqrt()
}
