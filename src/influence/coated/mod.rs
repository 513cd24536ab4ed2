//! Influence coefficients of bodies with a coating: a bonded elastic layer of thickness t on a half-space, the substrate.
//!
//! ```text
//! A(X, Y) = sum over bodies of c_b [b L(X, Y) + (1/t) integral over the element of F_b(r/t) dA],   c_b = (1 - nu1)/(2 pi G1)
//! ```
//!
//! L is the integral of 1/r over an element ([`HalfSpace`]). The base b L has the coefficients of a half-space: at distances below t that of the
//! layer's material, b = 1, and beyond that of the substrate, b = B0. F_b is the radial correction to the base ([`Radial`]). With the same base
//! at all distances, either digits would cancel or the integrand would have a singularity. A body without a coating has b = 1 and no correction.

mod base;
mod cache;
mod hankel;
mod layer;
mod offsets;
mod periodic;
mod polynomial;
mod quadrature;
mod radial;
mod response;
mod shear;
mod tensor;
mod tractions;
mod transfer;
mod waves;

use std::f64::consts::PI;
use std::sync::Arc;

pub use base::Base;
use offsets::{first_of_half, first_of_substrate, COATED};
pub use periodic::CoatedPeriodic;
pub use radial::Radial;
pub use response::Response;
pub use shear::{Across, Along};
pub use tractions::Coat;
pub use transfer::Transfer;

use super::gauss::rule;
use super::kernel::Kernel;
use super::HalfSpace;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;
use cache::Cache;
use layer::LayerCorrection;

/// One body, with or without a coating.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedBody {
    /// `(1 - nu)/(2 pi G)` of the material at the surface.
    pub compliance: f64,
    /// The thickness of the coating, and its radial functions. `None`: there is no coating.
    pub layer: Option<(f64, Arc<Radial>)>,
}

/// The radial functions of the last materials.
static CACHE: Cache<Radial> = Cache::new();

/// The radial functions of a layer whose shear modulus is `mu` times the substrate's, with the Poisson ratios of layer and substrate. They are
/// computed once for each set of materials, as long as the cache keeps them.
pub fn radial(mu: f64, [nu1, nu2]: [f64; 2]) -> Arc<Radial> {
    CACHE.get([mu, nu1, nu2], || Radial::new(Transfer::new(mu, [nu1, nu2])))
}

/// The influence coefficients of two bodies, of which at least one has a coating, on the offsets of one grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Coated {
    bodies: [CoatedBody; 2],
    half_space: HalfSpace,
    /// The number of elements in x.
    mx: usize,
    /// The coefficients `[ky][kx]` at offsets >= 0.
    table: Arc<Vec<f64>>,
}

impl Coated {
    /// Computes the coefficients of a grid.
    pub fn new(bodies: [CoatedBody; 2], grid: &Grid) -> Result<Coated> {
        // With the compliance 1/(pi E*) = 1 coefficients are integrals of 1/r.
        Coated::with_half_space(bodies, HalfSpace::new(grid.dx, grid.dy, PI), grid)
    }

    fn with_half_space(bodies: [CoatedBody; 2], half_space: HalfSpace, grid: &Grid) -> Result<Coated> {
        let mut table = zeros(grid.len(), COATED)?;
        for (ky, row) in table.chunks_exact_mut(grid.mx).enumerate() {
            let first = first_of_half(grid, ky);
            half_space.fill_row(first as i64, ky as i64, &mut row[first..]);
            let [one, two] = bodies.each_ref().map(|body| body.first_of_substrate(grid, ky));
            // The base of each body changes at the distance of its thickness. Between these places one factor holds.
            let ends = [first, one.min(two).max(first), one.max(two).max(first), row.len()];
            for ends in ends.windows(2) {
                let factor: f64 =
                    bodies.iter().map(|body| body.base(ends[0] >= body.first_of_substrate(grid, ky))).sum();
                row[ends[0]..ends[1]].iter_mut().for_each(|value| *value *= factor);
            }
        }
        for body in &bodies {
            if let Some((thickness, radial)) = &body.layer {
                let layer = LayerCorrection { radial, t: *thickness, grid: *grid, half_space: &half_space };
                layer.add(body.compliance, &mut table)?;
            }
        }
        mirror(grid, &mut table);
        Ok(Coated { bodies, half_space, mx: grid.mx, table: Arc::new(table) })
    }
}

