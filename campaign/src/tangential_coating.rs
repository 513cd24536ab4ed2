//! The change of displacements by tractions that a coating of both bodies causes, compared with half-spaces of the layer's material.
//!
//! With the transfer functions L along a wave and T across it (`hankel`), a wave k of tractions causes the displacements
//! `((1 - nu1) L k k^T/k^2 + T (1 - k k^T/k^2))/(G1 k)`. In real space the changes, of both bodies and in units of 1/(pi G1 t), are
//!
//! ```text
//! xx = S + D cos 2 theta,   yy = S - D cos 2 theta,   xy = D sin 2 theta
//! S(rho) = integral over s > 0 of (T - 1 + (1 - nu1) (L - 1))/2 J0(s rho),   D(rho) = integral of (T - 1 - (1 - nu1) (L - 1))/2 J2(s rho)
//! ```
//!
//! S and D are tabulated along the distance, and integrated over elements by Gauss's rule, as for pressures (`coating`).

use crate::coating::Coating;
use crate::grid::Grid;
use crate::hankel::{of_tractions, Rules, Table};
use crate::tangential_coefficients::Vector;

/// The error of a coefficient, relative to the largest one, of the library and of this module together. Four digits cancel in L, and the tables have
/// an error of 1e-13.
pub const ACCURACY: f64 = 1e-11;

/// The change of the coefficients by a coating.
pub struct Coat {
    /// S and D. None if the layer has no thickness.
    tables: Option<[Table; 2]>,
    /// The thickness of the layer.
    t: f64,
    /// The sides of an element.
    sides: Vector,
    rules: Rules,
}

/// The Bessel function J2, for the terms in 2 theta.
fn j2(x: f64) -> f64 {
    libm::jn(2, x)
}

impl Coat {
    /// The change on a grid. Displacements are at places that are shifted by `by` from the centres of elements.
    pub fn new(coating: &Coating, grid: &Grid, by: Vector) -> Coat {
        let (_, t, mu, nu) = coating.surface(0);
        let reach = |m: usize, d: f64, by: f64| (m as f64 + 1.0) * d + by.abs();
        let last = reach(grid.mx, grid.dx, by[0]).hypot(reach(grid.my, grid.dy, by[1])) / t;
        let parts = |s: f64| {
            let [along, across] = of_tractions(mu, nu, s);
            [(1.0 - nu[0]) * (along - 1.0), across - 1.0]
        };
        let sum = |s: f64| 0.5 * (parts(s)[1] + parts(s)[0]);
        let difference = |s: f64| 0.5 * (parts(s)[1] - parts(s)[0]);
        let tables = (t > 0.0).then(|| [Table::of(mu, &sum, libm::j0, last), Table::of(mu, &difference, j2, last)]);
        Coat {
            tables,
            t,
            sides: [grid.dx, grid.dy],
            rules: Rules::new(grid.dx.max(grid.dy) / if t > 0.0 { t } else { 1.0 }),
        }
    }

    /// The changes of xx, yy and xy at an offset, in units of 1/(pi G1).
    pub fn at(&self, at: Vector) -> [f64; 3] {
        let Some([s, d]) = &self.tables else { return [0.0; 3] };
        let [dx, dy] = self.sides;
        let rule = self.rules.at(at[0].hypot(at[1]) / self.t);
        let mut sums = [0.0; 3];
        for (u, wu) in rule {
            for (v, wv) in rule {
                let (x, y) = (at[0] + (u - 0.5) * dx, at[1] + (v - 0.5) * dy);
                let (r, w) = (x.hypot(y), wu * wv * dx * dy / self.t);
                let (s, d) = (w * s.at(r / self.t), w * d.at(r / self.t));
                let (cosine, sine) = if r > 0.0 { (x / r, y / r) } else { (1.0, 0.0) };
                sums[0] += s + d * (cosine * cosine - sine * sine);
                sums[1] += s - d * (cosine * cosine - sine * sine);
                sums[2] += d * 2.0 * cosine * sine;
            }
        }
        // xy is odd in x and in y, so it is 0 on both axes.
        if at[0] == 0.0 || at[1] == 0.0 {
            sums[2] = 0.0;
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coating::Layer;

    /// The coefficients of 3 x 3 elements add up to that of one element with sides three times as long.
    #[test]
    fn nine_elements_are_one() {
        for (t, modulus, below, nu) in [
            (1.6, 1.0, f64::INFINITY, [0.5, 0.3]),
            (4.0, 0.2, 1.0, [0.3, 0.1]),
            (1.6, 20.0, 1.0, [0.0, 0.5]),
            (0.16, 5e3, 1.0, [0.3, 0.4]),
        ] {
            let layer = Some(Layer { thickness: t, shear_modulus: modulus, poisson_ratio: nu[0] });
            let coating = Coating { layers: [layer; 2], shear_modulus: [below; 2], poisson_ratio: [nu[1]; 2] };
            let fine = Coat::new(&coating, &Grid { mx: 40, my: 40, dx: 1.0, dy: 0.7 }, [0.0; 2]);
            let coarse = Coat::new(&coating, &Grid { mx: 14, my: 14, dx: 3.0, dy: 2.1 }, [0.0; 2]);
            let largest = coarse.at([0.0; 2])[0].abs();
            for at in [[0.0, 0.0], [3.0, 0.0], [1.1, 4.2], [15.0, -6.0], [33.0, 20.0]] {
                let nine = (-1..2).flat_map(|j| (-1..2).map(move |i| (f64::from(i), f64::from(j))));
                let mut sum = [0.0; 3];
                for (i, j) in nine {
                    let one = fine.at([at[0] + i, at[1] + 0.7 * j]);
                    (0..3).for_each(|k| sum[k] += one[k]);
                }
                let whole = coarse.at(at);
                let off = (0..3).map(|k| (sum[k] - whole[k]).abs()).fold(0.0, f64::max);
                assert!(off <= ACCURACY * largest, "{t} {modulus} {at:?}: {sum:?} {whole:?}");
            }
        }
    }
}
