//! Unit tests of `contact/outline.rs`.

use super::*;
use crate::grid::Grid;
use crate::scene::Load;
use crate::threads::Threads;

#[test]
fn changes_and_edges_of_a_corner() {
    // ##.
    // #x.    x: no surface
    // ...
    let grid = Grid::new(3, 3, 1.0, 2.0).unwrap();
    let mut h = vec![0.0; 9];
    h[4] = f64::INFINITY;
    let mut state = State::new(grid, (Load::Approach(0.0), 0.0), &Threads::One).unwrap();
    state.h = h;
    for i in [0, 1, 3] {
        state.contact[i] = true;
    }
    let outline = Outline::of(&state);
    assert_eq!((outline.changes, outline.edges, outline.border, outline.rows), (2, 2, (2, 2), 2));
    // Two runs along rows, two along columns: of 2 and 1 elements.
    assert_eq!(outline.chord(3), 1.5);
    assert_eq!(outline.corrected_area(&state, 3), (3.0 - 2.0 * SHARE) * 2.0);
}

/// A circle of radius r is crossed twice by each of 2 r rows and 2 r columns: M = 8 r.
#[test]
fn a_circle_has_eight_changes_a_radius() {
    let grid = Grid::new(140, 140, 1.0, 1.0).unwrap();
    let mut state = State::new(grid, (Load::Approach(0.0), 0.0), &Threads::One).unwrap();
    state.h.fill(0.0);
    for step in 0..40 {
        let r = 50.0 + 0.25 * step as f64;
        for i in 0..140 * 140 {
            let (x, y) = ((i % 140) as f64 - 69.5, (i / 140) as f64 - 69.5);
            state.contact[i] = x.hypot(y) <= r;
        }
        let outline = Outline::of(&state);
        // The first and last row or column may be missed on either side.
        assert!((outline.changes as f64 - 8.0 * r).abs() <= 8.0, "{} of {}", outline.changes, 8.0 * r);
        assert_eq!(outline.edges, 0);
    }
}
