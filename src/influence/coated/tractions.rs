//! The displacements by tractions on coated surfaces, less those of half-spaces.
//!
//! Let L be the response along the wave vector and T that across it ([`Along`](super::shear::Along), [`Across`](super::shear::Across)). A
//! traction wave of amplitude q displaces the surface by `1/(G1 k)` times
//!
//! ```text
//! ((1 - nu1) L k k^T/k^2 + T (1 - k k^T/k^2)) q
//! ```
//!
//! Let B be one of these responses and b its base, as for pressures: b = 1 at distances below t, a half-space of the layer's material, and b =
//! B(0) beyond, the substrate. The inverse transform of `(B - b)/k k_i k_j/k^2` is `d_i d_j Psi/(2 pi t)`, with lengths in units of t and a
//! function Psi of the distance rho alone. The Laplacian of Psi is the radial function F_b of B, and its slope is `M_b/rho` ([`Radial`]):
//!
//! ```text
//! d_x d_x Psi = g + (F - 2 g) cos^2       integral over the element: X       g = M/rho^2
//! d_y d_y Psi = g + (F - 2 g) sin^2       integral over the element: Y
//! d_x d_y Psi = (F - 2 g) cos sin         integral over the element: Z
//!
//! Axx = (1 - nu1) X(L) + Y(T),    Ayy = (1 - nu1) Y(L) + X(T),    Axy = (1 - nu1) Z(L) - Z(T)       in 1/(2 pi G1) of one body
//! ```
//!
//! Up to a distance of [`CORNERS`] diagonals of the element, X and Y are corner differences of `T(x, y)` and of `T(y, x)`, as in the coefficients
//! of pressures (`layer.rs`). Z is a corner difference of Psi, and its differences along an edge are integrals of its slope. At larger distances,
//! and for layers that are much thicker than elements are long, tensor Gauss quadrature is used. Offsets need not be integers, because steps of
//! rolling end between the centres.

use std::sync::Arc;

use super::base::Base;
use super::cache::Cache;
use super::layer::{CORNERS, LINE_POINTS};
use super::radial::Radial;
use super::response::Response;
use super::tensor::Tensor;
use crate::influence::gauss::rule;

/// The ratio of the shear moduli of layer and substrate from which the layer counts as a membrane, which spreads loads over a long distance.
const MEMBRANE: f64 = 30.0;
/// The number of points per side of tensor Gauss quadrature, up to each distance in longer sides of an element. The relative error on a function
/// like 1/r, `(n!)^4/((2n + 1)((2n)!)^2) r^-2n`, is at most 3e-13 where a rule begins; the last rule begins at 400.
const POINTS: [(f64, usize); 4] = [(12.0, 7), (40.0, 4), (400.0, 3), (f64::INFINITY, 2)];

/// The tables of the last materials.
static CACHE: Cache<Tensor> = Cache::new();

/// A coating that both bodies have alike, for tractions.
#[derive(Clone, Debug)]
pub struct Coat {
    /// The radial functions of a layer of unit thickness.
    tensor: Arc<Tensor>,
    /// The thickness.
    t: f64,
}

impl Coat {
    /// A layer of thickness t whose shear modulus is `mu` times the substrate's, with the Poisson ratios of layer and substrate.
    pub fn new(t: f64, mu: f64, nu: [f64; 2]) -> Coat {
        Coat { tensor: CACHE.get([mu, nu[0], nu[1]], || Tensor::new(mu, nu)), t }
    }

    /// Whether the coating is so much stiffer than the substrate that it spreads loads as a membrane, over many elements.
    pub fn is_membrane(&self) -> bool {
        self.tensor.across.transfer.substrate() >= MEMBRANE
    }

    /// The displacements of one body by a traction wave of amplitude 1 and wave number k, along and across the wave vector, in units of `1/(G1
    /// k)`.
    pub fn of_wave(&self, k: f64) -> [f64; 2] {
        let Tensor { along, across, one_minus_nu, .. } = &*self.tensor;
        [one_minus_nu * along.transfer.at(k * self.t), across.transfer.at(k * self.t)]
    }

    /// The coating with `length` as the unit of lengths.
    pub fn in_units_of(&self, length: f64) -> Coat {
        Coat { t: self.t / length, ..self.clone() }
    }

    /// The coefficients at an offset in elements `dx` by `dy`: the base half-space, and what has to be added to `pi G1` times its Axx, Ayy and
    /// Axy (of both bodies).
    pub fn at(&self, (x, y): (f64, f64), (dx, dy): (f64, f64)) -> (Base, [f64; 3]) {
        let place = Place::new([x.abs() * dx, y.abs() * dy].map(|x| x / self.t), [dx / self.t, dy / self.t]);
        let sign = match (x, y) {
            (0.0, _) | (_, 0.0) => 0.0,
            _ if (x < 0.0) == (y < 0.0) => 1.0,
            _ => -1.0,
        };
        let [xx, yy, xy] = match place.points {
            Some(points) => place.by_gauss(&self.tensor, rule(points)),
            None => place.near(&self.tensor),
        };
        let sum = [xx, yy, sign * xy];
        (place.base, sum.map(|sum| self.t * sum))
    }
}

