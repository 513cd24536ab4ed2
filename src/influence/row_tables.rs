//! Coefficients that differ from one loaded row to another: one table for each row jy of loaded elements.
//!
//! ```text
//! A_IJ = c_jy(iy, ix - jx),     u(ix, iy) = sum over jy and jx of c_jy(iy, ix - jx) p(jx, jy)
//! ```
//!
//! Examples are surfaces that vary along y: conformal contact, a varying inclination, a layer of varying thickness. A is Toeplitz in x only. The
//! coefficients need not be symmetric or positive.
//!
//! On a coarser grid a coefficient is the mean displacement of the fine elements of one coarse element by a unit pressure on the fine elements of
//! another. In x it is computed as for [`Table`](super::Table). In y it is
//!
//! ```text
//! C_J(I, k) = (c_2J(2I, k) + c_2J(2I+1, k) + c_2J+1(2I, k) + c_2J+1(2I+1, k))/2
//! ```
//!
//! If the number of rows is odd, the last coarse row exceeds the grid. A pair with a fine row beyond the last is then replaced by the pair one
//! row before, at the same distance.
//!
//! A preconditioner uses, at each offset, the mean over the rows.

use std::any::Any;
use std::sync::Arc;

use super::given::width;
use super::kernel::Kernel;
use super::table::LARGEST_RATIO;
use super::table::{check_scale, coarsen_row, index_of};
use super::table_properties::{are_finite, largest, SYMMETRY};
use crate::error::{invalid, Error, Number, Result};
use crate::grid::Grid;
use crate::memory::{blank, reserve, Held};

/// The name of the memory of the tables in messages.
const TABLES: &str = "the tables of coefficients";

/// The tables of all rows. If all are even in x, only offsets >= 0 in x are stored.
#[derive(Clone, Debug, PartialEq)]
pub struct RowTables {
    /// The numbers of elements of the grid in x and in y.
    pub(crate) mx: usize,
    pub(crate) my: usize,
    even: bool,
    /// The largest absolute value of a coefficient.
    largest: f64,
    /// The coefficients `[jy][iy][width]`. Copies of the tables share them.
    pub(crate) values: Arc<Held>,
}

/// Checks the caller's coefficients, and returns whether all tables are even in x.
fn are_even(cx: usize, values: &[f64], scale: f64, grid: &Grid) -> Result<bool> {
    let Grid { mx, my, .. } = *grid;
    let mut even = true;
    for (k, row) in values.chunks_exact(2 * cx).enumerate() {
        let (jy, iy) = (k / my, k % my);
        let row = &row[cx + 1 - mx..cx + mx];
        // The fold has no early exit, so that the compiler vectorises it. Of an even row, only the half that is stored is tested for finite
        // values.
        even &= row[mx - 1..].iter().zip(row[..mx].iter().rev()).fold(true, |all, (a, b)| all & (a == b));
        if !are_finite(if even { &row[mx - 1..] } else { row }, scale) {
            let i = row.iter().position(|value| !(scale * value).is_finite()).unwrap_or(0);
            let kx = i as i64 - (mx as i64 - 1);
            return Err(Error::NotFinite(format!(
                "row_tables->coefficients of rows (jy {jy}, iy {iy}) at offset {kx} is {}; coefficients must be finite",
                Number(scale * row[i])
            )));
        }
        if jy == iy && scale * row[mx - 1] <= 0.0 {
            return Err(Error::NotPositiveDefinite(format!(
                "row_tables->coefficients of rows (jy {jy}, iy {iy}) at offset 0 is {}; a pressure must displace its largest_own \
                 element inwards",
                Number(scale * row[mx - 1])
            )));
        }
    }
    Ok(even)
}

impl RowTables {
    /// Returns the kernel as row tables, if it is of this type.
    pub fn of(kernel: &dyn Kernel) -> Option<&RowTables> {
        (kernel as &dyn Any).downcast_ref()
    }

    /// Tables from `rows` by `rows` by `2 cx` coefficients `values[jy][iy][kx + cx]`. They must fit `grid`: `rows` is my, and cx is at least mx.
    /// Column `-cx` is unused.
    pub fn new(cx: usize, rows: usize, values: &[f64], grid: &Grid) -> Result<RowTables> {
        RowTables::scaled(cx, rows, values, 1.0, grid)
    }

