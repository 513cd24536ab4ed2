//! The caller's table as given. The copy of its used part also determines its extremes.

use super::extremes::Extremes;
use crate::error::{Error, Number, Result};
use crate::grid::Grid;
use crate::memory::{blank, reserve};

/// The name of this memory in messages.
pub(super) const TABLE: &str = "the influence coefficients";

/// Number of stored coefficients in one direction.
pub(super) fn width(c: usize, even: bool) -> usize {
    if even {
        c
    } else {
        2 * c - 1
    }
}

/// A table as given: `values[ky + cy][kx + cx]`.
pub(super) struct Given<'a> {
    pub cx: usize,
    pub cy: usize,
    pub values: &'a [f64],
}

impl Given<'_> {
    /// The coefficients of row ky at offsets `0..mx`.
    fn after(&self, ky: i64, mx: usize) -> &[f64] {
        &self.values[(ky + self.cy as i64) as usize * 2 * self.cx + self.cx..][..mx]
    }

    /// The coefficients of row ky at offsets `1 - mx..=0`.
    fn before(&self, ky: i64, mx: usize) -> &[f64] {
        &self.values[(ky + self.cy as i64) as usize * 2 * self.cx + self.cx + 1 - mx..][..mx]
    }

    /// Whether the coefficients are even on the offsets of the grid, to the last bit.
    pub fn is_even(&self, grid: &Grid) -> bool {
        let mx = grid.mx;
        (0..grid.my as i64).all(|ky| {
            let rows = self.after(ky, mx).iter().zip(self.after(-ky, mx));
            let before = self.before(ky, mx).iter().rev().zip(self.before(-ky, mx).iter().rev());
            rows.zip(before).fold(true, |all, ((a, b), (c, d))| all & (a == b) & (a == c) & (a == d))
        })
    }

    /// The coefficients at offsets `0.., 0..` of the grid, scaled.
    pub fn quarter(&self, grid: &Grid, scale: f64) -> Result<(Vec<f64>, Extremes)> {
        let (mut kept, mut extremes) = (Vec::new(), Extremes::NONE);
        reserve(&mut kept, grid.len(), TABLE)?;
        for ky in 0..grid.my as i64 {
            kept.extend(self.after(ky, grid.mx).iter().map(|value| scale * value));
            extremes = extremes.and(Extremes::of_even(&kept[kept.len() - grid.mx..]));
        }
        match extremes.finite {
            true => Ok((kept, extremes)),
            false => Err(self.not_finite(grid, scale, true)),
        }
    }

    /// The coefficients at all offsets of the grid, scaled. Opposite rows are filled together and compared while they are in the cache.
    pub fn whole(&self, grid: &Grid, scale: f64) -> Result<(Vec<f64>, Extremes)> {
        let Grid { mx, my, .. } = *grid;
        let (columns, mut extremes) = (width(mx, false), Extremes::NONE);
        let mut kept = blank(columns * width(my, false), f64::NAN, TABLE)?;
        let (negative, rest) = kept.split_at_mut((my - 1) * columns);
        let fill = |out: &mut [f64], ky: i64| {
            let (before, after) = out.split_at_mut(mx - 1);
            let scaled = |out: &mut [f64], row: &[f64]| {
                out.iter_mut().zip(row).for_each(|(value, given)| *value = scale * given);
            };
            scaled(before, &self.before(ky, mx)[..mx - 1]);
            scaled(after, self.after(ky, mx));
        };
        let (zero, positive) = rest.split_at_mut(columns);
        fill(zero, 0);
        let large = zero[mx - 1];
        extremes = extremes.and(Extremes::of_opposite(zero, zero, large));
        let pairs = positive.chunks_exact_mut(columns).zip(negative.rchunks_exact_mut(columns));
        for ((row, opposite), ky) in pairs.zip(1..) {
            fill(row, ky);
            fill(opposite, -ky);
            extremes = extremes.and(Extremes::of_opposite(row, opposite, large));
        }
        match extremes.finite {
            true => Ok((kept, extremes)),
            false => Err(self.not_finite(grid, scale, false)),
        }
    }

    /// The error of a table with coefficients that are not finite.
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
