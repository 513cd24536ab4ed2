//! Semismooth Newton on total pressures. Each step predicts C by the natural map `q - e/a0 > 0` and linearises the rest:
//!
//! ```text
//! in C  e = 0,      outside  p = -sigma(e)
//! ```
//!
//! Far from the solution the exponential law is linearised at the mean of e and of the distance that -p belongs to: from e alone the tangent of a steep
//! law reaches too far. There is no line search: where steps fail descent takes over ([`robust`](super::robust)).
//!
//! A cautious step takes a part of the slope of the attraction alone, as long as elements enter or leave the contact, and wherever a whole one went wrong:
//! between the step of Newton's method and that of descent, which takes none. Steps then hardly jump from one state of an element to another. A sphere whose
//! elements are nearly unstable in their own springs (Tabor's parameter 3, 64 x 64 elements, kappa 0.92) is drawn off in steps of 0.1: bold steps fail
//! at 18 of 20 of them, cautious ones at 9, with half the steps in all.
//!
//! With two periods waves leave the mean of the distances. As long as the approach is below it, not all elements touch: where all do by the natural map,
//! pressures are lowered until some leave.
//!
//! A warm start keeps the last contact area in its first step. A change of the approach lifts e in all of C, and the natural map, which knows
//! the compliance of one element only, would release the inside.

use super::law::Law;
use super::level::Level;
use super::system::{Linearised, Short, PRODUCTS};
use super::unknowns::{is_small, Measured};
use crate::error::Result;
use crate::methods::fgmres::{Bordered, Until};
use crate::methods::fields;
use crate::operator::fft::Real;
use crate::progress::Monitor;

/// Steps at most.
const MOST_STEPS: u64 = 20;
/// Above this residual a step linearises at the mean distance, and its linear system is solved to `FAR`; below to `NEAR`.
const CLOSE: f64 = 2e-2;
const FAR: f64 = 0.2;
const NEAR: f64 = 0.1;
/// The mean distance lies within so many ranges of e.
const WITHIN: f64 = 3.0;
/// Directions of a linear solve at most: what takes more is a system that is nearly singular. On grids that are not small they are `IN_MEMORY`; on those of more
/// than `LARGE` elements `AT_FIRST`, and twice as many after each solve that they are too few for.
const DIRECTIONS: usize = 30;
pub const IN_MEMORY: usize = 2 * PRODUCTS;
const LARGE: usize = 1 << 16;
const AT_FIRST: usize = 6;
/// The part of the slope that a cautious step takes.
const CAUTIOUS: f64 = 0.7;
/// A whole step went wrong if the residual has risen by this factor: steps from one edge of a smeared law to the other may go on for ever.
const RISEN: f64 = 2.0;
/// The next one is tried below this part of the residual that it was tried at.
const AGAIN: f64 = 0.1;
/// Cautious steps at most, as long as they are close: next to a fold of the branch they are slow.
const MOST_CAUTIOUS: u64 = 30;
/// Firm steps at most, and the parts of the right-hand side to which their linear systems are solved, far from the solution and near it.
const MOST_FIRM: u64 = 60;
const FIRM: [f64; 2] = [0.1, 0.03];
/// s a0 is never taken for more: it is stored in single precision.
const STIFFEST: f64 = 1e30;
/// A residual beyond that is a failure.
const LOST: f64 = 1e12;

/// How a loop ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The measures are met; where it is asked for, with a fresh product.
    Solved,
    /// No step brings more.
    Failed,
    /// The caller cancelled, or no cycle is left.
    Interrupted,
}

/// How steps are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// With the whole slope of the attraction.
    Bold,
    /// With a part of it, until the contact area stands still.
    Cautious,
    /// As bold ones, but their linear systems are solved firmly, and there are more of them.
    Firm,
}

/// The goal of a loop on one grid.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// Of the worst measure.
    pub tolerance: f64,
    /// The sum of p where the force is given.
    pub wanted: Option<f64>,
    /// Whether a fresh product has to confirm it.
    pub certified: bool,
    /// Cycles on the finest grid at most.
    pub most: u64,
    /// How Newton's method steps.
    pub pace: Pace,
}

impl Goal {
    /// Whether no cycle is left, or the caller cancelled.
    pub fn is_interrupted(&self, monitor: &Monitor<'_>) -> bool {
        monitor.is_cancelled() || monitor.count.cycles >= self.most
    }
}

/// Iterates from what the level holds. `keeps`: the first step keeps its contact area.
pub fn newton(level: &mut Level, goal: Goal, keeps: bool, monitor: &mut Monitor<'_>) -> Result<(End, Measured)> {
    let mut measured = Measured::default();
    let (mut last, mut whole_below) = (f64::INFINITY, f64::INFINITY);
    let (mut directions, most) = match level.now.u.len() {
        n if is_small(n) => (DIRECTIONS, DIRECTIONS),
        n if n <= LARGE => (IN_MEMORY, IN_MEMORY),
        _ => (AT_FIRST, IN_MEMORY),
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
            Pace::Cautious if residual < CLOSE => MOST_CAUTIOUS,
            _ => MOST_STEPS,
        };
        if !(worst < LOST) || step >= most_steps {
            break;
        }
        if residual > RISEN * last {
            whole_below = AGAIN * last;
        }
        let is_far =
            residual > CLOSE || goal.pace == Pace::Cautious && (measured.changed > 0 || residual > whole_below);
        last = if is_far { f64::INFINITY } else { residual };
        if !take_step(level, goal, is_far, directions)? {
            directions = (2 * directions).min(most);
        }
        level.count_products(monitor);
        monitor.cycle_done(&level.problem.grid, 0, 0.0, worst);
    }
    Ok((End::Failed, measured))
}

/// Takes one step, of at most so many directions, far from the solution or near it. Returns whether these were enough.
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
    let [far, near] = if pace == Pace::Firm { FIRM } else { [FAR, NEAR] };
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

/// s a0 outside the contact area of now, `place(i, e)` being the distance at which element i is linearised.
pub fn stiffnesses<T: Real>(level: &Level, place: impl Fn(usize, f64) -> f64 + Sync + Send, stiffness: &mut [[T; 1]]) {
    let (surface, now, a0) = (&level.surface, &level.now, level.self_influence());
    fields::fill(&level.problem.threads, stiffness, |i| {
        let e = surface.distance(i, now);
        if now.contact[i] || !e.is_finite() {
            return [T::zero()];
        }
        [T::of((surface.attraction.stiffness(surface.work_at(i), place(i, e)) * a0).min(STIFFEST))]
    });
}

/// s, and the right-hand side, of the contact area of now.
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
                (0.5 * (e + of_pressure.clamp(e - WITHIN * range, e + WITHIN * range))).max(0.0)
            }
        }
    };
    stiffnesses(level, place, stiffness);
    if is_far && pace == Pace::Cautious {
        fields::scale(threads, stiffness, CAUTIOUS);
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
