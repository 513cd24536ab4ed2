//! Samples: solves on small grids from which the price list is predicted.

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

/// Most repetitions of a sample for its seconds: the first solve of a size is slow, and other programs may disturb any solve.
const REPEATED_TIMINGS: usize = 3;

/// The caller's callbacks: the surface, and the progress.
pub(super) type Callbacks<'c, 's, 'p> = (&'c mut Option<SurfaceCallback<'s>>, &'c mut Option<ProgressCallback<'p>>);

/// How a sample ended.
pub(super) enum Taken {
    Sample(Box<Sample>),
    /// A callback cancelled.
    Cancelled,
    /// The solve did not converge, with this outcome, or was refused.
    Unsolved(Outcome),
}

/// A callback cancelled.
pub(super) struct Cancelled;

/// An iteration, as the progress callback saw it.
#[derive(Clone, Copy)]
struct Iteration {
    /// The relative residual.
    residual: f64,
    /// Seconds since the sample was begun.
    seconds: f64,
    /// Products of the normal problem so far, in work units.
    normal: f64,
}

/// The results of a small grid.
pub(super) struct Sample {
    /// Doublings from the scene's grid to this one; negative: halvings.
    pub(super) doublings: i32,
    /// The cost of a solve to `tolerance`.
    pub(super) cost: Cost,
    /// Seconds of set-up and solve; without those of the surface callback, of stresses and of the stiffness.
    pub(super) solve: f64,
    tolerance: f64,
    /// Elements across the contact, in the direction with fewer of them.
    pub(super) across: usize,
    values: Values,
    outlook: Outlook,
    /// The quantity whose accuracies have a price.
    quantity: Quantity,
    pub(super) bytes: f64,
    /// The relative error from the length of the time step of relaxing bodies; 0 if no body relaxes.
    pub(super) time_error: f64,
    /// The iterations on this grid, in order.
    iterations: Vec<Iteration>,
    /// Products of the tangential problem.
    tangential: f64,
    /// The costs of a solve to a larger tolerance, if known.
    loose: Option<Loose>,
}

/// The costs of a solve to a larger (loose) tolerance, relative to those to the (tight) tolerance of the sample. They are measured by a second solve.
/// The iterations of the tight solve alone do not tell them, for three reasons: iterations of the tangential problem do not report products, problems
/// of unlike bodies are solved again in each turn, and a loose solve of the coarser grids gives another start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Loose {
    tolerance: f64,
    /// Seconds over those of the tight solve.
    seconds: f64,
    /// Products of the tangential problem over those of the tight solve.
    tangential: f64,
    /// Products of the normal problem over those predicted by the iterations of the tight solve.
    normal: f64,
}

/// The work of a solve after a residual was reached.
#[derive(Clone, Copy, Default)]
struct Work {
    seconds: f64,
    /// Products of the normal problem.
    normal: f64,
    /// Iterations of the tangential problem.
    tangential_iterations: f64,
}

impl Sample {
    /// Solves a small grid, and repeats the solve within the `spare` seconds. The fastest solve is the sample.
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

