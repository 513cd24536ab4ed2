//! The half-space whose stresses are computed, and its units.

use crate::error::{require, Result};
use crate::grid::Grid;

/// Names of the components, in their order.
pub const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];

/// Which loads act: pressure, traction in x, traction in y.
pub type Loaded = [bool; 3];

/// The longer side of an element, or that across a single line of them: pressures change from element to element over this length.
pub fn side(grid: &Grid) -> f64 {
    match (grid.mx, grid.my) {
        (2.., 1) => grid.dx,
        (1, 2..) => grid.dy,
        _ => grid.dx.max(grid.dy),
    }
}

/// A half-space with loads on the elements of a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// The elements.
    pub grid: Grid,
    /// nu, in (-1, 0.5].
    pub poisson_ratio: f64,
    /// Whether the loads are periodic with the grid's length in x and in y. Lateral strains have mean zero.
    pub periodic: bool,
}

impl Body {
    pub(super) fn check(&self) -> Result<()> {
        self.grid.check()?;
        let nu = self.poisson_ratio;
        require(nu > -1.0 && nu <= 0.5, "poisson_ratio", nu, "it must lie in (-1, 0.5]")
    }

    /// This body. A periodic line gets square elements, because its loads are uniform along them, however long they are (plane strain).
    pub fn of_square_elements(mut self) -> Body {
        let Grid { mx, my, .. } = self.grid;
        if self.periodic && (mx == 1 || my == 1) {
            let side = side(&self.grid);
            (self.grid.dx, self.grid.dy) = (side, side);
        }
        self
    }

    /// The unit of lengths inside: the longer side of an element. Kernels depend on ratios of lengths only.
    pub(super) fn unit(&self) -> f64 {
        self.grid.dx.max(self.grid.dy)
    }

    /// An element's sides in that unit.
    pub(super) fn element(&self) -> (f64, f64) {
        (self.grid.dx / self.unit(), self.grid.dy / self.unit())
    }

    /// A length in that unit. It is 0 if its square would underflow. It is cut off if its square would overflow, where stresses are 0.
    pub(super) fn in_units(&self, length: f64) -> f64 {
        let ratio = (length / self.unit()).clamp(-1e150, 1e150);
        if ratio.abs() < 1e-100 {
            0.0
        } else {
            ratio
        }
    }
}
