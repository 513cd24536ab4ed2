//! The decay factors of waves in SIMD lanes, compared with the standard library's exp.

use super::{exp_of_minus, Fading, Lanes, LANES, NODES};

/// The standard library's `exp` is within one unit of the last place. The lanes add the round-off of the series, of its power and of the remainder.
#[test]
fn exp_of_minus_is_exp() {
    for step in 0..7000 {
        let x: Lanes = std::array::from_fn(|i| 0.1 * step as f64 + 0.0123 * i as f64);
        for (found, x) in exp_of_minus(&x).into_iter().zip(x.iter().filter(|x| **x < 700.0)) {
            let exact = (-x).exp();
            assert!((found - exact).abs() <= 3.0 * f64::EPSILON * exact, "{x}: {found} for {exact}");
        }
    }
    assert_eq!(exp_of_minus(&[0.0; LANES]), [1.0; LANES]);
}

/// The library leaves out nodes with negligible factors. The reference sums all nodes, one by one. Weights are up to 252.
#[test]
fn waves_near_the_surface_fade_as_at_the_nodes() {
    for z in [0.0, 1e-12, 0.3, 0.99] {
        let fading = Fading::new(z);
        let Fading::Near(weights) = &fading else { panic!("{z} is near") };
        assert!((weights.iter().sum::<f64>() - 1.0).abs() <= 1e-12, "{weights:?}");
        for least in [0.0, 0.1, 1.0, 4.2, 10.0, 21.4, 36.9] {
            let k: Lanes = std::array::from_fn(|i| least + 0.09 * i as f64);
            let (e, ze) = fading.of(&k, least);
            for i in 0..LANES {
                let part = |j: usize| weights[j] * (-k[i] * (j + 1) as f64).exp();
                let exact: f64 = (0..NODES).map(part).sum();
                let of_depths: f64 = (0..NODES).map(|j| (j + 1) as f64 * part(j)).sum();
                // 1e-13 is the round-off of terms of up to 252 and of the omitted terms, which are 1e-16. The sum of depths has terms ten times as
                // large.
                assert!((e[i] - exact).abs() <= 1e-13 && (ze[i] - of_depths).abs() <= 1e-12, "z {z}, k {}", k[i]);
            }
        }
    }
}
