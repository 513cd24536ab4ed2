//! Forces that pull. Each has two equilibria, of which the one with dF/dapproach > 0 is stable; below the pull-off force there is none.
//!
//! So the approach decreases along the stable branch from a state of more force, step by step until nothing is in contact. Asperities part one after
//! the other, and so do elements that are too coarse: the force falls and rises many times on the way. Places where the force was nearly the least
//! are revisited in small steps, whose least is the pull-off force. With a wanted force the way ends at the first step that crosses it
//! ([`held`](super::held)).

use super::level::Level;
use super::place::{Met, Place, Walk};
use super::tangent::{is_locked, stiffness_of_contact};
use super::unknowns::energies;
use super::way::{Walker, Way};
use crate::error::Result;
use crate::methods::fields;

/// The longest step of a way, relative to the length that the energy and the stiffness of the contact give.
/// LONGEST_STEP_TO_MEET serves a way that may still meet the state of an earlier way.
const LONGEST_STEP: f64 = 0.1;
const LONGEST_STEP_TO_MEET: f64 = 0.3;
/// The least length, relative to the range. Bodies in contact without attraction have a length that falls with their force, and a way in parts of
/// that length has no end.
const LEAST_LENGTH: f64 = 1e-3;
/// The first step from surfaces locked in contact or apart, relative to the range.
const LOCKED_STEP: f64 = 0.1;
/// Most steps.
const MOST_STEPS: u32 = 400;
/// Parts of each step that is repeated where the force was nearly the least. The edge of a contact is pinned at rings of elements, and the force of a
/// sphere has a minimum at each ring.
const PARTS_OF_STEP: u32 = 8;
/// Relative excess over the least force, divided by the square of kappa, of forces that are nearly the least; bounds of the excess. The minima of a
/// sphere at neighbouring rings lie 1 % below the forces between them for kappa 0.4, and 0.01 % for kappa 0.14.
const NEARLY_LEAST: f64 = 0.1;
const NEARLY_LEAST_BOUNDS: (f64, f64) = (0.005, 0.02);
/// The search around the minimum begins at one of these numbers of small steps above it, the first at which a state is found.
const STARTS_ABOVE: [f64; 4] = [0.0, 0.25, 0.5, 1.0];
/// Steps from the minimum to both sides, which are halved: the last elements of a contact part at a cusp.
const LAST_STEPS: u32 = 5;
/// Difference of the sums of p, relative to the sum of |p|, at which two ways meet.
const MEETING_DIFFERENCE: f64 = 1e-3;
/// Contact pressures of parting elements are below this share of sigma(0).
const PARTING_PRESSURE: f64 = 1e-9;

/// The least force on a way.
struct Least {
    at: Place,
    /// The state before the first one that is nearly the least, and the latter's sum.
    above: Place,
    first: f64,
    /// The approach of the last state that is nearly the least, and the length of a step there.
    last: f64,
    step: f64,
    /// The relative excess of forces that are nearly the least.
    nearly: f64,
}

/// Whether a sum of p is nearly the least.
fn is_nearly(sum: f64, least: f64, part: f64) -> bool {
    sum - least <= part * least.abs()
}

impl Least {
    /// The least force at the start of a way.
    fn of(level: &Level, way: &Way) -> Result<Least> {
        let Way { here, longest, .. } = way;
        let place = || Place::of(level, here.sum);
        let kappa = level.surface.attraction.resolution(level.surface.work, level.self_influence());
        let nearly = (NEARLY_LEAST * kappa * kappa).clamp(NEARLY_LEAST_BOUNDS.0, NEARLY_LEAST_BOUNDS.1);
        Ok(Least { at: place()?, above: place()?, first: here.sum, last: here.approach(), step: *longest, nearly })
    }

    /// Records the level's state of this sum, one step along the way.
    fn look_at(&mut self, level: &Level, sum: f64, way: &Way) -> Result<()> {
        if sum < self.at.sum {
            if !is_nearly(self.first, sum, self.nearly) {
                self.above.sum = way.here.sum;
                self.above.at.copy_from(&way.here.at)?;
                self.first = sum;
            }
            self.at.take(level, sum)?;
            self.step = way.here.approach() - level.now.approach();
        }
        if is_nearly(sum, self.at.sum, self.nearly) {
            self.last = level.now.approach();
        }
        Ok(())
    }
}

