//! Friction as an [`Effect`]: which effects it excludes, and the checks of steps, tables and numbers.

use std::f64::consts::PI;

use super::effect::{Effect, Value, NOT_TOGETHER};
use super::friction::{Friction, Motion, Prescribed, Previous};
use super::friction_bounds;
use super::properties::{Continues, Properties, Stresses};
use super::rolled_towards;
use crate::error::{finite, require, Error, Result, Rounded};
use crate::grid::{check_values, Grid};
use crate::influence::Coefficients;
use crate::powers::LARGEST;
use crate::scene::Plain;

/// The longest step of rolling, in elements.
const LONGEST_STEP: f64 = 1e6;
/// The shortest step of steady rolling, in elements.
const SHORTEST_STEADY_STEP: f64 = 0.1;
const OTHER_UNITS: &str = "friction needs numbers below 1e140: choose other units";

/// For the caller's tables, a step of rolling counts as one of whole elements if it differs from a whole number by at most this.
const WHOLE_STEP: f64 = 1e-9;

/// Why a solve on several grids is refused.
const OWN_COEFFICIENTS: &str =
    "friction->influence and friction->row_tables are those of one grid, and this call needs others";
const KEPT: &str = "friction->continues begins with tractions on the handle's own grid, and this call needs others: give previous_traction";
const HISTORY: &str =
    "friction->previous_coefficient and friction->previous_yield_limit are those of one grid, and this call needs others";

const CONTINUES: Continues =
    Continues { member: "friction->continues", from: "tractions", instead: "give previous_traction" };

impl Effect for Friction<'_> {
    fn name(&self) -> &'static str {
        Friction::NAME
    }

    fn properties(&self) -> Properties<'_> {
        let has_particles = self.law.is_some() || self.layer.is_some();
        // The library has no tangential coefficients for these effects. For `influence` and `row_tables` the caller may give them.
        let excludes: &[&str] = match self.influence {
            Some(influence) if influence.cross.is_none() => &["adhesion", "period", "patches"],
            // The caller's coupling coefficients are not used together with these effects.
            Some(_) => &["adhesion", "row_tables", "period", "patches", "coating"],
            None => &["adhesion", "influence", "row_tables", "period", "patches"],
        };
        // Laws and layers exclude adhesion, the first in the list: they need the pressures, and adhesion gives only traction bounds.
        let excludes = if has_particles { excludes } else { &excludes[1..] };
        let continues = (self.previous == Previous::Kept).then_some(CONTINUES);
        let has_history = has_particles && (self.coefficients_before.is_some() || self.yield_limits.is_some());
        let one_grid =
            self.influence.map(|_| OWN_COEFFICIENTS).or(continues.map(|_| KEPT)).or(has_history.then_some(HISTORY));
        Properties {
            excludes,
            without_multigrid: None,
            with_given_area: true,
            one_grid,
            own_coefficients: None,
            repeats: (false, false),
            limits: None,
            // The solver holds the tangential problem itself instead of `coupled`.
            is_beside: true,
            continues,
        }
    }

    fn why_excluded(&self, other: &str) -> &'static str {
        match other {
            "influence" if self.influence.is_none() => "they are solved together with friction->influence",
            "row_tables" if self.influence.is_none() => "they are solved together with friction->row_tables",
            _ => NOT_TOGETHER,
        }
    }

    fn check(&self, grid: &Grid) -> Result<()> {
        check(self, grid)?;
        friction_bounds::check_law(self, grid)
    }

    fn check_load(&self, scene: &Plain<'_>, others: &[Option<&dyn Effect>]) -> Result<()> {
        friction_bounds::check_bodies_of_law(self, &scene.bodies)?;
        if self.influence.is_none() {
            others.iter().flatten().try_for_each(|other| other.check_tractions(scene))?;
        }
        let has_bodies = others.iter().flatten().all(|other| other.properties().own_coefficients.is_none());
        let lacks_cross = self.influence.is_some_and(|influence| influence.cross.is_none());
        if lacks_cross && has_bodies && scene.bodies.unlike() != 0.0 {
            let by_row = self.influence.is_some_and(|influence| influence.by_row);
            let (name, rule) = match by_row {
                true => ("friction->row_tables", "tables per row are for like bodies only"),
                false => ("friction->influence", "influence_cross is not given"),
            };
            return Err(Error::Unsupported(format!(
                "{name} has no coefficients for the coupling of the normal and the tangential problem of unlike bodies: {rule}"
            )));
        }
        Ok(())
    }

    fn check_coefficients(&self, grid: &Grid, coefficients: &Coefficients) -> Result<()> {
        rolled_towards::check_pressures(self, grid, coefficients)
    }

    // The record of a set-up has no values of friction, which may differ in each solve. The solver itself keeps the tangential tables.
    fn values(&self, _tell: &mut dyn FnMut(&'static str, Value<'_>)) {}

    fn gives_way(&self, _scene: &Plain<'_>) -> bool {
        false
    }

    fn stresses(&self, _b: usize, _scene: &Plain<'_>) -> Stresses<'_> {
        Stresses::Same
    }
}

