//! The caller's influence coefficients: a table over the offsets `-cx..cx-1` by `-cy..cy-1`.
//!
//! `A_IJ = c(ix - jx, iy - jy)`. The coefficients need not be symmetric or positive, and the table may be larger than the grid. Row `-cy` and
//! column `-cx` are unused, because no pair of elements has such an offset.
//!
//! On a grid that is coarsened in x, a coefficient is the mean displacement of the fine elements of one coarse element by a unit pressure on
//! those of another: `c_H(K) = c(2K-1)/2 + c(2K) + c(2K+1)/2`; likewise in y. If the number of fine elements is odd, the last coarse element
//! exceeds the grid. Then the outermost coefficient replaces the one just outside the table.

use std::sync::Arc;

use super::given::{width, Given, TABLE};
use super::kernel::Kernel;
use super::table_properties::{are_symmetric, largest, TableProperties};
use crate::error::{invalid, require, Error, Number, Result};
use crate::grid::Grid;
use crate::memory::{blank, Held};

/// A coefficient larger than this times that of an element on itself is an error of the table, not round-off.
pub(crate) const LARGEST_RATIO: f64 = 1.001;

/// Refuses a scale that is not positive and finite. `name` names the scale in the message.
pub(super) fn check_scale(name: &str, scale: f64) -> Result<()> {
    require(scale > 0.0 && scale.is_finite(), name, scale, "coefficients are scaled by a positive, finite number")
}

/// The caller's coefficients at the offsets of a grid. If they are even, only offsets >= 0 are stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The numbers of elements of the grid in x and in y.
    pub(crate) cx: usize,
    pub(crate) cy: usize,
    even: bool,
    /// The coefficients `[ky][kx]`, from offset 0 if even, otherwise from `1 - c` on. Copies of the table share them.
    pub(crate) values: Arc<Held>,
    /// The properties of all coefficients.
    properties: TableProperties,
}

impl Table {
    /// A table from `2 cx` by `2 cy` coefficients `values[ky + cy][kx + cx]`. This is the layout of a Fortran array `cf(-cx:cx-1, -cy:cy-1)`. The
    /// table must reach all offsets of `grid`.
    pub fn new(cx: usize, cy: usize, values: &[f64], grid: &Grid) -> Result<Table> {
        Table::scaled(cx, cy, values, 1.0, grid)
    }

    /// [`Table::new`] with the coefficients `scale * values`. CONTACT stores coefficients times G.
    pub fn scaled(cx: usize, cy: usize, values: &[f64], scale: f64, grid: &Grid) -> Result<Table> {
        check_scale("influence.scale", scale)?;
        for (name, c, count, m) in [("cx", cx, "mx", grid.mx), ("cy", cy, "my", grid.my)] {
            if c < m {
                return invalid(format!(
                    "influence.{name} is {c}; the table must reach offsets of the grid, {count} = {m}"
                ));
            }
        }
        let expected = cx.checked_mul(cy).and_then(|n| n.checked_mul(4));
        if expected != Some(values.len()) {
            return invalid(format!("the influence table has {} values; it must have 2 cx by 2 cy", values.len()));
        }
        // Only the offsets of the grid are stored, because the caller's table may be far larger.
        let (Grid { mx, my, .. }, given) = (*grid, Given { cx, cy, values });
        let even = given.is_even(grid);
        let (values, properties) = if even { given.quarter(grid, scale)? } else { given.whole(grid, scale)? };
        let table = Table { cx: mx, cy: my, even, values: Arc::new(values.into()), properties };
        if table.at(0, 0) <= 0.0 {
            return Err(Error::NotPositiveDefinite(format!(
                "influence.coefficients at offset (0, 0) is {}; a pressure must displace its own element inwards",
                Number(table.at(0, 0))
            )));
        }
        Ok(table)
    }

