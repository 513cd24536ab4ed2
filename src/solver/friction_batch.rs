//! Many tangential problems of one scene: its pressures once, then one motion or force after the other, spread over threads.
//!
//! Entries are solved in runs of [`RUN`] that stand side by side in the table. The first of a run starts from nothing, each other one
//! from the tractions of the one before, unless that is [far](NEAR) away; what ends without its certificate is solved once more
//! from nothing. Runs are the same whoever
//! takes them: the results have the same bits for any number of threads.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::tangential::{Tangent, Turn};
use super::tangential_calls::{measures, positive};
use super::{Options, Outcome, Progress, ProgressCallback, Report, Solver};
use crate::effects::{Effect, Previous};
use crate::error::{invalid, Result};
use crate::friction::{self, Solution};
use crate::grid::Grid;
use crate::memory::collected;
use crate::progress::Monitor;
use crate::scene::{Friction, Prescribed, Scene};
use crate::sums::in_blocks;
use crate::threads::Threads;

/// Entries of a run.
pub const RUN: usize = 16;
/// Forces that differ by more than this part of mu N are far apart: starts from steps of .03 take 16 products in the mean, of .1 they take
/// 28, of .3 they take 49, and from nothing 25 (circles and ellipses of 35 x 35 elements).
const NEAR_FORCE: f64 = 0.05;
/// Creepages and spin, times the radius of the contact area, that differ by more than this part of themselves are far apart: starts from
/// steps of .01 take 10 products in the mean, of .1 they take 14, of .4 they take 18, and from nothing 16.
const NEAR: f64 = 0.1;

/// What one entry of a table prescribes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Entry {
    /// In x and in y: the force where the scene's friction prescribes forces, else the creepage.
    pub amount: [f64; 2],
    /// phi.
    pub spin: f64,
}

impl Entry {
    /// What a scene's friction prescribes.
    pub fn of(friction: &Friction<'_>) -> Entry {
        let amount = friction.prescribed.map(|prescribed| match prescribed {
            Prescribed::Creepage(amount) | Prescribed::Force(amount) => amount,
        });
        Entry { amount, spin: friction.spin }
    }

    /// The friction of a table with what this entry prescribes.
    fn friction<'a>(&self, of: &Friction<'a>) -> Friction<'a> {
        let mut friction = Friction { spin: self.spin, ..*of };
        for (prescribed, amount) in friction.prescribed.iter_mut().zip(self.amount) {
            *prescribed = match prescribed {
                Prescribed::Creepage(_) => Prescribed::Creepage(amount),
                Prescribed::Force(_) => Prescribed::Force(amount),
            };
        }
        friction
    }
}

/// How the entry of a table ended, and what was found; `Outcome::Cancelled`: it was not solved.
pub type Ended = Result<(Outcome, friction::Report)>;

