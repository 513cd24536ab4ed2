//! Random grids like those of instruments: squares of any size, strips and line scans, in x or in y, some with slender elements.

use crate::grid::Grid;
use crate::random::Random;

/// An integer in a..=b, whose logarithm is uniformly distributed. Sometimes it is rounded up to a power of two.
fn count(random: &mut Random, a: usize, b: usize) -> usize {
    let value = random.decades(a as f64, b as f64 + 0.999) as usize;
    if random.chance(0.2) {
        value.next_power_of_two().min(b)
    } else {
        value
    }
}

/// A random grid. Few grids are large, so that the mean time of a case is some tenths of a second.
pub fn any(random: &mut Random) -> Grid {
    let (mx, my) = match random.uniform() {
        u if u < 0.12 => (count(random, 32, 9600), 1),
        u if u < 0.24 => (count(random, 100, 2441), count(random, 2, 20)),
        u if u < 0.27 => (count(random, 2, 8), count(random, 2, 8)),
        u if u < 0.47 => (count(random, 8, 64), count(random, 8, 64)),
        u if u < 0.57 => square(random, 26, 64),
        u if u < 0.80 => square(random, 64, 112),
        u if u < 0.95 => square(random, 112, 180),
        _ => square(random, 180, 256),
    };
    let (mx, my) = if random.chance(0.5) { (mx, my) } else { (my, mx) };
    let unit = if random.chance(0.3) { 10f64.powi(random.integer(0, 12) as i32 - 6) } else { 1.0 };
    let dx = unit * random.decades(0.1, 10.0);
    let dy = match random.uniform() {
        u if u < 0.6 => dx,
        u if u < 0.95 => dx * random.decades(0.25, 4.0),
        _ => dx * random.decades(1e-2, 1e2),
    };
    Grid { mx, my, dx, dy }
}

/// Equal or nearly equal numbers of elements in both directions.
fn square(random: &mut Random, a: usize, b: usize) -> (usize, usize) {
    let m = count(random, a, b);
    let other = if random.chance(0.5) { m } else { (m as f64 * random.between(0.7, 1.3)) as usize };
    (m, other.min(b))
}
