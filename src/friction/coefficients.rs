//! Influence coefficients of tangential tractions: the displacement difference at a point by a unit traction on one element.
//!
//! With both bodies' `1/G = (1/G1 + 1/G2)/2` and `nu/G = (nu1/G1 + nu2/G2)/2`, at the offset `(X, Y)` from the centre of the element
//! (Kalker 1990, appendix B; Johnson, Contact Mechanics, section 3.6)
//!
//! ```text
//! Axx = ((1 - nu) a + b)/(pi G)       a = integral of y^2/r^3       over the element, x and y from there to (X, Y)
//! Ayy = (a + (1 - nu) b)/(pi G)       b = integral of x^2/r^3
//! Axy = Ayx = nu c/(pi G)             c = integral of x y/r^3
//! ```
//!
//! `a + b` is the integral of 1/r, which the normal coefficients are made of, and as there three ways of summation share the offsets:
//!
//! * beyond six half-diagonals d a series in `z = (d/r)^2`, whose terms are polynomials in `t = (X/r)^2`:
//!   `a = dx dy/r sum_k z^k a_k(t)`, from the moments of the element and the derivatives of `y^2/r^3`;
//! * nearer, where the offset is two elements or more in one direction, the integral is exact in the other direction and by
//!   Gauss-Legendre in this one;
//! * next to the element `a = [X asinh(Y/|X|)]`, `b = [Y asinh(X/|Y|)]`, differences over its corners.
//!
//! c needs no series: as a difference of distances it is a product of positive terms, without cancellation,
//!
//! ```text
//! c = (X+^2 - X-^2)(Y+^2 - Y-^2) (1/(r++ + r-+) + 1/(r+- + r--)) / ((r++ + r+-)(r-+ + r--))
//! ```
//!
//! Offsets are in elements and need not be whole: rolling asks for displacements between the centres.

use std::f64::consts::PI;
use std::sync::Arc;

use super::tables::Tables;
use crate::effects::TangentialInfluence;
use crate::error::Result;
use crate::influence::gauss;
use crate::scene::Bodies;

/// The coefficients of one offset: `Axx, Ayy, Axy`.
pub type Entry = [f64; 3];

/// Terms of the series at most.
const MOST_TERMS: usize = 8;

/// `(distance in half-diagonals, K)`: from this distance on the terms `k <= K` suffice, as for the normal coefficients.
const SERIES: [(f64, usize); 4] = [(6.0, 8), (12.0, 6), (40.0, 4), (300.0, 2)];

/// Polynomials `p_k(t) = sum_j series[k][j] t^j`.
type Series = [[f64; MOST_TERMS + 2]; MOST_TERMS + 1];

/// What the bodies' materials make of tractions: `1/G`, `nu/G` and `K/G` of both together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compliance {
    /// `1/G = (1/G1 + 1/G2)/2`.
    pub shear: f64,
    /// `nu/G = (nu1/G1 + nu2/G2)/2`.
    pub poisson: f64,
    /// `K/G = ((1 - 2 nu1)/G1 - (1 - 2 nu2)/G2)/4`: 0 for like bodies, whose normal and tangential problems are independent.
    pub unlike: f64,
}

impl Compliance {
    /// Of two bodies.
    pub fn of(bodies: &Bodies) -> Compliance {
        let Bodies { shear_modulus: [g1, g2], poisson_ratio: [nu1, nu2] } = *bodies;
        Compliance {
            shear: 0.5 * (1.0 / g1 + 1.0 / g2),
            poisson: 0.5 * (nu1 / g1 + nu2 / g2),
            unlike: 0.25 * ((1.0 - 2.0 * nu1) / g1 - (1.0 - 2.0 * nu2) / g2),
        }
    }
}

/// Tangential coefficients for one element size.
#[derive(Clone, Debug)]
pub struct Tangential {
    dx: f64,
    dy: f64,
    compliance: Compliance,
    shape: Arc<Shape>,
    /// The series of Axx and Ayy.
    series: [Series; 2],
    /// The caller's own, in place of these.
    own: Option<Tables>,
}

/// The series of a and b, which depend on the ratio dx/dy only.
#[derive(Debug)]
struct Shape {
    a: Series,
    b: Series,
}

impl Tangential {
    /// Coefficients of elements `dx` by `dy`.
    pub fn new(dx: f64, dy: f64, compliance: Compliance) -> Tangential {
        Tangential::of_shape(dx, dy, compliance, Arc::new(Shape::new(dx, dy)))
    }

    fn of_shape(dx: f64, dy: f64, compliance: Compliance, shape: Arc<Shape>) -> Tangential {
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
        Tangential { dx, dy, compliance, shape: shape.clone(), series: [xx, yy], own: None }
    }

