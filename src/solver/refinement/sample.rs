//! Solves on small grids for the prediction of prices.

use std::time::Instant;

use super::outlook::{across, History, Outlook, Values};
use super::solved::Solved;
use super::{on_grid, SurfaceCallback};
use crate::error::Result;
use crate::scene::{scaled, Scene};
use crate::solver::falling::Falling;
use crate::solver::quantities::Quantity;
use crate::solver::seconds::Cost;
use crate::solver::{Options, Outcome, Progress, ProgressCallback};

/// Most repeated timings of a sample: the first solve of a size is slow, and machines are busy.
const REPEATED_TIMINGS: usize = 3;

/// The callbacks of a sample: the surface, and whether to go on.
pub(super) type Callbacks<'c, 's, 'p> = (&'c mut Option<SurfaceCallback<'s>>, &'c mut Option<ProgressCallback<'p>>);

/// The end of a sample.
pub(super) enum Taken {
    Sample(Box<Sample>),
    /// Cancelled by a callback.
    Cancelled,
    /// Not solved, with this outcome.
    Unsolved(Outcome),
}

/// Cancelled by a callback.
pub(super) struct Cancelled;

/// An iteration: the residual, seconds since the start of the surface, products of the normal problem so far.
type Told = (f64, f64, f64);

/// The results of a small grid.
pub(super) struct Sample {
    pub(super) doublings: i32,
    /// The cost of a solve to its tolerance, by one thread or by all.
    pub(super) cost: Cost,
    /// Seconds without those of stresses and of the stiffness.
    pub(super) solve: f64,
    tolerance: f64,
    /// Elements across the contact, in the direction with fewer.
    pub(super) across: usize,
    values: Values,
    outlook: Outlook,
    quantity: Quantity,
    pub(super) bytes: f64,
    /// The relative error of a step of relaxing bodies by its length; 0: no body relaxes.
    pub(super) time_error: f64,
    /// The iterations.
    reached: Vec<Told>,
    /// Products of the tangential problem.
    tangential: f64,
    /// The costs of a looser tolerance, if known.
    loose: Option<Loose>,
}

/// The seconds and tangential products of a loose tolerance, relative to those of a tight one. Tangential iterations do not report products, problems
/// of unlike bodies are solved again in each turn, and a loose start on coarse grids differs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Loose {
    tolerance: f64,
    seconds: f64,
    tangential: f64,
    /// Products of the normal problem over those predicted by the iterations of the tight solve.
    normal: f64,
}

