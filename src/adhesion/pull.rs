//! Forces that pull. Two equilibria belong to one of them, of which the one with dF/dapproach > 0 is stable; below the pull-off force there is none.
//!
//! So the approach goes down the stable branch from a state of more force, until the force that is wanted lies between two states, or the force rises
//! again: then the least one is the pull-off force.

use super::level::{Level, MakeFrozen};
use super::majorise::Descent;
use super::newton::{newton, stiffness_of_contact, End, Goal};
use super::robust;
use super::unknowns::{energies, Unknowns};
use crate::error::Result;
use crate::methods::fields;
use crate::progress::Monitor;

/// The first step: this part of the length that the energy and the stiffness of the contact have together.
const FIRST: f64 = 0.1;
/// Steps at most, and how small they become around the least force.
const MOST_STEPS: u32 = 80;
const SMALLEST: f64 = 1.0 / 64.0;
/// The last whole step before a minimum is repeated in so many parts. Elements part one by one and do not come back, so that the force of a sphere of
/// 64 x 64 elements differs by 1e-4 of itself between long and short steps.
const PARTS: i32 = 8;
/// Minima of the force at most on the way.
const MOST_MINIMA: u32 = 40;
/// Of secants at most, between two states.
const SECANTS: u32 = 40;

/// Where a walk ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Walk {
    /// At the force that was wanted, on the stable branch.
    Found,
    /// At the least force, a sum of pressures, which is not as low as the one that was wanted.
    Least {
        /// The sum of p.
        sum: f64,
        /// The approach there.
        approach: f64,
    },
    /// The caller cancelled, or no cycle is left.
    Interrupted,
    /// No state is found on the way.
    Lost,
}

/// A state on the way.
struct Place {
    at: Unknowns,
    sum: f64,
}

impl Place {
    fn of(at: &Unknowns, sum: f64) -> Result<Place> {
        let mut place = Place { at: Unknowns::default(), sum };
        place.at.copy_from(at)?;
        Ok(place)
    }

    fn approach(&self) -> f64 {
        self.at.approach()
    }

    /// Takes what a level holds.
    fn take(&mut self, level: &Level, sum: f64) -> Result<()> {
        self.sum = sum;
        self.at.copy_from(&level.now)
    }
}

