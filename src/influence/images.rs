//! The contribution of the far images of a periodic scene, as a polynomial.
//!
//! The sum of 1/rho over the far images is smooth on one period. It is replaced by a polynomial in x^2 and y^2 through its values at 12 x 12
//! Chebyshev nodes, and the means of this polynomial over elements are the wanted contribution. Images are summed in lines. With one period the
//! lines lie along it, with two periods along the shorter one. At a node the sum over a line is that of `1/|x + n L| - 1/|n L|`, whose tail is a
//! multipole series.
//!
//! *Bounded work.* The potential of a line of images with the period L varies along the line by waves, which decay with the distance y from the
//! line as `exp(-2 pi |y|/L)`. Beyond the distance [`FADED`] L only the mean along the line remains, which has a closed form. Therefore images
//! are summed only for rows nearer than that and, with two periods, only over the nearer of the other lines.

use std::f64::consts::PI;

use super::gauss::rule;
use super::special::{hurwitz_zeta, EULER_GAMMA};
use crate::grid::Grid;

/// The number of Chebyshev nodes in each direction. The nearest singularity of the function lies on or beyond the ellipse whose semi-axes have
/// the sum 4.5 (see `reach`), so the error is `4.5^-24 = 2e-16`.
pub(super) const NODES: usize = 12;
/// The half-width of the polynomial, relative to the period: half the period plus half an element of the coarsest grid, which has 8 elements.
const COVERED_PERIOD: f64 = 0.5626;
/// The distance from a line of images, in periods, beyond which its waves vanish: `exp(-2 pi 6) = 4e-17`.
const FADED: f64 = 6.0;
/// If the longer period is at least this times the shorter one, the waves of other lines vanish at all offsets. The farthest offset is half the
/// longer period less half an element, so that at least a quarter of this period lies between it and the next line.
const MUCH_LONGER: f64 = 4.0 * FADED;

/// The direction of the lines in which images are summed. The mean along each line has a closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lines {
    /// Along x.
    X,
    /// Along y.
    Y,
}

/// The offsets at which images are summed: those nearer to a line of images than its waves reach.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    /// The numbers of these offsets in x and in y, at least one.
    pub offsets: (usize, usize),
    /// The element's sides. Across lines with waves that vanish, the side is cut off where they vanish.
    pub element: (f64, f64),
}

impl Near {
    /// The half-lengths of the rectangle that the elements at these offsets cover.
    fn half(&self) -> (f64, f64) {
        ((self.offsets.0 as f64 - 0.5) * self.element.0, (self.offsets.1 as f64 - 0.5) * self.element.1)
    }
}

/// The lengths of the grid in x and in y.
pub(super) fn lengths(grid: &Grid) -> (f64, f64) {
    (grid.mx as f64 * grid.dx, grid.my as f64 * grid.dy)
}

/// The contribution of all far images to the potential of a unit load, as a polynomial on `|x| <= half.0`, `|y| <= half.1`.
#[derive(Debug, PartialEq)]
pub(super) struct Far {
    /// Whether the scene is periodic in x and in y.
    directions: (bool, bool),
    /// The lengths of the grid in x and in y.
    lengths: (f64, f64),
    /// The half-lengths of the rectangle on which the polynomial holds.
    half: (f64, f64),
    /// The direction of the lines.
    pub lines: Lines,
    /// Whether images are summed only at the offsets that the waves of the line through the load reach. True with one period, and with two if the
    /// longer is at least [`MUCH_LONGER`] times the shorter one, so that the waves of other lines vanish everywhere. Beyond these offsets only
    /// the mean along the line remains.
    fades: bool,
    /// The number of other lines on either side whose waves do not vanish. The polynomial does not contain the mean of the lines beyond.
    pub other_lines: usize,
    /// The number of near images on either side, in x and in y.
    pub images: (usize, usize),
    /// The coefficients `[j][i]` of `T_i(2 (x/X)^2 - 1) T_j(2 (y/Y)^2 - 1)`, with X, Y = `half`.
    coefficients: [[f64; NODES]; NODES],
}

/// The number of near images on either side in a direction with the period `length`. In this direction the polynomial holds on `[-half, half]`,
/// in the other one on `[-half_across, half_across]`. Images beyond the near ones have no singularity inside the ellipse about `[-half, half]` in
/// the complex plane with semi-axes of 2.4 and 2.2 half-lengths.
fn reach(length: f64, half: f64, half_across: f64) -> usize {
    (f64::max(2.4 * half, half + 2.2 * half_across) / length).ceil() as usize - 1
}

