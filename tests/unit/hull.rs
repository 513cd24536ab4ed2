//! The convex hull of points, from which friction laws get their largest slope.

use super::*;

/// In each direction the farthest of random points is on the hull, and the hull has no other points.
#[test]
fn the_hull_has_the_farthest_in_each_direction() {
    let mut state = 7u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1u64 << 24) as f64
    };
    for n in [1, 2, 3, 10, 300] {
        let points: Vec<[f64; 2]> = (0..n).map(|_| [draw(), draw() - 0.5]).collect();
        let found = hull(points.clone());
        let far = |of: &[[f64; 2]], t: f64| of.iter().map(|p| t.cos() * p[0] + t.sin() * p[1]).fold(-1.0, f64::max);
        for k in 0..=1000 {
            let t = f64::from(k) / 1000.0 * std::f64::consts::FRAC_PI_2;
            assert!((far(&points, t) - far(&found, t)).abs() <= 1e-15, "{n} {t}");
        }
        assert!(found.len() <= 60, "{n} {}", found.len());
    }
    let line: Vec<[f64; 2]> = (0..1000).map(|k| [f64::from(k), -0.25 * f64::from(k)]).collect();
    assert_eq!(hull(line), [[999.0, -249.75], [0.0, 0.0]]);
}
