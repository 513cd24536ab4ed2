//! Coefficients of a scene that repeats itself, in x, in y or in both: the half-space's, summed over all images.
//!
//! ```text
//! both          A(k) = sum over n, m of c(kx + n mx, ky + m my) - their mean over the period
//! x only        A(k) = sum over n of c(kx + n mx, ky), so that its mean over x is c dx dy (2/Lx) log(W/|y|), W = my dy
//! ```
//!
//! *The zero mode.* The sums of 1/rho diverge, by a constant. With two periods the constant is such that the mean displacement is
//! zero: displacements, and the approach, are relative to the mean plane of the bodies. With one period the bodies are those of plane
//! strain in the mean, whose displacement knows no infinity (Johnson, Contact Mechanics, section 2.4): it is zero, in the mean over the
//! period, at the distance W from a load, the grid's whole width in the direction that is free. Another W would add
//! `2 c F/L log(W'/W)` to the approach, and nothing to the pressures of a given force.
//!
//! These are the exact coefficients for pressures that are constant on elements: with two periods their transform at the wave numbers
//! q is `sum over the aliases of q of 2 pi c/|q| sinc(qx dx/2) sinc(qy dy/2)`, 0 for q = 0 (Stanley & Kato 1997 take the first alias).
//!
//! *How they are summed.* Near images by the half-space's own coefficients. The rest is smooth on one period: a polynomial in
//! x^2 and y^2 through 12 x 12 Chebyshev nodes, whose means over elements are its integrals; at the nodes it is Ewald's sum (1921), or
//! with one period the sum of `1/|x + n L| - 1/|n L|`, whose tail is a multipole series. It serves all coarser grids of the same period.

use std::f64::consts::PI;
use std::sync::Arc;

use super::half_space::{HalfSpace, GAUSS};
use super::special::{complementary_error_function, hurwitz_zeta, EULER_GAMMA};
use crate::grid::Grid;

/// Chebyshev nodes in each direction. The nearest singularity of what they represent lies on the ellipse of sum of semi-axes 4.5 or
/// beyond (see `reach`): `4.5^-24 = 2e-16` is left.
const NODES: usize = 12;
/// A Gaussian at this many widths is below 1e-17.
const GAUSSIAN: f64 = 6.3;
/// What a grid of 8 elements covers of its period: half, and half an element.
const COARSE: f64 = 0.5626;

/// Coefficients of a scene that repeats itself after a grid's length in x, in y or in both.
#[derive(Clone, Debug, PartialEq)]
pub struct Periodic {
    half_space: HalfSpace,
    /// Which directions repeat.
    x: bool,
    y: bool,
    mx: usize,
    my: usize,
    /// Shared with coarser grids.
    far: Arc<Far>,
    /// Coefficients at offsets >= 0, up to half the period where there is one; `row` of them in a row.
    table: Arc<[f64]>,
    row: usize,
}

impl Periodic {
    /// The coefficients of `grid`, which is one period in the directions that repeat.
    pub fn new(half_space: HalfSpace, (x, y): (bool, bool), grid: &Grid) -> Periodic {
        assert!(x || y, "a scene that repeats itself nowhere");
        let far = Arc::new(Far::new((x, y), grid));
        Periodic::with_far(half_space, (x, y), grid, far)
    }

    fn with_far(half_space: HalfSpace, (x, y): (bool, bool), grid: &Grid, far: Arc<Far>) -> Periodic {
        let (row, rows) = offsets((x, y), grid);
        let means = |count: usize, d: f64, half: f64| (0..count).map(move |k| chebyshev_means(k as f64, d / half));
        let in_x: Vec<_> = means(row, grid.dx, far.half.0).collect();
        let strength = half_space.compliance() * grid.element_area();
        let mut table = Vec::with_capacity(row * rows);
        let (last_x, last_y) = (far.images_x * grid.mx, (far.images_y * grid.my) as i64);
        let mut from_image = vec![0.0; last_x + row];
        for (ky, in_y) in (0..rows as i64).zip(means(rows, grid.dy, far.half.1)) {
            let start = table.len();
            let line = far.along_x(&in_y);
            let at = |in_x: &[f64; NODES]| line.iter().zip(in_x).map(|(a, b)| a * b).sum::<f64>();
            table.extend(in_x.iter().map(|in_x| strength * at(in_x)));
            for image in (-last_y..=last_y).step_by(grid.my) {
                half_space.fill_row(0, ky + image, &mut from_image);
                for (kx, value) in table[start..].iter_mut().enumerate() {
                    *value += from_image[kx];
                    for image in (grid.mx..=last_x).step_by(grid.mx) {
                        *value += from_image[image + kx] + from_image[image - kx];
                    }
                }
            }
        }
        let mut periodic = Periodic { half_space, x, y, mx: grid.mx, my: grid.my, far, table: Arc::new([]), row };
        if x && y {
            periodic.remove_mean(&mut table);
        }
        periodic.table = table.into();
        periodic
    }

