//! What an effect is to the rest of the library.

use std::sync::Arc;

use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::influence::{Coefficients, Kernel};
use crate::memory::Held;
use crate::scene::Plain;

/// A value of an effect.
#[derive(Clone, Copy, Debug)]
pub enum Value<'a> {
    /// A number, a count, or a switch (0 or 1).
    Number(f64),
    /// One per element.
    Array(&'a [f64]),
    /// One per element, whole.
    Integers(&'a [i32]),
    /// Many, which the coefficients hold, too.
    Shared(&'a Arc<Held>),
}

/// An effect. What is not said is that of one that changes nothing and goes with everything.
pub trait Effect {
    /// As it is called in a scene.
    fn name(&self) -> &'static str;

    /// Refuses what is none.
    fn check(&self, grid: &Grid) -> Result<()>;

    /// Refuses a load that it cannot carry beside the other effects; asked for each solve.
    fn check_load(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>]) -> Result<()> {
        Ok(())
    }

    /// Refuses a load that no pressures carry beside the other effects, on any contact area or on the one that is given; asked for each solve.
    fn check_area(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>], _given: Option<&[bool]>) -> Result<()> {
        Ok(())
    }

    /// The names of the effects that it is not solved with; one of a pair says so.
    fn excludes(&self) -> &'static [&'static str] {
        &[]
    }

    /// Whether the bodies of the scene do not matter: it has coefficients of its own.
    fn replaces_bodies(&self) -> bool {
        false
    }

    /// Whether surfaces approach each other beyond their mean distance, though a uniform pressure does not move the bodies: in a scene that
    /// repeats itself in both directions. By a uniform pressure something is compressed, or pressures are held.
    fn gives_way(&self, _scene: &Plain<'_>) -> bool {
        false
    }

    /// What MULTIGRID and FULL_MULTIGRID do not solve: there is no smoother, or there are no coarser grids.
    fn without_multigrid(&self) -> Option<&'static str> {
        None
    }

    /// In which directions it makes the scene repeat itself.
    fn repeats(&self) -> (bool, bool) {
        (false, false)
    }

    /// Its own kernel, in place of the half-space's; others may have a say in it.
    fn kernel(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>]) -> Result<Option<Arc<dyn Kernel>>> {
        Ok(None)
    }

    /// What it does to the coefficients of the kernel.
    fn apply(&self, coefficients: Coefficients) -> Result<Coefficients> {
        Ok(coefficients)
    }

    /// Tells each value that a set-up depends on, with its name.
    fn values(&self, _tell: &mut dyn FnMut(&'static str, Value<'_>)) {}
}

/// Checks one value per element; the message names the first one that `require` refuses.
pub(super) fn check_values(
    name: &str,
    values: &[f64],
    grid: &Grid,
    require: impl Fn(&str, f64) -> Result<()>,
) -> Result<()> {
    if values.len() != grid.len() {
        return invalid(format!("{name} has {} values; the grid has {} elements", values.len(), grid.len()));
    }
    match values.iter().position(|value| require(name, *value).is_err()) {
        Some(i) => require(&format!("{name} of {}", grid.element(i)), values[i]),
        None => Ok(()),
    }
}
