//! One grid of the analysis: its frequencies, symbols and smoothers.

use std::f64::consts::PI;

use super::symbol::{Symbol, Value};
use contact_normal::methods::multigrid::SmootherKind;
use contact_normal::operator::fft::Complex;

/// The symbols at the frequencies `t = pi (2 j + 1)/n`, `j = 0..n`, in each direction.
pub struct Level {
    /// n, in x and y.
    pub(super) n: [usize; 2],
    /// c(0, 0).
    pub(super) diagonal: f64,
    /// `[jy][jx]`.
    pub(super) values: Vec<Value>,
    /// `(1 + e^(i t))/2` at every frequency of a direction: the mean of a wave over two neighbours.
    pub(super) means: [Vec<Complex<f64>>; 2],
}

/// The effect of one sweep on a wave of frequency t: its new amplitude, and that of the wave of frequency t + (pi, pi).
pub(super) type Left = (Complex<f64>, Complex<f64>);

/// Frequency j of n.
pub(super) fn frequency(j: usize, n: usize) -> f64 {
    PI * (2 * j + 1) as f64 / n as f64
}

/// Whether the next coarser grid resolves frequency j of n: |t| < pi/2.
pub(super) fn is_low(j: usize, n: usize) -> bool {
    2 * (2 * j + 1).min(2 * (n - j) - 1) < n
}

impl Level {
    /// The level of elements `dx` by `dy` with n frequencies in each direction.
    pub(super) fn new(dx: f64, dy: f64, n: [usize; 2]) -> Level {
        let symbol = Symbol::new(dx, dy, 1.0);
        let [nx, ny] = n;
        let zero = Value { whole: 0.0, before: Complex::default() };
        let mut values = vec![zero; nx * ny];
        for jx in 0..nx / 2 {
            let column = symbol.row(frequency(jx, nx), (0..ny).map(|jy| frequency(jy, ny)));
            for (jy, value) in column.into_iter().enumerate() {
                values[jy * nx + jx] = value;
                // At -t L has the conjugate value.
                values[(ny - 1 - jy) * nx + nx - 1 - jx] = Value { before: value.before.conj(), ..value };
            }
        }
        let means = n.map(|n| (0..n).map(|j| 0.5 * (1.0 + Complex::from_polar(1.0, frequency(j, n)))).collect());
        Level { n, diagonal: symbol.diagonal(), values, means }
    }

    /// Index of the wave of frequency t + (pi, pi).
    pub(super) fn opposite(&self, jx: usize, jy: usize) -> usize {
        let [nx, ny] = self.n;
        (jy + ny / 2) % ny * nx + (jx + nx / 2) % nx
    }

    /// The effect of one sweep at every frequency.
    pub(super) fn sweep(&self, smoother: SmootherKind, omega: f64) -> Vec<Left> {
        let alone = |factor: Complex<f64>| (factor, Complex::default());
        match smoother {
            SmootherKind::Jacobi => {
                self.values.iter().map(|value| alone((1.0 - omega * value.whole / self.diagonal).into())).collect()
            }
            SmootherKind::GaussSeidel => {
                let left = |value: &Value| alone(1.0 - value.whole / (self.diagonal / omega + value.before));
                self.values.iter().map(left).collect()
            }
            SmootherKind::RedBlack => {
                let [nx, ny] = self.n;
                (0..nx * ny).map(|i| self.red_black(i, self.opposite(i % nx, i / nx), omega)).collect()
            }
            // M A = 1, and the step of least energy is 1
            SmootherKind::Fft => vec![alone((1.0 - omega).into()); self.values.len()],
        }
    }

    /// The effect of a red half sweep, then a black one, on the wave of index `own`; `other` is t + (pi, pi). Within a colour the offsets kx + ky are
    /// even, and the mean of L(t) and L(t + (pi, pi)) is the sum over those.
    fn red_black(&self, own: usize, other: usize, omega: f64) -> Left {
        let (value, opposite) = (self.values[own], self.values[other]);
        let inverse = 1.0 / (self.diagonal / omega + 0.5 * (value.before + opposite.before));
        // The residual of the red elements has half its amplitude in the wave itself, and half in the wave of the other frequency.
        let red = 0.5 * inverse * value.whole;
        let (mut left, mut crossed) = (1.0 - red, -red);
        let black = 0.5 * inverse * (value.whole * left - opposite.whole * crossed);
        left -= black;
        crossed += black;
        (left, crossed)
    }
}
