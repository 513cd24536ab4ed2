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
//! B(0) = mu (1 - nu2)/(1 - nu1) is the response of the substrate alone, B(infinity) = 1 that of the layer alone. For small s the terms of D
//! cancel if the layer is stiff, and those of N if it is stiff or soft. There N and D are written as sums without cancellation. For N a layer is
//! stiff if kappa >= 0 and lambda > 0, for D if kappa >= 0. The terms of a soft layer's D do not cancel.
//!
//! ```text
//! 1 - lambda kappa = B(0) (1 - lambda)(1 - kappa)
//! N = (1 - lambda kappa) + 2 th (lambda kappa (sinh 2s - 2s) + 2 s kappa (1 + lambda))                      soft
//! N = (1 - lambda kappa) - lambda kappa expm1(-4 s) + 4 s kappa th                                          stiff
//! D = (1 - lambda)(1 - kappa) + ((1 - lambda) kappa th + lambda (1 - kappa)) e + 4 kappa th (sinh^2 s - s^2)    stiff, e = 1 - th
//! ```

use super::response::{quotient, Response, TERMS};
use crate::powers::FADED;

/// Above this s, `exp(-2 s)` is below round-off, so that N and D have no cancellation.
pub(super) const NEGLIGIBLE_EXPONENTIALS: f64 = 0.5 * FADED;
/// Above this s, exp(-2 s) is 0 in double precision.
const ZERO_EXPONENTIALS: f64 = 373.0;

/// The transfer function B of one layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transfer {
    pub(super) lambda: f64,
    pub(super) kappa: f64,
    /// `1 - lambda`. This difference and the following ones are stored because they are computed without cancellation.
    pub(super) one_minus_lambda: f64,
    /// `1 - kappa`.
    one_minus_kappa: f64,
    /// `1 + lambda`.
    one_plus_lambda: f64,
    /// `1 - lambda kappa`.
    pub(super) one_minus_product: f64,
    /// B(0), the response of the substrate alone.
    pub substrate: f64,
    /// The compression of the layer by a uniform pressure p is `p t/M`, with the oedometric modulus `M = 2 G1 (1 - nu1)/(1 - 2 nu1)`. This field
    /// is `(G1/(1 - nu1))/M`.
    pub of_mean: f64,
}

impl Transfer {
    /// The transfer function of a layer whose shear modulus is `mu` times the substrate's. `nu1` and `nu2` are the Poisson ratios of layer and
    /// substrate.
    pub fn new(mu: f64, [nu1, nu2]: [f64; 2]) -> Transfer {
        let (one, two) = (1.0 + mu * (3.0 - 4.0 * nu2), mu + 3.0 - 4.0 * nu1);
        let (one_minus_lambda, one_minus_kappa) = (4.0 * (1.0 - nu1) / one, 4.0 * (1.0 - nu1) / two);
        let substrate = mu * (1.0 - nu2) / (1.0 - nu1);
        Transfer {
            lambda: (mu * (3.0 - 4.0 * nu2) - (3.0 - 4.0 * nu1)) / one,
            kappa: (mu - 1.0) / two,
            one_minus_lambda,
            one_minus_kappa,
            one_plus_lambda: (2.0 * mu * (3.0 - 4.0 * nu2) - 2.0 * (1.0 - 2.0 * nu1)) / one,
            one_minus_product: substrate * one_minus_lambda * one_minus_kappa,
            substrate,
            of_mean: 0.5 * (1.0 - 2.0 * nu1) / ((1.0 - nu1) * (1.0 - nu1)),
        }
    }

    /// B(s) - 1 = (N - D)/D for s >= 1, where the terms of N - D do not cancel. `factor` is 1 + 2 s for a pressure and 1 - 2 s for a traction.
    pub(super) fn less_one_by_exponentials(&self, s: f64, factor: f64) -> f64 {
        if s > ZERO_EXPONENTIALS {
            return 0.0;
        }
        let Transfer { lambda, kappa, .. } = *self;
        let fade = Fade::new(s);
        fade.th * (lambda + kappa * factor.powi(2) - 2.0 * lambda * kappa * fade.th) / self.denominator(s, fade)
    }

