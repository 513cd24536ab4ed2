//! Checks of friction: steps, tables and numbers.

use std::f64::consts::PI;

use super::friction::{Friction, Motion, Prescribed, Previous};
use crate::error::{finite, require, Error, Result, Rounded};
use crate::grid::{check_values, Grid};
use crate::powers::LARGEST;

/// Longest step of rolling, in elements.
const LONGEST_STEP: f64 = 1e6;
/// Shortest step of steady rolling, in elements.
const SHORTEST_STEADY_STEP: f64 = 0.1;
const OTHER_UNITS: &str = "friction needs numbers below 1e140: choose other units";

/// Distance from a whole number of elements at which a step of rolling counts as whole.
const WHOLE_STEP: f64 = 1e-9;

impl Friction<'_> {
    /// Refuses steps beyond all grids, and steps of steady rolling that elements do not resolve.
    pub(super) fn check_step(&self, grid: &Grid) -> Result<()> {
        let (name, distance) = ("friction->rolling_distance", self.distance(grid));
        let (x, y) = self.elements_rolled(grid);
        let longest = x.abs().max(y.abs());
        match self.motion {
            Motion::Shift => Ok(()),
            Motion::TransientRolling => {
                let rule = "a step of transient rolling must be at most a million elements long";
                require(longest <= LONGEST_STEP, name, distance, rule)
            }
            Motion::SteadyRolling => {
                let rule =
                    "a step of steady rolling must be at least a tenth of an element long, and at most a million elements";
                require((SHORTEST_STEADY_STEP..=LONGEST_STEP).contains(&longest), name, distance, rule)
            }
        }
    }

    /// Refuses slips and tractions that are no numbers, or whose squares leave the range of double precision.
    pub(super) fn check_range(&self, grid: &Grid) -> Result<()> {
        let small = |name: &str, value: f64| {
            finite(name, value)?;
            require(value.abs() < LARGEST, name, value, OTHER_UNITS)
        };
        // Slips by creepages and spin are largest in a corner.
        let corners = [0, grid.mx - 1, grid.len() - grid.mx, grid.len() - 1];
        for slip in
            corners.iter().flat_map(|&i| Friction { rigid_slip: None, weights: None, ..*self }.rigid_slip_at(grid, i))
        {
            require(slip.abs() < LARGEST, "the rigid slip by friction->creepage and spin", slip, OTHER_UNITS)?;
        }
        for (name, own) in
            ["friction->rigid_slip[0]", "friction->rigid_slip[1]"].iter().zip(self.rigid_slip.iter().flatten())
        {
            check_values(name, own, grid, small)?;
        }
        let weights = ["friction->creepage_weight[0]", "friction->creepage_weight[1]"];
        for (name, weights) in weights.iter().zip(self.weights.iter().flatten()) {
            let rule = "a weight must lie in [-1, 1]";
            check_values(name, weights, grid, |name, weight| require(weight.abs() <= 1.0, name, weight, rule))?;
        }
        let starts = ["friction->initial_traction[0]", "friction->initial_traction[1]"];
        for (name, q) in starts.iter().zip(self.initial.iter().flatten()) {
            check_values(name, q, grid, finite)?;
        }
        let Previous::Given(before) = self.previous else { return Ok(()) };
        for (name, q) in ["friction->previous_traction[0]", "friction->previous_traction[1]"].iter().zip(before) {
            match self.motion {
                // Previous tractions only start the iteration.
                Motion::SteadyRolling => check_values(name, q, grid, finite)?,
                _ => check_values(name, q, grid, small)?,
            }
        }
        Ok(())
    }

    /// Refuses invalid coefficients and compliances.
    pub(super) fn check_coefficients(&self, grid: &Grid) -> Result<()> {
        let coefficient = |name: &str, mu: f64| {
            let rule = "a coefficient of friction must be 0 or more, and below 1e140";
            require((0.0..LARGEST).contains(&mu), name, mu, rule)
        };
        self.coefficient.check(["friction->coefficient", "friction->coefficients"], grid, coefficient)?;
        let compliance = |name: &str, value: f64| {
            require((0.0..LARGEST).contains(&value), name, value, "a compliance must be 0 or more, and below 1e140")
        };
        self.compliance.check(["friction->compliance", "friction->compliances"], grid, compliance)
    }

    /// Refuses invalid numbers.
    pub(super) fn check_numbers(&self) -> Result<()> {
        for (k, prescribed) in self.prescribed.iter().enumerate() {
            match prescribed {
                Prescribed::Creepage(creepage) => {
                    finite(["friction->creepage[0]", "friction->creepage[1]"][k], *creepage)?
                }
                Prescribed::Force(force) => finite(["friction->force[0]", "friction->force[1]"][k], *force)?,
            }
        }
        finite("friction->spin", self.spin)?;
        finite("friction->spin_centre[0]", self.spin_centre[0])?;
        finite("friction->spin_centre[1]", self.spin_centre[1])?;
        finite("friction->spin_offset", self.spin_offset)?;
        let (distance, direction) = (self.rolling_distance, self.rolling_direction);
        require(
            distance >= 0.0 && distance.is_finite(),
            "friction->rolling_distance",
            distance,
            "it must be positive and finite, or 0 for dx",
        )?;
        let turns = "an angle must lie in [-2 pi, 2 pi]";
        require(direction.abs() <= 2.0 * PI, "friction->rolling_direction", direction, turns)
    }

    /// Refuses tables that suit no motion on the grid: each solve refuses those that do not suit its own.
    pub fn check_tables(&self, grid: &Grid) -> Result<()> {
        match &self.influence {
            Some(influence) if influence.by_row => influence.check_rows(grid),
            Some(influence) => influence.check(grid, true),
            None => Ok(()),
        }
    }

    /// Refuses tables that do not suit the grid or the step: they have no coefficients between whole offsets.
    pub(super) fn check_influence(&self, grid: &Grid) -> Result<()> {
        let Some(influence) = &self.influence else { return Ok(()) };
        if self.motion != Motion::Shift {
            let (distance, (sine, cosine)) = (self.distance(grid), self.rolling_direction.sin_cos());
            let (x, y) = (distance * cosine / grid.dx, distance * sine / grid.dy);
            let far = format!("({}, {}) elements far", Rounded(x), Rounded(y));
            if influence.by_row && y.abs() > WHOLE_STEP {
                return Err(Error::Unsupported(format!(
                    "friction->row_tables are given, and a step of rolling goes {far}; it must go along x"
                )));
            }
            if (x - x.round()).abs().max((y - y.round()).abs()) > WHOLE_STEP {
                return Err(Error::Unsupported(format!(
                    "{} is given, and a step of rolling goes {far}; it must be whole elements",
                    influence.name()
                )));
            }
        }
        if influence.by_row {
            influence.check_rows(grid)
        } else {
            influence.check(grid, self.motion == Motion::SteadyRolling)?;
            self.check_rolled(grid)
        }
    }
}