    /// The caller's own coefficients, for elements `dx` by `dy`.
    pub fn of_tables(dx: f64, dy: f64, influence: &TangentialInfluence<'_>) -> Result<Tangential> {
        let no_bodies = Compliance { shear: 1.0, poisson: 0.0, unlike: 0.0 };
        Ok(Tangential { own: Some(Tables::new(influence)?), ..Tangential::new(dx, dy, no_bodies) })
    }

    /// Whether these are the caller's own, or there are none, as `influence` says.
    pub fn are_of(&self, influence: Option<&TangentialInfluence<'_>>) -> bool {
        match (&self.own, influence) {
            (Some(own), Some(influence)) => own.are_of(influence),
            (own, influence) => own.is_none() && influence.is_none(),
        }
    }

    /// The same bodies, another element size; own tables are coarsened where elements are larger.
    pub fn for_element(&self, dx: f64, dy: f64) -> Result<Tangential> {
        let same_shape = dx / self.dx == dy / self.dy;
        let shape = if same_shape { self.shape.clone() } else { Arc::new(Shape::new(dx, dy)) };
        let own = self.own.as_ref().map(|own| own.coarsened(dx > self.dx, dy > self.dy)).transpose()?;
        Ok(Tangential { own, ..Tangential::of_shape(dx, dy, self.compliance, shape) })
    }

    /// What the materials make of tractions.
    pub fn compliance(&self) -> Compliance {
        self.compliance
    }

    /// The coefficients at an offset, in elements; of own tables at the next whole one.
    pub fn at(&self, x: f64, y: f64) -> Entry {
        if let Some(own) = &self.own {
            return own.at(x.round() as i64, y.round() as i64);
        }
        let (kx, ky, sign) = (x.abs(), y.abs(), if (x < 0.0) == (y < 0.0) { 1.0 } else { -1.0 });
        let (dx, dy) = (self.dx, self.dy);
        let Compliance { shear, poisson, .. } = self.compliance;
        let xy = sign * poisson / PI * mixed(kx, ky, dx, dy);
        let (px, py) = (kx * dx, ky * dy);
        let (r2, half_diagonal2) = (px * px + py * py, 0.25 * (dx * dx + dy * dy));
        let z = half_diagonal2 / r2;
        let beyond = |s: usize| z * (SERIES[s].0 * SERIES[s].0) <= 1.0;
        if !beyond(0) {
            let (a, b) = near(kx, ky, dx, dy);
            return [(shear * (a + b) - poisson * a) / PI, (shear * (a + b) - poisson * b) / PI, xy];
        }
        let t = px * px / r2;
        let sums = match (beyond(1), beyond(2), beyond(3)) {
            (false, ..) => self.sums::<8>(z, t),
            (_, false, _) => self.sums::<6>(z, t),
            (_, _, false) => self.sums::<4>(z, t),
            _ => self.sums::<2>(z, t),
        };
        let scale = dx * dy / r2.sqrt();
        [scale * sums[0], scale * sums[1], xy]
    }

    fn sums<const K: usize>(&self, z: f64, t: f64) -> [f64; 2] {
        self.series.each_ref().map(|series| {
            let mut sum = 0.0;
            for k in (0..=K).rev() {
                let mut value = series[k][k + 1];
                for j in (0..=k).rev() {
                    value = value * t + series[k][j];
                }
                sum = sum * z + value;
            }
            sum
        })
    }
}

/// c at an offset `kx, ky >= 0`.
fn mixed(kx: f64, ky: f64, dx: f64, dy: f64) -> f64 {
    let (xp, xm, yp, ym) = ((kx + 0.5) * dx, (kx - 0.5) * dx, (ky + 0.5) * dy, (ky - 0.5) * dy);
    let r = |x: f64, y: f64| (x * x + y * y).sqrt();
    let (pp, pm, mp, mm) = (r(xp, yp), r(xp, ym), r(xm, yp), r(xm, ym));
    let squares = (2.0 * kx * dx * dx) * (2.0 * ky * dy * dy);
    if squares == 0.0 {
        return 0.0;
    }
    squares * (1.0 / (pp + mp) + 1.0 / (pm + mm)) / ((pp + pm) * (mp + mm))
}

