//! The window: the part of the grid on which the iteration works.
//!
//! The cost of a product is proportional to the area of the grid, and contact is often a small part of the potential contact area. So the iteration
//! works on the smallest rectangle around the contact area, with a margin. The loop then checks the full grid for penetration outside, and the next
//! window is larger if there is any.

use std::ops::Range;

use crate::contact::State;
use crate::grid::Grid;
use crate::operator::fft::good_length;
use crate::operator::length_for_stages;
use crate::rectangle::Rectangle;
use crate::threads::Threads;

/// The least margin of a new window on each side, in elements: one for elements that enter C, one for a contact area that moves. With two for the
/// latter, first calls on ellipse 64 and wheel-rail y4_82kN take 1.07 and 1.13 times as long. With none they take the same time.
const MARGIN: usize = 2;
/// The margin is larger by the length of the contact area over this number. With 32, first calls on ellipses of 512 to 2048 take 1.03 to 1.06 times
/// as long.
const MARGIN_DIVISOR: usize = 64;
/// If the window would be more than this part of the grid, the iteration works on the whole grid. With 0.6, steps in time on ellipse 64 and 256 and
/// on both wheel-rail contacts take 1.1 to 1.2 times as long, and first calls 1.0 to 1.35 times. With 0.95 they take the same time.
const LARGEST_WINDOW: f64 = 0.85;
/// A window is used again while the rectangle around the contact area fills more than this part of the window.
const LEAST_FILLED: f64 = 0.3;
/// Grids of fewer elements have no windows.
const SMALLEST_GRID: usize = 64 * 64;

/// Chooses the window for a state: the `current` one if it serves, otherwise the rectangle around the contact area with a margin, or the whole grid
/// if a window is not worthwhile. `even` tells whether the coefficients are even.
pub(super) fn around(state: &State, current: Option<&Rectangle>, even: bool, threads: &Threads) -> Rectangle {
    let grid = &state.grid;
    let full = Rectangle::full(grid);
    if grid.len() < SMALLEST_GRID {
        return full;
    }
    let Some(area) = area(state, threads) else { return full };
    if let Some(current) = current.filter(|current| serves(current, &area, grid)) {
        return current.clone();
    }
    let span = |range: &Range<usize>, m: usize| {
        let margin = MARGIN + range.len() / MARGIN_DIVISOR;
        let (start, end) = (range.start.saturating_sub(margin), (range.end + margin).min(m));
        // A product on k elements has the period 2k - 2 if the coefficients are even, otherwise 2k - 1. The window takes all k for which the length
        // of the transform is the same.
        let (less, length): (_, fn(usize) -> usize) = if even { (2, length_for_stages) } else { (1, good_length) };
        let length = ((length(2 * (end - start) - less) + less) / 2).min(m);
        let start = start.saturating_sub((length - (end - start)) / 2).min(m - length);
        start..start + length
    };
    let window = Rectangle { x: span(&area.x, grid.mx), y: span(&area.y, grid.my) };
    if window.count() as f64 <= LARGEST_WINDOW * grid.len() as f64 {
        window
    } else {
        full
    }
}

/// Whether a window still serves a contact area: the window has a margin for elements that enter C, and is not far too large.
fn serves(window: &Rectangle, area: &Rectangle, grid: &Grid) -> bool {
    let has_room = |outer: &Range<usize>, inner: &Range<usize>, m: usize| {
        (outer.start == 0 || outer.start < inner.start) && (outer.end == m || inner.end < outer.end)
    };
    let fills = area.count() as f64 > LEAST_FILLED * window.count() as f64;
    has_room(&window.x, &area.x, grid.mx) && has_room(&window.y, &area.y, grid.my) && fills
}

/// The smallest rectangle that contains the contact area and all elements at their limit; None if there are none.
fn area(state: &State, threads: &Threads) -> Option<Rectangle> {
    let any = |row: &[bool]| row.iter().fold(false, |any, inside| any | inside);
    let around = |elements: &[bool]| Rectangle::around_values(elements, &state.grid, threads, any);
    let free = around(&state.contact);
    let at_limit = if state.at_limit.is_empty() { None } else { around(&state.at_limit) };
    Rectangle::joined(free, at_limit)
}
