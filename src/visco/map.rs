//! One step of time of one body, by any of three forms:
//!
//! * relaxation: u is linear in the step, so a held approach is exact if this body alone gives way, or both relax alike;
//! * creep: w is linear in the step, so a held load is exact where pressures are constant;
//! * backward Euler, of first order, as in tamaas (Frérot et al. 2020).
//!
//! With `e = exp(-x)` and `g = (1 - e)/x` the first two are exponential integrators: only the linear interpolation limits the step.

use super::modes::Mode;
use super::series::Series;

/// The quantity that is linear in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The displacement.
    Relaxation,
    /// The pressures.
    Creep,
    /// Neither: both have their values at the end of the step.
    BackwardEuler,
}

/// `q after = m q + before w0 + now w`, `u = w + r.q`, for a body with `w0` before the step.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    r: Vec<f64>,
    /// `[k][l]`.
    m: Vec<f64>,
    before: Vec<f64>,
    now: Vec<f64>,
    /// `r.m`, `r.before`, `r.now`.
    of_q: Vec<f64>,
    of_before: f64,
    of_now: f64,
}

impl Map {
    /// A step of `dt` >= 0. For dt = 0 all forms agree: the instantaneous response.
    pub fn new(series: &Series, dt: f64, form: Form) -> Map {
        match form {
            Form::Creep if dt > 0.0 => Map::creep(series, dt),
            Form::BackwardEuler => Map::relaxation(series, |t| {
                let x = dt / t;
                (1.0 / (1.0 + x), 1.0 - 1.0 / (1.0 + x), 0.0)
            }),
            _ => Map::relaxation(series, |t| weights(dt / t)),
        }
    }

    /// `q after = e q + (g - e) u0 + (1 - g) u` of each branch; `weights` has `(e, 1 - g, g - e)` of a time.
    fn relaxation(series: &Series, weights: impl Fn(f64) -> (f64, f64, f64)) -> Map {
        let (r, n) = (series.fractions.clone(), series.len());
        let weights: Vec<(f64, f64, f64)> = series.times.iter().map(|t| weights(*t)).collect();
        let sum = |of: fn(&(f64, f64, f64)) -> f64| r.iter().zip(&weights).map(|(r, w)| r * of(w)).sum::<f64>();
        // u (1 - sum of r (1 - g)) = w + sum of r (e q + (g - e) u0); the stiffness is summed without differences.
        let (of_u0, stiffness) = (sum(|w| w.2), series.rest + sum(|w| w.0 + w.2));
        let mut map = Map::empty(r);
        for (k, (e, now, before)) in weights.iter().enumerate() {
            for (l, of_l) in weights.iter().enumerate() {
                let u = map.r[l] * (of_l.0 + of_u0) / stiffness;
                map.m[k * n + l] = if k == l { *e } else { 0.0 } + before * map.r[l] + now * u;
            }
            map.before[k] = before + now * of_u0 / stiffness;
            map.now[k] = now / stiffness;
        }
        map.summed()
    }

    /// `v after = e v + dt/N (psi0 w0 + psi1 w)` of each mode.
    fn creep(series: &Series, dt: f64) -> Map {
        let (r, t, n) = (series.fractions.clone(), &series.times, series.len());
        let mut map = Map::empty(r);
        for mode in Mode::of(series) {
            let x = mode.rate * dt;
            let (e, now, before) = weights(x);
            // 1/rate of slow modes overflows.
            let (now, before) = match x < SERIES_BELOW {
                true => (dt * slow(x).0, dt * slow(x).1),
                false => (now / mode.rate, before / mode.rate),
            };
            for k in 0..n {
                let shape = mode.shape[k] / mode.inertia;
                for (l, t) in t.iter().enumerate() {
                    map.m[k * n + l] += shape * e * map.r[l] * t * mode.shape[l];
                }
                map.before[k] += shape * before;
                map.now[k] += shape * now;
            }
        }
        map.summed()
    }

    fn empty(r: Vec<f64>) -> Map {
        let n = r.len();
        let zeros = || vec![0.0; n];
        Map { m: vec![0.0; n * n], before: zeros(), now: zeros(), of_q: zeros(), of_before: 0.0, of_now: 0.0, r }
    }

    fn summed(mut self) -> Map {
        let n = self.r.len();
        let dot = |of: &dyn Fn(usize) -> f64| (0..n).map(|k| self.r[k] * of(k)).sum::<f64>();
        let of_q = (0..n).map(|l| dot(&|k| self.m[k * n + l])).collect();
        let (of_before, of_now) = (dot(&|k| self.before[k]), dot(&|k| self.now[k]));
        self.of_q = of_q;
        (self.of_before, self.of_now) = (of_before, of_now);
        self
    }

    /// Number of branches.
    pub fn branches(&self) -> usize {
        self.r.len()
    }

    /// u over w.
    pub fn compliance(&self) -> f64 {
        1.0 + self.of_now
    }

    /// u after the step for w = 0.
    #[inline]
    pub fn history(&self, q: &[f64], w0: f64) -> f64 {
        self.of_q.iter().zip(q).map(|(of, q)| of * q).sum::<f64>() + self.of_before * w0
    }

    /// q after the step.
    #[inline]
    pub fn advance(&self, q: &[f64], w0: f64, w: f64, after: &mut [f64]) {
        let n = self.r.len();
        for (k, after) in after.iter_mut().enumerate() {
            let of_q: f64 = self.m[k * n..][..n].iter().zip(q).map(|(m, q)| m * q).sum();
            *after = of_q + self.before[k] * w0 + self.now[k] * w;
        }
    }
}

/// x below which differences are computed by series.
const SERIES_BELOW: f64 = 0.1;

/// `(exp(-x), 1 - g, g - exp(-x))` with `g = (1 - exp(-x))/x`.
fn weights(x: f64) -> (f64, f64, f64) {
    if x < SERIES_BELOW {
        let (now, before) = slow(x);
        return ((-x).exp(), x * now, x * before);
    }
    let (e, g) = ((-x).exp(), -(-x).exp_m1() / x);
    (e, 1.0 - g, g - e)
}

/// `(1 - g)/x` and `(g - exp(-x))/x`, by their series: `sum of (-x)^j/(j + 2)!`, and the same terms times `j + 1`.
fn slow(x: f64) -> (f64, f64) {
    let (mut term, mut now, mut before) = (0.5, 0.0, 0.0);
    for j in 0..10 {
        now += term;
        before += term * f64::from(j + 1);
        term *= -x / f64::from(j + 3);
    }
    (now, before)
}
