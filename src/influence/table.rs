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
use crate::memory::{reserve, zeros};

/// What memory is for.
const TABLE: &str = "the influence coefficients";

/// Round-off allowed in a symmetric table, relative to its largest coefficient: single-precision tables pass.
pub(super) const SYMMETRY: f64 = 1e-7;

/// Refuses a scale that turns coefficients around or away.
pub(super) fn check_scale(name: &str, scale: f64) -> Result<()> {
    require(scale > 0.0 && scale.is_finite(), name, scale, "coefficients are scaled by a positive, finite number")
}

/// A table of coefficients, `values[ky + cy][kx + cx]`, x fastest: the bytes of a Fortran `cf(-cx:cx-1, -cy:cy-1)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Elements of the grid that it was made for.
    pub(crate) cx: usize,
    pub(crate) cy: usize,
    /// Shared by all that hold the table.
    pub(crate) values: Arc<Vec<f64>>,
}

impl Table {
    /// A table of `2 cx` by `2 cy` coefficients that must cover `grid`.
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
        let (kept_x, kept_y) = (grid.mx, grid.my);
        let mut kept = zeros(4 * kept_x * kept_y, TABLE)?;
        for ky in -(kept_y as i64) + 1..kept_y as i64 {
            for kx in -(kept_x as i64) + 1..kept_x as i64 {
                let value = scale * values[(ky + cy as i64) as usize * 2 * cx + (kx + cx as i64) as usize];
                if !value.is_finite() {
                    return Err(Error::NotFinite(format!(
                        "influence.coefficients at offset ({kx}, {ky}) is {value}; coefficients must be finite"
                    )));
                }
                kept[(ky + kept_y as i64) as usize * 2 * kept_x + (kx + kept_x as i64) as usize] = value;
            }
        }
        let table = Table { cx: kept_x, cy: kept_y, values: Arc::new(kept) };
        if table.at(0, 0) <= 0.0 {
            return Err(Error::NotPositiveDefinite(format!(
                "influence.coefficients at offset (0, 0) is {}; a pressure must displace its own element inwards",
                table.at(0, 0)
            )));
        }
        Ok(table)
    }

    fn offsets(&self, grid: &Grid) -> impl Iterator<Item = (i64, i64)> {
        let (mx, my) = (grid.mx as i64, grid.my as i64);
        (0..my).flat_map(move |ky| (1 - mx..mx).map(move |kx| (kx, ky)))
    }
}

impl Kernel for Table {
    fn at(&self, kx: i64, ky: i64) -> f64 {
        let clamp = |k: i64, c: usize| (k.clamp(1 - c as i64, c as i64 - 1) + c as i64) as usize;
        self.values[clamp(ky, self.cy) * 2 * self.cx + clamp(kx, self.cx)]
    }

    fn fill_even_row(&self, ky: i64, out: &mut [f64]) {
        for (kx, value) in (0..).zip(out) {
            let four = [(kx, ky), (-kx, ky), (kx, -ky), (-kx, -ky)];
            *value = 0.25 * four.into_iter().map(|(x, y)| self.at(x, y)).sum::<f64>();
        }
    }

    fn is_even(&self, grid: &Grid) -> bool {
        self.offsets(grid).all(|(kx, ky)| {
            let value = self.at(kx, ky);
            value == self.at(-kx, ky) && value == self.at(kx, -ky)
        })
    }

    fn largest(&self, grid: &Grid) -> f64 {
        let both = self.offsets(grid).map(|(kx, ky)| self.at(kx, ky).abs().max(self.at(-kx, -ky).abs()));
        both.fold(0.0, f64::max)
    }

    fn is_symmetric(&self, grid: &Grid) -> bool {
        let largest = self.largest(grid);
        self.offsets(grid).all(|(kx, ky)| (self.at(kx, ky) - self.at(-kx, -ky)).abs() <= SYMMETRY * largest)
    }

    fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>> {
        let (half_x, half_y) = (coarse.mx < fine.mx, coarse.my < fine.my);
        // The outer two are added first: so the coarser coefficients of an even table are even to the last bit, as the
        // operator's shorter period (and the workspace that the grids share) needs them.
        let in_x = |kx: i64, ky: i64| match half_x {
            true => self.at(2 * kx, ky) + 0.5 * (self.at(2 * kx - 1, ky) + self.at(2 * kx + 1, ky)),
            false => self.at(kx, ky),
        };
        let in_both = |kx: i64, ky: i64| match half_y {
            true => in_x(kx, 2 * ky) + 0.5 * (in_x(kx, 2 * ky - 1) + in_x(kx, 2 * ky + 1)),
            false => in_x(kx, ky),
        };
        let (cx, cy) = (coarse.mx, coarse.my);
        let mut values = Vec::new();
        reserve(&mut values, 4 * cx * cy, TABLE)?;
        for ky in -(cy as i64)..cy as i64 {
            values.extend((-(cx as i64)..cx as i64).map(|kx| in_both(kx, ky)));
        }
        Ok(Arc::new(Table { cx, cy, values: Arc::new(values) }))
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.values[..])
    }
}
