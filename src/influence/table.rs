//! The caller's own influence coefficients: a table over offsets `-cx..cx-1` by `-cy..cy-1`.
//!
//! `A_IJ = c(ix - jx, iy - jy)`. Neither symmetric nor positive coefficients are assumed, and the table may be larger
//! than the grid. Row `-cy` and column `-cx` never matter: no pair of elements has those offsets.
//!
//! On a grid coarsened in x the coefficient is the mean displacement of the fine elements of one coarse element by a
//! unit pressure on those of another, `c_H(K) = c(2K-1)/2 + c(2K) + c(2K+1)/2`, and likewise in y. Where an odd count
//! asks for an offset just outside the table (the last coarse element sticks out), the outermost coefficient serves.

use std::sync::Arc;

use super::Kernel;
use crate::error::{invalid, require, Error, Result};
use crate::grid::Grid;
use crate::memory::{blank, reserve};

/// What memory is for.
const TABLE: &str = "the influence coefficients";

/// Round-off allowed in a symmetric table, relative to its largest coefficient: single-precision tables pass.
pub(super) const SYMMETRY: f64 = 1e-7;

/// Refuses a scale that turns coefficients around or away.
pub(super) fn check_scale(name: &str, scale: f64) -> Result<()> {
    require(scale > 0.0 && scale.is_finite(), name, scale, "coefficients are scaled by a positive, finite number")
}

/// A table of coefficients: of offsets >= 0 only, where all are even.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Elements of the grid that it was made for.
    pub(crate) cx: usize,
    pub(crate) cy: usize,
    even: bool,
    /// `[ky][kx]`, x fastest, from offset 0 or `1 - c` on; shared by all that hold the table.
    pub(crate) values: Arc<Vec<f64>>,
}

/// Coefficients of one direction that are kept.
fn width(c: usize, even: bool) -> usize {
    if even {
        c
    } else {
        2 * c - 1
    }
}

/// Whether all are finite, looked at many at a time.
fn are_finite(values: &[f64], scale: f64) -> bool {
    values.iter().fold(true, |all, value| all & (scale * value).is_finite())
}

/// A table as it is given: `values[ky + cy][kx + cx]`.
struct Given<'a> {
    cx: usize,
    cy: usize,
    values: &'a [f64],
}

impl Given<'_> {
    /// Offsets `0..mx` of row ky.
    fn after(&self, ky: i64, mx: usize) -> &[f64] {
        &self.values[(ky + self.cy as i64) as usize * 2 * self.cx + self.cx..][..mx]
    }

    /// Offsets `1 - mx..=0` of row ky.
    fn before(&self, ky: i64, mx: usize) -> &[f64] {
        &self.values[(ky + self.cy as i64) as usize * 2 * self.cx + self.cx + 1 - mx..][..mx]
    }

    fn is_even(&self, grid: &Grid) -> bool {
        let mx = grid.mx;
        (0..grid.my as i64).all(|ky| {
            let rows = self.after(ky, mx).iter().zip(self.after(-ky, mx));
            let before = self.before(ky, mx).iter().rev().zip(self.before(-ky, mx).iter().rev());
            rows.zip(before).fold(true, |all, ((a, b), (c, d))| all & (a == b) & (a == c) & (a == d))
        })
    }
}

impl Table {
    /// A table of `2 cx` by `2 cy` coefficients, `values[ky + cy][kx + cx]`, that must cover `grid`: the bytes of a Fortran
    /// `cf(-cx:cx-1, -cy:cy-1)`.
    pub fn new(cx: usize, cy: usize, values: &[f64], grid: &Grid) -> Result<Table> {
        Table::scaled(cx, cy, values, 1.0, grid)
    }

    /// The same of `scale * values`: CONTACT keeps its coefficients times G.
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
        // Only the offsets of the grid matter, so only they are kept: the table may be far larger.
        let (Grid { mx, my, .. }, given) = (*grid, Given { cx, cy, values });
        let even = given.is_even(grid);
        let (first_x, first_y) = if even { (0, 0) } else { (1 - mx as i64, 1 - my as i64) };
        let mut kept = Vec::new();
        reserve(&mut kept, width(mx, even) * width(my, even), TABLE)?;
        for ky in first_y..my as i64 {
            let row = &given.before(ky, mx)[..(-first_x) as usize];
            for (row, first) in [(row, first_x), (given.after(ky, mx), 0)] {
                if !are_finite(row, scale) {
                    return Err(not_finite(row, scale, (first, ky)));
                }
                kept.extend(row.iter().map(|value| scale * value));
            }
        }
        let table = Table { cx: mx, cy: my, even, values: Arc::new(kept) };
        if table.at(0, 0) <= 0.0 {
            return Err(Error::NotPositiveDefinite(format!(
                "influence.coefficients at offset (0, 0) is {}; a pressure must displace its own element inwards",
                table.at(0, 0)
            )));
        }
        Ok(table)
    }

    /// Row ky, the outermost one where the table ends.
    fn row(&self, ky: i64) -> &[f64] {
        let (y, width) = (place(ky, self.cy, self.even), width(self.cx, self.even));
        &self.values[y * width..][..width]
    }

    /// The rows of `grid`, each as far as the grid reaches.
    fn rows_of<'a>(&'a self, grid: &Grid) -> impl DoubleEndedIterator<Item = &'a [f64]> {
        let (mx, last, even, cx) = (grid.mx, grid.my as i64 - 1, self.even, self.cx);
        let first = if even { 0 } else { -last };
        (first..=last).map(move |ky| &self.row(ky)[if even { 0 } else { cx - mx }..][..width(mx, even)])
    }
}

