//! The part of a state in the window: copies it to the iteration, in the iteration's units, and back.

use super::scaling::Scaling;
use crate::contact::{AdmissibleSet, Freshness, State};
use crate::error::Result;
use crate::memory::{rest, wake};
use crate::operator::reserve;
use crate::rectangle::Rectangle;
use crate::threads::Threads;

/// Copies the part of `state` in the window to `part`, in the iteration's units. The state's memory of p and of u is released after the copy.
pub(super) fn enter<S: AdmissibleSet>(
    (window, units): (&Rectangle, &Scaling),
    state: &mut State,
    part: &mut State,
    displacement: Freshness,
    threads: &Threads,
) -> Result<()> {
    let (whole, n) = (state.grid, part.grid.len());
    part.reached_limit = S::LIMITED && state.reached_limit;
    if S::LIMITED {
        reserve(&mut part.at_limit, n, "elements at the limit")?;
        part.at_limit.clear();
        part.at_limit.resize(n, false);
        if state.reached_limit {
            window.extract(&whole, &state.at_limit, &mut part.at_limit, threads);
        }
    } else {
        part.at_limit.clear();
    }
    window.extract(&whole, &state.contact, &mut part.contact, threads);
    let extract = |from: &[f64], to: &mut Vec<f64>| {
        wake(to, n, f64::NAN, threads);
        window.extract(&whole, from, to, threads);
    };
    extract(&state.h, &mut part.h);
    extract(&state.p, &mut part.p);
    rest(&mut state.p);
    if displacement == Freshness::Stale {
        wake(&mut part.u, n, f64::NAN, threads);
    } else {
        extract(&state.u, &mut part.u);
    }
    rest(&mut state.u);
    (part.load, part.approach) = (state.load, state.approach);
    if *units != Scaling::SAME {
        units.convert(part);
    }
    Ok(())
}

/// Copies p, C, the elements at their limit and the approach from `part` back to the state. Outside the window p becomes 0.
pub(super) fn leave<S: AdmissibleSet>(
    (window, units): (&Rectangle, &Scaling),
    part: &mut State,
    state: &mut State,
    threads: &Threads,
) {
    if *units != Scaling::SAME {
        units.convert_back(part);
    }
    let whole = state.grid;
    [&mut state.p, &mut state.u].into_iter().for_each(|values| wake(values, whole.len(), f64::NAN, threads));
    window.insert(&whole, &part.p, &mut state.p, 0.0, threads);
    window.insert(&whole, &part.contact, &mut state.contact, false, threads);
    if S::LIMITED && part.reached_limit {
        window.insert(&whole, &part.at_limit, &mut state.at_limit, false, threads);
        state.reached_limit = true;
    }
    state.approach = part.approach;
}
