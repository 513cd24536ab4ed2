//! The creep of a body: the modes of its dashpots under a given w.
//!
//! ```text
//! t_k dq_k/dt = w + sum of r_l q_l - q_k,    q_k = sum over modes of v_i/(1 - t_k lambda_i),    dv_i/dt = -lambda_i v_i + w/N_i
//! sum of r_k/(1 - t_k lambda_i) = 1,         N_i = sum of r_k t_k/(1 - t_k lambda_i)^2
//! ```
//!
//! There is one lambda between any two rates `1/t_k`, and one below all rates, which is 0 for a fluid. A root is found as its distance from the
//! nearer neighbouring rate, by bisection of its bits: all digits of lambda and of `1 - t_k lambda_i` are right.

use super::series::Series;

/// One mode.
pub struct Mode {
    /// lambda, a rate >= 0.
    pub rate: f64,
    /// `1/(1 - t_k lambda)` of each branch: q by v.
    pub shape: Vec<f64>,
    /// N, a time.
    pub inertia: f64,
}

impl Mode {
    /// All modes of a series.
    pub fn of(series: &Series) -> Vec<Mode> {
        (0..series.len()).map(|i| Mode::new(series, i)).collect()
    }

    /// The mode between the rates i - 1 and i, or below the first.
    fn new(series: &Series, i: usize) -> Mode {
        let Series { fractions, times, .. } = series;
        let (rate, less) = root(series, i);
        let shape: Vec<f64> = less.iter().map(|less| 1.0 / less).collect();
        let inertia = (0..times.len()).map(|k| fractions[k] * times[k] * shape[k] * shape[k]).sum();
        Mode { rate, shape, inertia }
    }
}

/// A root, and `1 - t_k lambda` of each branch.
fn root(series: &Series, i: usize) -> (f64, Vec<f64>) {
    let Series { fractions, times, rest } = series;
    let excess = |less: &[f64]| fractions.iter().zip(less).map(|(r, less)| r / less).sum::<f64>() - 1.0;
    // Relative to 0: no cancellation if the long-time modulus is small.
    let from_zero = |rate: f64| {
        let term = |(r, t): (&f64, &f64)| r * t * rate / (1.0 - t * rate);
        fractions.iter().zip(times).map(term).sum::<f64>() - rest
    };
    // lambda = (1 - d)/t_o. Only ratios of times, so that they may have any unit.
    let from =
        |o: usize, d: f64| -> Vec<f64> { times.iter().map(|t| (times[o] - t) / times[o] + t / times[o] * d).collect() };
    if i == 0 {
        let middle = 0.5 / times[0];
        if *rest == 0.0 {
            return (0.0, vec![1.0; times.len()]);
        }
        if from_zero(middle) >= 0.0 {
            let rate = bisect(middle, |rate| from_zero(rate) < 0.0);
            return (rate, times.iter().map(|t| 1.0 - t * rate).collect());
        }
        let d = bisect(0.5, |d| excess(&from(0, d)) > 0.0);
        return ((1.0 - d) / times[0], from(0, d));
    }
    let middle = 0.5 * (1.0 / times[i - 1] + 1.0 / times[i]);
    let (below, above) = (times[i - 1] * middle - 1.0, 1.0 - times[i] * middle);
    let (o, d) = match excess(&from(i, above)) >= 0.0 {
        true => (i - 1, -bisect(below, |d| excess(&from(i - 1, -d)) < 0.0)),
        false => (i, bisect(above, |d| excess(&from(i, d)) > 0.0)),
    };
    ((1.0 - d) / times[o], from(o, d))
}

/// The end of the range with `is_before` between 0 and `most`, to the last bit.
fn bisect(most: f64, is_before: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0u64, most.to_bits());
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if is_before(f64::from_bits(middle)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::from_bits(high)
}
