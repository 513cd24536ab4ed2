//! [`Effect`]: what the library asks of an effect. An effect (friction, a coating, a period, ...) is simulated only if the scene has it.

use std::sync::Arc;

use super::coupled::{Coupled, History};
use super::memory::Memory;
use super::properties::{Properties, Stresses};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::{Coefficients, Kernel};
use crate::memory::Held;
use crate::scene::{Bodies, Plain};

/// A value of an effect on which the set-up of a solver depends.
#[derive(Clone, Copy, Debug)]
pub enum Value<'a> {
    /// A number, a count, or a switch (0 or 1).
    Number(f64),
    /// An array of numbers, for instance one for each element.
    Array(&'a [f64]),
    /// An array of integers, one for each element.
    Integers(&'a [i32]),
    /// A table of influence coefficients. The effect shares its memory with the solver.
    Shared(&'a Arc<Held>),
}

/// The usual reason why an effect excludes another one.
pub(super) const NOT_TOGETHER: &str = "this version does not solve them together";

/// An effect of a scene. The methods up to [`stresses`](Effect::stresses) have no default; the defaults of the others change nothing.
///
/// `scene` is the scene without its effects. `others` has an entry for each effect of the library, this one included, in the order of the
/// list (`list.rs`); None: the scene does not have that effect.
pub trait Effect {
    /// The name of the effect in scenes and messages.
    fn name(&self) -> &'static str;

    /// Returns what the effect excludes and what it changes.
    fn properties(&self) -> Properties<'_>;

    /// Refuses invalid values.
    fn check(&self, grid: &Grid) -> Result<()>;

    /// Calls `tell` with the name and the value of each quantity on which the set-up of a solver depends. All other quantities may differ in each
    /// solve.
    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>));

    /// Whether, in a scene with two periods, the approach can exceed the mean undeformed distance: because a uniform pressure compresses a layer, or
    /// because the pressures are limited. Without such an effect a uniform pressure does not displace the surfaces of a scene with two periods.
    fn gives_way(&self, scene: &Plain<'_>) -> bool;

    /// How the effect changes the stresses below the surface of body 1 (`b` is 0) or of body 2 (`b` is 1).
    fn stresses(&self, b: usize, scene: &Plain<'_>) -> Stresses<'_>;

    /// The reason, for the message that refuses this effect together with `_other`.
    fn why_excluded(&self, _other: &str) -> &'static str {
        NOT_TOGETHER
    }

    /// Whether the scene has this effect: the values change the solution, or they are invalid and the scene has to refuse them. Otherwise the scene
    /// is solved as one without the effect.
    fn is_one(&self, _scene: &Plain<'_>) -> bool {
        true
    }

    /// Called for each solve. Refuses a scene that cannot be solved with this load, these bodies, or these other effects.
    fn check_load(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>]) -> Result<()> {
        Ok(())
    }

    /// Called for each solve. Refuses a load that no admissible pressures carry on any contact area, or on the `_given` one.
    fn check_area(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>], _given: Option<&[bool]>) -> Result<()> {
        Ok(())
    }

    /// The elastic constants at the surfaces of the bodies, which are those of a coating where there is one. None: the effect leaves the constants of
    /// the scene.
    fn at_surface(&self, _scene: &Plain<'_>) -> Option<Bodies> {
        None
    }

    /// Called with friction to which the caller gives no tangential coefficients. Refuses friction if the library has no such coefficients for this
    /// effect, or if tractions would change the pressures.
    fn check_tractions(&self, _scene: &Plain<'_>) -> Result<()> {
        Ok(())
    }

    /// The kernel that replaces the half-space's. It may depend on the other effects. None: the effect has no kernel.
    fn kernel(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>]) -> Result<Option<Arc<dyn Kernel>>> {
        Ok(None)
    }

    /// Changes the coefficients of the kernel.
    fn apply(&self, coefficients: Coefficients) -> Result<Coefficients> {
        Ok(coefficients)
    }

    /// Called if the caller's `_coefficients` of pressures are not symmetric. Refuses coefficients that cannot be solved with this effect.
    fn check_coefficients(&self, _grid: &Grid, _coefficients: &Coefficients) -> Result<()> {
        Ok(())
    }

    /// The undeformed distance that replaces `_h`. None: the effect does not change the undeformed distance.
    fn surface(&self, _h: &[f64]) -> Result<Option<Vec<f64>>> {
        Ok(None)
    }

    /// A step in time of bodies whose displacements depend on the `_history` of earlier steps. None: the effect has no such step.
    fn memory(
        &self,
        _scene: &Plain<'_>,
        _others: &[Option<&dyn Effect>],
        _history: &mut History,
    ) -> Result<Option<Box<dyn Memory>>> {
        Ok(None)
    }

    /// A problem that is solved in turns with the normal one, with the effect's `_history` of earlier steps. None: the effect has no such problem.
    /// Friction has none here, because the solver itself holds the tangential problem. `tests/unit/foundation.rs` is an example.
    fn coupled<'s>(&'s self, _scene: &Plain<'_>, _history: &'s mut History) -> Result<Option<Box<dyn Coupled + 's>>> {
        Ok(None)
    }
}
