//! Stored states on a path along a branch, and how a path ends.

use super::level::Level;
use super::unknowns::Unknowns;
use crate::error::Result;
use crate::methods::fields;

/// How a path ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathEnd {
    /// At the wanted force, in a stable state. The level has this state.
    Found,
    /// At the least force of the path, which is above the wanted one. The level has the state of the least force.
    Least {
        /// The sum of p.
        sum: f64,
        /// The approach.
        approach: f64,
    },
    /// At the state at which an earlier path started, without a smaller force before.
    Joined,
    /// The caller cancelled, or no cycle is left.
    Interrupted,
    /// Without a next state: none is found.
    Lost,
}

/// The approach and the sums of pressures of a state. Two paths have met if these are nearly equal.
#[derive(Clone, Copy, Debug)]
pub struct StateSums {
    /// The approach.
    pub approach: f64,
    /// The sum of p.
    pub sum: f64,
    /// The sum of |p|.
    pub all: f64,
}

impl StateSums {
    /// The state of a level.
    pub fn of(level: &Level) -> StateSums {
        let now = &level.now;
        let of_element = |i: usize| [now.p.field[i][0], now.p.field[i][0].abs()];
        let [sum, all] = fields::sum(&level.problem.threads, now.u.len(), of_element);
        StateSums { approach: now.approach(), sum, all }
    }
}

/// A copy of a state on a path.
pub struct SavedState {
    /// p, u, C and the approach.
    pub unknowns: Unknowns,
    /// The sum of p.
    pub sum: f64,
}

impl SavedState {
    /// The state of a level.
    pub fn of(level: &Level, sum: f64) -> Result<SavedState> {
        let mut state = SavedState { unknowns: Unknowns::default(), sum };
        state.unknowns.copy_from(&level.now)?;
        Ok(state)
    }

    /// The approach of the state.
    pub fn approach(&self) -> f64 {
        self.unknowns.approach()
    }

    /// Replaces this copy by the state of a level, with the sum of p.
    pub fn take(&mut self, level: &Level, sum: f64) -> Result<()> {
        self.sum = sum;
        self.unknowns.copy_from(&level.now)
    }
}
