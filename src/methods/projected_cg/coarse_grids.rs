//! The coarser grids, from which a solve without a guess starts (nested iteration, section 4.3 of the paper). Each grid starts from the solution of
//! the next coarser grid: from its pressures, piecewise constant, and from its displacements, linearly interpolated. If that grid's relative residual
//! exceeds 1, which p = 0 has, the next grid starts from p = 0.
//!
//! With two periods u has mean zero, so the mean of e is the mean of `h - approach`. An approach beyond the mean of h has no solution, and an
//! approach close to it a huge pressure. A coarser grid covers more than a period if the finer count of elements is odd. Therefore the h of each
//! coarser grid is shifted to the mean of the finest grid, so that the coarser grid has a solution if the finest has.

use std::f64::consts::PI;
use std::iter::successors;
use std::ops::Range;

use super::find_force::FindForce;
use super::level::Level;
use super::level_task::LevelTask;
use super::End;
use crate::blocks;
use crate::contact::{AdmissibleSet, Freshness, Problem, State, Survey};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::memory::sparse;
use crate::methods::multigrid::{coarsen, transfer};
use crate::methods::Task;
use crate::operator::reserve;
use crate::operator::Precision;
use crate::progress::{Criterion, Goal, Monitor};
use crate::scene::Load;
use crate::sums::mean;
use crate::threads::Threads;

/// The coarsest grid has at most this many elements in each direction.
const COARSEST: usize = 8;
/// The tolerance on the coarsest grid, whose discretisation error is larger.
const COARSEST_TOLERANCE: f64 = 1e-3;
/// The largest number of iterations on the coarsest grid.
const COARSEST_ITERATIONS: u64 = 50;
/// The same on the grids between the coarsest and the finest. With 3 to 5 a solve takes 1.0 to 1.1 times as many products.
const COARSE_ITERATIONS: u64 = 2;
/// The same if elements are at their limit. With 4, 5, 6 and 8, each of 48 scenes (`examples/pressure_limits`) takes at most 6.0, 3.2, 3.3 and 3.6
/// times the work of the scene without limits.
const LIMITED_ITERATIONS: u64 = 5;
/// The same with a search for the force: three forces. 60 lines take at most 85 products on the finest grid; with two and four forces 130 and 110.
const FORCE_ITERATIONS: u64 = 6;

/// One coarser grid.
pub(super) struct Coarse {
    pub(super) level: Level,
    pub(super) state: State,
    /// The pressure limits of its elements, if the scene has any.
    limits: Vec<f64>,
}

/// All coarser grids.
pub struct CoarseGrids {
    /// The number of elements of the finest grid.
    pub(super) finest: usize,
    /// The grids, from the finer ones to the coarsest.
    pub(super) grids: Vec<Coarse>,
    threads: Threads,
    /// Whether the coefficients belong to the present ones of the finest grid.
    are_current: bool,
    /// The survey of the last grid that was solved.
    found: Survey,
    find_force: FindForce,
}

impl CoarseGrids {
    /// Creates the grids that are coarser than `grid`. Their operators are set up when needed.
    pub fn new(grid: &Grid, of_grid: &Coefficients, precision: Precision, threads: &Threads) -> Result<CoarseGrids> {
        let below = || successors(coarsen(grid, COARSEST), |grid| coarsen(grid, COARSEST));
        let mut grids = sparse(below().count(), "coarser grids")?;
        let (mut fine, mut coefficients) = (*grid, of_grid.clone());
        for coarse in below() {
            coefficients = coefficients.coarsen(&fine, &coarse)?;
            fine = coarse;
            grids.push(Coarse {
                level: Level::new(fine, coefficients.clone(), precision, threads),
                state: State::new(fine, (Load::Approach(0.0), 0.0), threads)?,
                limits: Vec::new(),
            });
        }
        let (finest, threads, found, find_force) =
            (grid.len(), threads.clone(), Survey::default(), FindForce::default());
        Ok(CoarseGrids { finest, grids, threads, are_current: true, found, find_force })
    }

    /// Marks the coefficients as outdated, after a change on the finest grid.
    pub fn forget_coefficients(&mut self) {
        self.are_current = false;
    }

    /// Coarsens the coefficients of the finest grid `grid` anew, if they have changed.
    pub fn renew(&mut self, grid: &Grid, coefficients: &Coefficients) -> Result<()> {
        if self.are_current {
            return Ok(());
        }
        let (mut fine, mut coefficients) = (*grid, coefficients.clone());
        for coarse in &mut self.grids {
            coefficients = coefficients.coarsen(&fine, &coarse.state.grid)?;
            fine = coarse.state.grid;
            coarse.level.renew(coefficients.clone());
        }
        self.are_current = true;
        Ok(())
    }