    /// The denominator D, which is the same for pressures and tractions.
    pub(super) fn denominator(&self, s: f64, Fade { th, th_minus_1 }: Fade) -> f64 {
        let Transfer { lambda, kappa, .. } = *self;
        if kappa < 0.0 || s > NEGLIGIBLE_EXPONENTIALS {
            return 1.0 - (lambda + kappa + 4.0 * kappa * s * s) * th + lambda * kappa * th * th;
        }
        // th (sinh^2 s - s^2) = th (sinh s - s) (sinh s - s + 2 s)
        let even = if s <= 1.0 {
            let odd = sinh_less(s);
            th * odd * (odd + 2.0 * s)
        } else {
            0.25 * th_minus_1 * th_minus_1 - s * s * th
        };
        self.one_minus_lambda * self.one_minus_kappa
            - (self.one_minus_lambda * kappa * th + lambda * self.one_minus_kappa) * th_minus_1
            + 4.0 * kappa * even
    }

    /// The Taylor coefficients of N/D, where `n(k)` are the coefficients of N.
    pub(super) fn over_denominator(&self, n: impl Fn(i32) -> f64) -> [f64; TERMS] {
        let (a, b, c) = (self.one_minus_lambda, self.one_minus_kappa, self.one_minus_product);
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
            return 1.0 + self.less_one_by_exponentials(s, 1.0 + 2.0 * s);
        }
        let Transfer { lambda, kappa, .. } = *self;
        let fade = Fade::new(s);
        let Fade { th, th_minus_1 } = fade;
        let n = if kappa >= 0.0 && lambda > 0.0 {
            // expm1(-4 s) = (th - 1)(th + 1)
            self.one_minus_product - lambda * kappa * th_minus_1 * (2.0 + th_minus_1) + 4.0 * s * kappa * th
        } else {
            self.one_minus_product + 2.0 * (lambda * kappa * fade.odd(s) + 2.0 * s * kappa * self.one_plus_lambda * th)
        };
        n / self.denominator(s, fade)
    }

    fn less_one(&self, s: f64) -> f64 {
        if s >= 1.0 {
            self.less_one_by_exponentials(s, 1.0 + 2.0 * s)
        } else {
            self.at(s) - 1.0
        }
    }

    fn substrate(&self) -> f64 {
        self.substrate
    }

    // Only the constant term of N would cancel; it is stored. The series of D is in terms of `1 - lambda` and `1 - kappa`.
    fn taylor(&self) -> [f64; TERMS] {
        let n = |k: i32| match k {
            0 => self.one_minus_product,
            _ => 4.0 * self.kappa * term(-2.0, k - 1) - self.lambda * self.kappa * term(-4.0, k),
        };
        self.over_denominator(n)
    }
}

/// `x^k/k!`.
pub(super) fn term(x: f64, k: i32) -> f64 {
    (1..=k).fold(1.0, |product, i| product * x / f64::from(i))
}

/// `th = exp(-2 s)` and `th - 1`, each to full precision.
#[derive(Clone, Copy)]
pub(super) struct Fade {
    pub(super) th: f64,
    pub(super) th_minus_1: f64,
}

impl Fade {
    pub(super) fn new(s: f64) -> Fade {
        if s < 1.0 {
            let th_minus_1 = (-2.0 * s).exp_m1();
            return Fade { th: 1.0 + th_minus_1, th_minus_1 };
        }
        let th = (-2.0 * s).exp();
        Fade { th, th_minus_1: th - 1.0 }
    }

    /// `th (sinh 2s - 2s)`.
    pub(super) fn odd(self, s: f64) -> f64 {
        let Fade { th, th_minus_1 } = self;
        if s <= 0.5 {
            th * sinh_less(2.0 * s)
        } else {
            -0.5 * th_minus_1 * (2.0 + th_minus_1) - 2.0 * s * th
        }
    }
}

/// `sinh x - x` for x between 0 and 1, by its series.
fn sinh_less(x: f64) -> f64 {
    // x^3/3! (1 + x^2/(4 5) (1 + x^2/(6 7) (...)))
    let series = (2..=9).rev().fold(1.0, |sum, k| 1.0 + x * x / f64::from(2 * k * (2 * k + 1)) * sum);
    x * x * x / 6.0 * series
}
