use super::*;
use crate::grid::Grid;

#[test]
fn the_farthest_element_is_found_in_any_part_of_a_grid() {
    for (mx, my) in [(1, 1), (7, 3), (64, 1), (65, 9), (200, 160)] {
        let (grid, n) = (Grid::new(mx, my, 1.0, 1.0).unwrap(), mx * my);
        for far in [0, n / 2, n - 1] {
            // In contact above the approach, or below it; the others are beyond reach.
            for (h, inside) in [(9.0, true), (-5.0, false), (2.5, true)] {
                let mut state = State::new(grid, vec![1e9; n], Load::Approach(2.0), 2.0).unwrap();
                (state.h[far], state.contact[far]) = (h, inside);
                for threads in [Threads::One, Threads::new(2).unwrap()] {
                    assert_eq!(farthest(&state, &threads), f64::abs(h - 2.0), "{mx} x {my}, element {far}");
                }
            }
        }
    }
}
