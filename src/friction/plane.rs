//! Vectors of the plane, and projections onto discs.

pub use crate::methods::fields::plus;

/// A vector of the plane: `[x, y]`.
pub type Vector = [f64; 2];

/// [`clip`] keeps tractions below their bounds by this relative margin, because a computed length may be rounded up.
const MARGIN: f64 = 4.0 * f64::EPSILON;

/// Projects q onto the disc `|q| <= g`. The result is in the disc however its length is computed and rounded.
pub fn clip(q: Vector, g: f64) -> Vector {
    if !(g > 0.0) {
        return [0.0; 2];
    }
    let scaled = [q[0] / g, q[1] / g];
    let length = square(scaled).sqrt();
    if length > 1.0 - MARGIN {
        let factor = (1.0 - MARGIN) / length;
        return [q[0] * factor, q[1] * factor];
    }
    q
}

/// The traction of length g opposite to a slip, [clipped](clip); 0 if the slip is 0.
pub fn against(slip: Vector, g: f64) -> Vector {
    let length = length(slip);
    if length > 0.0 {
        clip(slip.map(|s| -s / length * g), g)
    } else {
        [0.0; 2]
    }
}

/// `|v|`, without overflow.
pub fn length(v: Vector) -> f64 {
    v[0].hypot(v[1])
}

/// `|v|^2`.
#[inline]
pub fn square(v: Vector) -> f64 {
    v[0] * v[0] + v[1] * v[1]
}

/// `v . w`.
#[inline]
pub fn dot(v: Vector, w: Vector) -> f64 {
    v[0] * w[0] + v[1] * w[1]
}

/// `v + w`.
#[inline]
pub fn add(v: Vector, w: Vector) -> Vector {
    [v[0] + w[0], v[1] + w[1]]
}

/// Projects q onto the disc of radius g, up to round-off: see [`clip`].
#[inline]
pub fn onto_disc(q: Vector, g: f64) -> Vector {
    let squared = square(q);
    if squared > g * g {
        let factor = g / squared.sqrt();
        return [q[0] * factor, q[1] * factor];
    }
    q
}
