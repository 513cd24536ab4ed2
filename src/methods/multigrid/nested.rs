//! The FMG scheme (section 4.3 of the paper): nested iteration over the grids, coarsest first.

use super::step as multigrid_method;
use crate::contact::State;
use crate::error::Result;
use crate::methods::descent as descent_method;
use crate::methods::multigrid::{transfer, Multigrid};
use crate::methods::norm::step::{self as norm_method, Displace};
use crate::progress::{Monitor, Rule};
use crate::solver::Stop;

/// Cycles at most on the coarser grids: they only prepare the next finer one.
const COARSE_CYCLES: u64 = 30;

/// Memory of the methods, kept from one solve to the next; none before a method asks for it.
#[derive(Default)]
pub struct Workspace {
    /// NORM's.
    pub norm: norm_method::Workspace,
    /// That of projected descent.
    pub descent: descent_method::Workspace,
    /// That of cycles in an active-set loop.
    pub cycles: multigrid_method::Workspace,
}

/// Solves on all grids; `states[0]` is the finest. `error_ratio` as in the options.
pub fn solve(
    multigrid: &mut Multigrid,
    states: &mut [State],
    rule: &Rule,
    error_ratio: f64,
    workspace: &mut Workspace,
    monitor: &mut Monitor<'_>,
) -> Result<Stop> {
    let coarsest = states.len() - 1;
    let highest = states[0].out_of_reach(multigrid.hierarchy.levels[0].influence.at(0, 0));
    let within = |h: f64| if h.is_finite() { h.min(highest) } else { h };
    let coarse_rule = Rule { max_cycles: rule.max_cycles.min(COARSE_CYCLES), ..*rule };

    for l in 1..states.len() {
        let (finer, coarser) = states.split_at_mut(l);
        let (fine, coarse) = (&finer[l - 1], &mut coarser[0]);
        transfer::restrict_distance(&fine.grid, &coarse.grid, |i| within(fine.h[i]), &mut coarse.h);
        (coarse.load, coarse.approach) = (fine.load, fine.approach);
        coarse.p.fill(0.0);
        coarse.u.fill(0.0);
    }

    // The coarsest grid, by NORM.
    monitor.enter_grid();
    let level = &multigrid.hierarchy.levels[coarsest];
    let (symmetric, work) = (level.influence.is_symmetric(&level.grid), multigrid.hierarchy.work(coarsest));
    states[coarsest].start(level.influence.at(0, 0));
    let mut displace = |p: &[f64], u: &mut [f64]| multigrid.displace(coarsest, p, u);
    let norm_rule = if coarsest == 0 { *rule } else { Rule { max_cycles: rule.max_cycles.max(1000), ..*rule } };
    let by = Displace { product: &mut displace, work, symmetric };
    let mut stop = norm_method::solve(&mut states[coarsest], by, &norm_rule, &mut workspace.norm, monitor)?;
    multigrid.take_products(coarsest);

    // Each finer grid, from the pressures of the coarser one.
    for l in (0..coarsest).rev() {
        let cancelled = stop == Stop::Cancelled;
        if !cancelled {
            monitor.close_grid(&states[l + 1]);
            monitor.enter_grid();
        }
        let (finer, coarser) = states.split_at_mut(l + 1);
        let state = &mut finer[l];
        interpolate(&coarser[0], state, highest);
        state.balance_force();
        multigrid.displace(l, &state.p, &mut state.u);
        state.fit_approach();
        if cancelled {
            continue; // what the coarser grids found is the best iterate there is
        }
        let mut level_rule = if l == 0 { *rule } else { coarse_rule };
        if l == 0 && error_ratio > 0.0 {
            level_rule.tolerance = level_rule.tolerance.max(error_ratio * discretisation_error(monitor, state));
            monitor.tolerance = level_rule.tolerance;
        }
        stop = multigrid_method::solve(multigrid, l, state, &level_rule, &mut workspace.cycles, monitor);
    }
    Ok(stop)
}

/// p and u of the coarser grid, piecewise constant; contact where p > 0 or e <= 0. Elements above `highest` are out of reach.
fn interpolate(coarse: &State, fine: &mut State, highest: f64) {
    let (coarse_grid, fine_grid) = (coarse.grid, fine.grid);
    transfer::interpolate(&fine_grid, &coarse_grid, |i| coarse.p[i], &mut fine.p, |to, value| *to = value);
    transfer::interpolate(&fine_grid, &coarse_grid, |i| coarse.u[i], &mut fine.u, |to, value| *to = value);
    fine.approach = coarse.approach;
    for i in 0..fine.p.len() {
        if fine.h[i].is_infinite() || fine.h[i] > highest {
            fine.p[i] = 0.0;
        }
        fine.contact[i] = fine.p[i] > 0.0 || fine.deformed_distance(i) <= 0.0;
    }
}

/// Relative discretisation error of the force, or of the approach if the force is prescribed, as the step between the last two
/// coarser grids suggests it for this one: their step is 3/4 of the coarser one's error, which falls by 4 with every grid.
fn discretisation_error(monitor: &Monitor<'_>, state: &State) -> f64 {
    let [.., before, last] = monitor.ledger() else { return 0.0 };
    let (before, last) = (before.measures.found(state.load), last.measures.found(state.load));
    let relative = ((before - last) / last).abs() / 12.0;
    if relative.is_finite() {
        relative
    } else {
        0.0
    }
}
