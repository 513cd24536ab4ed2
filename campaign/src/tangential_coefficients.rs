//! Influence coefficients of tangential tractions on an element, and the coupling coefficients of unlike bodies.
//!
//! Near an element the coefficients are differences of closed forms over its corners (Kalker 1990; Johnson, Contact Mechanics, section 3.6). Brackets
//! stand for these differences, and `r = hypot(X, Y)`:
//!
//! ```text
//! Axx = ((1 - nu) a + b)/(pi G),   Ayy = (a + (1 - nu) b)/(pi G),   Axy = nu c/(pi G)
//! Axz = -K/(pi G) [Y ln r + X atan(Y/X)],   Ayz = -K/(pi G) [X ln r + Y atan(X/Y)]
//! a = [X asinh(Y/|X|)],   b = [Y asinh(X/|Y|)],   c = [-r],   K/G = ((1 - 2 nu1)/G1 - (1 - 2 nu2)/G2)/4
//! ```
//!
//! At places that are some sides away from the element, the kernels are integrated in closed form along one direction and by Gauss points along the
//! other. So the coefficients of slender elements lose no digits by cancellation. Far from the element the coefficients are sums over sixteen Gauss
//! points. The normal displacements by tractions are `-(Axz qx + Ayz qy)`.

use std::f64::consts::PI;

use crate::hankel::gauss;

/// A vector in the plane of the contact.
pub type Vector = [f64; 2];

/// From this number of the longer sides on, Gauss points replace the element in both directions. With four points a side the error is `(1/120)^8`.
const FAR: f64 = 30.0;
/// From this number of sides in a direction on, eight Gauss points replace the element in this direction. The error is `(1/16)^16`.
const BESIDE: f64 = 4.0;
/// The coefficients xx, yy, xy, xz, yz.
pub type Entry = [f64; 5];

/// The compliances of both bodies.
#[derive(Clone, Copy)]
pub struct Compliance {
    /// The mean of 1/G.
    pub shear: f64,
    /// The mean of nu/G.
    pub poisson: f64,
    /// K/G, with the difference parameter K.
    pub unlike: f64,
}

/// The coefficients at an offset as differences of the closed forms over the corners. Also returns the largest absolute value of a term of these
/// differences.
fn near(c: Compliance, [x, y]: Vector, [dx, dy]: Vector) -> (Entry, f64) {
    let (mut sums, mut largest) = ([0.0; 5], 0.0f64);
    for (sx, sy) in [(0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)] {
        let (cx, cy) = (x + sx * dx, y + sy * dy);
        let term = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() };
        let across = |a: f64, b: f64| {
            // Lengths are relative to the element: the logarithm of the unit cancels.
            let along = if b == 0.0 { 0.0 } else { b * (a.hypot(b) / dx).ln() };
            along + if a == 0.0 { 0.0 } else { a * (b / a).atan() }
        };
        let parts = [term(cx, cy), term(cy, cx), -cx.hypot(cy), across(cx, cy), across(cy, cx)];
        // An odd coefficient is 0 on its line of symmetry, so its terms have no round-off there.
        let nonzero = [x != 0.0 && y != 0.0, x != 0.0, y != 0.0];
        let counts =
            [true, true, nonzero[0] && c.poisson != 0.0, nonzero[1] && c.unlike != 0.0, nonzero[2] && c.unlike != 0.0];
        largest =
            parts.iter().zip(counts).filter(|(_, counts)| *counts).fold(largest, |l, (part, _)| l.max(part.abs()));
        (0..5).for_each(|k| sums[k] += 4.0 * sx * sy * parts[k]);
    }
    let [a, b, r, xz, yz] = sums;
    let entry = [
        c.shear * (a + b) - c.poisson * a,
        c.shear * (a + b) - c.poisson * b,
        c.poisson * r,
        -c.unlike * xz,
        -c.unlike * yz,
    ];
    (entry.map(|value| value / PI), largest)
}

