//! Effect: the scene is periodic in x, in y or in both. The grid is one period.
//!
//! [`Periodic`](crate::influence::Periodic) describes the coefficients and from which plane the approach counts.

use std::sync::Arc;

use super::effect::{Effect, Value};
use super::properties::{Properties, Stresses};
use crate::error::{invalid, Error, Number, Result};
use crate::grid::Grid;
use crate::influence::{HalfSpace, Kernel, Periodic};
use crate::scene::{Load, Plain};
use crate::sums::mean;

/// The message that refuses a given approach if the given contact area is the whole grid.
const FULL: &str = "active_set is FIXED and all elements are in contact; with two periods the approach is relative to the mean plane, \
     and any force fits: prescribe the force";

/// The directions in which the scene is periodic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Period {
    /// Whether the scene is periodic in x, with the period `mx dx`.
    pub x: bool,
    /// Whether the scene is periodic in y, with the period `my dy`.
    pub y: bool,
}

impl Effect for Period {
    fn name(&self) -> &'static str {
        "period"
    }

    fn properties(&self) -> Properties<'_> {
        Properties {
            excludes: &[],
            without_multigrid: Some(self.name()),
            with_given_area: true,
            one_grid: None,
            own_coefficients: None,
            repeats: (self.x, self.y),
            limits: None,
            is_beside: false,
            continues: None,
        }
    }

    fn check(&self, _grid: &Grid) -> Result<()> {
        if !self.x && !self.y {
            return invalid("period->x and period->y are 0; at least one must be 1. For no period, give NULL".into());
        }
        Ok(())
    }

    // With two periods the mean displacement is zero, so the mean deformed distance is mean(h) - approach for any force. If this mean is zero,
    // contact is full and any force satisfies the conditions. If this mean is negative, no pressures do. Such approaches are refused.
    fn check_area(&self, scene: &Plain<'_>, others: &[Option<&dyn Effect>], given: Option<&[bool]>) -> Result<()> {
        let (Load::Approach(approach), true, true) = (scene.load, self.x, self.y) else { return Ok(()) };
        if others.iter().flatten().any(|other| other.gives_way(scene)) {
            return Ok(());
        }
        let h = scene.undeformed_distance;
        if let Some(contact) = given {
            let is_full = contact.iter().zip(h).all(|(inside, h)| *inside && h.is_finite());
            return if is_full { Err(Error::Infeasible(FULL.into())) } else { Ok(()) };
        }
        let mean = mean(h);
        if approach >= mean {
            return Err(Error::Infeasible(format!(
                "approach is {}, the mean of undeformed_distance {}; with two periods the approach is relative to the \
                 mean plane and must be less than that: contact is full there, at any force. Prescribe the force",
                Number(approach),
                Number(mean)
            )));
        }
        Ok(())
    }

    fn kernel(&self, scene: &Plain<'_>, _others: &[Option<&dyn Effect>]) -> Result<Option<Arc<dyn Kernel>>> {
        let half_space = HalfSpace::new(scene.grid.dx, scene.grid.dy, scene.bodies.compliance());
        Ok(Some(Arc::new(Periodic::new(half_space, (self.x, self.y), &scene.grid)?)))
    }

    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>)) {
        tell("period->x", Value::Number(f64::from(self.x)));
        tell("period->y", Value::Number(f64::from(self.y)));
    }

    fn gives_way(&self, _scene: &Plain<'_>) -> bool {
        false
    }

    fn stresses(&self, _b: usize, _scene: &Plain<'_>) -> Stresses<'_> {
        match self {
            Period { x: true, y: true } => Stresses::Repeat,
            _ => Stresses::Unknown("repeats in one direction; subsurface stresses need two periods or none"),
        }
    }
}
