//! A callback runs in the floating-point environment of the host program. It may write into the caller's arrays, but it may not use the handle that
//! is solving.

use std::hint::black_box;
use std::ptr::{null, null_mut};

use libc::{c_char, c_int, c_void};

use super::{assert_refused, solved, Handle};
use crate::call::{last_error, Call, Through};
use contact_normal::ffi::*;

extern "C" {
    fn fesetround(mode: c_int) -> c_int;
}

#[cfg(target_arch = "x86_64")]
const UPWARD: c_int = 0x800;
#[cfg(target_arch = "x86_64")]
const DOWNWARD: c_int = 0x400;
#[cfg(target_arch = "aarch64")]
const UPWARD: c_int = 0x400000;
#[cfg(target_arch = "aarch64")]
const DOWNWARD: c_int = 0x800000;

/// One third, rounded to nearest, which here is downwards.
const DOWN: f64 = 1.0 / 3.0;

/// The rounding mode of double arithmetic, found by computing. A function of the C library might report the mode of another unit.
fn rounding() -> c_int {
    let third = |sign: f64| black_box(sign) / black_box(3.0);
    match (third(1.0) > DOWN, third(-1.0) < -DOWN) {
        (true, false) => UPWARD,
        (false, true) => DOWNWARD,
        _ => 0,
    }
}

/// What a callback records, and what it does.
struct Watch {
    /// The rounding mode at the beginning of each call.
    modes: Vec<c_int>,
    /// The rounding mode that the callback sets before it returns.
    leaves: c_int,
    /// A solve that the callback makes.
    inner: Option<Call>,
}

impl Watch {
    fn called(&mut self) {
        self.modes.push(rounding());
        if let Some(inner) = &mut self.inner {
            assert_eq!(inner.run(Through::Solve, null_mut()).0, CONTACT_NORMAL_OK);
            assert_eq!(rounding(), *self.modes.last().expect("a mode"));
        }
        // SAFETY: sets the rounding mode of this thread.
        assert_eq!(unsafe { fesetround(self.leaves) }, 0);
    }
}

unsafe extern "C" fn progress(_: *const contact_normal_progress, user: *mut c_void) -> i32 {
    // SAFETY: the test's own.
    unsafe { &mut *user.cast::<Watch>() }.called();
    0
}

unsafe extern "C" fn log(_: i32, _: *const c_char, user: *mut c_void) {
    // SAFETY: the test's own. Other tests of this process also log, from their threads.
    if WATCHED.get() {
        unsafe { &mut *user.cast::<Watch>() }.called();
    }
}

thread_local! {
    static WATCHED: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
}

unsafe extern "C" fn surface(mx: i32, my: i32, dx: f64, dy: f64, h: *mut f64, user: *mut c_void) -> i32 {
    // SAFETY: the test's own, and room for all values.
    unsafe {
        let mode = rounding();
        fesetround(0);
        for i in 0..(mx * my) as usize {
            let x = (i % mx as usize) as f64 + 0.5 - 0.5 * f64::from(mx);
            let y = (i / mx as usize) as f64 + 0.5 - 0.5 * f64::from(my);
            h.add(i).write(0.04 * (x * dx).powi(2) + 0.32 * (y * dy).powi(2));
        }
        fesetround(mode);
        (*user.cast::<Watch>()).called();
    }
    0
}

/// Makes a call in the rounding mode DOWNWARD, and returns the mode after it.
fn downward(call: impl FnOnce()) -> c_int {
    // SAFETY: the rounding mode of this thread, nearest (0) again before Rust computes.
    unsafe {
        assert_eq!(fesetround(DOWNWARD), 0);
        call();
        let after = rounding();
        assert_eq!(fesetround(0), 0);
        after
    }
}