/// The position of a point relative to a loaded element, in thicknesses, and the method for this distance.
struct Place {
    /// The offset of the point from the element's centre in x and y, not negative.
    offset: [f64; 2],
    /// The element's sides.
    size: [f64; 2],
    /// The half-space that is the base there.
    base: Base,
    /// The number of points per side of tensor Gauss quadrature. `None`: corner differences.
    points: Option<usize>,
}

impl Place {
    fn new(offset: [f64; 2], size: [f64; 2]) -> Place {
        let (distance, longer) = (offset[0].hypot(offset[1]), size[0].max(size[1]));
        // F and g are smooth also on the scale t, which is 1 here.
        let smooth = distance.max(1.0) / longer;
        let is_near = smooth <= POINTS[0].0 && distance <= CORNERS * size[0].hypot(size[1]);
        let points = POINTS.iter().find(|(last, _)| smooth <= *last).map(|(_, points)| *points);
        let base = if (if is_near { longer } else { distance }) < 1.0 { Base::Layer } else { Base::Substrate };
        Place { offset, size, base, points: points.filter(|_| !is_near) }
    }

    /// The terms of Axx, Ayy and Axy by tensor Gauss quadrature.
    fn by_gauss(&self, tensor: &Tensor, rule: &[(f64, f64)]) -> [f64; 3] {
        let [[x, y], [dx, dy]] = [self.offset, self.size];
        let mut sums = [0.0; 3];
        for (sx, wx) in rule {
            let x = x + (sx - 0.5) * dx;
            for (sy, wy) in rule {
                let y = y + (sy - 0.5) * dy;
                let ([isotropic, directional], weight) = (tensor.at_square(x * x + y * y, self.base), wx * wy);
                sums[0] += weight * (isotropic + directional * x * x);
                sums[1] += weight * (isotropic + directional * y * y);
                sums[2] += weight * (directional * x * y);
            }
        }
        sums.map(|sum| sum * dx * dy)
    }

    /// The terms of Axx, Ayy and Axy by corner differences.
    fn near(&self, tensor: &Tensor) -> [f64; 3] {
        let (along, across) = (self.by_corners(&tensor.along), self.by_corners(&tensor.across));
        let one_minus_nu = tensor.one_minus_nu;
        [one_minus_nu * along[0] + across[1], one_minus_nu * along[1] + across[0], one_minus_nu * along[2] - across[2]]
    }

    /// X, Y and Z of one response by corner differences.
    fn by_corners<R: Response>(&self, radial: &Radial<R>) -> [f64; 3] {
        let ends = |k: usize| [self.offset[k] - 0.5 * self.size[k], self.offset[k] + 0.5 * self.size[k]];
        let ([xm, xp], [ym, yp], of) = (ends(0), ends(1), (radial, self.base));
        let corners = |f: &dyn Fn(f64, f64) -> f64| f(xp, yp) - f(xp, ym) - f(xm, yp) + f(xm, ym);
        let rising = |x: f64| along_ray(of, ym.hypot(x), yp.hypot(x));
        [corners(&|x, y| side(of, x, y)), corners(&|x, y| side(of, y, x)), rising(xp) - rising(xm)]
    }
}

/// `integral from 0 to b of a M(r)/r^2 dy` with `r^2 = a^2 + y^2`. It is odd in a and in b.
fn side<R: Response>((radial, base): (&Radial<R>, Base), a: f64, b: f64) -> f64 {
    let (height, end) = (a.abs(), (b / a).abs().asinh());
    if a == 0.0 || !end.is_finite() {
        return 0.0;
    }
    let at = |(u, w): &(f64, f64)| {
        let cosh = (end * u).cosh();
        let m = match base {
            // `M/r^2` keeps all digits where M is small.
            Base::Layer => radial.mean_at_square((height * cosh).powi(2), base) * (height * cosh) * height,
            Base::Substrate => radial.m(height * cosh, base) / cosh,
        };
        w * m
    };
    let value = end * rule(LINE_POINTS).iter().map(at).sum::<f64>();
    if (a < 0.0) == (b < 0.0) {
        value
    } else {
        -value
    }
}

/// `Psi(to) - Psi(from)`, by integration of the slope M/rho over `v = asinh(rho/2)`.
fn along_ray<R: Response>((radial, base): (&Radial<R>, Base), from: f64, to: f64) -> f64 {
    let (start, end) = ((0.5 * from).asinh(), (0.5 * to).asinh());
    let at = |(u, w): &(f64, f64)| {
        let v = start + (end - start) * u;
        let rho = 2.0 * v.sinh();
        w * radial.mean_at_square((rho * rho).max(f64::MIN_POSITIVE), base) * rho * 2.0 * v.cosh()
    };
    (end - start) * rule(LINE_POINTS).iter().map(at).sum::<f64>()
}