    /// Bytes of all coarser grids.
    pub fn bytes(&self) -> usize {
        self.find_force.bytes() + self.grids.iter().map(|grid| grid.level.bytes() + grid.state.bytes()).sum::<usize>()
    }

    /// See [`Level::forget_window`].
    pub fn forget_windows(&mut self) {
        self.grids.iter_mut().for_each(|grid| grid.level.forget_window());
    }

    /// Solves on the coarser grids, and interpolates their solution to the task's state. Returns how accurately its u then equals A p.
    pub fn start<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>) -> Result<Freshness> {
        let (count, self_influence) = (self.grids.len(), task.problem.self_influence());
        let Task { state: fine, lowest, set, goal, monitor, .. } = task;
        if count == 0 {
            // Discards the pressures of a guess.
            fine.p.fill(0.0);
            fine.u.fill(0.0);
            fine.start(self_influence);
            return Ok(Freshness::Stale);
        }
        let highest = fine.out_of_reach(*lowest, self_influence);
        self.restrict(fine, *set, highest)?;
        let coarsest = &mut self.grids[count - 1];
        coarsest.state.p.fill(0.0);
        coarsest.state.start(coarsest.level.self_influence());
        coarsest.state.carry_force(S::within(&coarsest.limits), &self.threads);
        let (mut displacement, threads) = (Freshness::Stale, self.threads.clone());
        for l in (0..count).rev() {
            let known = !monitor.is_cancelled();
            if known {
                monitor.enter_grid();
                self.iterate::<S>(l, displacement, goal, monitor)?;
                self.found = Survey::by(&self.grids[l].state, &threads);
                monitor.survey = Some(self.found);
                monitor.close_grid(&self.grids[l].state);
                displacement = Freshness::Near;
            }
            let finer_influence = if l > 0 { self.grids[l - 1].level.self_influence() } else { self_influence };
            let found = self.found;
            let (to, from) = self.pair(l, fine);
            to.reached_limit |= from.state.reached_limit;
            if known && found.residual <= found.distance {
                prolong(&from.state, to, highest, &threads);
            } else {
                to.p.fill(0.0);
                to.start(finer_influence);
                displacement = Freshness::Stale;
            }
            if S::LIMITED {
                let limits = l.checked_sub(1).map(|l| std::mem::take(&mut self.grids[l].limits));
                let (to, _) = self.pair(l, fine);
                match limits {
                    Some(limits) => {
                        truncate_to(to, S::within(&limits));
                        self.grids[l - 1].limits = limits;
                    }
                    None => truncate_to(to, *set),
                }
            }
        }
        monitor.enter_grid();
        Ok(displacement)
    }

    /// Restricts distances, load and limits to all coarser grids. Elements with h above `highest` are never in contact.
    fn restrict<S: AdmissibleSet>(&mut self, fine: &mut State, set: S, highest: f64) -> Result<()> {
        let threads = self.threads.clone();
        for l in 0..self.grids.len() {
            let (from, to) = self.pair(l, fine);
            transfer::restrict_distance(&from.grid, &to.state.grid, &from.h, highest, &mut to.state.h, &threads);
            to.state.reached_limit = false;
            to.state.at_limit.clear();
            if to.level.coefficients().is_mean_free() {
                shift_to_mean(&from.h, &mut to.state.h);
            }
            (to.state.load, to.state.approach) = (from.load, from.approach);
        }
        if S::LIMITED {
            self.restrict_limits(fine, set)?;
        }
        Ok(())
    }

    /// The error of p on the finest grid that single-precision errors of u cause, relative to the rms of p over elements in contact. These errors of
    /// u have a white spectrum. An error of u with the wave number k causes an error of p that is `E* |k|/2` times as large.
    pub fn noise(&self, fine: &Problem) -> f64 {
        let Some(Coarse { state, .. }) = self.grids.first() else { return 0.0 };
        let Survey { squares, contact_count, .. } = self.found;
        let depth = |i: usize| if state.contact[i] { state.approach - state.h[i] } else { 0.0 };
        let deepest_of = |block: Range<usize>| block.map(depth).fold(0.0, f64::max);
        let deepest = blocks::fold(&state.grid, &self.threads, 0.0, deepest_of, f64::max);
        let wave_number = (PI * PI / 3.0).sqrt() * (1.0 / fine.grid.dx).hypot(1.0 / fine.grid.dy);
        let modulus = fine.grid.modulus(fine.self_influence());
        f64::from(f32::EPSILON) * deepest * 0.5 * modulus * wave_number / f64::sqrt(squares / contact_count as f64)
    }

    /// Iterates on grid `l`, from displacements of the given accuracy.
    fn iterate<S: AdmissibleSet>(
        &mut self,
        l: usize,
        displacement: Freshness,
        goal: &Goal,
        monitor: &mut Monitor<'_>,
    ) -> Result<End> {
        let (max_cycles, enough) = match l + 1 == self.grids.len() {
            true => (COARSEST_ITERATIONS, COARSEST_TOLERANCE),
            false if self.grids[l].state.has_limited() => (LIMITED_ITERATIONS, 0.0),
            false => (COARSE_ITERATIONS, 0.0),
        };
        let goal = Goal { criterion: Criterion::Residual, tolerance: goal.tolerance.max(enough), max_cycles };
        let Coarse { level, state, limits, .. } = &mut self.grids[l];
        let mut task = LevelTask { level, state, set: S::within(limits), whole: None, finest: self.finest, monitor };
        let end = if FindForce::serves(&task, &goal) {
            task.state.u_is = displacement;
            let goal = Goal { max_cycles: max_cycles.max(FORCE_ITERATIONS), ..goal };
            self.find_force.begin();
            self.find_force.run(&mut task, &goal, COARSE_ITERATIONS)?
        } else {
            task.run(displacement, None, &goal)?
        };
        task.level.take_displacements(task.state);
        Ok(end)
    }

    /// Restricts limits to the coarser grids: each is the mean over the joined elements, infinite if one of them is. No element is then at its limit.
    fn restrict_limits<S: AdmissibleSet>(&mut self, fine: &State, set: S) -> Result<()> {
        for l in 0..self.grids.len() {
            let (finer, coarser) = self.grids.split_at_mut(l);
            let Coarse { state, limits, .. } = &mut coarser[0];
            let n = state.grid.len();
            reserve(limits, n, "limits of the pressures")?;
            limits.resize(n, 0.0);
            match finer.last() {
                Some(from) => transfer::restrict_mean(&from.state.grid, &state.grid, |i| from.limits[i], limits),
                None => transfer::restrict_mean(&fine.grid, &state.grid, |i| set.limit(i), limits),
            }
            reserve(&mut state.at_limit, n, "elements at the limit")?;
            state.at_limit.clear();
            state.at_limit.resize(n, false);
        }
        Ok(())
    }

    /// The state of the next finer grid than `l`, and grid `l`.
    fn pair<'a>(&'a mut self, l: usize, finest: &'a mut State) -> (&'a mut State, &'a mut Coarse) {
        let (finer, coarser) = self.grids.split_at_mut(l);
        (finer.last_mut().map_or(finest, |grid| &mut grid.state), &mut coarser[0])
    }
}

