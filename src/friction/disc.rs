//! One element of the projected gradients: what slips there, and where it goes.

use super::plane::{add, onto_disc, plus, square, Pair, Vector};
use super::tangent::{look, mixing, Seen};
use crate::operator::fft::Real;

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

impl Units {
    /// At an element of bound g, with its q, u and w.
    #[inline]
    pub fn look(&self, q: Vector, u: Vector, w: Vector, g: f64) -> Seen {
        look((q, add(w, u)), g, (self.rho, 1.0 / self.rho))
    }

    /// E of the preconditioner.
    #[inline]
    pub fn mixing(&self, curvature: f64) -> f64 {
        mixing(curvature, self.a0)
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