/// The number of offsets, out of `0..count`, with elements of size d that reach nearer than `faded`, and the size of an element, cut off at this
/// distance on both sides.
fn cut(count: usize, d: f64, faded: f64) -> (usize, f64) {
    let near = (faded / d + 0.5).ceil().min(count as f64) as usize;
    (near.max(1), d.min(2.0 * faded))
}

impl Lines {
    /// Turns a pair (x, y) into a pair (along, across) the lines. It also turns (along, across) into (x, y).
    fn along_across<A>(self, (x, y): (A, A)) -> (A, A) {
        match self {
            Lines::X => (x, y),
            Lines::Y => (y, x),
        }
    }
}

impl Far {
    /// The polynomial for a grid and its coarser grids. In periodic directions it holds up to half the period plus half an element of the
    /// coarsest grid.
    pub fn new(directions: (bool, bool), grid: &Grid) -> Far {
        let lengths = lengths(grid);
        let lines = if directions.0 && (!directions.1 || lengths.0 <= lengths.1) { Lines::X } else { Lines::Y };
        let (length, width) = lines.along_across(lengths);
        let fades = !(directions.0 && directions.1) || width >= MUCH_LONGER * length;
        let (half, images, coefficients) = ((0.0, 0.0), (0, 0), [[0.0; NODES]; NODES]);
        let mut far = Far { directions, lengths, half, lines, fades, other_lines: 0, images, coefficients };
        let (half_along, half_across) = lines.along_across(far.near(grid).half());
        let along = half_along.max(COVERED_PERIOD * length);
        let (mut across, mut near_lines) = (half_across.max(COVERED_PERIOD * width), 0);
        if fades {
            // Elements of coarser grids reach farther across the lines, at most to the end of the grid.
            let ((_, count), (_, d)) =
                (lines.along_across(grid.offsets(directions)), lines.along_across((grid.dx, grid.dy)));
            across = half_across.max(f64::min((count as f64 - 0.5) * d, 1.5 * FADED * length));
        } else {
            near_lines = reach(width, across, along);
            far.other_lines = near_lines.max(((FADED * length + across) / width).ceil() as usize - 1);
        }
        let near = (reach(length, along, across), near_lines);
        (far.half, far.images) = (lines.along_across((along, across)), lines.along_across(near));
        far.interpolate();
        far
    }

    /// The sum of 1/rho at `(x, y)` over the images of all lines whose waves do not vanish, without the near images.
    fn value(&self, x: f64, y: f64) -> f64 {
        let (along, across) = self.lines.along_across((x, y));
        let (near, near_lines) = self.lines.along_across(self.images);
        let (length, width) = self.lines.along_across(self.lengths);
        let mut sum = 0.0;
        for line in (1..=self.other_lines).rev() {
            for across in [line as f64 * width - across, line as f64 * width + across] {
                sum += line_of_images(along, across, length, near, width);
                if line > near_lines {
                    let images = -(near as i64)..=near as i64;
                    sum += images.map(|n| 1.0 / (along + n as f64 * length).hypot(across)).sum::<f64>();
                }
            }
        }
        sum + line_of_images(along, across, length, near, width)
    }

    /// Computes the coefficients from the values at the Chebyshev nodes.
    fn interpolate(&mut self) {
        let angle = |i: usize| PI * (i as f64 + 0.5) / NODES as f64;
        let node = |i: usize, half: f64| half * (0.5 * (1.0 + angle(i).cos())).sqrt();
        let twice = |k: usize| if k == 0 { 1.0 } else { 2.0 };
        for (a, b) in (0..NODES * NODES).map(|k| (k % NODES, k / NODES)) {
            let value = self.value(node(a, self.half.0), node(b, self.half.1)) / (NODES * NODES) as f64;
            for (j, row) in self.coefficients.iter_mut().enumerate() {
                for (i, coefficient) in row.iter_mut().enumerate() {
                    *coefficient +=
                        twice(i) * twice(j) * value * (i as f64 * angle(a)).cos() * (j as f64 * angle(b)).cos();
                }
            }
        }
    }

