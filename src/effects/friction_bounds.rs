//! Bounds of tractions with a law or a layer, and the checks of these.

use super::friction::{Friction, Motion};
use super::friction_law::{ordinary, zero_or_ordinary, Branch};
use crate::error::{require, Error, Result};
use crate::grid::{check_values, Grid};
use crate::powers::LARGEST;
use crate::scene::Bodies;

impl Friction<'_> {
    /// Whether the bounds depend on the slip, so that [`law`](crate::friction::law) solves the tangential problem.
    pub fn has_law(&self) -> bool {
        self.law.is_some() || self.layer.is_some_and(|layer| layer.hardening != 0.0)
    }

    /// Whether the bounds depend on the history of the interface's particles.
    pub fn has_memory(&self) -> bool {
        self.law.is_some_and(|law| law.memory_distance > 0.0) || self.layer.is_some_and(|layer| layer.hardening != 0.0)
    }

    /// The duration of a step for a law's speed; 1 without a law.
    pub fn duration(&self, grid: &Grid) -> f64 {
        match (self.law, self.motion) {
            (None, _) => 1.0,
            (Some(law), Motion::Shift) => law.time_step,
            (Some(law), _) => self.distance(grid) / law.speed,
        }
    }

    /// Whether a layer bounds the tractions by limits that do not depend on the slip.
    pub fn has_ideal_layer(&self) -> bool {
        self.layer.is_some() && !self.has_law()
    }

    /// The coefficients of particles before the step; none are read without a law or a layer that changes.
    pub(crate) fn coefficients_read(&self) -> Option<&[f64]> {
        self.coefficients_before.filter(|_| self.has_law())
    }

    /// The yield limits of particles before the step; none are read without a layer.
    pub(crate) fn yield_limits_read(&self) -> Option<&[f64]> {
        self.yield_limits.filter(|_| self.layer.is_some())
    }
}

/// Refuses invalid laws, layers and histories, and those that are not solved with the rest.
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

/// Refuses unlike bodies with a law.
pub(super) fn check_bodies_of_law(friction: &Friction<'_>, bodies: &Bodies) -> Result<()> {
    let has_cross = friction.influence.is_some_and(|influence| influence.cross.is_some());
    let is_unlike = friction.influence.is_none() && bodies.unlike() != 0.0;
    if friction.has_law() && (has_cross || is_unlike) {
        let name = if friction.law.is_some() { "friction->law" } else { "friction->hardening" };
        return Err(Error::Unsupported(format!("{name} is given: bodies must be alike")));
    }
    Ok(())
}

/// Refuses an invalid yield limit before the step, which may have fallen to a thousandth of that of fresh material.
fn kept_limit(name: &str, limit: f64) -> Result<()> {
    let rule = "it must be positive, from 1e-143 to 1e140: choose other units";
    require((1e-3 / LARGEST..=LARGEST).contains(&limit), name, limit, rule)
}
