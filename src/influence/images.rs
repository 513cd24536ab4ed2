//! The images of a periodic scene: the contribution of all but the near ones, as a polynomial.
//!
//! The sum over the far images is smooth on one period. A polynomial in x^2 and y^2 through 12 x 12 Chebyshev nodes
//! replaces it, and its means over elements follow. Images are summed in lines along the period, or along the shorter
//! of two: at the nodes a line is the sum of `1/|x + n L| - 1/|n L|`, whose tail is a multipole series.
//!
//! *Bounded work.* A line of images of period L has waves along it that decay with the distance y as `exp(-2 pi |y|/L)`. Beyond [`FADED`] L
//! only the mean remains, which has a closed form. So images are summed for nearer rows only, and with two periods in the nearer of the other
//! lines.

use std::f64::consts::PI;

use super::gauss::rule;
use super::special::{hurwitz_zeta, EULER_GAMMA};
use crate::grid::Grid;

/// Chebyshev nodes in each direction. The nearest singularity of the function lies on or beyond the ellipse of sum of semi-axes 4.5 (see
/// `reach`), so the error is `4.5^-24 = 2e-16`.
pub(super) const NODES: usize = 12;
/// The part of its period that a grid of 8 elements covers: half, and half an element.
const COVERED_PERIOD: f64 = 0.5626;
/// Periods beyond which the waves of a line of images vanish: `exp(-2 pi 6) = 4e-17`.
const FADED: f64 = 6.0;
/// Ratio of the periods from which waves of other lines vanish at the farthest offset: half the period less half an element, at least a
/// quarter of the period.
const MUCH_LONGER: f64 = 4.0 * FADED;

/// The direction of the lines in which images are summed, the mean of each in closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lines {
    /// Along x.
    X,
    /// Along y.
    Y,
}

/// The offsets of a grid for which images are summed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    /// Offsets in x and in y, at least one.
    pub offsets: (usize, usize),
    /// The element's size, cut off where waves vanish.
    pub element: (f64, f64),
}

impl Near {
    /// Half the rectangle that these offsets cover.
    fn half(&self) -> (f64, f64) {
        ((self.offsets.0 as f64 - 0.5) * self.element.0, (self.offsets.1 as f64 - 0.5) * self.element.1)
    }
}

/// The grid's lengths.
pub(super) fn lengths(grid: &Grid) -> (f64, f64) {
    (grid.mx as f64 * grid.dx, grid.my as f64 * grid.dy)
}

/// The contribution of all far images, per unit strength, as a polynomial on `|x| <= half.0, |y| <= half.1`.
#[derive(Debug, PartialEq)]
pub(super) struct Far {
    directions: (bool, bool),
    lengths: (f64, f64),
    half: (f64, f64),
    /// The direction of the lines.
    pub lines: Lines,
    /// Whether the waves of all lines vanish within the offsets across them, so that only means remain beyond.
    fades: bool,
    /// Other lines on either side whose waves do not vanish; the mean of lines beyond is not in the polynomial.
    pub other_lines: usize,
    /// Near images on either side, in x and in y.
    pub images: (usize, usize),
    /// `[j][i]`: the coefficients of `T_i(2 (x/X)^2 - 1) T_j(2 (y/Y)^2 - 1)`.
    coefficients: [[f64; NODES]; NODES],
}

/// Near images on either side: images beyond have no singularity inside the ellipse about `[-here, here]` of semi-axes 2.4 and 2.2
/// half-lengths.
fn reach(length: f64, here: f64, across: f64) -> usize {
    (f64::max(2.4 * here, here + 2.2 * across) / length).ceil() as usize - 1
}

/// The number of offsets `0..count` of elements of size d nearer than `faded`, and the part of an element within.
fn cut(count: usize, d: f64, faded: f64) -> (usize, f64) {
    let near = (faded / d + 0.5).ceil().min(count as f64) as usize;
    (near.max(1), d.min(2.0 * faded))
}

