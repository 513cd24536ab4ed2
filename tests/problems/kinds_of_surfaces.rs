//! Two hundred random surfaces that resemble measured ones: unchanged, with one high point, with fifteen high points, or worn to a plateau. A third
//! of them have holes, a fifth quantised heights, a seventh a tilt. AUTO solves them by force and by approach. The limits of iterations are those of
//! a prototype on forty such scenes.

use crate::measured_surfaces::{iterations, rough};
use crate::random::Random;

/// The number of elements along a side, for most surfaces and for the last ten.
const SIDES: [usize; 2] = [48, 150];
/// The iterations of the prototype, by force and by approach: medians of 16 and 16.5, and at most 21 and 23.
const MEDIAN: [u64; 2] = [16, 16];
const MOST: [u64; 2] = [21, 23];

/// The surface and the force for a seed.
fn surface(seed: u64, m: usize) -> (Vec<f64>, f64) {
    let random = &mut Random::new(1000 + seed);
    let mut h = rough(m, m, random.between(0.1, 0.9), seed);
    let slopes: f64 = (m..h.len()).map(|i| (h[i] - h[i - m]).powi(2)).sum();
    let slope = (2.0 * slopes / (m * m - m) as f64).sqrt();
    if seed % 5 == 4 {
        h.iter_mut().for_each(|h| *h = (8.0 * *h).round() / 8.0);
    }
    if seed % 7 == 3 {
        let tilt = random.between(0.0, 0.1) * slope;
        (0..h.len()).for_each(|i| h[i] += tilt * (i % m) as f64);
    }
    let mut force = random.decades(5e-3, 0.3) * slope * (m * m) as f64;
    let points = [0, 1, 15, 0][(seed % 4) as usize];
    if points > 0 {
        let depth = random.decades(30.0, if points == 1 { 3e4 } else { 1e3 });
        h.iter_mut().for_each(|h| *h += depth);
        force += if points == 1 { 2.0 } else { 15.0 } * depth;
        for _ in 0..points {
            let height = if points == 1 { 0.0 } else { random.between(0.0, depth) };
            h[random.integer(5, m - 6) * m + random.integer(5, m - 6)] = height;
        }
    } else if seed % 4 == 3 {
        let mut sorted = h.clone();
        sorted.sort_by(f64::total_cmp);
        let plateau = sorted[random.integer(m * m / 20, 2 * m * m / 5)];
        h.iter_mut().for_each(|h| *h = h.max(plateau));
    }
    if seed % 3 == 0 {
        h.iter_mut().filter(|_| random.between(0.0, 1.0) < 0.1).for_each(|h| *h = f64::INFINITY);
    }
    (h, force)
}

#[test]
fn two_hundred_seeds_take_the_iterations_of_smooth_surfaces() {
    let mut found = [Vec::new(), Vec::new()];
    for seed in 0..200 {
        let m = SIDES[usize::from(seed >= 190)];
        let (h, force) = surface(seed, m);
        let what = format!("seed {seed}");
        let counts = iterations(m, &h, force, &what);
        for (k, count) in counts.into_iter().enumerate() {
            assert!(count <= MOST[k], "{what}: {counts:?} iterations by force and by approach");
            found[k].push(count);
        }
    }
    for (k, found) in found.iter_mut().enumerate() {
        found.sort();
        println!("median {}, most {}", found[100], found[199]);
        assert!(found[100] <= MEDIAN[k], "{}", found[100]);
    }
}
