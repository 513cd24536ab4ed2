//! Coatings: the influence coefficients of a bonded layer on a body, by a quadrature of the Hankel integral of its transfer function.
//!
//! With a layer of thickness t, a unit pressure on one element displaces the surface more than that of a half-space of the layer's material, by
//!
//! ```text
//! c (1/t) integral over the element of F(r/t),    F(rho) = integral over s > 0 of (B(s) - 1) J0(s rho),    c = (1 - nu1)/(2 pi G1)
//! ```
//!
//! F is analytic in |Im rho| < 2. It is tabulated along the distance, and integrated over elements by Gauss's rule. Near the load the panels of the
//! rule are at most two thicknesses long.
//!
//! With two periods the additional displacement is a sum over the waves k of the grid and their aliases, with the factors `2 pi c (B(k t) - 1)/k`
//! times the means of the wave over elements. The mean pressure P compresses the layer by `P t/M`, with `M = 2 G1 (1 - nu1)/(1 - 2 nu1)`.

use std::f64::consts::PI;

use crate::grid::Grid;
use crate::half_space::{free, periodic, Quadrant};
use crate::hankel::{transfer, Rules, Table};
use crate::random::Random;

/// A bonded layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    pub thickness: f64,
    pub shear_modulus: f64,
    pub poisson_ratio: f64,
}

/// The layers of both bodies, and the materials of the bodies below.
#[derive(Clone, Debug, PartialEq)]
pub struct Coating {
    pub layers: [Option<Layer>; 2],
    /// The shear moduli of the bodies below the layers.
    pub shear_modulus: [f64; 2],
    /// The Poisson ratios of the bodies below the layers.
    pub poisson_ratio: [f64; 2],
}

/// The error of coefficients, relative to the largest one, for G1/G2 of 0.01 to 100: that of the library, and as much of this module.
const ACCURACY: f64 = 2e-10;
/// Above this G1/G2 the error of coefficients grows in proportion to G1/G2.
const STIFF: f64 = 100.0;

/// Random layers on one body or on both; one body may be rigid. On small grids with two periods the thickness is down to 1/16 of an element.
pub fn random(
    random: &mut Random,
    grid: &Grid,
    (shear_modulus, poisson_ratio): ([f64; 2], [f64; 2]),
    period: Option<(bool, bool)>,
) -> Coating {
    let longer = grid.dx.max(grid.dy);
    let is_thin = period == Some((true, true)) && grid.len() <= 600;
    let size = (grid.mx as f64 * grid.dx).hypot(grid.my as f64 * grid.dy);
    let mut layer = |b: usize| {
        let equal = random.chance(0.05);
        let factor = random.decades(0.01, 100.0);
        let thickness = match is_thin {
            true => longer * random.decades(0.0626, 50.0),
            false => f64::max(longer * random.decades(0.5, 50.0), 0.02 * size),
        };
        // The library refuses a layer on a rigid body that is thin and almost incompressible.
        let is_rigid = shear_modulus[b].is_infinite();
        let below = if is_rigid { shear_modulus[0] } else { shear_modulus[b] };
        let poisson_ratio = match equal {
            true => poisson_ratio[b],
            false => random.between(0.0, if is_rigid && is_thin { 0.45 } else { 0.5 }),
        };
        let shear_modulus = below * if equal { 1.0 } else { factor };
        Layer { thickness: if random.chance(0.05) { 0.0 } else { thickness }, shear_modulus, poisson_ratio }
    };
    let layers = [layer(0), layer(1)];
    let layers = match random.integer(0, 2) {
        1 => [None, Some(layers[1])],
        2 => layers.map(Some),
        _ => [Some(layers[0]), None],
    };
    Coating { layers, shear_modulus, poisson_ratio }
}

/// The largest number of elements of a grid whose layers may be as thin as a twentieth of an element. For such layers the table along the distance is
/// long.
const FEW: usize = 2500;

/// The same random layer on two equal bodies. Some layers are thin and stiff. Sometimes the bodies become rigid, and the layer gets their shear
/// modulus.
pub fn on_both(random: &mut Random, grid: &Grid, (shear_modulus, poisson_ratio): (f64, f64)) -> Coating {
    let coating = self::random(random, grid, ([shear_modulus; 2], [poisson_ratio; 2]), None);
    let Some(mut layer) = coating.layers[0].or(coating.layers[1]) else { return coating };
    let mut beside = random.beside(0x57aff);
    if grid.len() <= FEW && beside.chance(0.3) {
        layer.thickness = grid.dx.max(grid.dy) * beside.decades(0.05, 0.7);
        layer.shear_modulus = shear_modulus * beside.decades(10.0, 1e4);
        return Coating { layers: [Some(layer); 2], ..coating };
    }
    let on_rigid = random.chance(0.3) && layer.thickness > 0.0;
    let layer = Layer { shear_modulus: if on_rigid { shear_modulus } else { layer.shear_modulus }, ..layer };
    let shear_modulus = if on_rigid { [f64::INFINITY; 2] } else { coating.shear_modulus };
    Coating { layers: [Some(layer); 2], shear_modulus, ..coating }
}

