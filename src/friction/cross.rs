//! Unlike bodies: pressures displace the surfaces tangentially (sideways), and tractions displace them along the normal.
//!
//! With `K/G = ((1 - 2 nu1)/G1 - (1 - 2 nu2)/G2)/4`, at the offset `(X, Y)` from the centre of a loaded element
//!
//! ```text
//! Axz = -K/(pi G) integral of x/r^2,    Ayz = -K/(pi G) integral of y/r^2       sideways, by a unit pressure
//! u_z = -(Axz qx + Ayz qy)                                                    along the normal, by tractions
//! ```
//!
//! The integrals are over the element, x and y are the coordinates from its points to (X, Y). By the signs the operator of all three components is
//! symmetric. Both integrals are parts of the integral of `1/(x + i y)`:
//!
//! * beyond six half-diagonals the series `dx dy sum_k m_2k/Z^(2k+1)`, `Z = X + i Y`, where m_2k is the mean over the element of `(x + i y)^2k`;
//! * nearer, at two elements or more in one direction, the closed form in the other direction, and Gauss-Legendre in this one;
//! * next to the element differences of `Y ln r + X atan(Y/X)` over its corners. Of a slender element only the near part is integrated so. The rest
//!   is integrated by Gauss-Legendre over panels that grow with the distance.

use std::f64::consts::PI;
use std::sync::Arc;

use super::plane::Vector;
use super::unit::unit_of;
use crate::effects::TangentialInfluence;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::{gauss, gauss_each, Coefficients, Kernel, MOST_TERMS, SERIES};
use crate::memory::zeros;
use crate::operator::fft::Complex;
use crate::operator::{Operator, Workspace};
use crate::threads::Threads;

/// Next to the element, the part of it up to this distance is integrated by differences over corners, in units of the shorter side.
const CORNERS_DISTANCE: f64 = 2.0;
/// The end of a panel of the rest is this many times as far away as its start.
const PANEL_RATIO: f64 = 1.5;

/// Where Axz and Ayz come from.
#[derive(Clone, Debug)]
pub enum Source {
    /// Two half-spaces, with this K/G.
    HalfSpace(f64),
    /// The caller's tables.
    Tables(CrossTables),
}

impl Source {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        match self {
            Source::HalfSpace(_) => 0,
            Source::Tables(tables) => size_of_val(&tables.values[..]),
        }
    }
}

/// The caller's Axz and Ayz at the offsets `-cx..cx` by `-cy..cy`.
#[derive(Clone, Debug)]
pub struct CrossTables {
    cx: i64,
    cy: i64,
    /// `[Axz, Ayz]` of each offset, `[2 cy][2 cx]`.
    values: Arc<Vec<Vector>>,
}

impl CrossTables {
    /// Copies the caller's tables, which have been checked; none if the caller has no Axz and Ayz.
    pub fn new(influence: &TangentialInfluence<'_>) -> Result<Option<CrossTables>> {
        if influence.cross.is_none() {
            return Ok(None);
        }
        let (cx, cy) = (influence.cx as i64, influence.cy as i64);
        let mut values: Vec<Vector> = zeros(4 * influence.cx * influence.cy, "the coefficients of unlike bodies")?;
        for (k, value) in values.iter_mut().enumerate() {
            *value = influence.cross_at(k as i64 % (2 * cx) - cx, k as i64 / (2 * cx) - cy);
        }
        Ok(Some(CrossTables { cx, cy, values: Arc::new(values) }))
    }

    /// Axz and Ayz at an offset. Beyond the tables they are 0; such offsets do not occur between elements of C.
    fn at(&self, x: i64, y: i64) -> Vector {
        if x < -self.cx || x >= self.cx || y < -self.cy || y >= self.cy {
            return [0.0; 2];
        }
        self.values[((y + self.cy) * 2 * self.cx + x + self.cx) as usize]
    }
}

/// The kernel of one component of the coupling.
#[derive(Clone, Debug)]
struct Cross {
    dx: f64,
    dy: f64,
    source: Source,
    /// 0: Axz; 1: Ayz.
    component: usize,
    /// The offset of the points of the displacements from the centres, in elements.
    by: (f64, f64),
}

