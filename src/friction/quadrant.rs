//! Coefficients at whole offsets of one quadrant, computed once for all operators of a box, and for those of the coarser grids.
//!
//! Coefficients are homogeneous: elements twice as long and twice as wide have twice the coefficient at the same offset in elements.

use super::coefficients::{Entry, Tangential};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::blank;
use crate::threads::Threads;

/// `Axx, Ayy, Axy` at the offsets `0..cx` by `0..cy`.
pub struct Quadrant {
    tangential: Tangential,
    cx: usize,
    cy: usize,
    values: Vec<Entry>,
}

impl Quadrant {
    /// As far as operators of a grid ask: products ask for the offsets between its elements, preconditioners for one more, and rolling
    /// by whole elements for `by` more.
    pub fn new(tangential: &Tangential, grid: &Grid, by: (f64, f64), threads: &Threads) -> Result<Quadrant> {
        let (cx, cy) = reach(grid, by);
        let mut values: Vec<Entry> = blank(cx * cy, [f64::NAN; 3], "the tangential influence coefficients")?;
        threads.for_each_plain_row(&mut values, cx, |ky, row| tangential.fill_row(ky, row));
        Ok(Quadrant { tangential: tangential.clone(), cx, cy, values })
    }

    /// Of a coarser grid.
    pub fn coarser(self, tangential: &Tangential, grid: &Grid, by: (f64, f64), threads: &Threads) -> Result<Quadrant> {
        let (cx, cy) = reach(grid, by);
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

    /// What the coefficients are of.
    pub fn tangential(&self) -> &Tangential {
        &self.tangential
    }

    /// Whether there is no Axy between the elements of a grid, displacements being taken at `by` from the centres.
    pub fn is_uncoupled(&self, grid: &Grid, by: (f64, f64)) -> bool {
        if self.tangential.is_own() {
            return self.values.iter().all(|entry| entry[2] == 0.0);
        }
        // On a line Axy is 0, and that of steps along it.
        let along_line = (grid.my == 1 && by.1 == 0.0) || (grid.mx == 1 && by.0 == 0.0);
        along_line || self.tangential.compliance().poisson == 0.0
    }

    /// The coefficients at a whole offset.
    #[inline]
    pub fn at(&self, x: i64, y: i64) -> Entry {
        let [xx, yy, xy] = self.values[y.unsigned_abs() as usize * self.cx + x.unsigned_abs() as usize];
        [xx, yy, if (x < 0) == (y < 0) { xy } else { -xy }]
    }

    /// The same `by` elements further on.
    pub fn displaced(&self, x: i64, y: i64, by: (f64, f64)) -> Entry {
        match whole(by) {
            Some((in_x, in_y)) => self.at(x + in_x, y + in_y),
            None => self.tangential.at(x as f64 + by.0, y as f64 + by.1),
        }
    }
}

/// A displacement by whole elements.
fn whole(by: (f64, f64)) -> Option<(i64, i64)> {
    (by.0.fract() == 0.0 && by.1.fract() == 0.0).then_some((by.0 as i64, by.1 as i64))
}

/// Offsets in each direction.
fn reach(grid: &Grid, by: (f64, f64)) -> (usize, usize) {
    let (in_x, in_y) = whole(by).unwrap_or((0, 0));
    (grid.mx + 1 + in_x.unsigned_abs() as usize, grid.my + 1 + in_y.unsigned_abs() as usize)
}
