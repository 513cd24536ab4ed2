//! The projected gradients on one SIMD vector of elements: slip prediction and step.

use pulp::Simd;

use super::certificate::ON_THE_CIRCLE;
use super::lanes::{Arithmetic, Pair};
use super::tangent::{ALIGNED, CURVATURE_WEIGHT, NEAR_THE_CIRCLE};

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
    pub curvature: S::f64s,
    /// `P(-s)`.
    pub projected: Pair<S>,
    /// The square of the slip's residual.
    pub rest: S::f64s,
}

/// The formulas, with their constants as vectors.
#[derive(Clone, Copy)]
pub struct Disc<S: Simd> {
    pub a: Arithmetic<S>,
    rho: S::f64s,
    inverse_rho: S::f64s,
    a0: S::f64s,
    mixed: S::f64s,
    zero: S::f64s,
    one: S::f64s,
}

impl<S: Simd> Disc<S> {
    #[inline(always)]
    pub fn new(simd: S, units: &Units) -> Disc<S> {
        let a = Arithmetic(simd);
        Disc {
            a,
            rho: a.splat(units.rho),
            inverse_rho: a.splat(1.0 / units.rho),
            a0: a.splat(units.a0),
            mixed: a.splat(CURVATURE_WEIGHT / units.a0),
            zero: a.splat(0.0),
            one: a.splat(1.0),
        }
    }

    /// The prediction for elements of tractions q, slips s and bounds g.
    #[inline(always)]
    pub fn predict(&self, q: Pair<S>, s: Pair<S>, g: S::f64s) -> Prediction<S> {
        let Disc { a, zero, one, .. } = *self;
        let tau = a.sub_pair(q, a.scale(self.rho, s));
        let (square_q, square_tau) = (a.square(q), a.square(tau));
        let slips = a.0.greater_than_f64s(square_tau, a.mul(g, g));
        let (length, reach) = (a.sqrt(square_q), a.sqrt(square_tau));
        // q is near the circle, and its angle with tau is below that of ALIGNED.
        let off = a.abs(a.sub(length, g));
        let is_near = a.0.less_than_or_equal_f64s(off, a.mul(a.splat(NEAR_THE_CIRCLE), g));
        let least = a.mul(a.splat(ALIGNED), a.mul(length, reach));
        let is_near = a.0.and_m64s(is_near, a.0.greater_than_or_equal_f64s(a.dot(q, tau), least));
        let inverse = a.div(one, a.select(is_near, length, reach));
        let n = a.scale(inverse, a.select_pair(is_near, q, tau));
        let bent = a.0.max_f64s(a.div(a.sub(zero, a.dot(n, s)), g), zero);
        let turned = a.mul(a.sub(a.div(reach, g), one), self.inverse_rho);
        let normal = a.select_pair(slips, n, [zero; 2]);
        let curvature = a.select(slips, a.select(is_near, bent, turned), zero);
        let projected = a.sub_pair(a.scale(a.dot(s, normal), normal), s);
        Prediction { normal, curvature, projected, rest: self.rest(s, q, square_q, g) }
    }

    /// See [`rest`](super::certificate::rest).
    #[inline(always)]
    fn rest(&self, s: Pair<S>, q: Pair<S>, square_q: S::f64s, g: S::f64s) -> S::f64s {
        let a = self.a;
        let circle = a.mul(g, a.splat(ON_THE_CIRCLE));
        let is_on_circle = a.0.greater_than_or_equal_f64s(square_q, a.mul(circle, circle));
        let is_across = a.0.and_m64s(a.0.less_than_f64s(a.dot(s, q), self.zero), is_on_circle);
        let across = a.sub(a.mul(s[0], q[1]), a.mul(s[1], q[0]));
        a.select(is_across, a.div(a.mul(across, across), square_q), a.square(s))
    }

    /// E of the preconditioner.
    #[inline(always)]
    pub fn mixing(&self, curvature: S::f64s) -> S::f64s {
        let a = self.a;
        a.div(self.one, a.add(self.one, a.mul(self.mixed, curvature)))
    }

    /// The diagonal part of the preconditioner, beside E: `(1 - E)/(D + a0)`.
    #[inline(always)]
    pub fn own(&self, mixing: S::f64s, stiff: S::f64s) -> S::f64s {
        self.a.div(self.a.sub(self.one, mixing), self.a.add(stiff, self.a0))
    }

    /// P v, with the normal n; n = 0: v.
    #[inline(always)]
    pub fn project(&self, n: Pair<S>, v: Pair<S>) -> Pair<S> {
        self.a.sub_pair(v, self.a.scale(self.a.dot(v, n), n))
    }

    /// The slipping elements, whose normal is not 0.
    #[inline(always)]
    pub fn slips(&self, [x, y]: Pair<S>) -> S::m64s {
        let a = self.a;
        a.0.greater_than_f64s(a.add(a.abs(x), a.abs(y)), self.zero)
    }

    /// The tractions after a step `way` from q: along the circle where elements slip, else straight and projected onto the disc.
    #[inline(always)]
    pub fn moved(&self, (slips, n): (S::m64s, Pair<S>), g: S::f64s, q: Pair<S>, way: Pair<S>) -> Pair<S> {
        let a = self.a;
        let to = a.add_pair(a.select_pair(slips, a.scale(g, n), q), way);
        let squared = a.square(to);
        let onto = a.0.or_m64s(slips, a.0.greater_than_f64s(squared, a.mul(g, g)));
        a.select_pair(onto, a.scale(a.div(g, a.sqrt(squared)), to), to)
    }
}
