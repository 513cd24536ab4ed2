//! The half-space whose stresses are computed, and its unit of length.

use crate::error::{require, Result};
use crate::grid::Grid;

/// The names of the stress components, in the order of all arrays.
pub const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];

/// Whether each load acts: the pressure, the traction in x, the traction in y.
pub type Loaded = [bool; 3];

/// The longer side of an element. On a single line of elements it is the side along the line: pressures change from element to element over this
/// length.
pub fn side(grid: &Grid) -> f64 {
    match (grid.mx, grid.my) {
        (2.., 1) => grid.dx,
        (1, 2..) => grid.dy,
        _ => grid.dx.max(grid.dy),
    }
}

/// A half-space that is loaded on the elements of a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// The grid of elements.
    pub grid: Grid,
    /// The Poisson ratio nu, in (-1, 0.5].
    pub poisson_ratio: f64,
    /// Whether the loads are periodic in x and in y, with the lengths of the grid. The mean lateral strains are then 0.
    pub periodic: bool,
}

impl Body {
    /// Refuses an invalid grid, and a Poisson ratio out of range.
    pub(super) fn check(&self) -> Result<()> {
        self.grid.check()?;
        let nu = self.poisson_ratio;
        require(nu > -1.0 && nu <= 0.5, "poisson_ratio", nu, "it must lie in (-1, 0.5]")
    }

    /// This body, but with square elements if it is a periodic line of elements. The loads on such a line are uniform across it, however wide the
    /// elements are (plane strain).
    pub fn of_square_elements(mut self) -> Body {
        let Grid { mx, my, .. } = self.grid;
        if self.periodic && (mx == 1 || my == 1) {
            let side = side(&self.grid);
            (self.grid.dx, self.grid.dy) = (side, side);
        }
        self
    }

    /// The unit of lengths in this module: the longer side of an element. Kernels depend on ratios of lengths only.
    pub(super) fn unit(&self) -> f64 {
        self.grid.dx.max(self.grid.dy)
    }

    /// The sides of an element in this unit.
    pub(super) fn element(&self) -> (f64, f64) {
        (self.grid.dx / self.unit(), self.grid.dy / self.unit())
    }

    /// A length in this unit. A length whose square would underflow becomes 0. A length whose square would overflow is cut off; there the
    /// stresses are 0.
    pub(super) fn in_units(&self, length: f64) -> f64 {
        let ratio = (length / self.unit()).clamp(-1e150, 1e150);
        if ratio.abs() < 1e-100 {
            0.0
        } else {
            ratio
        }
    }
}
