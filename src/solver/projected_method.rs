//! The production method: nested iteration (section 4.3 of the paper) with projected conjugate gradients on every grid.
//!
//! On each coarser grid a few iterations; on the finest one as many as the tolerance asks for, on the window around the contact area
//! and in single precision directions; then u = A p on the full grid, in double precision: the certificate. If it does not
//! hold, the iteration goes on from there.

use super::full_multigrid::discretisation_error;
use super::monitor::{Monitor, Rule};
use super::options::Precision;
use super::report::Stop;
use crate::active_set::{admit, certify, norm_of_distance, residual_norm, State};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Influence;
use crate::multigrid::{coarsen, transfer};
use crate::operator::{zeros, Toeplitz, Workspace};
use crate::projected_cg::{Cycle, End, Iteration, Stopping, Window};
use crate::threads::Threads;

/// The nested iteration starts on a grid of at most this many elements in each direction.
const COARSEST: usize = 8;
/// Iterations on the coarsest grid, and on those between it and the finest.
const COARSEST_ITERATIONS: u64 = 50;
const COARSE_ITERATIONS: u64 = 4;
/// The iteration aims at this part of the tolerance, so that the rounding of its single precision products does not fail the
/// certificate.
const AIM: f64 = 0.5;
/// Rounds without progress after which round-off is reached, or the method does not work on this scene.
const PATIENCE: u32 = 3;

/// The iteration of one grid, in the precision asked for.
enum Inner {
    Single(Iteration<f32>),
    Double(Iteration<f64>),
}

impl Inner {
    fn new(influence: &Influence, grid: &Grid, precision: Precision, threads: &Threads) -> Result<Inner> {
        Ok(match precision {
            Precision::Double => Inner::Double(Iteration::new(influence, grid, threads)?),
            Precision::Auto | Precision::Mixed => Inner::Single(Iteration::new(influence, grid, threads)?),
        })
    }

    fn displace(&mut self, state: &mut State) {
        match self {
            Inner::Single(iteration) => iteration.displace(state),
            Inner::Double(iteration) => iteration.displace(state),
        }
    }

    /// Iterates; `work` is that of one product.
    fn run(&mut self, state: &mut State, stop: &Stopping, work: f64, monitor: &mut Monitor<'_>) -> End {
        let grid = state.grid;
        let after_cycle = |cycle: &Cycle| {
            monitor.count_products(cycle.products, work);
            monitor.active_set_steps += 1;
            monitor.cycle_done(&grid, cycle.changes, cycle.update, cycle.residual)
        };
        match self {
            Inner::Single(iteration) => iteration.run(state, stop, after_cycle),
            Inner::Double(iteration) => iteration.run(state, stop, after_cycle),
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Inner::Single(iteration) => iteration.bytes(),
            Inner::Double(iteration) => iteration.bytes(),
        }
    }
}

/// One coarser grid.
struct Coarse {
    inner: Inner,
    state: State,
    /// The influence of an element on itself.
    self_influence: f64,
}

/// The iteration on a window of the finest grid.
struct Windowed {
    window: Window,
    inner: Inner,
    /// The window's part of the state; none when the window is the whole grid.
    part: Option<State>,
}

/// The method's operators, set up once.
pub struct Projected {
    grid: Grid,
    influence: Influence,
    /// In double precision, on the full grid: for certificates.
    operator: Toeplitz<f64>,
    workspace: Workspace<f64>,
    /// Coarser grids, the coarsest last; none before the first cold start.
    coarse: Vec<Coarse>,
    finest: Option<Windowed>,
    /// Whether the next window is chosen without regard to the one there is.
    choose_anew: bool,
    /// With criterion UPDATE: p before the last round.
    before: Vec<f64>,
    precision: Precision,
    threads: Threads,
}

impl Projected {
    /// Sets up the full-grid operator; the rest follows when it is first needed.
    pub fn new(grid: &Grid, influence: &Influence, precision: Precision, threads: &Threads) -> Result<Projected> {
        let operator = Toeplitz::new(influence, grid, threads)?;
        Ok(Projected {
            grid: *grid,
            influence: influence.clone(),
            workspace: operator.workspace()?,
            operator,
            coarse: Vec::new(),
            finest: None,
            choose_anew: true,
            before: Vec::new(),
            precision,
            threads: threads.clone(),
        })
    }

    /// The influence coefficients.
    pub fn influence(&self) -> &Influence {
        &self.influence
    }

    /// The next solve chooses its window by itself, so that its result does not depend, in the last bits, on the solve before.
    pub fn forget_window(&mut self) {
        self.choose_anew = true;
    }