impl Lines {
    /// A pair in x and y as a pair along and across the lines, and back.
    fn turn<A>(self, (x, y): (A, A)) -> (A, A) {
        match self {
            Lines::X => (x, y),
            Lines::Y => (y, x),
        }
    }
}

impl Far {
    /// The polynomial of a grid and, in periodic directions, of coarser ones: half an element beyond half the period.
    pub fn new(directions: (bool, bool), grid: &Grid) -> Far {
        let lengths = lengths(grid);
        let lines = if directions.0 && (!directions.1 || lengths.0 <= lengths.1) { Lines::X } else { Lines::Y };
        let (length, width) = lines.turn(lengths);
        let fades = !(directions.0 && directions.1) || width >= MUCH_LONGER * length;
        let (half, images, coefficients) = ((0.0, 0.0), (0, 0), [[0.0; NODES]; NODES]);
        let mut far = Far { directions, lengths, half, lines, fades, other_lines: 0, images, coefficients };
        let (own_along, own_across) = lines.turn(far.near(grid).half());
        let along = own_along.max(COVERED_PERIOD * length);
        let (mut across, mut near_lines) = (own_across.max(COVERED_PERIOD * width), 0);
        if fades {
            // Across lines coarser elements reach farther, at most to the end.
            let ((_, count), (_, d)) = (lines.turn(grid.offsets(directions)), lines.turn((grid.dx, grid.dy)));
            across = own_across.max(f64::min((count as f64 - 0.5) * d, 1.5 * FADED * length));
        } else {
            near_lines = reach(width, across, along);
            far.other_lines = near_lines.max(((FADED * length + across) / width).ceil() as usize - 1);
        }
        let near = (reach(length, along, across), near_lines);
        (far.half, far.images) = (lines.turn((along, across)), lines.turn(near));
        far.interpolate();
        far
    }

    /// The sum at a place over all but the near images of the lines whose waves do not vanish.
    fn value(&self, x: f64, y: f64) -> f64 {
        let (along, across) = self.lines.turn((x, y));
        let (near, near_lines) = self.lines.turn(self.images);
        let (length, width) = self.lines.turn(self.lengths);
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

    /// The offsets of a grid for which images are summed.
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

    /// Whether the polynomial serves a coarser grid as well.
    pub fn serves(&self, grid: &Grid) -> bool {
        let half = self.near(grid).half();
        lengths(grid) == self.lengths && half.0 <= self.half.0 && half.1 <= self.half.1
    }

    /// The polynomial's means over elements at the first offsets: in x and in y.
    pub fn means(&self, near: &Near) -> [impl ExactSizeIterator<Item = [f64; NODES]>; 2] {
        let means = |count: usize, d: f64| (0..count).map(move |k| chebyshev_means(k as f64, d));
        [means(near.offsets.0, near.element.0 / self.half.0), means(near.offsets.1, near.element.1 / self.half.1)]
    }

    /// The polynomial in x, from the means `in_y` of the polynomials in y.
    pub fn along_x(&self, in_y: &[f64; NODES]) -> [f64; NODES] {
        let mut line = [0.0; NODES];
        for (coefficients, t) in self.coefficients.iter().zip(in_y) {
            line.iter_mut().zip(coefficients).for_each(|(sum, coefficient)| *sum += coefficient * t);
        }
        line
    }
}

/// Means of `T_i(2 t^2 - 1)`, i < 12, over `|t - k d| <= d/2`.
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

/// The sum of 1/rho over the images of one line but the near ones, at `along` its period of the given length and `across` it. The mean of the
/// whole sum along the line is `2/L log(W/across)`.
///
/// ```text
/// sum over n of 1/rho_n - [n != 0]/|n L|    has the mean 2/L (log(2 L/across) - gamma)
/// ```
fn line_of_images(along: f64, across: f64, length: f64, near: usize, width: f64) -> f64 {
    let harmonic: f64 = (1..=near).rev().map(|n| 1.0 / n as f64).sum();
    let constant = 2.0 / length * ((width / (2.0 * length)).ln() + EULER_GAMMA - harmonic);
    // Beyond, the terms are a series in (r/(n L))^2 <= 1/100.
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
