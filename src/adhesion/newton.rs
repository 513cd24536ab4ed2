//! Semismooth Newton on total pressures. Each step predicts C by the natural map `q - e/a0 > 0` and linearises the rest:
//!
//! ```text
//! in C  e = 0,      outside  p = -sigma(e)
//! ```
//!
//! Far from the solution bold and firm steps linearise the exponential law at the mean of e and of the distance whose attraction is -p: at e alone
//! the tangent of a steep law overshoots. There is no line search: if steps fail, descent follows ([`robust`](super::robust)).
//!
//! A cautious step uses a part of the slope of the attraction in three cases: far from the solution, while elements enter or leave the contact, and
//! after a full step has failed. It lies between a Newton step and a step of descent, which uses no slope. Such steps seldom jump from one state of
//! an element to another. Example: a sphere with nearly unstable elements (Tabor's parameter 3, 64 x 64 elements, kappa 0.92) is pulled off in steps
//! of 0.1. Bold steps fail at 18 of 20 of these, cautious ones at 9, with half the number of steps.
//!
//! With two periods waves do not change the mean distance. As long as the approach is below it, not all elements touch: if all touch by the
//! natural map, pressures are lowered until some leave.
//!
//! A warm start keeps the last contact area in its first step. A change of the approach raises e in all of C, and the natural map, based on the
//! compliance of one element, would release the inside.

use super::law::Law;
use super::level::Level;
use super::system::{Linearised, Short, KEPT_PRODUCTS};
use super::unknowns::{is_small, Measured};
use crate::error::Result;
use crate::methods::fgmres::{Bordered, Until};
use crate::methods::fields;
use crate::operator::fft::Real;
use crate::progress::Monitor;

/// Most steps.
const MOST_STEPS: u64 = 20;
/// Above this residual a step is far from the solution. Its linear system is solved to `FAR_TOLERANCE`, that of a step near the solution to
/// `CLOSE_TOLERANCE`. Firm steps have `FIRM_TOLERANCES` for both.
const CLOSE_RESIDUAL: f64 = 2e-2;
const FAR_TOLERANCE: f64 = 0.2;
const CLOSE_TOLERANCE: f64 = 0.1;
/// Largest distance of the place of linearisation from e, in ranges.
const MOST_RANGES_FROM_E: f64 = 3.0;
/// Most directions of a linear solve: systems that take more are nearly singular. Grids that are not small have `IN_MEMORY`, those of more than
/// `LARGE_GRID` elements `FIRST_DIRECTIONS`, doubled after each solve for which they were too few.
pub const MOST_DIRECTIONS: usize = 30;
pub const IN_MEMORY: usize = 2 * KEPT_PRODUCTS;
const LARGE_GRID: usize = 1 << 16;
const FIRST_DIRECTIONS: usize = 6;
/// The part of the slope in a cautious step.
const CAUTIOUS_SLOPE: f64 = 0.7;
/// Rise of the residual at which a full step counts as failed: steps between both edges of a smeared law may recur for ever.
const FAILED_RISE: f64 = 2.0;
/// The next full step is tried below this part of the residual of the failed one.
const FULL_STEP_AGAIN: f64 = 0.1;
/// Most cautious steps below [`CLOSE_RESIDUAL`]: next to a fold of the branch they converge slowly.
const MOST_CAUTIOUS: u64 = 30;
/// Most firm steps, and the relative tolerances of their linear systems far from the solution and near it.
const MOST_FIRM: u64 = 60;
const FIRM_TOLERANCES: [f64; 2] = [0.1, 0.03];
/// Largest s a0, which is stored in single precision.
const LARGEST_STIFFNESS: f64 = 1e30;
/// Steps have failed if the residual is not below this.
const LOST_RESIDUAL: f64 = 1e12;

/// How a loop ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The measures are met, with a fresh product if required.
    Solved,
    /// Steps make no more progress.
    Failed,
    /// The caller cancelled, or no cycle is left.
    Interrupted,
}

/// How steps are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// With the whole slope of the attraction.
    Bold,
    /// With a part of it, until the contact area is constant.
    Cautious,
    /// As bold ones, but with linear systems solved to smaller tolerances, and more steps.
    Firm,
}

/// The goal of a loop on one grid.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// The tolerance of the worst measure.
    pub tolerance: f64,
    /// The sum of p, if the force is given.
    pub wanted: Option<f64>,
    /// Whether a fresh product has to confirm the measures.
    pub certified: bool,
    /// Most cycles on the finest grid.
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

/// Iterates from the level's state. `keeps`: the first step keeps its contact area.
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

/// Makes one step, with at most `most` directions, far from the solution or near it. Returns whether these were enough.
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

/// s a0 outside the present contact area; `place(i, e)` is the distance at which element i is linearised.
pub fn stiffnesses<T: Real>(level: &Level, place: impl Fn(usize, f64) -> f64 + Sync + Send, stiffness: &mut [[T; 1]]) {
    let (surface, now, a0) = (&level.surface, &level.now, level.self_influence());
    fields::fill(&level.problem.threads, stiffness, |i| {
        let e = surface.distance(i, now);
        if now.contact[i] || !e.is_finite() {
            return [T::zero()];
        }
        [T::of((surface.attraction.stiffness(surface.work_at(i), place(i, e)) * a0).min(LARGEST_STIFFNESS))]
    });
}

/// s and the right-hand side for the present contact area.
fn linearise(level: &Level, pace: Pace, is_far: bool, stiffness: &mut [Short], right: &mut [[f64; 1]]) {
    let (surface, now, a0, threads) = (&level.surface, &level.now, level.self_influence(), &level.problem.threads);
    let range = surface.attraction.range;
    let at_mean = is_far && pace != Pace::Cautious && surface.attraction.law == Law::Exponential;
    // The distance at which element i is linearised.
    let place = |i: usize, e: f64| {
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
    stiffnesses(level, place, stiffness);
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
        let at = place(i, e);
        [-(p + surface.traction(i, at) - f64::from(stiffness[i][0]) / a0 * (e - at))]
    });
}
