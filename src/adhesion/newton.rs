//! Semismooth Newton's method for the total pressures. Each step predicts C by the natural map `q - e/a0 > 0`, and linearises the remaining
//! conditions:
//!
//! ```text
//! in C  e = 0,      outside  p = -sigma(e)
//! ```
//!
//! There are three kinds of steps ([`Pace`]):
//!
//! * Bold steps use the whole slope of the attraction. Far from the solution they linearise the exponential law at the mean of two distances: e,
//!   and the one at which the attraction is -p. Linearised at e alone, a steep law overshoots.
//! * Firm steps are bold ones whose linear systems are solved to smaller tolerances, and of which more are allowed.
//! * Cautious steps use only a part of the slope in three cases: far from the solution, while elements enter or leave the contact, and after a
//!   step with the whole slope has failed. Such a step lies between a Newton step and a step of descent, which uses no slope. It seldom moves an
//!   element from one of its states to another. Example: a sphere with nearly unstable elements (Tabor's parameter 3, 64 x 64 elements, kappa
//!   0.92) is pulled off in load steps of 0.1. Bold steps fail in 18 of 20 load steps, cautious ones in 9, with half the number of Newton steps.
//!
//! There is no line search. If the steps fail, descent follows ([`robust`](super::robust)).
//!
//!
//! With two periods pressure waves do not change the mean distance. As long as the approach is below this mean, not all elements are in contact.
//! If the natural map still puts all of them in contact, the pressures are lowered until some leave.
//!
//! A solve that starts from an earlier state keeps the contact area of that state in its first step. A change of the approach changes e in all of
//! C, and the natural map, which only knows the compliance of one element, would release the inside.

use super::law::Law;
use super::level::Level;
use super::system::{Linearised, Short, KEPT_PRODUCTS};
use super::unknowns::{is_small, Measured};
use crate::error::Result;
use crate::methods::fgmres::{Bordered, Until};
use crate::methods::fields;
use crate::operator::fft::Real;
use crate::progress::Monitor;

/// The largest number of bold steps, and of cautious ones far from the solution.
const MOST_STEPS: u64 = 20;
/// Above this residual a step is far from the solution. Its linear system is solved to the relative tolerance FAR_TOLERANCE, that of a step near
/// the solution to CLOSE_TOLERANCE. Firm steps have FIRM_TOLERANCES instead.
const CLOSE_RESIDUAL: f64 = 2e-2;
const FAR_TOLERANCE: f64 = 0.2;
const CLOSE_TOLERANCE: f64 = 0.1;
/// The largest distance of the place of linearisation from e, in ranges, on either side before the mean is taken.
const MOST_RANGES_FROM_E: f64 = 3.0;
/// The largest number of search directions of a linear solve on a small grid. A system that takes more is nearly singular. Larger grids have
/// IN_MEMORY directions. Grids of more than LARGE_GRID elements begin with FIRST_DIRECTIONS, and double this number after each solve for which it
/// was too small, up to IN_MEMORY.
pub const MOST_DIRECTIONS: usize = 30;
pub const IN_MEMORY: usize = 2 * KEPT_PRODUCTS;
const LARGE_GRID: usize = 1 << 16;
const FIRST_DIRECTIONS: usize = 6;
/// The part of the slope of the attraction that a cautious step uses.
const CAUTIOUS_SLOPE: f64 = 0.7;
/// The rise of the residual from which a step with the whole slope counts as failed. Without this test, steps between both edges of a smeared law
/// may recur for ever.
const FAILED_RISE: f64 = 2.0;
/// After a step with the whole slope has failed, the next one is tried when the residual is below this fraction of the residual before the failed
/// step.
const FULL_STEP_AGAIN: f64 = 0.1;
/// The largest number of cautious steps near the solution. Next to a fold of the branch they converge slowly.
const MOST_CAUTIOUS: u64 = 30;
/// The largest number of firm steps, and the relative tolerances of their linear systems far from the solution and near it.
const MOST_FIRM: u64 = 60;
const FIRM_TOLERANCES: [f64; 2] = [0.1, 0.03];
/// The largest s a0. The numbers are stored in single precision.
const LARGEST_STIFFNESS: f64 = 1e30;
/// The method has failed if a residual is not below this.
const LOST_RESIDUAL: f64 = 1e12;