    /// Refuses a table in which a coefficient exceeds that of an element on itself.
    pub(crate) fn check_largest(&self) -> Result<()> {
        let own = self.at(0, 0);
        if self.properties.largest <= LARGEST_RATIO * own {
            return Ok(());
        }
        let last = (self.cx as i64 - 1, self.cy as i64 - 1);
        let Some((kx, ky)) = offset_beyond(own, last, |kx, ky| self.at(kx, ky)) else { return Ok(()) };
        Err(Error::NotPositiveDefinite(format!(
            "influence.coefficients at offset ({kx}, {ky}) is {}, and {} at (0, 0): no elastic body moves another element more than the one that is \
             pressed. Offset (0, 0) is value [cy][cx] of the table",
            Number(self.at(kx, ky)),
            Number(own)
        )))
    }

    /// Whether the table has exactly the offsets of `grid`, not those of a larger grid.
    fn is_of(&self, grid: &Grid) -> bool {
        (self.cx, self.cy) == (grid.mx, grid.my)
    }

    /// The coefficients of row ky; beyond the table those of its outermost row.
    fn row(&self, ky: i64) -> &[f64] {
        let (y, width) = (index_of(ky, self.cy, self.even), width(self.cx, self.even));
        &self.values[y * width..][..width]
    }

    /// The rows at the offsets of `grid`, each cut to the grid's offsets in x.
    fn rows_of<'a>(&'a self, grid: &Grid) -> impl DoubleEndedIterator<Item = &'a [f64]> + Clone {
        let (mx, last, even, cx) = (grid.mx, grid.my as i64 - 1, self.even, self.cx);
        let first = if even { 0 } else { -last };
        (first..=last).map(move |ky| &self.row(ky)[if even { 0 } else { cx - mx }..][..width(mx, even)])
    }
}

/// Coarsens a row of coefficients of a grid with c elements in x. If the grid is not `halved` in x, the row is only cut to the length of `out`.
/// The outer two of three coefficients are added first, so that even coefficients stay even to the last bit.
pub(super) fn coarsen_row(row: &[f64], c: usize, even: bool, halved: bool, out: &mut [f64]) {
    let last = out.len() - 1;
    let first = if even { 0 } else { -(last as i64) / 2 };
    if !halved {
        let start = index_of(first, c, even);
        return out.copy_from_slice(&row[start..=start + last]);
    }
    // Offsets beyond the ends of the row have the outermost coefficients.
    for i in [0, last] {
        let [before, at, after] = [-1, 0, 1].map(|k| row[index_of(2 * (first + i as i64) + k, c, even)]);
        out[i] = at + 0.5 * (before + after);
    }
    if last > 1 {
        let start = index_of(2 * first, c, even) + 1;
        for (value, three) in out[1..last].iter_mut().zip(row[start..].windows(3).step_by(2)) {
            *value = three[1] + 0.5 * (three[0] + three[2]);
        }
    }
}

/// The index of the offset k in a row of a grid with c elements; beyond the end of the row, the index of its outermost coefficient.
pub(super) fn index_of(k: i64, c: usize, even: bool) -> usize {
    let last = c as i64 - 1;
    match even {
        true => k.abs().min(last) as usize,
        false => (k.clamp(-last, last) + last) as usize,
    }
}

