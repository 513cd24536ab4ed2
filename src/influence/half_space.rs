//! Boussinesq-Love coefficients of the elastic half-space.
//!
//! With `c = 1/(pi E*)`, `1/E* = sum over both bodies of (1 - nu)/(2 G)`, the coefficient at offset `(X, Y)` is
//!
//! ```text
//! A(X, Y) = c * integral over |s| <= dx/2, |t| <= dy/2 of 1/sqrt((X - s)^2 + (Y - t)^2)
//!         = c * [F(X+, Y+) - F(X+, Y-) - F(X-, Y+) + F(X-, Y-)],     X+- = X +- dx/2, Y+- = Y +- dy/2
//! F(a, b) = a asinh(b/|a|) + b asinh(a/|b|)
//! ```
//!
//! (Love 1929; Johnson, Contact Mechanics, eq. 3.25). The closed form suffers from cancellation: at offset `k` it loses a factor `k^2` of
//! accuracy. Therefore it is used only at the four offsets with kx, ky <= 1. At other offsets there are two methods:
//!
//! * Beyond six half-diagonals `d`, a multipole series. With `r^2 = X^2 + Y^2`, `z = (d/r)^2`, `t = (X/r)^2` it is `A = c dx dy / r * sum_k z^k
//!   q_k(t)`, where `z^k q_k` is the mean over the element of the Legendre term of degree `2k`.
//! * Nearer, the closed form in one direction and Gauss-Legendre quadrature in the other. The closed form `asinh(X+/|y|) - asinh(X-/|y|)` is
//!   written as one logarithm of positive terms. Its singularity y = 0 is at least three half-widths away from the interval of the quadrature.

use std::cell::RefCell;
use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

use super::gauss::gauss;
use super::kernel::Kernel;
use crate::error::Result;
use crate::grid::Grid;
use crate::powers::{apart, times_power};
use crate::threads::made_once;

/// Pairs of a distance in half-diagonals and a number K: from this distance on the terms `k <= K` of the multipole series suffice. The first
/// omitted term is `z^(K+1) <= 2e-15` (1e-14 at the first distance, where `|q_9| < 0.1`).
pub const SERIES: [(f64, usize); 4] = [(6.0, 8), (12.0, 6), (40.0, 4), (300.0, 2)];
/// The largest k of the multipole series (degree `2 * 8 = 16`).
pub const MOST_TERMS: usize = SERIES[0].1;

/// The sizes of quadrants of coefficients that are computed and kept, once a grid needs a part of one. Computing a quadrant takes as long as a
/// product or more. The operators of a grid, of its windows and of coarser grids, preconditioners and the next solver need the same coefficients.
/// All quadrants of one shape have at most 4.4 MB. A quadrant within one that is kept is not computed.
const QUADRANTS: [usize; 12] = [8, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512];

/// The largest quadrant that is computed as a whole, even if only a small part of it is needed.
const SMALL_QUADRANT: usize = 64;

/// The Boussinesq-Love coefficients of an elastic half-space on elements of one size.
#[derive(Clone, Debug)]
pub struct HalfSpace {
    /// The sides of an element.
    pub(super) dx: f64,
    pub(super) dy: f64,
    /// `c = 1/(pi E*)`.
    pub(super) compliance: f64,
    shape: Arc<Shape>,
}

/// The coefficients of all elements with one ratio dx/dy: if an element is twice as long and twice as wide, its coefficients are twice as large.
/// They are stored as integrals of 1/rho over an element, relative to its length in x.
#[derive(Debug)]
struct Shape {
    /// The sides of the element, scaled such that the longer one is near 1.
    dx: f64,
    dy: f64,
    /// `q_k(t) = sum_j series[k][j] t^j`.
    series: [[f64; MOST_TERMS + 1]; MOST_TERMS + 1],
    /// The [`QUADRANTS`] that are computed so far, row by row.
    quadrants: [OnceLock<Vec<f64>>; QUADRANTS.len()],
}

/// A computed shape, and the scaled sides of its element.
struct Computed {
    element: (f64, f64),
    shape: Arc<Shape>,
}

thread_local! {
    /// The last shape of this thread. Computing a shape takes as long as the rest of the set-up of a small grid, and most programs have one
    /// element size.
    static LAST: RefCell<Option<Computed>> = const { RefCell::new(None) };
}

impl Shape {
    /// The shape of an element `dx` by `dy`: the last one of this thread if its scaled sides are the same, otherwise a new one.
    fn of(dx: f64, dy: f64) -> Arc<Shape> {
        let (_, unit) = apart(dx.max(dy));
        let [dx, dy] = [dx, dy].map(|side| times_power(side, -unit));
        let kept = LAST.try_with(|last| match &mut *last.borrow_mut() {
            Some(last) if last.element == (dx, dy) => last.shape.clone(),
            last => last.insert(Computed { element: (dx, dy), shape: Arc::new(Shape::new(dx, dy)) }).shape.clone(),
        });
        // At the end of a thread its thread-local memory may be gone already.
        kept.unwrap_or_else(|_| Arc::new(Shape::new(dx, dy)))
    }

