//! The response of a coating to the pressure waves of a period.
//!
//! What the coating adds to the response to a wave k is the sum over k and its aliases `k + 2 pi (a/dx, b/dy)` of `2 pi c (B(k t) - 1)/k sinc(kx
//! dx/2) sinc(ky dy/2)`. Its terms decay as `exp(-2 k t)`, so that thin coatings have many aliases. They are summed in two groups:
//!
//! * the wave itself, and for slender elements also its nearest aliases along the longer side, are computed for each wave;
//! * the sum of all others is a smooth function of the wave on `[0, pi/dx] x [0, pi/dy]`, and is interpolated. Its singularities are those of
//!   `1/k`. Each lies at least one length of the interval beyond both ends. Therefore interpolation at n Chebyshev nodes in each direction has the
//!   error `r^-n`, where r is the sum of the half axes of the Bernstein ellipse through the nearest singularity: `r + 1/r = 2 + 2 sqrt(2)`, and the
//!   error is 1e-16 for n = 24. On grids with fewer waves than nodes the sum is computed for each wave.

use std::f64::consts::PI;

use toeplitz::ParityProduct;

use super::response::Response;
use super::CoatedBody;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{collected, computed, zeros};

/// The k t beyond which aliases are dropped: `exp(-2 k t) (k t)^2` is 1.7e-15 there.
const FADED: f64 = 20.0;
/// The number of nodes of the interpolation in each direction.
const NODES: usize = 24;
/// The name of the memory of waves in messages.
const WAVES: &str = "the waves of a coating";

/// Adds what the coating of a body contributes to the responses to all waves, `waves[bin in y][bin in x]`.
pub fn add(body: &CoatedBody, grid: &Grid, waves: &mut [f64]) -> Result<()> {
    let Some((t, _)) = body.layer else { return Ok(()) };
    let directions = [(grid.dx, grid.mx), (grid.dy, grid.my)];
    add_nearest(body, grid, waves)?;
    // The longest of all aliases is that of the shortest wave. If it has faded, all have.
    if PI * t > FADED * grid.dx.max(grid.dy) {
        return Ok(());
    }
    let [x, y] = directions.map(|(d, m)| Direction::new(d / t, m));
    let (x, y, nearest) = (x?, y?, nearest(grid));
    let mut values = zeros(x.places.len() * y.places.len(), WAVES)?;
    let (columns, is_symmetric) = (x.places.len(), grid.dx == grid.dy && x.is_interpolated() && y.is_interpolated());
    for (row, in_y) in y.places.iter().enumerate() {
        for (column, in_x) in x.places.iter().enumerate().skip(if is_symmetric { row } else { 0 }) {
            let value = others(body, nearest, in_x, in_y);
            values[row * columns + column] = value;
            if is_symmetric {
                values[column * columns + row] = value;
            }
        }
    }
    let row = x.bins;
    let mut in_x = zeros(x.places.len(), WAVES)?;
    for (j, waves) in waves.chunks_exact_mut(row).enumerate() {
        in_x.fill(0.0);
        y.each(j, |place, weight| {
            let values = &values[place * in_x.len()..][..in_x.len()];
            in_x.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
        });
        match x.is_interpolated() {
            false => waves.iter_mut().zip(&in_x).for_each(|(wave, value)| *wave += value),
            true => x.weights.chunks_exact(row).zip(&in_x).for_each(|(weights, value)| {
                waves.iter_mut().zip(weights).for_each(|(wave, weight)| *wave += weight * value);
            }),
        }
    }
    Ok(())
}

/// The largest numbers of aliases in x and in y, with either sign, that are computed for each wave. Only the direction of the longer side has
/// such aliases.
fn nearest(grid: &Grid) -> (i64, i64) {
    // Alias a has a wave number of at least (2 |a| - 1) pi/d. It is computed if this is less than that of the shortest wave in the other
    // direction.
    let last = |ratio: f64| (0.5 * (1.0 + ratio)).ceil().min(1e6) as i64 - 1;
    (last(grid.dx / grid.dy).max(0), last(grid.dy / grid.dx).max(0))
}

/// Adds, for all waves except the constant one, the aliases up to [`nearest`].
fn add_nearest(body: &CoatedBody, grid: &Grid, waves: &mut [f64]) -> Result<()> {
    let Some((t, radial)) = &body.layer else { return Ok(()) };
    let ((row, rows), (last_x, last_y)) = (grid.offsets((true, true)), nearest(grid));
    let [of_x, of_y] = [(grid.dx, grid.mx), (grid.dy, grid.my)]
        .map(|(d, m)| move |bin: usize, number: i64| alias(d / t, PI * bin as f64 / m as f64, number));
    let scale = 2.0 * PI * body.compliance * t;
    for a in (-last_x..=last_x).filter(|&a| has_wave_left(of_x(0, a), of_x(row - 1, a))) {
        let in_x = collected((0..row).map(|i| of_x(i, a)), WAVES)?;
        for b in (-last_y..=last_y).filter(|&b| has_wave_left(of_y(0, b), of_y(rows - 1, b))) {
            for (j, waves) in waves.chunks_exact_mut(row).enumerate() {
                let (sy, mean_y) = of_y(j, b);
                if sy.abs() > FADED {
                    continue;
                }
                for (wave, (sx, mean_x)) in waves.iter_mut().zip(&in_x) {
                    let s = (sx * sx + sy * sy).sqrt();
                    if s > 0.0 && s <= FADED {
                        *wave += scale * radial.transfer.less_one(s) / s * (mean_x * mean_y);
                    } else if a == 0 && s > 0.0 {
                        break;
                    }
                }
            }
        }
    }
    Ok(())
}

