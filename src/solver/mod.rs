//! The solve of a scene: the options, the loop of all methods (`iterate`), the order of the methods, and the report.
//!
//! A [`Solver`] is set up once for a grid and a pair of bodies: it holds operators, transforms and coarser grids. Then it solves scenes with any
//! undeformed distances and loads, one by one or as a [batch](Solver::solve_batch). [`solve`] sets up and solves in one call. The methods of
//! [`Solver`] are in the files of this folder, one subject in each.

mod adhesion;
mod adhesive_friction;
mod asked;
mod batch;
mod beside;
mod best;
mod bill;
mod by_creepages;
mod check;
mod compressible;
mod compression;
mod creepage_peak;
mod creepage_trials;
mod errors;
mod estimates;
mod extrapolation;
mod falling;
mod friction_batch;
mod friction_table;
mod handle;
mod iterate;
mod kept;
mod linear;
mod methods;
mod nested;
mod normal;
mod numbered;
mod options;
mod own_tables;
mod quantities;
mod refinement;
mod report;
mod seconds;
mod stages;
mod step;
mod take_over;
mod tangential;
mod tangential_calls;
mod tangential_estimates;
mod tangential_turn;
mod turns;
mod unlike_bodies;
mod unlike_sensitivities;
mod with_memory;

use std::sync::Arc;
use std::time::Instant;

pub use crate::operator::Precision;
pub use crate::progress::{
    Counters, Criterion, DiscretisationError, LedgerRow, Measures, Outcome, Progress, ProgressCallback,
};
pub(crate) use asked::Asked;
pub use batch::Problem;
pub use bill::{effects_bill, BillOptions, BillRow, Neglected, Omission, Verdict};
pub use falling::Falling;
pub use friction_batch::{solve_friction_batch, Ended, Entry, RUN};
pub use linear::Stiffness;
pub(crate) use options::check_threads;
pub use options::{ActiveSet, Guess, InitialGuess, Method, Options};
pub use quantities::{quantities, Lack, Quantity, QuantityRow};
pub use refinement::{cost_of_accuracy, solve_to_accuracy, Accuracy, Obstacle, Price, Refinement, SurfaceCallback};
pub use report::{Halving, Limit, Report};
pub use tangential_calls::solve_tangential;

use crate::contact::{self, State};
use crate::effects::{self, KeptInfluence, Layout, Named};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::progress::Monitor;
use crate::scene::{Load, Scene};
use crate::threads::Threads;
use beside::Beside;
use compressible::Compressible;
use methods::Methods;
pub(crate) use tangential::StepBefore;
use tangential::Tangent;

/// Solves scenes on one grid and with one pair of bodies; holds their operators and coarser grids. Only one thread at a time may use a solver.
///
/// A solver holds the last complete result, or none. A solve that is refused before it begins leaves the previous result, and so does a failed solve
/// of a scene with friction, adhesion or another coupled effect. After any other failed solve the solver holds none.
///
/// The bits of a solve that starts from p = 0 or from a given guess do not depend on earlier solves.
///
/// With one thread, repeated solves by the same method and from the same kind of start allocate no memory, with three exceptions:
///
/// - PROJECTED_CG and AUTO iterate on a window around the contact area. The operator of the window is set up again when its size changes.
/// - From 128 x 128 elements on, products with pressures on a part of the grid use an operator of a shorter period. This operator is set up again
///   when the extent of the pressures changes.
/// - From 2^23 elements (2896 x 2896) on, the operators for the start of a solve are set up in each solve.
pub struct Solver {
    problem: contact::Problem,
    set_up: SetUp,
    methods: Methods,
    state: State,
    /// Whether `state` is a complete result.
    has_result: bool,
    /// The pressure limits of the scene that is solved, if they are given per element.
    limits: Vec<f64>,
    ledger: Vec<LedgerRow>,
    /// What coupled problems keep from step to step, except friction.
    beside: Beside,
    /// The tangential problem of scenes with friction.
    friction: Option<Box<Tangent>>,
    /// A step of another solver, from which the first step of this solver may continue.
    step_before: Option<StepBefore>,
    /// The solver of scenes with adhesion.
    adhesion: Option<Box<crate::adhesion::Solver>>,
    /// The split of the total pressures of the last result, if its scene had adhesion.
    split: Option<crate::adhesion::Split>,
    /// Two fields for visco-elastic bodies: the displacements by earlier steps, and the distances of the step. Empty for other bodies.
    remembered: Vec<f64>,
    /// The compliance of the bodies in the step of the last result, relative to that at set-up: 1 for bodies without memory.
    compliance: f64,
    /// The caller's tangential coefficients.
    own_tables: Option<Arc<KeptInfluence>>,
    /// Tangential problems of one thread each, for tables of entries. They are set up at the first table.
    crew: Vec<Tangent>,
    /// Solvers of one thread each, for batches and stiffnesses. They are set up at the first use.
    workers: Vec<Option<Solver>>,
    /// Seconds of the set-up, until a report has them.
    setup_seconds: f64,
}

