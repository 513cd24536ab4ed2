//! Products `u = A q` of tractions with two components, by FFT ([`VectorProduct`]).
//!
//! Axx and Ayy are even in both directions, Axy is odd in both. Steady rolling by whole elements along x uses differences of such coefficients. In
//! other steps of rolling the coefficients lie between the centres and are neither even nor odd.
//!
//! If Axy is 0 (for a Poisson ratio of 0, or on a single row), a traction displaces in its direction only. Then a component that is 0 everywhere
//! takes no time, and its displacement is exactly 0.

use std::f64::consts::PI;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use toeplitz::fft::Real;
use toeplitz::{vector_period, EvenMatrix, Memory, VectorProduct};

use super::coefficients::{Entry, Tangential};
use super::plane::Vector;
use super::quadrant::{circulant_period, Quadrant};
use super::unit::unit_of;
use crate::error::Result;
use crate::grid::Grid;
use crate::threads::Threads;

/// The offset of displacements at the centres.
const HERE: (f64, f64) = (0.0, 0.0);

/// Steps along x by whole elements use the product of even coefficients if they are at most the length of the grid over this number. That product
/// needs a longer period, but saves half of the symbol and three quarters of its set-up.
const LONGER_PERIOD: usize = 8;

/// The product of one grid. T is the precision of the transforms.
pub struct Toeplitz<T: Real> {
    product: VectorProduct<T>,
    /// The unit of the coefficients, a power of two, for the range of single precision.
    unit: f64,
}

impl<T: Real> Toeplitz<T> {
    /// Products with the coefficients of `tangential` on `grid`.
    pub fn new(tangential: &Tangential, grid: &Grid, threads: &Threads) -> Result<Toeplitz<T>> {
        Toeplitz::direct(&Quadrant::new(tangential, grid, HERE, threads)?, grid, threads)
    }

    /// Products with the inverse of a circulant near A, a preconditioner. The period of the circulant is at least one element longer than the grid.
    /// None if the circulant is not positive definite.
    pub fn inverse(tangential: &Tangential, grid: &Grid, threads: &Threads) -> Result<Option<Toeplitz<T>>> {
        Toeplitz::nearly_inverse(&Quadrant::new(tangential, grid, HERE, threads)?, grid, threads)
    }

    /// Products that return the displacements at the offset `by` from each centre, in elements.
    pub fn displaced(tangential: &Tangential, grid: &Grid, by: (f64, f64), threads: &Threads) -> Result<Toeplitz<T>> {
        let quadrant = Quadrant::new(tangential, grid, by, threads)?;
        if let Some(n) = whole_step(grid, by) {
            let product = Toeplitz::even(&quadrant, grid, n.unsigned_abs() as usize, threads)?;
            return Ok(Toeplitz { product: product.product.further_on(n)?, ..product });
        }
        Toeplitz::general((&quadrant, by), grid, |x, y| quadrant.displaced(x, y, by), threads)
    }

    /// Products with A, from coefficients that are computed already.
    pub fn direct(quadrant: &Quadrant, grid: &Grid, threads: &Threads) -> Result<Toeplitz<T>> {
        Toeplitz::even(quadrant, grid, 0, threads)
    }