    fn remove_mean(&self, table: &mut [f64]) {
        // Offsets k and m - k are one entry, but for 0 and m/2.
        let weight = |k: usize, m: usize| if k == 0 || 2 * k == m { 1.0 } else { 2.0 };
        let weights = |i: usize| weight(i % self.row, self.mx) * weight(i / self.row, self.my);
        let sum: f64 = table.iter().enumerate().map(|(i, value)| weights(i) * value).sum();
        let mean = sum / (self.mx * self.my) as f64;
        table.iter_mut().for_each(|value| *value -= mean);
    }

    /// In which directions `grid` is one period: of a part of the scene's grid, maybe in none.
    pub fn repeats(&self, grid: &Grid) -> (bool, bool) {
        (self.x && grid.mx == self.mx, self.y && grid.my == self.my)
    }

    /// Whether a uniform pressure displaces nothing: the mean is taken away.
    pub fn is_mean_free(&self) -> bool {
        self.x && self.y
    }

    /// The coefficient at offset `(kx, ky)`; in a direction that does not repeat the outermost one beyond the grid.
    pub fn at(&self, kx: i64, ky: i64) -> f64 {
        let folded = |k: i64, repeats: bool, m: usize| {
            let k = if repeats { k.unsigned_abs() as usize % m } else { (k.unsigned_abs() as usize).min(m - 1) };
            if repeats {
                k.min(m - k)
            } else {
                k
            }
        };
        self.table[folded(ky, self.y, self.my) * self.row + folded(kx, self.x, self.mx)]
    }

    /// A constant that gives the mean-free coefficients an inverse, for preconditioners: the mode of zero gets about the response
    /// `2 pi c/|q|` of the longest wave.
    pub fn constant_for_inverse(&self) -> f64 {
        if !self.is_mean_free() {
            return 0.0;
        }
        let (dx, dy) = self.half_space.element();
        let longest = f64::max(self.mx as f64 * dx, self.my as f64 * dy);
        self.half_space.compliance() * longest / (self.mx as f64 * self.my as f64)
    }

    /// The coefficients of a coarser grid. An odd count makes it longer by an element: good enough to start from.
    pub fn coarsen(&self, coarse: &Grid) -> Periodic {
        let directions = (self.x, self.y);
        let far =
            if self.far.serves(directions, coarse) { self.far.clone() } else { Arc::new(Far::new(directions, coarse)) };
        Periodic::with_far(self.half_space.for_element(coarse.dx, coarse.dy), directions, coarse, far)
    }

    /// The coefficients times `factor`.
    pub fn times(&self, factor: f64) -> Periodic {
        let table = self.table.iter().map(|value| factor * value).collect();
        Periodic { half_space: self.half_space.times(factor), far: self.far.clone(), table, ..*self }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.table[..])
    }
}

/// Number of offsets >= 0 in x and y: up to half the period where there is one.
fn offsets((x, y): (bool, bool), grid: &Grid) -> (usize, usize) {
    let offsets = |repeats: bool, m: usize| if repeats { m / 2 + 1 } else { m };
    (offsets(x, grid.mx), offsets(y, grid.my))
}

/// Half the rectangle that the offsets of a grid cover.
fn covered(directions: (bool, bool), grid: &Grid) -> (f64, f64) {
    let (row, rows) = offsets(directions, grid);
    ((row as f64 - 0.5) * grid.dx, (rows as f64 - 0.5) * grid.dy)
}

/// The grid's lengths.
fn lengths(grid: &Grid) -> (f64, f64) {
    (grid.mx as f64 * grid.dx, grid.my as f64 * grid.dy)
}

/// What all but the near images contribute, per unit strength, as a polynomial on `|x| <= half.0, |y| <= half.1`.
#[derive(Debug, PartialEq)]
struct Far {
    lengths: (f64, f64),
    half: (f64, f64),
    /// Near images on either side.
    images_x: usize,
    images_y: usize,
    /// `[j][i]`: of `T_i(2 (x/X)^2 - 1) T_j(2 (y/Y)^2 - 1)`.
    coefficients: [[f64; NODES]; NODES],
}

/// Images on either side that are near: beyond them no singularity is inside the ellipse about `[-here, here]` whose semi-axes are
/// 2.4 and 2.2 half-lengths.
fn reach(length: f64, here: f64, across: f64) -> usize {
    (f64::max(2.4 * here, here + 2.2 * across) / length).ceil() as usize - 1
}

