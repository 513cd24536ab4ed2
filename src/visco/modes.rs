//! The creep of a body: the modes v_i of its dashpots under a given instantaneous displacement w (see [`visco`](super)).
//!
//! ```text
//! t_k dq_k/dt = w + sum of r_l q_l - q_k,    q_k = sum over modes of v_i/(1 - t_k lambda_i),    dv_i/dt = -lambda_i v_i + w/N_i
//! sum of r_k/(1 - t_k lambda_i) = 1,         N_i = sum of r_k t_k/(1 - t_k lambda_i)^2
//! ```
//!
//! The rates lambda_i are the roots of the first equation of the second line. There is one lambda between any two neighbouring rates `1/t_k`, and one
//! below all of these rates, which is 0 for a fluid. The unknown of the search is the distance of lambda from the nearer one of the two rates. It is
//! bisected in its bits, so that all digits of lambda and of `1 - t_k lambda_i` are right.

use super::series::Series;

/// A mode of creep.
pub struct Mode {
    /// The rate lambda >= 0.
    pub rate: f64,
    /// The ratio of q_k to v for each branch, `1/(1 - t_k lambda)`.
    pub shape: Vec<f64>,
    /// N, a time.
    pub inertia: f64,
}

impl Mode {
    /// All modes of a series.
    pub fn of(series: &Series) -> Vec<Mode> {
        (0..series.len()).map(|i| Mode::new(series, i)).collect()
    }

    /// The mode with a rate between `1/t_(i - 1)` and `1/t_i`, or below `1/t_0` for i = 0.
    fn new(series: &Series, i: usize) -> Mode {
        let Series { fractions, times, .. } = series;
        let (rate, denominators) = root(series, i);
        let shape: Vec<f64> = denominators.iter().map(|denominator| 1.0 / denominator).collect();
        let inertia = (0..times.len()).map(|k| fractions[k] * times[k] * shape[k] * shape[k]).sum();
        Mode { rate, shape, inertia }
    }
}

/// The rate lambda of mode i, and the denominators `1 - t_k lambda` of all branches.
fn root(series: &Series, i: usize) -> (f64, Vec<f64>) {
    let Series { fractions, times, rest } = series;
    // The equation of the module, as a function of the denominators.
    let excess = |denominators: &[f64]| fractions.iter().zip(denominators).map(|(r, d)| r / d).sum::<f64>() - 1.0;
    // The same equation less its value at lambda = 0, so that nothing cancels if the long-time modulus is small.
    let from_zero = |rate: f64| {
        let term = |(r, t): (&f64, &f64)| r * t * rate / (1.0 - t * rate);
        fractions.iter().zip(times).map(term).sum::<f64>() - rest
    };
    // The denominators for lambda = (1 - d)/t_o, a rate at the relative distance d from that of branch o. Times enter as ratios, so that they may
    // have any unit.
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

/// The number between 0 and `most` up to which `is_before` holds, to the last bit.
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
