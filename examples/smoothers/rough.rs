//! The self-affine rough surface of `data/rough`, on a half-space without periods with E* = 1, under a mean pressure of 0.007.

use std::f64::consts::PI;

use contact_normal::grid::Grid;
use contact_normal::operator::fft::{ColumnTransform, Complex};
use contact_normal::scene::{Bodies, Load, Scene};

/// The force on a square of side 1. About 10 % of it are in contact.
pub const FORCE: f64 = 0.007;

/// The grid of m x m elements on `[0, 1] x [0, 1]`.
pub fn grid(m: usize) -> Grid {
    Grid::new(m, m, 1.0 / m as f64, 1.0 / m as f64).expect("a valid grid")
}

/// The undeformed distance `h = max(z) - z` with `z(x, y) = sum over k of c_k exp(2 pi i (kx x + ky y))` at the element centres. m must be at least
/// 128, so that all waves (at most 64 per side) are resolved.
pub fn undeformed_distance(m: usize) -> Vec<f64> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/rough/self_affine.txt");
    let text = std::fs::read_to_string(path).expect("data/rough/self_affine.txt");
    let mut bins = vec![Complex::<f64>::default(); m * m];
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().expect("a number")).collect();
        let (ky, kx) = (numbers[0], numbers[1]);
        // The phase of a shift to the centre of the first element.
        let (sine, cosine) = (PI * (kx + ky) / m as f64).sin_cos();
        let c = Complex::new(numbers[2], numbers[3]) * Complex::new(cosine, sine);
        let bin = |k: f64| (k as i64).rem_euclid(m as i64) as usize;
        // The surface also has the complex conjugate of each listed wave. As only the real part is used, the listed wave is doubled instead.
        bins[bin(ky) * m + bin(kx)] += 2.0 * c;
    }
    let transform = ColumnTransform::<f64>::new(m).expect("memory for a plan");
    let mut scratch = transform.scratch().unwrap();
    transform.inverse(&mut bins, &mut scratch);
    let mut turned: Vec<_> = (0..m * m).map(|i| bins[(i % m) * m + i / m]).collect();
    transform.inverse(&mut turned, &mut scratch);
    let highest = turned.iter().fold(f64::NEG_INFINITY, |highest, z| highest.max(z.re));
    (0..m * m).map(|i| highest - turned[(i % m) * m + i / m].re).collect()
}

/// The scene with a prescribed force.
pub fn scene(m: usize, h: &[f64]) -> Scene<'_> {
    let bodies = Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0, 0.0] };
    Scene::new(grid(m), h, bodies, Load::Force(FORCE))
}
