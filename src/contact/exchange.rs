//! Steps (4.1) and (4.2) of section 4.1: elements leave and enter the contact area.

use std::ops::Range;

use super::admissible::AdmissibleSet;
use super::State;
use crate::blocks;
use crate::threads::Threads;

/// Step (4.1): moves elements of C with p < 0 to the exterior area, with `p = 0`, and elements of C with p above their limit to the limit. Returns
/// the number of elements that leave C.
pub fn truncate<S: AdmissibleSet>(state: &mut State, set: S, threads: &Threads) -> usize {
    if S::FIXED {
        return 0;
    }
    // Usually no element leaves. If some leave, they are in few rows.
    let (p, contact) = (&state.p, &state.contact);
    let some = blocks::fold(
        &state.grid,
        threads,
        false,
        #[inline(always)]
        |block| some_leaves(set, p, contact, block),
        |some, of_block| some | of_block,
    );
    if !some {
        return 0;
    }
    let (n, mx, mut changed) = (state.p.len(), state.grid.mx, 0);
    for row in (0..n).step_by(mx).map(|start| start..start + mx) {
        if !some_leaves(set, &state.p, &state.contact, row.clone()) {
            continue;
        }
        for i in row {
            if state.contact[i] && set.leaves(i, state.p[i]) {
                leave(state, set, i, state.p[i] > 0.0);
                changed += 1;
            }
        }
    }
    changed
}

/// Whether no element of C leaves it.
pub fn all_stay<S: AdmissibleSet>(state: &State, set: S) -> bool {
    S::FIXED || !some_leaves(set, &state.p, &state.contact, 0..state.p.len())
}

/// Moves element i from C to its limit or to the exterior area, and sets its p. Returns the change of this pressure.
pub fn leave<S: AdmissibleSet>(state: &mut State, set: S, i: usize, for_limit: bool) -> f64 {
    let (before, at_limit) = (state.p[i], S::LIMITED && for_limit);
    if at_limit {
        (state.at_limit[i], state.reached_limit) = (true, true);
    }
    state.p[i] = if at_limit { set.limit(i) } else { 0.0 };
    state.contact[i] = false;
    state.p[i] - before
}

/// Moves element i to C, from its limit or from the exterior area.
pub fn enter<S: AdmissibleSet>(state: &mut State, i: usize) {
    state.contact[i] = true;
    if S::LIMITED {
        state.at_limit[i] = false;
    }
}

/// Whether any of these elements leaves C. The loop tests all of them instead of stopping at the first, so that the compiler vectorises it.
#[inline(always)]
fn some_leaves<S: AdmissibleSet>(set: S, p: &[f64], contact: &[bool], elements: Range<usize>) -> bool {
    let values = p[elements.clone()].iter().zip(&contact[elements.clone()]).zip(elements);
    values.fold(0, |some, ((p, inside), i)| some | u64::from(inside & set.leaves(i, *p))) != 0
}

/// Step (4.2): moves exterior elements with `e < 0`, and elements at their limit with `e > 0`, to C. Returns the number of elements that enter C.
/// `state.u` must be A p of the p that [`truncate`] left.
pub fn admit<S: AdmissibleSet>(state: &mut State, set: S) -> usize {
    if S::FIXED {
        return 0;
    }
    let mut changed = 0;
    for i in 0..state.p.len() {
        let at_limit = S::LIMITED && state.at_limit[i];
        if !state.contact[i] && set.enters(at_limit, state.deformed_distance(i)) {
            enter::<S>(state, i);
            changed += 1;
        }
    }
    changed
}