    /// Solves a small grid once, and computes the wanted values.
    fn take_once(
        scene: &Scene<'_>,
        options: &Options,
        (doublings, wanted): (i32, &[Quantity]),
        (surface, progress): Callbacks<'_, '_, '_>,
    ) -> Result<Taken> {
        let (began, mut iterations) = (Instant::now(), Vec::new());
        let elements = scaled(scene, doublings)?.len();
        let mut watch = |told: &Progress| {
            // Steps of the computation of stresses and of the stiffness report work units of 0.
            if told.mx * told.my == elements && told.work_units > 0.0 {
                let (residual, seconds, normal) = (told.residual, began.elapsed().as_secs_f64(), told.work_units);
                iterations.push(Iteration { residual, seconds, normal });
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
            iterations,
            tangential,
            loose: None,
        })))
    }

    /// Sets `loose`: solves again to the larger tolerance of `options`, or copies the relative costs of the sample `before` if that is given.
    /// Cancelled: a callback cancelled.
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
                    normal: (again.cost.products - again.tangential)
                        / self.predicted_normal_products(tolerance).max(1.0),
                });
            }
            Taken::Cancelled => return Ok(Outcome::Cancelled),
            Taken::Unsolved(_) => {}
        }
        Ok(Outcome::Converged)
    }

    /// Counts the products of a solve on a grid to the tolerance of `options`. None if the solve fails.
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

    /// The position of a tolerance between the tight one (0) and the loose one (1), on a logarithmic scale; and the costs of the loose one.
    fn position(&self, tolerance: f64) -> Option<(f64, Loose)> {
        let loose = self.loose?;
        let position = (tolerance / self.tolerance).ln() / (loose.tolerance / self.tolerance).ln();
        Some((if position.is_finite() { position.clamp(0.0, 1.0) } else { 0.0 }, loose))
    }

    /// For a scene with friction: the seconds to a tolerance over those of the tight solve, and the tangential products to that tolerance. Both are
    /// interpolated between the tight and the loose solve. None without friction, or without a loose solve.
    pub(super) fn with_friction(&self, tolerance: f64) -> Option<(f64, f64)> {
        let (position, loose) = self.position(tolerance).filter(|_| self.tangential > 0.0)?;
        Some((1.0 + position * (loose.seconds - 1.0), self.tangential * (1.0 + position * (loose.tangential - 1.0))))
    }

    /// The sample with the error that follows from its value and those of the coarser grids in `history`.
    pub(super) fn with_history(mut self, history: &mut History) -> Sample {
        history.add(self.doublings, &self.values, &mut self.outlook);
        self
    }

    /// Whether the quantity is exactly 0, because there is no contact on the grid of the scene or a finer one.
    pub(super) fn is_exact(&self) -> bool {
        self.across == 0 && self.doublings >= 0 && self.value() == Some(0.0)
    }

    pub(super) fn value(&self) -> Option<f64> {
        self.values.of_wanted.first().and_then(|value| value.ok().map(|found| found.value))
    }

    /// The relative error of the quantity on this and finer grids; None if unknown.
    pub(super) fn error(&self) -> Option<Falling> {
        self.outlook.error(self.quantity)
    }

    /// The seconds and the products of a solve to a tolerance. On a finer grid, which starts closer to the solution, the iterations to this tolerance
    /// are those to the `equivalent` tolerance here.
    pub(super) fn cost_to(&self, tolerance: f64, equivalent: f64) -> (f64, f64) {
        let beyond = self.work_beyond(equivalent);
        // Only the sum of the tangential products is known: each iteration gets an equal share.
        let each = self.tangential / tangential_iterations(&self.iterations).max(1.0);
        let tangential = self.tangential - each * beyond.tangential_iterations;
        (self.cost.seconds - beyond.seconds, self.normal_products(tolerance, equivalent) + tangential)
    }

    /// The products of the normal problem in [`cost_to`](Sample::cost_to).
    pub(super) fn normal_products(&self, tolerance: f64, equivalent: f64) -> f64 {
        let factor = self.position(tolerance).map_or(1.0, |(position, loose)| 1.0 + position * (loose.normal - 1.0));
        factor * self.predicted_normal_products(equivalent)
    }

    /// The products of the normal problem to a tolerance, as the iterations of the tight solve predict them.
    fn predicted_normal_products(&self, tolerance: f64) -> f64 {
        self.cost.products - self.tangential - self.work_beyond(tolerance).normal
    }

    /// The work of the solve that a larger tolerance saves. A solve is a sequence of passes: of the normal problem, of the tangential problem, and of
    /// their turns. Each pass would end when its residual is at most `tolerance`. Work between the last iteration of a pass and the next pass is
    /// needed for any tolerance. A pass ends where the residual increases.
    fn work_beyond(&self, tolerance: f64) -> Work {
        let is_same_pass = |one: &Iteration, next: &Iteration| {
            (one.residual <= tolerance) == (next.residual <= tolerance) && next.residual <= one.residual
        };
        let saved = self.iterations.chunk_by(is_same_pass).filter(|pass| pass[0].residual <= tolerance);
        saved.fold(Work::default(), |sum, pass| {
            // An iteration of several parts reports each part with the same residual. The last part of the first iteration is still needed.
            let parts = pass.iter().take_while(|one| one.residual == pass[0].residual).count();
            let (rest, end) = (&pass[parts - 1..], pass[pass.len() - 1]);
            Work {
                seconds: sum.seconds + end.seconds - rest[0].seconds,
                normal: sum.normal + end.normal - rest[0].normal,
                tangential_iterations: sum.tangential_iterations + tangential_iterations(rest),
            }
        })
    }
}

/// The number of iterations of the tangential problem: those before which no product of the normal problem was made.
fn tangential_iterations(iterations: &[Iteration]) -> f64 {
    iterations.windows(2).filter(|pair| pair[0].normal == pair[1].normal).count() as f64
}

#[cfg(test)]
#[path = "../../../tests/unit/sample.rs"]
mod tests;