    /// The shape of an element with these scaled sides, without quadrants.
    fn new(dx: f64, dy: f64) -> Shape {
        Shape { dx, dy, series: multipole_series(dx, dy), quadrants: Default::default() }
    }

    /// The coefficients at the offsets `(0..end, ky)`, if a quadrant with them is kept or worth computing.
    fn kept(&self, end: usize, ky: usize) -> Option<&[f64]> {
        let large_enough = || QUADRANTS.iter().zip(&self.quadrants).filter(|(size, _)| **size >= end.max(ky + 1));
        let known = large_enough().find_map(|(size, quadrant)| Some((size, quadrant.get()?)));
        let (size, quadrant) = known.or_else(|| {
            // A large quadrant costs more than it saves if only a small part of it is needed, for example on a long grid or for one coefficient.
            let worthwhile = |size: usize| size <= SMALL_QUADRANT || end.min(ky + 1) >= size / 4;
            let (size, quadrant) = large_enough().next().filter(|(size, _)| worthwhile(**size))?;
            Some((size, made_once(quadrant, || self.quadrant(*size))))
        })?;
        quadrant.get(ky * size..)?.get(..end)
    }

    /// Computes the quadrant of offsets below `size`. It is empty if there is no memory for it.
    fn quadrant(&self, size: usize) -> Vec<f64> {
        let mut quadrant = Vec::new();
        if quadrant.try_reserve_exact(size * size).is_ok() {
            quadrant.resize(size * size, 0.0);
            quadrant.chunks_exact_mut(size).enumerate().for_each(|(ky, row)| self.fill_row(0, ky, row));
        }
        quadrant
    }

    /// Computes the coefficients at the offsets `(kx.., ky)`.
    fn fill_row(&self, kx: usize, ky: usize, out: &mut [f64]) {
        let y = ky as f64 * self.dy;
        let half_diagonal2 = 0.25 * (self.dx * self.dx + self.dy * self.dy);
        // The distance grows along the row, so each segment has its own number of terms.
        let first_beyond = |half_diagonals: f64| {
            let x2 = half_diagonals * half_diagonals * half_diagonal2 - y * y;
            let k = if x2 > 0.0 { (x2.sqrt() / self.dx).ceil() as i64 - kx as i64 } else { 0 };
            k.clamp(0, out.len() as i64) as usize
        };
        let starts = SERIES.map(|(distance, _)| first_beyond(distance));
        let (near, far) = out.split_at_mut(starts[0]);
        for (value, kx) in near.iter_mut().zip(kx..) {
            *value = integral_at((kx as f64, ky as f64), (self.dx, self.dy)) / self.dx;
        }
        let [s8, s6, s4, s2] = starts;
        let (far8, rest) = far.split_at_mut(s6 - s8);
        let (far6, rest) = rest.split_at_mut(s4 - s6);
        let (far4, far2) = rest.split_at_mut(s2 - s4);
        let arch = pulp::Arch::new();
        let at = |s: usize| (kx + s) as f64;
        arch.dispatch(SeriesSegment::<8> { shape: self, kx: at(s8), y, out: far8 });
        arch.dispatch(SeriesSegment::<6> { shape: self, kx: at(s6), y, out: far6 });
        arch.dispatch(SeriesSegment::<4> { shape: self, kx: at(s4), y, out: far4 });
        arch.dispatch(SeriesSegment::<2> { shape: self, kx: at(s2), y, out: far2 });
    }
}

/// Computes a part of a row by the series with the terms `k <= K`. pulp compiles it for the vector instructions of the machine; the results are
/// the same, bit for bit, on any machine.
struct SeriesSegment<'a, const K: usize> {
    shape: &'a Shape,
    kx: f64,
    y: f64,
    out: &'a mut [f64],
}

impl<const K: usize> pulp::NullaryFnOnce for SeriesSegment<'_, K> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let SeriesSegment { shape, kx, y, out } = self;
        // Copies, so that the compiler knows that writes to `out` do not change them.
        let (dx, dy, series) = (shape.dx, shape.dy, shape.series);
        let half_diagonal2 = 0.25 * (dx * dx + dy * dy);
        for (k, value) in out.iter_mut().enumerate() {
            let x = (kx + k as f64) * dx;
            let r2 = x * x + y * y;
            let inverse_r2 = 1.0 / r2;
            let (t, z) = (x * x * inverse_r2, half_diagonal2 * inverse_r2);
            let mut sum = 0.0;
            for term in (0..=K).rev() {
                let mut q = series[term][term];
                for j in (0..term).rev() {
                    q = q * t + series[term][j];
                }
                sum = sum * z + q;
            }
            *value = dy * sum * inverse_r2.sqrt();
        }
    }
}

impl HalfSpace {
    /// The coefficients for elements `dx` by `dy`. `compliance` is `1/E* = sum of (1 - nu)/(2 G)` over the bodies.
    pub fn new(dx: f64, dy: f64, compliance: f64) -> HalfSpace {
        HalfSpace { dx, dy, compliance: compliance / PI, shape: Shape::of(dx, dy) }
    }

