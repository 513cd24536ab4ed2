//! The undeformed distance on a finer grid: cubics are reproduced, holes stay holes.

use contact_normal::grid::Grid;
use contact_normal::scene::refine;

const INF: f64 = f64::INFINITY;

/// `value(x, y)` at the centres; the corner of the grid is at (0, 0).
fn sampled(grid: &Grid, value: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let centre = |i: usize, d: f64| (i as f64 + 0.5) * d;
    (0..grid.len()).map(|i| value(centre(i % grid.mx, grid.dx), centre(i / grid.mx, grid.dy))).collect()
}

fn finer(grid: &Grid, parts: usize) -> Grid {
    let d = parts as f64;
    Grid::new(grid.mx * parts, grid.my * parts, grid.dx / d, grid.dy / d).expect("a grid")
}

/// Largest difference of the refined samples from the samples on the finer grid.
fn error(mx: usize, my: usize, parts: usize, value: impl Fn(f64, f64) -> f64 + Copy) -> f64 {
    let grid = Grid::new(mx, my, 1.0 / mx as f64, 0.7 / my as f64).expect("a grid");
    let refined = refine(&sampled(&grid, value), &grid, (parts, parts)).expect("memory");
    let exact = sampled(&finer(&grid, parts), value);
    refined.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

// Round-off: half an element outside the last centre the weights' moduli sum to 6 in each direction, values are of order 1:
// 36 times some units of 1.1e-16.
const ROUND_OFF: f64 = 2e-14;

#[test]
fn polynomials_up_to_the_number_of_centres_are_reproduced() {
    let cubic = |x: f64, y: f64| 1.0 - x + 2.0 * x * y * y - x.powi(3) * y + 0.5 * x.powi(3) * y.powi(3);
    for parts in [1, 2, 4, 8] {
        assert!(error(7, 5, parts, cubic) < ROUND_OFF, "{parts}");
        assert!(error(4, 4, parts, cubic) < ROUND_OFF, "{parts}");
        assert!(error(3, 9, parts, |x, y| x * x - x * y.powi(3)) < ROUND_OFF, "{parts}");
        assert!(error(2, 1, parts, |x, _| 3.0 - x) < ROUND_OFF, "{parts}");
    }
    assert!(error(7, 5, 4, |x, _| x.powi(4)) > 1e-5);
}

#[test]
fn parts_of_a_hole_are_holes_and_lines_go_on_beside_it() {
    let grid = Grid::new(6, 5, 1.0, 1.0).expect("a grid");
    let line = |x: f64, y: f64| 2.0 + 0.25 * x - 0.5 * y;
    let mut h = sampled(&grid, line);
    let holes = [grid.index(0, 0), grid.index(2, 2), grid.index(3, 2), grid.index(5, 4)];
    holes.iter().for_each(|&i| h[i] = INF);
    let refined = refine(&h, &grid, (4, 4)).expect("memory");
    let fine = finer(&grid, 4);
    for (i, (found, exact)) in refined.iter().zip(sampled(&fine, line)).enumerate() {
        let (ix, iy) = (i % fine.mx, i / fine.mx);
        if holes.contains(&grid.index(ix / 4, iy / 4)) {
            assert_eq!(*found, INF, "({ix}, {iy})");
        } else {
            assert!((found - exact).abs() < ROUND_OFF, "({ix}, {iy}): {found} for {exact}");
        }
    }
}

#[test]
fn an_element_alone_is_flat() {
    let grid = Grid::new(3, 3, 1.0, 1.0).expect("a grid");
    let mut h = vec![INF; 9];
    h[4] = 0.75;
    let refined = refine(&h, &grid, (2, 2)).expect("memory");
    assert_eq!(refined.iter().filter(|v| v.is_finite()).copied().collect::<Vec<f64>>(), [0.75; 4]);
}
