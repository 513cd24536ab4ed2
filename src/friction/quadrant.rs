//! The coefficients at whole offsets `kx, ky >= 0`, computed once for all operators of a box and, if possible, of its coarser grids.
//!
//! Coefficients of half-spaces are homogeneous: elements twice as long and twice as wide have twice the coefficient at the same offset in elements.

use toeplitz::vector_period;

use super::coefficients::{Entry, Tangential};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::blank;
use crate::threads::Threads;

/// `Axx, Ayy, Axy` at the offsets `0..cx` by `0..cy`.
pub struct Quadrant {
    /// The source of the coefficients, for other offsets.
    tangential: Tangential,
    cx: usize,
    cy: usize,
    /// `[cy][cx]`.
    values: Vec<Entry>,
}

impl Quadrant {
    /// Computes the coefficients for the operators of a grid: those at the offsets between its elements for products, at one offset more for
    /// preconditioners, and at `by` more if a step of rolling is of whole elements.
    pub fn new(tangential: &Tangential, grid: &Grid, by: (f64, f64), threads: &Threads) -> Result<Quadrant> {
        let (cx, cy) = reach(tangential, grid, by);
        let mut values: Vec<Entry> = blank(cx * cy, [f64::NAN; 3], "the tangential influence coefficients")?;
        threads.for_each_plain_row(&mut values, cx, |ky, row| tangential.fill_row(ky, row));
        Ok(Quadrant { tangential: tangential.clone(), cx, cy, values })
    }

    /// The coefficients of a coarser grid: these times a factor if they are homogeneous, otherwise computed anew.
    pub fn coarser(self, tangential: &Tangential, grid: &Grid, by: (f64, f64), threads: &Threads) -> Result<Quadrant> {
        let (cx, cy) = reach(tangential, grid, by);
        match tangential.times(&self.tangential) {
            Some(factor) if cx <= self.cx && cy <= self.cy => {
                let Quadrant { cx: width, mut values, .. } = self;
                for iy in 0..cy {
                    for ix in 0..cx {
                        values[iy * cx + ix] = values[iy * width + ix].map(|value| factor * value);
                    }
                }
                values.truncate(cx * cy);
                Ok(Quadrant { tangential: tangential.clone(), cx, cy, values })
            }
            _ => Quadrant::new(tangential, grid, by, threads),
        }
    }

    /// The source of the coefficients.
    pub fn tangential(&self) -> &Tangential {
        &self.tangential
    }

    /// Whether Axy is 0 between all elements of a grid, for displacements at the offset `by` from the centres.
    pub fn is_uncoupled(&self, grid: &Grid, by: (f64, f64)) -> bool {
        if self.tangential.is_own() {
            return self.values.iter().all(|entry| entry[2] == 0.0);
        }
        // On a single row or column Axy is 0, also for steps along it.
        let along_line = (grid.my == 1 && by.1 == 0.0) || (grid.mx == 1 && by.0 == 0.0);
        along_line || self.tangential.is_uncoupled()
    }

    /// The coefficients at a whole offset of any sign.
    #[inline]
    pub fn at(&self, x: i64, y: i64) -> Entry {
        let [xx, yy, xy] = self.values[y.unsigned_abs() as usize * self.cx + x.unsigned_abs() as usize];
        [xx, yy, if (x < 0) == (y < 0) { xy } else { -xy }]
    }

    /// Writes Axx (component 0), Ayy (1) or Axy (2) at the offsets `(0.., ky)`.
    pub fn fill_row(&self, component: usize, ky: i64, out: &mut [f64]) {
        let row = &self.values[ky as usize * self.cx..][..out.len()];
        out.iter_mut().zip(row).for_each(|(value, entry)| *value = entry[component]);
    }

    /// The coefficients at the offset `(x, y) + by`. They are computed unless this is a whole offset that is stored.
    pub fn displaced(&self, x: i64, y: i64, by: (f64, f64)) -> Entry {
        let (at_x, at_y) = (x as f64 + by.0, y as f64 + by.1);
        let is_kept =
            at_x.fract() == 0.0 && at_y.fract() == 0.0 && at_x.abs() < self.cx as f64 && at_y.abs() < self.cy as f64;
        if is_kept {
            self.at(at_x as i64, at_y as i64)
        } else {
            self.tangential.at(at_x, at_y)
        }
    }
}

/// The period of the circulant that approximates A, and the number of its offsets >= 0, both in x and y. The period is at least an element longer
/// than the grid, and has offsets up to a half of it. A direction with one element has one offset.
pub fn circulant_period(grid: &Grid) -> ((usize, usize), (usize, usize)) {
    let (px, py) = vector_period((grid.mx + 1, grid.my + 1));
    let offsets = |m: usize, period: usize| if m == 1 { 1 } else { period / 2 + 1 };
    ((px, py), (offsets(grid.mx, px), offsets(grid.my, py)))
}

/// The number of stored offsets in each direction. A step of whole elements adds offsets if it is at most as long as the grid, or if the coefficients
/// are the caller's tables.
fn reach(tangential: &Tangential, grid: &Grid, by: (f64, f64)) -> (usize, usize) {
    let is_whole = by.0.fract() == 0.0 && by.1.fract() == 0.0;
    let is_short = by.0.abs() <= grid.mx as f64 && by.1.abs() <= grid.my as f64;
    let (in_x, in_y) = if is_whole && (is_short || tangential.is_own()) { by } else { (0.0, 0.0) };
    let (_, (circulant_x, circulant_y)) = circulant_period(grid);
    ((grid.mx + 1 + in_x.abs() as usize).max(circulant_x), (grid.my + 1 + in_y.abs() as usize).max(circulant_y))
}
