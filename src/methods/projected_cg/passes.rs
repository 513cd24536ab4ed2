//! The passes over the contact area, each over its segments.

use super::energy::Energy;
use super::extension::Area;
use super::vectors::Iteration;
use crate::contact::State;
use crate::operator::fft::Real;
use crate::scene::Load;

/// What becomes of u: factor (u + alpha q + gamma w + A d), w of the known change.
#[derive(Clone, Copy)]
pub(super) struct Update {
    pub(super) alpha: f64,
    pub(super) gamma: f64,
    /// Whether z holds A d.
    pub(super) settled: bool,
    pub(super) factor: f64,
}

impl Default for Update {
    fn default() -> Update {
        Update { alpha: 0.0, gamma: 0.0, settled: false, factor: 1.0 }
    }
}

/// Sums over C: (r, t), (t, q), (t, t), of |t|, (p, p); and (r, d), (q, d), 0 where no change is known.
pub(super) struct Step {
    pub(super) rt: f64,
    pub(super) tq: f64,
    pub(super) tt: f64,
    pub(super) t1: f64,
    pub(super) pp: f64,
    pub(super) rd: f64,
    pub(super) qd: f64,
    pub(super) energy: Option<Energy>,
}

impl Step {
    /// The 2-norm of the change of p, at most: the sum of what the step along t, that along d, of which the length is given, and the scaling change.
    pub(super) fn change(&self, alpha: f64, along_d: f64, factor: f64) -> f64 {
        alpha.abs() * self.tt.sqrt() + along_d + (factor - 1.0).abs() * self.pp.sqrt()
    }
}

impl<T: Real> Iteration<T> {
    /// The runs of a contact area of which nothing is known.
    pub(super) fn find_contact(&mut self, state: &State) {
        self.runs.change_all();
        self.runs.find(&state.contact);
    }

    /// With a prescribed force, where no change is known: the approach is the mean over C of h + u, u as `update` will leave it.
    pub(super) fn fit_approach(&mut self, state: &mut State, update: &Update) {
        if matches!(state.load, Load::Approach(_)) {
            return;
        }
        let (q, z, Update { alpha, settled, factor, .. }) = (&self.q, &self.z, *update);
        let [sum] = self.runs.sum(
            #[inline(always)]
            |block, sums| {
                for (run, _) in block.runs() {
                    let (h, u, q, z) = (&state.h[run.clone()], &state.u[run.clone()], &q[run.clone()], &z[run]);
                    sums.add([h, u], [q, z], |[h, u], [q, z]| {
                        let repair = if settled { z } else { 0.0 };
                        [h + factor * (u + alpha * q + repair)]
                    });
                }
            },
        );
        if self.runs.count() > 0 {
            state.approach = sum / self.runs.count() as f64 + self.limits.shift;
        }
    }

    /// z = r = -e on C, 0 outside; the relative residual.
    pub(super) fn residual(&mut self, state: &State) -> f64 {
        let approach = state.approach;
        let [rr, hh] = self.runs.sum_changing(
            &mut self.z,
            #[inline(always)]
            |block, z, sums| {
                z.fill(T::zero());
                for (run, local) in block.runs() {
                    let (h, u, z) = (&state.h[run.clone()], &state.u[run], &mut z[local]);
                    z.iter_mut().zip(h).zip(u).for_each(|((z, h), u)| *z = T::of(-(h - approach + u)));
                    sums.add::<T, 2, 0>([h, u], [], |[h, u], []| {
                        let (distance, e) = (h - approach, h - approach + u);
                        [e * e, distance * distance]
                    });
                }
            },
        );
        self.limits.residual = rr;
        if rr == 0.0 {
            0.0
        } else {
            (rr / hh).sqrt()
        }
    }

    /// Whether directions need not carry force: p is scaled to it, or to the least energy, or moves along a known change.
    fn is_without_force(&self, state: &State) -> bool {
        matches!(state.load, Load::Force(_)) || self.known.is_there() || self.is_scaled
    }

    /// z = E^T M E r, r being what z holds (module `extension`).
    pub(super) fn precondition(&mut self, state: &State) {
        let without_force = self.is_without_force(state);
        if let Some(m) = &mut self.preconditioner {
            let area = Area { contact: &state.contact, segments: &self.runs };
            m.apply(&mut self.z, (area, without_force), &mut self.extension, &mut self.workspace);
        }
    }

