//! The outline of the contact area, from which the true area of contact is estimated.
//!
//! The area of the elements in contact overestimates the true area, by a part of the elements along the outline. Let N_a elements be in contact, and
//! let M be the number of changes between contact and exterior along all rows and columns. The corrected area is (Yastrebov, Anciaux, Molinari 2017)
//!
//! ```text
//! A* = (N_a - c M) dx dy,    c = (pi - 1 + ln 2)/24
//! ```
//!
//! The number c is a mean over all directions of the outline, for square elements of size 1. If elements are not square, the grid is stretched until
//! they are: N_a and M stay the same, and the area scales by dx dy.
//!
//! The number c does not hold for a straight piece of outline along a row or column: all its elements are off by the same part of an element. Changes
//! in such pieces are counted separately.

use std::borrow::Cow;
use std::f64::consts::{LN_2, PI};

use super::State;
use crate::grid::Grid;
use crate::memory::collected;

/// The number c: the part of an element by which each change overestimates the area.
const EXCESS_PER_CHANGE: f64 = (PI - 1.0 + LN_2) / 24.0;
/// A piece of outline along a row or column counts as straight from this many elements on.
pub(crate) const STRAIGHT: usize = 8;

/// The outline of a contact area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outline {
    /// M: changes between contact and an exterior element that has a surface, along all rows and columns.
    pub changes: usize,
    /// The changes in straight pieces, which have 8 elements or more, or go from one end of the grid to the other. The first number is that of pieces
    /// along columns, the second that of pieces along rows.
    pub straight: (usize, usize),
    /// The number of sides between an element in contact and an element without a surface.
    pub edges: usize,
    /// The number of `edges` in straight pieces.
    pub straight_edges: usize,
    /// The number of sides of elements in contact on the border of the grid: on the first and last column, and on the first and last row.
    pub border: (usize, usize),
    /// The number of rows with contact.
    pub rows: usize,
}

/// Successive rows with the same elements in contact.
#[derive(Default)]
struct Same {
    /// The number of these rows.
    rows: usize,
    /// Changes along one of these rows.
    changes: usize,
    /// Sides beside elements without a surface, along one of these rows.
    edges: usize,
}

impl Outline {
    /// Counts the outline of the elements in contact or at their limit. Rows without contact cost almost nothing.
    pub fn of(state: &State) -> Outline {
        let (mx, my) = (state.grid.mx, state.grid.my);
        let area = touching(state);
        let mut outline = Outline::default();
        let (mut above, mut same): (&[bool], Same) = (&[], Same::default());
        let (mut above_touches, mut above_holes) = (false, None);
        for (iy, row) in area.chunks_exact(mx).enumerate() {
            let touches = row.contains(&true);
            let mut row_holes = None;
            if touches || above_touches {
                let start = iy * mx;
                let (along, across) = (differing(&row[1..], &row[..mx - 1]), differing(row, above));
                let with_holes = holes(&state.h[start..start + mx]);
                row_holes = Some(with_holes);
                let above_with_holes = above_holes.unwrap_or_else(|| holes(&state.h[start.saturating_sub(mx)..start]));
                let (mut ends_along, mut ends_across) = (0, 0);
                if with_holes || above_with_holes {
                    let ends = |i: usize, j: usize| area[i] != area[j] && state.h[i].max(state.h[j]).is_infinite();
                    ends_along = (start..start + mx - 1).filter(|&i| ends(i, i + 1)).count();
                    ends_across = if iy > 0 { (start..start + mx).filter(|&i| ends(i - mx, i)).count() } else { 0 };
                }
                outline.changes += along + across - ends_along - ends_across;
                outline.edges += ends_along + ends_across;
                if across >= STRAIGHT.min(mx) && across >= STRAIGHT.min(mx) * pieces(row, above) {
                    outline.straight.1 += across - ends_across;
                    outline.straight_edges += ends_across;
                }
                let (changes, edges) = (along - ends_along, ends_along);
                if across > 0 || above.is_empty() || (changes, edges) != (same.changes, same.edges) {
                    outline.close(&mut same, my);
                }
                same = Same { rows: same.rows + 1, changes, edges };
                outline.add_border(row, iy, my);
            }
            outline.rows += usize::from(touches);
            (above, above_touches, above_holes) = (row, touches, row_holes);
        }
        outline.close(&mut same, my);
        outline
    }

