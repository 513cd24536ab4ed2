//! The grid: the potential contact area, divided into `mx` by `my` rectangular elements of size `dx` by `dy`.

use std::f64::consts::PI;
use std::ops::Range;

use crate::error::{invalid, require, Result};

/// A grid of `mx * my` elements of size `dx * dy`. Arrays of one value per element are `[my][mx]`, x fastest: element `(ix, iy)` has the index
/// `iy * mx + ix`. A Fortran array `a(mx, my)` has the same memory layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Elements in x.
    pub mx: usize,
    /// Elements in y.
    pub my: usize,
    /// Element size in x.
    pub dx: f64,
    /// Element size in y.
    pub dy: f64,
}

/// The largest number of elements. The C ABI and the padded products count elements in 32 bits.
pub(crate) const MOST_ELEMENTS: usize = i32::MAX as usize;

/// The factor on the number of elements if they are doubled in these directions: 4 for both, else 2.
pub fn doubling((in_x, in_y): (bool, bool)) -> f64 {
    if in_x && in_y {
        4.0
    } else {
        2.0
    }
}

impl Grid {
    /// A message that names the first size in which this grid differs from that of a set-up. None if all sizes are equal.
    pub fn differs(&self, of_set_up: &Grid) -> Option<String> {
        let sizes = |grid: &Grid| [("mx", grid.mx as f64), ("my", grid.my as f64), ("dx", grid.dx), ("dy", grid.dy)];
        let pairs = sizes(self).into_iter().zip(sizes(of_set_up));
        let ((name, now), (_, at_set_up)) = pairs.into_iter().find(|((_, now), (_, at_set_up))| now != at_set_up)?;
        Some(format!("{name} is {now}; this solver was set up for {at_set_up}"))
    }

    /// The directions in which a finer grid has more elements. Not in a periodic direction of one element, along which nothing varies; unless the
    /// grid has only this element.
    pub fn refines(&self, (repeats_x, repeats_y): (bool, bool)) -> (bool, bool) {
        (self.mx > 1 || !repeats_x || self.my == 1, self.my > 1 || !repeats_y || self.mx == 1)
    }

    /// Makes a grid, and refuses invalid sizes.
    pub fn new(mx: usize, my: usize, dx: f64, dy: f64) -> Result<Grid> {
        let grid = Grid { mx, my, dx, dy };
        grid.check()?;
        Ok(grid)
    }

    /// Refuses invalid sizes. A caller may have made the grid without [`new`](Self::new).
    pub fn check(&self) -> Result<()> {
        let Grid { mx, my, dx, dy } = *self;
        for (name, m) in [("mx", mx), ("my", my)] {
            if m == 0 {
                return invalid(format!("{name} is 0; a grid has at least one element in each direction"));
            }
        }
        match mx.checked_mul(my) {
            Some(n) if n <= MOST_ELEMENTS => {}
            _ => return invalid(format!("mx * my is {mx} * {my}; a grid has at most {MOST_ELEMENTS} elements")),
        }
        for (name, d) in [("dx", dx), ("dy", dy)] {
            require(d > 0.0 && d.is_finite(), name, d, "an element size must be positive and finite")?;
        }
        Ok(())
    }

    /// The number of rows of a block, if the grid is divided into at most `most` blocks of about `least` elements or more. The number does not depend
    /// on the threads.
    pub(crate) fn rows_of_blocks(&self, most: usize, least: usize) -> usize {
        self.my.div_ceil(most).max(least / self.mx).min(self.my)
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.mx * self.my
    }

    /// Whether element `i` lies in the first or last row or column, not counting the ends of periodic directions.
    pub(crate) fn is_at_end(&self, i: usize, (repeats_x, repeats_y): (bool, bool)) -> bool {
        let (x, y) = (i % self.mx, i / self.mx);
        !repeats_x && (x == 0 || x + 1 == self.mx) || !repeats_y && (y == 0 || y + 1 == self.my)
    }

    /// Always false: a grid has at least one element.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Area of one element.
    pub fn element_area(&self) -> f64 {
        self.dx * self.dy
    }

    /// E* of half-spaces on which a unit pressure on an element displaces the element itself by `self_influence`. At the centre of a uniformly loaded
    /// rectangle, E* times this displacement is `(2/pi) (dx asinh(dy/dx) + dy asinh(dx/dy))` (Love 1929).
    pub fn modulus(&self, self_influence: f64) -> f64 {
        let (dx, dy) = (self.dx, self.dy);
        2.0 / PI * (dx * (dy / dx).asinh() + dy * (dx / dy).asinh()) / self_influence
    }

    /// Element `i` in words, for messages.
    pub(crate) fn element(&self, i: usize) -> String {
        format!("element ({}, {})", i % self.mx, i / self.mx)
    }

    /// The centre of element `i`, relative to the centre of the grid.
    pub fn place(&self, i: usize) -> [f64; 2] {
        let from_middle = |k: usize, m: usize, d: f64| (k as f64 - 0.5 * (m as f64 - 1.0)) * d;
        [from_middle(i % self.mx, self.mx, self.dx), from_middle(i / self.mx, self.my, self.dy)]
    }

    /// The numbers of offsets >= 0 between elements, in x and in y. In a periodic direction offsets reach to half the period; there are as many
    /// wave numbers >= 0.
    pub(crate) fn offsets(&self, (x, y): (bool, bool)) -> (usize, usize) {
        let offsets = |repeats: bool, m: usize| if repeats { m / 2 + 1 } else { m };
        (offsets(x, self.mx), offsets(y, self.my))
    }

    /// Index of element `(ix, iy)`.
    pub fn index(&self, ix: usize, iy: usize) -> usize {
        iy * self.mx + ix
    }

    /// The elements of the next finer grid that element i of this grid covers: 2 x 2, or fewer at the end of an odd number of elements and if one
    /// direction is not coarsened.
    pub fn children(&self, fine: &Grid, i: usize) -> impl Iterator<Item = usize> {
        let (columns, mx) = (children(fine.mx, self.mx, i % self.mx), fine.mx);
        children(fine.my, self.my, i / self.mx).flat_map(move |y| columns.clone().map(move |x| y * mx + x))
    }
}

/// Along one direction: the elements of a line of `fine` elements that element i of a line of `coarse` elements covers.
pub fn children(fine: usize, coarse: usize, i: usize) -> Range<usize> {
    let factor = if coarse < fine { 2 } else { 1 };
    factor * i..(factor * (i + 1)).min(fine)
}

/// Refuses arrays that have not one value per element, or in which a value does not meet `require`. The message names the first such value.
pub(crate) fn check_values(
    name: &str,
    values: &[f64],
    grid: &Grid,
    require: impl Fn(&str, f64) -> Result<()>,
) -> Result<()> {
    if values.len() != grid.len() {
        return invalid(format!("{name} has {} values; the grid has {} elements", values.len(), grid.len()));
    }
    match values.iter().position(|value| require(name, *value).is_err()) {
        Some(i) => require(&format!("{name} of {}", grid.element(i)), values[i]),
        None => Ok(()),
    }
}
