//! Prepares the state for a solve: its load, and its start, which is p = 0, the caller's guess, or the last solution. Also solutions that are known
//! without iteration.

use std::ops::Range;

use super::{Asked, InitialGuess};
use crate::blocks;
use crate::contact::{leave, AdmissibleSet, Freshness, Problem, State, Survey};
use crate::error::Result;
use crate::methods::Start;
use crate::progress::Monitor;
use crate::scene::Load;
use crate::sums::{mean, ROUND_OFF};
use crate::threads::Threads;

/// A guess whose residual, relative to the norm of `h - approach` over C, exceeds this is discarded. p = 0 has the relative residual 1.
const WORST_GUESS: f64 = 1e3;

/// Copies the undeformed distance `given` to the state. A copy is needed because a callback may change the caller's array.
pub fn take_distance(state: &mut State, given: &[f64], threads: &Threads) {
    let mx = state.grid.mx;
    threads.for_a_pass(given.len()).for_each_plain_row(&mut state.h, mx, |y, row| {
        row.copy_from_slice(&given[y * mx..][..row.len()]);
    });
}

/// Sets load and start of the state, which has the undeformed distance already. `has_solution` tells whether the state holds the last solution.
/// Returns which start was taken, and its survey unless it is p = 0. u is then A p.
pub fn take_over<S: AdmissibleSet>(
    problem: &mut Problem,
    state: &mut State,
    set: S,
    (asked, has_solution): (Asked<'_>, bool),
    monitor: &mut Monitor<'_>,
) -> Result<(Start, Option<Survey>)> {
    let Asked { scene, options, .. } = asked;
    let nothing = (Start::Nothing, None);
    let from = take_pressures(state, asked, has_solution);
    state.load = scene.load;
    state.round_off = problem.round_off();
    state.reached_limit = false;
    if let Load::Approach(approach) = scene.load {
        state.approach = approach;
    }
    if from == Start::Nothing {
        state.forget();
        // The approach of the last result must not affect this solve.
        if let Load::Force(_) = scene.load {
            state.approach = 0.0;
        }
        return Ok(nothing);
    }
    clean(state, set);
    // Pressures that are all 0 are no guess.
    if !S::FIXED && state.p.iter().all(|p| *p == 0.0) {
        state.forget();
        return Ok(nothing);
    }
    let is_scaled = balance(problem, state, set)?;
    monitor.count_products(problem.take_products(), 1.0);
    // A start far worse than p = 0 would take many iterations or overflow.
    let mut survey = Survey::by(state, &problem.threads);
    if is_scaled && options.goal().holds(&survey, 0.0, set) {
        // The start may be the solution. Only a fresh product certifies, and u was scaled with the load.
        problem.refresh(state, set)?;
        monitor.count_products(problem.take_products(), 1.0);
        survey = Survey::by(state, &problem.threads);
    }
    let Survey { residual, distance, .. } = survey;
    if residual.is_finite() && residual <= WORST_GUESS * distance || residual == 0.0 {
        return Ok((from, Some(survey)));
    }
    if !S::FIXED {
        state.forget();
        return Ok(nothing);
    }
    state.p.fill(0.0);
    problem.refresh(state, set)?;
    monitor.count_products(problem.take_products(), 1.0);
    Ok((from, Some(Survey::by(state, &problem.threads))))
}

/// Sets the pressures and the contact area to start from: the guess, or those in the state. Returns which of them.
fn take_pressures(state: &mut State, asked: Asked<'_>, has_solution: bool) -> Start {
    let is_fixed = asked.options.is_fixed();
    // C does not contain the elements at their limit. In a start they belong to C.
    for (inside, at_limit) in state.contact.iter_mut().zip(&mut state.at_limit) {
        *inside |= std::mem::take(at_limit);
    }
    match (asked.options.initial_guess, asked.guess) {
        (InitialGuess::Given, Some(guess)) => {
            state.p.copy_from_slice(guess.pressure);
            state.contact.copy_from_slice(guess.contact);
            state.u_is = Freshness::Stale;
            Start::Given
        }
        (from, Some(guess)) if is_fixed => {
            let is_previous = from == InitialGuess::Previous;
            if !(is_previous && has_solution) {
                state.p.fill(0.0);
                state.u_is = Freshness::Stale;
            }
            state.contact.copy_from_slice(guess.contact);
            if is_previous {
                Start::Previous
            } else {
                Start::Given
            }
        }
        (InitialGuess::Previous, _) if has_solution => Start::Previous,
        _ => Start::Nothing,
    }
}

/// Removes elements without a surface from C, and makes the pressures admissible: 0 outside C.
fn clean<S: AdmissibleSet>(state: &mut State, set: S) {
    for start in (0..state.p.len()).step_by(state.grid.mx) {
        // First tests whether the row needs a change: few do, and the compiler vectorises the test.
        let row = start..start + state.grid.mx;
        let (p, h, contact) = (&state.p[row.clone()], &state.h[row.clone()], &state.contact[row.clone()]);
        let elements = p.iter().zip(h).zip(contact).zip(row.clone());
        let is_unclean = pulp::Arch::new().dispatch(
            #[inline(always)]
            || {
                elements.fold(false, |some, (((p, h), &inside), i)| {
                    let to = if inside { set.project(i, *p) } else { 0.0 };
                    some | (to != *p) | (inside & !h.is_finite())
                })
            },
        );
        if !is_unclean {
            continue;
        }
        for i in row {
            state.contact[i] &= state.h[i].is_finite();
            let p = if state.contact[i] { set.project(i, state.p[i]) } else { 0.0 };
            if p != state.p[i] {
                state.p[i] = p;
                state.u_is = Freshness::Stale;
            }
        }
    }
    if S::LIMITED {
        stay_at_limits(state, set);
    }
    state.project(set);
}

/// Moves elements of C whose pressure is at the limit out of C, to the elements at their limit. In C their e would count as a residual, and the first
/// step of a method would change all their pressures. Step (4.2) returns those with e > 0 to C. At least one element must remain in C, because the
/// residual is a norm over C; otherwise nothing is moved.
fn stay_at_limits<S: AdmissibleSet>(state: &mut State, set: S) {
    let stays = |state: &State, i: usize| state.contact[i] && state.p[i] > 0.0 && state.p[i] >= set.limit(i);
    if (0..state.p.len()).any(|i| state.contact[i] && !stays(state, i)) {
        for i in 0..state.p.len() {
            if stays(state, i) {
                leave(state, set, i, true);
            }
        }
    }
}

/// Makes p carry the prescribed force, with u = A p. If u is A p before, p and u are scaled by a common factor, without a product. Returns whether
/// they were scaled.
fn balance<S: AdmissibleSet>(problem: &mut Problem, state: &mut State, set: S) -> Result<bool> {
    if state.u_is != Freshness::Exact {
        problem.refresh(state, set)?;
        return Ok(false);
    }
    let factor = state.carry_force(set, &problem.threads);
    match factor {
        Some(1.0) => {}
        Some(factor) => state.u.iter_mut().for_each(|u| *u *= factor),
        None => {
            problem.refresh(state, set)?;
            return Ok(false);
        }
    }
    state.fit_approach(&problem.threads);
    Ok(factor != Some(1.0))
}

/// If a prescribed force is the greatest that the pressure limits allow, up to round-off, puts all elements at their limit and returns true. No
/// iteration finds this solution: what remains of the force for an element in C would be round-off.
pub fn fills_limits<S: AdmissibleSet>(problem: &mut Problem, state: &mut State, set: S) -> Result<bool> {
    let Load::Force(force) = state.load else { return Ok(false) };
    if !S::LIMITED {
        return Ok(false);
    }
    let limit = |i: usize| if state.h[i].is_finite() { set.limit(i) } else { 0.0 };
    let of_block = |block: Range<usize>| block.map(limit).sum::<f64>();
    let greatest = blocks::fold(&state.grid, &problem.threads, 0.0, of_block, |sum, block| sum + block);
    let greatest = greatest * state.grid.element_area();
    if !(force >= greatest * (1.0 - ROUND_OFF)) {
        return Ok(false);
    }
    put_at_limits(problem, state, set)?;
    Ok(true)
}

/// Whether no element is at its limit, with two periods and an approach above the mean of h by more than round-off. A uniform pressure displaces nothing then.
/// So the mean of e is negative with any p, and elements are at their limits in every solution.
pub fn has_lost_limits<S: AdmissibleSet>(problem: &Problem, state: &State, set: S) -> bool {
    let Load::Approach(approach) = state.load else { return false };
    let are_finite = || (0..state.p.len()).all(|i| set.limit(i) < f64::INFINITY || state.h[i].is_infinite());
    let is_above = || {
        let largest = state.h.iter().fold(0.0, |largest: f64, h| largest.max(h.abs()));
        approach - mean(&state.h) > ROUND_OFF * largest
    };
    S::LIMITED && !state.has_limited() && problem.coefficients.is_mean_free() && is_above() && are_finite()
}

/// Puts all elements with a surface at their limit, with u = A p by a product.
pub fn put_at_limits<S: AdmissibleSet>(problem: &mut Problem, state: &mut State, set: S) -> Result<()> {
    for i in 0..state.p.len() {
        let at_limit = state.h[i].is_finite();
        (state.p[i], state.contact[i], state.at_limit[i]) =
            (if at_limit { set.limit(i) } else { 0.0 }, false, at_limit);
    }
    state.reached_limit = true;
    problem.displace(&state.p, &mut state.u)?;
    state.u_is = Freshness::Exact;
    state.fit_approach(&problem.threads);
    Ok(())
}

/// If there is no contact, sets the solution p = 0 and returns true: the prescribed force is 0, or the prescribed approach is less than the `lowest`
/// distance. A `fixed` contact area always has contact.
pub fn is_without_contact(state: &mut State, lowest: f64, fixed: bool) -> bool {
    let nothing = match state.load {
        Load::Approach(approach) => !fixed && lowest > approach,
        Load::Force(force) => !fixed && force == 0.0,
    };
    if nothing {
        state.unload();
        if let Load::Force(_) = state.load {
            state.approach = if lowest.is_finite() { lowest } else { 0.0 };
        }
    }
    nothing
}

/// If the prescribed force is 0, and h is constant on a given contact area up to round-off, sets the solution p = 0 and returns true. No iteration
/// accepts this solution: all `h - approach` are 0, and no residual is small relative to that.
pub fn is_even_without_force<S: AdmissibleSet>(state: &mut State) -> bool {
    if !S::FIXED || state.load != Load::Force(0.0) {
        return false;
    }
    let on_contact = state.h.iter().zip(&state.contact).filter(|(_, &inside)| inside).map(|(h, _)| *h);
    let (low, high) =
        on_contact.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high): (f64, f64), h| (low.min(h), high.max(h)));
    if !(high - low <= f64::EPSILON * low.abs().max(high.abs())) {
        return false;
    }
    state.p.fill(0.0);
    state.u.fill(0.0);
    state.u_is = Freshness::Exact;
    state.approach = low + 0.5 * (high - low);
    true
}