/// How a sequence of steps ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// All residuals are within the tolerance, with a fresh product if the goal requires it.
    Solved,
    /// The largest number of steps is reached, or the residual is too large.
    Failed,
    /// The caller cancelled, or no cycle is left.
    Interrupted,
}

/// The kind of Newton steps (see the module).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// With the whole slope of the attraction.
    Bold,
    /// With a part of the slope, until the contact area is constant.
    Cautious,
    /// As bold ones, but with linear systems solved to smaller tolerances, and more steps.
    Firm,
}

/// The goal of a solve on one grid.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// The tolerance of the largest residual.
    pub tolerance: f64,
    /// The wanted sum of p. `None`: the approach is given.
    pub wanted: Option<f64>,
    /// Whether a fresh product has to confirm the residuals.
    pub certified: bool,
    /// The largest number of cycles on this grid.
    pub most: u64,
    /// The kind of Newton steps.
    pub pace: Pace,
}

impl Goal {
    /// Whether no cycle is left, or the caller cancelled.
    pub fn is_interrupted(&self, monitor: &Monitor<'_>) -> bool {
        monitor.is_cancelled() || monitor.count.cycles >= self.most
    }

    /// Whether the given force pulls.
    pub fn pulls(&self) -> bool {
        self.wanted.is_some_and(|wanted| wanted < 0.0)
    }
}

/// Iterates from the current iterate of the level. `keeps`: the first step keeps the contact area.
pub fn newton(level: &mut Level, goal: Goal, keeps: bool, monitor: &mut Monitor<'_>) -> Result<(End, Measured)> {
    let mut measured = Measured::default();
    let (mut last, mut whole_below) = (f64::INFINITY, f64::INFINITY);
    let (mut directions, most) = match level.now.u.len() {
        n if is_small(n) => (MOST_DIRECTIONS, MOST_DIRECTIONS),
        n if n <= LARGE_GRID => (IN_MEMORY, IN_MEMORY),
        _ => (FIRST_DIRECTIONS, IN_MEMORY),
    };
    for step in 0..=MOST_FIRM {
        measured = level.measure(keeps && step == 0, goal.wanted);
        if measured.opening > 0.0 {
            level.open();
            measured = level.measure(false, goal.wanted);
        }
        let worst = measured.worst();
        if worst < goal.tolerance && step > 0 {
            if !goal.certified {
                return Ok((End::Solved, measured));
            }
            level.refresh()?;
            measured = level.measure(false, goal.wanted);
            level.count_products(monitor);
            if measured.worst() < goal.tolerance {
                return Ok((End::Solved, measured));
            }
        }
        if goal.is_interrupted(monitor) {
            return Ok((End::Interrupted, measured));
        }
        let residual = measured.residual();
        let most_steps = match goal.pace {
            Pace::Firm => MOST_FIRM,
            Pace::Cautious if residual < CLOSE_RESIDUAL => MOST_CAUTIOUS,
            _ => MOST_STEPS,
        };
        if !(worst < LOST_RESIDUAL) || step >= most_steps {
            break;
        }
        if residual > FAILED_RISE * last {
            whole_below = FULL_STEP_AGAIN * last;
        }
        let is_far = residual > CLOSE_RESIDUAL
            || goal.pace == Pace::Cautious && (measured.changed > 0 || residual > whole_below);
        last = if is_far { f64::INFINITY } else { residual };
        if !take_step(level, goal, is_far, directions)? {
            directions = (2 * directions).min(most);
        }
        level.count_products(monitor);
        monitor.cycle_done(&level.problem.grid, 0, 0.0, worst);
    }
    Ok((End::Failed, measured))
}

