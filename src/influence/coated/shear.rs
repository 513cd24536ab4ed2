//! The responses of a bonded layer on a half-space to traction waves, along and across the wave vector.
//!
//! A traction wave along its wave vector displaces the surface in that direction by `(1 - nu1)/(G1 k) L(k t)` times its amplitude. This is
//! plane strain, with lambda, kappa, th and D of [`Transfer`]:
//!
//! ```text
//! L(s) = N/D,    N = 1 - 4 s kappa th - lambda kappa th^2
//! N = (1 - lambda kappa) - lambda kappa expm1(-4 s) - 4 s kappa th                                     soft: lambda < 0, kappa < 0
//! N = (1 - lambda kappa) + 2 lambda kappa th (sinh 2s - 2s) - 4 s kappa (1 - lambda) th                 stiff: lambda > 0, kappa > 0
//! ```
//!
//! A traction wave across its wave vector displaces by `1/(G1 k) T(k t)`. This is antiplane shear, a line of one impedance terminated by
//! another:
//!
//! ```text
//! T(s) = (mu + tanh s)/(1 + mu tanh s),    T(s) - 1 = 2 kappa' th/(1 - kappa' th),    kappa' = (mu - 1)/(mu + 1)
//! ```
//!
//! L(0) = B(0) and T(0) = mu are the substrate's. On a rigid body L = s/(1 - nu1) and T = s for small s: a layer of compliance t/G1,
//! compressible or not.

use super::response::{quotient, Response, TERMS};
use super::transfer::{term, Fade, Transfer, NEGLIGIBLE_EXPONENTIALS};

/// L of one layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along(Transfer);

impl Along {
    /// L of a layer of shear modulus `mu` times the substrate's, with both Poisson ratios.
    pub fn new(mu: f64, nu: [f64; 2]) -> Along {
        Along(Transfer::new(mu, nu))
    }
}

impl Response for Along {
    fn at(&self, s: f64) -> f64 {
        if s > NEGLIGIBLE_EXPONENTIALS {
            return 1.0 + self.0.less_one_plain(s, 1.0 - 2.0 * s);
        }
        let Transfer { lambda, kappa, less_lambda, less_both, .. } = self.0;
        let fade = Fade::new(s);
        let (Fade { th, less }, both) = (fade, lambda * kappa);
        let n = if both <= 0.0 {
            1.0 - both * th * th - 4.0 * s * kappa * th
        } else if kappa < 0.0 {
            // expm1(-4 s) = less (2 + less)
            less_both - both * less * (2.0 + less) - 4.0 * s * kappa * th
        } else {
            less_both + 2.0 * both * fade.odd(s) - 4.0 * s * kappa * less_lambda * th
        };
        n / self.0.denominator(s, fade)
    }

    fn less_one(&self, s: f64) -> f64 {
        if s >= 1.0 {
            self.0.less_one_plain(s, 1.0 - 2.0 * s)
        } else {
            self.at(s) - 1.0
        }
    }

    fn substrate(&self) -> f64 {
        self.0.substrate
    }

    // lambda = 1 - less_lambda: it is nearly 1 for stiff layers, and the terms of lambda = 1 begin with s^3.
    fn taylor(&self) -> [f64; TERMS] {
        let Transfer { kappa, less_lambda, less_both, .. } = self.0;
        let stiff = |k: i32| if k < 3 { 0.0 } else { -4.0 * term(-2.0, k - 1) - term(-4.0, k) };
        self.0.over_denominator(|k| match k {
            0 => less_both,
            _ => kappa * (stiff(k) + less_lambda * term(-4.0, k)),
        })
    }
}

/// T of one layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across {
    mu: f64,
}

impl Across {
    /// T of a layer of shear modulus `mu` times the substrate's.
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
        // cosh has the even terms, sinh the odd ones.
        let of = |even: f64, odd: f64| move |k: i32| if k % 2 == 0 { even } else { odd } * term(1.0, k);
        quotient(of(self.mu, 1.0), of(1.0, self.mu))
    }
}
