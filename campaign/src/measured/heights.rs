//! Random surfaces without faults: undeformed distances of size about 1.

use std::f64::consts::PI;

use crate::fft::synthesis;
use crate::grid::Grid;
use crate::random::Random;

/// A random surface: its name, and undeformed distances.
pub fn any(random: &mut Random, grid: &Grid) -> (String, Vec<f64>) {
    let (name, h) = match random.integer(0, 15) {
        0..=4 => ("self-affine", self_affine(random, grid)),
        5 => ("noise", noise(random, grid)),
        6 | 7 => ("short waves", waves(random, grid)),
        8 | 9 => ("punch", punch(random, grid)),
        10 => ("profile", profile(random, grid)),
        11 => ("grating", grating(random, grid)),
        12 => ("pattern", pattern(random, grid)),
        13 => ("flat", vec![0.0; grid.len()]),
        14 => ("islands", islands(random, grid)),
        _ => ("rough ball", rough_ball(random, grid)),
    };
    (name.into(), h)
}

/// The centres of the elements, relative to the middle of the grid, in units of the grid's half width in each direction.
fn centres(grid: &Grid) -> impl Iterator<Item = [f64; 2]> {
    let Grid { mx, my, .. } = *grid;
    let along = |i: usize, m: usize| (2 * i + 1) as f64 / m as f64 - 1.0;
    (0..mx * my).map(move |i| [along(i % mx, mx), along(i / mx, my)])
}

/// A self-affine surface of waves with random phases. The amplitudes are proportional to the wave number to the power `-(1 + Hurst exponent)`, or
/// `-(1/2 + Hurst exponent)` for a line. They are constant below the roll-off wave number, and 0 above that of the shortest wave. Distances are measured down
/// from the highest point, and their rms about the mean is 1. The surface is periodic if the numbers of elements are powers of two.
pub fn self_affine(random: &mut Random, grid: &Grid) -> Vec<f64> {
    let Grid { mx, my, .. } = *grid;
    let (nx, ny) = (mx.next_power_of_two(), my.next_power_of_two());
    let exponent = if my == 1 || mx == 1 { 0.5 } else { 1.0 } + random.between(0.1, 1.0);
    let longest = random.decades(1.0, 8.0) / nx.max(ny) as f64;
    let shortest = random.pick(&[0.5, 0.5, 0.25, 0.1]);
    let phases: Vec<f64> = (0..nx * ny).map(|_| random.between(0.0, 2.0 * PI)).collect();
    let number = |i: usize, n: usize| i.min(n - i) as f64 / n as f64;
    let z = synthesis(nx, ny, |ix, iy| {
        let q = number(ix, nx).hypot(number(iy, ny));
        let amplitude = if q == 0.0 || q > shortest { 0.0 } else { f64::max(q, longest).powf(-exponent) };
        (amplitude, phases[iy * nx + ix])
    });
    let (x0, y0) = (random.integer(0, nx - mx), random.integer(0, ny - my));
    from_the_top((0..mx * my).map(|i| z[(y0 + i / mx) * nx + x0 + i % mx]).collect())
}

/// Distances of heights z from the highest one, in units of the rms about the mean.
fn from_the_top(z: Vec<f64>) -> Vec<f64> {
    let n = z.len() as f64;
    let (top, mean) = (z.iter().copied().fold(f64::NEG_INFINITY, f64::max), z.iter().sum::<f64>() / n);
    let rms = (z.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / n).sqrt();
    let size = if rms > 0.0 { rms } else { 1.0 };
    z.into_iter().map(|z| (top - z) / size).collect()
}

/// White noise: uniformly distributed, or with a long tail to one side.
fn noise(random: &mut Random, grid: &Grid) -> Vec<f64> {
    let power = random.pick(&[1.0, 1.0, 0.1, 8.0]);
    (0..grid.len()).map(|_| random.uniform().powf(power)).collect()
}

/// Waves with wave lengths of two to ten elements, in one direction or in two, and a long wave.
fn waves(random: &mut Random, grid: &Grid) -> Vec<f64> {
    let number = |random: &mut Random| match random.uniform() {
        u if u < 0.3 => random.pick(&[PI, 0.5 * PI, PI / 3.0, 2.0 * PI / 3.0]),
        u if u < 0.4 => 0.0,
        _ => 2.0 * PI / random.between(2.0, 10.0),
    };
    let (qx, qy, phase) = (number(random), number(random), random.between(0.0, 2.0 * PI));
    let long = 2.0 * PI / (grid.mx.max(grid.my) as f64) * random.integer(0, 3) as f64;
    let swell = random.between(0.0, 2.0);
    let at = |i: usize| {
        let (x, y) = ((i % grid.mx) as f64, (i / grid.mx) as f64);
        2.0 - (qx * x + phase).cos() * (qy * y).cos() - swell * (long * (x + y)).cos()
    };
    (0..grid.len()).map(at).collect()
}

