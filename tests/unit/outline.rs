//! Unit tests of `contact/outline.rs`: the outline of the contact area, in edges and changes along rows and columns.

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
    // A run is a sequence of elements in contact. There are two runs along rows and two along columns, with 2 and 1 elements.
    assert_eq!(outline.chord(3, (false, false)), 1.5);
    assert_eq!(outline.corrected_area(&state, 3), (3.0 - 2.0 * EXCESS_PER_CHANGE) * 2.0);
}

/// A circle of radius r is crossed twice by each of 2 r rows and 2 r columns, so that the number of changes is M = 8 r.
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
        // On each side the first row or column may miss the circle.
        assert!((outline.changes as f64 - 8.0 * r).abs() <= 8.0, "{} of {}", outline.changes, 8.0 * r);
        assert_eq!(outline.edges, 0);
        // The error of M is at most 8 of 400, and that of chords is as large.
        let count = state.contact_count();
        assert!(
            (outline.scatter(count, (false, false)) - 1.0).abs() <= 0.02,
            "{}",
            outline.scatter(count, (false, false))
        );
        // Four such circles have twice the scatter relative to that of one.
        let four = Outline { changes: 4 * outline.changes, ..outline };
        assert!(
            (four.scatter(4 * count, (false, false)) - 2.0).abs() <= 0.04,
            "{}",
            four.scatter(4 * count, (false, false))
        );
    }
}

/// Small random contact areas with holes. The sides at holes are counted as by definition, and at most that many count as straight.
#[test]
fn sides_at_holes_are_those_of_pairs_of_neighbours() {
    let mut bits = 0x9E37_79B9_7F4A_7C15_u64;
    let mut draw = |of: u64| {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (bits >> 33) % of
    };
    for (mx, my) in [(3, 2), (2, 3), (1, 9), (9, 1), (12, 10), (3, 16)] {
        let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
        for _ in 0..200 {
            let mut state = State::new(grid, (Load::Approach(0.0), 0.0), &Threads::One).unwrap();
            // Rows often equal the row above, so that there are straight sides.
            for i in 0..mx * my {
                state.h[i] = if draw(4) == 0 { f64::INFINITY } else { 0.0 };
                let as_above = i >= mx && draw(8) != 0;
                state.contact[i] = state.h[i] == 0.0 && if as_above { state.contact[i - mx] } else { draw(2) == 0 };
            }
            let (mut changes, mut edges) = (0, 0);
            for i in 0..mx * my {
                let right = (i % mx + 1 < mx).then_some(i + 1);
                let below = (i + mx < mx * my).then_some(i + mx);
                for j in [right, below].into_iter().flatten().filter(|&j| state.contact[i] != state.contact[j]) {
                    match state.h[i].max(state.h[j]).is_infinite() {
                        true => edges += 1,
                        false => changes += 1,
                    }
                }
            }
            let outline = Outline::of(&state);
            assert_eq!((outline.changes, outline.edges), (changes, edges), "{mx} x {my}");
            let straight = outline.straight.0 + outline.straight.1;
            assert!(straight <= changes && outline.straight_edges <= edges, "{mx} x {my}: {outline:?}");
        }
    }
}