/// Checks friction, except the law and the layer.
fn check(friction: &Friction<'_>, grid: &Grid) -> Result<()> {
    check_numbers(friction)?;
    check_coefficients(friction, grid)?;
    check_step(friction, grid)?;
    check_range(friction, grid)?;
    check_influence(friction, grid)
}

/// Refuses steps of rolling that are longer than [`LONGEST_STEP`], and steps of steady rolling shorter than [`SHORTEST_STEADY_STEP`].
fn check_step(friction: &Friction<'_>, grid: &Grid) -> Result<()> {
    let (name, distance) = ("friction->rolling_distance", friction.distance(grid));
    let (x, y) = friction.elements_rolled(grid);
    let longest = x.abs().max(y.abs());
    match friction.motion {
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

/// Refuses slips and tractions that are not finite, or whose squares leave the range of double precision, and weights outside [-1, 1].
fn check_range(friction: &Friction<'_>, grid: &Grid) -> Result<()> {
    let small = |name: &str, value: f64| {
        finite(name, value)?;
        require(value.abs() < LARGEST, name, value, OTHER_UNITS)
    };
    // The slip due to creepages and spin is largest in a corner of the grid.
    let corners = [0, grid.mx - 1, grid.len() - grid.mx, grid.len() - 1];
    for slip in
        corners.iter().flat_map(|&i| Friction { rigid_slip: None, weights: None, ..*friction }.rigid_slip_at(grid, i))
    {
        require(slip.abs() < LARGEST, "the rigid slip by friction->creepage and spin", slip, OTHER_UNITS)?;
    }
    let slips = ["friction->rigid_slip[0]", "friction->rigid_slip[1]"];
    for (name, slip) in slips.iter().zip(friction.rigid_slip.iter().flatten()) {
        check_values(name, slip, grid, small)?;
    }
    let weights = ["friction->creepage_weight[0]", "friction->creepage_weight[1]"];
    for (name, weights) in weights.iter().zip(friction.weights.iter().flatten()) {
        let rule = "a weight must lie in [-1, 1]";
        check_values(name, weights, grid, |name, weight| require(weight.abs() <= 1.0, name, weight, rule))?;
    }
    let starts = ["friction->initial_traction[0]", "friction->initial_traction[1]"];
    for (name, q) in starts.iter().zip(friction.initial.iter().flatten()) {
        check_values(name, q, grid, finite)?;
    }
    let Previous::Given(before) = friction.previous else { return Ok(()) };
    for (name, q) in ["friction->previous_traction[0]", "friction->previous_traction[1]"].iter().zip(before) {
        match friction.motion {
            // Here previous tractions are only an initial guess.
            Motion::SteadyRolling => check_values(name, q, grid, finite)?,
            _ => check_values(name, q, grid, small)?,
        }
    }
    Ok(())
}

/// Refuses invalid coefficients of friction, and invalid compliances of the layer.
fn check_coefficients(friction: &Friction<'_>, grid: &Grid) -> Result<()> {
    let coefficient = |name: &str, mu: f64| {
        let rule = "a coefficient of friction must be 0 or more, and below 1e140";
        require((0.0..LARGEST).contains(&mu), name, mu, rule)
    };
    friction.coefficient.check(["friction->coefficient", "friction->coefficients"], grid, coefficient)?;
    let compliance = |name: &str, value: f64| {
        require((0.0..LARGEST).contains(&value), name, value, "a compliance must be 0 or more, and below 1e140")
    };
    friction.compliance.check(["friction->compliance", "friction->compliances"], grid, compliance)
}

/// Refuses creepages, forces, spins and steps that are not finite or out of their range.
fn check_numbers(friction: &Friction<'_>) -> Result<()> {
    for (k, prescribed) in friction.prescribed.iter().enumerate() {
        match prescribed {
            Prescribed::Creepage(creepage) => finite(["friction->creepage[0]", "friction->creepage[1]"][k], *creepage)?,
            Prescribed::Force(force) => finite(["friction->force[0]", "friction->force[1]"][k], *force)?,
        }
    }
    finite("friction->spin", friction.spin)?;
    finite("friction->spin_centre[0]", friction.spin_centre[0])?;
    finite("friction->spin_centre[1]", friction.spin_centre[1])?;
    finite("friction->spin_offset", friction.spin_offset)?;
    let (distance, direction) = (friction.rolling_distance, friction.rolling_direction);
    require(
        distance >= 0.0 && distance.is_finite(),
        "friction->rolling_distance",
        distance,
        "it must be positive and finite, or 0 for dx",
    )?;
    let turns = "an angle must lie in [-2 pi, 2 pi]";
    require(direction.abs() <= 2.0 * PI, "friction->rolling_direction", direction, turns)
}

/// Refuses the caller's tables if they do not suit the grid or the step: tables have no coefficients between whole offsets.
fn check_influence(friction: &Friction<'_>, grid: &Grid) -> Result<()> {
    let Some(influence) = &friction.influence else { return Ok(()) };
    if friction.motion != Motion::Shift {
        let (distance, (sine, cosine)) = (friction.distance(grid), friction.rolling_direction.sin_cos());
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
        influence.check(grid, friction.motion == Motion::SteadyRolling)?;
        rolled_towards::check_tangential(friction, grid)
    }
}
