//! Grids of odd shapes and elements far from square.

use contact_normal::scene::Load;

use super::case::{distance, grid, Case};

pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let shapes = [
        ("elements 1:1000", 48, 40, 1e-3, 1.0),
        ("elements 1000:1", 40, 48, 1.0, 1e-3),
        ("elements 1:1000, square outline", 8, 2000, 1.0, 0.004),
        ("3 x 5000", 3, 5000, 0.1, 0.1),
        ("4099 x 7", 4099, 7, 0.1, 0.1),
        ("primes 97 x 89", 97, 89, 0.1, 0.13),
        ("primes 211 x 2", 211, 2, 0.1, 0.1),
        ("1 x 1", 1, 1, 0.1, 0.2),
        ("2 x 1", 2, 1, 0.1, 0.2),
    ];
    for (name, mx, my, dx, dy) in shapes {
        let grid = grid(mx, my, dx, dy);
        // An ellipsoid with the height 1 at the middle of the sides; the approach is a third of it.
        let (a, b) = (0.5 * mx as f64 * dx, 0.5 * my as f64 * dy);
        let h = distance(&grid, |x, y| (x / a).powi(2) + (y / b).powi(2));
        // A force that has about the same contact area: E* sqrt(area) * depth.
        let force = 0.3 * (a * b).sqrt() * 0.3;
        for load in [Load::Approach(0.3), Load::Force(force)] {
            cases.push(Case::new(name, grid, h.clone(), load));
        }
    }
    cases
}

#[cfg(test)]
mod promises {
    use super::super::certificate::{assert_solved_or_told, assert_sound, run};
    use super::*;
    use contact_normal::solver::Method;

    #[test]
    fn grids_of_odd_shapes() {
        assert_solved_or_told(&cases());
    }

    #[test]
    fn elements_of_any_aspect_end_with_a_result_or_a_status() {
        for ratio in [1e-300, 1e-30, 1e-9, 1e9, 1e30, 1e300] {
            let grid = grid(7, 5, ratio, 1.0);
            let case = Case::new("a needle of an element", grid, vec![0.0; grid.len()], Load::Approach(1.0));
            if let Ok(found) = run(&case, Method::Auto) {
                assert_sound(&case, "AUTO", &found);
            }
        }
    }
}
