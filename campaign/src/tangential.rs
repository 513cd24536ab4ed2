//! Displacements by tractions and by pressures, of like and of unlike bodies, by coefficients of the campaign's own.
//!
//! Near an element they are differences of closed forms over its corners (Kalker 1990; Johnson, Contact Mechanics, section 3.6), with
//! `r = hypot(X, Y)`:
//!
//! ```text
//! Axx = ((1 - nu) a + b)/(pi G),   Ayy = (a + (1 - nu) b)/(pi G),   Axy = nu c/(pi G)
//! Axz = -K/(pi G) [Y ln r + X atan(Y/X)],   Ayz = -K/(pi G) [X ln r + Y atan(X/Y)]
//! a = [X asinh(Y/|X|)],   b = [Y asinh(X/|Y|)],   c = [-r],   K/G = ((1 - 2 nu1)/G1 - (1 - 2 nu2)/G2)/4
//! ```
//!
//! and far from it sums over sixteen Gauss points of the kernels that these are integrals of. Tractions displace along the normal by
//! `-(Axz qx + Ayz qy)`.

use std::cell::OnceCell;
use std::f64::consts::PI;

use crate::fft::Convolution;
use crate::friction_place::Place;
use crate::grid::Grid;
use crate::hankel::gauss;

pub type Vector = [f64; 2];

/// From so many of an element's longer sides on, points stand for it: four of them a side leave `(1/120)^8`.
const FAR: f64 = 30.0;
/// Products of more terms are done by the transform.
const LONG: usize = 300_000;

/// xx, yy, xy, xz, yz.
type Entry = [f64; 5];

/// What the bodies do: 1/G, nu/G and K/G, means of both and their difference.
#[derive(Clone, Copy)]
struct Compliance {
    shear: f64,
    poisson: f64,
    unlike: f64,
}

/// Coefficients between the elements of a grid, displaced by so many lengths.
pub struct Operator {
    grid: Grid,
    /// Of offsets `-(m - 1)..m`.
    pub table: Vec<Entry>,
    couples: bool,
    /// What rounding may do to a displacement by loads whose sizes add up to 1, and by loads whose 2-norm is 1.
    rounding: [f64; 2],
    transforms: OnceCell<[Convolution; 5]>,
}

