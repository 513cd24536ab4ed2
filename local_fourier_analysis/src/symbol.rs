//! The Fourier series of the influence coefficients, on an infinite grid.
//!
//! ```text
//! A(t) = sum over all k of c(k) e^(-i k t)                                    what a wave e^(i k t) is multiplied by
//! L(t) = the same sum over k = (kx, ky) with ky > 0, or ky = 0 and kx > 0     what a lexicographic sweep has updated
//! ```
//!
//! The coefficients fall off like 1/|k|, so that sums of them hardly converge. In closed form, with c = compliance/pi: the Fourier transform of 1/r
//! along x is 2 K0(w |y|). By Poisson's summation formula the row at distance ky is
//!
//! ```text
//! R(ky) = sum over kx of c(kx, ky) e^(-i kx tx) = 2 c sum over m of sinc_m * integral of K0(w_m |y|) over the element in y
//! w_m = |tx + 2 pi m|/dx,    sinc_m = (-1)^m 2 sin(tx/2)/(tx + 2 pi m),    K0(x) = integral over s > 0 of e^(-x cosh s)
//! ```
//!
//! With x = w_m dy cosh s, the integral over y and the sum over ky >= 1 are elementary,
//!
//! ```text
//! sum over ky >= 1 of R(ky) e^(-i ky ty) = 2 c sum over m, integral over s of
//!       sinc_m/(w_m cosh s) * e^(-x/2) (1 - e^(-x)) e^(-i ty)/(1 - e^(-x) e^(-i ty))
//! R(0) = 2 pi c sum over m of sinc_m/w_m - 4 c sum over m, integral over s of sinc_m/(w_m cosh s) e^(-x/2)
//! ```
//!
//! All terms fall off exponentially in m and doubly so in s, where the trapezoidal rule of step H has an error of e^(-pi^2/H) (the nearest poles are
//! at Im s = pi/2). Only the first sum of R(0) converges slowly. It alternates, and is accelerated. The part of L in the own row has the real part
//! (R(0) - c(0,0))/2. The slow terms of its imaginary part are known sums. The error is about 1e-13 of c(0, 0).

use std::f64::consts::PI;

use contact_normal::influence::{HalfSpace, Kernel};
use contact_normal::operator::fft::Complex;

/// Step of the trapezoidal rule in s: e^(-pi^2/H) = 7e-18.
const H: f64 = 0.25;

/// Terms with e^(-x/2) are dropped from here on: 4e-18.
const NEGLIGIBLE: f64 = 80.0;

/// Coefficients of the own row that are summed one by one, for elements no longer in y than in x. The remainder is a sum of terms below 0.1/k^5,
/// 3e-14.
const OWN_ROW: usize = 1000;

/// The symbols of the half-space's coefficients on elements `dx` by `dy`.
pub struct Symbol {
    dx: f64,
    dy: f64,
    /// 1/(pi E*).
    c: f64,
    /// c(0, 0).
    diagonal: f64,
    /// c(k, 0) - alpha/k - beta/k^3, k >= 1.
    own_row: Vec<f64>,
    alpha: f64,
    beta: f64,
}

/// The symbols at one frequency.
#[derive(Clone, Copy, Debug)]
pub struct Value {
    /// A(t), real and positive.
    pub whole: f64,
    /// L(t).
    pub before: Complex<f64>,
}

impl Symbol {
    /// The symbols of elements `dx` by `dy`; `compliance` is `1/E*`.
    pub fn new(dx: f64, dy: f64, compliance: f64) -> Symbol {
        let c = compliance / PI;
        let ratio = dy / dx;
        let half_space = HalfSpace::new(dx, dy, compliance);
        // c(k, 0) = c dx dy/X (1 + (dx^2/12 - dy^2/24)/X^2 + ..), X = k dx: the first terms of its multipole series
        let (alpha, beta) = (c * dy, c * dy * (1.0 / 12.0 - ratio * ratio / 24.0));
        let mut own_row = vec![0.0; OWN_ROW * ratio.max(1.0).ceil() as usize];
        half_space.fill_row(1, 0, &mut own_row);
        for (k, value) in (1..).map(f64::from).zip(&mut own_row) {
            *value -= alpha / k + beta / (k * k * k);
        }
        Symbol { dx, dy, c, diagonal: half_space.at(0, 0), own_row, alpha, beta }
    }

