//! The states on a walk along a branch, and the end of a walk.

use super::level::Level;
use super::unknowns::Unknowns;
use crate::error::Result;
use crate::methods::fields;

/// The end of a walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Walk {
    /// At the wanted force, on the stable branch.
    Found,
    /// At the least force, a sum of pressures, which is above the wanted one. The level has this state.
    Least {
        /// The sum of p.
        sum: f64,
        /// The approach.
        approach: f64,
    },
    /// At the starting state of an earlier walk.
    Met,
    /// The caller cancelled, or no cycle is left.
    Interrupted,
    /// No state is found on the way.
    Lost,
}

/// The starting state of an earlier walk.
#[derive(Clone, Copy, Debug)]
pub struct Met {
    pub approach: f64,
    /// The sum of p, and that of |p|.
    pub sum: f64,
    pub all: f64,
}

impl Met {
    /// The state of a level.
    pub fn of(level: &Level) -> Met {
        let now = &level.now;
        let of_element = |i: usize| [now.p.field[i][0], now.p.field[i][0].abs()];
        let [sum, all] = fields::sum(&level.problem.threads, now.u.len(), of_element);
        Met { approach: now.approach(), sum, all }
    }
}

/// A state on the way.
pub struct Place {
    pub at: Unknowns,
    /// The sum of p.
    pub sum: f64,
}

impl Place {
    /// The state of a level.
    pub fn of(level: &Level, sum: f64) -> Result<Place> {
        let mut place = Place { at: Unknowns::default(), sum };
        place.at.copy_from(&level.now)?;
        Ok(place)
    }

    pub fn approach(&self) -> f64 {
        self.at.approach()
    }

    /// Copies the state of a level.
    pub fn take(&mut self, level: &Level, sum: f64) -> Result<()> {
        self.sum = sum;
        self.at.copy_from(&level.now)
    }
}
