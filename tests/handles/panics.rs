//! A panic in the core becomes the status INTERNAL, with its message, unchanged outputs and no text on stderr; the next call works.

use std::ptr::null_mut;
use std::sync::atomic::Ordering;

use crate::call::{Call, Through};
use contact_normal::ffi::*;
use contact_normal::panics::BLOCKS;

/// Makes a call in which a product panics after `block` blocks. Returns whether it panicked.
fn panics_at(block: i64, call: &mut Call, through: Through, handle: *mut contact_normal_solver) -> bool {
    BLOCKS.store(block, Ordering::Relaxed);
    let before = call.outputs();
    let (status, message) = call.run(through, handle);
    if BLOCKS.swap(-1, Ordering::Relaxed) >= 0 {
        assert_eq!(status, CONTACT_NORMAL_OK, "{through:?}, block {block}: {message}");
        return false;
    }
    assert_eq!(status, CONTACT_NORMAL_INTERNAL, "{through:?}, block {block}: {message}");
    assert!(message.contains("on demand of a test") && message.contains("report"), "\"{message}\"");
    assert!(call.outputs() == before, "{through:?}, block {block}: outputs were written");
    true
}

#[test]
fn a_panic_anywhere_is_a_status_and_the_next_call_works() {
    let _alone = crate::alone();
    let methods = [
        CONTACT_NORMAL_METHOD_AUTO,
        CONTACT_NORMAL_METHOD_NORM,
        CONTACT_NORMAL_METHOD_MULTIGRID,
        CONTACT_NORMAL_METHOD_FULL_MULTIGRID,
    ];
    for threads in [1, 2] {
        for method in methods {
            let new = || {
                let mut call = Call::new();
                (call.options.known.method, call.options.known.threads) = (method, threads);
                call
            };
            let handle = new().new_handle();
            let mut expected = new();
            assert_eq!(expected.run(Through::SolverSolve, handle).0, CONTACT_NORMAL_OK);
            for through in [Through::Solve, Through::SolverSolve, Through::SolverSolveBatch] {
                for block in 0.. {
                    let panicked = panics_at(block, &mut new(), through, handle);
                    assert!(panicked || block > 0, "{through:?}, method {method}: no product");
                    let mut next = new();
                    assert_eq!(next.run(through, handle), (CONTACT_NORMAL_OK, String::new()), "block {block}");
                    assert_eq!(next.pressure, expected.pressure, "{through:?}, block {block}: another result");
                    if !panicked {
                        break;
                    }
                }
            }
            // SAFETY: made above.
            unsafe { contact_normal_solver_free(handle) };
        }
    }
    on_a_worker();
}

/// A solve on a grid that several threads share, in which a worker panics.
fn on_a_worker() {
    const M: usize = 160;
    let centre = |i: usize| i as f64 + 0.5 - 0.5 * M as f64;
    let h: Vec<f64> = (0..M * M).map(|i| 1e-5 * (centre(i % M).powi(2) + centre(i / M).powi(2))).collect();
    let mut scene = crate::call::initialised(contact_normal_scene_init);
    (scene.mx, scene.my, scene.dx, scene.dy) = (M as i32, M as i32, 0.1, 0.1);
    (scene.shear_modulus, scene.poisson_ratio) = ([1.0; 2], [0.3; 2]);
    (scene.approach, scene.undeformed_distance) = (0.1, h.as_ptr());
    let mut options = crate::call::initialised(contact_normal_options_init);
    options.threads = 2;
    for block in [0, 1, 5, 40, -1] {
        let (mut p, mut fields) = (vec![-7.0; M * M], crate::call::initialised(contact_normal_fields_init));
        fields.pressure = p.as_mut_ptr();
        BLOCKS.store(block, Ordering::Relaxed);
        // SAFETY: structs with their arrays.
        let status = unsafe { contact_normal_solve(&scene, &options, &mut fields, null_mut()) };
        let left = BLOCKS.swap(-1, Ordering::Relaxed);
        assert!(left < 0, "block {block}: {left} blocks more were to come");
        let panicked = block >= 0;
        assert_eq!(status, if panicked { CONTACT_NORMAL_INTERNAL } else { CONTACT_NORMAL_OK }, "block {block}");
        assert!(p.iter().all(|&p| if panicked { p == -7.0 } else { p >= 0.0 }), "block {block}");
    }
}

/// The environment variable that is set in the child process, which panics.
const CHILD: &str = "CONTACT_NORMAL_TEST_PANICS";

/// A panic writes nothing to stderr. This is tested in a child process, because the test harness captures the output of a test, and because the
/// demand for a panic must not affect the test above.
#[test]
fn a_panic_is_not_announced() {
    if std::env::var_os(CHILD).is_some() {
        let mut call = Call::new();
        BLOCKS.store(0, Ordering::Relaxed);
        let text = "internal error: on demand of a test; please report it".to_string();
        assert_eq!(call.run(Through::Solve, null_mut()), (CONTACT_NORMAL_INTERNAL, text));
        return;
    }
    let itself = std::env::current_exe().expect("this test's path");
    let arguments = ["--exact", "panics::a_panic_is_not_announced", "--nocapture"];
    let output = std::process::Command::new(itself).args(arguments).env(CHILD, "1").output().expect("a process");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("1 passed"), "the child ran no test");
    assert!(said.trim().is_empty(), "{said}");
}
