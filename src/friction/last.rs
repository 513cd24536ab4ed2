//! The last step, and a copy of it, to restore it if a step of several solves fails.

use super::law::Particle;
use super::plane::Vector;
use super::solution::Solution;
use super::solver::Solver;
use crate::error::Result;
use crate::memory::{copied, keep};

/// A copy of the last result.
pub struct Last {
    solution: Solution,
    offset: Vector,
    had_friction: bool,
}

impl Drop for Last {
    fn drop(&mut self) {
        let Solution { traction, slip, stick_slip, .. } = &mut self.solution;
        keep([traction, slip]);
        keep([stick_slip]);
    }
}

impl Solver {
    /// The last step, from which another one may continue.
    pub fn last_step(&self) -> Option<&Solution> {
        self.has_solution.then_some(&self.solution)
    }

    /// Takes a step of another solver on the same grid.
    pub fn take_step(&mut self, traction: Vec<Vector>, particles: Vec<Particle>) -> Result<()> {
        self.make_room()?;
        self.solution = Solution { traction, particles, ..std::mem::take(&mut self.solution) };
        self.has_solution = true;
        Ok(())
    }

    /// Notes a solve without friction: its result has no tractions. The tractions of the last step stay, for a step that continues from them.
    pub fn pass_over(&mut self) {
        self.had_friction = false;
    }

    /// A copy of the last result, if there is one.
    pub fn last(&self) -> Result<Option<Last>> {
        let Some(Solution { traction, slip, stick_slip, particles }) = self.last_step() else { return Ok(None) };
        let what = "the tractions before";
        let (traction, slip) = (copied(traction, what)?, copied(slip, what)?);
        let (stick_slip, particles) = (copied(stick_slip, what)?, copied(particles, what)?);
        let solution = Solution { traction, slip, stick_slip, particles };
        Ok(Some(Last { solution, offset: self.offset, had_friction: self.had_friction }))
    }

    /// Takes the last result of another solver on the same grid.
    pub fn take_last_of(&mut self, other: &mut Solver) {
        std::mem::swap(&mut self.solution, &mut other.solution);
        std::mem::swap(&mut self.sums, &mut other.sums);
        (self.offset, self.has_solution, self.had_friction) = (other.offset, other.has_solution, other.had_friction);
    }

    /// Restores the copy.
    pub fn go_back(&mut self, last: Option<Last>) {
        self.has_solution = last.is_some();
        if let Some(mut last) = last {
            std::mem::swap(&mut self.solution, &mut last.solution);
            (self.offset, self.had_friction) = (last.offset, last.had_friction);
        }
    }
}