impl Far {
    /// Of a grid and, where there is a period, of coarser ones: half an element beyond half the period.
    fn new((x, y): (bool, bool), grid: &Grid) -> Far {
        let (length_x, length_y) = lengths(grid);
        let (own_x, own_y) = covered((x, y), grid);
        let half_x = if x { own_x.max(COARSE * length_x) } else { own_x };
        let half_y = if y { own_y.max(COARSE * length_y) } else { own_y };
        let images_x = if x { reach(length_x, half_x, half_y) } else { 0 };
        let images_y = if y { reach(length_y, half_y, half_x) } else { 0 };
        let value = |u: f64, v: f64| match (x, y) {
            (true, true) => ewald(u, v, (length_x, length_y), (images_x, images_y)),
            (true, false) => line_of_images(u, v, length_x, images_x, length_y),
            _ => line_of_images(v, u, length_y, images_y, length_x),
        };
        let angle = |i: usize| PI * (i as f64 + 0.5) / NODES as f64;
        let node = |i: usize, half: f64| half * (0.5 * (1.0 + angle(i).cos())).sqrt();
        let mut coefficients = [[0.0; NODES]; NODES];
        for b in 0..NODES {
            for a in 0..NODES {
                let value = value(node(a, half_x), node(b, half_y)) / (NODES * NODES) as f64;
                for (j, row) in coefficients.iter_mut().enumerate() {
                    for (i, coefficient) in row.iter_mut().enumerate() {
                        let twice = |k: usize| if k == 0 { 1.0 } else { 2.0 };
                        *coefficient +=
                            twice(i) * twice(j) * value * (i as f64 * angle(a)).cos() * (j as f64 * angle(b)).cos();
                    }
                }
            }
        }
        Far { lengths: (length_x, length_y), half: (half_x, half_y), images_x, images_y, coefficients }
    }

    /// Whether it is that of a coarser grid, too.
    fn serves(&self, directions: (bool, bool), grid: &Grid) -> bool {
        let (half_x, half_y) = covered(directions, grid);
        lengths(grid) == self.lengths && half_x <= self.half.0 && half_y <= self.half.1
    }

    /// The polynomial in x where those in y have the means `in_y`.
    fn along_x(&self, in_y: &[f64; NODES]) -> [f64; NODES] {
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
    for (node, weight) in GAUSS.into_iter().flat_map(|(node, weight)| [(node, weight), (-node, weight)]) {
        let weight = if node == 0.0 { 0.25 * weight } else { 0.5 * weight };
        let s = 2.0 * ((k + 0.5 * node) * d).powi(2) - 1.0;
        let (mut before, mut now) = (s, 1.0); // T_-1 = T_1 and T_0
        for mean in &mut means {
            *mean += weight * now;
            (before, now) = (now, 2.0 * s * now - before);
        }
    }
    means
}

/// The sum of 1/rho over all images but the near ones, two periods, up to a constant. With a width `1/eta` of Gaussians,
///
/// ```text
/// sum of 1/rho = sum of erfc(eta rho)/rho + 2 pi/(Lx Ly) sum over q of erfc(q/(2 eta))/q cos(q r)
/// ```
fn ewald(x: f64, y: f64, (lx, ly): (f64, f64), (near_x, near_y): (usize, usize)) -> f64 {
    let eta = (PI / (lx * ly)).sqrt();
    let last = |length: f64, near: usize| (((GAUSSIAN / eta) / length).ceil() as i64 + 1).max(near as i64);
    let (last_x, last_y) = (last(lx, near_x), last(ly, near_y));
    let mut sum = 0.0;
    for m in -last_y..=last_y {
        for n in -last_x..=last_x {
            let rho = (x + n as f64 * lx).hypot(y + m as f64 * ly);
            let is_near = n.unsigned_abs() as usize <= near_x && m.unsigned_abs() as usize <= near_y;
            if is_near && eta * rho < 1e-8 {
                sum -= 2.0 * eta / PI.sqrt();
            } else if is_near {
                let beyond = if eta * rho < GAUSSIAN { complementary_error_function(eta * rho) } else { 0.0 };
                sum -= (1.0 - beyond) / rho;
            } else if eta * rho < GAUSSIAN {
                sum += complementary_error_function(eta * rho) / rho;
            }
        }
    }
    let waves = |length: f64| (GAUSSIAN * eta * length / PI).ceil() as usize;
    for j in 0..=waves(ly) {
        for i in usize::from(j == 0)..=waves(lx) {
            let (qx, qy) = (2.0 * PI * i as f64 / lx, 2.0 * PI * j as f64 / ly);
            let q = qx.hypot(qy);
            if q < 2.0 * GAUSSIAN * eta {
                let signs = if i == 0 || j == 0 { 2.0 } else { 4.0 };
                let term = complementary_error_function(0.5 * q / eta) / q * (qx * x).cos() * (qy * y).cos();
                sum += signs * 2.0 * PI / (lx * ly) * term;
            }
        }
    }
    sum
}

/// The same for one period: `along` it, of the given length, and `across`; the mean along it of the whole sum is `2/L log(W/across)`.
///
/// ```text
/// sum over n of 1/rho_n - [n != 0]/|n L|    has the mean 2/L (log(2 L/across) - gamma)
/// ```
fn line_of_images(along: f64, across: f64, length: f64, near: usize, width: f64) -> f64 {
    let harmonic: f64 = (1..=near).rev().map(|n| 1.0 / n as f64).sum();
    let constant = 2.0 / length * ((width / (2.0 * length)).ln() + EULER_GAMMA - harmonic);
    // From here on the terms are a series in (r/(n L))^2 <= 1/100.
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
