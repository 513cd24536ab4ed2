//! Steps (4.1) and (4.2) of section 4.1: who enters the contact area and who leaves it.

use super::admissible::AdmissibleSet;
use super::State;

/// Step (4.1): elements of C that would pull go to the exterior area, with `p = 0`, and those above their limit to that. Returns how
/// many.
pub fn truncate<S: AdmissibleSet>(state: &mut State, set: S) -> usize {
    if S::FIXED {
        return 0;
    }
    let mut changed = 0;
    for start in (0..state.p.len()).step_by(state.grid.mx) {
        // Few rows have an element that leaves, and this the compiler can vectorise.
        let row = start..start + state.grid.mx;
        let elements = state.p[row.clone()].iter().zip(&state.contact[row.clone()]).zip(row.clone());
        let some_leaves = pulp::Arch::new().dispatch(
            #[inline(always)]
            || elements.fold(0, |some, ((p, inside), i)| some | u64::from(inside & set.leaves(i, *p))),
        );
        if some_leaves == 0 {
            continue;
        }
        for i in row {
            if state.contact[i] && set.leaves(i, state.p[i]) {
                if S::LIMITED && state.p[i] > 0.0 {
                    (state.at_limit[i], state.reached_limit) = (true, true);
                }
                state.p[i] = set.project(i, state.p[i]);
                state.contact[i] = false;
                changed += 1;
            }
        }
    }
    changed
}

/// Step (4.2): exterior elements with `e < 0`, and elements at their limit with `e > 0`, go to the contact area. Returns how many.
/// Needs u = A p of the truncated p.
pub fn admit<S: AdmissibleSet>(state: &mut State, set: S) -> usize {
    if S::FIXED {
        return 0;
    }
    let mut changed = 0;
    for i in 0..state.p.len() {
        let at_limit = S::LIMITED && state.at_limit[i];
        if !state.contact[i] && set.enters(at_limit, state.deformed_distance(i)) {
            state.contact[i] = true;
            if at_limit {
                state.at_limit[i] = false;
            }
            changed += 1;
        }
    }
    changed
}
