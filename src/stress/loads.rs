//! The loads on the surface of a body.

use super::body::Loaded;
use crate::effects::Effect;
use crate::error::{finite, invalid, Result};
use crate::grid::{check_values, Grid};
use crate::memory::collected;
use crate::scene::Patches;

/// Pressures and tractions, `[my][mx]`, each optional. Tractions act on the body considered, in the directions of x and y.
#[derive(Clone, Copy, Debug, Default)]
pub struct Loads<'a> {
    /// p: positive presses.
    pub pressure: Option<&'a [f64]>,
    /// qx.
    pub traction_x: Option<&'a [f64]>,
    /// qy.
    pub traction_y: Option<&'a [f64]>,
    /// Contact patches: below an element of one patch, the loads of another count times the factor between both.
    pub patches: Option<Patches<'a>>,
}

/// Elements stressed by the same loads: those of a patch, or all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// All elements, with unscaled loads.
    All,
    /// The elements of a patch.
    Patch(usize),
}

impl<'a> Loads<'a> {
    /// Pressures alone.
    pub fn pressure(pressure: &'a [f64]) -> Loads<'a> {
        Loads { pressure: Some(pressure), ..Loads::default() }
    }

    /// Pressure and both tractions.
    pub(super) fn list(&self) -> [Option<&'a [f64]>; 3] {
        [self.pressure, self.traction_x, self.traction_y]
    }

    pub(super) fn loaded(&self) -> Loaded {
        self.list().map(|load| load.is_some())
    }

    /// The parts of the grid with separate loads.
    pub(super) fn parts(&self) -> Vec<Part> {
        let Some(patches) = self.coupled() else { return vec![Part::All] };
        let has = |patch: &usize| (0..patches.patch.len()).any(|i| patches.of(i) == *patch);
        (0..patches.count).filter(has).map(Part::Patch).collect()
    }

    /// The patches, unless all factors are 1.
    pub(super) fn coupled(&self) -> Option<&Patches<'a>> {
        self.patches.as_ref().filter(|patches| patches.factors.iter().any(|factor| *factor != 1.0))
    }

    /// The loads on a part: each load times the factor of its patch.
    pub(super) fn on(&self, part: Part, load: &[f64]) -> Result<Vec<f64>> {
        let factor = |i: usize| match (self.coupled(), part) {
            (Some(patches), Part::Patch(patch)) => patches.factor(patch, i),
            _ => 1.0,
        };
        Ok(collected(load.iter().enumerate().map(|(i, load)| factor(i) * load), "the loads of a patch")?)
    }

    pub(super) fn check(&self, grid: &Grid) -> Result<()> {
        for (name, load) in ["pressure", "traction_x", "traction_y"].into_iter().zip(self.list()) {
            let Some(load) = load else { continue };
            check_values(name, load, grid, finite)?;
        }
        if let Some(patches) = &self.patches {
            Effect::check(patches, grid)?;
        }
        match self.loaded().contains(&true) {
            true => Ok(()),
            false => invalid("there is neither a pressure nor a traction; give at least one of them".into()),
        }
    }

    /// A power of two near the largest load: stresses of loads of about 1 neither overflow nor underflow.
    pub(super) fn scale(&self) -> f64 {
        let values = self.list().into_iter().flatten().flatten();
        let largest = values.fold(0.0, |largest: f64, value| largest.max(value.abs()));
        if largest == 0.0 {
            return 1.0;
        }
        largest.log2().floor().clamp(-1000.0, 1000.0).exp2()
    }
}
