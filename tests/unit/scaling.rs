use super::*;
use crate::grid::Grid;

#[test]
fn the_farthest_element_is_found_in_any_part_of_a_grid() {
    for (mx, my) in [(2, 2), (7, 3), (64, 1), (65, 9), (200, 160)] {
        let (grid, n) = (Grid::new(mx, my, 1.0, 1.0).unwrap(), mx * my);
        for far in [0, n / 2, n - 2] {
            // The farthest element is either in contact above the approach or exterior below it. Two other elements are nearer, and the rest has no
            // effect.
            for (h, inside, beyond) in [(9.0, true, 1e9), (-5.0, false, f64::INFINITY), (2.5, true, 1e9)] {
                let mut state = State::new(grid, (Load::Approach(2.0), 2.0), &Threads::One).unwrap();
                state.h.fill(beyond);
                (state.h[far], state.contact[far]) = (h, inside);
                for nearer in [far + 1, (far + n / 2) % n] {
                    (state.h[nearer], state.contact[nearer]) = (2.25, true);
                }
                for threads in [Threads::One, Threads::new(2).unwrap()] {
                    assert_eq!(farthest(&state, &threads), f64::abs(h - 2.0), "{mx} x {my}, element {far}");
                }
            }
        }
    }
}