impl Sample {
    /// Solves once, and again for the timing within the seconds available.
    pub(super) fn take(
        scene: &Scene<'_>,
        options: &Options,
        (doublings, spare): (i32, f64),
        quantity: Quantity,
        (surface, progress): Callbacks<'_, '_, '_>,
    ) -> Result<Taken> {
        let (began, mut spent) = (Instant::now(), 0.0);
        let mut taken = Sample::take_once(scene, options, (doublings, &[quantity]), (surface, progress))?;
        for _ in 0..REPEATED_TIMINGS {
            let Taken::Sample(best) = &mut taken else { break };
            if spent + 2.0 * best.cost.seconds > spare {
                break;
            }
            match Sample::take_once(scene, options, (doublings, &[quantity]), (surface, progress))? {
                Taken::Sample(again) if again.cost.seconds < best.cost.seconds => *best = again,
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
        (doublings, wanted): (i32, &[Quantity]),
        (surface, progress): Callbacks<'_, '_, '_>,
    ) -> Result<Taken> {
        let (began, mut reached) = (Instant::now(), Vec::new());
        let elements = scaled(scene, doublings)?.len();
        let mut watch = |told: &Progress| {
            // Stresses and the stiffness have no work.
            if told.mx * told.my == elements && told.work_units > 0.0 {
                reached.push((told.residual, began.elapsed().as_secs_f64(), told.work_units));
            }
            progress.as_mut().is_some_and(|progress| progress(told))
        };
        let solved = match on_grid(scene, (options, wanted), doublings, surface, &mut Some(&mut watch), &|_| false)? {
            Ok(solved) => solved,
            Err((Outcome::Cancelled, ..)) => return Ok(Taken::Cancelled),
            Err((outcome, ..)) => return Ok(Taken::Unsolved(outcome)),
        };
        let Solved { solver, report, outlook, values } = solved;
        let seconds = began.elapsed().as_secs_f64();
        let (x, y) = across(solver.state(), solver.influence().repeats(solver.grid()), &scene.grid);
        let tangential = report.tangential_products();
        Ok(Taken::Sample(Box::new(Sample {
            doublings,
            cost: Cost {
                elements: elements as f64,
                seconds,
                setup: report.setup_seconds + report.coarse_seconds,
                products: report.count.work_units + tangential,
            },
            solve: report.setup_seconds + report.solve_seconds,
            tolerance: options.tolerance,
            across: x.min(y),
            values,
            outlook,
            quantity: wanted.first().copied().unwrap_or(Quantity::Force),
            bytes: report.bytes as f64,
            time_error: report.visco.map_or(0.0, |step| step.time_error),
            reached,
            tangential,
            loose: None,
        })))
    }

    /// Solves again to a loose tolerance, or takes the costs of the sample `before`. Cancelled: by a callback.
    pub(super) fn loosen(
        &mut self,
        scene: &Scene<'_>,
        options: &Options,
        before: Option<&Sample>,
        callbacks: Callbacks<'_, '_, '_>,
    ) -> Result<Outcome> {
        let tolerance = options.tolerance;
        if let Some(before) = before {
            self.loose = before.loose;
        } else if tolerance <= self.tolerance {
            self.loose = Some(Loose { tolerance, seconds: 1.0, tangential: 1.0, normal: 1.0 });
        }
        if self.loose.is_some() {
            return Ok(Outcome::Converged);
        }
        match Sample::take_once(scene, options, (self.doublings, &[]), callbacks)? {
            Taken::Sample(again) => {
                self.loose = Some(Loose {
                    tolerance,
                    seconds: (1.0 - (self.solve - again.solve) / self.cost.seconds).min(1.0),
                    tangential: (again.tangential / self.tangential.max(1.0)).min(1.0),
                    normal: (again.cost.products - again.tangential) / self.told(tolerance).max(1.0),
                });
            }
            Taken::Cancelled => return Ok(Outcome::Cancelled),
            Taken::Unsolved(_) => {}
        }
        Ok(Outcome::Converged)
    }

    /// The products of a grid to a tolerance, by a solve. Cancelled: by a callback.
    pub(super) fn count(
        scene: &Scene<'_>,
        options: &Options,
        doublings: i32,
        callbacks: Callbacks<'_, '_, '_>,
    ) -> Result<std::result::Result<Option<f64>, Cancelled>> {
        Ok(match Sample::take_once(scene, options, (doublings, &[]), callbacks)? {
            Taken::Sample(sample) => Ok(Some(sample.cost.products)),
            Taken::Unsolved(_) => Ok(None),
            Taken::Cancelled => Err(Cancelled),
        })
    }

    /// The place of a tolerance between the tight and the loose one, by logarithms, with the costs of the loose one.
    fn on_the_way(&self, tolerance: f64) -> Option<(f64, Loose)> {
        let loose = self.loose?;
        let at = (tolerance / self.tolerance).ln() / (loose.tolerance / self.tolerance).ln();
        Some((if at.is_finite() { at.clamp(0.0, 1.0) } else { 0.0 }, loose))
    }

    /// With friction: the part of the seconds and the tangential products to a tolerance, interpolated between the solves. None: unknown.
    pub(super) fn between(&self, tolerance: f64) -> Option<(f64, f64)> {
        let (at, loose) = self.on_the_way(tolerance).filter(|_| self.tangential > 0.0)?;
        Some((1.0 + at * (loose.seconds - 1.0), self.tangential * (1.0 + at * (loose.tangential - 1.0))))
    }

    /// The sample with the error from its values and those of coarser grids.
    pub(super) fn carried_on(mut self, history: &mut History) -> Sample {
        history.add(self.doublings, &self.values, &mut self.outlook);
        self
    }

    /// Whether the quantity is exactly 0, as nothing touches on the grid of the scene or a finer one.
    pub(super) fn is_exact(&self) -> bool {
        self.across == 0 && self.doublings >= 0 && self.value() == Some(0.0)
    }

    /// The value of the quantity.
    pub(super) fn value(&self) -> Option<f64> {
        self.values.of_wanted.first().and_then(|value| value.ok().map(|found| found.value))
    }

    /// The relative error of the quantity, on this and finer grids.
    pub(super) fn falling(&self) -> Option<Falling> {
        self.outlook.falling(self.quantity)
    }

    /// Seconds and products to a residual; `begins`: the looser residual here that takes as long as that one on finer grids.
    pub(super) fn to(&self, tolerance: f64, begins: f64) -> (f64, f64) {
        let beyond = self.beyond(begins);
        // Tangential products are reported at the end only: iterations have equal shares.
        let each = self.tangential / tangential_iterations(&self.reached).max(1.0);
        let tangential = self.tangential - each * beyond.2;
        (self.cost.seconds - beyond.0, self.normal(tolerance, begins) + tangential)
    }

    /// Products of the normal problem to a residual; `begins`: the looser residual here that takes as long as that one on finer grids.
    pub(super) fn normal(&self, tolerance: f64, begins: f64) -> f64 {
        let more = self.on_the_way(tolerance).map_or(1.0, |(at, loose)| 1.0 + at * (loose.normal - 1.0));
        more * self.told(begins)
    }

    /// Products of the normal problem to a residual, by the iterations.
    fn told(&self, tolerance: f64) -> f64 {
        self.cost.products - self.tangential - self.beyond(tolerance).1
    }

    /// The work beyond a residual: seconds, products of the normal problem, iterations of the tangential one. A solve is a sequence of passes, of the
    /// normal problem, the tangential one and their turns, each of which would end at the residual. Work after the last iteration of a pass is needed
    /// by any residual. A rise of the residual begins another pass.
    fn beyond(&self, tolerance: f64) -> (f64, f64, f64) {
        let goes_on = |one: &Told, next: &Told| (one.0 <= tolerance) == (next.0 <= tolerance) && next.0 <= one.0;
        let met = self.reached.chunk_by(goes_on).filter(|met| met[0].0 <= tolerance);
        met.fold((0.0, 0.0, 0.0), |(seconds, normal, tangential), met| {
            // An iteration of several parts is reported by each part.
            let parts = met.iter().take_while(|told| told.0 == met[0].0).count();
            let (at, end) = (&met[parts - 1..], met[met.len() - 1]);
            (seconds + end.1 - at[0].1, normal + end.2 - at[0].2, tangential + tangential_iterations(at))
        })
    }
}

/// Iterations of the tangential problem: no product of the normal one lies before them.
fn tangential_iterations(told: &[Told]) -> f64 {
    told.windows(2).filter(|pair| pair[0].2 == pair[1].2).count() as f64
}

#[cfg(test)]
#[path = "../../../tests/unit/sample.rs"]
mod tests;