/// Copies the coefficients at kx < ky from those at kx > ky, which are the same for square elements. The rows are taken in groups, because their
/// values share cache lines.
fn mirror(grid: &Grid, table: &mut [f64]) {
    const ROWS: usize = 8;
    let Grid { mx, my, .. } = *grid;
    for rows in (0..my).step_by(ROWS).map(|first| first..my.min(first + ROWS)) {
        for kx in 0..first_of_half(grid, rows.end - 1) {
            for ky in rows.start.max(kx + 1)..rows.end {
                table[ky * mx + kx] = table[kx * mx + ky];
            }
        }
    }
}

impl CoatedBody {
    /// `c B(k t)` to three digits, for preconditioners.
    fn roughly(&self, k: f64) -> f64 {
        self.layer.as_ref().map_or(self.compliance, |(t, radial)| self.compliance * radial.roughly(k * t))
    }

    /// `c b`: with the base of the substrate, or with that of the layer.
    fn base(&self, of_substrate: bool) -> f64 {
        match &self.layer {
            Some((_, radial)) if of_substrate => self.compliance * radial.transfer.substrate,
            _ => self.compliance,
        }
    }

    /// The first offset in row ky at which the substrate is the base; the end of the row if there is none.
    fn first_of_substrate(&self, grid: &Grid, ky: usize) -> usize {
        self.layer.as_ref().map_or(grid.mx, |(t, _)| first_of_substrate(*t, grid, ky))
    }

    /// The displacement by a uniform pressure of 1 without lateral strain: the compression of the layer.
    fn of_mean(&self) -> f64 {
        self.layer.as_ref().map_or(0.0, |(t, radial)| 2.0 * PI * self.compliance * t * radial.transfer.of_mean)
    }

    /// The displacement by a pressure wave of amplitude 1 and wave number k: `2 pi c/k B(k t)`.
    pub fn of_wave(&self, k: f64) -> f64 {
        let layer = self.layer.as_ref().map_or(1.0, |(t, radial)| radial.transfer.at(k * t));
        2.0 * PI * self.compliance / k * layer
    }
}

impl Kernel for Coated {
    fn at(&self, kx: i64, ky: i64) -> f64 {
        let (x, y) = (kx.unsigned_abs() as usize, ky.unsigned_abs() as usize);
        match x < self.mx && y < self.table.len() / self.mx {
            true => self.table[y * self.mx + x],
            // The offset lies beyond the table.
            false => self.beyond(x, y),
        }
    }

    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        let (x, y, n) = (kx as usize, ky.unsigned_abs() as usize, out.len());
        if kx >= 0 && x + n <= self.mx && y < self.table.len() / self.mx {
            return out.copy_from_slice(&self.table[y * self.mx + x..][..n]);
        }
        out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = self.at(kx, ky));
    }

    // The sum contains the two largest aliases in each direction, k and k - 2 pi/d. Both have the same |sin(k d/2)|.
    fn wave(&self, grid: &Grid, kx: f64, ky: f64) -> Option<f64> {
        let aliases = |k: f64, d: f64| {
            let half = 0.5 * k * d;
            let sine = half.sin();
            let mean = if half == 0.0 { 1.0 } else { sine / half };
            [(k, mean), (k - 2.0 * PI / d, -sine / (half - PI))]
        };
        let mut sum = 0.0;
        let in_y = aliases(ky, grid.dy);
        for (kx, mean_x) in aliases(kx, grid.dx) {
            for (ky, mean_y) in in_y {
                let k = (kx * kx + ky * ky).sqrt();
                sum += mean_x * mean_y / k * self.bodies.iter().map(|body| body.roughly(k)).sum::<f64>();
            }
        }
        Some(2.0 * PI * sum)
    }

    fn coarsen(&self, _fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>> {
        let half_space = self.half_space.for_element(coarse.dx, coarse.dy);
        Ok(Arc::new(Coated::with_half_space(self.bodies.clone(), half_space, coarse)?))
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.table[..])
    }
}

impl Coated {
    /// Computes the coefficient at an offset beyond the table.
    fn beyond(&self, kx: usize, ky: usize) -> f64 {
        let (dx, dy) = (self.half_space.dx, self.half_space.dy);
        let (x, y) = (kx as f64 * dx, ky as f64 * dy);
        let grid = Grid { mx: kx + 1, my: ky + 1, dx, dy };
        let is_far = |body: &CoatedBody| kx >= body.first_of_substrate(&grid, ky);
        let base: f64 = self.bodies.iter().map(|body| body.base(is_far(body))).sum();
        let mut sum = self.half_space.at(kx as i64, ky as i64) * base;
        for body in &self.bodies {
            if let Some((t, radial)) = &body.layer {
                let layer = LayerCorrection { radial, t: *t, grid, half_space: &self.half_space };
                let base = if is_far(body) { Base::Substrate } else { Base::Layer };
                sum += body.compliance * layer.gauss(rule(5), (x, y), base);
            }
        }
        sum
    }
}