/// Makes one step, far from the solution or near it, with at most `most` search directions. Returns whether these were enough.
fn take_step(level: &mut Level, Goal { wanted, pace, .. }: Goal, is_far: bool, most: usize) -> Result<bool> {
    let (n, threads) = (level.now.u.len(), level.problem.threads.clone());
    let mut fields = std::mem::take(&mut level.fields);
    let (mut stiffness, mut right) = (fields.take_of(n)?, fields.take(n)?);
    linearise(level, pace, is_far, &mut stiffness, &mut right);
    let [sum, count] =
        fields::sum(&threads, n, |i| [level.now.p.field[i][0], f64::from(u8::from(level.now.contact[i]))]);
    let border = [wanted.map_or(0.0, |wanted| wanted - sum)];
    let weight = if wanted.is_some() { 1.0 / f64::max(count, 1.0) } else { 0.0 };
    let r = Bordered { field: right, border };
    let norm = (fields::dot(&threads, &r.field, &r.field) + weight * border[0] * border[0]).sqrt();
    let [far, near] = if pace == Pace::Firm { FIRM_TOLERANCES } else { [FAR_TOLERANCE, CLOSE_TOLERANCE] };
    let until = Until { target: norm * if is_far { far } else { near }, most };
    let mut system = Linearised::new(level, &stiffness, wanted.is_some(), &mut fields)?;
    let found = system.solve(r, (until, weight), &threads, &mut fields)?;
    let is_enough = found.count < most;
    system.give(&mut fields);
    found.add_to(&mut level.now.p, &mut level.now.u, &threads, &mut fields);
    fields.give_of(stiffness);
    level.fields = fields;
    Ok(is_enough)
}

/// Computes s a0 outside the current contact area; 0 inside. `linearised_at(i, e)` is the distance at which element i is linearised.
pub fn stiffnesses<T: Real>(
    level: &Level,
    linearised_at: impl Fn(usize, f64) -> f64 + Sync + Send,
    stiffness: &mut [[T; 1]],
) {
    let (surface, now, a0) = (&level.surface, &level.now, level.self_influence());
    fields::fill(&level.problem.threads, stiffness, |i| {
        let e = surface.distance(i, now);
        if now.contact[i] || !e.is_finite() {
            return [T::zero()];
        }
        [T::of((surface.attraction.stiffness(surface.work_at(i), linearised_at(i, e)) * a0).min(LARGEST_STIFFNESS))]
    });
}

/// Computes s a0 and the right-hand side for the current contact area.
fn linearise(level: &Level, pace: Pace, is_far: bool, stiffness: &mut [Short], right: &mut [[f64; 1]]) {
    let (surface, now, a0, threads) = (&level.surface, &level.now, level.self_influence(), &level.problem.threads);
    let range = surface.attraction.range;
    let at_mean = is_far && pace != Pace::Cautious && surface.attraction.law == Law::Exponential;
    // The distance at which element i is linearised.
    let linearised_at = |i: usize, e: f64| {
        let e = e.max(0.0);
        match at_mean {
            false => e,
            true => {
                let of_pressure = surface.attraction.distance_of(surface.work_at(i), -now.p.field[i][0]);
                let of_pressure = if of_pressure.is_finite() { of_pressure.max(0.0) } else { e };
                (0.5 * (e + of_pressure.clamp(e - MOST_RANGES_FROM_E * range, e + MOST_RANGES_FROM_E * range))).max(0.0)
            }
        }
    };
    stiffnesses(level, linearised_at, stiffness);
    if is_far && pace == Pace::Cautious {
        fields::scale(threads, stiffness, CAUTIOUS_SLOPE);
    }
    let stiffness = &*stiffness;
    fields::fill(threads, right, |i| {
        let (e, p) = (surface.distance(i, now), now.p.field[i][0]);
        if now.contact[i] {
            return [-e / a0];
        }
        if !e.is_finite() {
            return [-p];
        }
        let at = linearised_at(i, e);
        [-(p + surface.traction(i, at) - f64::from(stiffness[i][0]) / a0 * (e - at))]
    });
}