/// The coefficients at an offset, integrated in closed form along y and by Gauss points along x.
fn beside(c: Compliance, rule: &[(f64, f64)], [x, y]: Vector, [dx, dy]: Vector) -> Entry {
    let mut sums = [0.0; 5];
    for (u, w) in rule {
        let x = x - (u - 0.5) * dx;
        let ends = [y + 0.5 * dy, y - 0.5 * dy];
        let between = |f: &dyn Fn(f64) -> f64| f(ends[0]) - f(ends[1]);
        // The integrals along y of 1/r, x^2/r^3, xy/r^3, x/r^2 and y/r^2.
        let over_r = between(&|y| (y / x.abs()).asinh());
        let xx = between(&|y| y / x.hypot(y));
        let xy = between(&|y| -x / x.hypot(y));
        let (along, across) = (between(&|y| (y / x).atan()), between(&|y| 0.5 * (y / x).powi(2).ln_1p()));
        let parts = [
            (c.shear - c.poisson) * over_r + c.poisson * xx,
            c.shear * over_r - c.poisson * xx,
            c.poisson * xy,
            -c.unlike * along,
            -c.unlike * across,
        ];
        (0..5).for_each(|k| sums[k] += w * dx / PI * parts[k]);
    }
    sums
}

/// The coefficients at an offset by Gauss points in both directions.
fn far(c: Compliance, rule: &[(f64, f64)], [x, y]: Vector, [dx, dy]: Vector) -> Entry {
    let mut sums = [0.0; 5];
    for (u, wu) in rule {
        for (v, wv) in rule {
            let (x, y) = (x - (u - 0.5) * dx, y - (v - 0.5) * dy);
            let (r, w) = (x.hypot(y), wu * wv * dx * dy / PI);
            let (ex, ey) = (x / r, y / r);
            let kernel = [
                (c.shear - c.poisson * ey * ey) / r,
                (c.shear - c.poisson * ex * ex) / r,
                c.poisson * ex * ey / r,
                -c.unlike * ex / r,
                -c.unlike * ey / r,
            ];
            (0..5).for_each(|k| sums[k] += w * kernel[k]);
        }
    }
    sums
}

/// An element on bodies with these compliances.
pub struct Element {
    compliance: Compliance,
    /// The sides dx and dy.
    sides: Vector,
    /// Gauss's rules with four and with eight points.
    coarse: Vec<(f64, f64)>,
    fine: Vec<(f64, f64)>,
}

impl Element {
    /// An element with sides dx and dy.
    pub fn new(compliance: Compliance, sides: Vector) -> Element {
        Element { compliance, sides, coarse: gauss(4), fine: gauss(8) }
    }

    /// The coefficients at an offset from the element. Also returns the largest absolute value of a term that cancels, or 0 if there is no
    /// cancellation.
    pub fn at(&self, offset: Vector) -> (Entry, f64) {
        let (c, [dx, dy], [x, y]) = (self.compliance, self.sides, offset);
        if x.hypot(y) > FAR * dx.max(dy) {
            return (far(c, &self.coarse, offset, [dx, dy]), 0.0);
        }
        // Gauss points replace the shorter side if the offset along it is large, or else the other side if the offset along that one is large.
        let (is_beside_in_x, is_beside_in_y) = (x.abs() > BESIDE * dx, y.abs() > BESIDE * dy);
        if is_beside_in_x && (dx <= dy || !is_beside_in_y) {
            return (beside(c, &self.fine, offset, [dx, dy]), 0.0);
        }
        if is_beside_in_y {
            let [yy, xx, xy, yz, xz] = beside(c, &self.fine, [y, x], [dy, dx]);
            return ([xx, yy, xy, xz, yz], 0.0);
        }
        near(c, offset, [dx, dy])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The three ways of integration agree at offsets for which all are accurate, to the round-off of the closed forms.
    #[test]
    fn far_and_near_agree() {
        let (c, rule) = (Compliance { shear: 0.5, poisson: 0.1, unlike: 0.2 }, gauss(4));
        for at in [[21.5, 0.3], [0.0, -22.0], [-16.0, 15.0]] {
            let ((near, terms), far) = (near(c, at, [0.7, 0.4]), far(c, &rule, at, [0.7, 0.4]));
            assert!((0..5).all(|k| (near[k] - far[k]).abs() <= 32.0 * f64::EPSILON * terms), "{near:?} {far:?}");
            let [yy, xx, xy, yz, xz] = beside(c, &gauss(8), [at[1], at[0]], [0.4, 0.7]);
            let one = if at[0] != 0.0 { beside(c, &gauss(8), at, [0.7, 0.4]) } else { far };
            for found in [one, if at[1].abs() > 1.0 { [xx, yy, xy, xz, yz] } else { far }] {
                assert!((0..5).all(|k| (found[k] - far[k]).abs() <= 1e-14 * far[0]), "{found:?} {far:?}");
            }
        }
    }
}
