//! After any failure a handle holds its last complete result, or none, and its next call works.

#[path = "../abi/call.rs"]
#[allow(dead_code)] // only the call is used
mod call;
mod lack_of_memory;
mod lack_of_memory_adhesion;
mod lack_of_memory_line;
mod lack_of_memory_stress;
mod limited_memory;
mod panics;
mod panics_with_effects;
#[path = "../adhesion/support.rs"]
#[allow(dead_code)] // only the sphere is used
mod spheres;

use std::sync::{Mutex, MutexGuard, PoisonError};

use call::{last_error, Call, Through, MX, MY};
use contact_normal::ffi::*;

/// Lets tests run one at a time, because the demand for a panic is global.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A handle that is freed at the end of its test.
struct Handle(*mut contact_normal_solver);

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: made by a call, freed once.
        unsafe { contact_normal_solver_free(self.0) };
    }
}

/// The pressures, deformed distances and displacements that the handle holds, and its contact area. `None` if it has no result.
fn held(handle: &Handle) -> Option<(Vec<f64>, Vec<i32>)> {
    let n = MX * MY;
    let (mut numbers, mut contact) = (vec![-77.0; 3 * n], vec![-77; n]);
    let mut fields = call::initialised(contact_normal_fields_init);
    (fields.pressure, fields.contact) = (numbers.as_mut_ptr(), contact.as_mut_ptr());
    fields.deformed_distance = numbers[n..].as_mut_ptr();
    fields.displacement = numbers[2 * n..].as_mut_ptr();
    // SAFETY: a handle, and a struct with its arrays.
    let status = unsafe { contact_normal_solver_fields(handle.0, &mut fields) };
    if status == CONTACT_NORMAL_OK {
        assert!(numbers.iter().all(|value| *value != -77.0));
        return Some((numbers, contact));
    }
    assert_eq!(status, CONTACT_NORMAL_INVALID_ARGUMENT);
    assert!(last_error().contains("no result"), "{}", last_error());
    assert!(numbers.iter().all(|value| *value == -77.0), "refused, but written");
    None
}

type Effect = fn(&mut Call);

/// Names of effects, and the changes of a call that add them; the first one adds none.
const EFFECTS: [(&str, Effect); 7] = [
    ("none", |_| {}),
    ("influence", |c| _ = c.use_table()),
    ("row_tables", |c| _ = c.use_row_tables()),
    ("layer", |c| c.use_layer().compliance = 1e-6),
    ("layer per element", |c| {
        c.each.fill(1e-6);
        c.set_compliance(3, 2e-6);
    }),
    ("patches", |c| _ = c.use_patches([1.0, 0.5, 0.5, 1.0])),
    ("pressure_limit", |c| c.use_limit().limit = 1000.0),
];

unsafe extern "C" fn cancel(_: *const contact_normal_progress, _: *mut libc::c_void) -> i32 {
    1
}

/// The expected status of a solve that must be refused, and the change that causes it.
type Refused = (i32, Effect);

const REFUSED: [Refused; 4] = [
    (CONTACT_NORMAL_NOT_FINITE, |c| c.h[17] = f64::NAN),
    (CONTACT_NORMAL_INFEASIBLE, |c| {
        c.scene.known.load = CONTACT_NORMAL_PRESCRIBED_FORCE;
        c.h.fill(f64::INFINITY);
    }),
    (CONTACT_NORMAL_NOT_FINITE, |c| {
        c.options.known.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_GIVEN;
        c.pressure[3] = f64::NAN;
    }),
    (CONTACT_NORMAL_INVALID_ARGUMENT, |c| {
        c.fix_contact();
        c.contact[1..].fill(0);
        c.h[0] = f64::INFINITY;
    }),
];

fn new_call(effect: Effect, method: i32) -> Call {
    let mut call = Call::new();
    effect(&mut call);
    call.options.known.method = method;
    call
}

/// Asserts that a solve with the handle has the result of a new handle.
fn works(handle: &Handle, effect: Effect, method: i32, what: &str) {
    let (mut call, mut expected) = (new_call(effect, method), new_call(effect, method));
    assert_eq!(call.run(Through::SolverSolve, handle.0), (CONTACT_NORMAL_OK, String::new()), "{what}");
    let fresh = Handle(new_call(effect, method).new_handle());
    assert_eq!(expected.run(Through::SolverSolve, fresh.0).0, CONTACT_NORMAL_OK);
    assert_eq!(call.pressure, expected.pressure, "{what}: other bits");
    let (numbers, contact) = held(handle).expect("a result");
    assert_eq!((&numbers[..MX * MY], &contact), (&call.pressure[..], &call.contact), "{what}");
}