#[test]
fn a_callback_runs_in_the_environment_of_the_host_and_changes_no_bit() {
    for method in 0..=4 {
        let new = || {
            let mut call = Call::new();
            call.options.known.method = method;
            call
        };
        let mut undisturbed = new();
        solved(&mut undisturbed);
        for (leaves, inner) in [(UPWARD, false), (DOWNWARD, true)] {
            let mut watch = Watch { modes: Vec::new(), leaves, inner: inner.then(Call::new) };
            let mut call = new();
            call.options.known.progress = Some(progress);
            call.options.known.user = (&raw mut watch).cast();
            let after = downward(|| solved(&mut call));
            // The host has the mode that the callback set: in the next callback, and after the call.
            assert_eq!(watch.modes[0], DOWNWARD);
            assert!(watch.modes[1..].iter().all(|&mode| mode == leaves), "{:?}", watch.modes);
            assert_eq!(after, leaves);
            assert_eq!(call.pressure, undisturbed.pressure, "method {method}: other bits");
            assert_eq!(call.report.known.normal.residual.to_bits(), undisturbed.report.known.normal.residual.to_bits());
            if let Some(inner) = watch.inner {
                let mut expected = Call::new();
                solved(&mut expected);
                assert_eq!(inner.pressure, expected.pressure, "the solve inside has other bits");
            }
        }
    }
}

#[test]
fn the_surface_and_the_log_run_in_the_environment_of_the_host() {
    let run = |watch: *mut Watch| {
        let mut call = Call::new();
        call.accuracy.known.surface = Some(surface);
        call.accuracy.known.user = watch.cast();
        let after = downward(|| assert_eq!(call.run(Through::ToAccuracy, null_mut()).0, CONTACT_NORMAL_OK));
        (after, call.report.known.normal.force)
    };
    let mut calm = Watch { modes: Vec::new(), leaves: DOWNWARD, inner: None };
    let (_, expected) = run(&raw mut calm);
    let mut watch = Watch { modes: Vec::new(), leaves: UPWARD, inner: None };
    assert_eq!(run(&raw mut watch), (UPWARD, expected));
    assert_eq!((watch.modes[0], calm.modes[0]), (DOWNWARD, DOWNWARD));

    let mut undisturbed = Call::new();
    solved(&mut undisturbed);
    let mut watch = Watch { modes: Vec::new(), leaves: UPWARD, inner: None };
    WATCHED.set(true);
    // SAFETY: the callback and its data live until it is removed.
    unsafe {
        assert_eq!(contact_normal_set_log(Some(log), CONTACT_NORMAL_LOG_INFO, (&raw mut watch).cast()), 0);
    }
    let mut call = Call::new();
    let after = downward(|| solved(&mut call));
    let (pressure, handle) = (call.pressure.clone(), call.new_handle());
    let messages = watch.modes.len();
    assert_eq!(call.run(Through::SolverSolveBatch, handle).0, CONTACT_NORMAL_OK);
    assert_eq!(watch.modes.len(), messages, "a batch sends no messages");
    // SAFETY: a handle, not used any more, and no callback.
    unsafe {
        contact_normal_solver_free(handle);
        contact_normal_set_log(None, CONTACT_NORMAL_LOG_OFF, null_mut());
    }
    WATCHED.set(false);
    assert_eq!((watch.modes.first(), after), (Some(&DOWNWARD), UPWARD));
    assert_eq!(pressure, undisturbed.pressure);
}

/// A callback that tries to use the handle that is solving.
struct Misuse {
    handle: *mut contact_normal_solver,
    call: Call,
    outcomes: Vec<(i32, String)>,
}

unsafe extern "C" fn misuse(_: *const contact_normal_progress, user: *mut c_void) -> i32 {
    // SAFETY: the test's own; the handle is the one that solves.
    unsafe {
        let Misuse { handle, call, outcomes } = &mut *user.cast::<Misuse>();
        for through in [Through::SolverSolve, Through::SolverSolveBatch] {
            outcomes.push(call.run(through, *handle));
        }
        outcomes.push((contact_normal_solver_fields(*handle, &mut call.fields.known), last_error()));
        outcomes.push((contact_normal_solver_set_influence(*handle, &call.influence.known, null()), last_error()));
        outcomes.push((contact_normal_solver_free(*handle), last_error()));
        // The callback may use a handle of its own.
        let own = Handle::of(call);
        assert_eq!(call.run(Through::SolverSolve, own.0).0, CONTACT_NORMAL_OK);
    }
    0
}