/// What a solver was set up with: later scenes and options are checked against it.
#[derive(Clone)]
struct SetUp {
    /// The bodies and the values of effects that later scenes may not change.
    named: Named,
    /// The name of the effect by which the caller gives influence coefficients, and their layout. None without such an effect.
    own_coefficients: Option<(&'static str, Layout)>,
    /// Whether the last attempt to replace the caller's table failed, so that the solver has no coefficients.
    lacks_table: bool,
    /// The name of the effect, if any, for which the multigrid methods have no smoother or no coarser grids.
    without_multigrid: Option<&'static str>,
    /// The largest absolute influence coefficient.
    largest_influence: f64,
    /// The coefficients with their constant, if they contain one: see [`Compressible`].
    compressible: Option<Compressible>,
    /// Smoother, sweeps, precision, and the requested threads.
    options: Options,
}

/// Solves one scene.
pub fn solve(scene: &Scene<'_>, options: &Options) -> Result<(Solver, Outcome, Report)> {
    let (mut solver, lowest) = Solver::for_scene(scene, options)?;
    let (outcome, report) = solver.solve_checked(Asked::new((scene, lowest), options), None)?;
    Ok((solver, outcome, report))
}

impl Solver {
    /// Sets up operators and grids from the grid, the bodies and the effects of `scene`. The undeformed distance may be empty; then it and the load
    /// are not checked.
    pub fn new(scene: &Scene<'_>, options: &Options) -> Result<Solver> {
        Ok(Solver::set_up(scene, options, !scene.undeformed_distance.is_empty())?.0)
    }

    /// Checks the whole scene and sets up a solver for it. Returns the least undeformed distance as well.
    pub(crate) fn for_scene(scene: &Scene<'_>, options: &Options) -> Result<(Solver, f64)> {
        Solver::set_up(scene, options, true)
    }

    /// Sets up a solver. With `has_surface` the undeformed distance and the load are checked as well, and the least distance is returned; without it
    /// the second value is infinite.
    fn set_up(scene: &Scene<'_>, options: &Options, has_surface: bool) -> Result<(Solver, f64)> {
        let began = Instant::now();
        // Errors of the options and of the threads are returned only if the scene has none.
        let threads = options.check().and_then(|()| Ok(Threads::new(options.threads)?));
        let lowest = if !has_surface {
            scene.check_effects_and_bodies()?;
            f64::INFINITY
        } else {
            let lowest = scene.check(threads.as_ref().unwrap_or(&Threads::One))?;
            scene.check_free_load(options.is_fixed())?;
            lowest
        };
        let threads = threads?;
        let (coefficients, compressible) = Compressible::of(scene.coefficients()?, scene.load);
        let set_up = SetUp {
            named: Named::new(scene),
            own_coefficients: effects::own_coefficients(scene),
            lacks_table: false,
            without_multigrid: effects::excluded_method(scene),
            largest_influence: coefficients.largest(&scene.grid),
            compressible,
            options: *options,
        };
        let mut solver = Solver::of(scene.grid, coefficients, set_up, &threads)?;
        if let Some(given) = scene.friction.as_ref().and_then(|friction| friction.influence) {
            solver.own_tables = Some(Arc::new(KeptInfluence::new(&given)?));
        }
        solver.setup_seconds = began.elapsed().as_secs_f64();
        Ok((solver, lowest))
    }