#[test]
fn a_refused_solve_leaves_the_result_before() {
    let _alone = alone();
    for (name, effect) in EFFECTS {
        for (status, spoil) in REFUSED {
            let handle = Handle(new_call(effect, 0).new_handle());
            let refuse = || {
                let mut call = new_call(effect, 0);
                spoil(&mut call);
                let (got, message) = call.run(Through::SolverSolve, handle.0);
                // With pressure limits any fixed area is refused as unsupported.
                let unsupported = name == "pressure_limit" && got == CONTACT_NORMAL_UNSUPPORTED;
                assert!(got == status || unsupported && message.contains("FIXED"), "{name}: {got}, {message}");
            };
            refuse();
            assert!(held(&handle).is_none(), "{name}: a result before there was one");
            works(&handle, effect, 0, name);
            let before = held(&handle);
            refuse();
            assert!(held(&handle) == before, "{name}: the result is another after status {status}");
            // The kept result is an initial guess for the next step.
            let mut step = new_call(effect, 0);
            step.options.known.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS;
            assert_eq!(step.run(Through::SolverSolve, handle.0), (CONTACT_NORMAL_OK, String::new()), "{name}");
            works(&handle, effect, 0, name);
        }
    }
}

#[test]
fn a_cancelled_solve_leaves_a_complete_result() {
    let _alone = alone();
    for (name, effect) in EFFECTS {
        for method in [0, 1] {
            let handle = Handle(new_call(effect, method).new_handle());
            let mut call = new_call(effect, method);
            call.options.known.progress = Some(cancel);
            let (status, message) = call.run(Through::SolverSolve, handle.0);
            assert_eq!(status, CONTACT_NORMAL_CANCELLED, "{name}: {message}");
            let (numbers, contact) = held(&handle).expect("the best iterate");
            let n = MX * MY;
            assert_eq!((&numbers[..n], &contact), (&call.pressure[..], &call.contact), "{name}");
            // e = h - approach + u holds, so that all of them belong to one iterate and one scene.
            let approach = call.report.known.normal.approach;
            for i in 0..n {
                let expected = call.h[i] - approach + numbers[2 * n + i];
                let size = call.h[i].abs() + approach.abs() + numbers[2 * n + i].abs();
                assert!((numbers[n + i] - expected).abs() <= 4.0 * f64::EPSILON * size, "{name}, element {i}");
            }
            works(&handle, effect, method, name);
        }
    }
}

#[cfg(feature = "test-panics")]
#[test]
fn after_a_caught_panic_the_handle_works() {
    use contact_normal::panics::BLOCKS;
    use std::sync::atomic::Ordering;

    let _alone = alone();
    for (name, effect) in EFFECTS {
        for method in [0, 1, 2, 3] {
            let mut probe = new_call(effect, method);
            if probe.run(Through::Solve, std::ptr::null_mut()).0 == CONTACT_NORMAL_UNSUPPORTED {
                continue;
            }
            let handle = Handle(new_call(effect, method).new_handle());
            let mut panics = 0;
            for block in 0.. {
                let before = held(&handle);
                BLOCKS.store(block, Ordering::Relaxed);
                let mut call = new_call(effect, method);
                let (status, message) = call.run(Through::SolverSolve, handle.0);
                let was_demanded = BLOCKS.swap(-1, Ordering::Relaxed) < 0;
                assert_eq!(status == CONTACT_NORMAL_INTERNAL, was_demanded, "{name}, block {block}: {message}");
                if !was_demanded {
                    break;
                }
                panics += 1;
                let after = held(&handle);
                assert!(after.is_none() || after == before, "{name}, method {method}, block {block}: half of a result");
                works(&handle, effect, method, name);
            }
            assert!(panics > 0, "{name}, method {method}: no product");
        }
    }
}

#[test]
fn nothing_that_a_scene_names_is_ignored() {
    let _alone = alone();
    let others: [(&str, Effect, Effect); 5] = [
        ("layer", |c| c.use_layer().compliance = 1e-6, |c| c.use_layer().compliance = 1e-5),
        (
            "layer",
            |c| {
                c.each.fill(1e-6);
                c.set_compliance(3, 2e-6);
            },
            |c| {
                c.each.fill(1e-6);
                c.set_compliance(3, 2e-5);
            },
        ),
        // A layer with one compliance per element in the place of a uniform one.
        (
            "layer",
            |c| c.use_layer().compliance = 1e-6,
            |c| {
                c.each.fill(1e-6);
                c.set_compliance(3, 2e-6);
            },
        ),
        ("patches", |c| _ = c.use_patches([1.0, 0.5, 0.5, 1.0]), |c| _ = c.use_patches([1.0, 0.2, 0.2, 1.0])),
        (
            "patches",
            |c| _ = c.use_patches([1.0, 0.5, 0.5, 1.0]),
            |c| {
                c.use_patches([1.0, 0.5, 0.5, 1.0]);
                c.patch[7] = 1 - c.patch[7];
            },
        ),
    ];
    for (name, set_up, other) in others {
        let handle = Handle(new_call(set_up, 0).new_handle());
        for through in [Through::SolverSolve, Through::SolverSolveBatch] {
            assert_eq!(new_call(set_up, 0).run(through, handle.0), (CONTACT_NORMAL_OK, String::new()), "{name}");
            let mut call = new_call(other, 0);
            let (status, message) = call.run(through, handle.0);
            assert_eq!(status, CONTACT_NORMAL_INVALID_ARGUMENT, "{name}: {message}");
            assert!(message.contains(name), "\"{message}\" does not say {name}");
        }
    }
}

