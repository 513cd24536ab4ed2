//! Convolutions on grids by the campaign's Fourier transform: radix 2, in double precision, with sine and cosine computed for each twiddle.
//!
//! The period of a convolution is the number of offsets, rounded up to the next power of two. So different offsets do not coincide.

use std::f64::consts::PI;

type Complex = [f64; 2];

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// The transform of a length that is a power of two, with its twiddles `e^(-2 pi i k/n)`.
struct Transform {
    n: usize,
    twiddles: Vec<Complex>,
}

impl Transform {
    fn new(n: usize) -> Transform {
        let angle = |k: usize| -2.0 * PI * k as f64 / n as f64;
        Transform { n, twiddles: (0..n / 2).map(|k| [angle(k).cos(), angle(k).sin()]).collect() }
    }

    /// Transforms values in place: sorts them in the order of reversed bits, then applies the steps of Cooley and Tukey.
    fn forward(&self, values: &mut [Complex]) {
        let n = self.n;
        let mut reversed = 0;
        for i in 1..n {
            let mut bit = n >> 1;
            while reversed & bit != 0 {
                reversed ^= bit;
                bit >>= 1;
            }
            reversed |= bit;
            if i < reversed {
                values.swap(i, reversed);
            }
        }
        let mut half = 1;
        while half < n {
            let stride = n / (2 * half);
            for block in values.chunks_exact_mut(2 * half) {
                let (low, high) = block.split_at_mut(half);
                for (k, (low, high)) in low.iter_mut().zip(high).enumerate() {
                    let (a, b) = (*low, times(*high, self.twiddles[k * stride]));
                    (*low, *high) = ([a[0] + b[0], a[1] + b[1]], [a[0] - b[0], a[1] - b[1]]);
                }
            }
            half *= 2;
        }
    }
}

/// The transforms of a grid of complex numbers in both directions.
struct Plane {
    along_x: Transform,
    along_y: Transform,
}

impl Plane {
    /// The transforms of a grid of at least x by y values.
    fn new(x: usize, y: usize) -> Plane {
        Plane { along_x: Transform::new(x.next_power_of_two()), along_y: Transform::new(y.next_power_of_two()) }
    }

    /// Transforms values `[y][x]` in place.
    fn forward(&self, values: &mut [Complex]) {
        let (nx, ny) = (self.along_x.n, self.along_y.n);
        values.chunks_exact_mut(nx).for_each(|row| self.along_x.forward(row));
        // Eight columns are transformed at a time: in each row they are whole cache lines.
        let mut columns = vec![[0.0; 2]; 8 * ny];
        for first in (0..nx).step_by(8) {
            let count = (nx - first).min(8);
            for (y, row) in values.chunks_exact(nx).enumerate() {
                (0..count).for_each(|c| columns[c * ny + y] = row[first + c]);
            }
            columns.chunks_exact_mut(ny).take(count).for_each(|column| self.along_y.forward(column));
            for (y, row) in values.chunks_exact_mut(nx).enumerate() {
                (0..count).for_each(|c| row[first + c] = columns[c * ny + y]);
            }
        }
    }
}

/// Convolutions with a table of entries at the offsets `-(mx - 1)..mx` by `-(my - 1)..my`, whose transform is `spectrum`.
pub struct Convolution {
    mx: usize,
    my: usize,
    plane: Plane,
    spectrum: Vec<Complex>,
}

impl Convolution {
    /// `entry(kx, ky)` is the effect of a load of 1 on the element at this offset from the load.
    pub fn new(mx: usize, my: usize, entry: impl Fn(i64, i64) -> f64) -> Convolution {
        let plane = Plane::new(2 * mx - 1, 2 * my - 1);
        let (nx, ny) = (plane.along_x.n, plane.along_y.n);
        let mut spectrum = vec![[0.0; 2]; nx * ny];
        for ky in 1 - my as i64..my as i64 {
            let row = ky.rem_euclid(ny as i64) as usize * nx;
            for kx in 1 - mx as i64..mx as i64 {
                spectrum[row + kx.rem_euclid(nx as i64) as usize][0] = entry(kx, ky);
            }
        }
        plane.forward(&mut spectrum);
        Convolution { mx, my, plane, spectrum }
    }

    /// The convolutions of two fields of loads at once: one is the real part of the transformed values, the other the imaginary part.
    pub fn apply(&self, loads: [&[f64]; 2]) -> [Vec<f64>; 2] {
        let (nx, ny) = (self.plane.along_x.n, self.plane.along_y.n);
        let mut values = vec![[0.0; 2]; nx * ny];
        for (y, row) in values.chunks_exact_mut(nx).take(self.my).enumerate() {
            for (x, value) in row.iter_mut().take(self.mx).enumerate() {
                *value = loads.map(|load| load.get(y * self.mx + x).copied().unwrap_or(0.0));
            }
        }
        self.plane.forward(&mut values);
        // The inverse transform is the conjugate of the transform of the conjugate.
        for (value, factor) in values.iter_mut().zip(&self.spectrum) {
            let [re, im] = times(*value, *factor);
            *value = [re, -im];
        }
        self.plane.forward(&mut values);
        let scale = 1.0 / (nx * ny) as f64;
        let at = |i: usize| values[i / self.mx * nx + i % self.mx];
        let n = self.mx * self.my;
        [(0..n).map(|i| scale * at(i)[0]).collect(), (0..n).map(|i| -scale * at(i)[1]).collect()]
    }

    /// The convolution of one field of loads.
    pub fn of(&self, load: &[f64]) -> Vec<f64> {
        let [result, _] = self.apply([load, &[]]);
        result
    }
}

/// A periodic field on nx by ny elements, both powers of two: the real part of a sum of waves with these amplitudes and phases.
pub fn synthesis(nx: usize, ny: usize, amplitude_and_phase: impl Fn(usize, usize) -> (f64, f64)) -> Vec<f64> {
    let plane = Plane::new(nx, ny);
    let wave = |i: usize| {
        let (a, phase) = amplitude_and_phase(i % nx, i / nx);
        [a * phase.cos(), a * phase.sin()]
    };
    let mut values: Vec<Complex> = (0..nx * ny).map(wave).collect();
    plane.forward(&mut values);
    values.into_iter().map(|value| value[0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// The table has no symmetry. The grids are one element, one row, one column, and others.
    #[test]
    fn a_convolution_is_its_sum() {
        let mut random = Random::new(1);
        for (mx, my) in [(1, 1), (7, 1), (1, 9), (5, 12), (16, 3)] {
            let table: Vec<f64> = (0..4 * mx * my).map(|_| random.between(-1.0, 1.0)).collect();
            let entry = |kx: i64, ky: i64| table[(ky + my as i64) as usize * 2 * mx + (kx + mx as i64) as usize];
            let convolution = Convolution::new(mx, my, entry);
            let loads = [0, 1].map(|_| (0..mx * my).map(|_| random.uniform()).collect::<Vec<_>>());
            let found = convolution.apply([&loads[0], &loads[1]]);
            for (load, found) in loads.iter().zip(&found) {
                for (i, found) in found.iter().enumerate() {
                    let offset = |j: usize| {
                        (i as i64 % mx as i64 - j as i64 % mx as i64, i as i64 / mx as i64 - j as i64 / mx as i64)
                    };
                    let sum: f64 = (0..mx * my).map(|j| entry(offset(j).0, offset(j).1) * load[j]).sum();
                    // There are at most 60 terms of at most 1, and seven steps of a transform.
                    assert!((sum - found).abs() <= 1e-13, "{mx} x {my}, {i}: {found} for {sum}");
                }
            }
        }
    }
}
