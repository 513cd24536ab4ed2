//! Forces that pull. Two equilibria belong to one of them, of which the one with dF/dapproach > 0 is stable; below the pull-off force there is none.
//!
//! So the approach goes down the stable branch from a state of more force, step by step until nothing is in contact. Asperities part one after the
//! other, and so do elements that are too coarse: the force falls and rises many times on the way. The least of all is looked at once more in small steps:
//! that is the pull-off force. Where a force is wanted, the way ends at the first step that crosses it ([`held`](super::held)).

use super::level::{Level, MakeFrozen};
use super::majorise::Descent;
use super::newton::{End, Goal};
use super::place::{Met, Place, Walk};
use super::robust;
use super::tangent::{is_locked, stiffness_of_contact};
use super::unknowns::energies;
use crate::error::Result;
use crate::methods::fields;
use crate::progress::Monitor;

/// A step: this part of the length that the energy and the stiffness of the contact have together; a larger part down to the state of an earlier way.
const STEP: f64 = 0.1;
const LONG: f64 = 0.3;
/// Steps grow by this where the force changes little, up to the first one.
const GROWTH: f64 = 1.5;
/// A step of surfaces that are locked in contact: of the range.
const OF_RANGE: f64 = 0.1;
/// Steps at most, and halvings of one at whose end no state is found.
const MOST_STEPS: u32 = 400;
const HALVINGS: u32 = 4;
/// The steps around the least force are repeated in so many parts. Elements part one by one and do not come back, so that the force of a sphere of
/// 64 x 64 elements differs by 1e-4 of itself between long and short steps.
const PARTS: u32 = 8;
/// Small steps beyond a minimum that find no less; then steps from the minimum, which are halved where they find no less, too: the last elements of a
/// contact part at a cusp.
const BEYOND: u32 = 4;
const LAST: u32 = 5;
/// Two ways have met where their sums of p differ by less than this part of all attraction or repulsion.
const SAME: f64 = 1e-3;
/// Of sigma(0): contact pressures below are those of elements that part.
const PARTING: f64 = 1e-9;

/// Goes from state to state on one grid.
pub struct Walker<'a, 'm, 'c> {
    pub level: &'a mut Level,
    pub goal: Goal,
    pub make: MakeFrozen<'a>,
    pub monitor: &'m mut Monitor<'c>,
    /// Cycles of each state on the way at most: more are a state that is not found.
    pub each: u64,
}

/// The least force on a way.
struct Least {
    at: Place,
    /// The step before it, and the length of a step there.
    above: Place,
    step: f64,
}

impl<'a, 'm, 'c> Walker<'a, 'm, 'c> {
    /// On a grid, from what it holds; each state may take all cycles of the goal.
    pub fn new(level: &'a mut Level, goal: Goal, make: MakeFrozen<'a>, monitor: &'m mut Monitor<'c>) -> Self {
        Walker { level, goal, make, monitor, each: u64::MAX }
    }

    /// The sum of p at an approach, from what the level holds; none where no state is found.
    pub fn solve_at(&mut self, approach: f64) -> Result<Option<f64>> {
        self.level.now.p.border = [approach];
        let most = self.goal.most.min(self.monitor.count.cycles.saturating_add(self.each));
        let by_approach = Goal { wanted: None, most, ..self.goal };
        let ended = robust::solve(self.level, by_approach, (true, self.make), self.monitor)?;
        Ok((ended.end == Descent::By(End::Solved)).then_some(ended.measured.pressures))
    }

    /// Walks down from what the level holds, the state of more force. `met`: where it may end.
    pub fn walk(&mut self, met: Option<Met>) -> Result<Walk> {
        let first = match is_locked(self.level) {
            true => match self.part()? {
                (_, true) => return Ok(Walk::Found),
                (sum, false) => Some(sum),
            },
            false => self.solve_at(self.level.now.approach())?,
        };
        let Some(sum) = first else { return Ok(self.lost()) };
        let step = self.first_step(if met.is_some() { LONG } else { STEP })?;
        if !(step > 0.0) {
            return Ok(self.lost());
        }
        let least = match self.down(sum, step, met)? {
            Ok(least) => least,
            Err(walk) => return Ok(walk),
        };
        self.closer(least)
    }

    /// Down until nothing is in contact: the least force, or how the walk ended before.
    fn down(&mut self, sum: f64, first: f64, mut met: Option<Met>) -> Result<std::result::Result<Least, Walk>> {
        let mut step = first;
        let mut here = Place::of(self.level, sum)?;
        let mut least = Least { at: Place::of(self.level, sum)?, above: Place::of(self.level, sum)?, step };
        for _ in 0..MOST_STEPS {
            let target = here.approach() - step;
            let meets = met.filter(|met| target <= met.approach && met.approach < here.approach());
            let target = meets.map_or(target, |met| met.approach);
            let Some(sum) = self.step_to(&here, target)? else {
                self.level.now.copy_from(&least.at.at)?;
                return Ok(Err(self.lost()));
            };
            let (approach, is_apart) = (self.level.now.approach(), !self.level.now.contact.contains(&true));
            if self.goal.wanted.is_some_and(|wanted| sum <= wanted) {
                return Ok(Err(self.between(&mut here, (sum, approach))?));
            }
            if is_apart {
                break;
            }
            if sum < least.at.sum {
                least.above.sum = here.sum;
                least.above.at.copy_from(&here.at)?;
                least.at.take(self.level, sum)?;
                least.step = here.approach() - approach;
            }
            if meets.is_some_and(|met| approach == met.approach) {
                if meets.is_some_and(|met| (sum - met.sum).abs() <= SAME * met.all) {
                    // What is less than at the meeting lies on this way alone.
                    return Ok(if least.at.sum < sum { Ok(least) } else { Err(Walk::Met) });
                }
                met = None;
            }
            let stiffness = (here.sum - sum) / (here.approach() - approach);
            let part = if met.is_some() { LONG } else { STEP };
            step = (part * self.length(stiffness)).min(GROWTH * step).min(first);
            here.take(self.level, sum)?;
        }
        Ok(Ok(least))
    }

