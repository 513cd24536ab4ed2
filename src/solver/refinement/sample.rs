//! Solves on small grids, from which prices are predicted.

use std::time::Instant;

use super::outlook::{across, History, Outlook, Values};
use super::solved::Solved;
use super::{on_grid, SurfaceCallback};
use crate::error::Result;
use crate::scene::{scaled, Scene};
use crate::solver::falling::Falling;
use crate::solver::quantities::Quantity;
use crate::solver::{Options, Outcome, Progress, ProgressCallback};

/// Samples are timed again, so often at most: the first solve of a size is slow, and machines are busy.
const AGAIN: usize = 3;

/// The callbacks of a sample: the surface, and whether to go on.
pub(super) type Callbacks<'c, 's, 'p> = (&'c mut Option<SurfaceCallback<'s>>, &'c mut Option<ProgressCallback<'p>>);

/// The end of a sample.
pub(super) enum Taken {
    Sample(Box<Sample>),
    /// By a callback.
    Cancelled,
    Unsolved,
}

/// Of an iteration: the residual, seconds since the start of the surface, products of the normal problem until then.
type Told = (f64, f64, f64);

/// The results of a small grid.
pub(super) struct Sample {
    pub(super) doublings: i32,
    pub(super) elements: f64,
    /// In the direction with fewer of them.
    pub(super) across: usize,
    values: Values,
    outlook: Outlook,
    quantity: Quantity,
    pub(super) bytes: f64,
    /// How far a step of bodies that relax may be off by its length, relative; 0: none relaxes.
    pub(super) time_error: f64,
    /// Each iteration.
    reached: Vec<Told>,
    /// Products of all, and those of the tangential problem among them.
    pub(super) products: f64,
    tangential: f64,
    pub(super) seconds: f64,
    /// Of which the set-up took so many.
    pub(super) setup: f64,
}

impl Sample {
    /// Solves once, and again for the time as long as there are seconds to spare.
    pub(super) fn take(
        scene: &Scene<'_>,
        options: &Options,
        (doublings, spare): (i32, f64),
        quantity: Quantity,
        (surface, progress): Callbacks<'_, '_, '_>,
    ) -> Result<Taken> {
        let (began, mut spent) = (Instant::now(), 0.0);
        let mut taken = Sample::take_once(scene, options, doublings, quantity, (surface, progress))?;
        for _ in 0..AGAIN {
            let Taken::Sample(best) = &mut taken else { break };
            if spent + 2.0 * best.seconds > spare {
                break;
            }
            match Sample::take_once(scene, options, doublings, quantity, (surface, progress))? {
                Taken::Sample(again) if again.seconds < best.seconds => *best = again,
                Taken::Cancelled => return Ok(Taken::Cancelled),
                _ => {}
            }
            spent = began.elapsed().as_secs_f64();
        }
        Ok(taken)
    }

    fn take_once(
        scene: &Scene<'_>,
        options: &Options,
        doublings: i32,
        quantity: Quantity,
        (surface, progress): Callbacks<'_, '_, '_>,
    ) -> Result<Taken> {
        let (began, mut reached) = (Instant::now(), Vec::new());
        let elements = scaled(&scene.grid, doublings)?.len();
        let mut watch = |told: &Progress| {
            if told.mx * told.my == elements {
                reached.push((told.residual, began.elapsed().as_secs_f64(), told.work_units));
            }
            progress.as_mut().is_some_and(|progress| progress(told))
        };
        let wanted = &[quantity];
        let solved =
            match on_grid(scene, (options, &wanted[..]), doublings, surface, &mut Some(&mut watch), &|_| false)? {
                Ok(solved) => solved,
                Err((Outcome::Cancelled, ..)) => return Ok(Taken::Cancelled),
                Err(_) => return Ok(Taken::Unsolved),
            };
        let Solved { solver, report, outlook, values } = solved;
        let seconds = began.elapsed().as_secs_f64();
        let (x, y) = across(solver.state(), solver.influence().repeats(solver.grid()));
        let tangential = report.tangential_products();
        Ok(Taken::Sample(Box::new(Sample {
            doublings,
            elements: elements as f64,
            across: x.min(y),
            values,
            outlook,
            quantity,
            bytes: report.bytes as f64,
            time_error: report.visco.map_or(0.0, |step| step.time_error),
            reached,
            products: report.count.work_units + tangential,
            tangential,
            seconds,
            setup: report.setup_seconds,
        })))
    }

    /// With the error that the values of this and coarser grids have.
    pub(super) fn carried_on(mut self, history: &mut History) -> Sample {
        history.add(self.doublings, &self.values, &mut self.outlook);
        self
    }

    /// The relative error of the quantity, on this and finer grids.
    pub(super) fn falling(&self) -> Option<Falling> {
        self.outlook.falling(self.quantity)
    }

    /// Seconds and products to a residual. A solve is a row of passes, the normal problem's, the tangential one's and their turns. A pass ends there: what it
    /// does beyond goes. What follows the last iteration of a pass is needed by any residual; where residuals rise another one has begun.
    pub(super) fn to(&self, tolerance: f64) -> (f64, f64) {
        let (mut seconds, mut products) = (self.seconds, self.products);
        let is_tangential = |pair: &&[Told]| pair[0].2 == pair[1].2;
        let tangential = |told: &[Told]| told.windows(2).filter(is_tangential).count() as f64;
        // Its products are told at the end only: each iteration has the same.
        let each = self.tangential / tangential(&self.reached).max(1.0);
        let goes_on = |one: &Told, next: &Told| (one.0 <= tolerance) == (next.0 <= tolerance) && next.0 <= one.0;
        for met in self.reached.chunk_by(goes_on).filter(|met| met[0].0 <= tolerance) {
            // An iteration of several parts is told of by each of them.
            let parts = met.iter().take_while(|told| told.0 == met[0].0).count();
            let (at, end) = (&met[parts - 1..], met[met.len() - 1]);
            (seconds, products) = (seconds - (end.1 - at[0].1), products - (end.2 - at[0].2) - each * tangential(at));
        }
        (seconds, products)
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/sample.rs"]
mod tests;
