//! Random undeformed distances of many kinds.

use std::f64::consts::PI;

use crate::grid::Grid;
use crate::random::Random;

/// The centres of the elements, relative to the middle of the grid, in units of the grid's half width in each direction.
fn centres(mx: usize, my: usize) -> impl Iterator<Item = (f64, f64)> {
    let along = |i: usize, m: usize| (2 * i + 1) as f64 / m as f64 - 1.0;
    (0..mx * my).map(move |i| (along(i % mx, mx), along(i / mx, my)))
}

/// A random surface: its name, and undeformed distances of order 1.
pub fn any(random: &mut Random, grid: &Grid) -> (String, Vec<f64>) {
    let Grid { mx, my, .. } = *grid;
    // On fine grids mostly noise: coarser grids do not resolve its peaks.
    let kind = if mx * my > 3000 && random.chance(0.5) { 3 } else { random.integer(0, 8) };
    let (name, mut h) = match kind {
        0 | 1 => ("paraboloid", paraboloid(random, mx, my)),
        2 => ("self-affine", self_affine(random, mx, my)),
        3 | 4 => ("noise", (0..mx * my).map(|_| random.uniform()).collect()),
        5 => ("flat", vec![random.between(-1.0, 1.0); mx * my]),
        6 => ("checkerboard", (0..mx * my).map(|i| ((i % mx + i / mx) % 2) as f64).collect()),
        7 => ("wave", wave(random, mx, my)),
        _ => ("rough ball", rough_ball(random, mx, my)),
    };
    if random.chance(0.15) {
        make_holes(random, mx, my, &mut h);
    }
    (name.into(), h)
}

fn paraboloid(random: &mut Random, mx: usize, my: usize) -> Vec<f64> {
    let (a, b) = (random.decades(0.1, 4.0), random.decades(0.1, 4.0));
    let (x0, y0) = (random.between(-0.6, 0.6), random.between(-0.6, 0.6));
    centres(mx, my).map(|(x, y)| a * (x - x0).powi(2) + b * (y - y0).powi(2)).collect()
}

/// Cosines of random directions and phases, with amplitudes that fall as the wave number to -(1 + Hurst exponent).
fn self_affine(random: &mut Random, mx: usize, my: usize) -> Vec<f64> {
    let hurst = random.between(0.1, 1.0);
    let waves: Vec<_> = (0..40)
        .map(|_| {
            let (number, direction) = (random.decades(1.0, 0.5 * mx.max(my) as f64 + 1.0), random.between(0.0, 6.3));
            (number * direction.cos(), number * direction.sin(), random.between(0.0, 6.3), number.powf(-1.0 - hurst))
        })
        .collect();
    let at =
        |(x, y): (f64, f64)| waves.iter().map(|(qx, qy, phase, a)| a * (3.0 * (qx * x + qy * y) + phase).cos()).sum();
    centres(mx, my).map(at).collect()
}

fn wave(random: &mut Random, mx: usize, my: usize) -> Vec<f64> {
    let (i, j, amplitude) = (random.integer(0, 3) as f64, random.integer(0, 3) as f64, random.decades(0.1, 1.0));
    centres(mx, my).map(|(x, y)| amplitude * (PI * i * x).cos() * (PI * j * y).cos()).collect()
}

fn rough_ball(random: &mut Random, mx: usize, my: usize) -> Vec<f64> {
    let roughness = random.decades(1e-3, 1.0);
    centres(mx, my).map(|(x, y)| x * x + y * y + roughness * random.uniform()).collect()
}

/// Excludes elements (h infinite): scattered ones, the border, or all but one.
fn make_holes(random: &mut Random, mx: usize, my: usize, h: &mut [f64]) {
    let (kind, part, only) = (random.integer(0, 3), random.between(0.05, 0.9), random.integer(0, mx * my - 1));
    for (i, h) in h.iter_mut().enumerate() {
        let (ix, iy) = (i % mx, i / mx);
        let hole = match kind {
            0 | 1 => random.chance(part),
            2 => ix == 0 || iy == 0 || ix == mx - 1 || iy == my - 1,
            _ => i != only,
        };
        if hole && i != only {
            *h = f64::INFINITY;
        }
    }
}