    /// Products of steady rolling: displacements at each centre less those at the offset `by` from it, in elements.
    pub fn rolling(quadrant: &Quadrant, grid: &Grid, by: (f64, f64), threads: &Threads) -> Result<Toeplitz<T>> {
        if let Some(tables) = quadrant.tangential().uneven() {
            let (layer, (step_x, step_y)) = (quadrant.tangential().layer(), (by.0 as i64, by.1 as i64));
            let of_layer = |x: i64, y: i64| if (x, y) == (0, 0) { layer } else { 0.0 };
            let fill = |x: i64, y: i64| {
                let (here, there) = (tables.whole_at(x, y), tables.whole_at(x + step_x, y + step_y));
                let layer = of_layer(x, y) - of_layer(x + step_x, y + step_y);
                [here[0] - there[0] + layer, here[1] - there[1] + layer, here[2] - there[2]]
            };
            return Toeplitz::general((quadrant, by), grid, fill, threads);
        }
        if let Some(n) = whole_step(grid, by) {
            let product = Toeplitz::even(quadrant, grid, n.unsigned_abs() as usize, threads)?;
            return Ok(Toeplitz { product: product.product.less_further_on(n)?, ..product });
        }
        let fill = |x: i64, y: i64| {
            let (here, there) = (quadrant.at(x, y), quadrant.displaced(x, y, by));
            [here[0] - there[0], here[1] - there[1], here[2] - there[2]]
        };
        Toeplitz::general((quadrant, by), grid, fill, threads)
    }

    /// Products with the stored coefficients, Axx and Ayy even, Axy odd. The period has room for `more` further offsets in x.
    fn even(quadrant: &Quadrant, grid: &Grid, more: usize, threads: &Threads) -> Result<Toeplitz<T>> {
        let (given, unit) = ((grid.mx + more, grid.my), unit_of(quadrant.at(0, 0)[0]));
        let coefficients = EvenMatrix {
            given,
            is_coupled: !quadrant.is_uncoupled(grid, HERE),
            fill: |component, ky, row: &mut [f64]| quadrant.fill_row(component, ky, row),
            finish: |values: [f64; 3]| values.map(|value| value / unit),
        };
        let period = vector_period((2 * given.0 - 1, 2 * given.1 - 1));
        Ok(Toeplitz { product: VectorProduct::even((grid.mx, grid.my), period, &coefficients, threads)?, unit })
    }

    /// See [`inverse`](Self::inverse). If a coating is a membrane, the circulant of coefficients cut off at half a period may not be positive
    /// definite. Then the inverse follows from the responses to waves.
    pub fn nearly_inverse(quadrant: &Quadrant, grid: &Grid, threads: &Threads) -> Result<Option<Toeplitz<T>>> {
        let (period, given) = circulant_period(grid);
        if let Some(of_wave) = quadrant.tangential().of_waves().filter(|_| grid.mx > 1 && grid.my > 1) {
            return Toeplitz::inverse_of_waves(quadrant, (grid, period), of_wave, threads).map(Some);
        }
        let unit = 1.0 / unit_of(quadrant.at(0, 0)[0]);
        let fill = |component: usize, ky: i64, row: &mut [f64]| {
            quadrant.fill_row(component, ky, row);
            // An odd function is 0 at half a period.
            if component == 2 {
                let first = if 2 * ky as usize == period.1 { 0 } else { (period.0 / 2).min(row.len()) };
                row[first..].fill(0.0);
            }
        };
        let is_positive = AtomicBool::new(true);
        let finish = |values: [f64; 3]| {
            let (inverse, determinant) = inverted(values);
            if !(determinant > 0.0 && values[0] > 0.0) {
                is_positive.store(false, Ordering::Relaxed);
            }
            inverse.map(|value| value / unit)
        };
        let coefficients = EvenMatrix { given, is_coupled: !quadrant.is_uncoupled(grid, HERE), fill, finish };
        let product = VectorProduct::even((grid.mx, grid.my), period, &coefficients, threads)?;
        Ok(is_positive.into_inner().then_some(Toeplitz { product, unit }))
    }