/// Truncates pressures at their limit, and moves these elements from C to their limit.
fn truncate_to<S: AdmissibleSet>(state: &mut State, set: S) {
    if !state.reached_limit && !set.any_beyond(0, state.p.iter().copied()) {
        return;
    }
    for i in 0..state.p.len() {
        state.at_limit[i] = state.p[i] >= set.limit(i);
        state.reached_limit |= state.at_limit[i];
        if state.at_limit[i] {
            (state.p[i], state.contact[i]) = (set.limit(i), false);
        }
    }
}

/// Shifts the h of a coarser grid to the mean of the finer grid's h. If elements have no surface, the mean of e is free, and h stays.
pub fn shift_to_mean(fine: &[f64], coarse: &mut [f64]) {
    let shift = mean(fine) - mean(coarse);
    if shift.is_finite() {
        coarse.iter_mut().for_each(|h| *h += shift);
    }
}

/// Interpolates from a coarser grid: pressures and contact area piecewise constant (the preconditioner removes the difference to a smoother
/// interpolation), displacements linearly. Elements with h above `highest` are never in contact. The loop has no branches, so it is vectorised.
fn prolong(coarse: &State, fine: &mut State, highest: f64, threads: &Threads) {
    let (from, to) = (coarse.grid, fine.grid);
    transfer::interpolate_linearly(&to, &from, &coarse.u, &mut fine.u, threads);
    fine.approach = coarse.approach;
    let State { h, p, contact, .. } = fine;
    threads.for_a_pass(to.len()).for_each_row_pair(
        (p, to.mx),
        (contact, to.mx),
        #[inline(always)]
        |y, p, contact| {
            transfer::interpolate_row(&to, &from, &coarse.p, y, p, |to, value| *to = value);
            for ((p, inside), h) in p.iter_mut().zip(contact).zip(&h[y * to.mx..]) {
                *p = if h.is_infinite() | (*h > highest) { 0.0 } else { *p };
                *inside = *p > 0.0;
            }
        },
    );
}