/// A callback that overwrites the array `user`.
unsafe extern "C" fn spoil(_: *const contact_normal_progress, user: *mut libc::c_void) -> i32 {
    // SAFETY: one value per element, which nothing else reads now.
    (0..MX * MY).for_each(|i| unsafe { user.cast::<f64>().add(i).write(1e-300) });
    0
}

/// The limits are a little above the largest pressure, so that only iterates reach them. The library then solves the scene again without limits,
/// after callbacks have run.
#[test]
fn distances_are_read_before_a_callback_runs() {
    let _alone = alone();
    let mut free = new_call(|_| {}, 0);
    assert_eq!(free.run(Through::Solve, std::ptr::null_mut()).0, CONTACT_NORMAL_OK);
    let largest = free.pressure.iter().copied().fold(0.0, f64::max);
    for part in (0..40).map(|k| 1.0 + 0.005 * f64::from(k)) {
        let new = || {
            let mut call = new_call(|_| {}, 0);
            call.each.fill(part * largest);
            call.set_limit(0, part * largest);
            call
        };
        let mut undisturbed = new();
        assert_eq!(undisturbed.run(Through::Solve, std::ptr::null_mut()).0, CONTACT_NORMAL_OK);
        let mut call = new();
        call.options.known.progress = Some(spoil);
        call.options.known.user = call.h.as_mut_ptr().cast();
        assert_eq!(call.run(Through::Solve, std::ptr::null_mut()), (CONTACT_NORMAL_OK, String::new()), "{part}");
        assert_eq!(call.h[0], 1e-300, "not called");
        assert_eq!(call.pressure, undisturbed.pressure, "{part}");
    }
}

/// The tractions of unlike bodies change the distances, so that the scene is solved in turns, between which callbacks run.
#[test]
fn distances_of_unlike_bodies_are_read_before_a_callback_runs() {
    let _alone = alone();
    let unlike = |call: &mut Call| {
        call.scene.known.poisson_ratio = [0.0, 0.45];
        call.use_friction();
    };
    let run = |spoils: bool| {
        let mut call = new_call(unlike, 0);
        if spoils {
            call.options.known.progress = Some(spoil);
            call.options.known.user = call.h.as_mut_ptr().cast();
        }
        assert_eq!(call.run(Through::Solve, std::ptr::null_mut()), (CONTACT_NORMAL_OK, String::new()));
        assert_eq!(call.h[0] == 1e-300, spoils, "not called");
        call.pressure
    };
    let undisturbed = run(false);
    let mut alike = new_call(|_| {}, 0);
    alike.scene.known.poisson_ratio = [0.0, 0.45];
    assert_eq!(alike.run(Through::Solve, std::ptr::null_mut()).0, CONTACT_NORMAL_OK);
    assert_ne!(alike.pressure, undisturbed, "tractions change nothing");
    assert_eq!(run(true), undisturbed);
}

#[test]
fn limits_are_read_before_a_callback_runs() {
    let _alone = alone();
    for method in [0, 1] {
        let new = || {
            let mut call = new_call(|_| {}, method);
            call.each.fill(1000.0);
            call.set_limit(3, 500.0);
            call
        };
        let mut undisturbed = new();
        assert_eq!(undisturbed.run(Through::Solve, std::ptr::null_mut()).0, CONTACT_NORMAL_OK);
        assert!(undisturbed.contact.contains(&2), "no element is at the limit");
        let mut call = new();
        call.options.known.progress = Some(spoil);
        call.options.known.user = call.each.as_mut_ptr().cast();
        assert_eq!(call.run(Through::Solve, std::ptr::null_mut()), (CONTACT_NORMAL_OK, String::new()));
        assert_eq!(call.each[0], 1e-300, "not called");
        assert_eq!(call.pressure, undisturbed.pressure);
    }
}