    /// A solver without a result.
    fn of(grid: Grid, coefficients: Coefficients, set_up: SetUp, threads: &Threads) -> Result<Solver> {
        let mut problem = contact::Problem::new(grid, coefficients, threads)?;
        problem.given = set_up.own_coefficients.is_some();
        Ok(Solver {
            methods: Methods::new(&problem, &set_up.options)?,
            state: State::new(grid, (Load::Approach(0.0), 0.0), threads)?,
            problem,
            set_up,
            has_result: false,
            limits: Vec::new(),
            ledger: Vec::new(),
            beside: Beside::default(),
            friction: None,
            step_before: None,
            adhesion: None,
            split: None,
            remembered: Vec::new(),
            compliance: 1.0,
            own_tables: None,
            crew: Vec::new(),
            workers: Vec::new(),
            setup_seconds: 0.0,
        })
    }

    /// Solves a scene. Its undeformed distance and load may differ from those at set-up; its grid, bodies and effects must be the same, except for
    /// values that an effect allows to change.
    pub fn solve(
        &mut self,
        scene: &Scene<'_>,
        options: &Options,
        guess: Option<Guess<'_>>,
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<(Outcome, Report)> {
        let own_tables = self.own_tables.clone();
        let scene = &*self.with_own_tables(scene, own_tables.as_deref())?;
        let lowest = scene.check_distance_and_load(&self.problem.threads)?;
        self.solve_checked(Asked { guess, ..Asked::new((scene, lowest), options) }, progress)
    }

    /// [`Solver::solve`] for a scene whose distance and load are checked already.
    pub(crate) fn solve_checked(
        &mut self,
        asked: Asked<'_>,
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<(Outcome, Report)> {
        self.set_up.check(asked.scene, asked.options, &self.problem)?;
        (self.problem.exact_edges, self.problem.exact_jumps) = (asked.exact_edges, asked.exact_jumps);
        let surface = effects::surface(asked.scene)?;
        let changed = surface.as_deref().map(|h| Scene { undeformed_distance: h, ..asked.scene.clone() });
        let asked = asked.on(changed.as_ref(), &self.problem.threads)?;
        match (effects::memory(asked.scene, &mut self.beside.histories)?, asked.scene.attraction()) {
            (Some((k, memory)), _) => self.solve_with_memory(asked, (k, &*memory), progress),
            (None, Some(adhesion)) => self.solve_adhesive(asked, (adhesion, false), progress),
            (None, None) => self.solve_at_once(asked, progress),
        }
    }

    /// Solves a checked scene without adhesion: the normal problem, then the problems coupled with it, then the error estimates. Bodies with memory
    /// of earlier steps have that memory in the undeformed distance here.
    fn solve_at_once(&mut self, asked: Asked<'_>, progress: Option<ProgressCallback<'_>>) -> Result<(Outcome, Report)> {
        let Asked { scene, options, .. } = asked;
        check::guess(asked)?;
        self.suit(scene.load)?;
        check::range(asked, &self.problem, self.set_up.largest_influence)?;
        self.check_continues(scene)?;
        let kept = self.kept(scene)?;
        let mut monitor = Monitor::new(progress, std::mem::take(&mut self.ledger), options.estimates);
        let solved = self.solve_normal(asked, &mut monitor).and_then(|(outcome, tolerance)| {
            let outcome = self.meet_compressed(asked, &mut monitor, outcome)?;
            let (outcome, found) = self.solve_beside(scene, options, outcome, &mut monitor)?;
            let mut report = Report { friction: found, ..Report::of(&monitor, tolerance) };
            if options.estimates {
                self.estimate(scene, options, &mut monitor, &mut report);
            }
            if let Some(measures) = self.compress(scene.load, &mut monitor) {
                report.measures = measures;
            }
            (report.solve_seconds, report.coarse_seconds) = (monitor.seconds(), monitor.coarse_seconds);
            Ok((outcome, report))
        });
        self.ledger = monitor.ledger.rows;
        if solved.is_err() {
            self.go_back(kept);
        }
        let (outcome, mut report) = solved?;
        (self.split, self.compliance) = (None, 1.0);
        report.setup_seconds = std::mem::take(&mut self.setup_seconds);
        report.bytes = self.bytes() as u64;
        report.log(options.method, &self.problem.grid, outcome);
        Ok((outcome, report))
    }
}
