//! Coefficients of a scene that is periodic in x, in y or in both: those of the half-space, summed over all images.
//!
//! ```text
//! both          A(k) = sum over n, m of c(kx + n mx, ky + m my) - their mean over the period
//! x only        A(k) = sum over n of c(kx + n mx, ky), so that its mean over x is c dx dy (2/Lx) log(W/|y|), W = my dy
//! ```
//!
//! *The zero mode.* The sums of 1/rho diverge by a constant, which has to be chosen. With two periods it is such that the mean displacement is
//! zero: displacements and the approach are relative to the mean plane of the bodies. With one period the mean along the period is a problem of
//! plane strain, whose displacement diverges at infinity (Johnson, Contact Mechanics, section 2.4). Here the mean displacement along the period
//! is zero at the distance W from a load; W is the grid's width in the direction without a period. Another choice W' would add `2 c F/L
//! log(W'/W)` to the approach, and nothing to the pressures of a given force.
//!
//! These coefficients are exact for pressures that are constant on elements. With two periods their transform at the wave numbers q is `sum over
//! the aliases of q of 2 pi c/|q| sinc(qx dx/2) sinc(qy dy/2)`, and 0 for q = 0. (Stanley & Kato 1997 take only the first alias.)
//!
//! *Summation.* The contribution of near images is a sum of the half-space's coefficients, that of the others a polynomial (see
//! [`images`](super::images)), which serves all coarser grids of the same period. At a distance `|y|` of many periods L, a line of images along x
//! contributes only its mean along x. Integrated over an element, this mean is
//!
//! ```text
//! one period    c dx 2/L  integral of  log(W/|y|) dy
//! two periods   c dx 2/L  integral of -log(2 |sin(pi y/Ly)|) dy        (independent of W)
//! ```

use std::f64::consts::PI;
use std::sync::Arc;

use super::gauss::gauss;
use super::half_space::HalfSpace;
use super::images::{lengths, Far, Lines, Near, NODES};
use super::kernel::Kernel;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{collected, zeros};

/// The name of the memory of coefficients in messages.
const PERIODIC: &str = "the coefficients of a period";

/// The number of panels of a period for Gauss quadrature of functions that are smooth on the period. Their singularity is at least six
/// half-panels away.
const PANELS: usize = 12;

/// Coefficients of a scene that repeats itself after the length of a grid in x, in y or in both.
#[derive(Clone, Debug, PartialEq)]
pub struct Periodic {
    half_space: HalfSpace,
    /// Whether the scene is periodic in x.
    x: bool,
    /// Whether the scene is periodic in y.
    y: bool,
    /// The numbers of elements of the grid in x and in y.
    mx: usize,
    my: usize,
    /// The polynomial of the far images, shared with coarser grids.
    far: Arc<Far>,
    /// The coefficients `[ky][kx]` at offsets >= 0, in periodic directions up to half the period.
    table: Arc<Vec<f64>>,
    /// The number of coefficients in a row of the table.
    columns: usize,
}

impl Periodic {
    /// Computes the coefficients of `grid`, which is one period in the periodic directions.
    pub fn new(half_space: HalfSpace, (x, y): (bool, bool), grid: &Grid) -> Result<Periodic> {
        assert!(x || y, "a scene that repeats itself nowhere");
        let far = Arc::new(Far::new((x, y), grid));
        Periodic::with_far(half_space, (x, y), grid, far)
    }

    fn with_far(half_space: HalfSpace, (x, y): (bool, bool), grid: &Grid, far: Arc<Far>) -> Result<Periodic> {
        let (columns, rows) = grid.offsets((x, y));
        let mut table = zeros(columns * rows, PERIODIC)?;
        let periodic = Periodic { half_space, x, y, mx: grid.mx, my: grid.my, far, table: Arc::default(), columns };
        let near = periodic.far.near(grid);
        periodic.add_images(grid, &near, &mut table)?;
        periodic.add_lines(grid, &near, &mut table)?;
        if x && y {
            Periodic::remove_mean(&mut table, grid);
        }
        Ok(Periodic { table: Arc::new(table), ..periodic })
    }

