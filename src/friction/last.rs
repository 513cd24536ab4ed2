//! The result of the last step. A step that takes several solves may fail after some of them: a copy restores the result before.

use super::law::Particle;
use super::plane::Vector;
use super::solution::Solution;
use super::solver::Solver;
use crate::error::Result;
use crate::memory::{copied, keep};

/// A copy of the last result of a solver.
pub struct Last {
    solution: Solution,
    /// The creepages found, times the length of the step.
    offset: Vector,
    /// Whether the last solve had friction.
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
    /// The result of the last step with friction, from which another step may continue.
    pub fn last_step(&self) -> Option<&Solution> {
        self.has_solution.then_some(&self.solution)
    }

    /// Takes the tractions and particles of a step of another solver on the same grid, so that a step may continue from them.
    pub fn take_step(&mut self, traction: Vec<Vector>, particles: Vec<Particle>) -> Result<()> {
        self.make_room()?;
        self.solution = Solution { traction, particles, ..std::mem::take(&mut self.solution) };
        self.has_solution = true;
        Ok(())
    }

    /// Records that a solve had no friction, so that there is no tangential result of it. The tractions of the last step with friction are kept for a
    /// step that continues from them.
    pub fn pass_over(&mut self) {
        self.had_friction = false;
    }

    /// Copies the last result; none if there is none.
    pub fn last(&self) -> Result<Option<Last>> {
        let Some(Solution { traction, slip, stick_slip, particles }) = self.last_step() else { return Ok(None) };
        let what = "the tractions before";
        let (traction, slip) = (copied(traction, what)?, copied(slip, what)?);
        let (stick_slip, particles) = (copied(stick_slip, what)?, copied(particles, what)?);
        let solution = Solution { traction, slip, stick_slip, particles };
        Ok(Some(Last { solution, offset: self.offset, had_friction: self.had_friction }))
    }

    /// Takes the last result of another solver on the same grid, which gets the memory of this solver's result.
    pub fn take_last_of(&mut self, other: &mut Solver) {
        std::mem::swap(&mut self.solution, &mut other.solution);
        std::mem::swap(&mut self.sums, &mut other.sums);
        (self.offset, self.has_solution, self.had_friction) = (other.offset, other.has_solution, other.had_friction);
    }

    /// Restores the result from a copy. Without a copy there is no result afterwards.
    pub fn go_back(&mut self, last: Option<Last>) {
        self.has_solution = last.is_some();
        if let Some(mut last) = last {
            std::mem::swap(&mut self.solution, &mut last.solution);
            (self.offset, self.had_friction) = (last.offset, last.had_friction);
        }
    }
}
