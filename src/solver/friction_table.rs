//! A table of tangential problems with the same pressures, one for each motion or force, distributed over threads.
//!
//! Entries are solved in runs of [`RUN`] consecutive entries. The first entry of a run starts from rest. Each further entry starts from the
//! tractions of the entry before it, if that has converged and is [near](NEAR_CREEPAGE). An entry whose solve from these tractions does not converge
//! is solved again from rest. Runs do not depend on the threads: the results have the same bits for any number of threads.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::tangential::{Tangent, Turn};
use super::{Options, Outcome, Progress, ProgressCallback};
use crate::effects::Effect;
use crate::error::Result;
use crate::friction::{self, Solution};
use crate::memory::collected;
use crate::progress::Monitor;
use crate::scene::{Friction, Prescribed, Scene};
use crate::sums::in_blocks;
use crate::threads::Threads;

/// The number of entries of a run.
pub const RUN: usize = 16;
/// Entries are near if their forces differ by at most this part of mu N. Mean numbers of products, on circles and ellipses of 35 x 35 elements:
///
/// | difference | .03 | .1 | .3 | start from rest |
/// |---|---|---|---|---|
/// | products | 16 | 28 | 49 | 25 |
const NEAR_FORCE: f64 = 0.05;
/// Entries are near if their creepages, and spins times the radius of the contact area, differ by at most this part of those of the entry before.
/// Mean numbers of products:
///
/// | difference | .01 | .1 | .4 | start from rest |
/// |---|---|---|---|---|
/// | products | 10 | 14 | 18 | 16 |
const NEAR_CREEPAGE: f64 = 0.1;

/// The motion or force of one entry of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Entry {
    /// In x and in y: the force where the scene's friction prescribes a force, else the creepage.
    pub amount: [f64; 2],
    /// The spin phi.
    pub spin: f64,
}

impl Entry {
    /// The motion or force that a scene's friction prescribes.
    pub fn of(friction: &Friction<'_>) -> Entry {
        let amount = friction.prescribed.map(|prescribed| match prescribed {
            Prescribed::Creepage(amount) | Prescribed::Force(amount) => amount,
        });
        Entry { amount, spin: friction.spin }
    }

    /// The friction of the scene, with the motion or force of this entry.
    fn friction<'a>(&self, of_scene: &Friction<'a>) -> Friction<'a> {
        let mut friction = Friction { spin: self.spin, ..*of_scene };
        for (prescribed, amount) in friction.prescribed.iter_mut().zip(self.amount) {
            *prescribed = match prescribed {
                Prescribed::Creepage(_) => Prescribed::Creepage(amount),
                Prescribed::Force(_) => Prescribed::Force(amount),
            };
        }
        friction
    }
}

/// The outcome and the report of an entry. With `Outcome::Cancelled` the entry was not solved, or not to its end.
pub type Ended = Result<(Outcome, friction::Report)>;

/// The inputs of a table, and the progress of all its workers.
pub(super) struct Table<'a> {
    scene: &'a Scene<'a>,
    friction: &'a Friction<'a>,
    pressure: &'a [f64],
    entries: &'a [Entry],
    options: &'a Options,
    /// The largest difference of forces of near entries: [`NEAR_FORCE`] times mu N.
    near_force: f64,
    /// The radius of a circle whose area is that of the contact.
    radius: f64,
    done: Done,
}

/// What the workers of a table have done so far.
#[derive(Default)]
struct Done {
    /// Runs that workers have taken, besides the first run, which is the calling thread's.
    taken: AtomicUsize,
    /// Solved entries.
    entries: AtomicUsize,
    /// Products of solved entries.
    products: Mutex<f64>,
    /// Whether the caller cancelled.
    cancelled: AtomicBool,
}

