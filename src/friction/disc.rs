//! One element of the projected gradients: what slips there, and where it goes.

use super::certificate::rest;
use super::problem::{add, dot, onto_disc, plus, square};
use super::tangent::{normal_and_curvature, MIXED};
use super::Vector;
use crate::operator::fft::Real;

/// A value of two components.
pub type Pair<T> = [T; 2];

/// Units, and what is in them.
#[derive(Clone, Copy, Default)]
pub struct Units {
    /// Tractions are in this one, displacements in that one.
    pub traction: f64,
    pub displacement: f64,
    /// The influence of an element on itself.
    pub a0: f64,
    /// Of the natural map.
    pub rho: f64,
}

/// What the natural map says of an element: see [`Tangent`](super::tangent::Tangent).
pub struct Seen {
    pub normal: Vector,
    pub curvature: f64,
    pub driving: Vector,
    /// The square of what is left of the slip.
    pub rest: f64,
}

impl Units {
    /// At an element of bound g, with its q, u and w.
    #[inline]
    pub fn look(&self, q: Vector, u: Vector, w: Vector, g: f64) -> Seen {
        let s = add(w, u);
        let (tau, rest) = (plus(q, -self.rho, s), rest(s, q, g));
        if !(square(tau) > g * g) {
            return Seen { normal: [0.0; 2], curvature: 0.0, driving: [-s[0], -s[1]], rest };
        }
        let (normal, curvature) = normal_and_curvature((q, s), g, tau, 1.0 / self.rho);
        Seen { normal, curvature, driving: plus([-s[0], -s[1]], dot(s, normal), normal), rest }
    }

    /// E of the preconditioner.
    #[inline]
    pub fn mixing(&self, curvature: f64) -> f64 {
        1.0 / (1.0 + MIXED * curvature / self.a0)
    }
}

/// Whether an element with this normal slips.
#[inline]
pub fn slips(n: Vector) -> bool {
    n != [0.0; 2]
}

/// In double precision.
#[inline]
pub fn double<T: Real>(v: Pair<T>) -> Vector {
    v.map(T::to_double)
}

/// P v.
#[inline]
pub fn project(n: Vector, v: Vector) -> Vector {
    plus(v, -dot(v, n), n)
}

/// Where an element goes from q by `a t`.
#[inline]
pub fn moved(n: Vector, g: f64, q: Vector, t: Vector, a: f64) -> Vector {
    if !slips(n) {
        return onto_disc(plus(q, a, t), g);
    }
    let to = [g * n[0] + a * t[0], g * n[1] + a * t[1]];
    let factor = g / square(to).sqrt();
    [to[0] * factor, to[1] * factor]
}