    /// Adds the sides of row `iy` that lie on the border of the grid.
    fn add_border(&mut self, row: &[bool], iy: usize, my: usize) {
        self.border.0 += usize::from(row[0]) + usize::from(row[row.len() - 1]);
        if iy == 0 || iy + 1 == my {
            let count = row.iter().filter(|&&inside| inside).count();
            self.border.1 += if my == 1 { 2 * count } else { count };
        }
    }

    /// Ends a group of rows with the same elements in contact: in a large group their changes lie in straight pieces along columns.
    fn close(&mut self, same: &mut Same, my: usize) {
        let Same { rows, changes, edges } = std::mem::take(same);
        if rows >= STRAIGHT.min(my) {
            self.straight.0 += rows * changes;
            self.straight_edges += rows * edges;
        }
    }

    /// The number of sides at which the contact area ends because the surface ends there, or the grid in a direction without a period.
    pub fn ends(&self, repeats: (bool, bool)) -> usize {
        let border = |sides: usize, repeats: bool| if repeats { 0 } else { sides };
        self.edges + border(self.border.0, repeats.0) + border(self.border.1, repeats.1)
    }

    /// Adds up, over all changes in straight pieces, the size of an element across the piece (dx for a piece along a column, dy for one along a row).
    pub fn straight_length(&self, grid: &Grid) -> f64 {
        self.straight.0 as f64 * grid.dx + self.straight.1 as f64 * grid.dy
    }

    /// The mean number of consecutive elements in contact along rows and columns, if `count` elements are in contact. Contact goes on across a
    /// periodic border.
    pub fn chord(&self, count: usize, repeats: (bool, bool)) -> f64 {
        let sides = self.changes + self.ends(repeats);
        4.0 * count as f64 / sides.max(1) as f64
    }

    /// The fraction of all changes that lies in straight pieces.
    pub fn straight_part(&self) -> f64 {
        (self.straight.0 + self.straight.1) as f64 / self.changes.max(1) as f64
    }

    /// How scattered the contact area is: the root of the number of equal circles that together have the area of `count` elements and the mean chord
    /// of this outline. It is the mean chord of one circle of this area, `(pi/2) sqrt(count/pi)`, over [`chord`](Outline::chord), and at least 1.
    pub fn scatter(&self, count: usize, repeats: (bool, bool)) -> f64 {
        (0.5 * (PI * count as f64).sqrt() / self.chord(count, repeats)).max(1.0)
    }

    /// The corrected area A* if `count` elements are in contact.
    pub fn corrected_area(&self, state: &State, count: usize) -> f64 {
        (count as f64 - EXCESS_PER_CHANGE * self.changes as f64).max(0.0) * state.grid.element_area()
    }
}

/// Marks the elements that touch: those in C and those at their limit. If no element is at its limit, or there is no memory for a copy, the result is
/// C.
pub fn touching(state: &State) -> Cow<'_, [bool]> {
    if state.has_limited() {
        let touches = (0..state.contact.len()).map(|i| state.touches(i));
        if let Ok(touching) = collected(touches, "the elements that touch") {
            return Cow::Owned(touching);
        }
    }
    Cow::Borrowed(&state.contact)
}

/// Whether a row has elements without a surface.
fn holes(h: &[f64]) -> bool {
    h.iter().fold(false, |any, h| any | h.is_infinite())
}

/// The number of elements that are in contact in one of two rows only. It is counted in bytes, of which SIMD adds many at a time.
fn differing(a: &[bool], b: &[bool]) -> usize {
    const BYTE: usize = u8::MAX as usize;
    let pairs = a.chunks(BYTE).zip(b.chunks(BYTE));
    pairs.map(|(a, b)| usize::from(a.iter().zip(b).map(|(a, b)| u8::from(a != b)).sum::<u8>())).sum()
}

/// The number of contiguous groups of elements that differ between two rows.
fn pieces(a: &[bool], b: &[bool]) -> usize {
    let differs = |i: usize| a[i] != b[i];
    (0..a.len()).filter(|&i| differs(i) && (i == 0 || !differs(i - 1))).count()
}

#[cfg(test)]
#[path = "../../tests/unit/outline.rs"]
mod tests;
