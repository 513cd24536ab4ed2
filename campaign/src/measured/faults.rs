//! Faults that a measured map of heights has because of the instrument, of wear, or of the mounting.

use crate::grid::Grid;
use crate::random::Random;

/// Adds up to three faults to h, and returns their names. At least one element is not excluded.
pub fn any(random: &mut Random, grid: &Grid, h: &mut [f64]) -> Vec<&'static str> {
    let mut names = Vec::new();
    let count = random.pick(&[0, 0, 1, 1, 1, 2, 2, 3]);
    for _ in 0..count {
        names.push(match random.integer(0, 11) {
            0 => tilt(random, grid, h),
            1 => quantise(random, h),
            2 => plateau(random, h),
            3..=5 => spikes(random, h),
            6 => pits(random, h),
            7 => step(random, grid, h),
            8 => stripes(random, grid, h),
            9 | 10 => holes(random, grid, h),
            _ => offset(random, h),
        });
    }
    if h.iter().all(|h| h.is_infinite()) {
        h[grid.len() / 2] = 0.0;
    }
    names
}

/// The finite values of h, sorted.
pub fn sorted(h: &[f64]) -> Vec<f64> {
    let mut finite: Vec<f64> = h.iter().copied().filter(|h| h.is_finite()).collect();
    finite.sort_by(f64::total_cmp);
    finite
}

/// The rms of the finite values of h about their mean, or 1 if it is 0.
fn rms(h: &[f64]) -> f64 {
    let finite = || h.iter().filter(|h| h.is_finite());
    let n = finite().count().max(1) as f64;
    let mean = finite().sum::<f64>() / n;
    let rms = (finite().map(|h| (h - mean).powi(2)).sum::<f64>() / n).sqrt();
    if rms > 0.0 {
        rms
    } else {
        1.0
    }
}

/// Adds a plane: the surface was mounted at an angle.
fn tilt(random: &mut Random, grid: &Grid, h: &mut [f64]) -> &'static str {
    let size = rms(h) * random.decades(0.1, 1e3);
    let slopes = [random.between(-size, size) / grid.mx as f64, random.between(-size, size) / grid.my as f64];
    let along = |i: usize| slopes[0] * (i % grid.mx) as f64 + slopes[1] * (i / grid.mx) as f64;
    h.iter_mut().enumerate().for_each(|(i, h)| *h += along(i));
    "tilt"
}

/// Rounds heights to multiples of a quantum, like a converter with few bits.
fn quantise(random: &mut Random, h: &mut [f64]) -> &'static str {
    let quantum = rms(h) * random.decades(1e-3, 1.0);
    h.iter_mut().for_each(|h| *h = (*h / quantum).round() * quantum);
    "quantised"
}

/// Cuts off the tops, which are worn, or the valleys, which are beyond the range of the instrument.
fn plateau(random: &mut Random, h: &mut [f64]) -> &'static str {
    let finite = sorted(h);
    let Some(last) = finite.len().checked_sub(1) else { return "plateau" };
    let level = finite[(random.between(0.01, 0.6) * last as f64) as usize];
    let tops = random.chance(0.7);
    h.iter_mut().filter(|h| h.is_finite()).for_each(|h| *h = if tops { h.max(level) } else { h.min(level) });
    if tops {
        "plateau"
    } else {
        "cut valleys"
    }
}

/// Adds points above all others: dust, or errors of an interferometer on a slope.
fn spikes(random: &mut Random, h: &mut [f64]) -> &'static str {
    let (count, height) = (points(random, h.len()), rms(h) * random.decades(1.0, 1e4));
    let alike = random.chance(0.3);
    let finite = sorted(h);
    let top = finite.first().copied().unwrap_or(0.0);
    for _ in 0..count {
        let at = random.integer(0, h.len() - 1);
        h[at] = top - height * if alike { 1.0 } else { random.uniform() };
    }
    "spikes"
}

/// Lowers points.
fn pits(random: &mut Random, h: &mut [f64]) -> &'static str {
    let (count, depth) = (points(random, h.len()), rms(h) * random.decades(1.0, 1e4));
    for _ in 0..count {
        let at = random.integer(0, h.len() - 1);
        h[at] += depth * random.uniform();
    }
    "pits"
}

/// A random number of points out of n: one, some, or up to a tenth of all.
fn points(random: &mut Random, n: usize) -> usize {
    match random.uniform() {
        u if u < 0.4 => 1,
        u if u < 0.8 => random.integer(2, 20),
        _ => (random.decades(1e-3, 0.1) * n as f64) as usize + 1,
    }
}

/// Adds a step between two levels, in a random direction.
fn step(random: &mut Random, grid: &Grid, h: &mut [f64]) -> &'static str {
    let size = rms(h) * random.decades(0.1, 1e3);
    let angle: f64 = random.pick(&[0.0, 0.25, 0.5, 0.1]) * std::f64::consts::PI;
    let place = random.between(0.1, 0.9) * (angle.cos() * grid.mx as f64 + angle.sin() * grid.my as f64);
    for (i, h) in h.iter_mut().enumerate() {
        let along = angle.cos() * (i % grid.mx) as f64 + angle.sin() * (i / grid.mx) as f64;
        *h += if along > place { size } else { 0.0 };
    }
    "step"
}

/// Adds a different constant to each row, like the zero error of a scan.
fn stripes(random: &mut Random, grid: &Grid, h: &mut [f64]) -> &'static str {
    let size = rms(h) * random.decades(0.01, 1.0);
    let zeros: Vec<f64> = (0..grid.my).map(|_| random.between(-size, size)).collect();
    h.iter_mut().enumerate().for_each(|(i, h)| *h += zeros[i / grid.mx]);
    "stripes"
}

/// Excludes elements (h infinite): scattered ones, spots, the border, every second to fifth column, or the deepest ones.
fn holes(random: &mut Random, grid: &Grid, h: &mut [f64]) -> &'static str {
    let Grid { mx, my, .. } = *grid;
    let (kind, part, every) = (random.integer(0, 4), random.decades(1e-3, 0.9), random.integer(2, 5));
    let spot = |random: &mut Random| {
        [random.between(0.0, mx as f64), random.between(0.0, my as f64), random.between(0.05, 0.3) * mx.max(my) as f64]
    };
    let spots: Vec<[f64; 3]> = (0..random.integer(1, 6)).map(|_| spot(random)).collect();
    let finite = sorted(h);
    let level = finite.get((part * finite.len() as f64) as usize).copied().unwrap_or(f64::INFINITY);
    for (i, h) in h.iter_mut().enumerate() {
        let (ix, iy) = (i % mx, i / mx);
        let hole = match kind {
            0 => random.chance(part),
            1 => spots.iter().any(|[x, y, r]| (ix as f64 - x).hypot(iy as f64 - y) < *r),
            2 => ix == 0 || iy == 0 || ix == mx - 1 || iy == my - 1,
            3 => ix % every == 0,
            _ => *h > level,
        };
        if hole {
            *h = f64::INFINITY;
        }
    }
    "holes"
}

/// Adds a large constant.
fn offset(random: &mut Random, h: &mut [f64]) -> &'static str {
    let by = rms(h) * random.decades(1.0, 1e6) * random.pick(&[1.0, -1.0]);
    h.iter_mut().for_each(|h| *h += by);
    "offset"
}