/// Differences of the closed forms over the corners, and the largest of their terms.
fn near(c: Compliance, [x, y]: Vector, [dx, dy]: Vector) -> (Entry, f64) {
    let (mut sums, mut largest) = ([0.0; 5], 0.0f64);
    for (sx, sy) in [(0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)] {
        let (cx, cy) = (x + sx * dx, y + sy * dy);
        let term = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() };
        let across = |a: f64, b: f64| {
            // In units of the element: its logarithm goes out.
            let along = if b == 0.0 { 0.0 } else { b * (a.hypot(b) / dx).ln() };
            along + if a == 0.0 { 0.0 } else { a * (b / a).atan() }
        };
        let parts = [term(cx, cy), term(cy, cx), -cx.hypot(cy), across(cx, cy), across(cy, cx)];
        largest = parts.iter().fold(largest, |largest, part| largest.max(part.abs()));
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

/// Gauss points.
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

impl Operator {
    pub fn new(place: &Place, by: Vector) -> Operator {
        let Grid { mx, my, dx, dy } = place.grid;
        let each = |of: [f64; 2]| [0, 1].map(|b: usize| of[b] / place.shear_modulus[b]);
        let [shear, poisson] = [each([1.0; 2]), each(place.poisson_ratio)].map(|[a, b]| 0.5 * (a + b));
        let [one, other] = each(place.poisson_ratio.map(|nu| 1.0 - 2.0 * nu));
        let unlike = if place.is_alike() { 0.0 } else { 0.25 * (one - other) };
        let (c, rule) = (Compliance { shear, poisson, unlike }, gauss(4));
        let mut largest: f64 = 0.0;
        let mut entry = |kx: i64, ky: i64| {
            let at = [kx as f64 * dx + by[0], ky as f64 * dy + by[1]];
            if at[0].hypot(at[1]) > FAR * dx.max(dy) {
                return far(c, &rule, at, [dx, dy]);
            }
            let (entry, terms) = near(c, at, [dx, dy]);
            largest = largest.max(terms);
            entry
        };
        let reach = |m: usize| 1 - m as i64..m as i64;
        let table: Vec<Entry> =
            reach(my).flat_map(|ky| reach(mx).map(move |kx| (kx, ky))).map(|(kx, ky)| entry(kx, ky)).collect();
        let greatest = table.iter().flatten().fold(0.0, |greatest: f64, value| greatest.max(value.abs()));
        let norm = table.iter().flatten().map(|value| value * value).sum::<f64>().sqrt();
        // Eight terms, each to some units of round-off of the largest; and the transforms, here and there.
        let terms = (shear + poisson.abs() + unlike.abs()) * largest / PI + greatest;
        let steps = 4.0 + (16.0 * table.len() as f64).log2();
        let rounding = [64.0 * f64::EPSILON * terms, 8.0 * steps * f64::EPSILON * norm];
        Operator { grid: place.grid, table, couples: unlike != 0.0, rounding, transforms: OnceCell::new() }
    }

    /// Whether pressures displace sideways and tractions along the normal.
    pub fn couples(&self) -> bool {
        self.couples
    }

    /// What rounding may do to a displacement by these loads.
    pub fn rounding(&self, loads: impl Iterator<Item = f64>) -> f64 {
        let (sum, squares) =
            loads.fold((0.0, 0.0f64), |(sum, squares), load| (sum + load.abs(), squares + load * load));
        self.rounding[0] * sum + self.rounding[1] * squares.sqrt()
    }

    /// The coefficients of element i by a load of 1 on element j.
    pub fn between(&self, i: usize, j: usize) -> Entry {
        let (mx, my) = (self.grid.mx, self.grid.my);
        let (kx, ky) = (i % mx + mx - 1 - j % mx, i / mx + my - 1 - j / mx);
        self.table[ky * (2 * mx - 1) + kx]
    }

    fn transforms(&self) -> &[Convolution; 5] {
        let (mx, my) = (self.grid.mx as i64, self.grid.my as i64);
        let at = |kx: i64, ky: i64| ((ky + my - 1) * (2 * mx - 1) + kx + mx - 1) as usize;
        self.transforms.get_or_init(|| {
            [0, 1, 2, 3, 4]
                .map(|k: usize| Convolution::new(self.grid.mx, self.grid.my, |kx, ky| self.table[at(kx, ky)][k]))
        })
    }

    /// Displacements x, y and along the normal by tractions.
    pub fn by_tractions(&self, q: &[Vector]) -> Vec<[f64; 3]> {
        let loaded: Vec<usize> = (0..q.len()).filter(|&j| q[j] != [0.0; 2]).collect();
        if loaded.len() * q.len() <= LONG {
            let add = |i: usize, u: [f64; 3], j: usize| {
                let ([xx, yy, xy, xz, yz], [qx, qy]) = (self.between(i, j), q[j]);
                [u[0] + xx * qx + xy * qy, u[1] + xy * qx + yy * qy, u[2] - xz * qx - yz * qy]
            };
            return (0..q.len()).map(|i| loaded.iter().fold([0.0; 3], |u, &j| add(i, u, j))).collect();
        }
        let [x, y] = [0, 1].map(|k: usize| q.iter().map(|q| q[k]).collect::<Vec<f64>>());
        let [xx, yy, xy, xz, yz] = self.transforms();
        let [of_x, of_y] = xy.apply([&x, &y]);
        let mut u: Vec<[f64; 3]> = (0..q.len()).map(|i| [of_y[i], of_x[i], 0.0]).collect();
        for (k, sign, sum) in [(0, 1.0, xx.of(&x)), (1, 1.0, yy.of(&y))] {
            u.iter_mut().zip(sum).for_each(|(u, value)| u[k] += sign * value);
        }
        if self.couples {
            for sum in [xz.of(&x), yz.of(&y)] {
                u.iter_mut().zip(sum).for_each(|(u, value)| u[2] -= value);
            }
        }
        u
    }

    /// Displacements in x and y by pressures.
    pub fn by_pressures(&self, p: &[f64]) -> Vec<Vector> {
        if !self.couples {
            return vec![[0.0; 2]; p.len()];
        }
        let loaded: Vec<usize> = (0..p.len()).filter(|&j| p[j] != 0.0).collect();
        if loaded.len() * p.len() <= LONG {
            let add = |i: usize, u: Vector, j: usize| {
                let [_, _, _, xz, yz] = self.between(i, j);
                [u[0] + xz * p[j], u[1] + yz * p[j]]
            };
            return (0..p.len()).map(|i| loaded.iter().fold([0.0; 2], |u, &j| add(i, u, j))).collect();
        }
        let [_, _, _, xz, yz] = self.transforms();
        xz.of(p).into_iter().zip(yz.of(p)).map(|(x, y)| [x, y]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(mx: usize, my: usize) -> Place {
        Place::new(Grid { mx, my, dx: 0.7, dy: 0.4 }, [2.0, 5.0], [0.3, 0.1])
    }

    /// By midpoints of the kernels `((1 - nu)/r + nu x^2/r^3)/(2 pi G)` of both bodies, and `-K x/r^2/(pi G)`.
    #[test]
    fn closed_forms_are_integrals() {
        let (place, m) = (place(4, 3), 200);
        let operator = Operator::new(&place, [0.2, -0.1]);
        let (x, y) = (3.0 * 0.7 + 0.2, 2.0 * 0.4 - 0.1);
        let mut sums = [0.0; 5];
        for i in 0..m * m {
            let at = |i: usize, d: f64| ((i as f64 + 0.5) / m as f64 - 0.5) * d;
            let (x, y) = (x - at(i % m, 0.7), y - at(i / m, 0.4));
            let r = x.hypot(y);
            let body = |nu: f64, g: f64| {
                let of = [(1.0 - nu) / r + nu * x * x / r.powi(3), (1.0 - nu) / r + nu * y * y / r.powi(3)];
                [of[0], of[1], nu * x * y / r.powi(3)].map(|value| value / (2.0 * PI * g))
            };
            let (one, other) = (body(0.3, 2.0), body(0.1, 5.0));
            let unlike = 0.25 * (0.4 / 2.0 - 0.8 / 5.0) / PI;
            let [xx, yy, xy] = [0, 1, 2].map(|k: usize| one[k] + other[k]);
            let kernel = [xx, yy, xy, -unlike * x / (r * r), -unlike * y / (r * r)];
            (0..5).for_each(|k| sums[k] += kernel[k] * 0.28 / (m * m) as f64);
        }
        let found = operator.table[4 * 7 + 6];
        for k in 0..5 {
            let size = if k < 3 { sums[0] } else { sums[3].abs() };
            assert!((found[k] - sums[k]).abs() <= 1e-5 * size, "{k}: {} for {}", found[k], sums[k]);
        }
    }

    /// Where both are used: to what the closed forms leave of their terms.
    #[test]
    fn far_and_near_agree() {
        let (c, rule) = (Compliance { shear: 0.5, poisson: 0.1, unlike: 0.2 }, gauss(4));
        for at in [[21.5, 0.3], [0.0, -22.0], [-16.0, 15.0]] {
            let ((near, terms), far) = (near(c, at, [0.7, 0.4]), far(c, &rule, at, [0.7, 0.4]));
            assert!((0..5).all(|k| (near[k] - far[k]).abs() <= 32.0 * f64::EPSILON * terms), "{near:?} {far:?}");
        }
    }

    /// The transform does the sums, of tractions and of pressures.
    #[test]
    fn transforms_do_the_sums() {
        let operator = Operator::new(&place(40, 31), [0.2, 0.0]);
        let q: Vec<Vector> = (0..1240).map(|i| [f64::from(i % 7) - 3.0, f64::from(i % 5)]).collect();
        let p: Vec<f64> = (0..1240).map(|i| f64::from(i % 11)).collect();
        let (by_q, by_p) = (operator.by_tractions(&q), operator.by_pressures(&p));
        for i in [0, 77, 620, 1239] {
            let mut sums = [0.0; 5];
            for j in 0..1240 {
                let ([xx, yy, xy, xz, yz], [qx, qy]) = (operator.between(i, j), q[j]);
                let terms = [xx * qx + xy * qy, xy * qx + yy * qy, -xz * qx - yz * qy, xz * p[j], yz * p[j]];
                (0..5).for_each(|k| sums[k] += terms[k]);
            }
            let found = [by_q[i][0], by_q[i][1], by_q[i][2], by_p[i][0], by_p[i][1]];
            assert!((0..5).all(|k| (found[k] - sums[k]).abs() <= 1e-11 * sums[0].abs()), "{found:?} {sums:?}");
        }
    }
}
