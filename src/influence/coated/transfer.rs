//! The transfer function of a bonded elastic layer on a half-space (Burmister 1945; Chen & Engel 1972; O'Sullivan & King 1988).
//!
//! A pressure wave of wave number k displaces the surface by `(1 - nu1)/(G1 k) B(k t)` times its amplitude. With `mu = G1/G2`, `s = k t`,
//! `th = exp(-2 s)`,
//!
//! ```text
//! lambda = 1 - 4 (1 - nu1)/(1 + mu (3 - 4 nu2)),     kappa = (mu - 1)/(mu + 3 - 4 nu1)
//! B(s) = N/D,    N = 1 + 4 s kappa th - lambda kappa th^2,    D = 1 - (lambda + kappa + 4 kappa s^2) th + lambda kappa th^2
//! ```
//!
//! B(0) = mu (1 - nu2)/(1 - nu1) is the response of the substrate alone, B(infinity) = 1 that of the layer alone. For small s the terms of N and D
//! cancel, more so for a stiffer layer. Therefore they are written as sums without cancellation, with
//!
//! ```text
//! 1 - lambda kappa = B(0) (1 - lambda)(1 - kappa)
//! N = (1 - lambda kappa) + 2 th (lambda kappa (sinh 2s - 2s) + 2 s kappa (1 + lambda))                      soft
//! N = (1 - lambda kappa) - lambda kappa expm1(-4 s) + 4 s kappa th                                          stiff
//! D = (1 - lambda)(1 - kappa) + ((1 - lambda) kappa th + lambda (1 - kappa)) e + 4 kappa th (sinh^2 s - s^2)    stiff, e = 1 - th
//! ```

use super::response::{quotient, Response, TERMS};
use crate::powers::FADED;

/// Above this s, `exp(-2 s)` is below round-off, and nothing cancels.
pub(super) const NEGLIGIBLE_EXPONENTIALS: f64 = 0.5 * FADED;
/// s above which exp(-2 s) is 0 in double precision.
const ZERO_EXPONENTIALS: f64 = 373.0;

/// The transfer function B of one layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transfer {
    pub(super) lambda: f64,
    pub(super) kappa: f64,
    /// `1 - lambda`, `1 - kappa`, `1 + lambda`, `1 - lambda kappa`.
    pub(super) less_lambda: f64,
    less_kappa: f64,
    more_lambda: f64,
    pub(super) less_both: f64,
    /// B(0).
    pub substrate: f64,
    /// A mean pressure p compresses the layer by `p t/M`, with the oedometric modulus `M = 2 G1 (1 - nu1)/(1 - 2 nu1)`. This is `(G1/(1 - nu1))/M`.
    pub of_mean: f64,
}

impl Transfer {
    /// B of a layer with `mu` times the shear modulus of the substrate; `[nu1, nu2]`: the Poisson ratios of layer and substrate.
    pub fn new(mu: f64, [nu1, nu2]: [f64; 2]) -> Transfer {
        let (one, two) = (1.0 + mu * (3.0 - 4.0 * nu2), mu + 3.0 - 4.0 * nu1);
        let (less_lambda, less_kappa) = (4.0 * (1.0 - nu1) / one, 4.0 * (1.0 - nu1) / two);
        let substrate = mu * (1.0 - nu2) / (1.0 - nu1);
        Transfer {
            lambda: (mu * (3.0 - 4.0 * nu2) - (3.0 - 4.0 * nu1)) / one,
            kappa: (mu - 1.0) / two,
            less_lambda,
            less_kappa,
            more_lambda: (2.0 * mu * (3.0 - 4.0 * nu2) - 2.0 * (1.0 - 2.0 * nu1)) / one,
            less_both: substrate * less_lambda * less_kappa,
            substrate,
            of_mean: 0.5 * (1.0 - 2.0 * nu1) / ((1.0 - nu1) * (1.0 - nu1)),
        }
    }

    /// B(s) - 1 for s >= 1. `grows` is 1 + 2 s for a pressure and 1 - 2 s for a traction.
    pub(super) fn less_one_plain(&self, s: f64, grows: f64) -> f64 {
        if s > ZERO_EXPONENTIALS {
            return 0.0;
        }
        let Transfer { lambda, kappa, .. } = *self;
        let fade = Fade::new(s);
        fade.th * (lambda + kappa * grows.powi(2) - 2.0 * lambda * kappa * fade.th) / self.denominator(s, fade)
    }

