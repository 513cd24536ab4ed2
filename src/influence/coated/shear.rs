//! The responses of a bonded layer on a half-space to traction waves: L for tractions along the wave vector, T for tractions across it.
//!
//! A traction wave along its wave vector displaces the surface in the same direction by `(1 - nu1)/(G1 k) L(k t)` times its amplitude. This is
//! plane strain. With lambda, kappa, th and D of [`Transfer`]:
//!
//! ```text
//! L(s) = N/D,    N = 1 - 4 s kappa th - lambda kappa th^2
//! N = (1 - lambda kappa) - lambda kappa expm1(-4 s) - 4 s kappa th                                     soft: lambda < 0, kappa < 0
//! N = (1 - lambda kappa) + 2 lambda kappa th (sinh 2s - 2s) - 4 s kappa (1 - lambda) th                 stiff: lambda > 0, kappa > 0
//! ```
//!
//! A traction wave across its wave vector displaces the surface in its own direction by `1/(G1 k) T(k t)` times its amplitude. This is antiplane
//! shear, which has the equations of a transmission line of one impedance that ends in another:
//!
//! ```text
//! T(s) = (mu + tanh s)/(1 + mu tanh s),    T(s) - 1 = 2 kappa' th/(1 - kappa' th),    kappa' = (mu - 1)/(mu + 1)
//! ```
//!
//! L(0) = B(0) and T(0) = mu are the responses of the substrate alone. On a rigid body L = s/(1 - nu1) and T = s for small s: the layer has the
//! shear compliance t/G1, whether it is compressible or not.

use super::response::{quotient, Response, TERMS};
use super::transfer::{term, Fade, Transfer, NEGLIGIBLE_EXPONENTIALS};

/// The response L of one layer to tractions along the wave vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along(Transfer);

impl Along {
    /// L of a layer whose shear modulus is `mu` times the substrate's, with the Poisson ratios of layer and substrate.
    pub fn new(mu: f64, nu: [f64; 2]) -> Along {
        Along(Transfer::new(mu, nu))
    }
}

impl Response for Along {
    fn at(&self, s: f64) -> f64 {
        if s > NEGLIGIBLE_EXPONENTIALS {
            return 1.0 + self.0.less_one_by_exponentials(s, 1.0 - 2.0 * s);
        }
        let Transfer { lambda, kappa, one_minus_lambda, one_minus_product, .. } = self.0;
        let fade = Fade::new(s);
        let (Fade { th, th_minus_1 }, product) = (fade, lambda * kappa);
        let n = if product <= 0.0 {
            1.0 - product * th * th - 4.0 * s * kappa * th
        } else if kappa < 0.0 {
            // expm1(-4 s) = (th - 1)(th + 1)
            one_minus_product - product * th_minus_1 * (2.0 + th_minus_1) - 4.0 * s * kappa * th
        } else {
            one_minus_product + 2.0 * product * fade.odd(s) - 4.0 * s * kappa * one_minus_lambda * th
        };
        n / self.0.denominator(s, fade)
    }

    fn less_one(&self, s: f64) -> f64 {
        if s >= 1.0 {
            self.0.less_one_by_exponentials(s, 1.0 - 2.0 * s)
        } else {
            self.at(s) - 1.0
        }
    }

    fn substrate(&self) -> f64 {
        self.0.substrate
    }

    // lambda is written as `1 - one_minus_lambda`, because it is nearly 1 for stiff layers. The terms for lambda = 1 (`stiff`) begin with s^3.
    fn taylor(&self) -> [f64; TERMS] {
        let Transfer { kappa, one_minus_lambda, one_minus_product, .. } = self.0;
        let stiff = |k: i32| if k < 3 { 0.0 } else { -4.0 * term(-2.0, k - 1) - term(-4.0, k) };
        self.0.over_denominator(|k| match k {
            0 => one_minus_product,
            _ => kappa * (stiff(k) + one_minus_lambda * term(-4.0, k)),
        })
    }
}

/// The response T of one layer to tractions across the wave vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across {
    mu: f64,
}

impl Across {
    /// T of a layer whose shear modulus is `mu` times the substrate's.
    pub fn new(mu: f64) -> Across {
        Across { mu }
    }
}

impl Response for Across {
    fn at(&self, s: f64) -> f64 {
        let tanh = s.tanh();
        (self.mu + tanh) / (1.0 + self.mu * tanh)
    }

    fn less_one(&self, s: f64) -> f64 {
        let th = (-2.0 * s).exp();
        2.0 * (self.mu - 1.0) * th / ((1.0 + th) - self.mu * (-2.0 * s).exp_m1())
    }

    fn substrate(&self) -> f64 {
        self.mu
    }

    fn taylor(&self) -> [f64; TERMS] {
        // T = (mu cosh s + sinh s)/(cosh s + mu sinh s). cosh has the even terms, sinh the odd ones.
        let sum_of = |even: f64, odd: f64| move |k: i32| if k % 2 == 0 { even } else { odd } * term(1.0, k);
        quotient(sum_of(self.mu, 1.0), sum_of(1.0, self.mu))
    }
}
