//! How a scene is solved: the options, the methods, the report.
//!
//! A [`Solver`] is set up once for a grid and a pair of bodies (operators, transforms, grids) and then solves any number of
//! undeformed distances and loads on it, one by one or as a [batch](Solver::solve_batch). [`solve`] does both in one call.

mod accuracy;
mod batch;
pub(crate) mod estimates;
mod limited;
mod options;
mod report;
pub(crate) mod start;

use std::time::Instant;

pub use crate::progress::{Progress, ProgressCallback};
pub use accuracy::{solve_to_accuracy, Accuracy, Outcome, SurfaceCallback};
pub use batch::Problem;
pub use options::{ActiveSet, Criterion, InitialGuess, Method, Options, Precision};
pub use report::{DiscretisationError, Halving, LedgerRow, Limit, Measures, Report, Stop};

use crate::contact::State;
use crate::error::{invalid, Error, Result};
use crate::grid::Grid;
use crate::influence::Influence;
use crate::methods::descent as descent_method;
use crate::methods::multigrid::{nested as full_multigrid, step as multigrid_method};
use crate::methods::multigrid::{CycleShape, Multigrid};
use crate::methods::norm::step::{self as norm_method, Displace};
use crate::methods::projected_cg::Projected;
use crate::operator::zeros;
use crate::progress::{Monitor, Rule};
use crate::scene::{Bodies, Layer, Load, Period, Scene};
use crate::threads::Threads;
use start::Start;

/// Pressures and contact area to start from.
#[derive(Clone, Copy, Debug)]
pub struct Guess<'a> {
    /// Pressures, `[my][mx]`; negative ones and those outside the contact area count as 0 (with a free contact area).
    pub pressure: &'a [f64],
    /// Contact area.
    pub contact: &'a [bool],
}