    /// A state at an approach, or halfway to it, and so on. None where none is found.
    fn step_to(&mut self, from: &Place, approach: f64) -> Result<Option<f64>> {
        let mut way = approach - from.approach();
        for halving in 0..=HALVINGS {
            let approach = if halving == 0 { approach } else { from.approach() + way };
            let found = self.solve_at(approach)?;
            if self.goal.is_interrupted(self.monitor) {
                return Ok(None);
            }
            if found.is_some() {
                return Ok(found);
            }
            self.level.now.copy_from(&from.at)?;
            way *= 0.5;
        }
        Ok(None)
    }

    /// Small steps around the least force.
    fn closer(&mut self, least: Least) -> Result<Walk> {
        let Least { at: mut best, above, step } = least;
        let (to, small) = (best.approach() - step, step / f64::from(PARTS));
        self.level.now.copy_from(&above.at)?;
        let (mut here, mut beyond) = (above, 0);
        for _ in 0..3 * PARTS {
            let approach = here.approach() - small;
            if approach < to || beyond == BEYOND {
                break;
            }
            let found = self.solve_at(approach)?;
            if self.goal.is_interrupted(self.monitor) {
                self.level.now.copy_from(&best.at)?;
                return Ok(Walk::Interrupted);
            }
            let Some(sum) = found.filter(|_| self.level.now.contact.contains(&true)) else { break };
            if self.goal.wanted.is_some_and(|wanted| sum <= wanted) {
                return self.between(&mut here, (sum, approach));
            }
            let is_below = approach < best.approach();
            if sum < best.sum {
                best.take(self.level, sum)?;
                beyond = 0;
            } else if is_below {
                beyond += 1;
            }
            here.take(self.level, sum)?;
        }
        self.last(best, small)
    }

    /// Smaller and smaller steps from the least force.
    fn last(&mut self, mut best: Place, mut step: f64) -> Result<Walk> {
        for _ in 0..LAST {
            step *= 0.5;
            self.level.now.copy_from(&best.at)?;
            let approach = best.approach() - step;
            let found = self.solve_at(approach)?;
            if self.goal.is_interrupted(self.monitor) {
                break;
            }
            let found = found.filter(|_| self.level.now.contact.contains(&true));
            match found {
                Some(sum) if self.goal.wanted.is_some_and(|wanted| sum <= wanted) => {
                    return self.between(&mut best, (sum, approach));
                }
                Some(sum) if sum < best.sum => best.take(self.level, sum)?,
                _ => {}
            }
        }
        self.level.now.copy_from(&best.at)?;
        Ok(Walk::Least { sum: best.sum, approach: best.approach() })
    }

    /// Why no state was found.
    pub fn lost(&self) -> Walk {
        if self.goal.is_interrupted(self.monitor) {
            Walk::Interrupted
        } else {
            Walk::Lost
        }
    }

    /// The first step of a walk.
    pub fn first_step(&mut self, part: f64) -> Result<f64> {
        if is_locked(self.level) || self.level.now.contact.iter().all(|&inside| !inside) {
            return Ok(OF_RANGE * self.level.surface.attraction.range);
        }
        let stiffness = stiffness_of_contact(self.level, self.monitor)?;
        Ok(part * self.length(stiffness))
    }

    /// A length of the contact: where a spring of its stiffness holds its elastic energy and the work that parts it. The elastic energy alone is nothing
    /// where attraction and contact pressures cancel, as below a flat punch without a load.
    fn length(&self, stiffness: f64) -> f64 {
        let Level { surface, now, problem, .. } = &*self.level;
        let [elastic, _] = energies(surface, now, &problem.threads);
        let of_element = |i: usize| [if now.contact[i] { surface.work_at(i) } else { 0.0 }];
        let [parting] = fields::sum(&problem.threads, now.u.len(), of_element);
        ((elastic + parting) / stiffness.abs()).sqrt()
    }

    /// From surfaces that are locked in contact, where pressures fall by the same everywhere: to the force that is wanted, or to that at which the first
    /// element parts. Returns the sum of p, and whether it is the one that is wanted.
    fn part(&mut self) -> Result<(f64, bool)> {
        let Met { sum, .. } = Met::of(self.level);
        let Level { surface, now, .. } = &mut *self.level;
        let n = now.u.len();
        let q = |i: usize| now.p.field[i][0] + surface.traction(i, 0.0);
        let (least, most) = ((0..n).map(q).fold(f64::INFINITY, f64::min), surface.work / surface.attraction.range);
        let wanted = self.goal.wanted.map(|wanted| (sum - wanted) / n as f64).filter(|by| *by <= least);
        let by = wanted.unwrap_or(least);
        for i in 0..n {
            now.contact[i] = wanted.is_some() || now.p.field[i][0] + surface.traction(i, 0.0) - by > PARTING * most;
        }
        now.p.field.iter_mut().for_each(|p| p[0] -= by);
        self.level.refresh()?;
        self.level.count_products(self.monitor);
        Ok((sum - n as f64 * by, wanted.is_some()))
    }
}
