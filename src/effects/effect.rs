//! The trait of an effect.

use std::sync::Arc;

use super::coupled::{Coupled, History};
use super::memory::Memory;
use super::properties::{Properties, Stresses};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::{Coefficients, Kernel};
use crate::memory::Held;
use crate::scene::{Bodies, Plain};

/// A value of an effect.
#[derive(Clone, Copy, Debug)]
pub enum Value<'a> {
    /// A number, a count, or a switch (0 or 1).
    Number(f64),
    /// One per element.
    Array(&'a [f64]),
    /// One integer per element.
    Integers(&'a [i32]),
    /// An array shared with the coefficients.
    Shared(&'a Arc<Held>),
}

/// The usual reason why an effect excludes another.
pub(super) const NOT_TOGETHER: &str = "this version does not solve them together";

/// An effect. The [`Properties`] and the methods up to [`stresses`](Effect::stresses) have no default. The other methods change nothing by default.
pub trait Effect {
    /// The name in a scene.
    fn name(&self) -> &'static str;

    /// The effects it goes with, and the quantities it changes.
    fn properties(&self) -> Properties<'_>;

    /// Refuses invalid values.
    fn check(&self, grid: &Grid) -> Result<()>;

    /// Calls `tell` with each value that a set-up depends on, and its name. All other values may differ in each solve.
    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>));

    /// Whether surfaces can approach beyond their mean distance with two periods: a uniform pressure compresses a layer, or pressures are limited.
    /// Otherwise a uniform pressure does not move the bodies.
    fn gives_way(&self, scene: &Plain<'_>) -> bool;

    /// The stresses below the surface of body 1 (`b` is 0) or 2 with this effect.
    fn stresses(&self, b: usize, scene: &Plain<'_>) -> Stresses<'_>;

    /// The reason in the refusal of another effect that it excludes.
    fn why_excluded(&self, _other: &str) -> &'static str {
        NOT_TOGETHER
    }

    /// Whether the values change the scene, or are invalid: then the scene refuses them. Otherwise the scene counts as one without the effect.
    fn is_one(&self, _scene: &Plain<'_>) -> bool {
        true
    }

    /// Refuses a load that cannot be carried with the other effects; called for each solve.
    fn check_load(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>]) -> Result<()> {
        Ok(())
    }

    /// Refuses a load that no pressures carry with the other effects, on any contact area or on the given one; called for each solve.
    fn check_area(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>], _given: Option<&[bool]>) -> Result<()> {
        Ok(())
    }

    /// The materials at the surfaces of the bodies, if the effect covers them; none: the bodies' own.
    fn at_surface(&self, _scene: &Plain<'_>) -> Option<Bodies> {
        None
    }

    /// Refuses tractions if the library has no tangential coefficients for this effect, or if tractions would change
    /// the pressures.
    fn check_tractions(&self, _scene: &Plain<'_>) -> Result<()> {
        Ok(())
    }

    /// The kernel of the effect in place of the half-space's, which may depend on the other effects.
    fn kernel(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>]) -> Result<Option<Arc<dyn Kernel>>> {
        Ok(None)
    }

    /// Changes the coefficients of the kernel.
    fn apply(&self, coefficients: Coefficients) -> Result<Coefficients> {
        Ok(coefficients)
    }

    /// Called for the caller's `coefficients` of pressures if these are not symmetric: refuses those that do not suit the effect.
    fn check_coefficients(&self, _grid: &Grid, _coefficients: &Coefficients) -> Result<()> {
        Ok(())
    }

    /// The undeformed distance changed from `h`; none: unchanged.
    fn surface(&self, _h: &[f64]) -> Result<Option<Vec<f64>>> {
        Ok(None)
    }

    /// The memory of bodies, with the `history` of earlier steps, in this step.
    fn memory(
        &self,
        _scene: &Plain<'_>,
        _others: &[Option<&dyn Effect>],
        _history: &mut History,
    ) -> Result<Option<Box<dyn Memory>>> {
        Ok(None)
    }

    /// The problem solved in turns with the normal one; `history`: that of earlier steps. The solver holds the problem of friction itself;
    /// `tests/unit/foundation.rs` is an example.
    fn coupled<'s>(&'s self, _scene: &Plain<'_>, _history: &'s mut History) -> Result<Option<Box<dyn Coupled + 's>>> {
        Ok(None)
    }
}
