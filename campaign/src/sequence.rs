//! Checks a handle in a random sequence of calls: with other surfaces and loads, with effects of other values, and with calls that must be refused.

use contact_normal::ffi::*;

use crate::call::{self, Handle, Outputs};
use crate::case::Case;
use crate::effects;
use crate::grid::Load;
use crate::random::Random;
use crate::rules::{check, reason};
use crate::verdict::Verdict;

/// The result of a sequence: the statuses of its calls, and the verdict.
pub struct Found {
    pub statuses: Vec<i32>,
    pub verdict: Verdict,
}

/// The pressures that the handle may hold.
#[derive(Default)]
struct Held {
    /// Those of the last call with a status >= 0.
    last: Option<Vec<f64>>,
    /// Those of the last call with status OK.
    last_solved: Option<Vec<f64>>,
}

/// Makes the calls of a case, which is the first of the sequence.
pub fn run(case: &Case) -> Found {
    let mut random = Random::new(case.seed ^ 0x5eed);
    let mut found = Found { statuses: Vec::new(), verdict: Verdict::default() };
    let mut handle = match Handle::new(case) {
        Ok(handle) => handle,
        Err((status, message)) => {
            found.statuses.push(status);
            match reason(case, status) {
                Some(why) => found.verdict.excuse(why),
                None => found.verdict.fail("refused without a reason", format!("{status}: {message}")),
            }
            return found;
        }
    };
    let mut held = Held::default();
    for step in 0..random.integer(2, 5) {
        let next = if step == 0 { case.clone() } else { case.next(&mut random) };
        let what = if step == 0 { 0 } else { random.integer(0, 5) };
        match what {
            1 => spoil(&next, &mut random, &mut handle, &mut found),
            2 => change_effects(&next, &mut random, &mut handle, &mut held, &mut found),
            3 => solve(&next, true, "previous: ", &mut handle, &mut held, &mut found),
            _ => solve(&next, false, "", &mut handle, &mut held, &mut found),
        }
        holds(&handle, &held, case.grid.len(), &mut found);
    }
    found
}

/// Stores the status and the pressures of a call.
fn remember(outputs: &Outputs, held: &mut Held, found: &mut Found) {
    found.statuses.push(outputs.status);
    if outputs.status >= 0 {
        held.last = Some(outputs.p.clone());
    }
    if outputs.status == CONTACT_NORMAL_OK {
        held.last_solved = Some(outputs.p.clone());
    }
}

/// Solves a case and checks the result. If the solve does not start from the last result, it must have the bits of a call without a handle.
fn solve(case: &Case, previous: bool, what: &str, handle: &mut Handle, held: &mut Held, found: &mut Found) {
    let outputs = handle.solve(case, previous);
    remember(&outputs, held, found);
    found.verdict.add(check(case, &outputs).within(&format!("handle, {what}")));
    if !previous {
        let fresh = call::solve(case);
        if outputs.status != fresh.status || outputs.bits() != fresh.bits() {
            let details = format!("status {} and {} after {:?}", outputs.status, fresh.status, found.statuses);
            found.verdict.fail("a handle gives the bits of a fresh call", details);
        }
    }
}

/// Makes a call that must be refused.
fn spoil(case: &Case, random: &mut Random, handle: &mut Handle, found: &mut Found) {
    let mut spoiled = case.clone();
    let kind = random.integer(0, 3);
    match kind {
        0 => spoiled.h[case.grid.len() / 2] = f64::NAN,
        // With a fixed area a negative force is allowed.
        1 => spoiled.load = Load::Force(if case.how.fixed.is_some() { f64::NAN } else { -1.0 }),
        2 => spoiled.how.tolerance = -1.0,
        _ => spoiled.grid.dx *= 2.0,
    }
    let outputs = handle.solve(&spoiled, false);
    found.statuses.push(outputs.status);
    if outputs.status >= 0 || outputs.written {
        let details = format!("kind {kind}, status {}, written: {}", outputs.status, outputs.written);
        found.verdict.fail("a handle refuses what is no scene", details);
    }
}

/// Solves a case whose effects have other values. The handle must use these values, or refuse the call with a message; it must not ignore them.
fn change_effects(case: &Case, random: &mut Random, handle: &mut Handle, held: &mut Held, found: &mut Found) {
    let mut changed = case.clone();
    let self_influence = case.operator().diagonal();
    let effects = &mut changed.effects;
    if effects.layer.is_some() {
        effects.layer = Some(effects::layer(random, &case.grid, self_influence));
    } else if effects.patches.is_some() {
        effects.patches = Some(effects::patches(random, &case.grid));
    } else if let Some(table) = effects.influence.as_mut().or(effects.row_tables.as_mut()) {
        table.values.iter_mut().for_each(|value| *value *= 2.0);
    } else {
        changed.shear_modulus[0] *= 2.0;
    }
    let outputs = handle.solve(&changed, false);
    remember(&outputs, held, found);
    if outputs.status >= 0 {
        let Verdict { failures, excuses } = check(&changed, &outputs);
        found.verdict.excuses.extend(excuses);
        if let Some(first) = failures.first() {
            let details = format!("{}: {}", first.promise, first.details);
            found.verdict.fail("a handle uses what the scene names", details);
        }
    } else if outputs.written || outputs.message.is_empty() {
        found.verdict.fail("refused: outputs untouched", outputs.message);
    }
}

/// Checks that the handle holds the last complete result, or reports that it has none.
fn holds(handle: &Handle, held: &Held, n: usize, found: &mut Found) {
    let Some(p) = handle.pressures(n) else { return };
    let same = |of: &Option<Vec<f64>>| {
        of.as_ref().is_some_and(|of| of.iter().zip(&p).all(|(a, b)| a.to_bits() == b.to_bits()))
    };
    if !same(&held.last) && !same(&held.last_solved) {
        let details = format!("after {:?}", found.statuses);
        found.verdict.fail("a handle holds the last complete result", details);
    }
}
