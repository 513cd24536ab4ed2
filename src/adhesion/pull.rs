//! Forces that pull. Each has two equilibria, of which the one with dF/dapproach > 0 is stable. Below the pull-off force, the smallest force of
//! an equilibrium, there is none.
//!
//! Therefore the pull-off is found by continuation: the approach decreases along the stable branch from a state of larger force, step by step,
//! until nothing is in contact. Asperities part one after the other, and so do elements that are too coarse, so that the force falls and rises
//! many times on the path. Parts of the path where the force was nearly the least are repeated in small steps, whose smallest force is the
//! pull-off force. If a force is wanted, the path ends at the first step that crosses it ([`held`](super::held)).

use super::level::Level;
use super::path::{Continuation, Path};
use super::states::{PathEnd, SavedState, StateSums};
use super::tangent::{is_locked, stiffness_of_contact};
use super::unknowns::energies;
use crate::error::Result;
use crate::methods::fields;

/// The longest step of a path, relative to the length of the contact (`length`). LONGEST_STEP_TO_MEET is for a path that may still meet the
/// starting state of an earlier one.
const LONGEST_STEP: f64 = 0.1;
const LONGEST_STEP_TO_MEET: f64 = 0.3;
/// The smallest length of a contact, relative to the range. For bodies in contact without attraction the length falls with the force, and a path
/// in steps proportional to it would have no end.
const LEAST_LENGTH: f64 = 1e-3;
/// The first step of the approach from surfaces that are locked in contact or apart, relative to the range.
const LOCKED_STEP: f64 = 0.1;
/// The largest number of steps of a path.
const MOST_STEPS: u32 = 400;
/// The number of small steps that replace a step where the force was nearly the least. The edge of a contact is pinned at rings of elements, and
/// the force on a sphere has a minimum at each ring.
const PARTS_OF_STEP: u32 = 8;
/// The relative excess over the least force up to which a force is nearly the least, divided by the square of kappa, and the bounds of this
/// excess. The minima of a sphere at neighbouring rings lie 1 % below the forces between them for kappa 0.4, and 0.01 % for kappa 0.14.
const NEARLY_LEAST: f64 = 0.1;
const NEARLY_LEAST_BOUNDS: (f64, f64) = (0.005, 0.02);
/// The search around the minimum begins at one of these numbers of small steps above it: the first at which a state is found.
const STARTS_ABOVE: [f64; 4] = [0.0, 0.25, 0.5, 1.0];
/// The number of steps from the minimum to both sides. Each is half as long as the one before, because the last elements of a contact part at a
/// cusp.
const LAST_STEPS: u32 = 5;
/// The difference of the sums of p, relative to the sum of |p|, up to which two paths at the same approach have met.
const MEETING_DIFFERENCE: f64 = 1e-3;
/// An element parts if its contact pressure is below this fraction of sigma(0).
const PARTING_PRESSURE: f64 = 1e-9;

/// The least force on a path, and the part of the path where the force is nearly the least.
struct LeastForce {
    /// The state of the least force.
    state: SavedState,
    /// The last state before the force is nearly the least.
    above: SavedState,
    /// The sum of p of the first state that is nearly the least.
    first: f64,
    /// The approach of the last state that is nearly the least.
    last: f64,
    /// The length of the step to the least force.
    step: f64,
    /// The relative excess over the least force up to which a force is nearly the least.
    nearly: f64,
}

/// Whether a sum of p exceeds the least one by at most the fraction `part`.
fn is_nearly(sum: f64, least: f64, part: f64) -> bool {
    sum - least <= part * least.abs()
}

impl LeastForce {
    /// The least force at the start of a path.
    fn of(level: &Level, path: &Path) -> Result<LeastForce> {
        let Path { here, longest, .. } = path;
        let saved = || SavedState::of(level, here.sum);
        let kappa = level.surface.attraction.resolution(level.surface.work, level.self_influence());
        let nearly = (NEARLY_LEAST * kappa * kappa).clamp(NEARLY_LEAST_BOUNDS.0, NEARLY_LEAST_BOUNDS.1);
        Ok(LeastForce {
            state: saved()?,
            above: saved()?,
            first: here.sum,
            last: here.approach(),
            step: *longest,
            nearly,
        })
    }

