//! The window: the part of the grid that the iteration works on.
//!
//! Products cost by the area they cover, and contact is often a small part of the potential contact area. So the iteration works on
//! the bounding box of the contact area and a margin around it; that nothing outside it penetrates is checked on the full grid
//! afterwards, and the window grows where something does.

use std::ops::Range;

use crate::bounding_box::{bounding_box, joined};
use crate::contact::State;
use crate::grid::Grid;
use crate::operator::fft::good_length;
use crate::operator::length_for_stages;
use crate::threads::Threads;

/// Elements around the contact area, at least, in a new window: one for what may enter, one for an area that still moves (with two of these cold
/// calls on ellipse 64 and wheel-rail y4_82kN took 1.07 and 1.13 times as long, with none the same). And the part of its length that comes to
/// them on each side: with 1/32 cold calls on ellipses of 512 to 2048 took 1.03 to 1.06 times as long.
const MARGIN: usize = 2;
const PART: usize = 64;
/// A window of more than this part of the grid is not worth its own operator. With 0.6 steps in time on ellipse 64 and 256 and on both wheel-rail
/// contacts took 1.1 to 1.2 times as long, cold calls 1.0 to 1.35; with 0.95 as long.
const WORTHWHILE: f64 = 0.85;
/// Windows are not worth it on grids of fewer elements.
const SMALLEST_GRID: usize = 64 * 64;

/// A rectangle of elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    /// Columns.
    pub x: Range<usize>,
    /// Rows.
    pub y: Range<usize>,
}

impl Window {
    /// The whole grid.
    pub fn full(grid: &Grid) -> Window {
        Window { x: 0..grid.mx, y: 0..grid.my }
    }

    /// Whether this is the whole grid.
    pub fn is_full(&self, grid: &Grid) -> bool {
        self.x.len() == grid.mx && self.y.len() == grid.my
    }

    /// The window for a contact area, with a margin of a part of its size; the whole grid where a window is not worthwhile. `even`: whether the
    /// kernel is.
    pub fn around(state: &State, current: Option<&Window>, even: bool, threads: &Threads) -> Window {
        let grid = &state.grid;
        let full = Window::full(grid);
        if grid.len() < SMALLEST_GRID {
            return full;
        }
        let Some(area) = area(state, threads) else { return full };
        if let Some(current) = current.filter(|current| current.holds(&area, grid)) {
            return current.clone();
        }
        let span = |range: &Range<usize>, m: usize| {
            let margin = MARGIN + range.len() / PART;
            let (start, end) = (range.start.saturating_sub(margin), (range.end + margin).min(m));
            // An even kernel of k elements has the period 2k - 2, another one 2k - 1: fill it.
            let (less, length): (_, fn(usize) -> usize) = if even { (2, length_for_stages) } else { (1, good_length) };
            let length = ((length(2 * (end - start) - less) + less) / 2).min(m);
            let start = start.saturating_sub((length - (end - start)) / 2).min(m - length);
            start..start + length
        };
        let window = Window { x: span(&area.x, grid.mx), y: span(&area.y, grid.my) };
        let part = window.x.len() as f64 * window.y.len() as f64 / grid.len() as f64;
        if part <= WORTHWHILE {
            window
        } else {
            full
        }
    }

    /// Whether this window still serves a contact area: there is room for what may enter, and it is not far too large.
    fn holds(&self, area: &Window, grid: &Grid) -> bool {
        let has_room = |outer: &Range<usize>, inner: &Range<usize>, m: usize| {
            (outer.start == 0 || outer.start < inner.start) && (outer.end == m || inner.end < outer.end)
        };
        let part = area.x.len() as f64 * area.y.len() as f64 / (self.x.len() as f64 * self.y.len() as f64);
        has_room(&self.x, &area.x, grid.mx) && has_room(&self.y, &area.y, grid.my) && part > 0.3
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.x.len() * self.y.len()
    }

    /// The grid of the window.
    pub fn grid(&self, grid: &Grid) -> Grid {
        Grid { mx: self.x.len(), my: self.y.len(), ..*grid }
    }

    /// Copies the window's part of `from`, on `grid`, to `to`.
    pub fn extract<A: Copy + Send + Sync>(&self, grid: &Grid, from: &[A], to: &mut [A], threads: &Threads) {
        let (x, first) = (&self.x, self.y.start);
        threads.for_a_pass(to.len()).for_each_plain_row(to, x.len(), |y, row| {
            row.copy_from_slice(&from[(first + y) * grid.mx..][x.clone()]);
        });
    }

    /// Copies `from`, on the window, to its part of `to`; `to` becomes `outside` elsewhere.
    pub fn insert<A: Copy + Send + Sync>(&self, grid: &Grid, from: &[A], to: &mut [A], outside: A, threads: &Threads) {
        let Window { x, y: rows } = self;
        threads.for_a_pass(to.len()).for_each_plain_row(to, grid.mx, |y, row| {
            if !rows.contains(&y) {
                return row.fill(outside);
            }
            row[..x.start].fill(outside);
            row[x.clone()].copy_from_slice(&from[(y - rows.start) * x.len()..][..x.len()]);
            row[x.end..].fill(outside);
        });
    }
}

/// The smallest window that holds the contact area, and what is at its limit; none when it is empty.
fn area(state: &State, threads: &Threads) -> Option<Window> {
    let any = |row: &[bool]| row.iter().fold(false, |any, inside| any | inside);
    let box_of = |elements: &[bool]| bounding_box(elements, &state.grid, threads, any, |inside| *inside);
    let free = box_of(&state.contact);
    let at_limit = if state.at_limit.is_empty() { None } else { box_of(&state.at_limit) };
    joined(free, at_limit).map(|(x, y)| Window { x, y })
}
