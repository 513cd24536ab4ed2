//! The production method: nested iteration (section 4.3 of the paper) with projected conjugate gradients on every grid.
//!
//! On each coarser grid a few iterations (`coarse_grids`); on the finest one as many as the tolerance asks for, on the window around the
//! contact area and in single precision directions (`level`); then u = A p on the full grid, in double precision: the
//! certificate. If it does not hold, the iteration goes on from there.
//!
//! Few elements in contact are solved for directly instead (`direct`); a step in time starts from what the last ones found
//! (`predictor`).

use std::sync::Arc;

use super::coarse_grids::CoarseGrids;
use super::coarser_solutions::{PREDICTS, SHOWS_ORDER};
use super::level::Level;
use super::predictor::Predictor;
use super::{End, Stopping};
use crate::contact::admissible::AdmissibleSet;
use crate::contact::{admit, Freshness, State, Survey};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Influence;
use crate::methods::direct::Direct;
use crate::operator::{reserve, Toeplitz, Workspace};
use crate::progress::{Monitor, Rule};
use crate::solver::estimates::{self, Sample};
use crate::solver::start::Start;
use crate::solver::{Precision, Stop};
use crate::threads::Threads;

/// The iteration aims at this part of the tolerance: what is owed and the rounding of its single precision products shall not fail
/// the certificate, and on a full contact of flat bodies, where A is worst conditioned, p be within ten tolerances (tests/random_problems.rs). Work over 40 cases at 0.5, 0.75, 0.9: 1, 0.98, 0.96.
const AIM: f64 = 0.75;
/// The first u on the finest grid is of single precision if the noise that this may leave in p is at most so many tolerances. Errors
/// of transforms are some tenth of `EPSILON u`: what is left is below ten tolerances in the largest pressure.
const NOISE: f64 = 25.0;
/// Rounds without progress after which round-off is reached, or the method does not work on this scene.
const PATIENCE: u32 = 3;
/// Rounds with direct solves, after which the exchange of elements may be cycling and the iteration takes over.
const DIRECT_ROUNDS: u32 = 12;
/// A guess whose relative residual or penetration is larger is worth less than what the coarser grids find.
const WORTHLESS: f64 = 0.3;

/// The method's operators, set up once.
pub struct Projected {
    grid: Grid,
    /// In double precision, on the full grid: for certificates.
    operator: Arc<Toeplitz<f64>>,
    workspace: Workspace<f64>,
    finest: Level,
    /// None before it is first needed.
    coarse: Option<CoarseGrids>,
    /// None on large grids.
    direct: Option<Direct>,
    history: Predictor,
    /// With criterion UPDATE: p before the last round.
    before: Vec<f64>,
    precision: Precision,
    threads: Threads,
}

impl Projected {
    /// Sets up the full-grid operator; the rest follows when it is first needed.
    pub fn new(grid: &Grid, influence: &Influence, precision: Precision, threads: &Threads) -> Result<Projected> {
        let operator = Arc::new(Toeplitz::new(influence, grid, &threads.suited_to(grid.len()))?);
        Ok(Projected {
            grid: *grid,
            workspace: operator.workspace()?,
            finest: Level::new(*grid, influence.clone(), precision, threads).with_operator(operator.clone()),
            operator,
            coarse: None,
            direct: Direct::new(influence, grid)?,
            history: Predictor::default(),
            before: Vec::new(),
            precision,
            threads: threads.clone(),
        })
    }

    /// The influence coefficients.
    pub fn influence(&self) -> &Influence {
        self.finest.influence()
    }

    /// The next solve chooses its windows by itself, so that its result does not depend, in the last bits, on the solve before.
    pub fn forget_windows(&mut self) {
        self.finest.forget_window();
        self.coarse.iter_mut().for_each(CoarseGrids::forget_windows);
    }

    /// `u = A p` on the full grid, in double precision.
    pub fn displace(&mut self, p: &[f64], u: &mut [f64]) {
        self.operator.apply(p, u, &mut self.workspace);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let coarse = self.coarse.as_ref().map_or(0, CoarseGrids::bytes);
        let before = self.before.len() * size_of::<f64>();
        self.operator.bytes()
            + self.workspace.bytes()
            + coarse
            + self.finest.bytes()
            + before
            + self.history.bytes()
            + self.direct.as_ref().map_or(0, Direct::bytes)
    }

