//! Whether the traction bounds depend on the slip (by a friction law or a plastic layer), and the checks of laws and layers.

use super::friction::{Friction, Motion};
use super::friction_law::{ordinary, zero_or_ordinary, Branch};
use crate::error::{require, Error, Result};
use crate::grid::{check_values, Grid};
use crate::powers::LARGEST;
use crate::scene::Bodies;

impl Friction<'_> {
    /// Whether the traction bounds depend on the slip, so that [`law`](crate::friction::law) solves the tangential problem.
    pub fn has_law(&self) -> bool {
        self.law.is_some() || self.layer.is_some_and(|layer| layer.hardening != 0.0)
    }

    /// Whether the traction bounds depend on the history of the particles of the interface.
    pub fn has_memory(&self) -> bool {
        self.law.is_some_and(|law| law.memory_distance > 0.0) || self.layer.is_some_and(|layer| layer.hardening != 0.0)
    }

    /// The duration of the step, by which a law divides the slip to get the slip velocity. 1 without a law.
    pub fn duration(&self, grid: &Grid) -> f64 {
        match (self.law, self.motion) {
            (None, _) => 1.0,
            (Some(law), Motion::Shift) => law.time_step,
            (Some(law), _) => self.distance(grid) / law.speed,
        }
    }

    /// Whether a plastic layer bounds the tractions, and the bounds do not depend on the slip.
    pub fn has_ideal_layer(&self) -> bool {
        self.layer.is_some() && !self.has_law()
    }

    /// The coefficients of friction of the particles before the step. None: they are not given, or the bounds do not depend on the slip.
    pub(crate) fn coefficients_read(&self) -> Option<&[f64]> {
        self.coefficients_before.filter(|_| self.has_law())
    }

    /// The yield limits of the particles before the step. None: they are not given, or there is no plastic layer.
    pub(crate) fn yield_limits_read(&self) -> Option<&[f64]> {
        self.yield_limits.filter(|_| self.layer.is_some())
    }
}

/// Refuses invalid laws, layers and histories, and options of friction that are not solved together with a law.
pub(super) fn check_law(friction: &Friction<'_>, grid: &Grid) -> Result<()> {
    if let Some(law) = &friction.law {
        law.check(friction.motion == Motion::Shift)?;
    }
    if let Some(layer) = &friction.layer {
        ordinary("friction->yield_limit", layer.yield_limit)?;
        let rule = "it must be below 1e140: choose other units";
        require(layer.hardening.abs() < LARGEST, "friction->hardening", layer.hardening, rule)?;
    }
    friction
        .coefficients_read()
        .map_or(Ok(()), |values| check_values("friction->previous_coefficient", values, grid, zero_or_ordinary))?;
    friction
        .yield_limits_read()
        .map_or(Ok(()), |values| check_values("friction->previous_yield_limit", values, grid, kept_limit))?;
    if !friction.has_law() {
        return Ok(());
    }
    let refused = |rule: &str| {
        let name = if friction.law.is_some() { "friction->law" } else { "friction->hardening" };
        Err(Error::Unsupported(format!("{name} is given: {rule}")))
    };
    if friction.branch != Branch::Near && friction.has_forces() != [false; 2] {
        return refused("with a branch creepages must be prescribed in both directions");
    }
    if friction.sensitivities {
        return refused("friction->sensitivities must be 0");
    }
    let (x, y) = friction.elements_rolled(grid);
    let is_whole = x.fract() == 0.0 && y.fract() == 0.0 && (x == 0.0 || y == 0.0);
    if friction.motion == Motion::SteadyRolling && friction.has_memory() && !is_whole {
        return refused("with memory a step of steady rolling must be of whole elements along x or along y");
    }
    Ok(())
}

/// Refuses a law for bodies whose normal and tangential problems are coupled.
pub(super) fn check_bodies_of_law(friction: &Friction<'_>, bodies: &Bodies) -> Result<()> {
    let has_cross = friction.influence.is_some_and(|influence| influence.cross.is_some());
    let are_unlike = friction.influence.is_none() && bodies.unlike() != 0.0;
    if friction.has_law() && (has_cross || are_unlike) {
        let name = if friction.law.is_some() { "friction->law" } else { "friction->hardening" };
        return Err(Error::Unsupported(format!("{name} is given: bodies must be alike")));
    }
    Ok(())
}

/// Refuses an invalid yield limit of a particle before the step. The limit may have softened to a thousandth of that of fresh material.
fn kept_limit(name: &str, limit: f64) -> Result<()> {
    let rule = "it must be positive, from 1e-143 to 1e140: choose other units";
    require((1e-3 / LARGEST..=LARGEST).contains(&limit), name, limit, rule)
}
