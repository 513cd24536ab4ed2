//! Residuals continued outside C, for the preconditioner.
//!
//! On C, `A_CC^-1 r` is the least of `v . A^-1 v` over all fields v that are r on C. A continuation E of r beside C therefore makes
//! `E' M E`, with M near A^-1, a better inverse of `A_CC` than zeros outside do, and no continuation makes it too small. Here an element
//! outside takes a part of what lies about it in C, less the farther C is:
//!
//! ```text
//! coarse value = mean of the children's in C, or in what is known of them
//! E r = r in C;   DECAY times the interpolated coarse value outside, on each of LEVELS grids, from the coarsest
//! ```
//!
//! On rough surfaces, whose C is many small spots, it saves up to a third of the products (docs/friction.md).

use super::problem::{add, plus};
use super::Vector;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;

/// Coarser grids: C reaches eight elements far.
const LEVELS: usize = 3;
/// How much of the coarse value is left on the next finer grid.
const DECAY: f64 = 0.7;

/// E, and its transpose.
pub struct Extension {
    /// The given grid first.
    grids: Vec<Fields>,
}

/// One grid.
struct Fields {
    grid: Grid,
    /// Whether a value is known: in C, or where a child's is.
    known: Vec<bool>,
    /// Coarse values; of the given grid none.
    values: Vec<Vector>,
}

impl Extension {
    /// For a grid.
    pub fn new(grid: &Grid) -> Result<Extension> {
        let what = "the continuation of residuals";
        let mut grid = *grid;
        let mut grids = vec![Fields { grid, known: zeros(grid.len(), what)?, values: Vec::new() }];
        for _ in 0..LEVELS {
            grid = Grid { mx: grid.mx.div_ceil(2), my: grid.my.div_ceil(2), dx: 2.0 * grid.dx, dy: 2.0 * grid.dy };
            grids.push(Fields { grid, known: zeros(grid.len(), what)?, values: zeros(grid.len(), what)? });
        }
        Ok(Extension { grids })
    }

    /// C has changed: where `bound` is positive.
    pub fn contact_changed(&mut self, bound: &[f64]) {
        self.grids[0].known.iter_mut().zip(bound).for_each(|(known, g)| *known = *g > 0.0);
        for l in 1..self.grids.len() {
            let (fine, coarse) = self.pair(l);
            for k in 0..coarse.known.len() {
                coarse.known[k] = fine.known_children(k, &coarse.grid).next().is_some();
            }
        }
    }

    /// E r: fills in what is not known of `r`.
    pub fn fill(&mut self, r: &mut [Vector]) {
        for l in 1..self.grids.len() {
            let (fine, coarse) = self.pair(l);
            let from = if l == 1 { &*r } else { &fine.values };
            for k in 0..coarse.values.len() {
                let (mut sum, mut count) = ([0.0; 2], 0);
                for child in fine.known_children(k, &coarse.grid) {
                    (sum, count) = (add(sum, from[child]), count + 1);
                }
                coarse.values[k] = sum.map(|sum| sum / f64::from(count.max(1)));
            }
        }
        for l in (1..self.grids.len()).rev() {
            let (fine, coarse) = self.pair(l);
            let Fields { grid, known, values } = fine;
            let to = if l == 1 { &mut *r } else { values };
            for i in (0..to.len()).filter(|&i| !known[i]) {
                to[i] = [0.0; 2];
                coarse.around(i, grid.mx, |k, weight| to[i] = plus(to[i], DECAY * weight, coarse.values[k]));
            }
        }
    }

