//! Coated bodies in a scene that repeats itself in both directions.
//!
//! The half-space of the layer's material has its coefficients of [`Periodic`]. To them comes, per wave k of the grid and its aliases,
//! `2 pi c (B(k t) - 1)/k sinc(kx dx/2) sinc(ky dy/2)`, which fades as `exp(-2 k t)`. The mean displacement is zero, as without a coating.

use std::f64::consts::PI;
use std::sync::Arc;

use super::{CoatedBody, HalfSpace, Kernel};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::influence::Periodic;
use crate::memory::zeros;

/// `exp(-2 k t) (k t)^2` is below 1e-15 there.
const FADED: f64 = 20.0;
/// Elements that are longer, in thicknesses, have too many aliases.
const LONGEST: f64 = 16.0;

/// Coefficients of a period.
#[derive(Clone, Debug)]
pub struct CoatedPeriodic {
    bodies: [CoatedBody; 2],
    half_space: Periodic,
    /// The correction at offsets up to half the period, `[ky][kx]`.
    table: Arc<Vec<f64>>,
    mx: usize,
    my: usize,
}

impl CoatedPeriodic {
    /// The coefficients of a grid, which is one period in both directions.
    pub fn new(bodies: [CoatedBody; 2], grid: &Grid) -> Result<CoatedPeriodic> {
        let compliance: f64 = bodies.iter().map(|body| PI * body.compliance).sum();
        let half_space = Periodic::new(HalfSpace::new(grid.dx, grid.dy, compliance), (true, true), grid)?;
        CoatedPeriodic::with_half_space(bodies, half_space, grid)
    }

    fn with_half_space(bodies: [CoatedBody; 2], half_space: Periodic, grid: &Grid) -> Result<CoatedPeriodic> {
        let (row, rows) = (grid.mx / 2 + 1, grid.my / 2 + 1);
        let what = "the coefficients of a coating";
        let (mut waves, mut in_x): (Vec<f64>, Vec<f64>) = (zeros(row * rows, what)?, zeros(row * rows, what)?);
        let mut table = zeros(row * rows, what)?;
        for body in &bodies {
            if let Some((t, _)) = &body.layer {
                check(*t, grid)?;
                add_waves(body, *t, grid, &mut waves);
            }
        }
        // Cosines in x, then in y; bins k and m - k are one.
        for (waves, out) in waves.chunks_exact(row).zip(in_x.chunks_exact_mut(row)) {
            let terms = |kx: usize| waves.iter().enumerate().map(move |(i, wave)| wave * cosine(i, kx, grid.mx));
            out.iter_mut().enumerate().for_each(|(kx, value)| *value = terms(kx).sum());
        }
        for (ky, out) in table.chunks_exact_mut(row).enumerate() {
            for (j, in_x) in in_x.chunks_exact(row).enumerate() {
                let factor = cosine(j, ky, grid.my) / grid.len() as f64;
                out.iter_mut().zip(in_x).for_each(|(value, wave)| *value += factor * wave);
            }
        }
        Ok(CoatedPeriodic { bodies, half_space, table: Arc::new(table), mx: grid.mx, my: grid.my })
    }
}

/// Refuses coatings with too many aliases.
fn check(t: f64, grid: &Grid) -> Result<()> {
    if t * LONGEST < grid.dx.max(grid.dy) {
        return Err(Error::Unsupported(format!(
            "a coating has thickness {t} on elements {} x {}; with a period it must be at least 1/{LONGEST} of the longer side: name a \
             layer instead, which thin coatings are",
            grid.dx, grid.dy
        )));
    }
    Ok(())
}

/// `cos(2 pi i k/m)` times the number of bins that i stands for.
fn cosine(i: usize, k: usize, m: usize) -> f64 {
    let count = if i == 0 || 2 * i == m { 1.0 } else { 2.0 };
    count * (2.0 * PI * ((i * k) % m) as f64 / m as f64).cos()
}

/// Adds what waves meet, `[bin in y][bin in x]`.
fn add_waves(body: &CoatedBody, t: f64, grid: &Grid, waves: &mut [f64]) {
    let Some((_, radial)) = &body.layer else { return };
    let Grid { mx, my, dx, dy } = *grid;
    let row = mx / 2 + 1;
    let last = |d: f64| (FADED * d / (2.0 * PI * t)).ceil() as i64 + 1;
    let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
    for (bin, wave) in waves.iter_mut().enumerate() {
        let number = |i: usize, m: usize, alias: i64, d: f64| 2.0 * PI * (i as f64 / m as f64 + alias as f64) / d;
        for a in -last(dx)..=last(dx) {
            let kx = number(bin % row, mx, a, dx);
            for b in -last(dy)..=last(dy) {
                let ky = number(bin / row, my, b, dy);
                let k = kx.hypot(ky);
                if k > 0.0 && k * t <= FADED {
                    let change = 2.0 * PI * body.compliance / k * radial.transfer.less_one(k * t);
                    *wave += change * sinc(0.5 * kx * dx) * sinc(0.5 * ky * dy);
                }
            }
        }
    }
}

impl Kernel for CoatedPeriodic {
    fn at(&self, kx: i64, ky: i64) -> f64 {
        let folded = |k: i64, m: usize| {
            let k = k.unsigned_abs() as usize % m;
            k.min(m - k)
        };
        self.half_space.at(kx, ky) + self.table[folded(ky, self.my) * (self.mx / 2 + 1) + folded(kx, self.mx)]
    }

    fn repeats(&self, grid: &Grid) -> (bool, bool) {
        self.half_space.repeats(grid)
    }

    fn constant_for(&self, response: f64) -> f64 {
        self.half_space.constant_for(response)
    }

    fn constant_for_inverse(&self) -> f64 {
        self.half_space.constant_for_inverse()
    }

    fn coarsen(&self, _fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>> {
        Ok(Arc::new(CoatedPeriodic::new(self.bodies.clone(), coarse)?))
    }

    fn bytes(&self) -> usize {
        self.half_space.bytes() + size_of_val(&self.table[..])
    }
}
