//! How a scene is solved: the options, the methods, the report.
//!
//! A [`Solver`] is set up once for a grid and a pair of bodies (operators, transforms, grids) and then solves any number of
//! undeformed distances and loads on it. [`solve`] does both in one call.

mod full_multigrid;
mod monitor;
mod multigrid_method;
mod norm_method;
mod options;
mod report;

use std::time::Instant;

pub use monitor::{Progress, ProgressCallback};
pub use options::{ActiveSet, Criterion, InitialGuess, Method, Options, Precision};
pub use report::{DiscretisationError, LedgerRow, Measures, Report, Stop};

use crate::active_set::{truncate, State};
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::influence::Influence;
use crate::multigrid::{transfer, CycleShape, Multigrid};
use crate::scene::{Bodies, Load, Scene};
use crate::threads::Threads;
use monitor::{Monitor, Rule};
use norm_method::Displace;

/// Pressures and contact area to start from.
#[derive(Clone, Copy, Debug)]
pub struct Guess<'a> {
    /// Pressures, `[my][mx]`; negative ones and those outside the contact area count as 0 (with a free contact area).
    pub pressure: &'a [f64],
    /// Contact area.
    pub contact: &'a [bool],
}

/// Operators and grids for many solves on one grid and one pair of bodies. One thread at a time.
pub struct Solver {
    grid: Grid,
    bodies: Bodies,
    has_own_influence: bool,
    symmetric: bool,
    shape: CycleShape,
    threads: usize,
    multigrid: Multigrid,
    /// One per grid, finest first.
    states: Vec<State>,
    solved_before: bool,
    setup_seconds: f64,
}

/// Solves one scene.
pub fn solve(scene: &Scene<'_>, options: &Options) -> Result<(Solver, Stop, Report)> {
    let mut solver = Solver::new(scene, options)?;
    let (stop, report) = solver.solve(scene, options, None, None)?;
    Ok((solver, stop, report))
}

impl Solver {
    /// Sets up operators and grids; of `scene` the grid, the bodies and the influence coefficients matter.
    pub fn new(scene: &Scene<'_>, options: &Options) -> Result<Solver> {
        let began = Instant::now();
        scene.check()?;
        options.check()?;
        let threads = Threads::new(options.threads)?;
        let influence = scene.influence();
        let shape = options.cycle_shape();
        let multigrid = Multigrid::new(&scene.grid, &influence, shape, &threads)?;
        let states = multigrid
            .hierarchy
            .levels
            .iter()
            .map(|level| State::new(level.grid, vec![0.0; level.grid.len()], scene.load, 0.0))
            .collect::<Result<Vec<_>>>()?;
        Ok(Solver {
            grid: scene.grid,
            bodies: scene.bodies,
            has_own_influence: scene.influence.is_some(),
            symmetric: influence.is_symmetric(&scene.grid),
            shape,
            threads: options.threads,
            multigrid,
            states,
            solved_before: false,
            setup_seconds: began.elapsed().as_secs_f64(),
        })
    }