/// a and b at an offset `kx, ky >= 0` nearer than the series reaches.
fn near(kx: f64, ky: f64, dx: f64, dy: f64) -> (f64, f64) {
    if ky >= 2.0 {
        let a = gauss(ky * dy, dy, |y| along(kx, dx, y).0);
        let sum = gauss(ky * dy, dy, |y| along(kx, dx, y).1);
        (a, sum - a)
    } else if kx >= 2.0 {
        let b = gauss(kx * dx, dx, |x| along(ky, dy, x).0);
        let sum = gauss(kx * dx, dx, |x| along(ky, dy, x).1);
        (sum - b, b)
    } else {
        let (xp, xm, yp, ym) = ((kx + 0.5) * dx, (kx - 0.5) * dx, (ky + 0.5) * dy, (ky - 0.5) * dy);
        let f = |x: f64, y: f64| if x == 0.0 { 0.0 } else { x * (y / x.abs()).asinh() };
        let corners = |f: &dyn Fn(f64, f64) -> f64| f(xp, yp) - f(xp, ym) - f(xm, yp) + f(xm, ym);
        (corners(&f), corners(&|x, y| f(y, x)))
    }
}

/// Over `x` in an interval of length d about k d, at the distance y: the integrals of `y^2/r^3`, `[x/r]`, and of `1/r`,
/// `[asinh(x/y)]`, without cancellation.
fn along(k: f64, d: f64, y: f64) -> (f64, f64) {
    let (plus, minus) = ((k + 0.5) * d, (k - 0.5) * d);
    let (rp, rm) = (plus.hypot(y), minus.hypot(y));
    if minus < 0.0 {
        return (plus / rp - minus / rm, (plus / y).asinh() - (minus / y).asinh());
    }
    let squares = (plus + minus) * d;
    let sine = y * y * squares / (rp * rm * (plus * rm + minus * rp));
    (sine, ((d + squares / (rp + rm)) / (minus + rm)).ln_1p())
}

impl Shape {
    fn new(dx: f64, dy: f64) -> Shape {
        Shape { a: series(dx, dy, [1.0, 0.0, 0.0]), b: series(dx, dy, [0.0, 0.0, 1.0]) }
    }
}

/// A homogeneous polynomial `sum_p c[p] X^p Y^(degree - p)` over `r^power`.
#[derive(Clone)]
struct Fraction {
    coefficients: Vec<f64>,
    power: f64,
}

impl Fraction {
    /// `d/dX (N/r^m) = (N_X r^2 - m X N)/r^(m + 2)`, or the same in Y.
    fn derivative(&self, in_x: bool) -> Fraction {
        let degree = self.coefficients.len() - 1;
        let mut coefficients = vec![0.0; degree + 2];
        for (p, c) in self.coefficients.iter().enumerate() {
            let exponent = if in_x { p } else { degree - p } as f64;
            // Of X^p Y^q: X^(p+1) Y^q and X^(p-1) Y^(q+2), or X^p Y^(q+1) and X^(p+2) Y^(q-1).
            let (raised, crossed) = if in_x { (p + 1, p.wrapping_sub(1)) } else { (p, p + 2) };
            coefficients[raised] += (exponent - self.power) * c;
            if exponent > 0.0 {
                coefficients[crossed] += exponent * c;
            }
        }
        Fraction { coefficients, power: self.power + 2.0 }
    }
}

/// The polynomials of the mean over the element of `N(X, Y)/r^3`, N of degree 2: the sum of
/// `hx^(2i) hy^(2j)/((2i + 1)! (2j + 1)!)` times the derivatives of order 2i in X and 2j in Y, half-widths in units of the
/// half-diagonal.
fn series(dx: f64, dy: f64, numerator: [f64; 3]) -> Series {
    let diagonal = dx.hypot(dy);
    let moment = |h: f64, i: usize| (2..=2 * i + 1).fold(h.powi(2 * i as i32), |m, k| m / k as f64);
    let mut series = [[0.0; MOST_TERMS + 2]; MOST_TERMS + 1];
    let mut in_x = Fraction { coefficients: numerator.to_vec(), power: 3.0 };
    for i in 0..=MOST_TERMS {
        let mut term = in_x.clone();
        for j in 0..=MOST_TERMS - i {
            let factor = moment(dx / diagonal, i) * moment(dy / diagonal, j);
            add_in_t(&term.coefficients, factor, &mut series[i + j]);
            term = term.derivative(false).derivative(false);
        }
        in_x = in_x.derivative(true).derivative(true);
    }
    series
}

/// Adds `factor sum_p c[p] X^p Y^(2m - p)`, p even, as a polynomial in `t = X^2 = 1 - Y^2`.
fn add_in_t(coefficients: &[f64], factor: f64, polynomial: &mut [f64]) {
    let m = (coefficients.len() - 1) / 2;
    for half in 0..=m {
        let (c, rest) = (factor * coefficients[2 * half], m - half);
        let mut binomial = 1.0;
        for i in 0..=rest {
            polynomial[half + i] += if i % 2 == 0 { c } else { -c } * binomial;
            binomial *= (rest - i) as f64 / (i + 1) as f64;
        }
    }
}
