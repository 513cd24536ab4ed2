//! Surfaces that are hard for coarse grids, preconditioners or rounding.

use contact_normal::scene::Load;

use super::case::{distance, grid, paraboloid, Case, Random};

pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |name: &str, grid, h: Vec<f64>, loads: &[Load]| {
        cases.extend(loads.iter().map(|&load| Case::new(name, grid, h.clone(), load)));
    };
    let square = grid(64, 64, 0.1, 0.1);
    let checked = |i: usize| (i % 64 + i / 64) % 2 == 1;

    let board: Vec<f64> = (0..square.len()).map(|i| if checked(i) { 0.3 } else { 0.0 }).collect();
    // Under the first load only the high elements touch, under the second one all of them.
    add("checkerboard", square, board.clone(), &[Load::Approach(0.1), Load::Approach(2.0), Load::Force(0.5)]);
    let hollow: Vec<f64> =
        paraboloid(&square, 0.05).iter().zip(&board).map(|(h, step)| h + 1e-3 * step / 0.3).collect();
    add("checkerboard on a ball", square, hollow, &[Load::Approach(0.1), Load::Force(0.3)]);

    let mut random = Random(5);
    let noise: Vec<f64> = (0..square.len()).map(|_| random.next()).collect();
    add("random noise", square, noise.clone(), &[Load::Approach(0.5), Load::Force(0.3), Load::Approach(5.0)]);
    let wild: Vec<f64> = noise.iter().map(|r| 10f64.powf(24.0 * r - 12.0)).collect();
    add("noise over 24 decades", square, wild, &[Load::Approach(1e-6), Load::Approach(1e3), Load::Force(1e-3)]);

    let extreme: Vec<f64> = noise.iter().map(|r| 10f64.powf(400.0 * r - 200.0)).collect();
    add("noise over 400 decades", square, extreme, &[Load::Approach(1e-6), Load::Approach(1e100), Load::Force(1e-3)]);

    // 100 x 100 bumps of 4 x 4 elements, with different heights.
    let islands = grid(400, 400, 0.01, 0.01);
    let heights: Vec<f64> = (0..10_000).map(|_| 1e-3 * random.next()).collect();
    let h = (0..islands.len())
        .map(|i| {
            let (x, y) = (i % 400, i / 400);
            let (a, b) = ((x % 4) as f64 - 1.5, (y % 4) as f64 - 1.5);
            heights[y / 4 * 100 + x / 4] + 0.05 * (a * a + b * b)
        })
        .collect();
    add("10^4 islands", islands, h, &[Load::Approach(0.4)]);

    // Single high elements, 16 elements apart: on each coarser grid the means over 2 x 2 elements lose 3/4 of their height.
    let wide = grid(130, 120, 0.1, 0.1);
    let h = (0..wide.len()).map(|i| if (i % 130) % 16 == 7 && (i / 130) % 16 == 9 { 0.0 } else { 1.0 }).collect();
    add("islands that no coarse grid sees", wide, h, &[Load::Approach(0.2), Load::Force(0.2), Load::Approach(1.5)]);

    let mut needle = vec![0.0; wide.len()];
    needle[wide.index(71, 33)] = -1.0;
    add("a needle on a plain", wide, needle.clone(), &[Load::Approach(-0.5), Load::Approach(0.5), Load::Force(0.1)]);
    let ball = paraboloid(&wide, 0.01);
    let h = ball.iter().zip(&needle).map(|(ball, needle)| ball + 0.3 * needle).collect();
    add("a needle on a ball", wide, h, &[Load::Approach(0.2), Load::Force(1.0)]);

    let h = distance(&square, |x, _| if x < 0.7 { 0.0 } else { 0.2 });
    add("a step", square, h, &[Load::Approach(0.1), Load::Approach(0.6), Load::Force(1.0)]);

    let ripples = |x: f64, y: f64| 1e-9 * 6.4 * ((3.0 * x).sin() * (5.0 * y).cos() + 0.1 * x * x);
    add("nearly conformal", square, distance(&square, ripples), &[Load::Approach(4e-9), Load::Force(1e-8)]);

    let raised = |offset: f64| paraboloid(&square, 0.05).iter().map(|h| offset + h).collect::<Vec<f64>>();
    let variation = 0.05 * 2.0 * 3.2f64.powi(2);
    for offset in [1e6 * variation, -1e6 * variation] {
        let loads = [Load::Approach(offset + 0.1), Load::Force(0.3)];
        add("an offset of 1e6 times the variation", square, raised(offset), &loads);
    }
    cases
}

#[cfg(test)]
mod promises {
    use super::super::certificate::{assert_solved_or_told, run};
    use super::*;
    use contact_normal::solver::Method;

    #[test]
    fn surfaces_that_coarse_grids_see_badly() {
        assert_solved_or_told(&cases());
    }

    #[test]
    fn ten_thousand_islands_are_apart() {
        let case = cases().into_iter().find(|case| case.name == "10^4 islands").expect("the case");
        let found = run(&case, Method::Auto).expect("a solve");
        // An island is a block of 4 x 4 elements with contact in its middle and without contact at its corners.
        let touched = (0..10_000).filter(|&k| {
            let inside = |x: usize, y: usize| found.contact[(k / 100 * 4 + y) * 400 + k % 100 * 4 + x];
            let corner = inside(0, 0) || inside(3, 0) || inside(0, 3) || inside(3, 3);
            (inside(1, 1) || inside(2, 2)) && !corner
        });
        assert_eq!(touched.count(), 10_000);
    }
}
