//! The conditions of stick and slip, recomputed by direct sums.
//!
//! The coefficients are the campaign's own, differences of the closed forms over the corners of an element (Kalker 1990; Johnson,
//! Contact Mechanics, section 3.6), with `r = hypot(X, Y)`:
//!
//! ```text
//! Axx = ((1 - nu) a + b)/(pi G),   Ayy = (a + (1 - nu) b)/(pi G),   Axy = nu c/(pi G)
//! a = [X asinh(Y/|X|)],   b = [Y asinh(X/|Y|)],   c = [-r]
//! ```
//!
//! The slip is `s = w + A q - u'`. What is left of it counts where an element sticks, and where it slips but for what is opposite to q.
//! Every case of like bodies has to be solved but those of steady rolling that are not monotone, whose solution may be none or many.

use std::f64::consts::PI;

use contact_normal::ffi::{CONTACT_NORMAL_MOTION_SHIFT, CONTACT_NORMAL_MOTION_STEADY_ROLLING};

use crate::friction_case::{Case, Place};
use crate::friction_found::Found;
use crate::grid::Grid;

pub type Vector = [f64; 2];

/// Tractions of more than this part of the bound slip, by the library's documents.
pub const ON_THE_CIRCLE: f64 = 1.0 - 1e-7;

/// Own coefficients between elements, displaced by so many lengths.
pub struct Operator {
    grid: Grid,
    /// Of offsets `-(m - 1)..m`: xx, yy, xy.
    pub table: Vec<[f64; 3]>,
    /// What rounding may do to a displacement by tractions whose sizes add up to 1.
    rounding: f64,
}

impl Operator {
    pub fn new(place: &Place, by: Vector) -> Operator {
        let Grid { mx, my, dx, dy } = place.grid;
        let mean = |values: [f64; 2]| 0.5 * (values[0] / place.shear_modulus[0] + values[1] / place.shear_modulus[1]);
        let (shear, poisson) = (mean([1.0; 2]), mean(place.poisson_ratio));
        let mut largest: f64 = 0.0;
        let mut entry = |kx: i64, ky: i64| {
            let (x, y) = (kx as f64 * dx + by[0], ky as f64 * dy + by[1]);
            let mut sums = [0.0; 3];
            for (sx, sy) in [(0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)] {
                let (cx, cy) = (x + sx * dx, y + sy * dy);
                let term = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() };
                let parts = [term(cx, cy), term(cy, cx), -cx.hypot(cy)];
                largest = parts.iter().fold(largest, |largest, part| largest.max(part.abs()));
                (0..3).for_each(|k| sums[k] += 4.0 * sx * sy * parts[k]);
            }
            let [a, b, c] = sums;
            [shear * (a + b) - poisson * a, shear * (a + b) - poisson * b, poisson * c].map(|value| value / PI)
        };
        let reach = |m: usize| 1 - m as i64..m as i64;
        let table = reach(my).flat_map(|ky| reach(mx).map(move |kx| (kx, ky))).map(|(kx, ky)| entry(kx, ky)).collect();
        // Eight terms, each to some units of round-off of the largest; and the library's transforms.
        Operator { grid: place.grid, table, rounding: 64.0 * f64::EPSILON * (shear + poisson.abs()) * largest / PI }
    }

    /// The displacement of element i by tractions of 1 on element j: xx, yy, xy.
    fn between(&self, i: usize, j: usize) -> [f64; 3] {
        let (mx, my) = (self.grid.mx, self.grid.my);
        let (kx, ky) = (i % mx + mx - 1 - j % mx, i / mx + my - 1 - j / mx);
        self.table[ky * (2 * mx - 1) + kx]
    }

    /// Displacements by tractions.
    fn apply(&self, q: &[Vector]) -> Vec<Vector> {
        let displacement = |i: usize| {
            let mut u = [0.0; 2];
            for (j, q) in q.iter().enumerate().filter(|(_, q)| **q != [0.0; 2]) {
                let [xx, yy, xy] = self.between(i, j);
                u = [u[0] + xx * q[0] + xy * q[1], u[1] + xy * q[0] + yy * q[1]];
            }
            u
        };
        (0..q.len()).map(displacement).collect()
    }
}

pub fn length(v: Vector) -> f64 {
    v[0].hypot(v[1])
}

/// The root of the mean square, whatever the unit.
fn rms(lengths: &[f64]) -> f64 {
    let largest = lengths.iter().copied().fold(0.0, f64::max);
    if !(largest > 0.0) {
        return largest;
    }
    largest * (lengths.iter().map(|l| (l / largest).powi(2)).sum::<f64>() / lengths.len() as f64).sqrt()
}

/// What a call left of the conditions, and what it is compared with.
pub struct Conditions {
    pub left: f64,
    pub scale: f64,
    pub rounding: f64,
    /// The largest difference between the slip of the library and this one's.
    pub slip_error: f64,
}

