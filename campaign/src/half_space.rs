//! Influence coefficients of the half-space, by Love's closed form and, for periodic scenes, by Fourier series.
//!
//! ```text
//! c(X, Y) = c [F(X+, Y+) - F(X+, Y-) - F(X-, Y+) + F(X-, Y-)],  F(a, b) = a asinh(b/|a|) + b asinh(a/|b|)     (Love 1929)
//! ```
//!
//! With a period of `mx dx` in x, the coefficients in the row at distance ky are a sum of modes `e^(i t kx)`, t = 2 pi j/mx. The amplitude of mode j
//! is
//!
//! ```text
//! j > 0     2 c sum over m of sinc_m * integral of K0(w_m |y|) over the element,  w_m = |t + 2 pi m|/dx
//! j = 0     2 c   integral of log(W/|y|) over the element; W: the width of the grid in y. At this distance a line load has no displacement
//! ```
//!
//! With a second period Ly, in y, the images in y are summed. For j > 0 their sum is a geometric series. For j = 0 the images replace `log(W/|y|)` by
//! `-log |2 sin(pi y/Ly)|`, whose integral is Clausen's function.

use std::f64::consts::PI;

/// The compliance of both bodies `c = 1/(pi E*)`, with `1/E* = sum of (1 - nu)/(2 G)`.
pub fn compliance(shear_modulus: [f64; 2], poisson_ratio: [f64; 2]) -> f64 {
    (0..2).map(|i| (1.0 - poisson_ratio[i]) / (2.0 * shear_modulus[i])).sum::<f64>() / PI
}

/// Even coefficients, given at offsets >= 0.
pub struct Quadrant {
    /// The number of offsets in x.
    pub mx: usize,
    /// The coefficients, `[ky][kx]`.
    pub values: Vec<f64>,
    /// The possible round-off of one coefficient.
    pub rounding: f64,
}

impl Quadrant {
    /// The coefficient at an offset of any sign.
    pub fn at(&self, kx: i64, ky: i64) -> f64 {
        self.values[ky.unsigned_abs() as usize * self.mx + kx.unsigned_abs() as usize]
    }
}

/// F(a, b). At a = 0 or b = 0 it is the limit of F.
fn potential(a: f64, b: f64) -> f64 {
    let term = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() };
    term(a, b) + term(b, a)
}

/// The coefficients without a period, at offsets `0 .. mx` and `0 .. my`.
pub fn free(mx: usize, my: usize, dx: f64, dy: f64, c: f64) -> Quadrant {
    let corner = |kx: usize, ky: usize| potential((kx as f64 - 0.5) * dx, (ky as f64 - 0.5) * dy);
    let corners: Vec<f64> = (0..=my).flat_map(|ky| (0..=mx).map(move |kx| corner(kx, ky))).collect();
    let at = |kx: usize, ky: usize| corners[ky * (mx + 1) + kx];
    let value = |kx: usize, ky: usize| c * (at(kx + 1, ky + 1) - at(kx + 1, ky) - at(kx, ky + 1) + at(kx, ky));
    let values = (0..my).flat_map(|ky| (0..mx).map(move |kx| value(kx, ky))).collect();
    // A coefficient is a sum of four terms. Each has a round-off of some units, relative to the largest term.
    let largest = corners.iter().fold(0.0, |largest: f64, f| largest.max(f.abs()));
    Quadrant { mx, values, rounding: 16.0 * f64::EPSILON * c * largest }
}