    /// t = z + beta t on C, 0 outside; of mean zero over C, but for what is missing, where it need not carry force; held back by the forecast,
    /// if there is one, at p = 0. `tq` is (t, q) of the last direction, 0 if there is none.
    pub(super) fn direct(&mut self, state: &State, tq: f64, forecast: Option<f64>) {
        let without_force = self.is_without_force(state);
        let missing = self.limits.missing / forecast.unwrap_or(1.0);
        let (mean, beta) = self.conjugate(without_force.then_some(missing), tq);
        let (z, mean, beta) = (&self.z, T::of(mean), T::of(beta));
        let [] = self.runs.sum_changing(
            &mut self.t,
            #[inline(always)]
            |block, t, _| {
                for (run, local) in block.runs() {
                    let (p, z, t) = (&state.p[run.clone()], &z[run], &mut t[local]);
                    t.iter_mut().zip(z).for_each(|(t, z)| *t = *z - mean + beta * *t);
                    if let Some(forecast) = forecast {
                        hold_back(p, t, forecast);
                    }
                }
            },
        );
    }

    /// The mean over C that is taken from z + beta t, and beta. Directions without force have the sum `missing`; others may have any.
    fn conjugate(&mut self, missing: Option<f64>, tq: f64) -> (f64, f64) {
        if missing.is_none() && tq <= 0.0 {
            return (0.0, 0.0);
        }
        let (t, z, q) = (&self.t, &self.z, &self.q);
        let [t1, z1, q1, zq] = self.runs.sum(
            #[inline(always)]
            |block, sums| {
                for (run, _) in block.runs() {
                    let (t, z, q) = (&t[run.clone()], &z[run.clone()], &q[run]);
                    sums.add([], [t, z, q], |[], [t, z, q]| [t, z, q, z * q]);
                }
            },
        );
        let count = self.runs.count() as f64;
        let mean = if missing.is_some() { z1 / count } else { 0.0 };
        let beta = if tq > 0.0 { (-(zq - mean * q1) / tq).max(0.0) } else { 0.0 };
        (missing.map_or(0.0, |missing| (z1 + beta * t1 - missing) / count), beta)
    }

    /// The sums over C that the step length needs, and those of the energy where p is scaled.
    pub(super) fn step(&mut self, state: &State) -> Step {
        let (t, q, approach) = (&self.t, &self.q, state.approach);
        if self.known.is_there() {
            return self.step_beside_change(state);
        }
        if !self.is_scaled {
            let [rt, tq, tt, t1, pp] = self.runs.sum(
                #[inline(always)]
                |block, sums| {
                    for (run, _) in block.runs() {
                        let (h, u, p) = (&state.h[run.clone()], &state.u[run.clone()], &state.p[run.clone()]);
                        let (t, q) = (&t[run.clone()], &q[run]);
                        sums.add([h, u, p], [t, q], |[h, u, p], [t, q]| {
                            let e = h - approach + u;
                            [-e * t, t * q, t * t, t.abs(), p * p]
                        });
                    }
                },
            );
            return Step { rt, tq, tt, t1, pp, rd: 0.0, qd: 0.0, energy: None };
        }
        let [tq, tt, t1, pp, pq, rt, pd, td, pu] = self.runs.sum(
            #[inline(always)]
            |block, sums| {
                for (run, _) in block.runs() {
                    let (h, u, p) = (&state.h[run.clone()], &state.u[run.clone()], &state.p[run.clone()]);
                    let (t, q) = (&t[run.clone()], &q[run]);
                    sums.add_from(0, [p], [t, q], |[p], [t, q]| [t * q, t * t, t.abs(), p * p, p * q]);
                    sums.add_from(5, [h, u, p], [t], |[h, u, p], [t]| {
                        let depth = approach - h;
                        [(depth - u) * t, p * depth, t * depth, p * u]
                    });
                }
            },
        );
        let energy = Energy { pd, td, pu, pq_tu: pq + td - rt, tq };
        Step { rt, tq, tt, t1, pp, rd: 0.0, qd: 0.0, energy: Some(energy) }
    }

    /// p = factor p on C, and the debts likewise.
    pub(super) fn scale(&mut self, state: &mut State, factor: f64) {
        self.debts.iter_mut().for_each(|debt| debt.1 *= factor);
        let [] = self.runs.sum_changing(
            &mut state.p,
            #[inline(always)]
            |block, p, _| {
                for (_, local) in block.runs() {
                    p[local].iter_mut().for_each(|p| *p *= factor);
                }
            },
        );
    }
}

/// t where the step of the forecast would take p below 0: to 0. Without a branch, so that the compiler can vectorise.
#[inline(always)]
fn hold_back<T: Real>(p: &[f64], t: &mut [T], forecast: f64) {
    for (t, p) in t.iter_mut().zip(p) {
        let held = T::of(-p / forecast);
        *t = if p + forecast * t.to_double() < 0.0 { held } else { *t };
    }
}