impl Walker<'_, '_, '_> {
    /// Walks down from the level's state, one of more force. `met`: the place at which it may end.
    pub fn walk(&mut self, met: Option<Met>) -> Result<Walk> {
        let first = match is_locked(self.level) {
            true => match self.part()? {
                (_, true) => return Ok(Walk::Found),
                (sum, false) => Some(sum),
            },
            false => self.solve_at(self.level.now.approach())?,
        };
        let Some(sum) = first else { return Ok(self.lost()) };
        let step = self.first_step(if met.is_some() { LONGEST_STEP_TO_MEET } else { LONGEST_STEP })?;
        if !(step > 0.0) {
            return Ok(self.lost());
        }
        let way = Way::from(self.level, sum, step, false)?;
        let least = match self.down(way, met)? {
            Ok(least) => least,
            Err(walk) => {
                if walk == Walk::Lost {
                    let least = Place::of(self.level, 0.0)?;
                    if self.solve_at(least.approach())?.is_none() {
                        self.level.now.copy_from(&least.at)?;
                    }
                }
                return Ok(walk);
            }
        };
        self.closer(least)
    }

    /// Walks down until nothing is in contact. Returns the least force, or an earlier end of the walk.
    fn down(&mut self, mut way: Way, mut met: Option<Met>) -> Result<std::result::Result<Least, Walk>> {
        let mut least = Least::of(self.level, &way)?;
        for _ in 0..MOST_STEPS {
            let target = way.here.approach() - way.step;
            let meets = met.filter(|met| target <= met.approach && met.approach < way.here.approach());
            let target = meets.map_or(target, |met| met.approach);
            let Some(sum) = self.step_to(&mut way, target)? else {
                self.level.now.copy_from(&least.at.at)?;
                return Ok(Err(self.lost()));
            };
            let (approach, is_apart) = (self.level.now.approach(), !self.level.now.contact.contains(&true));
            if self.goal.wanted.is_some_and(|wanted| sum <= wanted) {
                return Ok(Err(self.between(&mut way.here, (sum, approach))?));
            }
            // The least force may lie within the step in which the last elements part.
            least.look_at(self.level, sum, &way)?;
            if is_apart {
                return Ok(Ok(least));
            }
            if let Some(at) = meets.filter(|met| approach == met.approach) {
                if (sum - at.sum).abs() <= MEETING_DIFFERENCE * at.all {
                    // A force less than at the meeting lies on this way only.
                    let is_less = least.at.sum < sum - MEETING_DIFFERENCE * at.all;
                    return Ok(if is_less { Ok(least) } else { Err(Walk::Met) });
                }
                met = None;
            }
            let stiffness = (way.here.sum - sum) / (way.here.approach() - approach);
            let part = if met.is_some() { LONGEST_STEP_TO_MEET } else { LONGEST_STEP };
            way.step = way.step.min(part * self.length(stiffness));
            way.take(self.level, sum)?;
        }
        self.level.now.copy_from(&least.at.at)?;
        Ok(Err(Walk::Lost))
    }

    /// Repeats the way in small steps where the force was nearly the least.
    fn closer(&mut self, least: Least) -> Result<Walk> {
        let Least { at: mut best, above, last, step, nearly, .. } = least;
        let (to, small) = (last - step, step / f64::from(PARTS_OF_STEP));
        self.level.now.copy_from(&above.at)?;
        let mut way = Way::from(self.level, above.sum, step, true)?;
        way.step = small;
        for _ in 0..MOST_STEPS {
            let target = way.here.approach() - way.step;
            let Some(sum) = self.step_to(&mut way, target)? else {
                if self.goal.is_interrupted(self.monitor) {
                    self.level.now.copy_from(&best.at)?;
                    return Ok(Walk::Interrupted);
                }
                break;
            };
            let approach = self.level.now.approach();
            if !self.level.now.contact.contains(&true) {
                break;
            }
            if self.goal.wanted.is_some_and(|wanted| sum <= wanted) {
                return self.between(&mut way.here, (sum, approach));
            }
            if sum < best.sum {
                best.take(self.level, sum)?;
            }
            if approach <= to {
                break;
            }
            // Steps are long up to where the force is nearly the least.
            way.longest = small.max(step.min(way.distance_to(best.sum + nearly * best.sum.abs(), (sum, approach))));
            way.step = way.step.min(way.longest);
            way.take(self.level, sum)?;
        }
        self.last(best, (small, nearly))
    }

    /// Restores the state of the least force on the way, and continues from there with smaller and smaller steps.
    fn last(&mut self, found: Place, (mut step, nearly): (f64, f64)) -> Result<Walk> {
        let mut best = None::<Place>;
        // Next to the end of a branch its last state may miss the tolerance.
        for up in STARTS_ABOVE {
            self.level.now.copy_from(&found.at)?;
            let sum = self.solve_at(found.approach() + up * step)?;
            if self.goal.is_interrupted(self.monitor) {
                self.level.now.copy_from(&found.at)?;
                return Ok(Walk::Interrupted);
            }
            if let Some(sum) = sum.filter(|sum| is_nearly(*sum, found.sum, nearly)) {
                best = Some(Place::of(self.level, sum)?);
                break;
            }
        }
        let Some(mut best) = best else {
            self.level.now.copy_from(&found.at)?;
            return Ok(self.lost());
        };
        'steps: for _ in 0..LAST_STEPS {
            step *= 0.5;
            for by in [-step, step] {
                self.level.now.copy_from(&best.at)?;
                let approach = best.approach() + by;
                let found = self.solve_at(approach)?;
                if self.goal.is_interrupted(self.monitor) {
                    break 'steps;
                }
                let found = found.filter(|_| self.level.now.contact.contains(&true));
                match found {
                    Some(sum) if self.goal.wanted.is_some_and(|wanted| sum <= wanted) => {
                        // The stable state lies above both.
                        return if by > 0.0 { self.climb(sum) } else { self.between(&mut best, (sum, approach)) };
                    }
                    Some(sum) if sum < best.sum => {
                        best.take(self.level, sum)?;
                        break;
                    }
                    _ => {}
                }
            }
        }
        self.level.now.copy_from(&best.at)?;
        Ok(Walk::Least { sum: best.sum, approach: best.approach() })
    }

    /// The first step of a walk.
    pub fn first_step(&mut self, part: f64) -> Result<f64> {
        if is_locked(self.level) || self.level.now.contact.iter().all(|&inside| !inside) {
            return Ok(LOCKED_STEP * self.level.surface.attraction.range);
        }
        let stiffness = stiffness_of_contact(self.level, self.monitor)?;
        Ok(part * self.length(stiffness))
    }

    /// A length of the contact: the stretch at which a spring of its stiffness has its elastic energy and the work of parting. The elastic energy
    /// alone is 0 if attraction and contact pressures cancel, as below a flat punch without a load.
    fn length(&self, stiffness: f64) -> f64 {
        let Level { surface, now, problem, .. } = &*self.level;
        let [elastic, _] = energies(surface, now, &problem.threads);
        let of_element = |i: usize| [if now.contact[i] { surface.work_at(i) } else { 0.0 }];
        let [parting] = fields::sum(&problem.threads, now.u.len(), of_element);
        ((elastic + parting) / stiffness.abs()).sqrt().max(LEAST_LENGTH * surface.attraction.range)
    }

    /// Lowers the pressures of surfaces locked in contact, which fall uniformly, to the wanted force or until the first element parts. Returns the
    /// sum of p, and whether it is the wanted one.
    fn part(&mut self) -> Result<(f64, bool)> {
        let Met { sum, .. } = Met::of(self.level);
        let Level { surface, now, .. } = &mut *self.level;
        let n = now.u.len();
        let q = |i: usize| now.p.field[i][0] + surface.traction(i, 0.0);
        let (least, most) = ((0..n).map(q).fold(f64::INFINITY, f64::min), surface.work / surface.attraction.range);
        let wanted = self.goal.wanted.map(|wanted| (sum - wanted) / n as f64).filter(|by| *by <= least);
        let by = wanted.unwrap_or(least);
        for i in 0..n {
            now.contact[i] =
                wanted.is_some() || now.p.field[i][0] + surface.traction(i, 0.0) - by > PARTING_PRESSURE * most;
        }
        now.p.field.iter_mut().for_each(|p| p[0] -= by);
        self.level.refresh()?;
        self.level.count_products(self.monitor);
        Ok((sum - n as f64 * by, wanted.is_some()))
    }
}
