//! The projected gradients on one SIMD vector of elements: slip prediction and step.

use pulp::Simd;

use super::certificate::ON_THE_CIRCLE;
use super::pairs::{add, choose, dot, scaled, subtract, Pair};
use super::tangent::{ALIGNED, CURVATURE_WEIGHT, NEAR_THE_CIRCLE};
use crate::lanes::{Holds, Lanes};

/// The units, and constants of the formulas in them.
#[derive(Clone, Copy, Default)]
pub struct Units {
    /// The unit of tractions, the unit of displacements.
    pub traction: f64,
    pub displacement: f64,
    /// The influence of an element on itself.
    pub a0: f64,
    /// rho of the natural map.
    pub rho: f64,
}

/// The prediction of the natural map on an element of C: see [`Tangent::predict`](super::tangent::Tangent::predict).
pub struct Prediction<S: Simd> {
    /// The normal n; 0 on stick.
    pub normal: Pair<S>,
    /// D.
    pub curvature: Lanes<S>,
    /// `P(-s)`.
    pub projected: Pair<S>,
    /// The square of the slip's residual.
    pub rest: Lanes<S>,
}

/// The formulas, with their constants as vectors.
#[derive(Clone, Copy)]
pub struct Disc<S: Simd> {
    rho: Lanes<S>,
    inverse_rho: Lanes<S>,
    a0: Lanes<S>,
    mixed: Lanes<S>,
    zero: Lanes<S>,
}

impl<S: Simd> Disc<S> {
    #[inline(always)]
    pub fn new(simd: S, units: &Units) -> Disc<S> {
        Disc {
            rho: Lanes::splat(simd, units.rho),
            inverse_rho: Lanes::splat(simd, 1.0 / units.rho),
            a0: Lanes::splat(simd, units.a0),
            mixed: Lanes::splat(simd, CURVATURE_WEIGHT / units.a0),
            zero: Lanes::splat(simd, 0.0),
        }
    }

    /// The prediction for elements of tractions q, slips s and bounds g.
    #[inline(always)]
    pub fn predict(&self, q: Pair<S>, s: Pair<S>, g: Lanes<S>) -> Prediction<S> {
        let tau = subtract(q, scaled(self.rho, s));
        let (square_q, square_tau) = (dot(q, q), dot(tau, tau));
        let slips = (g * g).is_below(square_tau);
        let (length, reach) = (square_q.sqrt(), square_tau.sqrt());
        // q is near the circle, and its angle with tau is below that of ALIGNED.
        let is_near =
            (length - g).abs().is_at_most(NEAR_THE_CIRCLE * g) & (ALIGNED * (length * reach)).is_at_most(dot(q, tau));
        let inverse = 1.0 / is_near.choose(length, reach);
        let n = scaled(inverse, choose(is_near, q, tau));
        let bent = ((0.0 - dot(n, s)) / g).max(self.zero);
        let turned = (reach / g - 1.0) * self.inverse_rho;
        let normal = choose(slips, n, [self.zero; 2]);
        let curvature = slips.choose(is_near.choose(bent, turned), self.zero);
        let projected = subtract(scaled(dot(s, normal), normal), s);
        Prediction { normal, curvature, projected, rest: self.rest(s, q, square_q, g) }
    }

    /// See [`rest`](super::certificate::rest).
    #[inline(always)]
    fn rest(&self, s: Pair<S>, q: Pair<S>, square_q: Lanes<S>, g: Lanes<S>) -> Lanes<S> {
        let circle = g * ON_THE_CIRCLE;
        let is_across = dot(s, q).is_below(self.zero) & (circle * circle).is_at_most(square_q);
        let across = s[0] * q[1] - s[1] * q[0];
        is_across.choose(across * across / square_q, dot(s, s))
    }

    /// E of the preconditioner.
    #[inline(always)]
    pub fn mixing(&self, curvature: Lanes<S>) -> Lanes<S> {
        1.0 / (1.0 + self.mixed * curvature)
    }

    /// The diagonal part of the preconditioner, beside E: `(1 - E)/(D + a0)`.
    #[inline(always)]
    pub fn own(&self, mixing: Lanes<S>, stiff: Lanes<S>) -> Lanes<S> {
        (1.0 - mixing) / (stiff + self.a0)
    }

    /// P v, with the normal n; n = 0: v.
    #[inline(always)]
    pub fn project(&self, n: Pair<S>, v: Pair<S>) -> Pair<S> {
        subtract(v, scaled(dot(v, n), n))
    }

    /// The slipping elements, whose normal is not 0.
    #[inline(always)]
    pub fn slips(&self, [x, y]: Pair<S>) -> Holds<S> {
        self.zero.is_below(x.abs() + y.abs())
    }

    /// The tractions after a step `way` from q: along the circle where elements slip, else straight and projected onto the disc.
    #[inline(always)]
    pub fn moved(&self, (slips, n): (Holds<S>, Pair<S>), g: Lanes<S>, q: Pair<S>, way: Pair<S>) -> Pair<S> {
        let to = add(choose(slips, scaled(g, n), q), way);
        let squared = dot(to, to);
        let onto = slips | (g * g).is_below(squared);
        choose(onto, scaled(g / squared.sqrt(), to), to)
    }
}
