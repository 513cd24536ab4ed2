//! Tangential displacements by tractions and by pressures, for like and unlike bodies, with the coefficients of the campaign
//! (`tangential_coefficients`). Between unlike bodies tractions also cause normal displacements, `-(Axz qx + Ayz qy)`.

use std::cell::{Cell, OnceCell};
use std::f64::consts::PI;

use crate::fft::Convolution;
use crate::friction_place::Place;
use crate::grid::Grid;
use crate::own_tractions::Kind;
use crate::tangential_coating::{Coat, ACCURACY};
pub use crate::tangential_coefficients::Vector;
use crate::tangential_coefficients::{Compliance, Entry};

/// Products with more terms than this use the transform.
const LONG: usize = 300_000;

/// The coefficients between loads on the elements of a grid and displacements at places that are shifted by a vector from the elements.
pub struct Operator {
    grid: Grid,
    /// The coefficients at offsets `-(m - 1)..m` in each direction, row by row.
    pub table: Vec<Entry>,
    /// For row tables: the factors of the rows, which multiply loads and displacements.
    rows: Option<Vec<f64>>,
    /// Whether the bodies are unlike.
    couples: bool,
    /// The possible round-off of a displacement: by loads whose absolute values add up to 1, and by loads whose 2-norm is 1.
    rounding: [f64; 2],
    /// The transforms of xx, yy, xy, xz and yz, which the first long product makes.
    transforms: OnceCell<[Convolution; 5]>,
}

impl Operator {
    /// The coefficients of a place, for displacements that are shifted by `by`.
    pub fn new(place: &Place, by: Vector) -> Operator {
        let Grid { mx, my, dx, dy } = place.grid;
        let coating = place.effects.coating.as_ref();
        let Compliance { shear, poisson, unlike } = place.materials();
        let (element, kind) = (place.element(), place.traction_tables.as_ref().map(|tables| &tables.kind));
        let mut largest: f64 = 0.0;
        let coat = coating.map(|coating| Coat::new(coating, &place.grid, by));
        let mut entry = |kx: i64, ky: i64| {
            let at = [kx as f64 * dx + by[0], ky as f64 * dy + by[1]];
            let (mut entry, terms) = element.at(at);
            largest = largest.max(terms);
            if let Some(coat) = &coat {
                entry.iter_mut().zip(coat.at(at)).for_each(|(value, change)| *value += shear / PI * change);
            }
            entry
        };
        let reach = |m: usize| 1 - m as i64..m as i64;
        let table: Vec<Entry> = match kind {
            None => reach(my).flat_map(|ky| reach(mx).map(move |kx| (kx, ky))).map(|(kx, ky)| entry(kx, ky)).collect(),
            Some(kind) => {
                // With the caller's tables, steps of rolling are whole elements along x.
                let step = (by[0] / dx).round() as i64;
                let largest = &Cell::new(largest);
                let at = |kx: i64, ky: i64| {
                    let ([xx, yy, xy, ..], terms) = element.at([kx as f64 * dx, ky as f64 * dy]);
                    largest.set(largest.get().max(terms));
                    [xx, yy, xy]
                };
                let row = |ky: i64| kind.row(ky, 1 - mx as i64 + step, 2 * mx - 1, &at);
                reach(my).flat_map(row).map(|[xx, yy, xy]| [xx, yy, xy, 0.0, 0.0]).collect()
            }
        };
        let greatest = table.iter().flatten().fold(0.0, |greatest: f64, value| greatest.max(value.abs()));
        let norm = table.iter().flatten().map(|value| value * value).sum::<f64>().sqrt();
        // A coefficient has up to eight terms, each with a round-off of some units relative to the largest. Both transforms, here and in the library,
        // have errors as well.
        let terms = (shear + poisson.abs() + unlike.abs()) * largest / PI + greatest;
        let steps = 4.0 + (16.0 * table.len() as f64).log2();
        let quadrature = if coat.is_some() { ACCURACY * greatest } else { 0.0 };
        let rounding = [64.0 * f64::EPSILON * terms + quadrature, 8.0 * steps * f64::EPSILON * norm];
        let rows = match kind {
            Some(Kind::Rows { d }) => Some(d.clone()),
            _ => None,
        };
        Operator { grid: place.grid, table, rows, couples: unlike != 0.0, rounding, transforms: OnceCell::new() }
    }