    /// Records the state of the level, with this sum of p, which is one step along the path.
    fn look_at(&mut self, level: &Level, sum: f64, path: &Path) -> Result<()> {
        if sum < self.state.sum {
            if !is_nearly(self.first, sum, self.nearly) {
                self.above.sum = path.here.sum;
                self.above.unknowns.copy_from(&path.here.unknowns)?;
                self.first = sum;
            }
            self.state.take(level, sum)?;
            self.step = path.here.approach() - level.now.approach();
        }
        if is_nearly(sum, self.state.sum, self.nearly) {
            self.last = level.now.approach();
        }
        Ok(())
    }
}

impl Continuation<'_, '_, '_> {
    /// Follows a path down from the state of the level, which has a larger force than the goal. `meeting`: the starting state of an earlier path,
    /// at which this path may end.
    pub fn follow(&mut self, meeting: Option<StateSums>) -> Result<PathEnd> {
        let first = match is_locked(self.level) {
            true => match self.part()? {
                (_, true) => return Ok(PathEnd::Found),
                (sum, false) => Some(sum),
            },
            false => self.solve_at(self.level.now.approach())?,
        };
        let Some(sum) = first else { return Ok(self.lost()) };
        let step = self.first_step(if meeting.is_some() { LONGEST_STEP_TO_MEET } else { LONGEST_STEP })?;
        if !(step > 0.0) {
            return Ok(self.lost());
        }
        let path = Path::from(self.level, sum, step, false)?;
        let least = match self.down(path, meeting)? {
            Ok(least) => least,
            Err(path_end) => {
                if path_end == PathEnd::Lost {
                    let least = SavedState::of(self.level, 0.0)?;
                    if self.solve_at(least.approach())?.is_none() {
                        self.level.now.copy_from(&least.unknowns)?;
                    }
                }
                return Ok(path_end);
            }
        };
        self.closer(least)
    }

    /// Follows a path down until nothing is in contact. Returns the least force, or an earlier end of the path.
    fn down(
        &mut self,
        mut path: Path,
        mut meeting: Option<StateSums>,
    ) -> Result<std::result::Result<LeastForce, PathEnd>> {
        let mut least = LeastForce::of(self.level, &path)?;
        for _ in 0..MOST_STEPS {
            let target = path.here.approach() - path.step;
            let meets = meeting.filter(|meeting| target <= meeting.approach && meeting.approach < path.here.approach());
            let target = meets.map_or(target, |meeting| meeting.approach);
            let Some(sum) = self.step_to(&mut path, target)? else {
                self.level.now.copy_from(&least.state.unknowns)?;
                return Ok(Err(self.lost()));
            };
            let (approach, is_apart) = (self.level.now.approach(), !self.level.now.contact.contains(&true));
            if self.goal.wanted.is_some_and(|wanted| sum <= wanted) {
                return Ok(Err(self.between(&mut path.here, (sum, approach))?));
            }
            // The least force may lie within the step in which the last elements part.
            least.look_at(self.level, sum, &path)?;
            if is_apart {
                return Ok(Ok(least));
            }
            if let Some(start) = meets.filter(|meeting| approach == meeting.approach) {
                if (sum - start.sum).abs() <= MEETING_DIFFERENCE * start.all {
                    // A force below that of the meeting lies on this path only.
                    let is_less = least.state.sum < sum - MEETING_DIFFERENCE * start.all;
                    return Ok(if is_less { Ok(least) } else { Err(PathEnd::Joined) });
                }
                meeting = None;
            }
            let stiffness = (path.here.sum - sum) / (path.here.approach() - approach);
            let part = if meeting.is_some() { LONGEST_STEP_TO_MEET } else { LONGEST_STEP };
            path.step = path.step.min(part * self.length(stiffness));
            path.take(self.level, sum)?;
        }
        self.level.now.copy_from(&least.state.unknowns)?;
        Ok(Err(PathEnd::Lost))
    }

    /// Repeats the path in small steps where the force was nearly the least.
    fn closer(&mut self, least: LeastForce) -> Result<PathEnd> {
        let LeastForce { state: mut best, above, last, step, nearly, .. } = least;
        let (to, small) = (last - step, step / f64::from(PARTS_OF_STEP));
        self.level.now.copy_from(&above.unknowns)?;
        let mut path = Path::from(self.level, above.sum, step, true)?;
        path.step = small;
        for _ in 0..MOST_STEPS {
            let target = path.here.approach() - path.step;
            let Some(sum) = self.step_to(&mut path, target)? else {
                if self.goal.is_interrupted(self.monitor) {
                    self.level.now.copy_from(&best.unknowns)?;
                    return Ok(PathEnd::Interrupted);
                }
                break;
            };
            let approach = self.level.now.approach();
            if !self.level.now.contact.contains(&true) {
                break;
            }
            if self.goal.wanted.is_some_and(|wanted| sum <= wanted) {
                return self.between(&mut path.here, (sum, approach));
            }
            if sum < best.sum {
                best.take(self.level, sum)?;
            }
            if approach <= to {
                break;
            }
            // Steps are long until the force is nearly the least.
            path.longest = small.max(step.min(path.distance_to(best.sum + nearly * best.sum.abs(), (sum, approach))));
            path.step = path.step.min(path.longest);
            path.take(self.level, sum)?;
        }
        self.last(best, (small, nearly))
    }

    /// Restores the state of the least force on the path, and searches around it with smaller and smaller steps.
    fn last(&mut self, found: SavedState, (mut step, nearly): (f64, f64)) -> Result<PathEnd> {
        let mut best = None::<SavedState>;
        // Next to the end of a branch, its last state may miss the tolerance.
        for up in STARTS_ABOVE {
            self.level.now.copy_from(&found.unknowns)?;
            let sum = self.solve_at(found.approach() + up * step)?;
            if self.goal.is_interrupted(self.monitor) {
                self.level.now.copy_from(&found.unknowns)?;
                return Ok(PathEnd::Interrupted);
            }
            if let Some(sum) = sum.filter(|sum| is_nearly(*sum, found.sum, nearly)) {
                best = Some(SavedState::of(self.level, sum)?);
                break;
            }
        }
        let Some(mut best) = best else {
            self.level.now.copy_from(&found.unknowns)?;
            return Ok(self.lost());
        };
        'steps: for _ in 0..LAST_STEPS {
            step *= 0.5;
            for by in [-step, step] {
                self.level.now.copy_from(&best.unknowns)?;
                let approach = best.approach() + by;
                let found = self.solve_at(approach)?;
                if self.goal.is_interrupted(self.monitor) {
                    break 'steps;
                }
                let found = found.filter(|_| self.level.now.contact.contains(&true));
                match found {
                    Some(sum) if self.goal.wanted.is_some_and(|wanted| sum <= wanted) => {
                        // The stable state of the wanted force lies at a larger approach than both states.
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
        self.level.now.copy_from(&best.unknowns)?;
        Ok(PathEnd::Least { sum: best.sum, approach: best.approach() })
    }

    /// The first step of a path: the fraction `part` of the length of the contact, or LOCKED_STEP ranges if the surfaces are locked in contact or
    /// apart.
    pub fn first_step(&mut self, part: f64) -> Result<f64> {
        if is_locked(self.level) || self.level.now.contact.iter().all(|&inside| !inside) {
            return Ok(LOCKED_STEP * self.level.surface.attraction.range);
        }
        let stiffness = stiffness_of_contact(self.level, self.monitor)?;
        Ok(part * self.length(stiffness))
    }

    /// A length of the contact: the stretch at which a spring of its stiffness stores the elastic energy and the work of parting together. The
    /// elastic energy alone is 0 if attraction and contact pressures cancel, as below a flat punch without a load.
    fn length(&self, stiffness: f64) -> f64 {
        let Level { surface, now, problem, .. } = &*self.level;
        let [elastic, _] = energies(surface, now, &problem.threads);
        let of_element = |i: usize| [if now.contact[i] { surface.work_at(i) } else { 0.0 }];
        let [parting] = fields::sum(&problem.threads, now.u.len(), of_element);
        ((elastic + parting) / stiffness.abs()).sqrt().max(LEAST_LENGTH * surface.attraction.range)
    }

    /// Lowers the pressures of surfaces that are locked in contact. They fall uniformly, to the wanted force or until the first element parts.
    /// Returns the sum of p, and whether it is the wanted one.
    fn part(&mut self) -> Result<(f64, bool)> {
        let StateSums { sum, .. } = StateSums::of(self.level);
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