impl Coating {
    /// `(c, t, G1/G2, [nu1, nu2])` of a body, with the layer as 1 and the body below as 2. The thickness t is 0 if the body has no layer.
    pub fn surface(&self, b: usize) -> (f64, f64, f64, [f64; 2]) {
        let (g, nu) = (self.shear_modulus[b], self.poisson_ratio[b]);
        match self.layers[b].filter(|layer| layer.thickness > 0.0) {
            Some(layer) => {
                let c = (1.0 - layer.poisson_ratio) / (2.0 * PI * layer.shear_modulus);
                (c, layer.thickness, layer.shear_modulus / g, [layer.poisson_ratio, nu])
            }
            None => ((1.0 - nu) / (2.0 * PI * g), 0.0, 1.0, [nu, nu]),
        }
    }

    /// The compliance `c = 1/(pi E*)` of the materials at both surfaces.
    pub fn compliance(&self) -> f64 {
        let [(c1, ..), (c2, ..)] = [0, 1].map(|b| self.surface(b));
        c1 + c2
    }

    /// The shear moduli and Poisson ratios at the surfaces, for a coating that is the same on both bodies.
    pub fn at_surface(&self) -> ([f64; 2], [f64; 2]) {
        let below = (self.shear_modulus, self.poisson_ratio);
        let layer = self.layers[0].filter(|layer| layer.thickness > 0.0);
        layer.map_or(below, |layer| ([layer.shear_modulus; 2], [layer.poisson_ratio; 2]))
    }

    /// The coefficients of both bodies together. With one period they are those of half-spaces of the materials at the surfaces: the library refuses
    /// coatings with one period.
    pub fn coefficients(&self, grid: &Grid, period: Option<(bool, bool)>) -> Quadrant {
        let Grid { mx, my, dx, dy } = *grid;
        let surfaces = [self.surface(0), self.surface(1)];
        let c = self.compliance();
        let mut quadrant = match period {
            Some(period) => periodic(mx, my, dx, dy, c, period),
            None => free(mx, my, dx, dy, c),
        };
        for (c, t, mu, nu) in surfaces {
            if t == 0.0 {
                continue;
            }
            match period {
                Some((true, true)) => {
                    add_waves(grid, (c, t, mu, nu), &mut quadrant.values);
                    let mean = compression((c, t, mu, nu)) / grid.len() as f64;
                    quadrant.values.iter_mut().for_each(|value| *value += mean);
                }
                Some(_) => {}
                None => add_elements(grid, (c, t, mu, nu), &mut quadrant.values),
            }
        }
        let largest = quadrant.values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        // In stiffer layers digits cancel.
        let stiffest = surfaces.iter().fold(STIFF, |most: f64, (_, _, mu, _)| most.max(*mu));
        quadrant.rounding += ACCURACY * largest * stiffest / STIFF;
        quadrant
    }
}

/// The compression of a layer by a mean pressure of 1, `t/M`. It is 0 if the layer has the material of the body.
fn compression((c, t, mu, [nu1, nu2]): (f64, f64, f64, [f64; 2])) -> f64 {
    if mu == 1.0 && nu1 == nu2 {
        return 0.0;
    }
    // c is (1 - nu1)/(2 pi G1).
    PI * c * t * (1.0 - 2.0 * nu1) / ((1.0 - nu1) * (1.0 - nu1))
}

/// Adds the changes of the coefficients by a layer, without a period.
fn add_elements(grid: &Grid, (c, t, mu, nu): (f64, f64, f64, [f64; 2]), values: &mut [f64]) {
    let Grid { mx, my, dx, dy } = *grid;
    let table = Table::new(mu, nu, ((mx as f64 + 1.0) * dx).hypot((my as f64 + 1.0) * dy) / t);
    let rules = Rules::new(dx.max(dy) / t);
    for (k, value) in values.iter_mut().enumerate() {
        let (x, y) = ((k % mx) as f64 * dx, (k / mx) as f64 * dy);
        let rule = rules.at(x.hypot(y) / t);
        let mut mean = 0.0;
        for (u, wu) in rule {
            for (v, wv) in rule {
                mean += wu * wv * table.at((x + (u - 0.5) * dx).hypot(y + (v - 0.5) * dy) / t);
            }
        }
        *value += c * dx * dy / t * mean;
    }
}

