//! The loads on the surface of a half-space.

use super::body::Loaded;
use crate::effects::Patches;
use crate::effects::{Effect, NO_PATCH};
use crate::error::{finite, invalid, require, Result};
use crate::grid::{check_values, Grid};
use crate::memory::collected;

/// The bound on loads, below which stresses are finite. The stresses by a load of 1 are below 2^11, since they grow with a logarithm towards
/// edges.
const LARGEST: f64 = 1e304;

/// The pressures and tractions on the elements, `[my][mx]`, each optional. Tractions are those that act on the body considered, in the directions
/// of x and y.
#[derive(Clone, Copy, Debug, Default)]
pub struct Loads<'a> {
    /// The pressure p, positive in compression.
    pub pressure: Option<&'a [f64]>,
    /// The traction qx in x.
    pub traction_x: Option<&'a [f64]>,
    /// The traction qy in y.
    pub traction_y: Option<&'a [f64]>,
    /// The contact patches. In the stresses below an element of one patch, the loads on another patch are multiplied by the factor between the
    /// two patches. Elements that belong to no patch are stressed by all loads in full.
    pub patches: Option<Patches<'a>>,
}

/// A set of elements below which the same loads count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The elements below which all loads count in full: those of no patch, or all elements if patches are not coupled by factors.
    All,
    /// The elements of the patch with this number.
    Patch(usize),
}

impl Part {
    /// The part to which element i belongs.
    pub(super) fn of(patches: &Patches<'_>, i: usize) -> Part {
        match patches.patch[i] {
            NO_PATCH => Part::All,
            _ => Part::Patch(patches.of(i)),
        }
    }
}

impl<'a> Loads<'a> {
    /// A pressure without tractions.
    pub fn pressure(pressure: &'a [f64]) -> Loads<'a> {
        Loads { pressure: Some(pressure), ..Loads::default() }
    }

    /// The pressure and both tractions, in this order.
    pub(super) fn list(&self) -> [Option<&'a [f64]>; 3] {
        [self.pressure, self.traction_x, self.traction_y]
    }

    /// Whether each load is given.
    pub(super) fn loaded(&self) -> Loaded {
        self.list().map(|load| load.is_some())
    }

    /// The parts of the grid that have elements.
    pub(super) fn parts(&self) -> Vec<Part> {
        let Some(patches) = self.coupled() else { return vec![Part::All] };
        let has = |part: &Part| (0..patches.patch.len()).any(|i| Part::of(patches, i) == *part);
        [Part::All].into_iter().chain((0..patches.count).map(Part::Patch)).filter(has).collect()
    }

    /// Tells whether the stresses below element i count for the largest ones. With coupled patches, only those below elements of patches count.
    pub fn counted(&self) -> impl Fn(usize) -> bool + '_ {
        let patches = self.coupled();
        move |i| patches.is_none_or(|patches| Part::of(patches, i) != Part::All)
    }

    /// The factor of the load on element j for the stresses below a part.
    pub(super) fn factors(&self, part: Part) -> impl Fn(usize) -> f64 + '_ {
        let patches = self.coupled();
        move |j| match (patches, part) {
            (Some(patches), Part::Patch(patch)) if patches.patch[j] != NO_PATCH => patches.factor(patch, j),
            _ => 1.0,
        }
    }

    /// The patches; `None` if there are none or all factors are 1.
    pub(super) fn coupled(&self) -> Option<&Patches<'a>> {
        self.patches.as_ref().filter(|patches| patches.factors.iter().any(|factor| *factor != 1.0))
    }

    /// The loads for the stresses below a part: each times its factor.
    pub(super) fn on(&self, part: Part, load: &[f64]) -> Result<Vec<f64>> {
        let factor = self.factors(part);
        Ok(collected(load.iter().enumerate().map(|(i, load)| factor(i) * load), "the loads of a patch")?)
    }

    /// Refuses loads of another size than the grid, loads that are not finite or too large, invalid patches, and a call without loads.
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

    /// A power of two near the largest load. The loads are divided by it, so that stresses neither overflow nor underflow.
    pub(super) fn scale(&self) -> f64 {
        let values = self.list().into_iter().flatten().flatten();
        let largest = values.fold(0.0, |largest: f64, value| largest.max(value.abs()));
        if largest == 0.0 {
            return 1.0;
        }
        largest.log2().floor().clamp(-1000.0, 1000.0).exp2()
    }
}