    /// The product with the inverses of the responses `of_wave` to the waves of a period, by their wave vectors in radians per element.
    fn inverse_of_waves(
        quadrant: &Quadrant,
        (grid, (px, py)): (&Grid, (usize, usize)),
        of_wave: impl Fn(Vector) -> Entry + Sync + Send,
        threads: &Threads,
    ) -> Result<Toeplitz<T>> {
        let unit = 1.0 / unit_of(quadrant.at(0, 0)[0]);
        let (in_x, in_y) = (|k: usize| aliases(k, px), |k: usize| aliases(k, py));
        let wave = |kx: usize, ky: usize| {
            let pairs = in_x(kx).into_iter().flat_map(|x| in_y(ky).map(|y| (x, y)));
            pairs.fold([0.0; 3], |sum, ((x, mean_x), (y, mean_y))| {
                let entry = of_wave([x, y]);
                [0, 1, 2].map(|k| sum[k] + mean_x * mean_y * entry[k])
            })
        };
        // `of_wave` has no value for a uniform traction, the wave number 0. The largest response to the longest waves takes its place.
        let mean = [wave(1, 0), wave(0, 1)].iter().fold(0.0, |most: f64, [xx, yy, _]| most.max(*xx).max(*yy));
        let inverse = |kx: usize, ky: usize| {
            let [xx, yy, xy] = if (kx, ky) == (0, 0) { [mean, mean, 0.0] } else { wave(kx, ky) };
            // An odd function is 0 at half a period.
            let xy = if 2 * kx == px || 2 * ky == py { 0.0 } else { xy };
            inverted([xx, yy, xy]).0.map(|value| value / unit)
        };
        let is_coupled = !quadrant.is_uncoupled(grid, HERE);
        let product = VectorProduct::of_waves((grid.mx, grid.my), (px, py), (is_coupled, inverse), threads)?;
        Ok(Toeplitz { product, unit })
    }

    /// Products with the coefficients `at(x, y)`, which need not be even or odd.
    fn general(
        (quadrant, by): (&Quadrant, (f64, f64)),
        grid: &Grid,
        at: impl Fn(i64, i64) -> Entry + Sync + Send,
        threads: &Threads,
    ) -> Result<Toeplitz<T>> {
        let unit = unit_of(quadrant.at(0, 0)[0]);
        let fill = |kx: i64, ky: i64, [xx, yy, xy]: [&mut [f64]; 3]| {
            for (((kx, xx), yy), xy) in (kx..).zip(xx).zip(yy).zip(xy) {
                [*xx, *yy, *xy] = at(kx, ky).map(|value| value / unit);
            }
        };
        let is_coupled = match quadrant.tangential().uneven() {
            Some(tables) => !tables.is_uncoupled(),
            None => !quadrant.is_uncoupled(grid, by),
        };
        Ok(Toeplitz { product: VectorProduct::uneven((grid.mx, grid.my), is_coupled, fill, threads)?, unit })
    }

    /// Memory for products by this operator.
    pub fn workspace(&self) -> Result<Memory<T>> {
        Ok(self.product.memory()?)
    }

    /// The operator in another precision.
    pub fn in_precision<S: Real>(&self) -> Result<Toeplitz<S>> {
        Ok(Toeplitz { product: self.product.in_precision()?, unit: self.unit })
    }

    /// Bytes of the symbol.
    pub fn bytes(&self) -> usize {
        self.product.bytes()
    }

    /// Computes `u = A q`. In the transforms q is in units of `unit`, a power of two.
    pub fn apply(&self, q: &[Vector], unit: f64, u: &mut [Vector], memory: &mut Memory<T>) {
        let (mx, my) = self.product.grid();
        assert!(q.len() == mx * my && u.len() == mx * my, "fields of another grid");
        let [to, from] = self.scales(unit);
        let load = |component: usize, first: usize, rows: &mut [T]| {
            let q = &q[first * mx..][..rows.len()];
            rows.iter_mut().zip(q).for_each(|(value, q)| *value = T::of(to * q[component]));
        };
        let write = |u: &mut [Vector], _: usize, [x, y]: [&[T]; 2]| {
            for ((u, x), y) in u.iter_mut().zip(x).zip(y) {
                *u = [from * x.to_double(), from * y.to_double()];
            }
        };
        let loaded = match self.product.is_uncoupled() {
            false => [rows_with(q, mx, |q| *q != [0.0; 2]); 2],
            true => [0, 1].map(|component| rows_with(q, mx, |q| q[component] != 0.0)),
        };
        let pieces = u.chunks_mut(self.product.rows_at_a_time() * mx);
        self.product.apply(loaded.map(range), load, (pieces, write), memory);
    }

