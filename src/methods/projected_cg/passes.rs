//! The passes over the contact area, each over its segments.

use super::extension::Area;
use super::vectors::Iteration;
use crate::contact::{AdmissibleSet, State};
use crate::operator::fft::Real;
use crate::scene::Load;

/// What becomes of u: factor (u + alpha q + A d).
#[derive(Clone, Copy)]
pub(super) struct Update {
    pub(super) alpha: f64,
    /// Whether z holds A d.
    pub(super) settled: bool,
    pub(super) factor: f64,
}

impl Default for Update {
    fn default() -> Update {
        Update { alpha: 0.0, settled: false, factor: 1.0 }
    }
}

/// Sums over C: (r, t), (t, q), (t, t), of |t|, (p, p).
pub(super) struct Step {
    pub(super) rt: f64,
    pub(super) tq: f64,
    pub(super) tt: f64,
    pub(super) t1: f64,
    pub(super) pp: f64,
}

impl<T: Real> Iteration<T> {
    /// The runs of a contact area of which nothing is known.
    pub(super) fn find_contact(&mut self, state: &State) {
        self.runs.change_all();
        self.runs.find(&state.contact);
    }

    /// With a prescribed force: the approach is the mean over C of h + u, u as `update` will leave it.
    pub(super) fn fit_approach(&mut self, state: &mut State, update: &Update) {
        if matches!(state.load, Load::Approach(_)) {
            return;
        }
        let (q, z, Update { alpha, settled, factor }) = (&self.q, &self.z, *update);
        let [sum] = self.runs.sum(|block, sums| {
            for (run, _) in block.runs() {
                let (h, u, q, z) = (&state.h[run.clone()], &state.u[run.clone()], &q[run.clone()], &z[run]);
                sums.add(h.len(), |i| {
                    let repair = if settled { z[i].to_double() } else { 0.0 };
                    [h[i] + factor * (u[i] + alpha * q[i].to_double() + repair)]
                });
            }
        });
        if self.runs.count() > 0 {
            state.approach = sum / self.runs.count() as f64 + self.limits.shift;
        }
    }

    /// z = r = -e on C, 0 outside; the relative residual.
    pub(super) fn residual(&mut self, state: &State) -> f64 {
        let approach = state.approach;
        let [rr, hh] = self.runs.sum_changing(&mut self.z, |block, z, sums| {
            z.fill(T::zero());
            for (run, local) in block.runs() {
                let (h, u, z) = (&state.h[run.clone()], &state.u[run], &mut z[local]);
                sums.add(h.len(), |i| {
                    let distance = h[i] - approach;
                    let e = distance + u[i];
                    z[i] = T::of(-e);
                    [e * e, distance * distance]
                });
            }
        });
        self.limits.residual = rr;
        if rr == 0.0 {
            0.0
        } else {
            (rr / hh).sqrt()
        }
    }

    /// z = E^T M E r, r being what z holds (module `extension`).
    pub(super) fn precondition(&mut self, state: &State) {
        if let Some(m) = &mut self.preconditioner {
            let without_force = matches!(state.load, Load::Force(_)) || self.is_scaled;
            let area = Area { contact: &state.contact, segments: &self.runs };
            m.apply(&mut self.z, (area, without_force), &mut self.extension, &mut self.workspace);
        }
    }

    /// t = z + beta t on C, 0 outside; of mean zero over C, but for what is missing, where it need not carry force; held back by the forecast,
    /// if there is one, at p = 0. `tq` is (t, q) of the last direction, 0 if there is none.
    pub(super) fn direct(&mut self, state: &State, tq: f64, forecast: Option<f64>) {
        let without_force = matches!(state.load, Load::Force(_)) || self.known.is_there() || self.is_scaled;
        let (mean, beta) = self.conjugate(without_force, tq);
        let (z, mean, beta) = (&self.z, T::of(mean), T::of(beta));
        let held = |p: f64, t: T| match forecast {
            Some(forecast) if p + forecast * t.to_double() < 0.0 => T::of(-p / forecast),
            _ => t,
        };
        let [sum] = self.runs.sum_changing(&mut self.t, |block, t, sums| {
            for (run, local) in block.runs() {
                let (p, z, t) = (&state.p[run.clone()], &z[run], &mut t[local]);
                sums.add(z.len(), |i| {
                    let direction = z[i] - mean + beta * t[i];
                    t[i] = if without_force { direction } else { held(p[i], direction) };
                    [direction.to_double()]
                });
            }
        });
        if without_force {
            let missing = self.limits.missing / forecast.unwrap_or(1.0);
            let mean = T::of((sum - missing) / self.runs.count() as f64);
            let [] = self.runs.sum_changing(&mut self.t, |block, t, _| {
                for (run, local) in block.runs() {
                    for (t, p) in t[local].iter_mut().zip(&state.p[run]) {
                        *t = held(*p, *t - mean);
                    }
                }
            });
        }
    }

