//! The search for the creepages of given forces, by turns with held creepages.

use crate::friction::{dot, length, Vector};

/// A trial is good if its missing force is at most this part of the least so far.
const PROGRESS: f64 = 0.5;
/// With two forces: a trial that misses more than this times the least is followed by one halfway back.
const WORSE: f64 = 2.0;
/// The first step along the creepages, relative to these, at most MOST_STEPS times the missing force. No step exceeds
/// LONGEST_STEP times the creepages.
const FIRST_STEP: f64 = 0.1;
const MOST_STEPS: f64 = 1e6;
const LONGEST_STEP: f64 = 0.8;
/// Least size of creepages in step lengths, relative to the slips.
const SMALL_CREEPAGE: f64 = 1e-3;

/// A place in the search.
#[derive(Clone, Copy)]
pub struct Place {
    /// Creepages times the length rolled.
    pub creepage: Vector,
    /// The excess of the forces, relative to mu N.
    pub excess: Vector,
}

impl Place {
    /// The size of the excess.
    pub fn missing(&self) -> f64 {
        length(self.excess)
    }
}

/// The creepages to try.
pub struct Trials {
    given: [bool; 2],
    /// The change of creepages per excess of force.
    slope: [Vector; 2],
    last: Option<Place>,
    /// With one force: the last creepage that carried more, and the last that carried less.
    between: [Option<f64>; 2],
    best: Place,
    bad: u32,
    /// Creepages below this are small.
    small: f64,
}

impl Trials {
    /// Begins at a place; slips are of the order of `scale`. Across the creepages forces turn with them; along them the first step is short.
    pub fn new(from: Place, given: [bool; 2], scale: f64) -> Trials {
        let only = |v: Vector| [0, 1].map(|k| if given[k] { v[k] } else { 0.0 });
        let small = SMALL_CREEPAGE * scale;
        let size = length(only(from.creepage)).max(small);
        let along = match only(from.creepage) {
            [0.0, 0.0] => only(from.excess),
            along => along,
        };
        let along = along.map(|c| c / length(along));
        let steps = (FIRST_STEP / dot(along, from.excess).abs()).clamp(1.0, MOST_STEPS);
        let row = |k: usize| {
            let of = |l: usize| f64::from(u8::from(k == l)) + (steps - 1.0) * along[k] * along[l];
            only([size * of(0), size * of(1)])
        };
        let slope = [0, 1].map(|k| if given[k] { row(k) } else { [0.0; 2] });
        Trials { given, slope, last: None, between: [None; 2], best: from, bad: 0, small }
    }

    /// The place with the least missing force.
    pub fn best(&self) -> Place {
        self.best
    }

    /// The next creepages after a place.
    pub fn next(&mut self, at: Place) -> Vector {
        let Place { creepage, excess } = at;
        if let Some(before) = self.last.replace(at) {
            let change = |now: Vector, then: Vector| [0, 1].map(|k| now[k] - then[k]);
            self.learn(change(creepage, before.creepage), change(excess, before.excess));
        }
        let missing = at.missing();
        self.bad = if missing > PROGRESS * self.best.missing() { self.bad + 1 } else { 0 };
        if missing < self.best.missing() {
            self.best = at;
        }
        let by = self.slope.map(|row| dot(row, excess));
        let shorter = (LONGEST_STEP * length(creepage).max(self.small) / length(by)).min(1.0);
        let secant = [0, 1].map(|k| creepage[k] + shorter * by[k]);
        match self.given {
            [true, true] if missing > WORSE * self.best.missing() => {
                [0, 1].map(|k| 0.5 * (creepage[k] + self.best.creepage[k]))
            }
            [true, true] => secant,
            [in_x, _] => {
                let k = usize::from(!in_x);
                let mut next = creepage;
                next[k] = self.between(creepage[k], excess[k], secant[k]);
                next
            }
        }
    }

    /// The next creepage with one force: that of the secant if it lies between the bounds.
    fn between(&mut self, at: f64, excess: f64, secant: f64) -> f64 {
        self.between[usize::from(excess < 0.0)] = Some(at);
        match self.between {
            [Some(more), Some(less)] => {
                let inside = (secant - more) * (less - secant) > 0.0;
                if inside && self.bad % 3 != 2 {
                    secant
                } else {
                    0.5 * (more + less)
                }
            }
            // Forces fall as creepages grow.
            _ if (secant - at) * excess > 0.0 => secant,
            _ => at + (at - secant),
        }
    }

    /// Broyden's update: a change of creepages by dc changed the forces by de.
    fn learn(&mut self, dc: Vector, de: Vector) {
        let by = self.slope.map(|row| dot(row, de));
        let along = [0, 1].map(|k| dc[0] * self.slope[0][k] + dc[1] * self.slope[1][k]);
        let size = dot(dc, by);
        if size != 0.0 {
            for (k, row) in self.slope.iter_mut().enumerate() {
                let rest = (dc[k] + by[k]) / size;
                *row = [0, 1].map(|l| row[l] - rest * along[l]);
            }
        }
    }
}
