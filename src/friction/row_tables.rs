//! The caller's tangential influence coefficients, one table per loaded row.
//!
//! On a coarser grid the coefficient is the mean displacement of the fine elements of one coarse element by a unit traction on the fine
//! elements of another. In x it is computed as for [`Tables`], in y as for [the normal ones](crate::influence::RowTables). A preconditioner uses the
//! mean over the rows at each offset.

use std::sync::Arc;

use super::coefficients::Entry;
use super::tables::Tables;
use crate::effects::TangentialInfluence;
use crate::error::Result;
use crate::memory::zeros;

pub const TABLES: &str = "the tangential influence coefficients";

/// The coefficients of one offset, `[xx, yy, xy, yx]`: xy is the displacement in x by a traction in y.
pub type Full = [f64; 4];

/// The tables, for a run of consecutive rows of the grid.
#[derive(Clone, Debug)]
pub struct RowTables {
    /// The tables have the offsets in x below this number.
    cx: usize,
    /// The number of all rows of the tables.
    all_rows: usize,
    /// `[jy][iy][2 cx - 1]`: loaded row, row, offset in x from `1 - cx` on.
    values: Arc<Vec<Full>>,
    /// A power of two, by which stored coefficients are multiplied.
    factor: f64,
    /// The first row of the run.
    first: usize,
    /// The number of rows of the run.
    rows: usize,
}

impl RowTables {
    /// Copies the caller's tables, which have been checked.
    pub fn new(influence: &TangentialInfluence<'_>) -> Result<RowTables> {
        RowTables::of(influence.cx, influence.cy, |jy, iy, kx| influence.of_rows(jy, iy, kx))
    }

    /// Tables of all rows with the coefficients `at(jy, iy, kx)`.
    fn of(cx: usize, rows: usize, at: impl Fn(usize, usize, i64) -> Full) -> Result<RowTables> {
        let width = 2 * cx - 1;
        let mut values: Vec<Full> = zeros(rows * rows * width, TABLES)?;
        for (k, row) in values.chunks_exact_mut(width).enumerate() {
            row.iter_mut().zip(1 - cx as i64..).for_each(|(entry, kx)| *entry = at(k / rows, k % rows, kx));
        }
        Ok(RowTables { cx, all_rows: rows, values: Arc::new(values), factor: 1.0, first: 0, rows })
    }

    /// The tables divided by `unit`.
    pub fn in_units_of(&self, unit: f64) -> RowTables {
        RowTables { factor: self.factor / unit, ..self.clone() }
    }

    /// The tables of a run of rows.
    pub fn of_run(&self, first: usize, rows: usize) -> RowTables {
        RowTables { first, rows, ..self.clone() }
    }

    /// The first row of the run.
    pub fn first(&self) -> usize {
        self.first
    }

    /// The coefficients of the loaded row jy and the row iy, both counted from the first row of the run, at an offset in x. Beyond the tables the
    /// outermost coefficients are used.
    pub fn at(&self, jy: usize, iy: usize, kx: i64) -> Full {
        let last = self.cx as i64 - 1;
        let row = (self.first + jy) * self.all_rows + self.first + iy;
        let column = (kx.clamp(-last, last) + last) as usize;
        self.values[row * (2 * self.cx - 1) + column].map(|value| self.factor * value)
    }

    /// The tables on a grid that is coarsened in x, in y, or in both.
    pub fn coarsened(&self, in_x: bool, in_y: bool) -> Result<RowTables> {
        // If a row lies beyond the last, the pair is shifted to rows at the same distance.
        let at = |jy: usize, iy: usize, kx: i64| {
            let beyond = jy.max(iy).saturating_sub(self.rows - 1);
            self.at(jy.saturating_sub(beyond), iy.saturating_sub(beyond), kx)
        };
        let of_rows = |jy: usize, iy: usize, kx: i64| match in_y {
            false => at(jy, iy, kx),
            true => {
                let pairs = [(0, 0), (1, 1), (0, 1), (1, 0)];
                let four = pairs.map(|(j, i)| at(2 * jy + j, 2 * iy + i, kx));
                [0, 1, 2, 3].map(|c| 0.5 * four.iter().map(|entry| entry[c]).sum::<f64>())
            }
        };
        let half = |m: usize, is_halved: bool| if is_halved { m.div_ceil(2) } else { m };
        RowTables::of(half(self.cx, in_x), half(self.rows, in_y), |jy, iy, kx| match in_x {
            false => of_rows(jy, iy, kx),
            true => {
                let [a, b, c] = [-1, 0, 1].map(|k| of_rows(jy, iy, 2 * kx + k));
                [0, 1, 2, 3].map(|k| 0.5 * a[k] + b[k] + 0.5 * c[k])
            }
        })
    }

    /// One table for all rows: the mean of the coefficients over the rows of the run, over xy and yx, and over an offset and its mirror images. Its
    /// xx and yy are even in both directions, its xy is odd in both.
    pub fn mean(&self) -> Result<Tables> {
        Tables::of(self.cx, self.rows, |x, y| {
            let (mut sum, mut count) = ([0.0; 3], 0);
            for jy in 0..self.rows - y as usize {
                let iy = jy + y as usize;
                let same_sign = [(self.at(jy, iy, x), 1.0), (self.at(iy, jy, -x), 1.0)];
                let opposite_sign = [(self.at(jy, iy, -x), -1.0), (self.at(iy, jy, x), -1.0)];
                for ([xx, yy, xy, yx], sign) in same_sign.into_iter().chain(opposite_sign) {
                    sum = [sum[0] + xx, sum[1] + yy, sum[2] + 0.5 * sign * (xy + yx)];
                }
                count += 4;
            }
            sum.map(|sum: f64| sum / f64::from(count)) as Entry
        })
    }
}