impl<'a> Table<'a> {
    pub(super) fn new(
        scene: &'a Scene<'a>,
        friction: &'a Friction<'a>,
        pressure: &'a [f64],
        entries: &'a [Entry],
        options: &'a Options,
    ) -> Table<'a> {
        // The yield limit of a layer changes with its plastic slip. Here that of fresh material suffices: the sum of the bounds only serves as a
        // scale.
        let layer =
            friction.layer.filter(|_| friction.has_ideal_layer()).map_or(f64::INFINITY, |layer| layer.yield_limit);
        let bounds = pressure.iter().enumerate().map(|(i, p)| (friction.coefficient.at(i) * p.max(0.0)).min(layer));
        let near_force = NEAR_FORCE * in_blocks(bounds) * scene.grid.element_area();
        let contact = pressure.iter().filter(|p| **p > 0.0).count() as f64 * scene.grid.element_area();
        let radius = (contact / std::f64::consts::PI).sqrt();
        Table { scene, friction, pressure, entries, options, near_force, radius, done: Done::default() }
    }

    /// Solves all entries, unless the normal problem ended with `outcome` CANCELLED. `crew` holds workers of one thread each; missing ones are set
    /// up. Returns `outcome`, or CANCELLED if the caller cancelled, and the seconds.
    pub(super) fn solve(
        self,
        outcome: Outcome,
        (crew, threads): (&mut Vec<Tangent>, &Threads),
        mut progress: Option<ProgressCallback<'_>>,
        found: &(impl Fn(usize, Ended, Option<&Solution>) + Sync + Send),
    ) -> Result<(Outcome, f64)> {
        let began = std::time::Instant::now();
        self.done.cancelled.store(outcome == Outcome::Cancelled, Ordering::Relaxed);
        let runs = self.entries.len().div_ceil(RUN);
        let workers = threads.count().min(runs).max(1);
        // All workers are set up before any entry is solved: if memory is short, the call fails as a whole, not for some entries.
        let missing = (crew.len()..workers).map(|_| Tangent::new(self.scene, self.options, &Threads::One));
        let missing = collected(missing, "the workers of a table")?;
        crew.extend(missing.into_iter().collect::<Result<Vec<_>>>()?);
        let mut tell = |residual: f64| {
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
            // The calling thread always has run 0. On a short table the other threads could take all runs, and then `progress` would never be called.
            |tangent| {
                self.run(0, tangent, &mut tell, found);
                self.work(tangent, &mut tell, found);
            },
            |tangent| self.work(tangent, &mut |_| (), found),
        );
        let outcome = if self.is_cancelled() { Outcome::Cancelled } else { outcome };
        Ok((outcome, began.elapsed().as_secs_f64()))
    }

    /// Solves runs until none is left. `tell` is called with the residual of each entry.
    fn work(
        &self,
        tangent: &mut Tangent,
        tell: &mut dyn FnMut(f64),
        found: &(impl Fn(usize, Ended, Option<&Solution>) + Sync + Send),
    ) {
        while self.done.taken.load(Ordering::Relaxed) < self.entries.len().div_ceil(RUN) {
            self.run(1 + self.done.taken.fetch_add(1, Ordering::Relaxed), tangent, tell, found);
        }
    }

    /// Solves the entries of run number `run`. A number beyond the table has no entries.
    fn run(
        &self,
        run: usize,
        tangent: &mut Tangent,
        tell: &mut dyn FnMut(f64),
        found: &(impl Fn(usize, Ended, Option<&Solution>) + Sync + Send),
    ) {
        let first = run.saturating_mul(RUN);
        let mut warm = false;
        for i in first..(first.saturating_add(RUN)).min(self.entries.len()) {
            let ended = self.entry(i, tangent, warm && self.is_near(i));
            warm = matches!(ended, Ok((Outcome::Converged, _)));
            let residual = ended.as_ref().map_or(-1.0, |(_, report)| report.certificate.residual);
            let has_solution = matches!(ended, Ok((outcome, _)) if outcome != Outcome::Cancelled);
            if let Ok((_, report)) = &ended {
                *self.done.products.lock().unwrap_or_else(PoisonError::into_inner) += report.products;
            }
            found(i, ended, if has_solution { tangent.solution() } else { None });
            self.done.entries.fetch_add(1, Ordering::Relaxed);
            if !self.is_cancelled() {
                tell(residual);
            }
        }
    }

    /// Whether entry i is near the entry before it (see [`NEAR_FORCE`] and [`NEAR_CREEPAGE`]).
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
        force.sqrt() <= self.near_force && motion.sqrt() <= NEAR_CREEPAGE * size.sqrt()
    }

    fn is_cancelled(&self) -> bool {
        self.done.cancelled.load(Ordering::Relaxed)
    }

    /// Solves entry i, from the result of the entry before if `warm`, otherwise or if that fails from rest.
    fn entry(&self, i: usize, tangent: &mut Tangent, warm: bool) -> Ended {
        if self.is_cancelled() {
            return Ok((Outcome::Cancelled, friction::Report::default()));
        }
        let friction = self.entries[i].friction(self.friction);
        // Tangential tables are those of the scene and were checked with it.
        Friction { influence: None, ..friction }.check(&self.scene.grid)?;
        let turn = Turn { scene: self.scene, friction: &friction, options: self.options, threads: &Threads::One };
        let mut watch = |_: &Progress| self.is_cancelled();
        let mut spent = 0.0;
        if warm {
            if let Ok((outcome, report)) = self.step(tangent, &turn, true, &mut watch) {
                if outcome == Outcome::Converged || outcome == Outcome::Cancelled {
                    return Ok((outcome, report));
                }
                spent = report.products;
            }
        }
        let (outcome, mut report) = self.step(tangent, &turn, false, &mut watch)?;
        report.products += spent;
        Ok((outcome, report))
    }

    /// Solves one tangential problem, from the last result if `again`.
    fn step(&self, tangent: &mut Tangent, turn: &Turn<'_>, again: bool, watch: ProgressCallback<'_>) -> Ended {
        tangent.solve(turn, self.pressure, again, &mut Monitor::new(Some(watch), Vec::new(), false))
    }
}