    /// E' z in C; elsewhere z is left as it is.
    pub fn fold(&mut self, z: &mut [Vector]) {
        for l in 1..self.grids.len() {
            let (fine, coarse) = self.pair(l);
            let from = if l == 1 { &*z } else { &fine.values };
            let mut sums = std::mem::take(&mut coarse.values);
            sums.fill([0.0; 2]);
            for i in (0..from.len()).filter(|&i| !fine.known[i]) {
                coarse.around(i, fine.grid.mx, |k, weight| sums[k] = plus(sums[k], DECAY * weight, from[i]));
            }
            coarse.values = sums;
        }
        for l in (1..self.grids.len()).rev() {
            let (fine, coarse) = self.pair(l);
            for k in (0..coarse.values.len()).filter(|&k| coarse.known[k]) {
                let share = 1.0 / fine.known_children(k, &coarse.grid).count() as f64;
                for child in coarse.grid.children(&fine.grid, k).filter(|&child| fine.known[child]) {
                    let to = if l == 1 { &mut z[child] } else { &mut fine.values[child] };
                    *to = plus(*to, share, coarse.values[k]);
                }
            }
        }
    }

    /// The grid before l, and l.
    fn pair(&mut self, l: usize) -> (&mut Fields, &mut Fields) {
        let (fine, coarse) = self.grids.split_at_mut(l);
        (&mut fine[l - 1], &mut coarse[0])
    }
}

impl Fields {
    /// The elements that are known in element k of the next coarser grid.
    fn known_children(&self, k: usize, coarse: &Grid) -> impl Iterator<Item = usize> + '_ {
        coarse.children(&self.grid, k).filter(|&child| self.known[child])
    }

    /// The elements between which the centre of element i of the next finer grid lies, `width` wide, and their weights.
    fn around(&self, i: usize, width: usize, mut take: impl FnMut(usize, f64)) {
        for (ix, in_x) in neighbours(i % width, self.grid.mx) {
            for (iy, in_y) in neighbours(i / width, self.grid.my) {
                take(self.grid.index(ix, iy), in_x * in_y);
            }
        }
    }
}

/// The two coarse places between which a fine one lies, and their weights.
pub fn neighbours(fine: usize, coarse: usize) -> [(usize, f64); 2] {
    let own = fine / 2;
    let other = if fine % 2 == 0 { own.checked_sub(1) } else { Some(own + 1).filter(|k| *k < coarse) };
    other.map_or([(own, 1.0), (own, 0.0)], |other| [(own, 0.75), (other, 0.25)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `w . E r = E' w . r` for C in spots, on a grid of odd sides and on a row.
    #[test]
    fn folding_is_the_transpose_of_filling() {
        for (mx, my) in [(21, 13), (17, 1)] {
            let value = |i: usize, seed: usize| ((i * 37 + seed) % 101) as f64 / 101.0 - 0.5;
            let bound: Vec<f64> = (0..mx * my).map(|i| if (i * 29 + i / 7) % 5 < 2 { 1.0 } else { 0.0 }).collect();
            let mut extension = Extension::new(&Grid::new(mx, my, 1.0, 1.0).unwrap()).unwrap();
            extension.contact_changed(&bound);
            let r: Vec<Vector> = (0..mx * my).map(|i| [bound[i] * value(i, 3), bound[i] * value(i, 8)]).collect();
            let w: Vec<Vector> = (0..mx * my).map(|i| [value(i, 50), value(i, 77)]).collect();
            let (mut filled, mut folded) = (r.clone(), w.clone());
            extension.fill(&mut filled);
            extension.fold(&mut folded);
            let dot =
                |a: &[Vector], b: &[Vector]| -> f64 { a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum() };
            let (by_filling, by_folding) = (dot(&w, &filled), dot(&folded, &r));
            // Sums of some 600 products below 1/4, in another order.
            assert!((by_filling - by_folding).abs() <= 1e-13, "{mx} x {my}: {by_filling} {by_folding}");
            assert!((0..mx * my).all(|i| bound[i] == 0.0 || filled[i] == r[i]), "what is known changed");
            assert!((0..mx * my).any(|i| bound[i] == 0.0 && filled[i] != [0.0; 2]), "nothing was filled in");
        }
    }
}