impl Kernel for Cross {
    fn at(&self, kx: i64, ky: i64) -> f64 {
        let (x, y) = (kx as f64 + self.by.0, ky as f64 + self.by.1);
        match &self.source {
            Source::HalfSpace(k_over_g) => {
                // The integrals are lengths. They are computed in units near dx, for the range of numbers.
                let unit = unit_of(self.dx);
                let integral = integrals(x, y, self.dx / unit, self.dy / unit)[self.component];
                -k_over_g / PI * (unit * integral)
            }
            // With tables steps are of whole elements.
            Source::Tables(tables) => tables.at(x.round() as i64, y.round() as i64)[self.component],
        }
    }

    fn is_even(&self, _grid: &Grid) -> bool {
        false
    }

    fn is_symmetric(&self, _grid: &Grid) -> bool {
        false
    }

    fn coarsen(&self, _fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>> {
        Ok(Arc::new(Cross { dx: coarse.dx, dy: coarse.dy, ..self.clone() }))
    }
}

/// The integrals of `x/r^2` and `y/r^2` over an element, at the offset (x, y) from its centre in elements.
pub fn integrals(x: f64, y: f64, dx: f64, dy: f64) -> [f64; 2] {
    let (kx, ky) = (x.abs(), y.abs());
    let (px, py) = (kx * dx, ky * dy);
    // Beyond six half-diagonals MOST_TERMS terms after the first suffice: the next one is at most 6^-18 = 1e-14 of the first.
    let far = SERIES[0].0 * 0.5 * dx.hypot(dy);
    let [jx, jy] = if px * px + py * py >= far * far { series(px, py, dx, dy) } else { near(kx, ky, dx, dy) };
    // Both integrals are odd functions. They are exactly 0 at the centre.
    let odd = |x: f64, value: f64| if x == 0.0 { 0.0 } else { value.copysign(x) };
    [odd(x, jx), odd(y, jy)]
}

/// The integrals by the series of moments, at the distance (px, py).
fn series(px: f64, py: f64, dx: f64, dy: f64) -> [f64; 2] {
    let inverse = Complex::new(px, py).inv();
    let (square, mut sum) = (inverse * inverse, Complex::new(0.0, 0.0));
    for k in (0..=MOST_TERMS).rev() {
        sum = sum * square + moment(k, dx, dy);
    }
    sum = sum * inverse * (dx * dy);
    [sum.re, -sum.im]
}

/// The moment m_2k, the mean over the element of `(x + i y)^2k`.
fn moment(k: usize, dx: f64, dy: f64) -> f64 {
    let (hx, hy) = (0.5 * dx, 0.5 * dy);
    let (mut sum, mut binomial) = (0.0, 1.0);
    for j in 0..=k {
        let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
        let (in_x, in_y) = (2 * (k - j), 2 * j);
        sum += sign * binomial * hx.powi(in_x as i32) / (in_x + 1) as f64 * hy.powi(in_y as i32) / (in_y + 1) as f64;
        binomial *= (in_x * (in_x.max(1) - 1)) as f64 / ((in_y + 1) * (in_y + 2)) as f64;
    }
    sum
}

/// The integrals at an offset `kx, ky >= 0` nearer than the series reaches.
fn near(kx: f64, ky: f64, dx: f64, dy: f64) -> [f64; 2] {
    if ky >= 2.0 {
        return gauss_each(ky * dy, dy, |y| along(kx, dx, y));
    }
    if kx >= 2.0 {
        let [y, x] = gauss_each(kx * dx, dx, |x| along(ky, dy, x));
        return [x, y];
    }
    if dx >= dy {
        // In units of the shorter side. The integrals are lengths.
        next_to_element(kx * dx / dy, ky, dx / dy).map(|value| value * dy)
    } else {
        let [jy, jx] = next_to_element(ky * dy / dx, kx, dy / dx);
        [jx * dx, jy * dx]
    }
}

/// The integrals over an element of `length >= 1` in x and 1 in y, at `(x, ky)`, less than two elements away in each direction. The near part is
/// integrated by its corners, the rest by panels in x, because over a long element the differences over corners would lose digits.
fn next_to_element(x: f64, ky: f64, length: f64) -> [f64; 2] {
    let (from, to) = (x - 0.5 * length, x + 0.5 * length);
    let (near_from, near_to) =
        (from.clamp(-CORNERS_DISTANCE, CORNERS_DISTANCE), to.clamp(-CORNERS_DISTANCE, CORNERS_DISTANCE));
    let mut sum = if near_from < near_to { corners((near_from, near_to), ky) } else { [0.0; 2] };
    // The integral of x/r^2 is odd in x.
    for (sign, first, last) in [(1.0, from.max(CORNERS_DISTANCE), to), (-1.0, (-to).max(CORNERS_DISTANCE), -from)] {
        let mut start = first;
        while start < last {
            let end = (PANEL_RATIO * start).min(last);
            let panel = |component: usize| gauss(0.5 * (start + end), end - start, |x| along(ky, 1.0, x)[component]);
            // `along` integrates over y here, at the distance x, so its components are exchanged.
            sum = [sum[0] + sign * panel(1), sum[1] + panel(0)];
            start = end;
        }
    }
    sum
}

/// The integrals over a rectangle from xm to xp in x, and of width 1 at the distance ky in y: differences over its corners of `Y ln r + X atan(Y/X)`,
/// and of the same with X and Y exchanged.
fn corners((xm, xp): (f64, f64), ky: f64) -> [f64; 2] {
    let (ym, yp) = (ky - 0.5, ky + 0.5);
    let f = |x: f64, y: f64| {
        let logarithm = if y == 0.0 { 0.0 } else { y * x.hypot(y).ln() };
        logarithm + if x == 0.0 { 0.0 } else { x * (y / x).atan() }
    };
    [f(xp, yp) - f(xp, ym) - f(xm, yp) + f(xm, ym), f(yp, xp) - f(ym, xp) - f(yp, xm) + f(ym, xm)]
}

/// The integrals over x of `x/r^2` and `y/r^2`, on the interval of length d about k d, at the distance y.
fn along(k: f64, d: f64, y: f64) -> [f64; 2] {
    let (plus, minus) = ((k + 0.5) * d, (k - 0.5) * d);
    [0.5 * (2.0 * k * d * d / (minus * minus + y * y)).ln_1p(), (d * y).atan2(plus * minus + y * y)]
}

/// Products with the coupling coefficients Axz and Ayz of a grid.
pub struct Coupling {
    /// The products with Axz and with Ayz.
    operators: [Operator<f64>; 2],
    workspace: Workspace<f64>,
    /// Scratch: the input and the output of a product.
    field: [Vec<f64>; 2],
}

impl Coupling {
    /// Sets up the coupling on a grid. Displacements are those at the offset `by` from each centre, in elements.
    pub fn new(grid: &Grid, source: &Source, by: (f64, f64), threads: &Threads) -> Result<Coupling> {
        let threads = &threads.suited_to(grid.len());
        let operator = |component: usize| {
            let kernel = Cross { dx: grid.dx, dy: grid.dy, source: source.clone(), component, by };
            Operator::new(&Coefficients::from(kernel), grid, threads)
        };
        let operators = [operator(0)?, operator(1)?];
        let workspace = operators[0].workspace()?;
        let field = || zeros(grid.len(), "the coupling of unlike bodies");
        Ok(Coupling { operators, workspace, field: [field()?, field()?] })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let fields = self.field.iter().map(|field| size_of_val(&field[..])).sum::<usize>();
        self.operators.iter().map(Operator::bytes).sum::<usize>() + self.workspace.bytes() + fields
    }

    /// Adds `sign` times the tangential displacements by pressures p to u.
    pub fn add_sideways(&mut self, p: &[f64], sign: f64, u: &mut [Vector]) {
        for (component, operator) in self.operators.iter().enumerate() {
            operator.apply(p, &mut self.field[0], &mut self.workspace);
            u.iter_mut().zip(&self.field[0]).for_each(|(u, value)| u[component] += sign * value);
        }
    }

    /// Computes the displacements u along the normal by tractions q.
    pub fn along_normal(&mut self, q: &[Vector], u: &mut [f64]) {
        u.fill(0.0);
        let [tractions, product] = &mut self.field;
        for (component, operator) in self.operators.iter().enumerate() {
            tractions.iter_mut().zip(q).for_each(|(traction, q)| *traction = q[component]);
            operator.apply(tractions, product, &mut self.workspace);
            u.iter_mut().zip(&*product).for_each(|(u, value)| *u -= value);
        }
    }
}
