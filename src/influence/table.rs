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
pub(super) fn width(c: usize, even: bool) -> usize {
    if even {
        c
    } else {
        2 * c - 1
    }
}

/// Whether all are finite, looked at many at a time.
pub(super) fn are_finite(values: &[f64], scale: f64) -> bool {
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

/// A row of the coefficients of c elements, on a grid coarsened in x or as it is. The outer two are added first: so what is even stays so
/// to the last bit.
pub(super) fn coarsen_row(row: &[f64], c: usize, even: bool, halved: bool, out: &mut [f64]) {
    let last = out.len() - 1;
    let first = if even { 0 } else { -(last as i64) / 2 };
    if !halved {
        let start = place(first, c, even);
        return out.copy_from_slice(&row[start..=start + last]);
    }
    // What lies beyond the ends is not of the row itself.
    for i in [0, last] {
        let [before, at, after] = [-1, 0, 1].map(|k| row[place(2 * (first + i as i64) + k, c, even)]);
        out[i] = at + 0.5 * (before + after);
    }
    if last > 1 {
        let start = place(2 * first, c, even) + 1;
        for (value, three) in out[1..last].iter_mut().zip(row[start..].windows(3).step_by(2)) {
            *value = three[1] + 0.5 * (three[0] + three[2]);
        }
    }
}

/// The largest of some values, whatever their sign.
pub(super) fn largest(values: &[f64]) -> f64 {
    // Several at a time: that the compiler can vectorise.
    const LANES: usize = 8;
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let mut largest = [0.0; LANES];
    let blocks = values.chunks_exact(LANES);
    let rest = blocks.remainder().iter().fold(0.0, |largest, value| larger(value.abs(), largest));
    for block in blocks {
        for lane in 0..LANES {
            largest[lane] = larger(block[lane].abs(), largest[lane]);
        }
    }
    largest.into_iter().fold(rest, larger)
}

/// Where an offset stands among those kept, the outermost one where they end.
pub(super) fn place(k: i64, c: usize, even: bool) -> usize {
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

    fn largest(&self, grid: &Grid) -> f64 {
        self.rows_of(grid).map(largest).fold(0.0, f64::max)
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
        let (half_y, even, (cx, cy)) = (coarse.my < fine.my, self.even, (coarse.mx, coarse.my));
        let (columns, rows) = (width(cx, even), width(cy, even));
        let mut in_x = blank(3 * columns, f64::NAN, TABLE)?;
        let mut values = Vec::new();
        reserve(&mut values, columns * rows, TABLE)?;
        for ky in (if even { 0 } else { 1 - cy as i64 })..cy as i64 {
            let joined = if half_y { [2 * ky - 1, 2 * ky, 2 * ky + 1] } else { [ky; 3] };
            for (out, ky) in in_x.chunks_exact_mut(columns).zip(joined) {
                coarsen_row(self.row(ky), self.cx, even, coarse.mx < fine.mx, out);
            }
            let (before, rest) = in_x.split_at(columns);
            let (at, after) = rest.split_at(columns);
            match half_y {
                true => values
                    .extend(at.iter().zip(before).zip(after).map(|((at, before), after)| at + 0.5 * (before + after))),
                false => values.extend_from_slice(at),
            }
        }
        Ok(Arc::new(Table { cx, cy, even, values: Arc::new(values) }))
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.values[..])
    }
}
