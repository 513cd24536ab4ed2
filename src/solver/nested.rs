//! The full multigrid scheme FMG (section 4.3 of the paper): nested iteration over the grids, coarsest first. Each grid is solved by the loop
//! (`iterate`), from the interpolated solution of the next coarser one.

use super::best::Best;
use super::iterate::iterate;
use crate::contact::{lowest, AdmissibleSet, NonNegative, Problem, State};
use crate::error::Result;
use crate::methods::multigrid::{transfer, CycleShape, Cycles, Multigrid, Workspace};
use crate::methods::norm::Norm;
use crate::methods::Task;
use crate::progress::{Goal, Monitor, Outcome};
use crate::scene::Load;
use crate::threads::Threads;

/// Most cycles on each coarser grid, as its solution only serves as a start of the next finer one.
const COARSE_CYCLES: u64 = 30;
/// Iterations of NORM allowed on the coarsest grid, or `max_cycles` if that is more.
const COARSEST_ITERATIONS: u64 = 1000;

/// The grids of the multigrid methods, and problem and unknowns of the coarser ones.
pub struct FullMultigrid {
    multigrid: Multigrid,
    workspace: Workspace,
    /// Problem and unknowns of each coarser grid, finest first.
    coarser: Vec<(Problem, State)>,
    /// The best iterate on a coarser grid.
    best: Best,
}

impl FullMultigrid {
    /// Sets up the grid of `problem` and the grids coarser than it.
    pub fn new(problem: &mut Problem, shape: CycleShape) -> Result<FullMultigrid> {
        let multigrid = Multigrid::new(problem, shape)?;
        let mut coarser = Vec::new();
        for level in &multigrid.levels[1..] {
            let (operator, work) = (level.operator.clone(), level.work);
            let threads = &problem.threads;
            let coarse = Problem::with_operator(level.grid, level.coefficients.clone(), operator, work, threads)?;
            coarser.push((coarse, State::new(level.grid, (Load::Approach(0.0), 0.0), threads)?));
        }
        Ok(FullMultigrid { multigrid, workspace: Workspace::default(), coarser, best: Best::default() })
    }

    /// The method of V-cycles that begin on grid number `level`; 0 is the finest.
    pub fn cycles(&mut self, level: usize) -> Cycles<'_> {
        Cycles { multigrid: &mut self.multigrid, level, workspace: &mut self.workspace }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let coarser: usize = self.coarser.iter().map(|(problem, state)| problem.bytes() + state.bytes()).sum();
        self.multigrid.bytes() + coarser
    }

    /// Makes a start without a guess for the finest grid: solves the coarser grids, coarsest first, each from the pressures of the one before.
    pub fn start<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>, norm: &mut Norm) -> Result<()> {
        let count = self.coarser.len();
        if count == 0 {
            task.state.start(task.problem.self_influence());
            return Ok(());
        }
        let highest = task.state.out_of_reach(task.lowest, task.problem.self_influence());
        self.restrict(task.state, highest);
        // A cancelled solve only interpolates to the finest grid.
        for l in (0..count).rev() {
            if !task.monitor.is_cancelled() {
                task.monitor.enter_grid();
                self.solve(l, &task.goal, norm, task.monitor)?;
                task.monitor.close_grid(&self.coarser[l].1);
            }
            let (finer, coarser) = self.coarser.split_at_mut(l);
            let from = &coarser[0].1;
            match finer.last_mut() {
                Some((problem, state)) => {
                    interpolate(from, state, highest);
                    problem.refresh(state, NonNegative)?;
                }
                None => {
                    interpolate(from, task.state, highest);
                    task.state.project(task.set);
                    task.problem.refresh(task.state, task.set)?;
                }
            }
        }
        task.monitor.enter_grid();
        task.count_products();
        Ok(())
    }

    /// Restricts the undeformed distance and the load to all coarser grids, and sets p = 0 there. Distances above `highest` count as `highest`.
    fn restrict(&mut self, fine: &State, highest: f64) {
        for l in 0..self.coarser.len() {
            let (finer, coarser) = self.coarser.split_at_mut(l);
            let (from, to) = (finer.last().map_or(fine, |(_, state)| state), &mut coarser[0].1);
            transfer::restrict_distance(&from.grid, &to.grid, &from.h, highest, &mut to.h, &Threads::One);
            (to.load, to.approach) = (from.load, from.approach);
            to.unload();
        }
    }

    /// Solves the coarser grid l: the coarsest by NORM from step 1 of the paper, the others by V-cycles from their state. If the solve does not
    /// converge, the next finer grid has a worse start, which is no error.
    fn solve(&mut self, l: usize, goal: &Goal, norm: &mut Norm, monitor: &mut Monitor<'_>) -> Result<()> {
        let FullMultigrid { multigrid, workspace, coarser, best } = self;
        let coarsest = l + 1 == coarser.len();
        let (problem, state) = &mut coarser[l];
        best.forget();
        let cycles =
            if coarsest { goal.max_cycles.max(COARSEST_ITERATIONS) } else { goal.max_cycles.min(COARSE_CYCLES) };
        let goal = Goal { max_cycles: cycles, ..*goal };
        let lowest = lowest(&state.h);
        let mut task = Task { problem, state, lowest, set: NonNegative, goal, monitor };
        let outcome = if coarsest {
            task.state.start(task.problem.self_influence());
            iterate(norm, &mut task, best)?
        } else {
            iterate(&mut Cycles { multigrid, level: l + 1, workspace }, &mut task, best)?
        };
        if outcome != Outcome::Converged {
            best.restore(&mut task)?;
        }
        Ok(())
    }
}

/// Interpolates p and u from the coarser grid as piecewise constants. C becomes the elements with p > 0 or e < 0. Elements with h above `highest` are
/// out of reach of any contact: p = 0 there.
fn interpolate(coarse: &State, fine: &mut State, highest: f64) {
    let (coarse_grid, fine_grid) = (coarse.grid, fine.grid);
    transfer::interpolate(&fine_grid, &coarse_grid, &coarse.p, &mut fine.p, |to, value| *to = value);
    transfer::interpolate(&fine_grid, &coarse_grid, &coarse.u, &mut fine.u, |to, value| *to = value);
    fine.approach = coarse.approach;
    for i in 0..fine.p.len() {
        if fine.h[i].is_infinite() || fine.h[i] > highest {
            fine.p[i] = 0.0;
        }
        fine.contact[i] = fine.p[i] > 0.0 || fine.deformed_distance(i) < 0.0;
    }
}