    /// Writes the sums over images to `table` at the near offsets: near images by the half-space's coefficients, far ones by the polynomial.
    fn add_images(&self, grid: &Grid, near: &Near, table: &mut [f64]) -> Result<()> {
        let far = &self.far;
        let half_space = self.half_space.for_element(near.element.0, near.element.1);
        let strength = half_space.compliance * (near.element.0 * near.element.1);
        let [means_x, means_y] = far.means(near);
        let in_x = collected(means_x, PERIODIC)?;
        let (last_x, last_y) = (far.images.0 * grid.mx, (far.images.1 * grid.my) as i64);
        let mut from_image = zeros(last_x + near.offsets.0, PERIODIC)?;
        for ((ky, in_y), out) in (0..).zip(means_y).zip(table.chunks_exact_mut(self.columns)) {
            let line = far.along_x(&in_y);
            let at = |in_x: &[f64; NODES]| line.iter().zip(in_x).map(|(a, b)| a * b).sum::<f64>();
            let out = &mut out[..near.offsets.0];
            out.iter_mut().zip(&in_x).for_each(|(value, in_x)| *value = strength * at(in_x));
            for image in (-last_y..=last_y).step_by(grid.my) {
                half_space.fill_row(0, ky + image, &mut from_image);
                for (kx, value) in out.iter_mut().enumerate() {
                    *value += from_image[kx];
                    for image in (grid.mx..=last_x).step_by(grid.mx) {
                        *value += from_image[image + kx] + from_image[image - kx];
                    }
                }
            }
        }
        Ok(())
    }

    /// Adds the means of lines of images. At far offsets this is the whole coefficient. At near ones it is the part of an element that was cut
    /// off, and the change by a second period.
    fn add_lines(&self, grid: &Grid, near: &Near, table: &mut [f64]) -> Result<()> {
        let (length_x, length_y) = lengths(grid);
        let (columns, c) = (self.columns, self.half_space.compliance);
        let along_x = self.far.lines == Lines::X;
        let (count, d, cut, near, length, width) = match self.far.lines {
            Lines::X => (table.len() / columns, grid.dy, near.element.1, near.offsets.1, length_x, length_y),
            Lines::Y => (columns, grid.dx, near.element.0, near.offsets.0, length_y, length_x),
        };
        let other_lines = (self.x && self.y).then_some(self.far.other_lines);
        let line = Line { d, cut, near, width, other_lines };
        let strength = 2.0 * c * (grid.dx * grid.dy / d) / length;
        let means = collected((0..count).map(|k| strength * line.beyond(k)), PERIODIC)?;
        for (i, value) in table.iter_mut().enumerate() {
            *value += means[if along_x { i / columns } else { i % columns }];
        }
        Ok(())
    }

    /// Subtracts the mean over two periods from a table of the coefficients at offsets up to half of both periods.
    pub fn remove_mean(table: &mut [f64], grid: &Grid) {
        let columns = grid.mx / 2 + 1;
        // Offsets k and m - k share an entry, except 0 and m/2.
        let weight = |k: usize, m: usize| if k == 0 || 2 * k == m { 1.0 } else { 2.0 };
        let weights = |i: usize| weight(i % columns, grid.mx) * weight(i / columns, grid.my);
        let sum: f64 = table.iter().enumerate().map(|(i, value)| weights(i) * value).sum();
        let mean = sum / (grid.mx * grid.my) as f64;
        table.iter_mut().for_each(|value| *value -= mean);
    }

    /// The offset between 0 and half a period of m elements that has the same coefficients as the offset k.
    pub fn folded(k: i64, m: usize) -> usize {
        let k = k.unsigned_abs() as usize % m;
        k.min(m - k)
    }

