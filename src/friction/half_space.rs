//! Influence coefficients of tangential tractions on two half-spaces: the displacement difference of the bodies at a point by a unit traction on one
//! element.
//!
//! With the combined `1/G = (1/G1 + 1/G2)/2` and `nu/G = (nu1/G1 + nu2/G2)/2`, at the offset `(X, Y)` from the centre of the element (Kalker 1990,
//! appendix B; Johnson, Contact Mechanics, section 3.6)
//!
//! ```text
//! Axx = ((1 - nu) a + b)/(pi G)       a = integral of y^2/r^3       over the element; x and y are the coordinates
//! Ayy = (a + (1 - nu) b)/(pi G)       b = integral of x^2/r^3       of (X, Y) from a point of the element
//! Axy = Ayx = nu c/(pi G)             c = integral of x y/r^3
//! ```
//!
//! `a + b` is the integral of 1/r, as in the normal coefficients. As there, each range of offsets has its own method:
//!
//! * beyond six half-diagonals d a series in `z = (d/r)^2`, whose terms are polynomials in `t = (X/r)^2`: `a = dx dy/r sum_k z^k a_k(t)`, from
//!   the moments of the element and the derivatives of `y^2/r^3` ([`series`](super::series));
//! * nearer, at two elements or more in one direction, Gauss-Legendre in this direction, and the closed form in the other;
//! * next to the element differences over its corners: `a = [X asinh(Y/|X|)]`, `b = [Y asinh(X/|Y|)]`.
//!
//! c has one formula for all offsets, a product of positive terms without cancellation. X+ and X- are the distances in x from the left and from the
//! right side of the element, Y+ and Y- likewise, and r+- is the length of (X+, Y-):
//!
//! ```text
//! c = (X+^2 - X-^2)(Y+^2 - Y-^2) (r++ + r-+ + r+- + r--) / ((r++ + r-+)(r+- + r--)(r++ + r+-)(r-+ + r--))
//! ```
//!
//! Offsets are in elements and need not be integers, because rolling needs displacements between centres.
use std::array::from_fn;
use std::f64::consts::PI;
use std::sync::Arc;

use super::compliance::Compliance;
use super::near_element::near;
use super::series::{Series, Shape};
use super::tables::Entry;
use crate::influence::SERIES;

/// The number of offsets whose series are summed together, in SIMD lanes.
const LANES: usize = 4;

/// The tangential influence coefficients of two half-spaces, for elements of one size.
#[derive(Clone, Debug)]
pub struct HalfSpace {
    pub dx: f64,
    pub dy: f64,
    pub compliance: Compliance,
    /// The series of a and b, which depend on dx/dy only.
    pub shape: Arc<Shape>,
    /// The series of Axx and Ayy.
    series: [Series; 2],
}

impl HalfSpace {
    /// The coefficients of elements `dx` by `dy`. `shape` has the series of elements with this ratio of sides.
    pub fn new(dx: f64, dy: f64, compliance: Compliance, shape: Arc<Shape>) -> HalfSpace {
        let Compliance { shear, poisson, .. } = compliance;
        let combined = |of: &dyn Fn(f64, f64) -> f64| {
            let mut series = shape.a;
            for (k, polynomial) in series.iter_mut().enumerate() {
                for (j, value) in polynomial.iter_mut().enumerate() {
                    *value = of(shape.a[k][j], shape.b[k][j]) / PI;
                }
            }
            series
        };
        let xx = combined(&|a, b| shear * (a + b) - poisson * a);
        let yy = combined(&|a, b| shear * (a + b) - poisson * b);
        HalfSpace { dx, dy, compliance, shape, series: [xx, yy] }
    }

    /// Axx, Ayy and Axy at an offset in elements.
    pub fn at(&self, x: f64, y: f64) -> Entry {
        let (kx, ky, sign) = (x.abs(), y.abs(), if (x < 0.0) == (y < 0.0) { 1.0 } else { -1.0 });
        let (px, py) = (kx * self.dx, ky * self.dy);
        let beyond = SERIES.map(|(distance, _)| self.is_beyond(distance, px, py));
        let one = |[[xx], [yy]]: [[f64; 1]; 2]| [xx, yy];
        let [xx, yy] = match beyond {
            [false, ..] => self.near(kx, ky),
            [_, false, ..] => one(self.far::<8, 1>([px], py)),
            [_, _, false, _] => one(self.far::<6, 1>([px], py)),
            [.., false] => one(self.far::<4, 1>([px], py)),
            _ => one(self.far::<2, 1>([px], py)),
        };
        [xx, yy, sign * self.mixed(kx, ky)]
    }

