//! What only a scene with limits of the pressures needs, `0 <= p <= p_max`.
//!
//! The limit is a second bound: elements are held back and truncated at both, and what was truncated at its limit enters C again where
//! e > 0. The pressures there cannot be scaled. So with a prescribed force nothing is, once an element is at its limit: what is missing
//! of the force the next direction restores, `sum of t = missing/alpha'`, evenly over C.
//!
//! No scaling keeps C from going and coming back. Instead the step is shortened to the least energy wherever a product has just paid
//! all debts: both ends of it are known exactly then. Large debts, and what is much of the force, the next product pays whole, by a
//! step of the length of the forecast.

use super::iteration::Iteration;
use super::passes::Update;
use crate::contact::{AdmissibleSet, State};
use crate::error::Result;
use crate::operator::fft::Real;
use crate::operator::reserve;
use crate::progress::Goal;
use crate::scene::Load;

/// A step goes back where the least energy lies before this part of it. Measured over 84 scenes: at 0.5 one is not solved, at 1 the
/// work is 4 % more in the mean and 20 % more in the worst.
const STEP_BACK: f64 = 0.7;

/// What goes beyond the plain iteration.
#[derive(Default)]
pub(super) struct Beyond {
    /// What is missing of a prescribed force, as a sum of pressures.
    pub(super) missing: f64,
    /// The pressures that u knows of: those of before the iteration without what was owed then.
    known: Vec<f64>,
}

impl Beyond {
    /// Whether the force is carried.
    pub(super) fn carries(&self, state: &State, goal: &Goal) -> bool {
        self.missing.abs() <= goal.tolerance * state.p.iter().sum::<f64>()
    }
}

impl<T: Real> Iteration<T> {
    /// Memory that a scene with limits needs beyond that of one without.
    pub fn reserve_for_limits(&mut self) -> Result<()> {
        reserve(&mut self.limits.known, self.t.len(), "pressures with a limit")
    }

    /// Whether elements are at their limit, so that pressures cannot be scaled; then it notes what is missing of the force.
    pub(super) fn cannot_scale(&mut self, state: &State) -> bool {
        let held = state.at_limit.contains(&true);
        self.limits.missing = match state.load {
            Load::Force(force) if held => force / state.grid.element_area() - state.p.iter().sum::<f64>(),
            _ => 0.0,
        };
        held
    }

    /// With a limit: keeps the pressures that u knows of.
    pub(super) fn remember(&mut self, state: &State) {
        self.limits.known.clear();
        self.limits.known.extend_from_slice(&state.p);
        for &(i, d) in &self.debts {
            self.limits.known[i] -= d;
        }
    }

    /// With a limit, where a product has just paid all debts: goes back along the change d of the pressures that u learns of, to the
    /// least energy between, `s = -(d, e)/(d, A d)` of it. Elements that left for a bound return to C.
    pub(super) fn step_back<S: AdmissibleSet>(&mut self, state: &mut State, set: S, update: &mut Update) {
        let (mut work, mut energy) = (0.0, 0.0);
        for i in 0..state.p.len() {
            let d = state.p[i] - self.limits.known[i];
            if d != 0.0 {
                work -= d * (state.h[i] - state.approach + state.u[i]);
                energy += d * (update.alpha * self.q[i].to_double() + self.z[i].to_double());
            }
        }
        let s = work / energy;
        if !(s > 0.0 && s < STEP_BACK) {
            return;
        }
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
                self.debts.push((i, state.p[i] - to));
            }
            let at_limit = state.p[i] >= set.limit(i);
            state.at_limit[i] = at_limit;
            state.contact[i] = state.p[i] > 0.0 && !at_limit;
        }
        self.find_contact(state);
    }

}