    /// c(0, 0).
    pub fn diagonal(&self) -> f64 {
        self.diagonal
    }

    /// The symbols at `(tx, ty)` for every ty of a list. tx and ty are frequencies per element, any but multiples of 2 pi.
    pub fn row(&self, tx: f64, ty: impl Iterator<Item = f64>) -> Vec<Value> {
        let folded = tx.rem_euclid(2.0 * PI);
        // R is even and the sines are odd.
        let (t, sign) = if folded <= PI { (folded, 1.0) } else { (2.0 * PI - folded, -1.0) };
        let (terms, row_zero) = self.terms(t);
        let own_row = Complex::new(0.5 * (row_zero - self.diagonal), -sign * self.sines(t));
        ty.map(|ty| {
            let turn = Complex::from_polar(1.0, -ty);
            let rows: Complex<f64> = terms.iter().map(|&(weight, decay)| turn * weight / (1.0 - turn * decay)).sum();
            Value { whole: row_zero + 2.0 * rows.re, before: own_row + rows }
        })
        .collect()
    }

    /// The symbols at one frequency.
    pub fn at(&self, tx: f64, ty: f64) -> Value {
        self.row(tx, std::iter::once(ty))[0]
    }

    /// For every m and s the factors `2 c sinc_m/(w_m cosh s) e^(-x/2) (1 - e^(-x))` and `e^(-x)`; and R(0).
    fn terms(&self, t: f64) -> (Vec<(f64, f64)>, f64) {
        let mut terms = Vec::new();
        let alternating = 2.0 * (0.5 * t).sin() * self.dx * (inverse_squares(t) + inverse_squares(2.0 * PI - t));
        let mut row_zero = 2.0 * PI * self.c * alternating;
        // m = 0, -1, 1, -2, 2, ..: growing w_m
        for m in (0..).flat_map(|m| [m, -1 - m]).map(f64::from) {
            let shifted = t + 2.0 * PI * m;
            let w = shifted.abs() / self.dx;
            if m > 0.0 && w * self.dy > NEGLIGIBLE {
                break;
            }
            let sinc = (0.5 * shifted).sin() / (0.5 * shifted);
            for s in (0..).map(|j| H * f64::from(j)) {
                let cosh = s.cosh();
                let x = w * self.dy * cosh;
                if x > NEGLIGIBLE {
                    break;
                }
                let step = if s == 0.0 { 0.5 * H } else { H };
                let weight = 2.0 * self.c * sinc / (w * cosh) * step * (-0.5 * x).exp();
                terms.push((-weight * (-x).exp_m1(), (-x).exp()));
                row_zero -= 2.0 * weight;
            }
        }
        (terms, row_zero)
    }

    /// Sum over k >= 1 of c(k, 0) sin(k t), 0 < t < 2 pi.
    fn sines(&self, t: f64) -> f64 {
        // The sums of sin(k t)/k and of sin(k t)/k^3.
        let (first, third) = (0.5 * (PI - t), t * t * t / 12.0 - 0.25 * PI * t * t + PI * PI * t / 6.0);
        let rest: f64 = (1..).map(f64::from).zip(&self.own_row).map(|(k, value)| value * (k * t).sin()).sum();
        self.alpha * first + self.beta * third + rest
    }
}

/// Sum over m >= 0 of (-1)^m/(t + 2 pi m)^2, to 5.8^-TERMS (Cohen, Rodriguez Villegas and Zagier, Convergence acceleration
/// of alternating series, Experimental Mathematics 9, 2000, algorithm 1).
fn inverse_squares(t: f64) -> f64 {
    const TERMS: i32 = 24;
    let root = (3.0 + 8f64.sqrt()).powi(TERMS);
    let d = 0.5 * (root + 1.0 / root);
    let (mut b, mut weight, mut sum) = (-1.0, -d, 0.0);
    for k in 0..TERMS {
        weight = b - weight;
        sum += weight / (t + 2.0 * PI * f64::from(k)).powi(2);
        b *= f64::from(k + TERMS) * f64::from(k - TERMS) / ((f64::from(k) + 0.5) * f64::from(k + 1));
    }
    sum / d
}
