//! A table of tangential problems with the same pressures, one for each motion or force, spread over threads.
//!
//! Entries are solved in runs of [`RUN`] consecutive entries. The first of a run starts from rest, each other one from
//! the tractions of the one before, unless that is [far](NEAR_CREEPAGE) away. An entry that ends without its
//! certificate is solved again from rest. Runs do not depend on the thread: the results have the same bits for any
//! number of threads.

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

/// Entries of a run.
pub const RUN: usize = 16;
/// Difference of forces over mu N from which entries are far apart. Starts at a distance of .03 take 16 products in the mean, of .1 28, of .3 49,
/// from rest 25 (circles and ellipses of 35 x 35 elements).
const NEAR_FORCE: f64 = 0.05;
/// Relative difference of creepages, and of spin times the radius of the contact area, from which entries are far apart. Starts at a distance of .01
/// take 10 products in the mean, of .1 14, of .4 18, from rest 16.
const NEAR_CREEPAGE: f64 = 0.1;

/// The motion or force of one entry of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Entry {
    /// In x and in y: the force if the scene's friction prescribes it, else the creepage.
    pub amount: [f64; 2],
    /// phi.
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

    /// The friction of a table with the motion or force of this entry.
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

/// The outcome and the report of an entry; `Outcome::Cancelled`: it was not solved.
pub type Ended = Result<(Outcome, friction::Report)>;

/// The inputs of all workers, and their common progress.
pub(super) struct Table<'a> {
    scene: &'a Scene<'a>,
    friction: &'a Friction<'a>,
    pressure: &'a [f64],
    entries: &'a [Entry],
    options: &'a Options,
    /// Difference below which forces are near.
    near_force: f64,
    /// The radius of a circle with the contact area.
    radius: f64,
    done: Done,
}

/// The progress so far.
#[derive(Default)]
struct Done {
    /// Runs taken, besides the first one, which is the caller's.
    taken: AtomicUsize,
    entries: AtomicUsize,
    products: Mutex<f64>,
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
        // The yield limit is that of fresh particles, which suffices for a distance.
        let layer =
            friction.layer.filter(|_| friction.has_ideal_layer()).map_or(f64::INFINITY, |layer| layer.yield_limit);
        let bounds = pressure.iter().enumerate().map(|(i, p)| (friction.coefficient.at(i) * p.max(0.0)).min(layer));
        let near_force = NEAR_FORCE * in_blocks(bounds) * scene.grid.element_area();
        let contact = pressure.iter().filter(|p| **p > 0.0).count() as f64 * scene.grid.element_area();
        let radius = (contact / std::f64::consts::PI).sqrt();
        Table { scene, friction, pressure, entries, options, near_force, radius, done: Done::default() }
    }

    /// Solves all entries, unless `outcome` of the normal problem is CANCELLED. `crew`: workers of one thread; missing ones are made. Returns the
    /// outcome and the seconds.
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
        // Set up before any entry is solved, so that lack of memory loses no entry.
        let missing = (crew.len()..workers).map(|_| Tangent::new(self.scene, self.options, &Threads::One));
        let missing = collected(missing, "the workers of a table")?;
        crew.extend(missing.into_iter().collect::<Result<Vec<_>>>()?);
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
            // On a short table others could take all runs before the caller has one: then progress would not be called, and could not cancel.
            |tangent| {
                self.run(0, tangent, &mut told, found);
                self.work(tangent, &mut told, found);
            },
            |tangent| self.work(tangent, &mut |_| (), found),
        );
        let outcome = if self.is_cancelled() { Outcome::Cancelled } else { outcome };
        Ok((outcome, began.elapsed().as_secs_f64()))
    }

    /// Takes runs until there are none left; `told` gets the residual of each entry.
    fn work(
        &self,
        tangent: &mut Tangent,
        told: &mut dyn FnMut(f64),
        found: &(impl Fn(usize, Ended, Option<&Solution>) + Sync + Send),
    ) {
        while self.done.taken.load(Ordering::Relaxed) < self.entries.len().div_ceil(RUN) {
            self.run(1 + self.done.taken.fetch_add(1, Ordering::Relaxed), tangent, told, found);
        }
    }

    /// Solves the entries of a run; none beyond the table.
    fn run(
        &self,
        run: usize,
        tangent: &mut Tangent,
        told: &mut dyn FnMut(f64),
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
                told(residual);
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
        force.sqrt() <= self.near_force && motion.sqrt() <= NEAR_CREEPAGE * size.sqrt()
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
        // The tables are the scene's, which are checked.
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

    fn step(&self, tangent: &mut Tangent, turn: &Turn<'_>, again: bool, watch: ProgressCallback<'_>) -> Ended {
        tangent.solve(turn, self.pressure, again, &mut Monitor::new(Some(watch), Vec::new(), false))
    }
}