    /// [`RowTables::new`] with the coefficients `scale * values`.
    pub fn scaled(cx: usize, rows: usize, values: &[f64], scale: f64, grid: &Grid) -> Result<RowTables> {
        check_scale("row_tables->scale", scale)?;
        let Grid { mx, my, .. } = *grid;
        if cx < mx {
            return invalid(format!("row_tables->cx is {cx}; the tables must reach offsets of the grid, mx = {mx}"));
        }
        if rows != my {
            return invalid(format!(
                "row_tables->rows is {rows}; there must be a table for each row of the grid, my = {my}"
            ));
        }
        let expected = rows.checked_mul(rows).and_then(|n| n.checked_mul(2)).and_then(|n| n.checked_mul(cx));
        if expected != Some(values.len()) {
            return invalid(format!(
                "the row tables have {} values; they must have rows by rows by 2 cx",
                values.len()
            ));
        }
        let even = are_even(cx, values, scale, grid)?;
        // Only the offsets of the grid are stored.
        let mut kept = Vec::new();
        reserve(&mut kept, my * my * width(mx, even), TABLES)?;
        for row in values.chunks_exact(2 * cx) {
            let row = &row[if even { cx } else { cx + 1 - mx }..cx + mx];
            kept.extend(row.iter().map(|value| scale * value));
        }
        Ok(RowTables { mx, my, even, largest: largest(&kept), values: Arc::new(kept.into()) })
    }

    /// Refuses tables in which the mean of a coefficient and that of the opposite pair exceeds every coefficient of an element on itself. Two
    /// such elements alone have an indefinite matrix.
    pub(crate) fn check_largest(&self) -> Result<()> {
        let largest_own = (0..self.my).map(|jy| self.coefficient(jy, jy, 0)).fold(0.0, f64::max);
        if self.largest <= LARGEST_RATIO * largest_own {
            return Ok(());
        }
        let last = self.mx as i64 - 1;
        let pairs = (0..self.my * self.my).flat_map(|k| (-last..=last).map(move |kx| (k / self.my, k % self.my, kx)));
        let mean = |(jy, iy, kx): (usize, usize, i64)| {
            0.5 * (self.coefficient(jy, iy, kx) + self.coefficient(iy, jy, -kx)).abs()
        };
        let Some((jy, iy, kx)) = pairs.into_iter().find(|pair| mean(*pair) > LARGEST_RATIO * largest_own) else {
            return Ok(());
        };
        Err(Error::NotPositiveDefinite(format!(
            "row_tables->coefficients of rows (jy {jy}, iy {iy}) at offset {kx} is {}, and at most {} of an element on itself: no elastic body moves \
             another element more than the one that is pressed",
            Number(self.coefficient(jy, iy, kx)),
            Number(largest_own)
        )))
    }

    /// Whether all tables are even in x.
    pub fn is_even_in_x(&self) -> bool {
        self.even
    }

    /// The coefficient between elements of the loaded row jy and elements of row iy, at offset kx. Beyond the table it is the outermost
    /// coefficient.
    pub fn coefficient(&self, jy: usize, iy: usize, kx: i64) -> f64 {
        self.row(jy, iy)[self.column(kx)]
    }

    /// Fills `out` with the coefficients between the loaded row jy and row iy. If all tables are even, `out` gets those at offsets `0..mx`.
    /// Otherwise `out` is a period that begins at offset 0, has the negative offsets at its end, and zeros between.
    pub fn fill(&self, jy: usize, iy: usize, out: &mut [f64]) {
        let (row, mx, n) = (self.row(jy, iy), self.mx, out.len());
        if self.even {
            return out.copy_from_slice(row);
        }
        out.fill(0.0);
        out[..mx].copy_from_slice(&row[mx - 1..]);
        out[n - (mx - 1)..].copy_from_slice(&row[..mx - 1]);
    }

    /// The stored coefficients between the loaded row jy and row iy: at offsets `0..mx` if all tables are even, otherwise from `1 - mx` on.
    pub fn row(&self, jy: usize, iy: usize) -> &[f64] {
        let width = width(self.mx, self.even);
        &self.values[(jy * self.my + iy) * width..][..width]
    }