/// Adds the changes of the coefficients by a layer, with two periods, except for the mean.
fn add_waves(grid: &Grid, (c, t, mu, nu): (f64, f64, f64, [f64; 2]), values: &mut [f64]) {
    let Grid { mx, my, dx, dy } = *grid;
    let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
    let reach = |d: f64| (18.0 * d / (2.0 * PI * t)).ceil() as i64 + 1;
    let number = |i: usize, m: usize, alias: i64, d: f64| 2.0 * PI * (i as f64 / m as f64 + alias as f64) / d;
    let mut in_x = vec![0.0; mx * my];
    for j in 0..my {
        for i in 0..mx {
            let mut sum = 0.0;
            for a in -reach(dx)..=reach(dx) {
                for b in -reach(dy)..=reach(dy) {
                    let (kx, ky) = (number(i, mx, a, dx), number(j, my, b, dy));
                    let k = kx.hypot(ky);
                    if k > 0.0 && k * t < 20.0 {
                        sum += (transfer(mu, nu, k * t) - 1.0) / k * sinc(0.5 * kx * dx) * sinc(0.5 * ky * dy);
                    }
                }
            }
            for kx in 0..mx {
                in_x[j * mx + kx] += sum * (2.0 * PI * ((i * kx) % mx) as f64 / mx as f64).cos();
            }
        }
    }
    for ky in 0..my {
        for j in 0..my {
            let factor = 2.0 * PI * c * (2.0 * PI * ((j * ky) % my) as f64 / my as f64).cos() / (mx * my) as f64;
            for kx in 0..mx {
                values[ky * mx + kx] += factor * in_x[j * mx + kx];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A layer of thickness t on one body, with G1/G2 = mu. If mu is 0, the body is rigid.
    fn layer_on_body(t: f64, mu: f64, nu: [f64; 2]) -> Coating {
        let (modulus, below) = if mu == 0.0 { (1.0, f64::INFINITY) } else { (mu, 1.0) };
        let layer = Layer { thickness: t, shear_modulus: modulus, poisson_ratio: nu[0] };
        Coating { layers: [Some(layer), None], shear_modulus: [below, f64::INFINITY], poisson_ratio: [nu[1], 0.3] }
    }

    /// The coefficients of 3 x 3 elements add up to that of one element with sides three times as long.
    #[test]
    fn nine_elements_are_one() {
        for (t, mu, nu) in [
            (1.5, 0.01, [0.5, 0.3]),
            (4.0, 0.2, [0.3, 0.1]),
            (1.5, 10.0, [0.0, 0.5]),
            (1.5, 0.0, [0.5, 0.3]),
            (12.0, 100.0, [0.3, 0.3]),
            (0.16, 5e3, [0.3, 0.2]),
        ] {
            let coating = layer_on_body(t, mu, nu);
            let fine = coating.coefficients(&Grid { mx: 40, my: 40, dx: 1.0, dy: 0.7 }, None);
            let coarse = coating.coefficients(&Grid { mx: 12, my: 12, dx: 3.0, dy: 2.1 }, None);
            for (kx, ky) in [(0, 0), (1, 0), (0, 2), (5, 3), (11, 11)] {
                let nine = (-1..2).flat_map(|j| (-1..2).map(move |i| (3 * kx + i, 3 * ky + j)));
                let sum: f64 = nine.map(|(kx, ky)| fine.at(kx, ky)).sum();
                let error = (sum - coarse.at(kx, ky)).abs();
                // Half of the allowed error belongs to this module, and the test allows half of that.
                assert!(
                    error <= 0.25 * coarse.rounding,
                    "t {t} mu {mu} ({kx}, {ky}): {error:e} of {:e}",
                    coarse.rounding
                );
            }
        }
    }

    /// A layer of the body's material has the coefficients of the half-space, and so has a layer that is so thick that the body below has no effect.
    #[test]
    fn limits_are_half_spaces() {
        let grid = Grid { mx: 20, my: 16, dx: 1.0, dy: 1.0 };
        let plain = free(20, 16, 1.0, 1.0, 0.7 / (2.0 * PI));
        let same = layer_on_body(3.0, 1.0, [0.3, 0.3]).coefficients(&grid, None);
        assert!(same.values.iter().zip(&plain.values).all(|(a, b)| (a - b).abs() <= 1e-13));
        let thick = layer_on_body(1e9, 5.0, [0.3, 0.1]).coefficients(&grid, None);
        assert!(thick.values.iter().zip(&plain.values).all(|(a, b)| (5.0 * a - b).abs() <= 1e-8));
    }
}
