//! Checks of the caller's tangential influence coefficients that have one table per loaded row. With displacements u by tractions q:
//!
//! ```text
//! u_x(ix, iy) = sum over jy and jx of  xx_jy(iy, k) qx(jx, jy) + xy_jy(iy, k) qy(jx, jy)          k = ix - jx
//! u_y(ix, iy) =                        yx_jy(iy, k) qx(jx, jy) + yy_jy(iy, k) qy(jx, jy)
//!
//! xx_jy(iy, k) = xx_iy(jy, -k),   yy alike,   yx_jy(iy, k) = xy_iy(jy, -k)           because the operator is symmetric
//! ```

use toeplitz::coefficients::SYMMETRY;

use super::tangential_influence::{TangentialInfluence, SCALE};
use crate::error::{invalid, require, Error, Number, Result};
use crate::grid::Grid;
use crate::influence::LARGEST_RATIO;

/// Names of the components xx, yy, xy in messages.
const NAMES: [&str; 3] =
    ["friction->row_tables[0] (xx)", "friction->row_tables[1] (yy)", "friction->row_tables[2] (xy)"];

impl TangentialInfluence<'_> {
    /// The coefficients `[xx, yy, xy, yx]` of the loaded row jy and the displaced row iy at an offset kx in x, `|kx| < cx`.
    pub fn of_rows(&self, jy: usize, iy: usize, kx: i64) -> [f64; 4] {
        let index = |jy: usize, iy: usize, kx: i64| (jy * self.cy + iy) * 2 * self.cx + (kx + self.cx as i64) as usize;
        let [xx, yy, xy] = self.coefficients.map(|values| self.scale * values[index(jy, iy, kx)]);
        [xx, yy, xy, self.scale * self.coefficients[2][index(iy, jy, -kx)]]
    }

    /// Refuses tables per loaded row whose sizes do not suit the grid, and coefficients that no elastic body has: that are not finite, not symmetric,
    /// or larger than those of an element on itself.
    pub(super) fn check_rows(&self, grid: &Grid) -> Result<()> {
        let TangentialInfluence { cx, cy: rows, scale, .. } = *self;
        require(scale > 0.0 && scale.is_finite(), "friction->row_tables->scale", scale, SCALE)?;
        if cx < grid.mx {
            let rule = format!("the tables must reach the offsets of the grid: {}", grid.mx);
            return invalid(format!("friction->row_tables->cx is {cx}; {rule}"));
        }
        if rows != grid.my {
            let rule = format!("there must be a table for each row of the grid: {}", grid.my);
            return invalid(format!("friction->row_tables->rows is {rows}; {rule}"));
        }
        let expected = rows.checked_mul(rows).and_then(|n| n.checked_mul(2)).and_then(|n| n.checked_mul(cx));
        for (values, name) in self.coefficients.iter().zip(NAMES) {
            if expected != Some(values.len()) {
                return invalid(format!("{name} has {} values; it must have rows by rows by 2 cx", values.len()));
            }
        }
        let largest = self.check_finite_and_own()?;
        (0..rows).try_for_each(|jy| (0..=jy).try_for_each(|iy| self.check_pair((jy, iy), largest)))
    }

    /// Refuses coefficients that are not finite, and coefficients xx and yy of an element on itself that are not positive. Returns the largest
    /// coefficient of an element on itself.
    fn check_finite_and_own(&self) -> Result<f64> {
        let (rows, width, mut largest) = (self.cy, 2 * self.cx, 0.0_f64);
        for (component, (values, name)) in self.coefficients.iter().zip(NAMES).enumerate() {
            for (k, row) in values.chunks_exact(width).enumerate() {
                let (jy, iy) = (k / rows, k % rows);
                let place =
                    |kx: usize| format!("{name} of rows (jy {jy}, iy {iy}) at offset {}", kx as i64 - self.cx as i64);
                // Column -cx is never read.
                if let Some(kx) = (1..width).find(|&kx| !(self.scale * row[kx]).is_finite()) {
                    let rule = "coefficients must be finite";
                    return Err(Error::NotFinite(format!("{} is {}; {rule}", place(kx), Number(self.scale * row[kx]))));
                }
                if component < 2 && jy == iy {
                    let own = self.scale * row[self.cx];
                    if !(own > 0.0) {
                        let rule = "a traction must displace its own element along";
                        return Err(Error::NotPositiveDefinite(format!(
                            "{} is {}; {rule}",
                            place(self.cx),
                            Number(own)
                        )));
                    }
                    largest = largest.max(own);
                }
            }
        }
        Ok(largest)
    }

    /// Refuses the coefficients between two rows if they are not symmetric to round-off, or if one exceeds `largest`, the largest coefficient of an
    /// element on itself.
    fn check_pair(&self, (jy, iy): (usize, usize), largest: f64) -> Result<()> {
        for kx in 1 - self.cx as i64..self.cx as i64 {
            let (one, other) = (self.of_rows(jy, iy, kx), self.of_rows(iy, jy, -kx));
            let is_off = |component: &usize| !((one[*component] - other[*component]).abs() <= SYMMETRY * largest);
            if let Some(component) = (0..2).find(is_off) {
                let (a, b) = (Number(one[component]), Number(other[component]));
                let places =
                    format!("of rows (jy {jy}, iy {iy}) at offset {kx} and {b} of rows (jy {iy}, iy {jy}) at {}", -kx);
                let rule = "the operator must be symmetric";
                return Err(Error::Unsupported(format!("{} is {a} {places}; {rule}", NAMES[component])));
            }
            if let Some(component) = (0..4).find(|&component| one[component].abs() > LARGEST_RATIO * largest) {
                // Component 3, yx, is the xy of the table of row iy.
                let (jy, iy, kx) = if component < 3 { (jy, iy, kx) } else { (iy, jy, -kx) };
                let (name, value, own) = (NAMES[component.min(2)], Number(one[component]), Number(largest));
                return Err(Error::NotPositiveDefinite(format!(
                    "{name} of rows (jy {jy}, iy {iy}) at offset {kx} is {value}, and at most {own} of an element on itself: no elastic body moves \
                     another element more than the one that is pulled"
                )));
            }
        }
        Ok(())
    }
}
