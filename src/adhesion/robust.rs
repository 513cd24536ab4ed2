//! Solves one grid. First comes Newton's method, and if it fails, Newton's method in cautious steps. If these also fail, or end at a larger
//! energy or at a saddle, some steps of descent follow, from the last iterate from which descent can continue. Then comes Newton's method again:
//! first in bold steps, later in firm and cautious ones in turns.

use super::level::{Level, MakeFrozen};
use super::majorise::{descend, Descent, Steps};
use super::newton::{newton, End, Goal, Pace};
use super::tangent::{is_stable, CHEAP};
use super::unknowns::{energies, Measured};
use crate::error::Result;
use crate::progress::Monitor;

/// The largest number of trials of Newton's method.
const NEWTON_TRIALS: u32 = 12;
/// The number of steps of descent between two trials.
pub const DESCENT_STEPS: u64 = 5;
/// The relative increase of the energy from which an end counts as uphill.
const UPHILL: f64 = 1e-6;
/// Grids of more than [`CHEAP`] elements are tested for a saddle only if Newton's method takes more than FEW_STEPS steps. They start near the
/// equilibrium of a coarser grid or of the last load, and few steps from a stable equilibrium end at a stable one.
const FEW_STEPS: u64 = 6;

/// How the solve of a grid ended.
#[derive(Clone, Copy, Debug)]
pub struct Ended {
    /// How the last method ended.
    pub end: Descent,
    /// The residuals of the conditions.
    pub measured: Measured,
    /// Whether Newton's method failed at first, so that the solve did not follow the branch of the starting state.
    pub is_lost: bool,
}

impl Ended {
    /// Whether the solve ended at an equilibrium of bodies in contact.
    pub fn is_in_contact(&self) -> bool {
        self.end == Descent::By(End::Solved) && self.measured.count > 0
    }
}

/// The energy that a stable equilibrium minimises, per area of an element: the elastic energy, less the remaining work of the attraction, less
/// the work of a given force.
pub fn energy(level: &Level, wanted: Option<f64>) -> f64 {
    let [elastic, adhesive] = energies(&level.surface, &level.now, &level.problem.threads);
    elastic - adhesive - wanted.map_or(0.0, |wanted| wanted * level.now.approach())
}

/// Whether Newton's method ended at an equilibrium that does not minimise the energy at a given approach. For a given force the search for the
/// state tests this at its end.
fn is_saddle(level: &mut Level, goal: Goal, is_long: bool, monitor: &mut Monitor<'_>) -> Result<bool> {
    let is_asked = level.now.u.len() <= CHEAP || goal.certified && is_long;
    Ok(goal.wanted.is_none() && is_asked && !is_stable(level, false, monitor)?)
}

/// The kind of Newton steps in each trial. If bold steps cycle, cautious ones may not, and conversely. Firm steps cost more, but finish most
/// avalanches, in which the edge of the contact moves from element to element.
fn pace_of(round: u32, first: Pace) -> Pace {
    match round {
        0 | 2 => first,
        1 => Pace::Cautious,
        _ if first == Pace::Bold && round % 2 == 1 => Pace::Firm,
        _ => Pace::Cautious,
    }
}

/// Solves a grid from its current iterate. `keeps`: the first Newton step keeps the contact area.
pub fn solve(
    level: &mut Level,
    goal: Goal,
    (keeps, make): (bool, MakeFrozen<'_>),
    monitor: &mut Monitor<'_>,
) -> Result<Ended> {
    let mut good = std::mem::take(&mut level.good);
    good.keep(&level.now, &level.problem.threads)?;
    let mut ended = None;
    let (mut least, mut is_lost, mut has_descended) = (f64::INFINITY, false, false);
    for round in 0..NEWTON_TRIALS {
        let before = monitor.count.cycles;
        let pace = pace_of(round, goal.pace);
        let keeps = keeps && !has_descended;
        let (end, measured) = newton(level, Goal { pace, ..goal }, keeps, monitor)?;
        let is_long = monitor.count.cycles - before > FEW_STEPS;
        let is_downhill = || energy(level, goal.wanted) <= least + UPHILL * least.abs();
        if end == End::Interrupted || end == End::Solved && is_downhill() && !is_saddle(level, goal, is_long, monitor)?
        {
            ended = Some((Descent::By(end), measured));
            break;
        }
        is_lost = true;
        log::debug!("adhesion: Newton's method {end:?} with {measured:?}");
        if !good.put(&mut level.now) {
            level.refresh()?;
        }
        if round == 0 && pace == Pace::Bold && end == End::Failed {
            // Cautious steps come before descent, because descent takes more memory.
            continue;
        }
        has_descended = true;
        let steps = Steps { most: DESCENT_STEPS, starts_without_attraction: false, make };
        let (end, measured) = descend(level, goal, steps, monitor)?;
        if end != Descent::By(End::Failed) {
            ended = Some((end, measured));
            break;
        }
        least = energy(level, goal.wanted);
        good.keep(&level.now, &level.problem.threads)?;
    }
    level.good = good;
    let (end, measured) = match ended {
        Some(ended) => ended,
        // All remaining cycles are spent on descent.
        None => descend(level, goal, Steps { most: goal.most, starts_without_attraction: false, make }, monitor)?,
    };
    Ok(Ended { end, measured, is_lost })
}