/// Whether some wave between the `first` and the `last` has not faded.
fn has_wave_left((first, _): (f64, f64), (last, _): (f64, f64)) -> bool {
    first.abs().min(last.abs()) <= FADED
}

/// The sum over all aliases at a place, except those up to [`nearest`].
fn others(body: &CoatedBody, (last_x, last_y): (i64, i64), in_x: &Place, in_y: &Place) -> f64 {
    let Some((t, radial)) = &body.layer else { return 0.0 };
    let mut sum = 0.0;
    for (a, (sx, mean_x)) in in_x {
        for (b, (sy, mean_y)) in in_y {
            let s = (sx * sx + sy * sy).sqrt();
            if s <= FADED && (a.abs() > last_x || b.abs() > last_y) {
                sum += radial.transfer.less_one(s) / s * (mean_x * mean_y);
            }
        }
    }
    2.0 * PI * body.compliance * t * sum
}

/// An alias of a wave in one direction: its `k t`, and its mean over an element of d thicknesses. `angle` is the phase of the wave over half an
/// element.
fn alias(d: f64, angle: f64, number: i64) -> (f64, f64) {
    let half = angle + PI * number as f64;
    let mean = if half == 0.0 { 1.0 } else { angle.sin() / half };
    (2.0 * half / d, if number % 2 == 0 { mean } else { -mean })
}

/// The aliases of a wave in one direction that have not faded: the number, `k t`, and the mean over an element of each.
type Place = Vec<(i64, (f64, f64))>;

/// One direction: the places at which aliases are summed, and the weights of the interpolation from these to the bins.
struct Direction {
    /// The number of bins.
    bins: usize,
    /// The places: Chebyshev nodes, or the bins themselves.
    places: Vec<Place>,
    /// The weights `[place][bin]` of the interpolation; empty if the places are the bins.
    weights: Vec<f64>,
}

impl Direction {
    /// The direction with m elements of d thicknesses each.
    fn new(d: f64, m: usize) -> Result<Direction> {
        let bins = m / 2 + 1;
        let angle_of = |bin: usize| PI * bin as f64 / m as f64;
        if bins <= NODES {
            let places = (0..bins).map(|bin| Direction::place(d, angle_of(bin))).collect();
            return Ok(Direction { bins, places, weights: Vec::new() });
        }
        // The phase of the wave of node n over half an element.
        let node = |n: usize| 0.25 * PI * (1.0 + (PI * (n as f64 + 0.5) / NODES as f64).cos());
        let places = (0..NODES).map(|n| Direction::place(d, node(n))).collect();
        let barycentric = |n: usize| (PI * (n as f64 + 0.5) / NODES as f64).sin() * if n % 2 == 0 { 1.0 } else { -1.0 };
        let mut weights = zeros(NODES * bins, WAVES)?;
        for bin in 0..bins {
            let away = |n: usize| angle_of(bin) - node(n);
            let total: f64 = (0..NODES).map(|n| barycentric(n) / away(n)).sum();
            let at_node = (0..NODES).find(|&n| away(n) == 0.0);
            for n in 0..NODES {
                weights[n * bins + bin] = match at_node {
                    Some(node) => f64::from(u8::from(n == node)),
                    None => barycentric(n) / away(n) / total,
                };
            }
        }
        Ok(Direction { bins, places, weights })
    }

    /// The aliases of the wave with this phase over half an element.
    fn place(d: f64, angle: f64) -> Place {
        let last = (FADED * d / (2.0 * PI)).ceil() as i64 + 1;
        (-last..=last).map(|a| (a, alias(d, angle, a))).filter(|(_, (s, _))| s.abs() <= FADED).collect()
    }

    /// Whether the places are nodes, from which the bins are interpolated.
    fn is_interpolated(&self) -> bool {
        !self.weights.is_empty()
    }

    /// Calls `take(place, weight)` for each place from which a bin is interpolated.
    fn each(&self, bin: usize, mut take: impl FnMut(usize, f64)) {
        match self.is_interpolated() {
            false => take(bin, 1.0),
            true => (0..self.places.len()).for_each(|place| take(place, self.weights[place * self.bins + bin])),
        }
    }
}

/// Computes the coefficients at offsets up to half the period from the responses to all waves, as sums of cosines.
pub fn coefficients(waves: &[f64], grid: &Grid) -> Result<Vec<f64>> {
    let (row, rows) = grid.offsets((true, true));
    // Rows beyond the last one that is not 0 are not transformed.
    let last = waves.chunks_exact(row).rposition(|waves| waves.iter().any(|wave| *wave != 0.0)).unwrap_or(0);
    let product = ParityProduct::new(grid.mx, grid.my)?;
    let mut sums = zeros(row * rows, WAVES)?;
    let mut memory = product.memory(last + 1)?;
    product.of_kernel(&waves[..(last + 1) * row], row, (false, false), &mut memory, &mut sums);
    drop(memory);
    let share = 1.0 / grid.len() as f64;
    // The sums are stored as `[kx][ky]`.
    Ok(computed((0..row * rows).map(|i| share * sums[i % row * rows + i / row]), WAVES)?)
}
