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
    /// Of each iteration: the residual, seconds since the start of the surface, products until then.
    reached: Vec<(f64, f64, f64)>,
    /// Products of all.
    pub(super) products: f64,
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
            products: report.count.work_units + report.friction.map_or(0.0, |found| found.products),
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

    /// Seconds and products to a residual: what follows the last iteration is needed by any.
    pub(super) fn to(&self, tolerance: f64) -> (f64, f64) {
        let Some(&end) = self.reached.last() else { return (self.seconds, self.products) };
        let mut met = self.reached.iter().skip_while(|(residual, ..)| !(*residual <= tolerance));
        let first = met.next().unwrap_or(&end);
        // An iteration of several parts is told of by each of them.
        let at = met.take_while(|(residual, ..)| *residual == first.0).last().unwrap_or(first);
        (self.seconds - (end.1 - at.1), self.products - (end.2 - at.2))
    }
}