/// Solves the tangential problem of a scene for each of the entries, with pressures `[my][mx]` that are given, or with those of the
/// scene's normal problem, which is solved once. `found(i, ended, solution)` is called for each entry, on the thread that solved it and
/// in no particular order, with a solution where there is one. Returns the outcome and the report of the normal problem.
///
/// An entry that is refused does not keep the others from being solved. Of unlike bodies the pressures displace the surfaces sideways,
/// but tractions do not change the pressures. `progress` is told on the calling thread: of the normal problem, and then of entries that
/// are done, which count as cycles. When it cancels, entries that are not done end as `Outcome::Cancelled`.
pub fn solve_friction_batch(
    scene: &Scene<'_>,
    pressure: Option<&[f64]>,
    entries: &[Entry],
    options: &Options,
    mut progress: Option<ProgressCallback<'_>>,
    found: impl Fn(usize, Ended, Option<&Solution>) + Sync + Send,
) -> Result<(Outcome, Report)> {
    let (solver, given);
    let (stop, mut report, pressure) = match pressure {
        Some(pressure) => {
            scene.check_tangential()?;
            options.check()?;
            given = positive(&scene.grid, pressure)?;
            (Outcome::Converged, of_pressures(&scene.grid, &given, options), &*given)
        }
        None => {
            scene.check(&Threads::One)?;
            options.check()?;
            scene.check_free_load(options.is_fixed())?;
            friction_of_table(scene)?;
            let normal = Scene { friction: None, ..scene.clone() };
            let (mut new, lowest) = Solver::for_scene(&normal, options)?;
            let watch = progress.as_mut().map(|progress| &mut **progress as ProgressCallback<'_>);
            let (stop, report) = new.solve_checked((&normal, lowest), options, None, watch)?;
            solver = new;
            (stop, report, &solver.state().p[..])
        }
    };
    let table = Table::new(scene, friction_of_table(scene)?, pressure, entries, options);
    if stop == Outcome::Cancelled {
        table.done.cancelled.store(true, Ordering::Relaxed);
    }
    let began = std::time::Instant::now();
    table.solve(&mut Vec::new(), &Threads::new(options.threads)?, progress, &found)?;
    report.solve_seconds += began.elapsed().as_secs_f64();
    let cancelled = table.done.cancelled.into_inner();
    Ok((if cancelled { Outcome::Cancelled } else { stop }, report))
}

impl Solver {
    /// [`solve_friction_batch`] with the coefficients that this solver keeps, and with pressures that are given. What it solved last stays
    /// as it is.
    pub fn solve_friction_batch(
        &mut self,
        scene: &Scene<'_>,
        pressure: &[f64],
        entries: &[Entry],
        options: &Options,
        progress: Option<ProgressCallback<'_>>,
        found: impl Fn(usize, Ended, Option<&Solution>) + Sync + Send,
    ) -> Result<(Outcome, Report)> {
        let own = self.own_tables.clone();
        let scene = &*self.with_own_tables(scene, own.as_deref())?;
        self.check_tangential(scene, options)?;
        let (friction, pressure) = (friction_of_table(scene)?, &*positive(&scene.grid, pressure)?);
        let table = Table::new(scene, friction, pressure, entries, options);
        let began = std::time::Instant::now();
        let threads = self.problem.threads.clone();
        table.solve(&mut self.crew, &threads, progress, &found)?;
        let solve_seconds = began.elapsed().as_secs_f64();
        let report = Report { solve_seconds, ..of_pressures(&scene.grid, pressure, options) };
        let cancelled = table.done.cancelled.into_inner();
        Ok((if cancelled { Outcome::Cancelled } else { Outcome::Converged }, report))
    }
}

/// The friction of a table, in which no entry has a step before.
fn friction_of_table<'s>(scene: &'s Scene<'_>) -> Result<&'s Friction<'s>> {
    match &scene.friction {
        None => invalid("friction is not given: there is nothing to solve".into()),
        Some(friction) if friction.previous == Previous::Kept => {
            invalid("friction->continues is 1; in a table there is no step before".into())
        }
        Some(friction) => Ok(friction),
    }
}

/// What is to be said of pressures that are given.
fn of_pressures(grid: &Grid, pressure: &[f64], options: &Options) -> Report {
    Report { measures: measures(grid, pressure), tolerance: options.tolerance, ..Report::default() }
}

/// What all workers read, and where they say what is done.
struct Table<'a> {
    scene: &'a Scene<'a>,
    friction: &'a Friction<'a>,
    pressure: &'a [f64],
    entries: &'a [Entry],
    options: &'a Options,
    /// Forces that differ by less are near.
    near_force: f64,
    /// Of a circle as large as the contact area.
    radius: f64,
    done: Done,
}

/// What is done so far.
#[derive(Default)]
struct Done {
    /// The next run that nobody has taken.
    next_run: AtomicUsize,
    entries: AtomicUsize,
    products: Mutex<f64>,
    cancelled: AtomicBool,
}

