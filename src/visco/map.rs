//! One step of time of one body (see [`visco`](super) for u, w and q). It has three forms:
//!
//! * relaxation: u is taken as linear in time within the step. A constant approach is then exact if only this body is deformable, or if both bodies
//!   relax in the same way.
//! * creep: w is taken as linear in time. A constant load is then exact where pressures are constant.
//! * backward Euler, a method of first order, as in tamaas (Frérot et al. 2020).
//!
//! The first two are exponential integrators, with `e = exp(-x)` and `g = (1 - e)/x` for x = dt over the time of a branch or mode. Only the linear
//! interpolation limits the length of their steps.

use super::modes::Mode;
use super::series::Series;

/// The quantity that is taken as linear in time within a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The displacement u.
    Relaxation,
    /// The instantaneous displacement w, which is linear in the pressures.
    Creep,
    /// None: u has its value at the end of the step.
    BackwardEuler,
}

/// The linear map of a step: `q after = m q + before w0 + now w` and `u = w + r.(q after)`, where w0 is w before the step.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    r: Vec<f64>,
    /// `[k][l]`.
    m: Vec<f64>,
    before: Vec<f64>,
    now: Vec<f64>,
    /// `r.m`: the derivatives of u by q.
    of_q: Vec<f64>,
    /// `r.before`: the derivative of u by w0.
    of_before: f64,
    /// `r.now`: the derivative of u by w, less 1.
    of_now: f64,
}

impl Map {
    /// The map of a step of the duration `dt` >= 0. For dt = 0 all forms give the instantaneous response.
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

    /// The map by `q after = e q + (g - e) u0 + (1 - g) u` of each branch, where u0 is u before the step. `weights(t)` returns `(e, 1 - g, g - e)`
    /// for the time t of a branch.
    fn relaxation(series: &Series, weights: impl Fn(f64) -> (f64, f64, f64)) -> Map {
        let (r, n) = (series.fractions.clone(), series.len());
        let weights: Vec<(f64, f64, f64)> = series.times.iter().map(|t| weights(*t)).collect();
        let sum = |of: fn(&(f64, f64, f64)) -> f64| r.iter().zip(&weights).map(|(r, w)| r * of(w)).sum::<f64>();
        // u (1 - sum of r (1 - g)) = w + sum of r (e q + (g - e) u0). The factor of u is summed without differences.
        let (of_u0, factor_of_u) = (sum(|(_, _, before)| *before), series.rest + sum(|(e, _, before)| e + before));
        let mut map = Map::empty(r);
        for (k, (e, now, before)) in weights.iter().enumerate() {
            for (l, (e_l, _, _)) in weights.iter().enumerate() {
                let u = map.r[l] * (e_l + of_u0) / factor_of_u;
                map.m[k * n + l] = if k == l { *e } else { 0.0 } + before * map.r[l] + now * u;
            }
            map.before[k] = before + now * of_u0 / factor_of_u;
            map.now[k] = now / factor_of_u;
        }
        map.summed()
    }

    /// The map by `v after = e v + ((g - e) w0 + (1 - g) w)/(lambda N)` of each [mode](super::modes).
    fn creep(series: &Series, dt: f64) -> Map {
        let (r, t, n) = (series.fractions.clone(), &series.times, series.len());
        let mut map = Map::empty(r);
        for mode in Mode::of(series) {
            let x = mode.rate * dt;
            let (e, now, before) = weights(x);
            // Divided by the rate, by series for slow modes: 1/rate may overflow.
            let (now, before) = match x < SERIES_BELOW {
                true => {
                    let (now, before) = slow(x);
                    (dt * now, dt * before)
                }
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

    /// A map whose coefficients are 0.
    fn empty(r: Vec<f64>) -> Map {
        let n = r.len();
        let zeros = || vec![0.0; n];
        Map { m: vec![0.0; n * n], before: zeros(), now: zeros(), of_q: zeros(), of_before: 0.0, of_now: 0.0, r }
    }

    /// Computes the derivatives of u from those of q.
    fn summed(mut self) -> Map {
        let n = self.r.len();
        let dot = |of: &dyn Fn(usize) -> f64| (0..n).map(|k| self.r[k] * of(k)).sum::<f64>();
        let of_q = (0..n).map(|l| dot(&|k| self.m[k * n + l])).collect();
        let (of_before, of_now) = (dot(&|k| self.before[k]), dot(&|k| self.now[k]));
        self.of_q = of_q;
        (self.of_before, self.of_now) = (of_before, of_now);
        self
    }

    /// The number of branches.
    pub fn branches(&self) -> usize {
        self.r.len()
    }

    /// The derivative of u by w: the compliance in the step, relative to the instantaneous one.
    pub fn compliance(&self) -> f64 {
        1.0 + self.of_now
    }

    /// u after the step for w = 0: the displacement that is left of the history.
    #[inline]
    pub fn history(&self, q: &[f64], w0: f64) -> f64 {
        self.of_q.iter().zip(q).map(|(of, q)| of * q).sum::<f64>() + self.of_before * w0
    }

    /// Computes q after the step.
    #[inline]
    pub fn advance(&self, q: &[f64], w0: f64, w: f64, after: &mut [f64]) {
        let n = self.r.len();
        for (k, after) in after.iter_mut().enumerate() {
            let of_q: f64 = self.m[k * n..][..n].iter().zip(q).map(|(m, q)| m * q).sum();
            *after = of_q + self.before[k] * w0 + self.now[k] * w;
        }
    }
}

/// For smaller x the differences 1 - g and g - exp(-x) are computed by series, because they would cancel.
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