    /// The coefficients of a coarser grid. If the number of fine elements is odd, the coarse grid is longer than the period by one fine element.
    /// Its coefficients are then those of this longer period, which suffices for an initial guess.
    pub fn coarsened(&self, coarse: &Grid) -> Result<Periodic> {
        let directions = (self.x, self.y);
        let far = if self.far.serves(coarse) { self.far.clone() } else { Arc::new(Far::new(directions, coarse)) };
        let half_space = self.half_space.for_element(coarse.dx, coarse.dy);
        Periodic::with_far(half_space, directions, coarse, far)
    }
}

impl Kernel for Periodic {
    fn at(&self, kx: i64, ky: i64) -> f64 {
        let folded = |k: i64, repeats: bool, m: usize| match repeats {
            true => Periodic::folded(k, m),
            false => (k.unsigned_abs() as usize).min(m - 1),
        };
        self.table[folded(ky, self.y, self.my) * self.columns + folded(kx, self.x, self.mx)]
    }

    fn repeats(&self, grid: &Grid) -> (bool, bool) {
        (self.x && grid.mx == self.mx, self.y && grid.my == self.my)
    }

    fn constant_for(&self, response: f64) -> f64 {
        match self.x && self.y {
            true => response / (self.mx as f64 * self.my as f64),
            false => 0.0,
        }
    }

    fn is_mean_free(&self) -> bool {
        self.x && self.y
    }

    // The zero mode gets about the response `2 pi c/|q|` of the longest wave.
    fn constant_for_inverse(&self) -> f64 {
        let HalfSpace { dx, dy, .. } = self.half_space;
        let longest = f64::max(self.mx as f64 * dx, self.my as f64 * dy);
        self.constant_for(self.half_space.compliance * longest)
    }

    fn coarsen(&self, _fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>> {
        Ok(Arc::new(self.coarsened(coarse)?))
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.table[..])
    }
}

/// The mean of a line of images along the line, as a function of the offset across the line: integrated over an element, in units of 2 c/L.
struct Line {
    /// The element's side across the line.
    d: f64,
    /// The part of this side on which images were summed.
    cut: f64,
    /// The number of offsets at which images were summed.
    near: usize,
    /// W; with two periods the period across the line.
    width: f64,
    /// With two periods: the number of other lines on either side that are in the sum already.
    other_lines: Option<usize>,
}

impl Line {
    /// The term that is missing in the coefficient at offset k.
    fn beyond(&self, k: usize) -> f64 {
        let (d, y) = (self.d, k as f64 * self.d);
        let line = match k {
            0 => 2.0 * (self.log_integral(0.5 * d) - self.log_integral(0.5 * self.cut)),
            k if k < self.near => 0.0,
            1 => self.log_integral(1.5 * d) - self.log_integral(0.5 * d),
            // The quadrature has no cancellation, and the singularity is at least four half-elements away.
            _ => gauss(y, d, |y| (self.width / y).ln()),
        };
        line - self.other_lines.map_or(0.0, |summed| self.of_other_lines(y, summed))
    }

    /// `integral from 0 to y of log(W/t) dt`.
    fn log_integral(&self, y: f64) -> f64 {
        y * ((self.width / y).ln() + 1.0)
    }

    /// The integral of `log(2 sin(pi y/Ly)/(y/W))` over an element, W = Ly: the mean of all other lines. The lines that are in the sum already
    /// are left out; each pair of them is a factor `1 - (y/(m Ly))^2` of the sine.
    fn of_other_lines(&self, centre: f64, summed: usize) -> f64 {
        let panels = (PANELS as f64 * self.d / self.width).ceil();
        let step = self.d / panels;
        let smooth = |y: f64| {
            let t = PI * y / self.width;
            let sine = if t == 0.0 { 1.0 } else { t.sin() / t };
            let factor = |m: usize| 1.0 - (y / (m as f64 * self.width)).powi(2);
            (2.0 * PI * sine / (1..=summed).map(factor).product::<f64>()).ln()
        };
        (0..panels as usize).map(|k| gauss(centre + ((k as f64 + 0.5) * step - 0.5 * self.d), step, smooth)).sum()
    }
}