impl<'a> Table<'a> {
    fn new(
        scene: &'a Scene<'a>,
        friction: &'a Friction<'a>,
        pressure: &'a [f64],
        entries: &'a [Entry],
        options: &'a Options,
    ) -> Table<'a> {
        let bounds = pressure.iter().enumerate().map(|(i, p)| friction.coefficient.at(i) * p.max(0.0));
        let near_force = NEAR_FORCE * in_blocks(bounds) * scene.grid.element_area();
        let contact = pressure.iter().filter(|p| **p > 0.0).count() as f64 * scene.grid.element_area();
        let radius = (contact / std::f64::consts::PI).sqrt();
        Table { scene, friction, pressure, entries, options, near_force, radius, done: Done::default() }
    }

    /// `crew`: workers of one thread, of which those that are missing are made.
    fn solve(
        &self,
        crew: &mut Vec<Tangent>,
        threads: &Threads,
        mut progress: Option<ProgressCallback<'_>>,
        found: &(impl Fn(usize, Ended, Option<&Solution>) + Sync + Send),
    ) -> Result<()> {
        let runs = self.entries.len().div_ceil(RUN);
        let workers = threads.count().min(runs).max(1);
        // Set up before any entry is solved: there is none that one lack of memory could lose.
        let missing = (crew.len()..workers).map(|_| Tangent::new(self.scene, self.options, &Threads::One));
        let missing = collected(missing, "the workers of a table")?;
        crew.extend(missing.into_iter().collect::<Result<Vec<_>>>()?);
        let began = std::time::Instant::now();
        let mut told = |residual: f64| {
            let Some(progress) = &mut progress else { return };
            let cycles = self.done.entries.load(Ordering::Relaxed) as u64;
            let work_units = *self.done.products.lock().unwrap_or_else(PoisonError::into_inner);
            let (seconds, grid) = (began.elapsed().as_secs_f64(), &self.scene.grid);
            if progress(&Progress { work_units, residual, ..Progress::of_part(grid, cycles, seconds) }) {
                self.done.cancelled.store(true, Ordering::Relaxed);
            }
        };
        threads.for_each_beside(
            &mut crew[..workers],
            |tangent| self.work(tangent, &mut told, found),
            |tangent| self.work(tangent, &mut |_| (), found),
        );
        Ok(())
    }

    /// Takes runs until there are none left; `told` hears the residual of each entry.
    fn work(
        &self,
        tangent: &mut Tangent,
        told: &mut dyn FnMut(f64),
        found: &(impl Fn(usize, Ended, Option<&Solution>) + Sync + Send),
    ) {
        loop {
            let first = self.done.next_run.fetch_add(1, Ordering::Relaxed).saturating_mul(RUN);
            if first >= self.entries.len() {
                return;
            }
            let mut warm = false;
            for i in first..(first + RUN).min(self.entries.len()) {
                let ended = self.entry(i, tangent, warm && self.is_near(i));
                warm = matches!(ended, Ok((Outcome::Converged, _)));
                let residual = ended.as_ref().map_or(-1.0, |(_, report)| report.certificate.residual);
                let has_solution = matches!(ended, Ok((stop, _)) if stop != Outcome::Cancelled);
                if let Ok((_, report)) = &ended {
                    *self.done.products.lock().unwrap_or_else(PoisonError::into_inner) += report.products;
                }
                found(i, ended, if has_solution { tangent.solution() } else { None });
                self.done.entries.fetch_add(1, Ordering::Relaxed);
                if !self.is_cancelled() {
                    told(residual);
                }
            }
        }
    }

    /// Whether entry i is near the one before.
    fn is_near(&self, i: usize) -> bool {
        let (now, before) = (&self.entries[i], &self.entries[i - 1]);
        let (mut force, mut motion, mut size) = (0.0, 0.0, 0.0);
        for k in 0..2 {
            let change = now.amount[k] - before.amount[k];
            match self.friction.prescribed[k] {
                Prescribed::Force(_) => force += change * change,
                Prescribed::Creepage(_) => {
                    motion += change * change;
                    size += before.amount[k] * before.amount[k];
                }
            }
        }
        motion += ((now.spin - before.spin) * self.radius).powi(2);
        size += (before.spin * self.radius).powi(2);
        force.sqrt() <= self.near_force && motion.sqrt() <= NEAR * size.sqrt()
    }

    fn is_cancelled(&self) -> bool {
        self.done.cancelled.load(Ordering::Relaxed)
    }

    /// Solves entry i; `warm`: from the result of the one before.
    fn entry(&self, i: usize, tangent: &mut Tangent, warm: bool) -> Ended {
        if self.is_cancelled() {
            return Ok((Outcome::Cancelled, friction::Report::default()));
        }
        let friction = self.entries[i].friction(self.friction);
        friction.check(&self.scene.grid)?;
        let turn = Turn { scene: self.scene, friction: &friction, options: self.options, threads: &Threads::One };
        let mut watch = |_: &Progress| self.is_cancelled();
        let mut spent = 0.0;
        if warm {
            if let Ok((stop, report)) = self.step(tangent, &turn, true, &mut watch) {
                if stop == Outcome::Converged || stop == Outcome::Cancelled {
                    return Ok((stop, report));
                }
                spent = report.products;
            }
        }
        let (stop, mut report) = self.step(tangent, &turn, false, &mut watch)?;
        report.products += spent;
        Ok((stop, report))
    }

    fn step(&self, tangent: &mut Tangent, turn: &Turn<'_>, again: bool, watch: ProgressCallback<'_>) -> Ended {
        tangent.solve(turn, self.pressure, again, &mut Monitor::new(Some(watch), Vec::new(), false))
    }
}
