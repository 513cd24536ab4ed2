//! The search for the creepages whose forces are the given ones: a secant method (Broyden 1965), with bisection if one force is given. The caller
//! solves each trial.

use crate::friction::{dot, length, Vector};

/// A trial makes progress if its missing force is at most this part of the least one so far.
const PROGRESS: f64 = 0.5;
/// With two given forces: after a trial that misses more than this times the least missing force, the next trial lies halfway to the best one.
const WORSE: f64 = 2.0;
/// The first step along the creepages, relative to their length, unless the excess of the force is larger.
const FIRST_STEP: f64 = 0.1;
/// Bound on this first step, over the excess of the force along the creepages.
const MOST_STEPS: f64 = 1e6;
/// The longest step, relative to the length of the creepages.
const LONGEST_STEP: f64 = 0.8;
/// Creepages below this part of the slips count as this large where a step is relative to their length.
const SMALL_CREEPAGE: f64 = 1e-3;

/// Creepages and their forces.
#[derive(Clone, Copy)]
pub struct Trial {
    /// Creepages times the length rolled.
    pub creepage: Vector,
    /// The forces less the given ones, relative to mu N; 0 in directions without a given force.
    pub excess: Vector,
}

impl Trial {
    /// The length of the excess.
    pub fn missing(&self) -> f64 {
        length(self.excess)
    }
}

/// The state of the search.
pub struct Trials {
    /// Whether the force is given, in x and in y.
    given: [bool; 2],
    /// The secant matrix: a step of the creepages is this matrix times the excess.
    slope: [Vector; 2],
    last: Option<Trial>,
    /// With one given force: the last creepage whose force was too large, and the last whose force was too small.
    between: [Option<f64>; 2],
    /// The trial with the least missing force.
    best: Trial,
    /// Trials in succession without [`PROGRESS`].
    bad: u32,
    /// [`SMALL_CREEPAGE`] times the slips.
    small: f64,
}

impl Trials {
    /// Begins at a solved trial; slips are of the order of `scale`. A step across the creepages turns the force by the same angle, which gives the
    /// slope there. The slope along the creepages is not known: the first step there is short.
    pub fn new(from: Trial, given: [bool; 2], scale: f64) -> Trials {
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

    /// The trial with the least missing force.
    pub fn best(&self) -> Trial {
        self.best
    }

    /// Learns from a solved trial, and returns the creepages of the next one.
    pub fn next(&mut self, trial: Trial) -> Vector {
        let Trial { creepage, excess } = trial;
        if let Some(before) = self.last.replace(trial) {
            let change = |now: Vector, then: Vector| [0, 1].map(|k| now[k] - then[k]);
            self.learn(change(creepage, before.creepage), change(excess, before.excess));
        }
        let missing = trial.missing();
        self.bad = if missing > PROGRESS * self.best.missing() { self.bad + 1 } else { 0 };
        if missing < self.best.missing() {
            self.best = trial;
        }
        let step = self.slope.map(|row| dot(row, excess));
        let shorter = (LONGEST_STEP * length(creepage).max(self.small) / length(step)).min(1.0);
        let secant = [0, 1].map(|k| creepage[k] + shorter * step[k]);
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

    /// The next creepage with one given force: that of the secant if it lies between the bounds, else their middle.
    fn between(&mut self, creepage: f64, excess: f64, secant: f64) -> f64 {
        self.between[usize::from(excess < 0.0)] = Some(creepage);
        match self.between {
            [Some(more), Some(less)] => {
                let inside = (secant - more) * (less - secant) > 0.0;
                // Every third trial without progress bisects.
                if inside && self.bad % 3 != 2 {
                    secant
                } else {
                    0.5 * (more + less)
                }
            }
            // A force decreases as its signed creepage increases. A secant step in the wrong direction is reversed.
            _ if (secant - creepage) * excess > 0.0 => secant,
            _ => creepage + (creepage - secant),
        }
    }

    /// Broyden's update of the slope, after a change of the creepages by dc changed the excess by de.
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
