//! Influence coefficients of coated bodies in a scene with two periods.
//!
//! The half-space of the layer's material has the coefficients of [`Periodic`]. What the coating adds to them is a sum over
//! [`waves`](super::waves).
//!
//! *The mean.* As without a coating, the mean displacement of the half-spaces is zero. In addition, a uniform pressure p compresses the layer by
//! `p t/M`, without lateral strain, with the oedometric modulus `M = 2 G (1 - nu)/(1 - 2 nu)`. This compression is a constant in all coefficients
//! ([`Kernel::constant`]).
//!
//! *Coarser grids.* If the elements of a coarser grid are too long for sums over waves, the coefficients come from the finer grid: the mean
//! displacement of four fine elements by a pressure on four.

use std::f64::consts::PI;
use std::sync::Arc;

use super::offsets::COATED;
use super::{waves, CoatedBody, HalfSpace, Kernel};
use crate::error::{Error, Number, Result};
use crate::grid::Grid;
use crate::influence::Periodic;
use crate::memory::zeros;

/// The longest element, in thicknesses. For longer elements the sums have too many aliases.
const LONGEST: f64 = 16.0;
/// The longest element of a coarser grid, in thicknesses. For longer ones, means over the finer grid are cheaper.
const LONGEST_COARSE: f64 = 4.0;

/// The influence coefficients of two coated bodies on a grid that is one period in both directions.
#[derive(Clone, Debug)]
pub struct CoatedPeriodic {
    /// The bodies, and the coefficients of the half-spaces of the layers' materials, from which coarser grids follow. `None` if the coefficients
    /// are means over a finer grid.
    sums: Option<([CoatedBody; 2], Periodic)>,
    /// The coefficients without their constant, at offsets up to half the period, `[ky][kx]`.
    table: Arc<Vec<f64>>,
    /// The numbers of elements of the grid in x and in y.
    mx: usize,
    my: usize,
    /// The displacement by a uniform pressure of 1.
    mean: f64,
    /// Whether the coefficients contain the constant of this displacement.
    has_mean: bool,
    /// The approximate displacement by the longest pressure wave of amplitude 1.
    longest: f64,
}

impl CoatedPeriodic {
    /// Computes the coefficients of a grid, which is one period in both directions. Refuses coatings that are too thin for sums over waves.
    pub fn new(bodies: [CoatedBody; 2], grid: &Grid) -> Result<CoatedPeriodic> {
        bodies.iter().try_for_each(|body| check(body, grid))?;
        let compliance: f64 = bodies.iter().map(|body| PI * body.compliance).sum();
        let half_space = Periodic::new(HalfSpace::new(grid.dx, grid.dy, compliance), (true, true), grid)?;
        CoatedPeriodic::with_half_space(bodies, half_space, grid)
    }

    /// Adds the sums over waves to the coefficients of the half-space.
    fn with_half_space(bodies: [CoatedBody; 2], half_space: Periodic, grid: &Grid) -> Result<CoatedPeriodic> {
        let (row, rows) = grid.offsets((true, true));
        let mut changes: Vec<f64> = zeros(row * rows, COATED)?;
        bodies.iter().try_for_each(|body| waves::add(body, grid, &mut changes))?;
        let mut table = waves::coefficients(&changes, grid)?;
        for (ky, row) in table.chunks_exact_mut(row).enumerate() {
            row.iter_mut().zip(0..).for_each(|(value, kx)| *value += half_space.at(kx, ky as i64));
        }
        let mean: f64 = bodies.iter().map(CoatedBody::of_mean).sum();
        let (table, longest) = (Arc::new(table), half_space.constant_for_inverse() * grid.len() as f64);
        let Grid { mx, my, .. } = *grid;
        Ok(CoatedPeriodic { sums: Some((bodies, half_space)), table, mx, my, mean, has_mean: mean != 0.0, longest })
    }