    /// Computes `u = from A (to q)/c` for fields by component, in any precision, where c is the unit of the coefficients.
    pub fn apply_by_component<S: Real>(
        &self,
        q: [&[S]; 2],
        [to, from]: [f64; 2],
        u: [&mut [S]; 2],
        memory: &mut Memory<T>,
    ) {
        let (mx, my) = self.product.grid();
        assert!(q.iter().all(|q| q.len() == mx * my), "fields of another grid");
        let load = |component: usize, first: usize, rows: &mut [T]| {
            let q = &q[component][first * mx..][..rows.len()];
            rows.iter_mut().zip(q).for_each(|(value, q)| *value = T::of(to * q.to_double()));
        };
        let write = |(ux, uy): (&mut [S], &mut [S]), _: usize, values: [&[T]; 2]| {
            for (u, values) in [ux, uy].into_iter().zip(values) {
                u.iter_mut().zip(values).for_each(|(u, value)| *u = S::of(from * value.to_double()));
            }
        };
        let loaded = q.map(|q| rows_with(q, mx, |q| !q.is_zero()));
        let loaded = match self.product.is_uncoupled() {
            false => [(loaded[0].0.min(loaded[1].0), loaded[0].1.max(loaded[1].1)); 2],
            true => loaded,
        };
        let [x, y] = u.map(|u| u.chunks_mut(self.product.rows_at_a_time() * mx));
        self.product.apply(loaded.map(range), load, (x.zip(y), write), memory);
    }

    /// The factors `[to, from]` for `u = A q` with q in units of `unit` in the transforms.
    pub fn scales(&self, unit: f64) -> [f64; 2] {
        [1.0 / unit, unit * self.unit]
    }
}

/// The wave number of wave k of a period and that of its longest alias, in radians per element, each with the mean of the wave over an element.
fn aliases(k: usize, period: usize) -> [(f64, f64); 2] {
    let half = PI * k as f64 / period as f64;
    let mean = |half: f64| if half == 0.0 { 1.0 } else { half.sin() / half };
    [half, half - PI].map(|half| (2.0 * half, mean(half)))
}

/// The inverse of a symmetric 2 x 2 matrix `[xx, yy, xy]`, and the determinant of this matrix.
fn inverted([xx, yy, xy]: [f64; 3]) -> ([f64; 3], f64) {
    let determinant = xx * yy - xy * xy;
    ([yy, xx, -xy].map(|value| value / determinant), determinant)
}

/// The number of elements of a step along x, if it is whole and short enough (see [`LONGER_PERIOD`]).
fn whole_step(grid: &Grid, by: (f64, f64)) -> Option<i64> {
    (by.1 == 0.0 && by.0.fract() == 0.0 && by.0.abs() * LONGER_PERIOD as f64 <= grid.mx as f64).then_some(by.0 as i64)
}

/// The first loaded row, and the one after the last. If no row is loaded, they are the number of rows and 0.
fn rows_with<A>(q: &[A], mx: usize, is_loaded: impl Fn(&A) -> bool) -> (usize, usize) {
    // The fold has no early exit, so that the compiler vectorises it.
    let has_any = |row: &[A]| row.iter().fold(false, |any, q| any | is_loaded(q));
    let first = q.chunks_exact(mx).position(has_any);
    let last = q.chunks_exact(mx).rposition(has_any);
    first.zip(last).map_or((q.len() / mx, 0), |(first, last)| (first, last + 1))
}

/// The result of [`rows_with`] as a range, which is empty if no row is loaded.
fn range((first, last): (usize, usize)) -> Range<usize> {
    first.min(last)..last
}
