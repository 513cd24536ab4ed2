//! The caller's table as the caller passes it. The used part is copied, and its properties are found at the same time.

use super::table_properties::TableProperties;
use crate::error::{Error, Number, Result};
use crate::grid::Grid;
use crate::memory::{blank, reserve};

/// The name of the memory of a table in messages.
pub(super) const TABLE: &str = "the influence coefficients";

/// The number of stored coefficients in one direction of a grid with c elements: offsets `0..c` if they are even, `1 - c..c` otherwise.
pub(super) fn width(c: usize, even: bool) -> usize {
    if even {
        c
    } else {
        2 * c - 1
    }
}

/// The caller's table, `values[ky + cy][kx + cx]`.
pub(super) struct Given<'a> {
    pub cx: usize,
    pub cy: usize,
    pub values: &'a [f64],
}

impl Given<'_> {
    /// The caller's coefficients of row ky at offsets `0..mx` in x.
    fn right(&self, ky: i64, mx: usize) -> &[f64] {
        &self.values[(ky + self.cy as i64) as usize * 2 * self.cx + self.cx..][..mx]
    }

    /// The caller's coefficients of row ky at offsets `1 - mx..=0` in x.
    fn left(&self, ky: i64, mx: usize) -> &[f64] {
        &self.values[(ky + self.cy as i64) as usize * 2 * self.cx + self.cx + 1 - mx..][..mx]
    }

    /// Whether the coefficients at the offsets of the grid are even in both directions, to the last bit.
    pub fn is_even(&self, grid: &Grid) -> bool {
        let mx = grid.mx;
        (0..grid.my as i64).all(|ky| {
            let rows = self.right(ky, mx).iter().zip(self.right(-ky, mx));
            let left = self.left(ky, mx).iter().rev().zip(self.left(-ky, mx).iter().rev());
            rows.zip(left).fold(true, |all, ((a, b), (c, d))| all & (a == b) & (a == c) & (a == d))
        })
    }

    /// Copies the coefficients at the grid's offsets `0.., 0..`, times `scale`.
    pub fn quarter(&self, grid: &Grid, scale: f64) -> Result<(Vec<f64>, TableProperties)> {
        let (mut kept, mut properties) = (Vec::new(), TableProperties::NONE);
        reserve(&mut kept, grid.len(), TABLE)?;
        for ky in 0..grid.my as i64 {
            kept.extend(self.right(ky, grid.mx).iter().map(|value| scale * value));
            properties = properties.and(TableProperties::of_even(&kept[kept.len() - grid.mx..]));
        }
        match properties.finite {
            true => Ok((kept, properties)),
            false => Err(self.not_finite(grid, scale, true)),
        }
    }

    /// Copies the coefficients at all offsets of the grid, times `scale`. The rows ky and -ky are filled together, and compared while they are in
    /// the cache.
    pub fn whole(&self, grid: &Grid, scale: f64) -> Result<(Vec<f64>, TableProperties)> {
        let Grid { mx, my, .. } = *grid;
        let (columns, mut properties) = (width(mx, false), TableProperties::NONE);
        let mut kept = blank(columns * width(my, false), f64::NAN, TABLE)?;
        let (negative, rest) = kept.split_at_mut((my - 1) * columns);
        let fill = |out: &mut [f64], ky: i64| {
            let (left, right) = out.split_at_mut(mx - 1);
            let scaled = |out: &mut [f64], row: &[f64]| {
                out.iter_mut().zip(row).for_each(|(value, given)| *value = scale * given);
            };
            scaled(left, &self.left(ky, mx)[..mx - 1]);
            scaled(right, self.right(ky, mx));
        };
        let (zero, positive) = rest.split_at_mut(columns);
        fill(zero, 0);
        let reference = zero[mx - 1];
        properties = properties.and(TableProperties::of_opposite(zero, zero, reference));
        let pairs = positive.chunks_exact_mut(columns).zip(negative.rchunks_exact_mut(columns));
        for ((row, opposite), ky) in pairs.zip(1..) {
            fill(row, ky);
            fill(opposite, -ky);
            properties = properties.and(TableProperties::of_opposite(row, opposite, reference));
        }
        match properties.finite {
            true => Ok((kept, properties)),
            false => Err(self.not_finite(grid, scale, false)),
        }
    }

    /// The error for the first coefficient that is not finite.
    fn not_finite(&self, grid: &Grid, scale: f64, even: bool) -> Error {
        let (mx, my) = (grid.mx as i64, grid.my as i64);
        let (first_x, first_y) = if even { (0, 0) } else { (1 - mx, 1 - my) };
        let offsets = (first_y..my).flat_map(|ky| (first_x..mx).map(move |kx| (kx, ky)));
        let at = |(kx, ky): (i64, i64)| {
            scale * self.values[((ky + self.cy as i64) * 2 * self.cx as i64 + kx + self.cx as i64) as usize]
        };
        let found = offsets.map(|offset| (offset, at(offset))).find(|(_, value)| !value.is_finite());
        let ((kx, ky), value) = found.unwrap_or(((0, 0), f64::NAN));
        Error::NotFinite(format!(
            "influence.coefficients at offset ({kx}, {ky}) is {}; coefficients must be finite",
            Number(value)
        ))
    }
}
