//! Effect: pressures do not exceed a limit, the hardness of the softer surface: `0 <= p <= p_max`.
//!
//! This is an elastic body with a perfectly plastic surface (Polonsky & Keer 1999, section 2). The limit is about 2.8 yield stresses. Where the
//! pressure is at the limit, the surface yields, and -e is the depth of the plastic indentation.
//!
//! ```text
//! p = 0,          e >= 0    in the exterior area
//! 0 <= p,         e = 0     in contact
//! p = p_max,      e <= 0    at the limit
//! ```

use std::ops::Range;

use super::each::Each;
use super::effect::{Effect, Value};
use super::properties::{PressureLimit, Properties, Stresses};
use crate::blocks;
use crate::error::{invalid, Error, Number, Result};
use crate::grid::Grid;
use crate::scene::{Load, Plain};
use crate::sums::ROUND_OFF;
use crate::threads::Threads;

impl Effect for PressureLimit<'_> {
    fn name(&self) -> &'static str {
        "pressure_limit"
    }

    fn properties(&self) -> Properties<'_> {
        Properties {
            excludes: &[],
            without_multigrid: None,
            with_given_area: false,
            one_grid: None,
            own_coefficients: None,
            repeats: (false, false),
            limits: Some(*self),
            is_beside: false,
            continues: None,
        }
    }

    fn check(&self, grid: &Grid) -> Result<()> {
        let require = |name: &str, limit: f64| match limit {
            limit if limit.is_nan() => Err(Error::NotFinite(format!("{name} is {limit}; it must be a number"))),
            limit if limit <= 0.0 => {
                invalid(format!("{name} is {}; a pressure limit must be positive; +infinity: none", Number(limit)))
            }
            _ => Ok(()),
        };
        self.0.check(["pressure_limit->limit", "pressure_limit->limits"], grid, require)
    }

    // Elements at their limit yield, so the approach can exceed the mean undeformed distance.
    fn gives_way(&self, scene: &Plain<'_>) -> bool {
        let may_yield = |(h, limit): (&f64, f64)| h.is_finite() && limit < f64::INFINITY;
        let h = scene.undeformed_distance.iter();
        match self.0 {
            Each::Uniform(limit) => h.zip(std::iter::repeat(limit)).any(may_yield),
            Each::PerElement(limits) => h.zip(limits.iter().copied()).any(may_yield),
        }
    }

    // Refuses a force that exceeds the sum of p_max dx dy over all elements with a surface.
    fn check_load(&self, scene: &Plain<'_>, _: &[Option<&dyn Effect>]) -> Result<()> {
        self.check(&scene.grid)?;
        let Load::Force(force) = scene.load else { return Ok(()) };
        let h = scene.undeformed_distance;
        let surface = |block: Range<usize>| block.filter(|&i| h[i].is_finite());
        // A uniform limit is multiplied, others are summed in blocks. A plain sum of many equal limits would have a larger error than the one that is
        // allowed below.
        let limits = match self.0 {
            Each::Uniform(limit) => surface(0..h.len()).count() as f64 * limit,
            Each::PerElement(limits) => {
                let of_block = |block| surface(block).map(|i| limits[i]).sum::<f64>();
                blocks::fold(&scene.grid, &Threads::One, 0.0, of_block, |sum, block| sum + block)
            }
        };
        let greatest = limits * scene.grid.element_area();
        // ROUND_OFF allows for the round-off of the sum.
        if force > greatest * (1.0 + ROUND_OFF) {
            return Err(Error::Infeasible(format!(
                "force is {}; with this pressure_limit the greatest force that can be carried is {}",
                Number(force),
                Number(greatest)
            )));
        }
        Ok(())
    }

    // The set-up of a solver does not depend on the limit, which may differ in each solve.
    fn values(&self, _tell: &mut dyn FnMut(&'static str, Value<'_>)) {}

    fn stresses(&self, _b: usize, _scene: &Plain<'_>) -> Stresses<'_> {
        Stresses::Same
    }
}
