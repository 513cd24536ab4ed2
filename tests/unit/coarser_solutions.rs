//! Unit tests of `methods/projected_cg/coarser_solutions.rs`.

use super::*;

#[test]
fn cubics_are_sampled_exactly_and_holes_stay_holes() {
    let fine = Grid::new(16, 24, 1.0, 1.0).unwrap();
    let coarse = Grid::new(4, 6, 4.0, 4.0).unwrap();
    let f = |x: f64, y: f64| 1.0 + x * x * x - 2.0 * x * y * y + 0.5 * y * y * y;
    let mut h: Vec<f64> = (0..fine.len()).map(|i| f((i % 16) as f64 + 0.5, (i / 16) as f64 + 0.5)).collect();
    let mut to = vec![0.0; coarse.len()];
    sample_distance(&fine, &coarse, &h, &mut to);
    for (i, value) in to.iter().enumerate() {
        let exact = f(4.0 * (i % 4) as f64 + 2.0, 4.0 * (i / 4) as f64 + 2.0);
        // values up to 1e4
        assert!((value - exact).abs() < 1e-10, "{value} {exact}");
    }
    for y in 0..24 {
        for x in 0..8 {
            h[y * 16 + x] = f64::INFINITY;
        }
    }
    sample_distance(&fine, &coarse, &h, &mut to);
    for (i, value) in to.iter().enumerate() {
        assert_eq!(value.is_infinite(), i % 4 < 2, "{i}: {value}");
    }
}
