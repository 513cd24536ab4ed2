//! Which elements are free, which stay at a bound, and which pressures equal a bound up to round-off.

use crate::contact::{AdmissibleSet, State};
use crate::scene::Load;
use crate::sums::{in_blocks, ROUND_OFF};

/// Computes e on elements with a surface, and marks the free elements.
///
/// If the force is prescribed and C is empty, h + u does not determine the approach. Then the approach is midway between the one that keeps all
/// elements at their limit, and the one at which an exterior element touches. If the first exceeds the second, elements of both kinds are free.
pub(super) fn find_free<S: AdmissibleSet>(state: &State, set: S, distance: &mut [f64], free: &mut [bool]) {
    let approach = match state.load {
        Load::Force(_) if !state.contact.contains(&true) => between(state),
        _ => state.approach,
    };
    for i in 0..state.p.len() {
        let has_surface = state.h[i].is_finite();
        let (p, e) = (state.p[i], if has_surface { state.h[i] - approach + state.u[i] } else { 0.0 });
        distance[i] = e;
        free[i] = has_surface && (p > 0.0 || e < 0.0) && (p < set.limit(i) || e > 0.0);
    }
}

/// Removes from the free elements those at a bound which t would violate, or with `all` each element at a bound. Returns whether there are any.
pub(super) fn keep_at_bounds<S: AdmissibleSet>(
    (state, set): (&State, S),
    t: &[f64],
    free: &mut [bool],
    all: bool,
) -> bool {
    let mut any = false;
    for i in 0..state.p.len() {
        let (p, t) = (state.p[i], t[i]);
        let leads_out = p <= 0.0 && (all || t < 0.0) || S::LIMITED && p >= set.limit(i) && (all || t > 0.0);
        any |= free[i] && leads_out;
        free[i] &= !leads_out;
    }
    any
}

/// With pressure limits: sets pressures to a bound that they equal up to the round-off of the force. If nearly all elements are at a bound, an
/// element whose pressure is such a round-off must not determine the approach.
pub(super) fn snap<S: AdmissibleSet>(state: &mut State, set: S) {
    if !S::LIMITED {
        return;
    }
    let least = ROUND_OFF * in_blocks(state.p.iter().copied()) / state.p.len() as f64;
    for (i, p) in state.p.iter_mut().enumerate() {
        // A limit may be as small as `least`, so the limit is tested first.
        if *p >= (1.0 - ROUND_OFF) * set.limit(i) {
            *p = set.limit(i);
        } else if *p <= least {
            *p = 0.0;
        }
    }
}

/// Sets C = {0 < p < limit}. Returns the number of elements that entered or left C.
pub(super) fn find_contact<S: AdmissibleSet>(state: &mut State, set: S) -> u64 {
    let mut changes = 0;
    for i in 0..state.p.len() {
        let at_limit = S::LIMITED && state.p[i] >= set.limit(i);
        if S::LIMITED {
            state.at_limit[i] = at_limit;
            state.reached_limit |= at_limit;
        }
        let inside = state.p[i] > 0.0 && !at_limit;
        changes += u64::from(state.contact[i] != inside);
        state.contact[i] = inside;
    }
    changes
}

/// The middle between the approach that keeps all elements at their limit and the one at which an exterior element touches.
fn between(state: &State) -> f64 {
    let (mut held, mut touching) = (f64::NEG_INFINITY, f64::INFINITY);
    for i in (0..state.p.len()).filter(|&i| state.h[i].is_finite()) {
        let distance = state.h[i] + state.u[i];
        if state.touches(i) {
            held = held.max(distance);
        } else {
            touching = touching.min(distance);
        }
    }
    match (held.is_finite(), touching.is_finite()) {
        (true, true) => 0.5 * (held + touching),
        (true, false) => held,
        (false, _) => touching,
    }
}