    /// Solves for the undeformed distance and the load of `scene`; the rest of it must be as at the set-up.
    pub fn solve(
        &mut self,
        scene: &Scene<'_>,
        options: &Options,
        guess: Option<Guess<'_>>,
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<(Stop, Report)> {
        self.check(scene, options)?;
        let mut monitor = Monitor::new(progress, Vec::with_capacity(self.states.len()));
        let rule = Rule {
            tolerance: options.tolerance,
            by_update: options.criterion == Criterion::Update,
            fixed: options.active_set == ActiveSet::Fixed,
            max_cycles: options.max_cycles as u64,
        };
        let has_start = self.start(scene, options, guess)?;
        let stop = if self.without_contact(scene.load, rule.fixed) {
            Stop::Converged
        } else {
            self.run(options, &rule, has_start, &mut monitor)?
        };
        self.solved_before = true;
        monitor.close_grid(&self.states[0]);
        let mut report = monitor.report();
        report.setup_seconds = std::mem::take(&mut self.setup_seconds);
        report.bytes = (self.multigrid.bytes() + self.states.iter().map(|s| s.p.len() * 25).sum::<usize>()) as u64;
        Ok((stop, report))
    }

    /// The result: pressures, displacements, contact area and approach.
    pub fn state(&self) -> &State {
        &self.states[0]
    }

    /// The influence coefficients in use.
    pub fn influence(&self) -> &Influence {
        &self.multigrid.hierarchy.levels[0].influence
    }

    /// Whether the coefficients were given with the set-up: then those of later scenes, and their bodies, do not matter.
    pub fn has_own_influence(&self) -> bool {
        self.has_own_influence
    }

    fn check(&self, scene: &Scene<'_>, options: &Options) -> Result<()> {
        scene.check_distance_and_load()?;
        options.check()?;
        if scene.grid != self.grid {
            return invalid(format!("the grid is {:?}; this solver was set up for {:?}", scene.grid, self.grid));
        }
        // Own coefficients know no bodies.
        if !self.has_own_influence && scene.bodies != self.bodies {
            return invalid(format!("the bodies are {:?}; this solver was set up for {:?}", scene.bodies, self.bodies));
        }
        if scene.influence.is_some() && !self.has_own_influence {
            return invalid("influence is given, but this solver was set up for the half-space".into());
        }
        if options.cycle_shape() != self.shape || options.threads != self.threads {
            return invalid("smoother, sweeps, relaxation, coarsest and threads must be those the solver was set up with".into());
        }
        Ok(())
    }

    /// Takes over the undeformed distance, the load and the initial guess; whether there is one.
    fn start(&mut self, scene: &Scene<'_>, options: &Options, guess: Option<Guess<'_>>) -> Result<bool> {
        let fixed = options.active_set == ActiveSet::Fixed;
        let state = &mut self.states[0];
        let has_guess = match (options.initial_guess, guess) {
            (InitialGuess::Previous, Some(guess)) if fixed => {
                check_guess(guess, &state.grid)?;
                if !self.solved_before {
                    state.p.fill(0.0);
                }
                state.contact.copy_from_slice(guess.contact);
                true
            }
            (InitialGuess::Previous, _) => self.solved_before,
            (InitialGuess::Given, Some(guess)) => {
                check_guess(guess, &state.grid)?;
                state.p.copy_from_slice(guess.pressure);
                state.contact.copy_from_slice(guess.contact);
                true
            }
            (InitialGuess::Given, None) => return invalid("initial_guess is GIVEN, but no pressures and contact area are".into()),
            (InitialGuess::None, Some(guess)) if fixed => {
                check_guess(guess, &state.grid)?;
                state.p.fill(0.0);
                state.contact.copy_from_slice(guess.contact);
                true
            }
            (InitialGuess::None, _) => false,
        };
        if fixed && !has_guess {
            return invalid("active_set is FIXED, but no contact area is given".into());
        }

        for l in 0..self.states.len() {
            let (finer, coarser) = self.states.split_at_mut(l);
            match finer.last() {
                None => coarser[0].h.copy_from_slice(scene.undeformed_distance),
                Some(fine) => transfer::restrict_distance(&fine.grid, &coarser[0].grid, &fine.h, &mut coarser[0].h),
            }
            coarser[0].load = scene.load;
            if let Load::Approach(approach) = scene.load {
                coarser[0].approach = approach;
            }
            if l > 0 || !has_guess {
                coarser[0].p.fill(0.0);
                coarser[0].u.fill(0.0);
                coarser[0].contact.fill(false);
            }
        }

        let state = &mut self.states[0];
        if !has_guess {
            state.start(self.multigrid.hierarchy.levels[0].influence.at(0, 0));
            return Ok(false);
        }
        for i in 0..state.p.len() {
            state.contact[i] &= state.h[i].is_finite();
            if !state.contact[i] || (!fixed && state.p[i] < 0.0) {
                state.p[i] = 0.0;
            }
        }
        if state.contact_count() == 0 {
            if fixed {
                return invalid("active_set is FIXED, but the given contact area is empty".into());
            }
            state.start(self.multigrid.hierarchy.levels[0].influence.at(0, 0));
            return Ok(false);
        }
        state.balance_force();
        self.multigrid.displace(0, &state.p, &mut state.u);
        state.fit_approach();
        Ok(true)
    }

    /// Whether nothing touches: no force, or no element penetrated by the approach. Then p = 0 solves the problem.
    fn without_contact(&mut self, load: Load, fixed: bool) -> bool {
        let state = &mut self.states[0];
        let lowest = state.h.iter().copied().fold(f64::INFINITY, f64::min);
        let nothing = match load {
            Load::Approach(approach) => !fixed && lowest > approach,
            Load::Force(force) => force == 0.0,
        };
        if nothing {
            state.p.fill(0.0);
            state.u.fill(0.0);
            state.contact.fill(false);
            if let Load::Force(_) = load {
                state.approach = if lowest.is_finite() { lowest } else { 0.0 };
            }
        }
        nothing
    }

    fn run(&mut self, options: &Options, rule: &Rule, has_start: bool, monitor: &mut Monitor<'_>) -> Result<Stop> {
        let products = self.multigrid.take_products();
        monitor.count_products(products[0], 1.0);
        let (multigrid, states) = (&mut self.multigrid, &mut self.states);
        let nested = !has_start && !rule.fixed;
        match options.method {
            Method::Norm => self.norm(rule, monitor),
            Method::Multigrid => Ok(multigrid_method::solve(multigrid, 0, &mut states[0], rule, monitor)),
            Method::FullMultigrid | Method::Auto => {
                let stop = if nested {
                    full_multigrid::solve(multigrid, states, rule, options.error_ratio, monitor)?
                } else {
                    multigrid_method::solve(multigrid, 0, &mut states[0], rule, monitor)
                };
                if stop != Stop::Stagnated || options.method == Method::FullMultigrid {
                    return Ok(stop);
                }
                log::info!("the V-cycle stagnated on this scene; NORM takes over");
                if !rule.fixed {
                    truncate(&mut self.states[0]);
                }
                self.norm(rule, monitor)
            }
        }
    }

    fn norm(&mut self, rule: &Rule, monitor: &mut Monitor<'_>) -> Result<Stop> {
        let (multigrid, state) = (&mut self.multigrid, &mut self.states[0]);
        let mut displace = |p: &[f64], u: &mut [f64]| multigrid.displace(0, p, u);
        let by = Displace { product: &mut displace, work: 1.0, symmetric: self.symmetric };
        let stop = norm_method::solve(state, by, rule, monitor)?;
        multigrid.take_products();
        Ok(stop)
    }
}

fn check_guess(guess: Guess<'_>, grid: &Grid) -> Result<()> {
    if guess.pressure.len() != grid.len() || guess.contact.len() != grid.len() {
        return invalid(format!("the initial guess has {} pressures and {} contact elements; the grid has {} elements",
            guess.pressure.len(), guess.contact.len(), grid.len()));
    }
    match guess.pressure.iter().find(|p| !p.is_finite()) {
        Some(p) => Err(crate::error::Error::NotFinite(format!("pressure, the initial guess, holds {p}; it must be finite"))),
        None => Ok(()),
    }
}