    /// `u = A p` on the full grid, in double precision.
    pub fn displace(&mut self, p: &[f64], u: &mut [f64]) {
        self.operator.apply(p, u, &mut self.workspace);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let of_state = |state: &State| state.p.len() * 25;
        let coarse: usize = self.coarse.iter().map(|level| level.inner.bytes() + of_state(&level.state)).sum();
        let finest = self.finest.as_ref().map_or(0, |w| w.inner.bytes() + w.part.as_ref().map_or(0, of_state));
        self.operator.bytes() + self.workspace.bytes() + coarse + finest + self.before.len() * size_of::<f64>()
    }

    /// Solves from `state`: from its pressures and contact area if `has_start` (then its u must be A p), or else from nothing.
    /// `error_ratio` is that of the options; it needs the coarser grids of a start from nothing.
    pub fn solve(
        &mut self,
        state: &mut State,
        rule: &Rule,
        has_start: bool,
        error_ratio: f64,
        monitor: &mut Monitor<'_>,
    ) -> Result<Stop> {
        let mut u_is_known = has_start;
        if !has_start && self.nested_start(state, rule, monitor)? == Stop::Cancelled {
            state.balance_force();
            self.certify(state, rule, monitor);
            return Ok(Stop::Cancelled);
        }
        let mut rule = *rule;
        if !has_start && error_ratio > 0.0 {
            rule.tolerance = rule.tolerance.max(error_ratio * discretisation_error(monitor, state));
        }
        let rule = &rule;
        let (mut best, mut rounds_without_progress) = (f64::INFINITY, 0);
        loop {
            if rule.by_update {
                self.before.clone_from(&state.p);
            }
            let end = self.iterate(state, rule, u_is_known, monitor)?;
            let certified = self.certify(state, rule, monitor);
            // A small last update proves nothing while u was of single precision, or pressures were owed: then all that
            // is done from a fresh u must come to no more than a small update.
            let settled = !rule.by_update || u_is_known && rule.holds(state, rms_change(state, &self.before));
            u_is_known = true;
            if certified.holds && settled {
                return Ok(Stop::Converged);
            }
            match end {
                End::Cancelled => return Ok(Stop::Cancelled),
                End::Limit if monitor.cycles >= rule.max_cycles => return Ok(Stop::IterationLimit),
                _ => {}
            }
            rounds_without_progress += 1;
            if certified.violation < 0.5 * best {
                best = certified.violation;
                rounds_without_progress = 0;
            }
            if rounds_without_progress == PATIENCE {
                return Ok(Stop::Stagnated);
            }
        }
    }

    /// Nested iteration up to the finest grid, whose state gets the pressures of the next coarser one.
    fn nested_start(&mut self, state: &mut State, rule: &Rule, monitor: &mut Monitor<'_>) -> Result<Stop> {
        self.set_up_coarse_grids(state)?;
        let count = self.coarse.len();
        for l in 0..count {
            let (finer, coarser) = self.coarse.split_at_mut(l);
            let fine = finer.last().map_or(&*state, |level| &level.state);
            let (fine_grid, to) = (fine.grid, &mut coarser[0].state);
            transfer::restrict_distance(&fine_grid, &to.grid, &fine.h, &mut to.h);
            (to.load, to.approach) = (state.load, state.approach);
        }
        if count == 0 {
            state.start(self.influence.at(0, 0));
            return Ok(Stop::Converged);
        }
        for l in (0..count).rev() {
            let work = self.coarse[l].state.grid.len() as f64 / self.grid.len() as f64;
            let (finer, coarser) = self.coarse.split_at_mut(l + 1);
            let Coarse { inner, state: on_grid, self_influence } = &mut finer[l];
            monitor.enter_grid();
            let iterations = match coarser.first() {
                None => {
                    on_grid.p.fill(0.0);
                    on_grid.start(*self_influence);
                    COARSEST_ITERATIONS
                }
                Some(coarse) => {
                    prolong(&coarse.state, on_grid);
                    COARSE_ITERATIONS
                }
            };
            on_grid.balance_force();
            inner.displace(on_grid);
            monitor.count_products(1, work);
            let stop = Stopping { tolerance: rule.tolerance, by_update: false, fixed: false, iterations };
            if inner.run(on_grid, &stop, work, monitor) == End::Cancelled {
                for finer_grid in (0..l).rev() {
                    let (finer, coarser) = self.coarse.split_at_mut(finer_grid + 1);
                    prolong(&coarser[0].state, &mut finer[finer_grid].state);
                }
                prolong(&self.coarse[0].state, state);
                return Ok(Stop::Cancelled);
            }
            monitor.close_grid(on_grid);
        }
        prolong(&self.coarse[0].state, state);
        monitor.enter_grid();
        Ok(Stop::Converged)
    }