/// The coefficients with a period in x, in y or in both.
pub fn periodic(mx: usize, my: usize, dx: f64, dy: f64, c: f64, (x, y): (bool, bool)) -> Quadrant {
    if !x {
        // A period in y only: the transposed problem has a period in x only.
        let transposed = periodic(my, mx, dy, dx, c, (true, false));
        let offsets = (0..my).flat_map(|ky| (0..mx).map(move |kx| (kx, ky)));
        let values = offsets.map(|(kx, ky)| transposed.values[kx * my + ky]);
        return Quadrant { mx, values: values.collect(), rounding: transposed.rounding };
    }
    let mut values = vec![0.0; mx * my];
    let mut sizes: f64 = 0.0;
    let cosines: Vec<f64> = (0..mx).map(|k| (2.0 * PI * k as f64 / mx as f64).cos()).collect();
    for j in 0..=mx / 2 {
        let t = 2.0 * PI * j as f64 / mx as f64;
        let modes = if j == 0 { uniform_mode(my, dy, c, y) } else { wave_mode(t, my, dx, dy, c, y) };
        // The modes j and mx - j together are one cosine.
        let weight = if j == 0 || 2 * j == mx { 1.0 } else { 2.0 } / mx as f64;
        sizes += weight * modes.iter().fold(0.0, |size: f64, mode| size.max(mode.abs()));
        for (ky, mode) in modes.into_iter().enumerate() {
            for (kx, value) in values[ky * mx..][..mx].iter_mut().enumerate() {
                *value += weight * mode * cosines[(j * kx) % mx];
            }
        }
    }
    // Coefficients are sums of terms with some units of round-off each; the error 7e-18 of the trapezoidal rule is smaller. With two periods the
    // modes of a single element cancel, so the terms count that are as large as a coefficient of the half-space. The uniform mode of two periods is a
    // difference of primitives at two edges, which are as large as the width of the grid.
    let width = if y { my as f64 * dy } else { 0.0 };
    Quadrant { mx, values, rounding: f64::EPSILON * (64.0 * (sizes + c * dx.max(dy)) + 16.0 * c * width / mx as f64) }
}

/// The amplitudes of mode j = 0 for ky = 0..my. `repeats`: the period in y exists as well.
fn uniform_mode(my: usize, dy: f64, c: f64, repeats: bool) -> Vec<f64> {
    let width = my as f64 * dy;
    let primitive = |y: f64| width / (2.0 * PI) * clausen(2.0 * PI * y / width);
    let edge = |ky: usize| primitive((ky as f64 - 0.5) * dy);
    let over_element = |ky: usize| match repeats {
        true => edge(ky + 1) - edge(ky),
        false => dy * mean_of_log(ky as f64, my as f64),
    };
    (0..my).map(|ky| 2.0 * c * over_element(ky)).collect()
}

/// The mean of `log(my/|t|)` over `k - 1/2 < t < k + 1/2`. The difference of the primitive `t (1 + log(my/t))` at both ends would have my times the
/// round-off of a logarithm. So it is written as `log(my/k)` plus a difference of order 1.
fn mean_of_log(k: f64, my: f64) -> f64 {
    if k == 0.0 {
        return 1.0 + (2.0 * my).ln();
    }
    let half = 0.5 / k;
    (my / k).ln() + (1.0 - (k + 0.5) * half.ln_1p() + (k - 0.5) * (-half).ln_1p())
}

/// Clausen's function, `-integral from 0 to the angle of log |2 sin(s/2)| ds`, by its series about 0.
fn clausen(angle: f64) -> f64 {
    let t = angle - (angle / (2.0 * PI)).round() * 2.0 * PI;
    if t == 0.0 {
        return 0.0;
    }
    // The coefficients of the series have Bernoulli's numbers, |B_2k|/(2k)! = 2 zeta(2k)/(2 pi)^2k. As |t/2 pi| <= 1/2, the error after 30 terms is
    // 4^-30.
    let term = |k: i32| {
        let zeta: f64 = 1.0 + (2..40).map(|n| f64::from(n).powi(-2 * k)).sum::<f64>() + zeta_tail(40.0, 2 * k);
        zeta * (t / (2.0 * PI)).powi(2 * k) / f64::from(k * (2 * k + 1))
    };
    t * (1.0 - t.abs().ln() + (1..=30).map(term).sum::<f64>())
}

