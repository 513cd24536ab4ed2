//! The effect of a cycle on the waves that it couples: those that alias to one wave of its coarsest grid.

use super::level::{is_low, Left, Level};
use super::spectral_radius::spectral_radius;
use contact_normal::operator::fft::Complex;

/// A cycle V(n1, n2) on waves.
pub(super) struct Cycle<'a> {
    /// The levels, finest first. On the last one the equations are solved exactly.
    pub levels: &'a [Level],
    /// One sweep on each level but the last.
    pub sweeps: &'a [Vec<Left>],
    /// n1.
    pub pre: usize,
    /// n2.
    pub post: usize,
}

/// The waves that alias to frequency `base` of the coarsest grid: `[y][x]`, `side` in each direction on one level.
#[derive(Clone, Copy)]
struct Waves {
    base: [usize; 2],
    spacing: [usize; 2],
    side: usize,
}

impl Waves {
    /// The waves' indices `(jx, jy)` on the level.
    fn frequencies(self) -> impl Iterator<Item = [usize; 2]> {
        let Waves { base, spacing, side } = self;
        (0..side * side).map(move |i| [base[0] + i % side * spacing[0], base[1] + i / side * spacing[1]])
    }
}

impl Cycle<'_> {
    /// The spectral radius of the cycle on the waves that alias to frequency `base` of the coarsest grid.
    pub fn factor(&self, base: [usize; 2]) -> f64 {
        let waves = self.waves(0, base);
        let n = waves.side * waves.side;
        spectral_radius(n, columns(n, |error| self.reduce(0, base, error)))
    }

    /// The spectral radius of n1 sweeps on the finest grid and an ideal correction, which removes the waves that the next grid resolves.
    pub fn smoothing(&self, base: [usize; 2]) -> f64 {
        let waves = self.waves(0, base);
        let n = waves.side * waves.side;
        let smooth = |error: Vec<Complex<f64>>| {
            let mut error = (0..self.pre).fold(error, |error, _| self.smooth(0, waves, error));
            let [nx, ny] = self.levels[0].n;
            for (e, [jx, jy]) in error.iter_mut().zip(waves.frequencies()) {
                if is_low(jx, nx) && is_low(jy, ny) {
                    *e = Complex::default();
                }
            }
            error
        };
        spectral_radius(n, columns(n, smooth))
    }

    fn waves(&self, l: usize, base: [usize; 2]) -> Waves {
        let spacing = self.levels.last().map_or([0; 2], |coarsest| coarsest.n);
        Waves { base, spacing, side: 1 << (self.levels.len() - 1 - l) }
    }

    /// The error after a cycle that starts on level `l` with `error`.
    fn reduce(&self, l: usize, base: [usize; 2], error: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
        if l + 1 == self.levels.len() {
            return vec![Complex::default(); error.len()];
        }
        let (level, waves) = (&self.levels[l], self.waves(l, base));
        let (coarse, coarse_waves) = (&self.levels[l + 1], self.waves(l + 1, base));
        let mut error = (0..self.pre).fold(error, |error, _| self.smooth(l, waves, error));

        // The means of the defects over the children, divided by the coarse symbols.
        let half = coarse_waves.side;
        let alias = |i: usize| i / waves.side % half * half + i % waves.side % half;
        let mean = |[jx, jy]: [usize; 2]| level.means[0][jx] * level.means[1][jy];
        let mut correction = vec![Complex::default(); half * half];
        for (i, j) in waves.frequencies().enumerate() {
            correction[alias(i)] += mean(j) * level.values[j[1] * level.n[0] + j[0]].whole * error[i];
        }
        for (v, [jx, jy]) in correction.iter_mut().zip(coarse_waves.frequencies()) {
            *v /= coarse.values[jy * coarse.n[0] + jx].whole;
        }
        // The coarse cycle starts at zero. So its error is v at first; the error after it is what the correction lacks.
        let missing = self.reduce(l + 1, base, correction.clone());
        for (i, j) in waves.frequencies().enumerate() {
            error[i] -= mean(j).conj() * (correction[alias(i)] - missing[alias(i)]);
        }
        (0..self.post).fold(error, |error, _| self.smooth(l, waves, error))
    }

    fn smooth(&self, l: usize, waves: Waves, error: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
        let (sweep, nx, side) = (&self.sweeps[l], self.levels[l].n[0], waves.side);
        let mut left = vec![Complex::default(); error.len()];
        for (i, [jx, jy]) in waves.frequencies().enumerate() {
            let (own, crossed) = sweep[jy * nx + jx];
            let opposite = (i / side + side / 2) % side * side + (i + side / 2) % side;
            left[i] += own * error[i];
            left[opposite] += crossed * error[i];
        }
        left
    }
}

/// The matrix of a linear map, column by column.
fn columns(n: usize, map: impl Fn(Vec<Complex<f64>>) -> Vec<Complex<f64>>) -> Vec<Complex<f64>> {
    let unit = |k: usize| (0..n).map(|i| Complex::new(if i == k { 1.0 } else { 0.0 }, 0.0)).collect();
    (0..n).flat_map(|k| map(unit(k))).collect()
}