/// The conditions by direct sums, of like bodies.
pub fn conditions(case: &Case, found: &Found, before: &[Vector]) -> Conditions {
    let slide = &case.slide;
    let step = slide.step(&case.place.grid);
    let is_steady = slide.motion == CONTACT_NORMAL_MOTION_STEADY_ROLLING;
    let (here, there) = (Operator::new(&case.place, [0.0; 2]), Operator::new(&case.place, step));
    let earlier = if is_steady { &found.q } else { before };
    let (u, u_before) = (here.apply(&found.q), there.apply(earlier));
    let size = |q: &[Vector]| q.iter().map(|q| length(*q)).sum::<f64>();
    let mut rounding = here.rounding * size(&found.q) + there.rounding * size(earlier);
    let (mut left, mut rigid, mut displaced, mut slip_error) = (Vec::new(), Vec::new(), Vec::new(), 0.0f64);
    for i in 0..found.q.len() {
        let (q, bound) = (found.q[i], slide.mu[i] * found.p[i]);
        if !(bound > 0.0) {
            continue;
        }
        let (w, largest) = slide.rigid_slip(&case.place.grid, i, found.report.creepage);
        rounding = rounding.max(8.0 * f64::EPSILON * largest + here.rounding * size(&found.q));
        let s = [0, 1].map(|k| w[k] + u[i][k] - u_before[i][k]);
        slip_error = slip_error.max(length([0, 1].map(|k| s[k] - found.slip[i][k])) - 8.0 * f64::EPSILON * largest);
        let mut rest = s;
        if length(q) >= bound * ON_THE_CIRCLE {
            let outward = q.map(|value| value / length(q));
            let along = (s[0] * outward[0] + s[1] * outward[1]).min(0.0);
            rest = [0, 1].map(|k| s[k] - along * outward[k]);
        }
        left.push(length(rest));
        rigid.push(length(w));
        displaced.push(length(if is_steady { [0, 1].map(|k| u[i][k] - u_before[i][k]) } else { u[i] }));
    }
    let or_displacements = match slide.motion {
        CONTACT_NORMAL_MOTION_SHIFT => 1.0,
        CONTACT_NORMAL_MOTION_STEADY_ROLLING if slide.has_forces() => 1.0,
        // Rolling slowly: what round-off of the displacements leaves.
        _ => 1.5e-8,
    };
    let scale = rms(&rigid).max(or_displacements * rms(&displaced));
    Conditions { left: rms(&left), scale, rounding, slip_error }
}

/// Whether steady rolling is a monotone problem, which has one solution: `B + B'` on C is positive definite, by Cholesky's
/// factors. It is not where a step is shorter than elements that are long in its direction.
pub fn is_monotone(case: &Case, found: &Found) -> bool {
    let step = case.slide.step(&case.place.grid);
    let (here, there) = (Operator::new(&case.place, [0.0; 2]), Operator::new(&case.place, step));
    let contact: Vec<usize> = (0..found.q.len()).filter(|&i| case.slide.mu[i] * found.p[i] > 0.0).collect();
    let n = 2 * contact.len();
    let entry = |row: usize, column: usize| {
        let [here, there] = [&here, &there].map(|operator| operator.between(contact[row / 2], contact[column / 2]));
        let k = if row % 2 == column % 2 { row % 2 } else { 2 };
        here[k] - there[k]
    };
    let mut factor = vec![0.0; n * n];
    for row in 0..n {
        for column in 0..=row {
            let (of_row, of_column) = (&factor[row * n..][..column], &factor[column * n..][..column]);
            let rest =
                entry(row, column) + entry(column, row) - of_row.iter().zip(of_column).map(|(a, b)| a * b).sum::<f64>();
            if row == column && !(rest > 0.0) {
                return false;
            }
            factor[row * n + column] = if row == column { rest.sqrt() } else { rest / factor[column * n + column] };
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By midpoints of the kernels `((1 - nu)/r + nu x^2/r^3)/(2 pi G)`, twice: two like bodies.
    #[test]
    fn the_closed_form_is_the_integral() {
        let grid = Grid { mx: 4, my: 3, dx: 0.7, dy: 0.4 };
        let place = Place::new(grid, [2.0; 2], [0.3; 2]);
        let operator = Operator::new(&place, [0.2, -0.1]);
        let (x, y, m) = (3.0 * 0.7 + 0.2, 2.0 * 0.4 - 0.1, 200);
        let mut sums = [0.0; 3];
        for i in 0..m * m {
            let at = |i: usize, d: f64| ((i as f64 + 0.5) / m as f64 - 0.5) * d;
            let (x, y) = (x - at(i % m, 0.7), y - at(i / m, 0.4));
            let r = x.hypot(y);
            let kernel =
                [0.7 / r + 0.3 * x * x / r.powi(3), 0.7 / r + 0.3 * y * y / r.powi(3), 0.3 * x * y / r.powi(3)];
            (0..3).for_each(|k| sums[k] += kernel[k] / (PI * 2.0) * 0.28 / (m * m) as f64);
        }
        let found = operator.table[4 * 7 + 6];
        for k in 0..3 {
            assert!((found[k] - sums[k]).abs() <= 1e-5 * sums[0], "{k}: {} for {}", found[k], sums[k]);
        }
    }
}