    /// The coefficients of a coarser grid as means over the elements of this one.
    fn joined(&self, coarse: &Grid) -> Result<CoatedPeriodic> {
        let (row, rows) = coarse.offsets((true, true));
        let parts = |m: usize, fine: usize, k: i64| match m < fine {
            true => [(2 * k, 1.0), (2 * k - 1, 0.5), (2 * k + 1, 0.5)],
            false => [(k, 1.0), (k, 0.0), (k, 0.0)],
        };
        let mut table: Vec<f64> = zeros(row * rows, COATED)?;
        for (ky, out) in (0..).zip(table.chunks_exact_mut(row)) {
            for (kx, value) in (0..).zip(out) {
                for (y, in_y) in parts(coarse.my, self.my, ky) {
                    *value += parts(coarse.mx, self.mx, kx)
                        .map(|(x, in_x)| in_x * in_y * self.without_mean(x, y))
                        .iter()
                        .sum::<f64>();
                }
            }
        }
        Periodic::remove_mean(&mut table, coarse);
        Ok(CoatedPeriodic { sums: None, table: Arc::new(table), mx: coarse.mx, my: coarse.my, ..self.clone() })
    }

    /// The coefficient at an offset, without the constant.
    fn without_mean(&self, kx: i64, ky: i64) -> f64 {
        self.table[Periodic::folded(ky, self.my) * (self.mx / 2 + 1) + Periodic::folded(kx, self.mx)]
    }

    /// The constant in all coefficients with which a uniform pressure of 1 has this response.
    fn constant_of(&self, response: f64) -> f64 {
        response / (self.mx as f64 * self.my as f64)
    }
}

/// Refuses a coating that is thinner than 1/[`LONGEST`] of the longer side of an element.
fn check(body: &CoatedBody, grid: &Grid) -> Result<()> {
    match &body.layer {
        Some((t, _)) if t * LONGEST < grid.dx.max(grid.dy) => Err(Error::Unsupported(format!(
            "a coating has thickness {} on elements {} x {}; with a period it must be at least 1/{LONGEST} of the longer side: name a \
             layer instead, which thin coatings are",
            Number(*t),
            Number(grid.dx),
            Number(grid.dy)
        ))),
        _ => Ok(()),
    }
}

impl Kernel for CoatedPeriodic {
    fn at(&self, kx: i64, ky: i64) -> f64 {
        self.without_mean(kx, ky) + self.constant()
    }

    fn repeats(&self, grid: &Grid) -> (bool, bool) {
        (grid.mx == self.mx, grid.my == self.my)
    }

    fn constant(&self) -> f64 {
        if self.has_mean {
            self.constant_of(self.mean)
        } else {
            0.0
        }
    }

    fn without_constant(&self) -> Option<Arc<dyn Kernel>> {
        self.has_mean.then(|| Arc::new(CoatedPeriodic { has_mean: false, ..self.clone() }) as Arc<dyn Kernel>)
    }

    fn is_mean_free(&self) -> bool {
        !self.has_mean
    }

    fn constant_for(&self, response: f64) -> f64 {
        self.constant_of(response)
    }

    // A uniform pressure gets at least the response of the longest wave, because a contact area couples the mean with waves.
    fn constant_for_inverse(&self) -> f64 {
        (self.constant_of(self.longest) - self.constant()).max(0.0)
    }

    fn coarsen(&self, _fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>> {
        let is_thin =
            |body: &CoatedBody| body.layer.as_ref().is_some_and(|(t, _)| t * LONGEST_COARSE < coarse.dx.max(coarse.dy));
        let mut kernel = match &self.sums {
            Some((bodies, half_space)) if !bodies.iter().any(is_thin) => {
                let half_space = half_space.coarsened(coarse)?;
                CoatedPeriodic::with_half_space(bodies.clone(), half_space, coarse)?
            }
            _ => self.joined(coarse)?,
        };
        kernel.has_mean = self.has_mean;
        Ok(Arc::new(kernel))
    }

    fn bytes(&self) -> usize {
        self.sums.as_ref().map_or(0, |(_, half_space)| half_space.bytes()) + size_of_val(&self.table[..])
    }
}