    fn set_up_coarse_grids(&mut self, state: &State) -> Result<()> {
        if !self.coarse.is_empty() {
            return Ok(());
        }
        let (mut grid, mut influence) = (self.grid, self.influence.clone());
        while let Some(coarse) = coarsen(&grid, COARSEST) {
            influence = influence.coarsen(&grid, &coarse);
            grid = coarse;
            self.coarse.push(Coarse {
                inner: Inner::new(&influence, &grid, self.precision, &self.threads)?,
                state: State::new(grid, zeros(grid.len(), "undeformed distances")?, state.load, state.approach)?,
                self_influence: influence.at(0, 0),
            });
        }
        Ok(())
    }

    /// Iterates on the window around the contact area.
    fn iterate(&mut self, state: &mut State, rule: &Rule, u_is_known: bool, monitor: &mut Monitor<'_>) -> Result<End> {
        state.balance_force();
        let current = self.finest.as_ref().map(|finest| &finest.window).filter(|_| !self.choose_anew);
        let window = Window::around(state, current);
        self.choose_anew = false;
        let grid = window.grid(&self.grid);
        // The operator of a window depends on its size only.
        if let Some(finest) = self.finest.as_mut().filter(|finest| finest.window.grid(&self.grid) == grid) {
            finest.window = window;
        } else {
            let inner = Inner::new(&self.influence, &grid, self.precision, &self.threads)?;
            let part = if window.is_full(&self.grid) {
                None
            } else {
                Some(State::new(grid, zeros(grid.len(), "undeformed distances")?, state.load, state.approach)?)
            };
            self.finest = Some(Windowed { window, inner, part });
        }
        let Some(Windowed { window, inner, part }) = &mut self.finest else {
            return Ok(End::Breakdown); // just made
        };
        let work = window.grid(&self.grid).len() as f64 / self.grid.len() as f64;
        let stop = Stopping {
            tolerance: if rule.by_update { rule.tolerance } else { AIM * rule.tolerance },
            by_update: rule.by_update,
            fixed: rule.fixed,
            iterations: rule.max_cycles.saturating_sub(monitor.cycles),
        };
        let Some(part) = part else {
            if !u_is_known {
                inner.displace(state);
                monitor.count_products(1, work);
            }
            return Ok(inner.run(state, &stop, work, monitor));
        };
        window.extract(&self.grid, &state.h, &mut part.h);
        window.extract(&self.grid, &state.p, &mut part.p);
        window.extract(&self.grid, &state.contact, &mut part.contact);
        (part.load, part.approach) = (state.load, state.approach);
        if u_is_known {
            window.extract(&self.grid, &state.u, &mut part.u);
        } else {
            inner.displace(part);
            monitor.count_products(1, work);
        }
        let end = inner.run(part, &stop, work, monitor);
        window.insert(&self.grid, &part.p, &mut state.p, 0.0);
        window.insert(&self.grid, &part.contact, &mut state.contact, false);
        state.approach = part.approach;
        Ok(end)
    }

    /// u = A p anew, on the full grid and in double precision, and whether the conditions hold. Elements outside C that penetrate
    /// enter it.
    fn certify(&mut self, state: &mut State, rule: &Rule, monitor: &mut Monitor<'_>) -> Certified {
        state.balance_force();
        self.operator.apply(&state.p, &mut state.u, &mut self.workspace);
        monitor.count_products(1, 1.0);
        state.fit_approach();
        let h = norm_of_distance(state);
        let scale = h / (state.contact_count().max(1) as f64).sqrt();
        let penetration = certify(state).penetration;
        let negligible = penetration <= rule.tolerance * scale;
        let entered = if rule.fixed || negligible && penetration == 0.0 { 0 } else { admit(state) };
        let residual = residual_norm(state);
        let holds = rule.holds(state, monitor.update) && (entered == 0 || negligible);
        let violation = (residual / h).max(penetration / scale);
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

/// The pressures of the coarser grid, piecewise constant (injection: what smoother interpolation would add the preconditioner kills),
/// and its contact area.
fn prolong(coarse: &State, fine: &mut State) {
    let (from, to) = (coarse.grid, fine.grid);
    transfer::interpolate(&to, &from, &coarse.p, &mut fine.p, |to, value| *to = value);
    fine.approach = coarse.approach;
    for ((p, inside), h) in fine.p.iter_mut().zip(&mut fine.contact).zip(&fine.h) {
        if h.is_infinite() {
            *p = 0.0;
        }
        *inside = *p > 0.0;
    }
}