/// The error of a row, offset `(kx, ky)` first, of which some are not finite.
fn not_finite(row: &[f64], scale: f64, (kx, ky): (i64, i64)) -> Error {
    let (kx, value) = (kx..).zip(row).find(|(_, value)| !(scale * *value).is_finite()).unwrap_or((kx, &f64::NAN));
    Error::NotFinite(format!(
        "influence.coefficients at offset ({kx}, {ky}) is {}; coefficients must be finite",
        scale * value
    ))
}

/// Where an offset stands among those kept, the outermost one where they end.
fn place(k: i64, c: usize, even: bool) -> usize {
    let last = c as i64 - 1;
    match even {
        true => k.abs().min(last) as usize,
        false => (k.clamp(-last, last) + last) as usize,
    }
}

impl Kernel for Table {
    fn at(&self, kx: i64, ky: i64) -> f64 {
        self.row(ky)[place(kx, self.cx, self.even)]
    }

    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        let (row, last) = (self.row(ky), self.cx as i64 - 1);
        if (if self.even { 0 } else { -last }) <= kx && kx + out.len() as i64 - 1 <= last {
            return out.copy_from_slice(&row[place(kx, self.cx, self.even)..][..out.len()]);
        }
        out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = row[place(kx, self.cx, self.even)]);
    }

    fn fill_even_row(&self, ky: i64, out: &mut [f64]) {
        if self.even {
            let (row, inside) = (self.row(ky), out.len().min(self.cx));
            out[..inside].copy_from_slice(&row[..inside]);
            return out[inside..].fill(row[self.cx - 1]);
        }
        let (above, below) = (self.row(ky), self.row(-ky));
        for (kx, value) in (0..).zip(out) {
            let (right, left) = (place(kx, self.cx, false), place(-kx, self.cx, false));
            *value = 0.25 * (above[right] + above[left] + below[right] + below[left]);
        }
    }

    fn is_even(&self, _: &Grid) -> bool {
        self.even
    }

    fn largest(&self, grid: &Grid) -> f64 {
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        let of_row = |row: &[f64]| row.iter().fold(0.0, |largest: f64, value| larger(largest, value.abs()));
        self.rows_of(grid).map(of_row).fold(0.0, larger)
    }

    fn is_symmetric(&self, grid: &Grid) -> bool {
        if self.even {
            return true;
        }
        let (allowed, rows) = (SYMMETRY * self.largest(grid), 2 * grid.my - 1);
        let alike = |(row, turned): (&[f64], &[f64])| {
            let pairs = row.iter().zip(turned.iter().rev());
            pairs.fold(true, |all, (a, b)| all & ((a - b).abs() <= allowed))
        };
        self.rows_of(grid).zip(self.rows_of(grid).rev()).take(rows.div_ceil(2)).all(alike)
    }

    fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>> {
        let (half_x, half_y, even) = (coarse.mx < fine.mx, coarse.my < fine.my, self.even);
        let (cx, cy) = (coarse.mx, coarse.my);
        let first = |c: usize| if even { 0 } else { 1 - c as i64 };
        let (columns, rows) = (width(cx, even), width(cy, even));
        let joined = |halved: bool, k: i64| if halved { [2 * k - 1, 2 * k, 2 * k + 1] } else { [k; 3] };
        // The outer two are added first: so what is even stays so to the last bit.
        let sum = |halved: bool, [before, at, after]: [f64; 3]| if halved { at + 0.5 * (before + after) } else { at };
        let mut in_x = blank(3 * columns, f64::NAN, TABLE)?;
        let mut values = Vec::new();
        reserve(&mut values, columns * rows, TABLE)?;
        for ky in first(cy)..cy as i64 {
            for (out, ky) in in_x.chunks_exact_mut(columns).zip(joined(half_y, ky)) {
                let row = self.row(ky);
                for (value, kx) in out.iter_mut().zip(first(cx)..) {
                    *value = sum(half_x, joined(half_x, kx).map(|kx| row[place(kx, self.cx, even)]));
                }
            }
            let (before, rest) = in_x.split_at(columns);
            let (at, after) = rest.split_at(columns);
            values.extend((0..columns).map(|i| sum(half_y, [before[i], at[i], after[i]])));
        }
        Ok(Arc::new(Table { cx, cy, even, values: Arc::new(values) }))
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.values[..])
    }
}