    /// D, which is the same for all loads.
    pub(super) fn denominator(&self, s: f64, Fade { th, less }: Fade) -> f64 {
        let Transfer { lambda, kappa, .. } = *self;
        if kappa < 0.0 || s > NEGLIGIBLE_EXPONENTIALS {
            return 1.0 - (lambda + kappa + 4.0 * kappa * s * s) * th + lambda * kappa * th * th;
        }
        // th (sinh^2 s - s^2) = th (sinh s - s) (sinh s - s + 2 s)
        let even = if s <= 1.0 {
            let odd = sinh_less(s);
            th * odd * (odd + 2.0 * s)
        } else {
            0.25 * less * less - s * s * th
        };
        self.less_lambda * self.less_kappa - (self.less_lambda * kappa * th + lambda * self.less_kappa) * less
            + 4.0 * kappa * even
    }

    /// The Taylor coefficients of the quotient of a series with the coefficients `n(k)` by D.
    pub(super) fn over_denominator(&self, n: impl Fn(i32) -> f64) -> [f64; TERMS] {
        let (a, b, c) = (self.less_lambda, self.less_kappa, self.less_both);
        let d = |k: i32| match k {
            0 => a * b,
            _ => {
                let quadratic = if k >= 2 { 4.0 * term(-2.0, k - 2) } else { 0.0 };
                // The limit of infinite stiffness: 4 th (sinh^2 s - s^2), which begins with s^4.
                let stiff = if k < 4 { 0.0 } else { term(-4.0, k) - 2.0 * term(-2.0, k) - quadratic };
                stiff + (a + b) * term(-2.0, k) + b * quadratic - c * term(-4.0, k)
            }
        };
        quotient(n, d)
    }
}

impl Response for Transfer {
    fn at(&self, s: f64) -> f64 {
        if s > NEGLIGIBLE_EXPONENTIALS {
            return 1.0 + self.less_one_plain(s, 1.0 + 2.0 * s);
        }
        let Transfer { lambda, kappa, .. } = *self;
        let fade = Fade::new(s);
        let Fade { th, less } = fade;
        let n = if kappa >= 0.0 && lambda > 0.0 {
            // expm1(-4 s) = less (2 + less)
            self.less_both - lambda * kappa * less * (2.0 + less) + 4.0 * s * kappa * th
        } else {
            self.less_both + 2.0 * (lambda * kappa * fade.odd(s) + 2.0 * s * kappa * self.more_lambda * th)
        };
        n / self.denominator(s, fade)
    }

    fn less_one(&self, s: f64) -> f64 {
        if s >= 1.0 {
            self.less_one_plain(s, 1.0 + 2.0 * s)
        } else {
            self.at(s) - 1.0
        }
    }

    fn substrate(&self) -> f64 {
        self.substrate
    }

    // From the series of N and D in terms of `1 - lambda` and `1 - kappa`, which avoid cancellation for stiff layers.
    fn taylor(&self) -> [f64; TERMS] {
        let n = |k: i32| match k {
            0 => self.less_both,
            _ => 4.0 * self.kappa * term(-2.0, k - 1) - self.lambda * self.kappa * term(-4.0, k),
        };
        self.over_denominator(n)
    }
}

/// `x^k/k!`.
pub(super) fn term(x: f64, k: i32) -> f64 {
    (1..=k).fold(1.0, |product, i| product * x / f64::from(i))
}

/// `th = exp(-2 s)` and `th - 1`, both to full precision.
#[derive(Clone, Copy)]
pub(super) struct Fade {
    pub(super) th: f64,
    pub(super) less: f64,
}

impl Fade {
    pub(super) fn new(s: f64) -> Fade {
        if s < 1.0 {
            let less = (-2.0 * s).exp_m1();
            return Fade { th: 1.0 + less, less };
        }
        let th = (-2.0 * s).exp();
        Fade { th, less: th - 1.0 }
    }

    /// `th (sinh 2s - 2s)`.
    pub(super) fn odd(self, s: f64) -> f64 {
        let Fade { th, less } = self;
        if s <= 0.5 {
            th * sinh_less(2.0 * s)
        } else {
            -0.5 * less * (2.0 + less) - 2.0 * s * th
        }
    }
}

/// `sinh x - x`, for x of 0 to 1.
fn sinh_less(x: f64) -> f64 {
    // x^3/3! (1 + x^2/(4 5) (1 + x^2/(6 7) (...)))
    let series = (2..=9).rev().fold(1.0, |sum, k| 1.0 + x * x / f64::from(2 * k * (2 * k + 1)) * sum);
    x * x * x / 6.0 * series
}