/// A punch: flat, curved or inclined within an outline, which may cut elements. Outside the outline there is a step or a slope, or elements are
/// excluded.
fn punch(random: &mut Random, grid: &Grid) -> Vec<f64> {
    let (a, b) = (random.between(0.05, 1.0), random.between(0.05, 1.0));
    let (x0, y0) = (random.between(-0.4, 0.4), random.between(-0.4, 0.4));
    let (kind, outside, step) = (random.integer(0, 3), random.integer(0, 2), random.decades(1e-3, 10.0));
    let (curved, leaning) = (random.pick(&[0.0, 0.0, 0.1]), random.pick(&[0.0, 0.0, 0.1]));
    let inner = random.between(0.1, 0.9);
    let at = |[x, y]: [f64; 2]| {
        let (u, v) = ((x - x0) / a, (y - y0) / b);
        let beyond = match kind {
            0 => u.hypot(v),
            1 => u.abs().max(v.abs()),
            2 => u.abs() + v.abs(),
            _ if u.hypot(v) < inner => 1.0 + inner - u.hypot(v),
            _ => u.hypot(v),
        };
        let inside = curved * (u * u + v * v) + leaning * u;
        match outside {
            _ if beyond <= 1.0 => inside,
            0 => inside + step,
            1 => inside + step * (beyond - 1.0),
            _ => f64::INFINITY,
        }
    };
    centres(grid).map(at).collect()
}

/// A profile of several arcs in y, like that of a wheel on a rail, and one arc in x.
fn profile(random: &mut Random, grid: &Grid) -> Vec<f64> {
    let (along, corners) = (random.decades(1e-3, 1.0), random.integer(1, 6));
    let places: Vec<[f64; 2]> = (0..corners).map(|_| [random.between(-1.0, 1.0), random.decades(0.01, 10.0)]).collect();
    let lean = random.between(-0.3, 0.3);
    let at = |[x, y]: [f64; 2]| {
        let bends: f64 = places.iter().map(|[from, bend]| bend * f64::max(y - from, 0.0).powi(2)).sum();
        along * x * x + 0.1 * y * y + bends + lean * y
    };
    centres(grid).map(at).collect()
}

/// Ridges with gaps between them. The gaps are deep, or their elements are excluded. Some asperities are higher than the ridges.
fn grating(random: &mut Random, grid: &Grid) -> Vec<f64> {
    let (period, by_rows) = (random.integer(2, 5), random.chance(0.5));
    let (gap, rise) = (random.pick(&[1.0, 0.01, f64::INFINITY]), random.decades(1e-3, 1e2));
    let asperities: Vec<usize> = (0..random.integer(0, 8)).map(|_| random.integer(0, grid.len() - 1)).collect();
    let at = |i: usize| {
        let line = if by_rows { i / grid.mx } else { i % grid.mx };
        match asperities.contains(&i) {
            true => 0.0,
            false if line % period == 0 => rise,
            false => rise + gap,
        }
    };
    (0..grid.len()).map(at).collect()
}

/// A periodic pattern of a few heights.
fn pattern(random: &mut Random, grid: &Grid) -> Vec<f64> {
    let (a, b, k) = (random.integer(0, 4), random.integer(1, 4), random.integer(2, 7));
    (0..grid.len()).map(|i| ((a * (i % grid.mx) + b * (i / grid.mx)) % k) as f64).collect()
}

/// The tops of a rough surface. All other elements are excluded.
fn islands(random: &mut Random, grid: &Grid) -> Vec<f64> {
    let h = self_affine(random, grid);
    let mut sorted = h.clone();
    sorted.sort_by(f64::total_cmp);
    let level = sorted[(random.between(0.02, 0.9) * (h.len() - 1) as f64) as usize];
    let flat = random.chance(0.3);
    let top = |h: f64| if flat { 0.0 } else { h };
    h.into_iter().map(|h| if h <= level { top(h) } else { f64::INFINITY }).collect()
}

/// A paraboloid with a self-affine roughness.
fn rough_ball(random: &mut Random, grid: &Grid) -> Vec<f64> {
    let (roughness, rough) = (random.decades(1e-4, 1.0), self_affine(random, grid));
    let (a, b) = (random.decades(0.3, 3.0), random.decades(0.3, 3.0));
    centres(grid).zip(rough).map(|([x, y], rough)| 5.0 * (a * x * x + b * y * y) + roughness * rough).collect()
}
