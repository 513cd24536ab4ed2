//! Products u = A p with the coefficients of the campaign, for every effect, and their possible round-off. Short products are direct sums; long ones
//! use the Fourier transform of the campaign.

use std::cell::OnceCell;

use crate::effects::{Effects, UserCoefficients, Values};
use crate::fft::Convolution;
use crate::grid::Grid;
use crate::half_space::{free, periodic, Quadrant};

/// The influence coefficients, without patches and layers.
enum Coefficients<'a> {
    HalfSpace(Quadrant),
    Table(&'a UserCoefficients),
    RowTables(&'a UserCoefficients),
}

/// The matrix A of a scene.
pub struct Operator<'a> {
    grid: Grid,
    effects: &'a Effects,
    coefficients: Coefficients<'a>,
    /// The 2-norm of all coefficients of a transform.
    norm: f64,
    /// The transform of the coefficients, which the first long product makes.
    convolution: OnceCell<Convolution>,
}

/// Products with more terms than this use the transform.
const LONG: usize = 2_000_000;

impl<'a> Operator<'a> {
    /// The matrix of a scene with these effects, on bodies with the compliance `c = 1/(pi E*)`.
    pub fn new(grid: &Grid, c: f64, effects: &'a Effects) -> Operator<'a> {
        let Grid { mx, my, dx, dy } = *grid;
        let coefficients = match (&effects.influence, &effects.row_tables, effects.period) {
            (Some(table), ..) => Coefficients::Table(table),
            (_, Some(tables), _) => Coefficients::RowTables(tables),
            _ if effects.coating.is_some() => {
                let coating = effects.coating.as_ref().expect("a coating");
                Coefficients::HalfSpace(coating.coefficients(grid, effects.period))
            }
            (.., Some(period)) => Coefficients::HalfSpace(periodic(mx, my, dx, dy, c, period)),
            _ => Coefficients::HalfSpace(free(mx, my, dx, dy, c)),
        };
        let values = match &coefficients {
            Coefficients::HalfSpace(quadrant) => &quadrant.values,
            Coefficients::Table(user) | Coefficients::RowTables(user) => &user.values,
        };
        // A quadrant has a quarter of the coefficients; those of all four have twice its norm. For tables this is an upper bound.
        let norm = 2.0 * values.iter().map(|v| v * v).sum::<f64>().sqrt();
        Operator { grid: *grid, effects, coefficients, norm, convolution: OnceCell::new() }
    }

    /// The influence of the middle element on itself, including its layer.
    pub fn diagonal(&self) -> f64 {
        let (ix, iy) = (self.grid.mx / 2, self.grid.my / 2);
        let layer = self.effects.layer.as_ref().map_or(0.0, |layer| layer.at(iy * self.grid.mx + ix));
        let mut row = vec![0.0; self.grid.mx];
        self.add(ix, iy, iy, 1.0, &mut row);
        let self_influence = row[ix] + layer;
        // A single element with two periods has no displacement. Then the influence without a period and with c = 1 is returned.
        if self_influence > 0.0 {
            self_influence
        } else {
            free(1, 1, self.grid.dx, self.grid.dy, 1.0).at(0, 0)
        }
    }

    /// Adds the displacements of the elements in row iy by a pressure on element `(jx, jy)` to `row`.
    fn add(&self, jx: usize, jy: usize, iy: usize, pressure: f64, row: &mut [f64]) {
        let mx = self.grid.mx;
        match &self.coefficients {
            Coefficients::HalfSpace(quadrant) => {
                let values = &quadrant.values[iy.abs_diff(jy) * mx..][..mx];
                let (left, right) = row.split_at_mut(jx);
                left.iter_mut().zip(values[..=jx].iter().rev()).for_each(|(u, a)| *u += a * pressure);
                right.iter_mut().zip(values).for_each(|(u, a)| *u += a * pressure);
            }
            Coefficients::Table(table) => {
                let start = (iy + table.cy - jy) * 2 * table.cx + table.cx - jx;
                row.iter_mut().zip(&table.values[start..]).for_each(|(u, a)| *u += a * pressure);
            }
            Coefficients::RowTables(tables) => {
                let start = (jy * tables.cy + iy) * 2 * tables.cx + tables.cx - jx;
                row.iter_mut().zip(&tables.values[start..]).for_each(|(u, a)| *u += a * pressure);
            }
        }
    }

    /// Computes the product u = A p.
    pub fn displace(&self, p: &[f64]) -> Vec<f64> {
        let mut u = if self.is_long(p) { self.by_transform(p) } else { self.by_sums(p) };
        if let Some(layer) = &self.effects.layer {
            u.iter_mut().zip(p).enumerate().for_each(|(i, (u, p))| *u += layer.at(i) * p);
        }
        u
    }

    /// Whether a product uses the transform. Row tables never do, because their product is no convolution in y.
    fn is_long(&self, p: &[f64]) -> bool {
        let terms = p.iter().filter(|p| **p != 0.0).count() * p.len();
        terms > LONG && !matches!(self.coefficients, Coefficients::RowTables(_))
    }

    /// Computes a product without layers by direct sums.
    fn by_sums(&self, p: &[f64]) -> Vec<f64> {
        let Grid { mx, my, .. } = self.grid;
        let mut u = vec![0.0; p.len()];
        let mut row = vec![0.0; mx];
        for j in (0..p.len()).filter(|&j| p[j] != 0.0) {
            for iy in 0..my {
                let to = &mut u[iy * mx..][..mx];
                let Some(patches) = &self.effects.patches else {
                    self.add(j % mx, j / mx, iy, p[j], to);
                    continue;
                };
                row.fill(0.0);
                self.add(j % mx, j / mx, iy, p[j], &mut row);
                let factors = &patches.factors[patches.patch[j] as usize * patches.count..];
                let of = &patches.patch[iy * mx..];
                to.iter_mut().zip(&row).zip(of).for_each(|((u, v), &patch)| *u += factors[patch as usize] * v);
            }
        }
        u
    }

    /// Computes a product without layers by the transform. With patches, the loads of each patch have a product of their own.
    fn by_transform(&self, p: &[f64]) -> Vec<f64> {
        let Grid { mx, my, .. } = self.grid;
        let convolution = self.convolution.get_or_init(|| match &self.coefficients {
            Coefficients::HalfSpace(quadrant) => Convolution::new(mx, my, |kx, ky| quadrant.at(kx, ky)),
            Coefficients::Table(table) => Convolution::new(mx, my, |kx, ky| {
                table.values[(ky + table.cy as i64) as usize * 2 * table.cx + (kx + table.cx as i64) as usize]
            }),
            Coefficients::RowTables(_) => unreachable!("row tables are no convolution"),
        });
        let Some(patches) = &self.effects.patches else { return convolution.of(p) };
        let mut u = vec![0.0; p.len()];
        for patch in 0..patches.count {
            let load = |(p, &its_patch): (&f64, &i32)| if its_patch as usize == patch { *p } else { 0.0 };
            let loads: Vec<f64> = p.iter().zip(&patches.patch).map(load).collect();
            let factors = &patches.factors[patch * patches.count..];
            let displaced = convolution.of(&loads);
            let elements = u.iter_mut().zip(&displaced).zip(&patches.patch);
            elements.for_each(|((u, v), &its_patch)| *u += factors[its_patch as usize] * v);
        }
        u
    }

    /// The possible round-off of a displacement. It includes that of the campaign's coefficients, and that of the library's product by FFT. The
    /// latter is at most some units of round-off, times log2 of the length of the transform, times the 2-norms of both factors (Higham, Accuracy and
    /// Stability of Numerical Algorithms, section 24.1).
    pub fn rounding(&self, p: &[f64]) -> f64 {
        let (sum, squares) = p.iter().fold((0.0, 0.0), |(sum, squares), p| (sum + p.abs(), squares + p * p));
        let coefficients = match &self.coefficients {
            Coefficients::HalfSpace(quadrant) => quadrant.rounding,
            _ => 0.0,
        };
        let layer = match &self.effects.layer {
            Some(Values::Uniform(value)) => *value,
            Some(Values::PerElement(values)) => values.iter().fold(0.0, |largest: f64, v| largest.max(*v)),
            None => 0.0,
        };
        let largest = p.iter().fold(0.0, |largest: f64, p| largest.max(p.abs()));
        // If the campaign uses its transform as well, both transforms have errors.
        let transforms = if self.is_long(p) { 2.0 } else { 1.0 };
        let steps = transforms * (4.0 + (4.0 * p.len() as f64).log2());
        // The library may add a layer of the same compliance everywhere to the coefficients.
        let norms = (self.norm + layer) * squares.sqrt();
        let rounding = coefficients * sum + f64::EPSILON * (4.0 * steps * norms + layer * largest);
        // The norm of coefficients near the largest double overflows.
        rounding.min(1e300)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Definiteness;
    use crate::random::Random;

    const GRID: Grid = Grid { mx: 5, my: 4, dx: 0.5, dy: 0.7 };

    /// A table and row tables with the coefficients of the half-space have the displacements of the half-space.
    #[test]
    fn the_three_kinds_of_coefficients_agree() {
        let Grid { mx, my, dx, dy } = GRID;
        let mut random = Random::new(1);
        let p: Vec<f64> = (0..GRID.len()).map(|_| random.uniform()).collect();
        let plain = Effects::default();
        let expected = Operator::new(&GRID, 1.0, &plain).displace(&p);
        let quadrant = free(mx + 2, my + 2, dx, dy, 1.0);
        let (cx, cy) = (mx as i64 + 1, my as i64);
        let offsets = (-cy..cy).flat_map(|ky| (-cx..cx).map(move |kx| (kx, ky)));
        let values = offsets.map(|(kx, ky)| quadrant.at(kx, ky)).collect();
        let table = UserCoefficients { cx: mx + 1, cy: my, values };
        let pairs = (0..my * my).flat_map(|k| (-cx..cx).map(move |kx| (kx, (k % my).abs_diff(k / my) as i64)));
        let values = pairs.map(|(kx, ky)| quadrant.at(kx, ky)).collect();
        let row_tables = UserCoefficients { cx: mx + 1, cy: my, values };
        for effects in [
            Effects { influence: Some(table), ..Effects::default() },
            Effects { row_tables: Some(row_tables), ..Effects::default() },
        ] {
            let found = Operator::new(&GRID, 1.0, &effects).displace(&p);
            // The round-off of 20 terms.
            assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= 20.0 * f64::EPSILON * b), "{found:?}");
        }
    }