    /// The coefficients of the same bodies for another element size. The shape is shared if the ratio dx/dy is the same.
    pub fn for_element(&self, dx: f64, dy: f64) -> HalfSpace {
        let shape = if dx / self.dx == dy / self.dy { self.shape.clone() } else { Shape::of(dx, dy) };
        HalfSpace { dx, dy, compliance: self.compliance, shape }
    }
}

/// The shape is not compared, because it follows from the element.
impl PartialEq for HalfSpace {
    fn eq(&self, other: &HalfSpace) -> bool {
        (self.dx, self.dy, self.compliance) == (other.dx, other.dy, other.compliance)
    }
}

impl Kernel for HalfSpace {
    fn at(&self, kx: i64, ky: i64) -> f64 {
        let mut value = [0.0];
        self.fill_row(kx.abs(), ky, &mut value);
        value[0]
    }

    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        debug_assert!(kx >= 0);
        let (kx, ky, scale) = (kx as usize, ky.unsigned_abs() as usize, self.compliance * self.dx);
        if let Some(kept) = self.shape.kept(kx + out.len(), ky) {
            out.iter_mut().zip(&kept[kx..]).for_each(|(value, kept)| *value = scale * kept);
            return;
        }
        self.shape.fill_row(kx, ky, out);
        out.iter_mut().for_each(|value| *value *= scale);
    }

    fn coarsen(&self, _fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>> {
        Ok(Arc::new(self.for_element(coarse.dx, coarse.dy)))
    }
}

/// The integral of 1/rho over an element `dx` by `dy`. Its centre has the offset `(kx, ky) >= 0` from the origin, in elements; offsets need not
/// be integers.
pub(crate) fn integral_at((kx, ky): (f64, f64), (dx, dy): (f64, f64)) -> f64 {
    if ky >= 2.0 {
        gauss(ky * dy, dy, |y| line(kx, dx, y))
    } else if kx >= 2.0 {
        gauss(kx * dx, dx, |x| line(ky, dy, x))
    } else {
        let (xp, xm, yp, ym) = ((kx + 0.5) * dx, (kx - 0.5) * dx, (ky + 0.5) * dy, (ky - 0.5) * dy);
        let half = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() };
        let f = |a: f64, b: f64| half(a, b) + half(b, a);
        f(xp, yp) - f(xp, ym) - f(xm, yp) + f(xm, ym)
    }
}

/// `integral over |s| <= d/2 of 1/sqrt((k d - s)^2 + y^2) = asinh(X+/y) - asinh(X-/y)`, computed without cancellation.
fn line(k: f64, d: f64, y: f64) -> f64 {
    let (plus, minus) = ((k + 0.5) * d, (k - 0.5) * d);
    if k == 0.0 {
        return 2.0 * (plus / y).asinh();
    }
    let (rp, rm) = (plus.hypot(y), minus.hypot(y));
    // (X+ + r+)/(X- + r-) - 1, with r+ - r- = (X+^2 - X-^2)/(r+ + r-)
    let near = if minus < 0.0 { y * (y / (rm - minus)) } else { minus + rm };
    ((d + (plus + minus) * d / (rp + rm)) / near).ln_1p()
}

/// The coefficients of the polynomials `q_k(t)`: the means over the element of `|s|^n P_n(cos)`, `n = 2k`, in units of the half-diagonal.
fn multipole_series(dx: f64, dy: f64) -> [[f64; MOST_TERMS + 1]; MOST_TERMS + 1] {
    let diagonal = dx.hypot(dy);
    let (hx, hy) = (dx / diagonal, dy / diagonal);
    // mean of s^(2i) over |s| <= h
    let moment = |h: f64, i: usize| h.powi(2 * i as i32) / (2 * i + 1) as f64;
    let mut series = [[0.0; MOST_TERMS + 1]; MOST_TERMS + 1];
    for (k, q) in series.iter_mut().enumerate() {
        let n = 2 * k;
        for l in 0..=k {
            // P_n(x) = sum_l legendre(l) x^(n - 2l)
            let legendre = (if l % 2 == 0 { 1.0 } else { -1.0 }) * binomial(n, l) * binomial(2 * n - 2 * l, n)
                / 2f64.powi(n as i32);
            let m = k - l; // (sx cx + sy cy)^(2m) (sx^2 + sy^2)^l, even powers only
            for j in 0..=m {
                let mean: f64 = (0..=l).map(|i| binomial(l, i) * moment(hx, j + i) * moment(hy, m - j + l - i)).sum();
                let coefficient = legendre * binomial(2 * m, 2 * j) * mean;
                // times t^j (1 - t)^(m - j)
                for i in 0..=m - j {
                    let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
                    q[j + i] += sign * coefficient * binomial(m - j, i);
                }
            }
        }
    }
    series
}

fn binomial(n: usize, k: usize) -> f64 {
    (1..=k).fold(1.0, |b, i| b * (n - k + i) as f64 / i as f64)
}