/// The sum of p at an approach, from what the level holds; none where no state is found.
fn solve_at(
    level: &mut Level,
    approach: f64,
    (goal, make): (Goal, MakeFrozen<'_>),
    monitor: &mut Monitor<'_>,
) -> Result<Option<f64>> {
    level.now.p.border = [approach];
    let by_approach = Goal { wanted: None, ..goal };
    let ended = robust::solve(level, by_approach, (true, make), monitor)?;
    Ok((ended.end == Descent::By(End::Solved)).then_some(ended.measured.pressures))
}

/// Walks down from what the level holds, the state of more force. Without a force that is wanted: to the least force, whose state the level then has.
///
/// Where asperities part one after the other the force has several minima: the walk goes on until nothing is in contact.
pub fn walk(level: &mut Level, (goal, make): (Goal, MakeFrozen<'_>), monitor: &mut Monitor<'_>) -> Result<Walk> {
    let from = level.now.approach();
    let Some(sum) = solve_at(level, from, (goal, make), monitor)? else { return Ok(lost(goal, monitor)) };
    let mut best = Place::of(&level.now, sum)?;
    let step = first_step(level, monitor)?;
    if !(step > 0.0) {
        return Ok(lost(goal, monitor));
    }
    let mut least: Option<Place> = None;
    for _ in 0..MOST_MINIMA {
        if let Some(end) = down(level, &mut best, step, (goal, make), monitor)? {
            return Ok(end);
        }
        if least.as_ref().is_none_or(|least| best.sum < least.sum) {
            least = Some(Place::of(&best.at, best.sum)?);
        }
        match over(level, &mut best, step, (goal, make), monitor)? {
            Over::Falls => {}
            Over::Apart => break,
            Over::Ended(walk) => return Ok(walk),
        }
    }
    let Some(least) = least else { return Ok(lost(goal, monitor)) };
    level.now.copy_from(&least.at)?;
    Ok(Walk::Least { sum: least.sum, approach: least.approach() })
}

/// Down to a minimum of the force, which `best` then has. Returns how the walk ended, if it did: at the force that is wanted, or where no cycle is left.
fn down(
    level: &mut Level,
    best: &mut Place,
    mut step: f64,
    (goal, make): (Goal, MakeFrozen<'_>),
    monitor: &mut Monitor<'_>,
) -> Result<Option<Walk>> {
    // Above: where the last whole step began.
    let (whole, mut above) = (step, None::<Place>);
    for _ in 0..MOST_STEPS {
        let approach = best.approach() - step;
        let found = solve_at(level, approach, (goal, make), monitor)?;
        if goal.is_interrupted(monitor) {
            return Ok(Some(Walk::Interrupted));
        }
        match found {
            Some(sum) if goal.wanted.is_some_and(|wanted| sum <= wanted) => {
                return between(level, best, (sum, approach), (goal, make), monitor).map(Some);
            }
            Some(sum) if sum < best.sum => {
                if step == whole {
                    above = Some(Place::of(&best.at, best.sum)?);
                }
                best.take(level, sum)?;
            }
            _ => {
                level.now.copy_from(&best.at)?;
                step *= 0.5;
            }
        }
        if step < SMALLEST * whole {
            break;
        }
    }
    if let Some(mut above) = above {
        let (from, way) = (above.approach(), best.approach() - above.approach());
        level.now.copy_from(&above.at)?;
        for k in 1..PARTS {
            let approach = from + way * f64::from(k) / f64::from(PARTS);
            match solve_at(level, approach, (goal, make), monitor)? {
                Some(sum) if goal.wanted.is_some_and(|wanted| sum <= wanted) => {
                    return between(level, &mut above, (sum, approach), (goal, make), monitor).map(Some);
                }
                Some(sum) if sum < best.sum => best.take(level, sum)?,
                Some(_) => {}
                None => break,
            }
        }
    }
    level.now.copy_from(&best.at)?;
    Ok(goal.is_interrupted(monitor).then_some(Walk::Interrupted))
}

/// The continuation behind a minimum.
enum Over {
    /// The force falls again.
    Falls,
    /// Nothing is in contact any more.
    Apart,
    /// The walk ends there.
    Ended(Walk),
}

/// From a minimum over what rises behind it, until the force falls again, of which `best` then has the state before.
fn over(
    level: &mut Level,
    best: &mut Place,
    step: f64,
    (goal, make): (Goal, MakeFrozen<'_>),
    monitor: &mut Monitor<'_>,
) -> Result<Over> {
    let mut approach = best.approach();
    for k in 0..MOST_STEPS {
        approach -= step;
        let found = solve_at(level, approach, (goal, make), monitor)?;
        if goal.is_interrupted(monitor) {
            return Ok(Over::Ended(Walk::Interrupted));
        }
        // A state that is not found may have less force.
        let Some(sum) = found else { return Ok(Over::Ended(Walk::Lost)) };
        if level.now.contact.iter().all(|inside| !inside) {
            return Ok(Over::Apart);
        }
        if k > 0 && sum < best.sum {
            level.now.copy_from(&best.at)?;
            return Ok(Over::Falls);
        }
        best.take(level, sum)?;
    }
    Ok(Over::Ended(Walk::Lost))
}

/// Why no state was found.
fn lost(goal: Goal, monitor: &Monitor<'_>) -> Walk {
    if goal.is_interrupted(monitor) {
        Walk::Interrupted
    } else {
        Walk::Lost
    }
}

/// A length of the contact: where a spring of its stiffness holds its elastic energy and the work that parts it. The elastic energy alone is nothing
/// where attraction and contact pressures cancel, as below a flat punch without a load.
fn first_step(level: &mut Level, monitor: &mut Monitor<'_>) -> Result<f64> {
    let Level { surface, now, problem, .. } = &*level;
    let [elastic, _] = energies(surface, now, &problem.threads);
    let of_element = |i: usize| [if now.contact[i] { surface.work_at(i) } else { 0.0 }];
    let [parting] = fields::sum(&problem.threads, now.u.len(), of_element);
    let stiffness = stiffness_of_contact(level, monitor)?;
    Ok(FIRST * ((elastic + parting) / stiffness.abs()).sqrt())
}

/// The state of the force that is wanted, between the `best` state of more force and one of less.
fn between(
    level: &mut Level,
    best: &mut Place,
    (mut sum_low, mut low): (f64, f64),
    (goal, make): (Goal, MakeFrozen<'_>),
    monitor: &mut Monitor<'_>,
) -> Result<Walk> {
    let Some(wanted) = goal.wanted else { return Ok(Walk::Lost) };
    for secant in 0..SECANTS {
        if goal.is_interrupted(monitor) {
            return Ok(Walk::Interrupted);
        }
        let part = ((best.sum - wanted) / (best.sum - sum_low)).clamp(0.0, 1.0);
        // Now and then the middle: the secant may stand still at one end.
        let part = if secant % 3 == 2 { 0.5 } else { part };
        let approach = best.approach() + part * (low - best.approach());
        level.now.copy_from(&best.at)?;
        level.now.p.border = [approach];
        let (end, _) = newton(level, goal, true, monitor)?;
        let reached = level.now.approach();
        let slack = best.approach() - low;
        if end == End::Solved && reached <= best.approach() + slack && reached >= low - slack {
            return Ok(Walk::Found);
        }
        level.now.copy_from(&best.at)?;
        match solve_at(level, approach, (goal, make), monitor)? {
            Some(sum) if sum > wanted => best.take(level, sum)?,
            Some(sum) => (sum_low, low) = (sum, approach),
            None => return Ok(lost(goal, monitor)),
        }
    }
    Ok(Walk::Lost)
}
