//! The iteration with pressure limits, `0 <= p <= p_max`.
//!
//! The limit is a second bound: steps are clipped and pressures truncated at both bounds. Elements truncated at their limit enter C again if e > 0.
//!
//! *Prescribed force.* Pressures at their limit cannot be scaled up. The missing force m is
//!
//! ```text
//! m = force/(dx dy) - sum of p
//! ```
//!
//! The next direction restores the missing force, evenly over C: its sum is m/alpha'. The approach changes by m/(sum of p) times the mean depth
//! (p, approach - h)/(sum of p), as if depth were proportional to force. Otherwise a thin C between elements at their limit and the exterior area
//! would stay in place while C carries all of m. If p carries far more than the force, all of p is scaled down, which no limit forbids, and elements
//! at their limit enter C.
//!
//! *Waiting.* Clipped elements go to their limit and enter C again if that was wrong. While the residual on C is far above the e of these elements,
//! they wait at their limit: directions stay conjugate, and C converges first ("proportioning", Dostal, *Optimal Quadratic Programming Algorithms*
//! (2009), section 5.8).
//!
//! *Prescribed approach.* No scaling prevents C from oscillating. Instead the step is shortened to the least energy whenever a product has just
//! corrected all of u, because the energies of both ends of the step are then known exactly. A large deferred correction is included in the next
//! product as a whole, by a step of the forecast length.

use super::formulas::Carried;
use super::formulas::CLIPPED_SHARE;
use super::passes::none;
use super::step_sums::Update;
use super::vectors::{Iteration, WithLimits};
use crate::contact::{AdmissibleSet, State};
use crate::error::Result;
use crate::operator::fft::Real;
use crate::operator::reserve;
use crate::scene::Load;

/// Elements wait at their limit while the norm of their e > 0 is less than this part of the norm of e on C. The work relative to that of the scene
/// without limits, as the mean of 140 scenes and as the largest value of 48 scenes (`examples/pressure_limits`):
///
/// | value | 0 | 0.1 | 0.3 | 0.4 | 1 |
/// |---|---|---|---|---|---|
/// | mean | 2.0 | 1.71 | 1.71 | 1.7 | 1.78 |
/// | largest | 7.3 | 4.2 | 3.3 | 3.3 | 3.3 |
const WAITING_E: f64 = 0.4;

/// If p carries more than the force by a larger part than this, p is scaled down. Without this scaling, the work is 1.16 times as much in the mean
/// and
/// 2.2 times in the worst of 36 scenes (ellipse and rough surface of 64 to 256, limits of 0.3 to 0.9 of the greatest pressure).
const FORCE_EXCESS: f64 = 0.05;

impl WithLimits {
    /// Forgets what the last iteration left.
    pub(super) fn forget(&mut self) {
        (self.missing, self.shift, self.residual, self.went_back) = (0.0, 0.0, 0.0, false);
    }

    /// Whether elements at their limit with e > 0 wait there instead of entering C: their e is small compared with the residual on C.
    pub(super) fn waits(&self, h: &[f64], u: &[f64], at_limit: &[bool], approach: f64) -> bool {
        let distances =
            h.iter().zip(u).zip(at_limit).filter(|(_, &at_limit)| at_limit).map(|((h, u), _)| h - approach + u);
        distances.filter(|e| *e > 0.0).map(|e| e * e).sum::<f64>() < WAITING_E * WAITING_E * self.residual
    }
}

impl<T: Real> Iteration<T> {
    /// Allocates the additional memory of a scene with pressure limits.
    pub fn reserve_for_limits(&mut self) -> Result<()> {
        Ok(reserve(&mut self.limits.known, self.t.len(), "pressures with a limit")?)
    }

    /// If the force is prescribed and elements are at their limit: scales p and the deferred corrections down if p carries far too much; otherwise
    /// stores the missing force and the change of the approach that it causes. Returns the factor of the scaling, or None if no element is at its
    /// limit.
    pub(super) fn carry_beside_limits(&mut self, state: &mut State) -> Option<f64> {
        (self.limits.missing, self.limits.shift) = (0.0, 0.0);
        let Load::Force(force) = state.load else { return None };
        if !state.has_limited() {
            return None;
        }
        let pressures = force / state.grid.element_area();
        let carried = state.pressures(&self.threads);
        if carried > (1.0 + FORCE_EXCESS) * pressures {
            let factor = pressures / carried;
            state.p.iter_mut().for_each(|p| *p *= factor);
            self.truncation.scale(factor);
            for (inside, at_limit) in state.contact.iter_mut().zip(&mut state.at_limit) {
                *inside |= std::mem::take(at_limit);
            }
            self.find_contact(state);
            return Some(factor);
        }
        let loaded = state.p.iter().zip(&state.h).filter(|(p, _)| **p > 0.0);
        let depth = loaded.map(|(p, h)| p * (state.approach - h)).sum::<f64>() / carried;
        self.limits.missing = pressures - carried;
        // The depth is at most doubled in one step.
        let shift = (self.limits.missing / carried).min(1.0) * depth;
        self.limits.shift = if shift.is_finite() { shift } else { 0.0 };
        Some(1.0)
    }