    /// The offsets of `grid` at which images are summed.
    pub fn near(&self, grid: &Grid) -> Near {
        let (row, rows) = grid.offsets(self.directions);
        let mut near = Near { offsets: (row, rows), element: (grid.dx, grid.dy) };
        match self.lines {
            _ if !self.fades => {}
            Lines::X => (near.offsets.1, near.element.1) = cut(rows, grid.dy, FADED * self.lengths.0),
            Lines::Y => (near.offsets.0, near.element.0) = cut(row, grid.dx, FADED * self.lengths.1),
        }
        near
    }

    /// Whether the polynomial also holds on a coarser grid: its lengths are the same, and its near offsets lie within `half`.
    pub fn serves(&self, grid: &Grid) -> bool {
        let half = self.near(grid).half();
        lengths(grid) == self.lengths && half.0 <= self.half.0 && half.1 <= self.half.1
    }

    /// The means of the Chebyshev polynomials over the elements at the near offsets: in x and in y.
    pub fn means(&self, near: &Near) -> [impl ExactSizeIterator<Item = [f64; NODES]>; 2] {
        let means = |count: usize, d: f64| (0..count).map(move |k| chebyshev_means(k as f64, d));
        [means(near.offsets.0, near.element.0 / self.half.0), means(near.offsets.1, near.element.1 / self.half.1)]
    }

    /// The coefficients of the polynomial in x for one row of elements. `in_y` has the means of the polynomials in y over this row.
    pub fn along_x(&self, in_y: &[f64; NODES]) -> [f64; NODES] {
        let mut line = [0.0; NODES];
        for (coefficients, t) in self.coefficients.iter().zip(in_y) {
            line.iter_mut().zip(coefficients).for_each(|(sum, coefficient)| *sum += coefficient * t);
        }
        line
    }
}

/// The means of `T_i(2 t^2 - 1)`, i < 12, over `|t - k d| <= d/2`, by Gauss-Legendre quadrature.
fn chebyshev_means(k: f64, d: f64) -> [f64; NODES] {
    let mut means = [0.0; NODES];
    for (node, weight) in rule(9) {
        let s = 2.0 * ((k + (node - 0.5)) * d).powi(2) - 1.0;
        let (mut before, mut now) = (s, 1.0); // T_-1 = T_1 and T_0
        for mean in &mut means {
            *mean += weight * now;
            (before, now) = (now, 2.0 * s * now - before);
        }
    }
    means
}

/// The sum of 1/rho over the images of one line with the period L = `length`, without `near` images on either side, at the distances `along` and
/// `across` from an image. The sum diverges by a constant, which is chosen such that the whole line has the mean `2/L log(W/across)` along it, W
/// = `width`. This follows from
///
/// ```text
/// sum over n of 1/rho_n - [n != 0]/|n L|    has the mean 2/L (log(2 L/across) - gamma)
/// ```
fn line_of_images(along: f64, across: f64, length: f64, near: usize, width: f64) -> f64 {
    let harmonic: f64 = (1..=near).rev().map(|n| 1.0 / n as f64).sum();
    let constant = 2.0 / length * ((width / (2.0 * length)).ln() + EULER_GAMMA - harmonic);
    // From `first_far` on the terms are a series in (r/(n L))^2 <= 1/100.
    let r = along.hypot(across);
    let first_far = near + 10 + (10.0 * r / length).ceil() as usize;
    let mut sum = 0.0;
    for n in (near + 1..first_far).rev() {
        let image = n as f64 * length;
        sum += 1.0 / (image + along).hypot(across) + 1.0 / (image - along).hypot(across) - 2.0 / image;
    }
    // 1/rho_n + 1/rho_-n = 2/(n L) sum over even l of (r/(n L))^l P_l(along/r)
    let (t, ratio) = (if r > 0.0 { along / r } else { 0.0 }, r / length);
    let (mut before, mut legendre) = (1.0, t);
    let mut power = ratio;
    for l in 2..=16 {
        let l_real = f64::from(l);
        (before, legendre) = (legendre, ((2.0 * l_real - 1.0) * t * legendre - (l_real - 1.0) * before) / l_real);
        power *= ratio;
        if l % 2 == 0 {
            sum += 2.0 / length * power * legendre * hurwitz_zeta(l_real + 1.0, first_far as f64);
        }
    }
    sum + constant
}
