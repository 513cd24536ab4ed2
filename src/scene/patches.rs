//! Effect: several contact patches on one grid, whose interaction is scaled. See [`influence::Patches`](crate::influence::Patches).

use crate::error::{invalid, require, Result};
use crate::grid::Grid;
use crate::influence::{self, Influence};

/// Patches at most: each costs a product.
const MOST: usize = 64;

/// The patch of each element, and the factors between patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patches<'a> {
    /// Number of patches.
    pub count: usize,
    /// Of each element, `[my][mx]`: 0 to count - 1.
    pub patch: &'a [i32],
    /// `[count][count]`, symmetric, 1 on the diagonal; 0: independent, 1: as if there were no patches.
    pub factors: &'a [f64],
}

impl Patches<'_> {
    /// Refuses what are no patches.
    pub(super) fn check(&self, grid: &Grid) -> Result<()> {
        let count = self.count;
        if !(1..=MOST).contains(&count) {
            return invalid(format!("patches->count is {count}; it must lie in 1..{MOST}"));
        }
        if self.patch.len() != grid.len() || self.factors.len() != count * count {
            return invalid(format!(
                "patches->patch has {} values and patches->factors {}; the grid has {} elements, and there are {count} patches",
                self.patch.len(),
                self.factors.len(),
                grid.len()
            ));
        }
        if let Some(i) = self.patch.iter().position(|patch| !(0..count as i32).contains(patch)) {
            return invalid(format!(
                "patches->patch of element ({}, {}) is {}; it must lie in 0..{}",
                i % grid.mx,
                i / grid.mx,
                self.patch[i],
                count - 1
            ));
        }
        for (k, &factor) in self.factors.iter().enumerate() {
            let (a, b) = (k / count, k % count);
            let name = format!("patches->factors of ({a}, {b})");
            require((0.0..=1.0).contains(&factor), &name, factor, "a factor must lie in [0, 1]")?;
            if a == b && factor != 1.0 {
                return invalid(format!("{name} is {factor}; within a patch it must be 1"));
            }
            let turned = self.factors[b * count + a];
            if b < a && factor != turned {
                return invalid(format!("{name} is {factor}, of ({b}, {a}) {turned}; factors must be symmetric"));
            }
        }
        Ok(())
    }

    /// The coefficients with these patches.
    pub(super) fn on(&self, base: Influence) -> Influence {
        let patch = self.patch.iter().map(|&patch| patch as u16);
        Influence::Patches(influence::Patches::new(base, self.count, patch, self.factors))
    }
}
