//! The inverse of a circulant near A, as a preconditioner (Strang 1986, T. Chan 1988).
//!
//! The period of the circulant is at least one element longer than the grid. In a periodic direction it is the length of the grid, in a direction
//! with one element it is 1. A product by the inverse costs a quarter of one with the padding of A, and the number of iterations is the same.

use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

use toeplitz::fft::Real;
use toeplitz::{Even, Product, SetUp};

use super::operator::Operator;
use super::periods::even_periods;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::threads::Threads;

impl<T: Real> Operator<T> {
    /// The period of the circulant of a preconditioner, in x and in y.
    pub fn circulant_period(coefficients: &Coefficients, grid: &Grid) -> (usize, usize) {
        let (px, py) = even_periods(coefficients, grid, (grid.mx + 1, grid.my + 1));
        (if grid.mx == 1 { 1 } else { px }, if grid.my == 1 { 1 } else { py })
    }

    /// Sets up the inverse of a circulant near A. The circulant has the given `period`, and the even part of the coefficients at offsets up to half
    /// the period. None if the circulant is not positive definite.
    pub fn inverse_circulant(
        coefficients: &Coefficients,
        grid: &Grid,
        period: (usize, usize),
        threads: &Threads,
    ) -> Result<Option<Operator<T>>> {
        Operator::scaled_inverse(coefficients, 1.0, grid, period, threads)
    }

    /// [`Operator::inverse_circulant`] for coefficients times a factor, a power of two.
    pub fn scaled_inverse(
        coefficients: &Coefficients,
        factor: f64,
        grid: &Grid,
        period: (usize, usize),
        threads: &Threads,
    ) -> Result<Option<Operator<T>>> {
        let positive = AtomicBool::new(true);
        let finish = |value: f64| {
            if !(value > 0.0) {
                positive.store(false, Ordering::Relaxed);
            }
            1.0 / (factor * value)
        };
        let mut inverse = Product::new((grid.mx, grid.my), period, threads)?;
        if coefficients.wave(grid, 1.0 / grid.dx, 0.0).is_some() {
            inverse.set_values(|x, y| finish(wave_of(coefficients, grid, period, (x, y))))?;
            return Ok(positive.into_inner().then(|| Operator::by(inverse, grid)));
        }
        let given = (period.0 / 2 + 1, period.1 / 2 + 1);
        let fill = |ky: i64, row: &mut [f64]| coefficients.fill_even_row(ky, row);
        inverse.set_even(&Even { given, fill, finish }, &mut SetUp::default())?;
        Ok(positive.into_inner().then(|| Operator::by(inverse, grid)))
    }
}

/// The inverse treats a uniform pressure like a wave with this part of the smallest wave number: it represents all waves longer than the period. The
/// value comes from measurements.
const MEAN_WAVE: f64 = 0.45;

/// The displacement by the wave of pressure with bin `(x, y)`, relative to the pressure.
fn wave_of(coefficients: &Coefficients, grid: &Grid, (px, py): (usize, usize), (x, y): (usize, usize)) -> f64 {
    let number = |bin: usize, p: usize, d: f64| 2.0 * PI * bin as f64 / (p as f64 * d);
    let (mut kx, ky) = (number(x, px, grid.dx), number(y, py, grid.dy));
    if kx == 0.0 && ky == 0.0 {
        kx = MEAN_WAVE * f64::min(number(1, px, grid.dx), number(1, py, grid.dy));
    }
    coefficients.wave(grid, kx, ky).unwrap_or(f64::NAN)
}