    /// The index of offset kx in a stored row; beyond its end, the index of the outermost coefficient.
    fn column(&self, kx: i64) -> usize {
        index_of(kx, self.mx, self.even)
    }

    /// All pairs of rows `(jy, iy)` with `iy - jy = ky`. If ky lies beyond the grid, these are the pairs of the largest distance.
    fn rows_apart(&self, ky: i64) -> impl Iterator<Item = (usize, usize)> + Clone {
        let last = self.my as i64 - 1;
        let ky = ky.clamp(-last, last);
        ((-ky).max(0)..=(last - ky).min(last)).map(move |jy| (jy as usize, (jy + ky) as usize))
    }
}

impl Kernel for RowTables {
    fn at(&self, kx: i64, ky: i64) -> f64 {
        let rows = self.rows_apart(ky);
        let count = rows.clone().count() as f64;
        rows.map(|(jy, iy)| self.coefficient(jy, iy, kx)).sum::<f64>() / count
    }

    fn between(&self, (jx, jy): (i64, i64), (ix, iy): (i64, i64)) -> f64 {
        self.coefficient(jy as usize, iy as usize, ix - jx)
    }

    fn fill_even_row(&self, ky: i64, out: &mut [f64]) {
        out.fill(0.0);
        let rows = || self.rows_apart(ky).chain(self.rows_apart(-ky));
        for row in rows().map(|(jy, iy)| self.row(jy, iy)) {
            let inside = if self.even { out.len().min(self.mx) } else { 0 };
            out[..inside].iter_mut().zip(row).for_each(|(value, c)| *value += c + c);
            for (value, kx) in out[inside..].iter_mut().zip(inside as i64..) {
                *value += row[self.column(kx)] + row[self.column(-kx)];
            }
        }
        let share = 0.5 / rows().count() as f64;
        out.iter_mut().for_each(|value| *value *= share);
    }

    fn largest(&self, _grid: &Grid) -> f64 {
        self.largest
    }

    fn is_even(&self, _grid: &Grid) -> bool {
        false
    }

    fn is_symmetric(&self, _grid: &Grid) -> bool {
        let allowed = SYMMETRY * self.largest;
        let alike = |jy: usize, iy: usize| {
            let (row, opposite) = (self.row(jy, iy), self.row(iy, jy));
            let near = |all: bool, (a, b): (&f64, &f64)| all & ((a - b).abs() <= allowed);
            match self.even {
                true => row.iter().zip(opposite).fold(true, near),
                false => row.iter().zip(opposite.iter().rev()).fold(true, near),
            }
        };
        (0..self.my).all(|jy| (0..=jy).all(|iy| alike(jy, iy)))
    }

    fn coarsen(&self, _fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>> {
        let Grid { mx, my, .. } = *coarse;
        let (half_x, half_y) = (mx < self.mx, my < self.my);
        // If one of the rows lies beyond the last, both are shifted back by as much, which keeps their distance.
        let row = |jy: usize, iy: usize| {
            let beyond = jy.max(iy).saturating_sub(self.my - 1);
            self.row(jy.saturating_sub(beyond), iy.saturating_sub(beyond))
        };
        let (fine, coarse) = (width(self.mx, self.even), width(mx, self.even));
        let mut joined = blank(fine, f64::NAN, TABLES)?;
        let mut values = blank(my * my * coarse, f64::NAN, TABLES)?;
        for (k, out) in values.chunks_exact_mut(coarse).enumerate() {
            let (jy, iy) = (k / my, k % my);
            if !half_y {
                coarsen_row(row(jy, iy), self.mx, self.even, half_x, out);
                continue;
            }
            let one = row(2 * jy, 2 * iy).iter().zip(row(2 * jy + 1, 2 * iy + 1));
            let other = row(2 * jy, 2 * iy + 1).iter().zip(row(2 * jy + 1, 2 * iy));
            for (value, ((a, b), (c, d))) in joined.iter_mut().zip(one.zip(other)) {
                *value = 0.5 * (a + b) + 0.5 * (c + d);
            }
            coarsen_row(&joined, self.mx, self.even, half_x, out);
        }
        Ok(Arc::new(RowTables { mx, my, even: self.even, largest: largest(&values), values: Arc::new(values.into()) }))
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.values[..])
    }
}
