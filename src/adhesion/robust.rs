//! One grid: Newton's method; where it fails in cautious steps; and where that fails, or ends uphill or on a saddle, some steps of descent from the last
//! good state, and Newton's method again, in bold steps, and then in firm and cautious ones by turns.

use super::level::{Level, MakeFrozen};
use super::majorise::{descend, Descent, Steps};
use super::newton::{newton, End, Goal, Pace};
use super::tangent::is_stable;
use super::unknowns::{energies, Measured};
use crate::error::Result;
use crate::progress::Monitor;

/// Times that Newton's method is tried.
const ROUNDS: u32 = 12;
/// Steps of descent between.
pub const BETWEEN: u64 = 5;
/// An energy of more by this part is uphill.
const UPHILL: f64 = 1e-6;
/// Grids of so many elements are asked whether their equilibrium is stable: it costs little there. Larger ones are if Newton's method takes more steps
/// than this: they begin near the equilibrium of a coarser grid, or of the last load, and a short way from a stable one ends at a stable one.
const ASKED: usize = 1024;
const SHORT: u64 = 6;

/// How a grid ended.
#[derive(Clone, Copy, Debug)]
pub struct Ended {
    /// Why.
    pub end: Descent,
    /// How well the conditions hold.
    pub measured: Measured,
    /// Whether Newton's method failed at first: the state that it began from was not followed.
    pub is_lost: bool,
}

impl Ended {
    /// Whether that is an equilibrium of bodies that touch.
    pub fn is_in_contact(&self) -> bool {
        self.end == Descent::By(End::Solved) && self.measured.count > 0
    }
}

/// The energy that an equilibrium makes least, per area of an element: elastic energy less work of adhesion, and less that of a force that is given.
pub fn energy(level: &Level, wanted: Option<f64>) -> f64 {
    let [elastic, adhesive] = energies(&level.surface, &level.now, &level.problem.threads);
    elastic - adhesive - wanted.map_or(0.0, |wanted| wanted * level.now.approach())
}

/// Whether Newton's method ended at an equilibrium of no least energy, the approach being given. What a force has is asked at the end of a whole solve.
fn is_saddle(level: &mut Level, goal: Goal, is_long: bool, monitor: &mut Monitor<'_>) -> Result<bool> {
    let is_asked = level.now.u.len() <= ASKED || goal.certified && is_long;
    Ok(goal.wanted.is_none() && is_asked && !is_stable(level, false, monitor)?)
}

/// How Newton's method steps at each of its trials. Where bold steps go round in circles cautious ones may not, and the other way round. Firm ones cost more, and
/// come to the end of most avalanches, in which the edge of the contact moves from element to element.
fn pace_of(round: u32, first: Pace) -> Pace {
    match round {
        0 | 2 => first,
        1 => Pace::Cautious,
        _ if first == Pace::Bold && round % 2 == 1 => Pace::Firm,
        _ => Pace::Cautious,
    }
}

/// Solves a grid from what it holds. `keeps`: the first step of Newton's method keeps the contact area.
pub fn solve(
    level: &mut Level,
    goal: Goal,
    (keeps, make): (bool, MakeFrozen<'_>),
    monitor: &mut Monitor<'_>,
) -> Result<Ended> {
    let mut good = std::mem::take(&mut level.good);
    good.take(&level.now, &level.problem.threads)?;
    let mut ended = None;
    let (mut least, mut is_lost, mut has_descended) = (f64::INFINITY, false, false);
    for round in 0..ROUNDS {
        let before = monitor.count.cycles;
        let pace = pace_of(round, goal.pace);
        let keeps = keeps && !has_descended;
        let (end, measured) = newton(level, Goal { pace, ..goal }, keeps, monitor)?;
        let is_long = monitor.count.cycles - before > SHORT;
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
            // Cautious steps are tried before descent, which takes more memory.
            continue;
        }
        has_descended = true;
        let steps = Steps { most: BETWEEN, from_none: false, make };
        let (end, measured) = descend(level, goal, steps, monitor)?;
        if end != Descent::By(End::Failed) {
            ended = Some((end, measured));
            break;
        }
        least = energy(level, goal.wanted);
        good.take(&level.now, &level.problem.threads)?;
    }
    level.good = good;
    let (end, measured) = match ended {
        Some(ended) => ended,
        // All that is left goes downhill only.
        None => descend(level, goal, Steps { most: goal.most, from_none: false, make }, monitor)?,
    };
    Ok(Ended { end, measured, is_lost })
}