    /// Scales p and the deferred corrections to carry the prescribed force. Returns the factor, with which u is to be scaled. On a given contact area
    /// a force that is negligible beside the sum of |p| does not determine the scale of p. Then p is not scaled: directions keep the force up to
    /// round-off, and the next certificate detects this round-off.
    pub(super) fn carry_force<S: AdmissibleSet>(&mut self, state: &mut State) -> f64 {
        let Load::Force(force) = state.load else { return 1.0 };
        if S::FIXED && state.is_cancelled(&self.threads) {
            return 1.0;
        }
        self.segments.find(&state.contact);
        if S::LIMITED {
            if let Some(factor) = self.carry_beside_limits(state) {
                return factor;
            }
        }
        let State { p, contact, .. } = &*state;
        let [carried] = self.segments.sum_of(contact, [p], none::<T>(), Carried);
        let factor = force / (carried * state.grid.element_area());
        if !(factor.is_finite() && factor > 0.0) {
            return 1.0;
        }
        self.scale(state, factor);
        factor
    }

    /// Clips t on elements that the forecast step would take beyond their limit.
    pub(super) fn clip_at_limit<S: AdmissibleSet>(&mut self, state: &State, set: S, forecast: f64) {
        let [] = self.segments.sum_changing(&state.contact, &mut self.t, |block, t| {
            for (elements, local) in block.segments() {
                let (p, t) = (&state.p[elements.clone()], &mut t[local]);
                if set.any_beyond(elements.start, p.iter().zip(&*t).map(|(p, t)| p + forecast * t.to_double())) {
                    for ((p, t), i) in p.iter().zip(t).zip(elements).filter(|(_, i)| state.contact[*i]) {
                        if p + forecast * t.to_double() > set.limit(i) {
                            let clipped = (set.limit(i) - p) / forecast;
                            // If the square of the clipped t is below the range of T, t is not clipped, and step (4.1) truncates p at the limit.
                            let is_in_range = clipped == 0.0 || T::of(clipped * clipped).to_double() > 0.0;
                            *t = if is_in_range { T::of(clipped) } else { *t };
                        }
                    }
                }
            }
            []
        });
    }

    /// Whether a step of the length alpha, or of the forecast if that is longer, brings any element to its limit or close to it.
    pub(super) fn reaches_limit<S: AdmissibleSet>(
        &mut self,
        state: &State,
        set: S,
        alpha: f64,
        forecast: Option<f64>,
    ) -> bool {
        let (t, farthest) = (&self.t, forecast.map_or(alpha, |forecast| forecast.max(alpha)));
        let [reached] = self.segments.sum(&state.contact, |block| {
            let beyond = block.segments().any(|(elements, _)| {
                let steps =
                    state.p[elements.clone()].iter().zip(&t[elements.clone()]).zip(&state.contact[elements.clone()]);
                let to = |(p, t): (&f64, &T)| (p + farthest * t.to_double()) * (1.0 + 2.0 * CLIPPED_SHARE);
                set.any_beyond(elements.start, steps.map(|(step, inside)| if *inside { to(step) } else { 0.0 }))
            });
            [f64::from(u8::from(beyond))]
        });
        reached > 0.0
    }

    /// Stores the pressures for which u = A p: p minus the deferred corrections.
    pub(super) fn remember(&mut self, state: &State) {
        self.limits.known.clear();
        self.limits.known.extend_from_slice(&state.p);
        for &(i, d) in self.truncation.gains() {
            self.limits.known[i] -= d;
        }
    }

    /// After a product that corrected all of u: shortens the change d of the pressures to `s d`, which has the least energy if
    /// `s = -(d, e)/(d, A d)`. Nothing changes unless 0 < s < 1. Elements that d had taken to a bound return to C.
    pub(super) fn step_back<S: AdmissibleSet>(&mut self, state: &mut State, set: S, update: &mut Update) {
        debug_assert!(update.gamma == 0.0, "with limits nothing is predicted");
        let (mut work, mut energy) = (0.0, 0.0);
        for i in 0..state.p.len() {
            let d = state.p[i] - self.limits.known[i];
            if d != 0.0 {
                work -= d * (state.h[i] - state.approach + state.u[i]);
                energy += d * (update.alpha * self.q[i].to_double() + self.z[i].to_double());
            }
        }
        let s = work / energy;
        // If the force is prescribed, d has a mean, whose energy is unknown before p is scaled. Shortening each step would cycle.
        let not_again = std::mem::take(&mut self.limits.went_back) && matches!(state.load, Load::Force(_));
        if !(s > 0.0 && s < 1.0) || not_again {
            return;
        }
        self.limits.went_back = true;
        update.alpha *= s;
        self.z.iter_mut().for_each(|z| *z = T::of(s * z.to_double()));
        for i in 0..state.p.len() {
            let d = state.p[i] - self.limits.known[i];
            if d == 0.0 {
                continue;
            }
            let to = self.limits.known[i] + s * d;
            state.p[i] = set.project(i, to);
            if state.p[i] != to {
                self.truncation.push(i, state.p[i] - to);
            }
            let at_limit = state.p[i] >= set.limit(i);
            state.at_limit[i] = at_limit;
            state.reached_limit |= at_limit;
            state.contact[i] = state.p[i] > 0.0 && !at_limit;
        }
        self.find_contact(state);
    }
}
