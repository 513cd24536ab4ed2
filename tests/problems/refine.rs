//! Interpolation of the undeformed distance to a finer grid: cubics are reproduced, and holes stay holes.

use contact_normal::grid::Grid;
use contact_normal::scene::refine;

const INF: f64 = f64::INFINITY;

/// `value(x, y)` at the centres of elements; the corner of the grid is at (0, 0).
fn sampled(grid: &Grid, value: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let centre = |i: usize, d: f64| (i as f64 + 0.5) * d;
    (0..grid.len()).map(|i| value(centre(i % grid.mx, grid.dx), centre(i / grid.mx, grid.dy))).collect()
}

fn finer(grid: &Grid, parts: usize) -> Grid {
    let d = parts as f64;
    Grid::new(grid.mx * parts, grid.my * parts, grid.dx / d, grid.dy / d).expect("a grid")
}

/// The largest difference between refined samples and samples on the finer grid.
fn error(mx: usize, my: usize, parts: usize, value: impl Fn(f64, f64) -> f64 + Copy) -> f64 {
    let grid = Grid::new(mx, my, 1.0 / mx as f64, 0.7 / my as f64).expect("a grid");
    let refined = refine(&sampled(&grid, value), &grid, (parts, parts), (false, false)).expect("memory");
    let exact = sampled(&finer(&grid, parts), value);
    refined.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

// Half an element outside the last centre the absolute values of the weights add up to 6 in each direction. Values are of order 1, so that the
// round-off is 36 times some units of 1.1e-16.
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

/// Where slopes of the surface jump, pressures are infinite. So the largest steps of the slopes, relative to those of a parabola, must fall with the
/// number of parts of an element.
#[test]
fn slopes_do_not_jump_between_the_elements() {
    let grid = Grid::new(12, 1, 1.0, 1.0).expect("a grid");
    let h: Vec<f64> = (0..12).map(|i| (0.754_877_666_246_69 * (i * i) as f64).fract()).collect();
    let largest = |parts: usize, period: bool| {
        let fine = refine(&h, &grid, (parts, 1), (period, false)).expect("memory");
        // A surface without a period keeps its height beyond the outermost centres.
        let inside = &fine[parts / 2..fine.len() - parts / 2];
        let bends = inside.windows(3).map(|h| (h[0] - 2.0 * h[1] + h[2]).abs());
        bends.fold(0.0, f64::max) * parts as f64
    };
    for period in [false, true] {
        let [coarse, fine] = [16, 64].map(|parts| largest(parts, period));
        assert!((fine / coarse - 0.25).abs() < 0.02, "{coarse} {fine}");
    }
}

#[test]
fn parts_of_a_hole_are_holes_and_lines_go_on_beside_it() {
    let grid = Grid::new(8, 7, 1.0, 1.0).expect("a grid");
    let line = |x: f64, y: f64| 2.0 + 0.25 * x - 0.5 * y;
    let mut h = sampled(&grid, line);
    let holes = [grid.index(0, 0), grid.index(3, 3), grid.index(4, 3), grid.index(7, 6)];
    holes.iter().for_each(|&i| h[i] = INF);
    let refined = refine(&h, &grid, (4, 4), (false, false)).expect("memory");
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
fn an_element_alone_is_flat_and_so_are_the_outer_halves_of_two() {
    let grid = Grid::new(4, 3, 1.0, 1.0).expect("a grid");
    let mut h = vec![INF; 12];
    let finite = |h: &[f64]| {
        let refined = refine(h, &grid, (2, 2), (false, false)).expect("memory");
        refined.into_iter().filter(|h| h.is_finite()).collect::<Vec<f64>>()
    };
    h[5] = 0.75;
    assert_eq!(finite(&h), [0.75; 4]);
    h[6] = 1.75;
    assert_eq!(finite(&h), [0.75, 1.0, 1.5, 1.75, 0.75, 1.0, 1.5, 1.75]);
}

/// The values of a grid, moved by (x, y) elements around the periods.
fn rolled(values: &[f64], grid: &Grid, (x, y): (usize, usize)) -> Vec<f64> {
    let of = |i: usize| values[grid.index((i % grid.mx + x) % grid.mx, (i / grid.mx + y) % grid.my)];
    (0..grid.len()).map(of).collect()
}

#[test]
fn one_period_is_refined_alike_wherever_it_begins() {
    for (mx, my) in [(9, 7), (5, 4), (3, 6), (2, 3), (1, 5)] {
        let grid = Grid::new(mx, my, 1.0, 1.0).expect("a grid");
        let mut h = sampled(&grid, |x, y| (3.1 * x + 5.7 * y * y).sin());
        for holes in [0, 1] {
            h.iter_mut().take(holes).for_each(|h| *h = INF);
            let refined = refine(&h, &grid, (4, 2), (true, true)).expect("memory");
            let fine = Grid::new(4 * mx, 2 * my, 0.25, 0.5).expect("a grid");
            for by in [(1, 0), (0, 1), (mx / 2, my / 2)] {
                let other = refine(&rolled(&h, &grid, by), &grid, (4, 2), (true, true)).expect("memory");
                assert_eq!(other, rolled(&refined, &fine, (4 * by.0, 2 * by.1)), "{mx} x {my}, {by:?}, {holes} holes");
            }
        }
    }
}

/// Beside a hole a linear extrapolation of rough heights would exceed their range by half a step. Such a point must not carry the load.
#[test]
fn rough_heights_beside_holes_stay_near_the_heights() {
    let grid = Grid::new(24, 20, 1.0, 1.0).expect("a grid");
    let random = |i: usize, factor: f64| (factor * (i * i) as f64).fract();
    let mut h: Vec<f64> = (0..grid.len()).map(|i| random(i, 0.754_877_666_246_69)).collect();
    for i in (0..grid.len()).filter(|i| random(i + 7, 0.569_840_290_998_05) < 0.15) {
        h[i] = INF;
    }
    let refined = refine(&h, &grid, (8, 8), (true, true)).expect("memory");
    let lowest = |of: &[f64]| of.iter().copied().fold(INF, f64::min);
    // Extrapolation by lines would reach -0.69. Four smooth heights are extrapolated, too, and cubics exceed the range of the heights between them:
    // -0.2 in all.
    assert!(lowest(&refined) > lowest(&h) - 0.35, "{} and {}", lowest(&refined), lowest(&h));
}

/// A plateau beside a step, and one with a pit of one element. Plain cubics would rise above the plateau by 7 % of the depth, and this lip would
/// carry the load.
#[test]
fn plateaus_beside_steps_and_pits_have_no_lips() {
    let grid = Grid::new(24, 16, 1.0, 1.0).expect("a grid");
    let is_deep = |x: usize, y: usize| x >= 14 || (x, y) == (6, 7);
    let h: Vec<f64> = (0..grid.len()).map(|i| if is_deep(i % 24, i / 24) { 1.0 } else { 0.0 }).collect();
    for repeats in [false, true] {
        let refined = refine(&h, &grid, (4, 4), (repeats, repeats)).expect("memory");
        let lowest = refined.iter().copied().fold(INF, f64::min);
        assert!(lowest >= -ROUND_OFF, "{repeats}: {lowest}");
    }
}

/// Half an element beyond the last centre a cubic extrapolation of rough heights is far outside their range, and would carry the load.
#[test]
fn the_ends_of_a_rough_surface_stay_near_its_heights() {
    let grid = Grid::new(16, 12, 1.0, 1.0).expect("a grid");
    // Heights from 0 to 1 without order: the fractional parts of multiples of an irrational number.
    let h: Vec<f64> = (0..grid.len()).map(|i| (0.754_877_666_246_69 * (i * i) as f64).fract()).collect();
    let refined = refine(&h, &grid, (8, 8), (false, false)).expect("memory");
    let fine = finer(&grid, 8);
    let at_end = |i: usize| {
        let (x, y) = (i % fine.mx, i / fine.mx);
        x < 4 || y < 4 || x + 4 >= fine.mx || y + 4 >= fine.my
    };
    let (inside, ends): (Vec<usize>, Vec<usize>) = (0..fine.len()).partition(|i| !at_end(*i));
    let lowest = |of: &[usize]| of.iter().map(|i| refined[*i]).fold(INF, f64::min);
    // If the last four heights are smooth, they are extrapolated by half of their last step, hence the 0.5. Cubic extrapolation would reach -2.3.
    assert!(lowest(&ends) > lowest(&inside) - 0.5, "{} and {}", lowest(&ends), lowest(&inside));
}
