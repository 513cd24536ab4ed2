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
    /// One per element, whole.
    Integers(&'a [i32]),
    /// Many, which the coefficients hold, too.
    Shared(&'a Arc<Held>),
}

/// An effect. What other places ask has no default ([`Properties`]); what an effect does has one: nothing.
pub trait Effect {
    /// As it is called in a scene.
    fn name(&self) -> &'static str;

    /// The effects it goes with, and the quantities it changes.
    fn properties(&self) -> Properties<'_>;

    /// Refuses what is none.
    fn check(&self, grid: &Grid) -> Result<()>;

    /// Tells each value that a set-up depends on, with its name. What is not told may be another one for each solve.
    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>));

    /// Whether surfaces approach each other beyond their mean distance, though a uniform pressure does not move the bodies: in a scene that
    /// repeats itself in both directions. By a uniform pressure something is compressed, or pressures are held.
    fn gives_way(&self, scene: &Plain<'_>) -> bool;

    /// The stresses below the surface of body 1 (`b` is 0) or 2 with it.
    fn stresses(&self, b: usize, scene: &Plain<'_>) -> Stresses<'_>;

    /// Whether a scene has to know of it.
    fn is_one(&self, _scene: &Plain<'_>) -> bool {
        true
    }

    /// Refuses a load that it cannot carry beside the other effects; asked for each solve.
    fn check_load(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>]) -> Result<()> {
        Ok(())
    }

    /// Refuses a load that no pressures carry beside the other effects, on any contact area or on the one that is given; asked for each solve.
    fn check_area(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>], _given: Option<&[bool]>) -> Result<()> {
        Ok(())
    }

    /// The materials at the surfaces of the bodies, where it covers them; none: the bodies' own.
    fn at_surface(&self, _scene: &Plain<'_>) -> Option<Bodies> {
        None
    }

    /// Refuses tractions whose coefficients are the library's, where it has none, or where they would change the pressures.
    fn check_tractions(&self, _scene: &Plain<'_>) -> Result<()> {
        Ok(())
    }

    /// Its own kernel, in place of the half-space's; others may have a say in it.
    fn kernel(&self, _scene: &Plain<'_>, _others: &[Option<&dyn Effect>]) -> Result<Option<Arc<dyn Kernel>>> {
        Ok(None)
    }

    /// Its change of the coefficients of the kernel.
    fn apply(&self, coefficients: Coefficients) -> Result<Coefficients> {
        Ok(coefficients)
    }

    /// The undeformed distance that it makes of `h`; none: the same.
    fn surface(&self, _h: &[f64]) -> Result<Option<Vec<f64>>> {
        Ok(None)
    }

    /// The memory of bodies that remember the steps before, `history`, in a step of this one.
    fn memory(
        &self,
        _scene: &Plain<'_>,
        _others: &[Option<&dyn Effect>],
        _history: &mut History,
    ) -> Result<Option<Box<dyn Memory>>> {
        Ok(None)
    }

    /// The problem that is solved in turns with the normal one; `history` is left by the last step.
    fn coupled<'s>(&'s self, _scene: &Plain<'_>, _history: &'s mut History) -> Result<Option<Box<dyn Coupled + 's>>> {
        Ok(None)
    }
}
