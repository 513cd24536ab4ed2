//! The outline of the contact area, from which its true area is estimated.
//!
//! Counting whole elements overestimates a contact area, by a part of the elements along its outline. With N_a elements in
//! contact and M changes between contact and exterior along all rows and columns (Yastrebov, Anciaux, Molinari 2017)
//!
//! ```text
//! A* = (N_a - c M) dx dy,    c = (pi - 1 + ln 2)/24
//! ```
//!
//! c is a mean over all directions of the outline, in units of the elements: of elements that are not square the outline is
//! stretched to one on square ones, where N_a and M are the same, and the area shrinks by dx dy with it.

use std::f64::consts::{LN_2, PI};

use super::State;

/// Part of an element by which each change overestimates the area.
const SHARE: f64 = (PI - 1.0 + LN_2) / 24.0;

/// The outline of a contact area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outline {
    /// M: changes between contact and an exterior element that has a surface, along all rows and columns.
    pub changes: usize,
    /// Sides of elements in contact that lie on the border of the grid, or beside an element without a surface.
    pub edges: usize,
}

impl Outline {
    /// Follows the rows and columns of a contact area; those without contact cost next to nothing.
    pub fn of(state: &State) -> Outline {
        let (mx, my) = (state.grid.mx, state.grid.my);
        let holes = |h: &[f64]| h.iter().fold(false, |any, h| any | h.is_infinite());
        let mut outline = Outline::default();
        let (mut above, mut above_touches, mut above_holes): (&[bool], bool, Option<bool>) = (&[], false, None);
        for (iy, row) in state.contact.chunks_exact(mx).enumerate() {
            let touches = row.contains(&true);
            let mut row_holes = None;
            if touches || above_touches {
                let start = iy * mx;
                outline.changes += differing(&row[1..], &row[..mx - 1]) + differing(row, above);
                outline.edges += usize::from(row[0]) + usize::from(row[mx - 1]);
                if iy == 0 || iy + 1 == my {
                    let count = row.iter().filter(|&&inside| inside).count();
                    outline.edges += if my == 1 { 2 * count } else { count };
                }
                let with_holes = holes(&state.h[start..start + mx]);
                row_holes = Some(with_holes);
                let above_with_holes = above_holes.unwrap_or_else(|| holes(&state.h[start.saturating_sub(mx)..start]));
                if with_holes || above_with_holes {
                    let ends = |i: usize, j: usize| {
                        state.contact[i] != state.contact[j] && state.h[i].max(state.h[j]).is_infinite()
                    };
                    let along = (start..start + mx - 1).filter(|&i| ends(i, i + 1)).count();
                    let across = if iy > 0 { (start..start + mx).filter(|&i| ends(i - mx, i)).count() } else { 0 };
                    outline.changes -= along + across;
                    outline.edges += along + across;
                }
            }
            (above, above_touches, above_holes) = (row, touches, row_holes);
        }
        outline
    }

    /// Mean length of the runs of `count` elements in contact, along rows and columns alike.
    pub fn chord(&self, count: usize) -> f64 {
        4.0 * count as f64 / (self.changes + self.edges).max(1) as f64
    }

    /// A*: the area of `count` elements in contact, corrected.
    pub fn corrected_area(&self, state: &State, count: usize) -> f64 {
        (count as f64 - SHARE * self.changes as f64).max(0.0) * state.grid.element_area()
    }
}

/// Elements in contact in one of two rows only. Counts in bytes, of which one instruction adds many.
fn differing(a: &[bool], b: &[bool]) -> usize {
    const BYTE: usize = u8::MAX as usize;
    let pairs = a.chunks(BYTE).zip(b.chunks(BYTE));
    pairs.map(|(a, b)| usize::from(a.iter().zip(b).map(|(a, b)| u8::from(a != b)).sum::<u8>())).sum()
}

#[cfg(test)]
#[path = "../../tests/unit/outline.rs"]
mod tests;
