//! The part of a scene that every effect may read: grid, distance, bodies and load.

use super::{Bodies, Load};
use crate::blocks;
use crate::error::{invalid, Error, Number, Result};
use crate::grid::Grid;
use crate::sums::{least, lesser};
use crate::threads::Threads;

/// A scene without its effects.
#[derive(Clone, Copy, Debug)]
pub struct Plain<'a> {
    /// The potential contact area.
    pub grid: Grid,
    /// h, `[my][mx]`. An element with `+infinity` has no surface and is never in contact.
    pub undeformed_distance: &'a [f64],
    /// Elasticity of the two bodies.
    pub bodies: Bodies,
    /// Prescribed approach or prescribed force.
    pub load: Load,
}

impl Plain<'_> {
    /// Refuses an invalid grid, and distances that are NaN or -infinity. Returns the least distance, which is infinite if no element has a surface.
    pub fn check_distance(&self, threads: &Threads) -> Result<f64> {
        self.grid.check()?;
        let (h, n) = (self.undeformed_distance, self.grid.len());
        if h.len() != n {
            return invalid(format!("undeformed_distance has {} values; the grid has {n} elements", h.len()));
        }
        // The comparison is false for NaN.
        let is_number = |v: &f64| *v > f64::NEG_INFINITY;
        let (lowest, all) = blocks::fold(
            &self.grid,
            threads,
            (f64::INFINITY, true),
            #[inline(always)]
            |block| {
                // No early exit and a mask instead of a branch, so that the compiler vectorises the loop.
                let h = &h[block];
                let all = h.iter().fold(!0, |all: u64, v| all & u64::from(is_number(v)).wrapping_neg());
                (least(h), all != 0)
            },
            |(lowest, all), (of_block, all_of_block)| (lesser(of_block, lowest), all & all_of_block),
        );
        match (!all).then(|| h.iter().position(|v| !is_number(v))).flatten() {
            Some(i) => Err(Error::NotFinite(format!(
                "undeformed_distance of {} is {}; it must be a number, or +infinity where there is no surface",
                self.grid.element(i),
                h[i]
            ))),
            None => Ok(lowest),
        }
    }

    /// Refuses a positive force if no element has a surface: the `lowest` distance is infinite.
    pub fn check_surface(&self, lowest: f64) -> Result<()> {
        match self.load {
            Load::Force(force) if force > 0.0 && lowest.is_infinite() => Err(Error::Infeasible(format!(
                "force is {}, but undeformed_distance is infinite on every element: nothing can carry it",
                Number(force)
            ))),
            _ => Ok(()),
        }
    }
}