#[test]
fn a_handle_that_is_solving_refuses_to_be_used_or_freed() {
    let mut undisturbed = Call::new();
    undisturbed.use_table();
    let handle = Handle::of(&mut undisturbed);
    assert_eq!(undisturbed.run(Through::SolverSolve, handle.0).0, CONTACT_NORMAL_OK);

    let mut misused = Misuse { handle: handle.0, call: Call::new(), outcomes: Vec::new() };
    let mut call = Call::new();
    call.use_table();
    call.options.known.progress = Some(misuse);
    call.options.known.user = (&raw mut misused).cast();
    assert_eq!(call.run(Through::SolverSolve, handle.0), (CONTACT_NORMAL_OK, String::new()));
    assert!(misused.outcomes.len() >= 5, "not called");
    for outcome in misused.outcomes {
        assert_refused(outcome, CONTACT_NORMAL_INVALID_ARGUMENT, &["solver", "in use", "callback"]);
    }
    assert_eq!(call.pressure, undisturbed.pressure);
    // The handle can still solve after the refused calls.
    call.options.known.progress = None;
    assert_eq!(call.run(Through::SolverSolve, handle.0), (CONTACT_NORMAL_OK, String::new()));
    assert_eq!(call.pressure, undisturbed.pressure);
}

/// Arrays that a callback overwrites.
struct Spoilt {
    numbers: Vec<(*mut f64, usize)>,
    patch: (*mut i32, usize),
}

unsafe extern "C" fn spoil(_: *const contact_normal_progress, user: *mut c_void) -> i32 {
    // SAFETY: the arrays of the call, which nothing else reads now.
    unsafe {
        let spoilt = &mut *user.cast::<Spoilt>();
        for &(start, n) in &spoilt.numbers {
            (0..n).for_each(|i| start.add(i).write(f64::NAN));
        }
        (0..spoilt.patch.1).for_each(|i| spoilt.patch.0.add(i).write(-1));
    }
    0
}

#[test]
fn what_the_effects_hold_is_read_before_a_callback_runs() {
    type Effect = fn(&mut Call);
    let effects: [Effect; 4] = [
        |c| c.set_compliance(0, 1e-6),
        |c| _ = c.use_patches([1.0, 0.5, 0.5, 1.0]),
        |c| _ = c.use_row_tables(),
        |c| {
            c.use_table();
            c.set_compliance(3, 1e-5);
        },
    ];
    for (k, effect) in effects.into_iter().enumerate() {
        for through in [Through::Solve, Through::ToAccuracy] {
            // A search for an accuracy refuses the caller's coefficients and values per element. It gets the plain scene.
            let change = |call: &mut Call| {
                if through == Through::Solve {
                    effect(call)
                }
            };
            let mut undisturbed = Call::new();
            undisturbed.each.fill(1e-5);
            change(&mut undisturbed);
            assert_eq!(undisturbed.run(through, null_mut()), (CONTACT_NORMAL_OK, String::new()));
            let mut call = Call::new();
            call.each.fill(1e-5);
            change(&mut call);
            let mut arrays = [&mut call.h, &mut call.table, &mut call.tables, &mut call.each];
            let mut numbers: Vec<_> = arrays.iter_mut().map(|array| (array.as_mut_ptr(), array.len())).collect();
            numbers.push((call.factors.as_mut_ptr(), 4));
            let mut spoilt = Spoilt { numbers, patch: (call.patch.as_mut_ptr(), call.patch.len()) };
            call.options.known.progress = Some(spoil);
            call.options.known.user = (&raw mut spoilt).cast();
            assert_eq!(call.run(through, null_mut()), (CONTACT_NORMAL_OK, String::new()), "effect {k}, {through:?}");
            assert!(call.h[0].is_nan(), "effect {k}: not called");
            assert_eq!(
                call.report.known.normal.force, undisturbed.report.known.normal.force,
                "effect {k}, {through:?}"
            );
            assert_eq!(call.pressure, undisturbed.pressure, "effect {k}, {through:?}");
        }
    }
}
