//! The window: the part of the grid of the iteration.
//!
//! The cost of a product is proportional to its area, and contact is often a small part of the potential contact area. So the iteration works on the
//! smallest rectangle around the contact area with a margin. Penetration outside is checked on the full grid afterwards, and the window grows if
//! there is any.

use std::ops::Range;

use crate::contact::State;
use crate::grid::Grid;
use crate::operator::fft::good_length;
use crate::operator::length_for_stages;
use crate::rectangle::Rectangle;
use crate::threads::Threads;

/// Least margin of a new window in elements: one for entering elements, one for an area that moves. With two for the
/// latter, cold calls on ellipse 64 and wheel-rail y4_82kN took 1.07 and 1.13 times as long. With none they took the
/// same time.
const MARGIN: usize = 2;
/// Additional margin on each side: the length of the area over this. With 32, cold calls on ellipses of 512 to 2048
/// took 1.03 to 1.06 times as long.
const MARGIN_DIVISOR: usize = 64;
/// Largest part of the grid for a window with its own operator. With 0.6, steps in time on ellipse 64 and 256 and on both wheel-rail
/// contacts took 1.1 to 1.2 times as long, and cold calls 1.0 to 1.35 times. With 0.95 they took the same time.
const LARGEST_WINDOW: f64 = 0.85;
/// A window stays while contact spans more than this part of it.
const LEAST_FILLED: f64 = 0.3;
/// Least elements of a grid with windows.
const SMALLEST_GRID: usize = 64 * 64;

/// The window for a contact area, with a margin; the whole grid if a window is not worthwhile. `even`: whether the kernel is even.
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
        // The period is 2k - 2 for k elements of an even kernel, else 2k - 1: the window fills it.
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

/// Whether a window still serves a contact area: it has a margin for entering elements, and is not far too large.
fn serves(window: &Rectangle, area: &Rectangle, grid: &Grid) -> bool {
    let has_room = |outer: &Range<usize>, inner: &Range<usize>, m: usize| {
        (outer.start == 0 || outer.start < inner.start) && (outer.end == m || inner.end < outer.end)
    };
    let fills = area.count() as f64 > LEAST_FILLED * window.count() as f64;
    has_room(&window.x, &area.x, grid.mx) && has_room(&window.y, &area.y, grid.my) && fills
}

/// The smallest rectangle with the contact area and all elements at their limit; none if both are empty.
fn area(state: &State, threads: &Threads) -> Option<Rectangle> {
    let any = |row: &[bool]| row.iter().fold(false, |any, inside| any | inside);
    let around = |elements: &[bool]| Rectangle::around_values(elements, &state.grid, threads, any);
    let free = around(&state.contact);
    let at_limit = if state.at_limit.is_empty() { None } else { around(&state.at_limit) };
    Rectangle::joined(free, at_limit)
}
