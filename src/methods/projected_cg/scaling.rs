//! Units for single precision, whose range is 1e-38 to 1e38. The numbers of a scene in nanometres, or with a huge modulus, would leave this range, so
//! the iteration multiplies them by factors. The factors are powers of two, so that they change no digit.

use crate::blocks::{self, LANES};
use crate::contact::State;
use crate::scene::Load;
use crate::threads::Threads;

/// Numbers between 2^-48 and 2^48 are not scaled. With sums over 2^24 elements, a tolerance of 2^-40 and the inverse of A, all results then stay
/// between 2^-126 and 2^127.
const LARGEST_EXPONENT: i32 = 48;

/// The factors that convert the scene's units to those of the iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaling {
    /// The factor on influence coefficients.
    pub influence: f64,
    /// The factor on lengths: h, u and the approach.
    pub length: f64,
}

impl Scaling {
    /// The iteration has the scene's units.
    pub const SAME: Scaling = Scaling { influence: 1.0, length: 1.0 };

    /// Chooses the factors for a state. `self_influence` is the influence of an element on itself.
    pub fn for_state(state: &State, self_influence: f64, threads: &Threads) -> Scaling {
        let alone = match state.load {
            Load::Approach(_) => 0.0,
            Load::Force(force) => force.abs() / state.grid.element_area() * self_influence,
        };
        let length = farthest(state, threads).max(alone);
        let pressure = length / self_influence;
        let suits = [length, pressure].into_iter().all(|value| towards_one(value) == 1.0);
        Scaling { influence: towards_one(self_influence), length: if suits { 1.0 } else { to_one(length) } }
    }

    /// The factor on pressures, with which u = A p holds in both units.
    pub fn pressure(&self) -> f64 {
        self.length / self.influence
    }

    /// Converts the state to the iteration's units.
    pub fn convert(&self, state: &mut State) {
        let (length, pressure) = (self.length, self.pressure());
        state.h.iter_mut().chain(&mut state.u).for_each(|value| *value *= length);
        state.p.iter_mut().for_each(|p| *p *= pressure);
        state.approach *= length;
        state.load = match state.load {
            Load::Approach(approach) => Load::Approach(approach * length),
            Load::Force(force) => Load::Force(force * pressure),
        };
    }

    /// Converts the state back to the scene's units.
    pub fn convert_back(&self, state: &mut State) {
        let (length, pressure) = (1.0 / self.length, 1.0 / self.pressure());
        state.u.iter_mut().for_each(|u| *u *= length);
        state.p.iter_mut().for_each(|p| *p *= pressure);
        state.approach *= length;
    }
}

/// The largest |h - approach| of all elements that are in contact or have h below the approach.
fn farthest(state: &State, threads: &Threads) -> f64 {
    blocks::fold(
        &state.grid,
        threads,
        0.0,
        #[inline(always)]
        |block| farthest_of(&state.h[block.clone()], &state.contact[block], state.approach),
        larger,
    )
}

/// The same for a block of elements, in lanes, so that the compiler vectorises the loop.
#[inline(always)]
fn farthest_of(h: &[f64], contact: &[bool], approach: f64) -> f64 {
    let distance = |h: f64, inside: bool| if inside | (h < approach) { (h - approach).abs() } else { 0.0 };
    let mut farthest = [0.0; LANES];
    let (h, contact) = (h.chunks_exact(LANES), contact.chunks_exact(LANES));
    let rest = h.remainder().iter().zip(contact.remainder());
    let of_rest = rest.fold(0.0, |farthest, (h, &inside)| larger(distance(*h, inside), farthest));
    for (h, contact) in h.zip(contact) {
        for lane in 0..LANES {
            farthest[lane] = larger(distance(h[lane], contact[lane]), farthest[lane]);
        }
    }
    farthest.into_iter().fold(of_rest, |farthest, value| larger(value, farthest))
}

/// The larger of two numbers, in a form that the compiler vectorises. If a is NaN, the result is b.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b {
        a
    } else {
        b
    }
}

/// The exponent of two of a normal number.
fn exponent(value: f64) -> i32 {
    (value.to_bits() >> 52 & 0x7ff) as i32 - 1023
}

/// 1 if the exponent of a value is within [`LARGEST_EXPONENT`], otherwise the power of two that brings the value to [1, 2).
fn towards_one(value: f64) -> f64 {
    if exponent(value).abs() <= LARGEST_EXPONENT {
        1.0
    } else {
        to_one(value)
    }
}

/// The power of two that brings a value to [1, 2); 1 if the value is not positive and normal, or that power is not normal.
fn to_one(value: f64) -> f64 {
    // The inverse of 2^1022 and beyond is not normal.
    if value.is_normal() && value > 0.0 && exponent(value) < 1022 {
        2f64.powi(-exponent(value))
    } else {
        1.0
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/scaling.rs"]
mod tests;