/// Operators and grids for many solves on one grid and one pair of bodies. One thread at a time.
///
/// A solve from nothing or from a given guess has the same result, to the last bit, whatever was solved before. After a first
/// solve, further ones by the same method and from the same kind of start allocate no memory (with one thread), but for one
/// thing: PROJECTED_CG (and AUTO) work on a window around the contact area, whose operator is set up anew when its size
/// changes.
pub struct Solver {
    grid: Grid,
    bodies: Bodies,
    has_own_influence: bool,
    has_row_tables: bool,
    period: Option<Period>,
    has_layer: bool,
    has_patches: bool,
    /// The effect, if any, for which the multigrid methods have no smoother or no coarser grids.
    without_multigrid: Option<&'static str>,
    symmetric: bool,
    /// The largest coefficient, whatever its sign.
    largest_influence: f64,
    shape: CycleShape,
    precision: Precision,
    /// As asked for in the options.
    thread_count: usize,
    threads: Threads,
    projected: Projected,
    /// Made when a method first asks for it.
    multigrid: Option<Multigrid>,
    /// The finest grid's, then one per coarser grid of `multigrid`.
    states: Vec<State>,
    workspace: full_multigrid::Workspace,
    limited: limited::Workspace,
    ledger: Vec<LedgerRow>,
    /// For batches: solvers of one thread, made when first needed.
    workers: Vec<Option<Solver>>,
    solved_before: bool,
    /// Whether u of the finest state is a fresh A p of its p.
    u_is_product: bool,
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
        let projected = Projected::new(&scene.grid, &influence, options.precision, &threads)?;
        let h = zeros(scene.grid.len(), "undeformed distances")?;
        Ok(Solver {
            grid: scene.grid,
            bodies: scene.bodies,
            has_own_influence: scene.influence.is_some(),
            has_row_tables: scene.row_tables.is_some(),
            period: scene.period,
            has_layer: scene.layer.is_some(),
            has_patches: scene.patches.is_some(),
            without_multigrid: without_multigrid(scene),
            symmetric: influence.is_symmetric(&scene.grid),
            largest_influence: influence.largest(&scene.grid),
            shape: options.cycle_shape(),
            precision: options.precision,
            thread_count: options.threads,
            threads,
            projected,
            multigrid: None,
            states: vec![State::new(scene.grid, h, scene.load, 0.0)?],
            workspace: full_multigrid::Workspace::default(),
            limited: limited::Workspace::default(),
            ledger: Vec::new(),
            workers: Vec::new(),
            solved_before: false,
            u_is_product: false,
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
        self.check_range(scene, guess.filter(|_| options.active_set == ActiveSet::Fixed))?;
        let mut monitor = Monitor::new(progress, std::mem::take(&mut self.ledger), options.estimates);
        let outcome = self.start_and_run(scene, options, guess, &mut monitor);
        let (mut report, ledger) = monitor.finish();
        self.ledger = ledger;
        let stop = outcome?;
        report.setup_seconds = std::mem::take(&mut self.setup_seconds);
        report.bytes = self.bytes() as u64;
        log::info!(
            "{:?} on {} x {}: {stop:?} after {} cycles and {:.1} work units, residual {:e}",
            options.method,
            self.grid.mx,
            self.grid.my,
            report.cycles,
            report.work_units,
            report.measures.certificate.residual
        );
        if log::log_enabled!(log::Level::Info) {
            report.advice().iter().for_each(|advice| log::info!("{advice}"));
        }
        Ok((stop, report))
    }

    fn start_and_run(
        &mut self,
        scene: &Scene<'_>,
        options: &Options,
        guess: Option<Guess<'_>>,
        monitor: &mut Monitor<'_>,
    ) -> Result<Stop> {
        let rule = Rule {
            tolerance: options.tolerance,
            by_update: options.criterion == Criterion::Update,
            fixed: options.active_set == ActiveSet::Fixed,
            max_cycles: options.max_cycles as u64,
        };
        let start = self.start(scene, options, guess, monitor)?;
        let mut stop = if self.without_contact(scene.load, rule.fixed) {
            Stop::Converged
        } else {
            self.run(options, &rule, start, monitor)?
        };
        if let Some(limit) = scene.pressure_limit {
            stop = self.limit_pressures(limit, stop, options, &rule, monitor)?;
        }
        let stop = if monitor.is_cancelled() { Stop::Cancelled } else { stop };
        self.solved_before = true;
        self.u_is_product = stop == Stop::Converged;
        monitor.close_grid(&self.states[0]);
        // With a limit of the pressures the samples would be other problems.
        let comparable = self.symmetric && !rule.fixed && scene.pressure_limit.is_none();
        if options.estimates && comparable && !monitor.is_cancelled() {
            let state = &self.states[0];
            let (samples, count) = self.projected.samples(state, monitor)?;
            monitor.estimate(state, &samples[..count]);
        }
        Ok(stop)
    }

    /// The result: pressures, displacements, contact area and approach.
    pub fn state(&self) -> &State {
        &self.states[0]
    }

    /// The grid that it was set up for.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Whether there is a result yet.
    pub fn has_solved(&self) -> bool {
        self.solved_before
    }

    /// What the last solve knew when: one row per grid, coarsest first.
    pub fn ledger(&self) -> &[LedgerRow] {
        &self.ledger
    }

    /// The influence coefficients in use.
    pub fn influence(&self) -> &Influence {
        self.projected.influence()
    }

    /// Whether the coefficients were given with the set-up: then those of later scenes, and their bodies, do not matter.
    pub fn has_own_influence(&self) -> bool {
        self.has_own_influence
    }

    /// The same of tables per loaded row.
    pub fn has_row_tables(&self) -> bool {
        self.has_row_tables
    }

    fn check(&self, scene: &Scene<'_>, options: &Options) -> Result<()> {
        scene.check_distance_and_load()?;
        self.check_options(options)?;
        if scene.grid != self.grid {
            return invalid(format!("the grid is {:?}; this solver was set up for {:?}", scene.grid, self.grid));
        }
        // Own coefficients know no bodies.
        if !self.has_own_influence && !self.has_row_tables && scene.bodies != self.bodies {
            return invalid(format!("the bodies are {:?}; this solver was set up for {:?}", scene.bodies, self.bodies));
        }
        if scene.influence.is_some() && !self.has_own_influence {
            return invalid("influence is given, but this solver was set up without".into());
        }
        if scene.row_tables.is_some() && !self.has_row_tables {
            return invalid("row_tables is given, but this solver was set up without".into());
        }
        if scene.period != self.period {
            return invalid(format!("period is {:?}; this solver was set up for {:?}", scene.period, self.period));
        }
        let named = [
            ("a layer", scene.layer.is_some(), self.has_layer),
            ("patches", scene.patches.is_some(), self.has_patches),
        ];
        for (effect, is_named, was_named) in named {
            if is_named != was_named {
                let with = |yes: bool| if yes { "with" } else { "without" };
                return invalid(format!(
                    "the scene is {} {effect}; this solver was set up {}",
                    with(is_named),
                    with(was_named)
                ));
            }
        }
        if scene.pressure_limit.is_some() && options.active_set == ActiveSet::Fixed {
            let message = "active_set is FIXED, and pressure_limit is given; this version does not solve them together";
            return Err(Error::Unsupported(message.into()));
        }
        match (options.method, self.without_multigrid) {
            (Method::Multigrid, Some(effect)) => unsupported("MULTIGRID", effect),
            (Method::FullMultigrid, Some(effect)) => unsupported("FULL_MULTIGRID", effect),
            _ => Ok(()),
        }
    }

    fn check_options(&self, options: &Options) -> Result<()> {
        options.check()?;
        if options.cycle_shape() != self.shape || options.threads != self.thread_count {
            return invalid(
                "smoother, sweeps, relaxation, coarsest and threads must be those the solver was set up with".into(),
            );
        }
        Ok(())
    }

    /// Refuses units in which pressures, displacements or their squares leave the range of double precision. `fixed`: a contact
    /// area that is given.
    fn check_range(&self, scene: &Scene<'_>, fixed: Option<Guess<'_>>) -> Result<()> {
        let influence = self.projected.influence().at(0, 0);
        let (pressure, displacement) = match (scene.load, fixed) {
            (Load::Approach(approach), Some(fixed)) => {
                let on_contact = scene.undeformed_distance.iter().zip(fixed.contact);
                let on_contact = on_contact.filter(|(h, inside)| **inside && h.is_finite());
                let depth = on_contact.fold(0.0, |depth: f64, (h, _)| depth.max((h - approach).abs()));
                (depth / influence, depth)
            }
            (Load::Approach(approach), None) => {
                let lowest = scene.undeformed_distance.iter().copied().fold(f64::INFINITY, f64::min);
                let depth = if lowest.is_finite() { (approach - lowest).max(0.0) } else { 0.0 };
                (depth / influence, depth)
            }
            (Load::Force(force), _) => {
                let pressure = force / scene.grid.element_area();
                (pressure, pressure * influence)
            }
        };
        // With a prescribed force the approach is a mean of distances, whatever they are measured from.
        let farthest = match (scene.load, fixed) {
            (Load::Approach(_), _) => 0.0,
            (Load::Force(_), Some(fixed)) => {
                let on_contact = scene.undeformed_distance.iter().zip(fixed.contact);
                let on_contact = on_contact.filter(|(h, inside)| **inside && h.is_finite());
                on_contact.fold(0.0, |farthest: f64, (h, _)| farthest.max(h.abs()))
            }
            (Load::Force(_), None) => scene.undeformed_distance.iter().copied().fold(f64::INFINITY, f64::min).abs(),
        };
        if pressure != 0.0 && farthest >= 1e140 {
            return invalid(format!(
                "the undeformed distances of the contact area are of order {farthest:e}; with a prescribed force they must lie \
                 below 1e140: choose other units"
            ));
        }
        let in_range = |value: f64| (1e-140..1e140).contains(&value);
        let loaded = pressure != 0.0 || displacement != 0.0;
        let largest = self.largest_influence;
        let coefficients = in_range(influence) && in_range(largest) && in_range(largest * pressure);
        if loaded && !(in_range(pressure) && in_range(displacement) && coefficients) {
            return invalid(format!(
                "the scene has pressures of order {pressure:e}, displacements of order {displacement:e} and influence \
                 coefficients of order {influence:e} to {largest:e}; all must lie between 1e-140 and 1e140: choose other units"
            ));
        }
        Ok(())
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

    fn run(&mut self, options: &Options, rule: &Rule, start: Start, monitor: &mut Monitor<'_>) -> Result<Stop> {
        if options.initial_guess != InitialGuess::Previous {
            self.projected.forget_windows();
        }
        match options.method {
            Method::Norm => self.norm(rule, monitor),
            Method::Multigrid => self.multigrid(rule, monitor),
            Method::FullMultigrid => self.full_multigrid(options, rule, start, monitor),
            Method::ProjectedCg if !self.symmetric => Err(Error::Unsupported(
                "method is PROJECTED_CG, but the influence coefficients are not symmetric; AUTO chooses a method that works".into(),
            )),
            Method::ProjectedCg => {
                self.projected.solve(&mut self.states[0], crate::contact::admissible::NonNegative, rule, start, options.error_ratio, monitor)
            }
            Method::Auto => {
                let stop = if self.symmetric {
                    self.projected.solve(&mut self.states[0], crate::contact::admissible::NonNegative, rule, start, options.error_ratio, monitor)?
                } else if self.without_multigrid.is_some() {
                    return self.norm(rule, monitor);
                } else {
                    self.full_multigrid(options, rule, start, monitor)?
                };
                if stop != Stop::Stagnated {
                    return Ok(stop);
                }
                if self.symmetric && !rule.fixed {
                    log::info!("the fast method stagnated on this scene; projected descent takes over");
                    self.descent(rule, monitor)
                } else {
                    log::info!("the fast method stagnated on this scene; NORM takes over");
                    self.norm(rule, monitor)
                }
            }
        }
    }

    fn descent(&mut self, rule: &Rule, monitor: &mut Monitor<'_>) -> Result<Stop> {
        let (projected, state) = (&mut self.projected, &mut self.states[0]);
        let mut displace = |p: &[f64], u: &mut [f64]| projected.displace(p, u);
        let by = Displace { product: &mut displace, work: 1.0, symmetric: true };
        descent_method::solve(state, by, rule, &mut self.workspace.descent, monitor)
    }

    fn norm(&mut self, rule: &Rule, monitor: &mut Monitor<'_>) -> Result<Stop> {
        let (projected, state) = (&mut self.projected, &mut self.states[0]);
        let mut displace = |p: &[f64], u: &mut [f64]| projected.displace(p, u);
        let by = Displace { product: &mut displace, work: 1.0, symmetric: self.symmetric };
        norm_method::solve(state, by, rule, &mut self.workspace.norm, monitor)
    }

    fn multigrid(&mut self, rule: &Rule, monitor: &mut Monitor<'_>) -> Result<Stop> {
        self.set_up_multigrid()?;
        let Some(multigrid) = &mut self.multigrid else { return Ok(Stop::Stagnated) };
        let workspace = &mut self.workspace.cycles;
        Ok(multigrid_method::solve(multigrid, 0, &mut self.states[0], rule, workspace, monitor))
    }

    fn full_multigrid(
        &mut self,
        options: &Options,
        rule: &Rule,
        start: Start,
        monitor: &mut Monitor<'_>,
    ) -> Result<Stop> {
        if start != Start::Nothing || rule.fixed {
            return self.multigrid(rule, monitor);
        }
        self.set_up_multigrid()?;
        let Some(multigrid) = &mut self.multigrid else { return Ok(Stop::Stagnated) };
        full_multigrid::solve(multigrid, &mut self.states, rule, options.error_ratio, &mut self.workspace, monitor)
    }

    fn set_up_multigrid(&mut self) -> Result<()> {
        self.workspace.cycles.reserve(self.grid.len())?;
        if self.multigrid.is_none() {
            let began = Instant::now();
            let multigrid = Multigrid::new(&self.grid, self.projected.influence(), self.shape, &self.threads)?;
            for level in &multigrid.hierarchy.levels[1..] {
                let h = zeros(level.grid.len(), "undeformed distances")?;
                let load = self.states[0].load;
                self.states.push(State::new(level.grid, h, load, 0.0)?);
            }
            self.multigrid = Some(multigrid);
            self.setup_seconds += began.elapsed().as_secs_f64();
        }
        Ok(())
    }

    fn bytes(&self) -> usize {
        let states: usize = self.states.iter().map(State::bytes).sum();
        // Workers share the coefficients of the finest grid.
        let own = |worker: &Solver| worker.bytes() - worker.influence().bytes();
        let workers: usize = self.workers.iter().flatten().map(own).sum();
        self.projected.bytes()
            + self.multigrid.as_ref().map_or(0, Multigrid::bytes)
            + states
            + workers
            + self.limited.bytes()
    }
}

/// The effects that MULTIGRID and FULL_MULTIGRID do not solve.
fn without_multigrid(scene: &Scene<'_>) -> Option<&'static str> {
    match scene {
        Scene { period: Some(_), .. } => Some("period"),
        Scene { patches: Some(_), .. } => Some("patches"),
        Scene { row_tables: Some(_), .. } => Some("row_tables"),
        Scene { layer: Some(Layer::PerElement(_)), .. } => Some("a layer of one compliance per element"),
        _ => None,
    }
}

fn unsupported(method: &str, effect: &str) -> Result<()> {
    let rule = "AUTO chooses a method that does";
    Err(Error::Unsupported(format!("method is {method}, which does not solve scenes with {effect}; {rule}")))
}
