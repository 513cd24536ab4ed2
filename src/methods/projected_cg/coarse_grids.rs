//! The coarser grids: where a solve from nothing begins (nested iteration, section 4.3 of the paper). Each grid starts from the
//! pressures of the next coarser one, piecewise constant, and its displacements, linearly interpolated.

use std::f64::consts::PI;

use super::level::Level;
use super::{End, Stopping};
use crate::contact::{AdmissibleSet, Freshness, NonNegative, State};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::methods::multigrid::{coarsen, transfer};
use crate::operator::zeros;
use crate::operator::Precision;
use crate::progress::{Goal, Monitor};
use crate::threads::Threads;

/// The coarsest grid has at most this many elements in each direction.
const COARSEST: usize = 8;
/// Iterations at most on the coarsest grid, and on those between it and the finest, where they follow a first step without
/// direction. Measured: with 3 or 4 the finest grid needs no fewer.
const COARSEST_ITERATIONS: u64 = 50;
const COARSE_ITERATIONS: u64 = 2;

/// One coarser grid.
pub(super) struct Coarse {
    pub(super) level: Level,
    pub(super) state: State,
    /// Means of the finest grid's pressures, while the grid is a sample.
    pub(super) means: Vec<f64>,
}

/// All coarser grids.
pub struct CoarseGrids {
    /// Elements of the finest grid.
    pub(super) finest: usize,
    /// The coarsest last.
    pub(super) grids: Vec<Coarse>,
}

impl CoarseGrids {
    /// The grids below `grid`; their operators follow when they are needed.
    pub fn new(grid: &Grid, influence: &Coefficients, precision: Precision, threads: &Threads) -> Result<CoarseGrids> {
        let mut grids = Vec::new();
        let (mut fine, mut influence) = (*grid, influence.clone());
        while let Some(coarse) = coarsen(&fine, COARSEST) {
            influence = influence.coarsen(&fine, &coarse)?;
            fine = coarse;
            let h = zeros(fine.len(), "undeformed distances")?;
            let load = crate::scene::Load::Approach(0.0);
            grids.push(Coarse {
                level: Level::new(fine, influence.clone(), precision, threads),
                state: State::new(fine, h, load, 0.0)?,
                means: Vec::new(),
            });
        }
        Ok(CoarseGrids { finest: grid.len(), grids })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.grids
            .iter()
            .map(|grid| grid.level.bytes() + grid.state.bytes() + grid.means.len() * size_of::<f64>())
            .sum()
    }

    /// See [`Level::forget_window`].
    pub fn forget_windows(&mut self) {
        self.grids.iter_mut().for_each(|grid| grid.level.forget_window());
    }

    /// Solves on the coarser grids; `fine` gets what they found. Returns what its u is.
    pub fn start<S: AdmissibleSet>(
        &mut self,
        fine: &mut State,
        set: S,
        self_influence: f64,
        goal: &Goal,
        monitor: &mut Monitor<'_>,
    ) -> Result<Freshness> {
        let _ = set;
        let count = self.grids.len();
        if count == 0 {
            // A guess that was worth nothing is gone.
            fine.p.fill(0.0);
            fine.u.fill(0.0);
            fine.start(self_influence);
            return Ok(Freshness::Stale);
        }
        let highest = fine.out_of_reach(self_influence);
        let within = |h: f64| if h.is_finite() { h.min(highest) } else { h };
        for l in 0..count {
            let (from, to) = self.pair(l, fine);
            transfer::restrict_distance(&from.grid, &to.state.grid, |i| within(from.h[i]), &mut to.state.h);
            (to.state.load, to.state.approach) = (from.load, from.approach);
        }
        let coarsest = &mut self.grids[count - 1];
        coarsest.state.p.fill(0.0);
        coarsest.state.start(coarsest.level.self_influence());
        coarsest.state.balance_force();
        let mut displacement = Freshness::Stale;
        for l in (0..count).rev() {
            if !monitor.is_cancelled() {
                monitor.enter_grid();
                self.iterate(l, displacement, goal, monitor)?;
                monitor.close_grid(&self.grids[l].state);
                displacement = Freshness::Near;
            }
            let (to, from) = self.pair(l, fine);
            prolong(&from.state, to, highest);
        }
        monitor.enter_grid();
        Ok(displacement)
    }

    /// What the rounding of a u in single precision leaves in p on the finest grid, relative to p (rms over C). Errors of
    /// `EPSILON u` that change from element to element, all wave numbers k alike, take pressures of `E* |k|/2` times themselves.
    pub fn noise(&self, fine: &Grid, self_influence: f64) -> f64 {
        let Some(Coarse { state, .. }) = self.grids.first() else { return 0.0 };
        let (mut deepest, mut squares, mut count) = (0.0_f64, 0.0, 0.0);
        for i in (0..state.p.len()).filter(|&i| state.contact[i]) {
            deepest = deepest.max(state.approach - state.h[i]);
            squares += state.p[i] * state.p[i];
            count += 1.0;
        }
        let wave_number = (PI * PI / 3.0).sqrt() * (1.0 / fine.dx).hypot(1.0 / fine.dy);
        let modulus = fine.modulus(self_influence);
        f64::from(f32::EPSILON) * deepest * 0.5 * modulus * wave_number / f64::sqrt(squares / count)
    }

    /// Some iterations on grid `l`.
    fn iterate(&mut self, l: usize, displacement: Freshness, goal: &Goal, monitor: &mut Monitor<'_>) -> Result<End> {
        let iterations = if l + 1 == self.grids.len() { COARSEST_ITERATIONS } else { COARSE_ITERATIONS };
        let stop = Stopping { tolerance: goal.tolerance, by_update: false, fixed: false, iterations };
        let Coarse { level, state, .. } = &mut self.grids[l];
        let end = level.run(state, displacement, &stop, NonNegative, self.finest, monitor)?;
        level.take_displacements(state);
        Ok(end)
    }

    /// The state finer than grid `l`, and grid `l`.
    fn pair<'a>(&'a mut self, l: usize, finest: &'a mut State) -> (&'a mut State, &'a mut Coarse) {
        let (finer, coarser) = self.grids.split_at_mut(l);
        (finer.last_mut().map_or(finest, |grid| &mut grid.state), &mut coarser[0])
    }
}

/// The pressures of the coarser grid, piecewise constant (what smoother interpolation would add the preconditioner kills), its
/// contact area, and its displacements, linearly interpolated. Elements above `highest` are out of reach.
fn prolong(coarse: &State, fine: &mut State, highest: f64) {
    let (from, to) = (coarse.grid, fine.grid);
    transfer::interpolate(&to, &from, |i| coarse.p[i], &mut fine.p, |to, value| *to = value);
    transfer::interpolate_linearly(&to, &from, |i| coarse.u[i], &mut fine.u, |to, value| *to = value);
    fine.approach = coarse.approach;
    for ((p, inside), h) in fine.p.iter_mut().zip(&mut fine.contact).zip(&fine.h) {
        if h.is_infinite() || *h > highest {
            *p = 0.0;
        }
        *inside = *p > 0.0;
    }
}