    /// Solves from what `state` holds, as `from` says. `error_ratio` is that of the options; it needs the coarser grids of a start from
    /// nothing.
    pub fn solve<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        set: S,
        rule: &Rule,
        from: Start,
        error_ratio: f64,
        monitor: &mut Monitor<'_>,
    ) -> Result<Stop> {
        let mut rule = *rule;
        let mut displacement = Freshness::Exact;
        let mut good_start = from != Start::Nothing;
        if good_start && !(rule.fixed && rule.by_update) {
            let certified = self.judge(state, &rule, monitor);
            if certified.holds && !rule.by_update {
                return Ok(Stop::Converged);
            }
            good_start = rule.fixed || certified.violation <= WORTHLESS;
        }
        // With limits what grows with the load is not known.
        if good_start && from == Start::Previous && !rule.fixed && !S::LIMITED {
            displacement = self.history.predict(state)?;
        }
        if !good_start {
            displacement = self.start(state, set, &rule, monitor)?;
            if displacement == Freshness::Near && self.noise() > NOISE * rule.tolerance {
                self.finest.correct(state, set)?;
                self.displace(&state.p, &mut state.u);
                monitor.count_products(1, 1.0);
                displacement = Freshness::Exact;
            }
            if error_ratio > 0.0 {
                rule.tolerance = rule.tolerance.max(error_ratio * self.predicted_error(state, monitor)?);
            }
        }
        if monitor.is_cancelled() {
            self.certify(state, set, &rule, monitor);
            return Ok(Stop::Cancelled);
        }
        let rule = &rule;
        let (mut best, mut rounds, mut rounds_without_progress) = (f64::INFINITY, 0, 0);
        loop {
            if rule.by_update {
                reserve(&mut self.before, state.p.len(), "the pressures before")?;
                self.before.clone_from(&state.p);
            }
            let stop = Stopping {
                tolerance: if rule.by_update { rule.tolerance } else { AIM * rule.tolerance },
                by_update: rule.by_update,
                fixed: rule.fixed,
                iterations: rule.max_cycles.saturating_sub(monitor.cycles),
            };
            let directly = match &mut self.direct {
                Some(direct) if !rule.fixed && !S::LIMITED && rounds < DIRECT_ROUNDS => {
                    direct.run(state, stop.iterations, monitor)
                }
                _ => None,
            };
            rounds += 1;
            let end = match directly {
                Some(end) => end,
                None => self.finest.run(state, set, displacement, &stop, self.grid.len(), monitor)?,
            };
            let certified = self.certify(state, set, rule, monitor);
            // A small last update proves nothing while u was of single precision, or pressures were owed: then all that
            // is done from a fresh u must come to no more than a small update.
            let settled = !rule.by_update
                || displacement == Freshness::Exact && rule.holds(state, rms_change(state, &self.before));
            displacement = Freshness::Exact;
            if certified.holds && settled {
                return Ok(Stop::Converged);
            }
            match end {
                End::Cancelled => return Ok(Stop::Cancelled),
                End::Limit if monitor.cycles >= rule.max_cycles => return Ok(Stop::IterationLimit),
                _ => {}
            }
            rounds_without_progress += u32::from(directly.is_none());
            if certified.violation < 0.5 * best {
                best = certified.violation;
                rounds_without_progress = 0;
            }
            if rounds_without_progress == PATIENCE {
                return Ok(Stop::Stagnated);
            }
        }
    }

    /// From nothing: what the coarser grids find. Returns what u is then.
    fn start<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        set: S,
        rule: &Rule,
        monitor: &mut Monitor<'_>,
    ) -> Result<Freshness> {
        let self_influence = self.finest.self_influence();
        self.coarse_grids()?.start(state, set, self_influence, rule, monitor)
    }

    /// What the scene of `state` is on coarser grids: up to two samples.
    pub fn samples(&mut self, state: &State, monitor: &mut Monitor<'_>) -> Result<([Sample; 2], usize)> {
        let chord = monitor.outline().chord(state.contact_count());
        self.coarse_grids()?.samples(state, chord, SHOWS_ORDER, monitor)
    }

    /// Relative discretisation error of the force (or the approach), before the finest grid is solved; 0 where it is not known.
    fn predicted_error(&mut self, state: &State, monitor: &mut Monitor<'_>) -> Result<f64> {
        let ([near, far], count) = self.coarse_grids()?.samples(state, 0.0, PREDICTS, monitor)?;
        Ok(if count == 2 { estimates::predict(&near, &far) } else { 0.0 })
    }

    fn coarse_grids(&mut self) -> Result<&mut CoarseGrids> {
        match &mut self.coarse {
            Some(coarse) => Ok(coarse),
            none => {
                let influence = self.finest.influence();
                Ok(none.insert(CoarseGrids::new(&self.grid, influence, self.precision, &self.threads)?))
            }
        }
    }

    /// What the rounding of a u in single precision will leave in p, see [`CoarseGrids::noise`].
    fn noise(&self) -> f64 {
        match (&self.coarse, self.precision) {
            (Some(coarse), Precision::Auto | Precision::Mixed) => {
                coarse.noise(&self.grid, self.finest.self_influence())
            }
            _ => 0.0,
        }
    }

    /// u = A p anew, on the full grid and in double precision, and whether the conditions hold. Elements outside C that penetrate
    /// enter it.
    fn certify<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        set: S,
        rule: &Rule,
        monitor: &mut Monitor<'_>,
    ) -> Certified {
        state.balance_force_within(set);
        self.operator.apply(&state.p, &mut state.u, &mut self.workspace);
        monitor.count_products(1, 1.0);
        state.fit_approach();
        self.judge(state, rule, monitor)
    }

    /// Whether the conditions hold for a state whose u is A p. Elements outside C that penetrate enter it.
    fn judge(&self, state: &mut State, rule: &Rule, monitor: &Monitor<'_>) -> Certified {
        let mut survey = Survey::of(state);
        let scale = survey.distance / (survey.contact_count.max(1) as f64).sqrt();
        // What is no number is no good: `max` alone would drop it.
        let violations = [survey.residual / survey.distance, survey.penetration / scale];
        let violation = violations.into_iter().fold(0.0, |worst, v| if v <= worst { worst } else { v });
        if !rule.fixed && survey.penetration > 0.0 {
            admit(state);
            if !(survey.penetration <= rule.tolerance * scale) {
                return Certified { holds: false, violation };
            }
            survey = Survey::of(state);
        }
        let holds = if rule.by_update {
            rule.holds(state, monitor.update)
        } else {
            survey.residual.is_finite() && survey.residual <= rule.tolerance * survey.distance
        };
        Certified { holds, violation }
    }
}

/// What a certificate says.
struct Certified {
    holds: bool,
    /// The larger of the relative residual and the relative penetration.
    violation: f64,
}

/// rms over C of the change of p.
fn rms_change(state: &State, before: &[f64]) -> f64 {
    let sum: f64 = state.p.iter().zip(before).map(|(p, before)| (p - before) * (p - before)).sum();
    (sum / state.contact_count().max(1) as f64).sqrt()
}
