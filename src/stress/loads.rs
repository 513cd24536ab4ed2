//! The loads on the surface of a body.

use super::body::Loaded;
use crate::effects::Patches;
use crate::effects::{Effect, NO_PATCH};
use crate::error::{finite, invalid, require, Result};
use crate::grid::{check_values, Grid};
use crate::memory::collected;

/// Loads below this have finite stresses. Stresses by a load of 1 are below 2^11, since they grow with a logarithm towards edges.
const LARGEST: f64 = 1e304;

/// Pressures and tractions, `[my][mx]`, each optional. Tractions act on the body considered, in the directions of x and y.
#[derive(Clone, Copy, Debug, Default)]
pub struct Loads<'a> {
    /// p: positive presses.
    pub pressure: Option<&'a [f64]>,
    /// qx.
    pub traction_x: Option<&'a [f64]>,
    /// qy.
    pub traction_y: Option<&'a [f64]>,
    /// Contact patches: below an element of one patch, the loads of another count times the factor between both. Elements of no patch are stressed
    /// by all loads in full.
    pub patches: Option<Patches<'a>>,
}

/// Elements stressed by the same loads: those of a patch; all, or those of no patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Elements with unscaled loads.
    All,
    /// The elements of a patch.
    Patch(usize),
}

impl Part {
    /// The part of an element.
    pub(super) fn of(patches: &Patches<'_>, i: usize) -> Part {
        match patches.patch[i] {
            NO_PATCH => Part::All,
            _ => Part::Patch(patches.of(i)),
        }
    }
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
        let has = |part: &Part| (0..patches.patch.len()).any(|i| Part::of(patches, i) == *part);
        [Part::All].into_iter().chain((0..patches.count).map(Part::Patch)).filter(has).collect()
    }

    /// Whether the stresses below an element count for the largest ones. With patches, only those below an element of a patch count.
    pub fn counted(&self) -> impl Fn(usize) -> bool + '_ {
        let patches = self.coupled();
        move |i| patches.is_none_or(|patches| Part::of(patches, i) != Part::All)
    }

    /// The factors of the loads on elements below a part.
    pub(super) fn factors(&self, part: Part) -> impl Fn(usize) -> f64 + '_ {
        let patches = self.coupled();
        move |j| match (patches, part) {
            (Some(patches), Part::Patch(patch)) if patches.patch[j] != NO_PATCH => patches.factor(patch, j),
            _ => 1.0,
        }
    }

    /// The patches, unless all factors are 1.
    pub(super) fn coupled(&self) -> Option<&Patches<'a>> {
        self.patches.as_ref().filter(|patches| patches.factors.iter().any(|factor| *factor != 1.0))
    }

    /// The loads on a part: each load times the factor of its patch.
    pub(super) fn on(&self, part: Part, load: &[f64]) -> Result<Vec<f64>> {
        let factor = self.factors(part);
        Ok(collected(load.iter().enumerate().map(|(i, load)| factor(i) * load), "the loads of a patch")?)
    }

    pub(super) fn check(&self, grid: &Grid) -> Result<()> {
        for (name, load) in ["pressure", "traction_x", "traction_y"].into_iter().zip(self.list()) {
            let Some(load) = load else { continue };
            check_values(name, load, grid, |name, value| {
                finite(name, value)?;
                require(value.abs() < LARGEST, name, value, "loads must lie below 1e304: choose other units")
            })?;
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