impl Kernel for Table {
    fn at(&self, kx: i64, ky: i64) -> f64 {
        self.row(ky)[index_of(kx, self.cx, self.even)]
    }

    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        let (row, last) = (self.row(ky), self.cx as i64 - 1);
        if (if self.even { 0 } else { -last }) <= kx && kx + out.len() as i64 - 1 <= last {
            return out.copy_from_slice(&row[index_of(kx, self.cx, self.even)..][..out.len()]);
        }
        out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = row[index_of(kx, self.cx, self.even)]);
    }

    fn fill_even_row(&self, ky: i64, out: &mut [f64]) {
        if self.even {
            let (row, inside) = (self.row(ky), out.len().min(self.cx));
            out[..inside].copy_from_slice(&row[..inside]);
            return out[inside..].fill(row[self.cx - 1]);
        }
        let ([above, below], zero) = ([self.row(ky), self.row(-ky)], self.cx - 1);
        let right = above[zero..].iter().zip(&below[zero..]);
        let left = above[..=zero].iter().rev().zip(below[..=zero].iter().rev());
        for (value, ((a, b), (c, d))) in out.iter_mut().zip(right.zip(left)) {
            *value = 0.25 * (a + c + b + d);
        }
        if out.len() > self.cx {
            let last = out[self.cx - 1];
            out[self.cx..].fill(last);
        }
    }

    fn is_even(&self, _: &Grid) -> bool {
        self.even
    }

    fn fill_symmetric_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        if self.even {
            return self.fill_row(kx, ky, out);
        }
        let (row, opposite) = (self.row(ky), self.row(-ky));
        let (first, end) = (index_of(kx, self.cx, false), index_of(-kx, self.cx, false) + 1);
        let pairs = row[first..].iter().zip(opposite[..end].iter().rev());
        out.iter_mut().zip(pairs).for_each(|(value, (a, b))| *value = 0.5 * (a + b));
    }

    fn largest(&self, grid: &Grid) -> f64 {
        if self.is_of(grid) {
            return self.properties.largest;
        }
        self.rows_of(grid).map(largest).fold(0.0, f64::max)
    }

    fn is_symmetric(&self, grid: &Grid) -> bool {
        if self.even || self.properties.symmetric {
            return true;
        }
        let (rows, reference) = (self.rows_of(grid), self.largest(grid));
        rows.clone().zip(rows.rev()).take(grid.my).all(|(row, opposite)| are_symmetric(row, opposite, reference))
    }

    fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>> {
        let (half_x, half_y) = (coarse.mx < fine.mx, coarse.my < fine.my);
        let (even, cx, cy) = (self.even, coarse.mx, coarse.my);
        let (columns, rows) = (width(cx, even), width(cy, even));
        let mut joined = blank(if half_y { width(self.cx, even) } else { 0 }, f64::NAN, TABLE)?;
        let mut values = blank(columns * rows, f64::NAN, TABLE)?;
        let first = if even { 0 } else { 1 - cy as i64 };
        for (ky, out) in (first..).zip(values.chunks_exact_mut(columns)) {
            if !half_y {
                coarsen_row(self.row(ky), self.cx, even, half_x, out);
                continue;
            }
            let [before, at, after] = [-1, 0, 1].map(|k| self.row(2 * ky + k));
            for (value, (at, (before, after))) in joined.iter_mut().zip(at.iter().zip(before.iter().zip(after))) {
                *value = at + 0.5 * (before + after);
            }
            coarsen_row(&joined, self.cx, even, half_x, out);
        }
        let of_rows = || TableProperties::of_rows(values.chunks_exact(columns), cy, values[values.len() / 2]);
        let properties = if even { TableProperties::of_even(&values) } else { of_rows() };
        Ok(Arc::new(Table { cx, cy, even, values: Arc::new(values.into()), properties }))
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.values[..])
    }
}

/// An offset k for which the mean of the coefficients `at` k and -k exceeds `own`, that of an element on itself, in size. Two elements at this offset
/// alone have an indefinite matrix. Of k and -k, the offset with the larger coefficient is returned. `last`: the largest offsets in x and in y.
pub(crate) fn offset_beyond(
    own: f64,
    (last_x, last_y): (i64, i64),
    at: impl Fn(i64, i64) -> f64,
) -> Option<(i64, i64)> {
    let mut offsets = (0..=last_y).flat_map(|ky| (-last_x..=last_x).map(move |kx| (kx, ky)));
    let mean = |(kx, ky): (i64, i64)| 0.5 * (at(kx, ky) + at(-kx, -ky)).abs();
    let (kx, ky) = offsets.find(|offset| mean(*offset) > LARGEST_RATIO * own)?;
    Some(if at(kx, ky).abs() >= at(-kx, -ky).abs() { (kx, ky) } else { (-kx, -ky) })
}