    /// Whether pressures cause tangential displacements, and tractions normal ones: the bodies are unlike.
    pub fn couples(&self) -> bool {
        self.couples
    }

    /// The possible round-off of a displacement by these loads.
    pub fn rounding(&self, loads: impl Iterator<Item = f64>) -> f64 {
        let (sum, squares) =
            loads.fold((0.0, 0.0f64), |(sum, squares), load| (sum + load.abs(), squares + load * load));
        self.rounding[0] * sum + self.rounding[1] * squares.sqrt()
    }

    /// The coefficients for the displacement of element i by loads on element j.
    pub fn between(&self, i: usize, j: usize) -> Entry {
        let (mx, my) = (self.grid.mx, self.grid.my);
        let (kx, ky) = (i % mx + mx - 1 - j % mx, i / mx + my - 1 - j / mx);
        let entry = self.table[ky * (2 * mx - 1) + kx];
        entry.map(|value| self.row_factor(i) * self.row_factor(j) * value)
    }

    /// The factor of the row of element i.
    fn row_factor(&self, i: usize) -> f64 {
        self.rows.as_ref().map_or(1.0, |d| d[i / self.grid.mx])
    }

    /// The transforms of the table.
    fn transforms(&self) -> &[Convolution; 5] {
        let (mx, my) = (self.grid.mx as i64, self.grid.my as i64);
        let at = |kx: i64, ky: i64| ((ky + my - 1) * (2 * mx - 1) + kx + mx - 1) as usize;
        self.transforms.get_or_init(|| {
            [0, 1, 2, 3, 4]
                .map(|k: usize| Convolution::new(self.grid.mx, self.grid.my, |kx, ky| self.table[at(kx, ky)][k]))
        })
    }

    /// The displacements in x, in y and along the normal by tractions.
    pub fn by_tractions(&self, q: &[Vector]) -> Vec<[f64; 3]> {
        let loaded: Vec<usize> = (0..q.len()).filter(|&j| q[j] != [0.0; 2]).collect();
        if loaded.len() * q.len() <= LONG {
            let add = |i: usize, u: [f64; 3], j: usize| {
                let ([xx, yy, xy, xz, yz], [qx, qy]) = (self.between(i, j), q[j]);
                [u[0] + xx * qx + xy * qy, u[1] + xy * qx + yy * qy, u[2] - xz * qx - yz * qy]
            };
            return (0..q.len()).map(|i| loaded.iter().fold([0.0; 3], |u, &j| add(i, u, j))).collect();
        }
        let [x, y] =
            [0, 1].map(|k: usize| q.iter().enumerate().map(|(i, q)| self.row_factor(i) * q[k]).collect::<Vec<f64>>());
        let [xx, yy, xy, xz, yz] = self.transforms();
        // Tractions in x cause displacements in y by xy, and the reverse.
        let [y_by_x, x_by_y] = xy.apply([&x, &y]);
        let mut u: Vec<[f64; 3]> = (0..q.len()).map(|i| [x_by_y[i], y_by_x[i], 0.0]).collect();
        for (k, sum) in [(0, xx.of(&x)), (1, yy.of(&y))] {
            u.iter_mut().zip(sum).for_each(|(u, value)| u[k] += value);
        }
        if self.couples {
            for sum in [xz.of(&x), yz.of(&y)] {
                u.iter_mut().zip(sum).for_each(|(u, value)| u[2] -= value);
            }
        }
        u.iter_mut().enumerate().for_each(|(i, u)| *u = u.map(|value| self.row_factor(i) * value));
        u
    }

    /// The displacements in x and y by pressures. They are 0 between like bodies.
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

    /// Compares closed forms with the midpoint rule, for the kernels `((1 - nu)/r + nu x^2/r^3)/(2 pi G)` of both bodies and `-K x/r^2/(pi G)`.
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

    /// Products by the transform are the direct sums, for tractions and for pressures.
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