    /// Writes the coefficients at the offsets `(0.., ky)`.
    pub fn fill_row(&self, ky: usize, out: &mut [Entry]) {
        // The distance grows along the row, so that each number of terms serves one segment of the row. sK: the first offset for K terms.
        let (y, count) = (ky as f64 * self.dy, out.len());
        let starts = SERIES.map(|(distance, _)| {
            let first = (0..count).position(|kx| self.is_beyond(distance, kx as f64 * self.dx, y));
            first.unwrap_or(count)
        });
        let (near, far) = out.split_at_mut(starts[0]);
        for (kx, entry) in near.iter_mut().enumerate() {
            let [xx, yy] = self.near(kx as f64, ky as f64);
            *entry = [xx, yy, 0.0];
        }
        let [s8, s6, s4, s2] = starts;
        let (far8, rest) = far.split_at_mut(s6 - s8);
        let (far6, rest) = rest.split_at_mut(s4 - s6);
        let (far4, far2) = rest.split_at_mut(s2 - s4);
        self.fill_far::<8>(s8, y, far8);
        self.fill_far::<6>(s6, y, far6);
        self.fill_far::<4>(s4, y, far4);
        self.fill_far::<2>(s2, y, far2);
        if self.compliance.poisson != 0.0 {
            for (kx, entry) in out.iter_mut().enumerate() {
                entry[2] = self.mixed(kx as f64, ky as f64);
            }
        }
    }

    /// Writes Axx and Ayy by the series with K terms after the first, at the offsets `first..` of a row at the distance y.
    fn fill_far<const K: usize>(&self, first: usize, y: f64, out: &mut [Entry]) {
        for (chunk, entries) in out.chunks_mut(LANES).enumerate() {
            let x = from_fn(|lane| (first + LANES * chunk + lane) as f64 * self.dx);
            let [xx, yy] = self.far::<K, LANES>(x, y);
            entries.iter_mut().enumerate().for_each(|(lane, entry)| *entry = [xx[lane], yy[lane], 0.0]);
        }
    }

    /// Whether the point (x, y) is at least this number of half-diagonals away.
    fn is_beyond(&self, half_diagonals: f64, x: f64, y: f64) -> bool {
        0.25 * (self.dx * self.dx + self.dy * self.dy) * (half_diagonals * half_diagonals) <= x * x + y * y
    }

    /// Axx and Ayy by the series with K terms after the first, at L points of one row.
    fn far<const K: usize, const L: usize>(&self, x: [f64; L], y: f64) -> [[f64; L]; 2] {
        let (half_diagonal2, area) = (0.25 * (self.dx * self.dx + self.dy * self.dy), self.dx * self.dy);
        let inverse = x.map(|x| 1.0 / (x * x + y * y));
        let t: [f64; L] = from_fn(|l| x[l] * x[l] * inverse[l]);
        let sum = |series: &Series| {
            let mut sum = [0.0; L];
            for k in (0..=K).rev() {
                let mut value = [series[k][k + 1]; L];
                for j in (0..=k).rev() {
                    value = from_fn(|l| value[l] * t[l] + series[k][j]);
                }
                sum = from_fn(|l| sum[l] * (half_diagonal2 * inverse[l]) + value[l]);
            }
            from_fn(|l| area * inverse[l].sqrt() * sum[l])
        };
        let xx = sum(&self.series[0]);
        // For nu = 0 both are the integral of 1/r.
        let yy = if self.compliance.poisson == 0.0 { xx } else { sum(&self.series[1]) };
        [xx, yy]
    }

    /// Axx and Ayy at an offset `kx, ky >= 0` nearer than the series reaches.
    fn near(&self, kx: f64, ky: f64) -> [f64; 2] {
        let Compliance { shear, poisson, .. } = self.compliance;
        let (a, b) = near(kx, ky, self.dx, self.dy);
        [(shear * (a + b) - poisson * a) / PI, (shear * (a + b) - poisson * b) / PI]
    }

    /// Axy at an offset `kx, ky >= 0`. Lengths are in units of dx, so that products of four of them stay in range.
    fn mixed(&self, kx: f64, ky: f64) -> f64 {
        let aspect = self.dy / self.dx;
        let (xp, xm, yp, ym) = (kx + 0.5, kx - 0.5, (ky + 0.5) * aspect, (ky - 0.5) * aspect);
        let r = |x: f64, y: f64| (x * x + y * y).sqrt();
        let (pp, pm, mp, mm) = (r(xp, yp), r(xp, ym), r(xm, yp), r(xm, ym));
        let squares = 4.0 * kx * ky * (aspect * aspect);
        let c = squares * ((pp + mp) + (pm + mm)) / ((pp + mp) * (pm + mm) * ((pp + pm) * (mp + mm)));
        self.compliance.poisson / PI * (self.dx * c)
    }
}
