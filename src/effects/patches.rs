//! Effect: several contact patches on one grid. A factor scales the influence of the elements of one patch on those of another one. See
//! [`influence::Patches`](crate::influence::Patches).

use super::effect::{Effect, Value};
use super::properties::{Properties, Stresses};
use crate::error::{invalid, require, Number, Result};
use crate::grid::Grid;
use crate::influence::{self, Coefficients};
use crate::memory::collected;
use crate::scene::Plain;

/// The largest number of patches. Each patch adds one product by FFT.
pub const MOST_PATCHES: usize = 64;

/// The number of the patch of an element that belongs to no patch. Such an element has no surface and stays exterior.
pub const NO_PATCH: i32 = -1;

/// The patch of each element, and the factors of the influence between patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patches<'a> {
    /// Number of patches.
    pub count: usize,
    /// The patch of each element, `[my][mx]`: 0 to count - 1, or -1 for none.
    pub patch: &'a [i32],
    /// The factor between each pair of patches, in [0, 1]: `[count][count]`, symmetric, 1 on the diagonal. 0: the two patches do not influence each
    /// other; 1: their influence is unchanged.
    pub factors: &'a [f64],
}

impl Patches<'_> {
    /// The patch to which element i belongs in the coefficients. An element without a patch counts there as one of the first patch.
    pub fn of(&self, i: usize) -> usize {
        self.patch[i].max(0) as usize
    }

    /// The factor between `patch` and the patch of element i.
    pub fn factor(&self, patch: usize, i: usize) -> f64 {
        self.factors[patch * self.count + self.of(i)]
    }
}

impl Effect for Patches<'_> {
    fn name(&self) -> &'static str {
        "patches"
    }

    fn properties(&self) -> Properties<'_> {
        Properties {
            excludes: &["period"],
            without_multigrid: Some(self.name()),
            with_given_area: true,
            one_grid: None,
            own_coefficients: None,
            repeats: (false, false),
            limits: None,
            is_beside: false,
            continues: None,
        }
    }

    fn check(&self, grid: &Grid) -> Result<()> {
        let count = self.count;
        if !(1..=MOST_PATCHES).contains(&count) {
            return invalid(format!("patches->count is {count}; it must lie in 1..{MOST_PATCHES}"));
        }
        if self.patch.len() != grid.len() || self.factors.len() != count * count {
            return invalid(format!(
                "patches->patch has {} values and patches->factors {}; the grid has {} elements, and there are {count} patches",
                self.patch.len(),
                self.factors.len(),
                grid.len()
            ));
        }
        if let Some(i) = self.patch.iter().position(|patch| !(NO_PATCH..count as i32).contains(patch)) {
            let (element, patch) = (grid.element(i), self.patch[i]);
            return invalid(format!(
                "patches->patch of {element} is {patch}; it must lie in 0..{}, or be -1 for none",
                count - 1
            ));
        }
        for (k, &factor) in self.factors.iter().enumerate() {
            let (a, b) = (k / count, k % count);
            let name = format!("patches->factors of ({a}, {b})");
            require((0.0..=1.0).contains(&factor), &name, factor, "a factor must lie in [0, 1]")?;
            if a == b && factor != 1.0 {
                return invalid(format!("{name} is {}; within a patch it must be 1", Number(factor)));
            }
            let transposed = self.factors[b * count + a];
            if b < a && factor != transposed {
                return invalid(format!(
                    "{name} is {}, of ({b}, {a}) {}; factors must be symmetric",
                    Number(factor),
                    Number(transposed)
                ));
            }
        }
        Ok(())
    }

    fn apply(&self, coefficients: Coefficients) -> Result<Coefficients> {
        let patch = self.patch.iter().map(|&patch| patch.max(0) as u16);
        Ok(coefficients.with_patches(influence::Patches::new(self.count, patch, self.factors)?))
    }

    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>)) {
        tell("patches->count", Value::Number(self.count as f64));
        tell("patches->patch", Value::Integers(self.patch));
        tell("patches->factors", Value::Array(self.factors));
    }

    fn gives_way(&self, _scene: &Plain<'_>) -> bool {
        false
    }

    fn stresses(&self, _b: usize, _scene: &Plain<'_>) -> Stresses<'_> {
        let Patches { count, patch, factors } = *self;
        Stresses::Patches { count, patch, factors }
    }

    // Elements without a patch have no surface.
    fn surface(&self, h: &[f64]) -> Result<Option<Vec<f64>>> {
        if !self.patch.contains(&NO_PATCH) {
            return Ok(None);
        }
        let distance = |(h, patch): (&f64, &i32)| if *patch == NO_PATCH { f64::INFINITY } else { *h };
        Ok(Some(collected(h.iter().zip(self.patch).map(distance), "the undeformed distance of patches")?))
    }
}
