//! The series of the integrals a and b of [`half_space`](super::half_space) far from an element: a polynomial in `t = (X/r)^2` for each power of
//! `z = (d/r)^2`, where d is half of the element's diagonal.

use crate::influence::MOST_TERMS;

/// The polynomials `p_k(t) = sum_j series[k][j] t^j` of the series `dx dy/r sum_k z^k p_k(t)`.
pub type Series = [[f64; MOST_TERMS + 2]; MOST_TERMS + 1];

/// The series of a and b for elements of one shape: they depend on the ratio dx/dy only.
#[derive(Debug)]
pub struct Shape {
    /// The series of `a`, the integral of `y^2/r^3`.
    pub a: Series,
    /// The series of `b`, the integral of `x^2/r^3`.
    pub b: Series,
}

impl Shape {
    /// Computes the series of elements `dx` by `dy`.
    pub fn new(dx: f64, dy: f64) -> Shape {
        Shape { a: series(dx, dy, [1.0, 0.0, 0.0]), b: series(dx, dy, [0.0, 0.0, 1.0]) }
    }
}

/// The function `N(X, Y)/r^power` with the homogeneous polynomial `N = sum_p coefficients[p] X^p Y^(degree - p)`.
#[derive(Clone)]
struct Fraction {
    coefficients: Vec<f64>,
    power: f64,
}

impl Fraction {
    /// The derivative by X, `(N_X r^2 - m X N)/r^(m + 2)` with m the power, or the derivative by Y likewise.
    fn derivative(&self, in_x: bool) -> Fraction {
        let degree = self.coefficients.len() - 1;
        let mut coefficients = vec![0.0; degree + 2];
        for (p, c) in self.coefficients.iter().enumerate() {
            let exponent = if in_x { p } else { degree - p } as f64;
            // X^p Y^q becomes X^(p+1) Y^q and X^(p-1) Y^(q+2), or X^p Y^(q+1) and X^(p+2) Y^(q-1).
            let (raised, crossed) = if in_x { (p + 1, p.wrapping_sub(1)) } else { (p, p + 2) };
            coefficients[raised] += (exponent - self.power) * c;
            if exponent > 0.0 {
                coefficients[crossed] += exponent * c;
            }
        }
        Fraction { coefficients, power: self.power + 2.0 }
    }
}

/// The series of the mean over the element of `N(X, Y)/r^3`, N of degree 2 with these coefficients. By Taylor's expansion the mean is the sum of
/// `hx^(2i) hy^(2j)/((2i + 1)! (2j + 1)!)` times the derivatives of order 2i in X and 2j in Y. hx and hy are half of the sides, in units of half of
/// the diagonal.
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

/// Adds `factor sum_p coefficients[p] X^p Y^(2m - p)`, p even, on the circle r = 1, as a polynomial in `t = X^2 = 1 - Y^2`.
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
