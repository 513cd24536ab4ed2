//! The outline of the contact area, from which its true area is estimated.
//!
//! Counting whole elements overestimates a contact area, by a part of the elements along its outline. With N_a elements in
//! contact and M changes between contact and exterior along all rows and columns (Yastrebov, Anciaux, Molinari 2017)
//!
//! ```text
//! A* = (N_a - c M) dx dy,    c = (pi - 1 + ln 2)/24
//! ```
//!
//! c is a mean over all directions of the outline, in units of the elements. For elements that are not square the outline is stretched to
//! square ones: N_a and M are the same, and the area scales by dx dy.
//!
//! c does not hold for a straight outline parallel to the elements: all of it is off by the same part of an element.
//! Changes in such pieces are counted.

use std::borrow::Cow;
use std::f64::consts::{LN_2, PI};

use super::State;
use crate::grid::Grid;
use crate::memory::collected;

/// Part of an element by which each change overestimates the area.
const EXCESS_PER_CHANGE: f64 = (PI - 1.0 + LN_2) / 24.0;
/// Least elements of a straight piece.
pub(crate) const STRAIGHT: usize = 8;

/// The outline of a contact area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outline {
    /// M: changes between contact and an exterior element that has a surface, along all rows and columns.
    pub changes: usize,
    /// Changes in straight pieces, of 8 elements and more or from one end of the grid to the other: pieces along
    /// columns, and along rows.
    pub straight: (usize, usize),
    /// Sides of elements in contact beside an element without a surface.
    pub edges: usize,
    /// Edges in straight pieces.
    pub straight_edges: usize,
    /// Sides on the border of the grid: on its first and last column, and on its first and last row.
    pub border: (usize, usize),
    /// Rows with contact.
    pub rows: usize,
}

/// Successive rows with the same contact, and their changes and edges.
#[derive(Default)]
struct Same {
    rows: usize,
    changes: usize,
    edges: usize,
}

impl Outline {
    /// The outline of the elements that touch. Rows without contact cost almost nothing.
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

    fn add_border(&mut self, row: &[bool], iy: usize, my: usize) {
        self.border.0 += usize::from(row[0]) + usize::from(row[row.len() - 1]);
        if iy == 0 || iy + 1 == my {
            let count = row.iter().filter(|&&inside| inside).count();
            self.border.1 += if my == 1 { 2 * count } else { count };
        }
    }

    /// Ends the rows with the same contact.
    fn close(&mut self, same: &mut Same, my: usize) {
        let Same { rows, changes, edges } = std::mem::take(same);
        if rows >= STRAIGHT.min(my) {
            self.straight.0 += rows * changes;
            self.straight_edges += rows * edges;
        }
    }

    /// Sides at which the contact area ends with the surface, or with the grid in directions without a period.
    pub fn ends(&self, repeats: (bool, bool)) -> usize {
        let border = |sides: usize, repeats: bool| if repeats { 0 } else { sides };
        self.edges + border(self.border.0, repeats.0) + border(self.border.1, repeats.1)
    }

    /// The sum over the changes in straight pieces of the element's size across the piece.
    pub fn straight_length(&self, grid: &Grid) -> f64 {
        self.straight.0 as f64 * grid.dx + self.straight.1 as f64 * grid.dy
    }

    /// Mean length of the runs of `count` elements in contact, over rows and columns. A periodic border ends no run.
    pub fn chord(&self, count: usize, repeats: (bool, bool)) -> f64 {
        let sides = self.changes + self.ends(repeats);
        4.0 * count as f64 / sides.max(1) as f64
    }

    /// The part of the changes that lies in straight pieces.
    pub fn straight_part(&self) -> f64 {
        (self.straight.0 + self.straight.1) as f64 / self.changes.max(1) as f64
    }

    /// The root of the number of equal circles with the area of `count` elements and these chords, at least 1: the chord of one circle of this
    /// area, `(pi/2) sqrt(count/pi)`, over the mean chord.
    pub fn scatter(&self, count: usize, repeats: (bool, bool)) -> f64 {
        (0.5 * (PI * count as f64).sqrt() / self.chord(count, repeats)).max(1.0)
    }

    /// A*: the area of `count` elements in contact, corrected.
    pub fn corrected_area(&self, state: &State, count: usize) -> f64 {
        (count as f64 - EXCESS_PER_CHANGE * self.changes as f64).max(0.0) * state.grid.element_area()
    }
}

/// The elements that touch: those in contact, and those at their limit. Where no limit is reached, or without memory for a copy, those in contact.
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

/// Elements in contact in one of two rows only. Counts in bytes, which SIMD adds many at a time.
fn differing(a: &[bool], b: &[bool]) -> usize {
    const BYTE: usize = u8::MAX as usize;
    let pairs = a.chunks(BYTE).zip(b.chunks(BYTE));
    pairs.map(|(a, b)| usize::from(a.iter().zip(b).map(|(a, b)| u8::from(a != b)).sum::<u8>())).sum()
}

/// Contiguous pieces of the elements that differ between two rows.
fn pieces(a: &[bool], b: &[bool]) -> usize {
    let differs = |i: usize| a[i] != b[i];
    (0..a.len()).filter(|&i| differs(i) && (i == 0 || !differs(i - 1))).count()
}

#[cfg(test)]
#[path = "../../tests/unit/outline.rs"]
mod tests;