    /// The mean of z over C for directions without force, else 0, and beta.
    fn conjugate(&mut self, without_force: bool, tq: f64) -> (f64, f64) {
        if !without_force && tq <= 0.0 {
            return (0.0, 0.0);
        }
        let (z, q) = (&self.z, &self.q);
        let [z1, q1, zq] = self.runs.sum(|block, sums| {
            for (run, _) in block.runs() {
                let (z, q) = (&z[run.clone()], &q[run]);
                sums.add(z.len(), |i| {
                    let (z, q) = (z[i].to_double(), q[i].to_double());
                    [z, q, z * q]
                });
            }
        });
        let mean = if without_force { z1 / self.runs.count() as f64 } else { 0.0 };
        (mean, if tq > 0.0 { (-(zq - mean * q1) / tq).max(0.0) } else { 0.0 })
    }

    /// The sums over C that the step length needs.
    pub(super) fn step(&mut self, state: &State) -> Step {
        let (t, q) = (&self.t, &self.q);
        let [rt, tq, tt, t1, pp] = self.runs.sum(|block, sums| {
            for (run, _) in block.runs() {
                let (h, u, p) = (&state.h[run.clone()], &state.u[run.clone()], &state.p[run.clone()]);
                let (t, q) = (&t[run.clone()], &q[run]);
                sums.add(h.len(), |i| {
                    let (t, e) = (t[i].to_double(), h[i] - state.approach + u[i]);
                    [-e * t, t * q[i].to_double(), t * t, t.abs(), p[i] * p[i]]
                });
            }
        });
        Step { rt, tq, tt, t1, pp }
    }

    /// By approach: scales p, and the debts with it, to the least energy `(p, u)/2 + (p, h - approach)`, u as `update` will leave it; `update` takes
    /// the factor. It costs no product. Where p moves along a known change instead, or pressures have reached a limit, only a truncation that a
    /// product has paid is followed by it.
    pub(super) fn least_energy<S: AdmissibleSet>(&mut self, state: &mut State, _: S, update: &mut Update) {
        self.is_scaled = false;
        let limited = S::LIMITED && state.reached_limit;
        let scales = !self.known.is_there() && !limited;
        let may_scale = scales || update.settled && !(limited && state.has_limited());
        if matches!(state.load, Load::Force(_)) || S::FIXED || !may_scale {
            return;
        }
        self.runs.find(&state.contact);
        let (q, z, Update { alpha, settled, .. }) = (&self.q, &self.z, *update);
        let [work, energy] = self.runs.sum(|block, sums| {
            for (run, _) in block.runs() {
                let (h, u, p) = (&state.h[run.clone()], &state.u[run.clone()], &state.p[run.clone()]);
                let (q, z) = (&q[run.clone()], &z[run]);
                sums.add(h.len(), |i| {
                    let repair = if settled { z[i].to_double() } else { 0.0 };
                    let u = u[i] + alpha * q[i].to_double() + repair;
                    [p[i] * (state.approach - h[i]), p[i] * u]
                });
            }
        });
        let factor = work / energy;
        if factor.is_finite() && factor > 0.0 {
            self.is_scaled = scales;
            update.factor = factor;
            self.scale(state, factor);
        }
    }

    /// p = factor p on C, and the debts likewise.
    pub(super) fn scale(&mut self, state: &mut State, factor: f64) {
        self.debts.iter_mut().for_each(|debt| debt.1 *= factor);
        let [] = self.runs.sum_changing(&mut state.p, |block, p, _| {
            for (_, local) in block.runs() {
                p[local].iter_mut().for_each(|p| *p *= factor);
            }
        });
    }
}