    /// Products by the transform are the direct sums, also with patches, an unsymmetric table, or a period.
    #[test]
    fn the_transform_does_the_direct_sums() {
        let mut random = Random::new(3);
        let grid = Grid { mx: 30, my: 17, dx: 0.5, dy: 0.7 };
        let p: Vec<f64> = (0..grid.len()).map(|_| random.uniform()).collect();
        let table = crate::effects::table(&mut random, &grid, 1.0, Definiteness::Unsymmetric);
        let patches = crate::effects::patches(&mut random, &grid);
        for effects in [
            Effects::default(),
            Effects { influence: Some(table), ..Effects::default() },
            Effects { patches: Some(patches), ..Effects::default() },
            Effects { period: Some((true, false)), ..Effects::default() },
        ] {
            let operator = Operator::new(&grid, 1.0, &effects);
            let (found, expected) = (operator.by_transform(&p), operator.by_sums(&p));
            let rounding = operator.rounding(&p);
            assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= rounding), "{}", effects.name());
            assert!(rounding <= 1e-11 * expected[0].abs(), "{rounding:e}");
        }
    }

    /// Compares a product with patches and a layer with their formulas, element by element.
    #[test]
    fn patches_and_a_layer_enter_as_their_formulas_say() {
        let mut random = Random::new(2);
        let patches = crate::effects::patches(&mut random, &GRID);
        let layer = crate::effects::layer(&mut random, &GRID, 1.0);
        let p: Vec<f64> = (0..GRID.len()).map(|_| random.uniform()).collect();
        let quadrant = free(GRID.mx, GRID.my, GRID.dx, GRID.dy, 1.0);
        let effects = Effects { patches: Some(patches.clone()), layer: Some(layer.clone()), ..Effects::default() };
        let found = Operator::new(&GRID, 1.0, &effects).displace(&p);
        for (i, found) in found.iter().enumerate() {
            let term = |j: usize| {
                let factor = patches.factors[patches.patch[i] as usize * patches.count + patches.patch[j] as usize];
                let (kx, ky) = ((i % GRID.mx).abs_diff(j % GRID.mx), (i / GRID.mx).abs_diff(j / GRID.mx));
                factor * quadrant.at(kx as i64, ky as i64) * p[j]
            };
            let expected = (0..p.len()).map(term).sum::<f64>() + layer.at(i) * p[i];
            assert!((found - expected).abs() <= 40.0 * f64::EPSILON * expected, "{i}: {found}, {expected}");
        }
    }
}