/// The sum over n >= first of n^-s, by the Euler-Maclaurin formula. From first = 40 on, the first term that is left out is below 1e-17.
fn zeta_tail(first: f64, s: i32) -> f64 {
    let r = f64::from(s);
    first.powi(1 - s) / (r - 1.0) + 0.5 * first.powi(-s) + r / 12.0 * first.powi(-s - 1)
        - r * (r + 1.0) * (r + 2.0) / 720.0 * first.powi(-s - 3)
        + r * (r + 1.0) * (r + 2.0) * (r + 3.0) * (r + 4.0) / 30240.0 * first.powi(-s - 5)
}

/// The amplitudes of the mode with 0 < t <= pi for ky = 0..my. `repeats`: the period in y exists as well.
///
/// With `K0(x) = integral over s > 0 of e^(-x cosh s)` the integral over the element is elementary. The trapezoidal rule in s with a step of 1/4 has
/// an error of e^(-4 pi^2) = 7e-18.
fn wave_mode(t: f64, my: usize, dx: f64, dy: f64, c: f64, repeats: bool) -> Vec<f64> {
    const STEP: f64 = 0.25;
    const NEGLIGIBLE: f64 = 80.0;
    let mut rows = vec![0.0; my];
    rows[0] = 2.0 * PI * c * alternating(t) * 2.0 * (0.5 * t).sin() * dx;
    for m in (0..).flat_map(|m| [m, -1 - m]).map(f64::from) {
        let shifted = t + 2.0 * PI * m;
        let w = shifted.abs() / dx;
        if m > 0.0 && w * dy > NEGLIGIBLE {
            break;
        }
        let sinc = (0.5 * shifted).sin() / (0.5 * shifted);
        for s in (0..).map(|i| STEP * f64::from(i)) {
            let x = w * dy * s.cosh();
            if 0.5 * x > NEGLIGIBLE {
                break;
            }
            let weight = 2.0 * c * sinc / (w * s.cosh()) * if s == 0.0 { 0.5 * STEP } else { STEP };
            // The sum over the images at distances my, 2 my, ...
            let images = if repeats { -1.0 / (-x * my as f64).exp_m1() } else { 1.0 };
            let edges = -(-x).exp_m1();
            let at = |k: usize| (-x * (k as f64 - 0.5)).exp() * edges * images;
            rows[0] -= 2.0 * weight * (-0.5 * x).exp();
            if repeats {
                rows[0] += 2.0 * weight * at(my);
            }
            // Rows beyond the reach have less than e^-80 of this term.
            let reach = ((NEGLIGIBLE / x) as usize).saturating_add(1);
            for ky in 1..my.min(reach + 1) {
                rows[ky] += weight * at(ky);
                if repeats {
                    rows[my - ky] += weight * at(ky);
                }
            }
        }
    }
    rows
}

