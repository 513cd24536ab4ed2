//! The formulas of the projected conjugate gradients for one SIMD vector of elements: the prediction of stick and slip, the preconditioner, and the
//! step. [`tangent`](super::tangent) has the same formulas for one element, and explains n, D, P and E.

use pulp::Simd;

use super::certificate::ON_THE_CIRCLE;
use super::pairs::{add, choose, dot, scaled, subtract, Pair};
use super::tangent::{ALIGNED, CURVATURE_WEIGHT, NEAR_THE_CIRCLE};
use crate::lanes::{Holds, Lanes};

/// The units of the fields, and two constants in these units.
#[derive(Clone, Copy, Default)]
pub struct Units {
    /// The unit of tractions.
    pub traction: f64,
    /// The unit of displacements.
    pub displacement: f64,
    /// The influence of an element on itself, in the units of the fields.
    pub a0: f64,
    /// rho of the natural map `tau = q - rho s`, in the units of the fields.
    pub rho: f64,
}

/// The prediction of the natural map for elements of C.
pub struct Prediction<S: Simd> {
    /// The normal n of the circle; 0 on stick.
    pub normal: Pair<S>,
    /// The curvature D.
    pub curvature: Lanes<S>,
    /// The projected residual `P(-s)`.
    pub projected: Pair<S>,
    /// The square of the residual slip.
    pub rest: Lanes<S>,
}

/// The formulas, with their constants as SIMD vectors.
#[derive(Clone, Copy)]
pub struct Disc<S: Simd> {
    rho: Lanes<S>,
    inverse_rho: Lanes<S>,
    a0: Lanes<S>,
    /// CURVATURE_WEIGHT/a0, the factor on D in E.
    curvature_weight: Lanes<S>,
    zero: Lanes<S>,
}

impl<S: Simd> Disc<S> {
    #[inline(always)]
    pub fn new(simd: S, units: &Units) -> Disc<S> {
        Disc {
            rho: Lanes::splat(simd, units.rho),
            inverse_rho: Lanes::splat(simd, 1.0 / units.rho),
            a0: Lanes::splat(simd, units.a0),
            curvature_weight: Lanes::splat(simd, CURVATURE_WEIGHT / units.a0),
            zero: Lanes::splat(simd, 0.0),
        }
    }

    /// Predicts stick or slip for tractions q, slips s and traction bounds g.
    #[inline(always)]
    pub fn predict(&self, q: Pair<S>, s: Pair<S>, g: Lanes<S>) -> Prediction<S> {
        let tau = subtract(q, scaled(self.rho, s));
        let (square_q, square_tau) = (dot(q, q), dot(tau, tau));
        let slips = (g * g).is_below(square_tau);
        let (length, reach) = (square_q.sqrt(), square_tau.sqrt());
        // If q is near the circle, and its angle with tau is small, n is q/|q|, otherwise tau/|tau|.
        let is_near =
            (length - g).abs().is_at_most(NEAR_THE_CIRCLE * g) & (ALIGNED * (length * reach)).is_at_most(dot(q, tau));
        let inverse = 1.0 / is_near.choose(length, reach);
        let n = scaled(inverse, choose(is_near, q, tau));
        let curvature_near = ((0.0 - dot(n, s)) / g).max(self.zero);
        let curvature_far = (reach / g - 1.0) * self.inverse_rho;
        let normal = choose(slips, n, [self.zero; 2]);
        let curvature = slips.choose(is_near.choose(curvature_near, curvature_far), self.zero);
        let projected = subtract(scaled(dot(s, normal), normal), s);
        Prediction { normal, curvature, projected, rest: self.rest(s, q, square_q, g) }
    }

    /// The square of the residual slip, as [`rest`](super::certificate::rest).
    #[inline(always)]
    fn rest(&self, s: Pair<S>, q: Pair<S>, square_q: Lanes<S>, g: Lanes<S>) -> Lanes<S> {
        let circle = g * ON_THE_CIRCLE;
        let is_across = dot(s, q).is_below(self.zero) & (circle * circle).is_at_most(square_q);
        let across = s[0] * q[1] - s[1] * q[0];
        is_across.choose(across * across / square_q, dot(s, s))
    }

    /// E, the weight of the circulant in the preconditioner: see `CURVATURE_WEIGHT`.
    #[inline(always)]
    pub fn mixing(&self, curvature: Lanes<S>) -> Lanes<S> {
        1.0 / (1.0 + self.curvature_weight * curvature)
    }

    /// The diagonal part of the preconditioner, `(1 - E)/(D + a0)`.
    #[inline(always)]
    pub fn diagonal_inverse(&self, mixing: Lanes<S>, curvature: Lanes<S>) -> Lanes<S> {
        (1.0 - mixing) / (curvature + self.a0)
    }

    /// P v, with the normal n. On stick n is 0, and P v is v.
    #[inline(always)]
    pub fn project(&self, n: Pair<S>, v: Pair<S>) -> Pair<S> {
        subtract(v, scaled(dot(v, n), n))
    }

    /// The lanes of slipping elements: those whose normal is not 0.
    #[inline(always)]
    pub fn slips(&self, [x, y]: Pair<S>) -> Holds<S> {
        self.zero.is_below(x.abs() + y.abs())
    }

    /// The tractions after a step `change`. An element that slips moves to the point of the circle in the direction of `g n + change`. The others
    /// move to `q + change`, projected onto the disc.
    #[inline(always)]
    pub fn moved(&self, (slips, n): (Holds<S>, Pair<S>), g: Lanes<S>, q: Pair<S>, change: Pair<S>) -> Pair<S> {
        let to = add(choose(slips, scaled(g, n), q), change);
        let squared = dot(to, to);
        let onto = slips | (g * g).is_below(squared);
        choose(onto, scaled(g / squared.sqrt(), to), to)
    }
}