/// `sum over all m of (-1)^m sign(t + 2 pi m)/(t + 2 pi m)^2`. The alternating sum converges by repeated means of neighbouring partial sums. After 40
/// means the error is 2^-40 of a term of 1e-4.
fn alternating(t: f64) -> f64 {
    let term = |m: i32| {
        let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
        let m = f64::from(m);
        sign * ((t + 2.0 * PI * m).powi(-2) + (2.0 * PI - t + 2.0 * PI * m).powi(-2))
    };
    let first: f64 = (0..40).map(term).sum();
    let mut sums: Vec<f64> = (40..80).map(|last| first + (40..last).map(term).sum::<f64>()).collect();
    while sums.len() > 1 {
        sums = sums.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    }
    sums[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integral of 1/rho over an element by the midpoint rule with m x m points. The relative error is about 1/m^2.
    fn by_midpoints(x: f64, y: f64, dx: f64, dy: f64, m: usize) -> f64 {
        let at = |i: usize, d: f64| ((i as f64 + 0.5) / m as f64 - 0.5) * d;
        let points = (0..m * m).map(|i| (x - at(i % m, dx)).hypot(y - at(i / m, dy)).recip());
        points.sum::<f64>() * dx * dy / (m * m) as f64
    }

    #[test]
    fn the_closed_form_is_the_integral() {
        let quadrant = free(5, 4, 0.7, 0.4, 1.0);
        for (kx, ky) in [(1, 0), (0, 1), (3, 2), (4, 3)] {
            let expected = by_midpoints(0.7 * kx as f64, 0.4 * ky as f64, 0.7, 0.4, 400);
            assert!((quadrant.at(kx, ky) - expected).abs() <= 1e-4 * expected, "({kx}, {ky})");
        }
        // At the centre of a square of side a the integral is 4 a asinh 1.
        assert!((free(1, 1, 2.0, 2.0, 1.0).at(0, 0) - 8.0 * 1f64.asinh()).abs() <= 1e-14);
    }

    /// Compares the mean of the logarithm with the midpoint rule; far away, with its expansion `log(my/k) + 1/(24 k^2)`, whose next term is `7/(960
    /// k^4)`.
    #[test]
    fn the_mean_of_the_logarithm_is_right_near_and_far() {
        for k in [1.0, 2.0, 5.0] {
            let at = |i: u32| (9.0 / (k - 0.5 + (f64::from(i) + 0.5) / 1000.0)).ln();
            let mean = (0..1000).map(at).sum::<f64>() / 1000.0;
            // The error of the midpoint rule is 1/24 of the square of a step, times the second derivative, which is at most 4.
            assert!((mean_of_log(k, 9.0) - mean).abs() <= 2e-7, "{k}");
        }
        for k in [1e3, 1e6, 1e9] {
            let expected = (2e9f64 / k).ln() + 1.0 / (24.0 * k * k);
            assert!((mean_of_log(k, 2e9) - expected).abs() <= 4.0 * f64::EPSILON * expected.max(1.0), "{k}");
        }
    }

    /// A difference of two periodic coefficients is a convergent sum over images. With one period, the rest beyond n periods is `1/n^2` of the first
    /// image. With two periods, sums over squares of n images converge more slowly.
    #[test]
    fn periodic_coefficients_are_sums_over_images() {
        let (mx, my, dx, dy, images) = (6, 5, 0.5, 0.6, 60i64);
        for period in [(true, false), (false, true), (true, true)] {
            let quadrant = periodic(mx, my, dx, dy, 1.0, period);
            let reach = |repeats: bool| if repeats { images } else { 0 };
            let large = free(mx * (images as usize + 1), my * (images as usize + 1), dx, dy, 1.0);
            let sum = |kx: i64, ky: i64| {
                let mut sum = 0.0;
                for n in -reach(period.0)..=reach(period.0) {
                    for m in -reach(period.1)..=reach(period.1) {
                        sum += large.at(kx + n * mx as i64, ky + m * my as i64);
                    }
                }
                sum
            };
            let zero = sum(0, 0);
            for (kx, ky) in [(1, 0), (0, 1), (3, 2), (2, 2)] {
                let expected = sum(kx, ky) - zero;
                let found = quadrant.at(kx, ky) - quadrant.at(0, 0);
                assert!(
                    (found - expected).abs() <= 5e-3 * expected.abs(),
                    "{period:?} ({kx}, {ky}): {found}, {expected}"
                );
            }
        }
    }

    #[test]
    fn the_mean_displacement_of_two_periods_is_zero() {
        let (mx, my) = (6, 5);
        let quadrant = periodic(mx, my, 0.5, 0.6, 1.0, (true, true));
        let sum: f64 = quadrant.values.iter().sum();
        assert!(sum.abs() <= (mx * my) as f64 * quadrant.rounding, "{sum}");
        // The coefficients are periodic: offsets k and m - k are equal.
        for (kx, ky) in [(1, 2), (2, 4), (3, 1)] {
            let mirrored = quadrant.at(mx as i64 - kx, my as i64 - ky);
            assert!((quadrant.at(kx, ky) - mirrored).abs() <= 2.0 * quadrant.rounding);
        }
    }
}
