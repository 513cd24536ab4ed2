//! Dumps of all calls other than a plain solve, and the program that repeats the calls.

use std::path::Path;
use std::process::Command;
use std::ptr::{null, null_mut};

use contact_normal::ffi::dump::Dump;
use contact_normal::ffi::*;

use crate::call::last_error;
use crate::dump::{folder, text};
use crate::dump_scene::Everything;

/// Repeats a dumped call, and asserts the same status. Returns the status.
fn reproduced(path: &Path, call: &str) -> i32 {
    let read = || Dump::read(&std::fs::read(path).expect("a dump")).expect("a dump that can be read");
    let (status, mut missing) = (read().status(), read().missing());
    // The undeformed distance of the scene is not read if there is a surface callback, or for stresses.
    missing.retain(|name| name != "scene->undeformed_distance");
    assert_eq!((read().call(), missing), (call, Vec::new()));
    assert_eq!(read().replay().expect("a call").status, status, "{call}: {}", last_error());
    status
}

#[test]
fn set_ups_and_tangential_problems_are_made_again() {
    let path = folder("set_up").join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new("friction");
    scene.options.dump = path_text.as_ptr();
    scene.scene.poisson_ratio[0] = 0.7;
    let mut handle = null_mut();
    // SAFETY (all): structs with the arrays that they declare.
    unsafe {
        let status = contact_normal_solver_new(&scene.scene, &scene.options, &mut handle);
        assert_eq!((status, handle), (CONTACT_NORMAL_INVALID_ARGUMENT, null_mut()));
        assert_eq!(reproduced(&path, "contact_normal_solver_new"), status);
        scene.scene.poisson_ratio[0] = 0.28;
        (scene.options.max_cycles, scene.options.tolerance) = (1, 1e-14);
        let pressure: Vec<f64> = (0..30).map(|i| if i % 6 > 1 { 50.0 + i as f64 } else { 0.0 }).collect();
        let mut report = contact_normal_report::default();
        let at = pressure.as_ptr();
        let solve = |handle, scene: &Everything, report: *mut _| {
            let (scene, options) = (&raw const scene.scene, &raw const scene.options);
            contact_normal_solve_tangential(handle, scene, at, options, 1, null(), null_mut(), report)
        };
        let status = solve(null_mut(), &scene, &mut report);
        assert!(status > 0, "{status}: {}", last_error());
        assert_eq!(reproduced(&path, "contact_normal_solve_tangential"), status);
        // Calls with a handle continue from its last tractions, and use its tables if the scene has none.
        for effects in ["friction tables", "friction tangential_rows"] {
            let mut scene = Everything::new(effects);
            scene.options.dump = path_text.as_ptr();
            (scene.options.max_cycles, scene.options.tolerance) = (1, 1e-14);
            assert_eq!(contact_normal_solver_new(&scene.scene, &scene.options, &mut handle), CONTACT_NORMAL_OK);
            assert_eq!(solve(handle, &scene, &mut report), status);
            scene.friction.influence = [null(); 3];
            scene.friction.influence_cross = [null(); 2];
            scene.friction.row_tables = [null(); 3];
            scene.friction.previous_traction = [null(); 2];
            scene.friction.continues = 1;
            scene.options.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS;
            let again = solve(handle, &scene, &mut report);
            assert!(again > 0, "{again}: {}", last_error());
            let force = report.tangential.force;
            assert_eq!(contact_normal_solver_free(handle), CONTACT_NORMAL_OK);
            let replayed = Dump::read(&std::fs::read(&path).unwrap()).unwrap().replay().unwrap();
            assert_eq!((replayed.status, replayed.report.expect("a report").tangential.force), (again, force));
        }
    }
}

#[test]
fn tables_of_forces_are_made_again() {
    let path = folder("entries").join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new("friction");
    scene.options.dump = path_text.as_ptr();
    (scene.friction.previous_traction, scene.friction.rigid_slip) = ([null(); 2], [null(); 2]);
    let entries = [0.001, 0.0, 0.0, f64::NAN, 0.0, 0.0];
    let mut force = [0.0; 4];
    let mut results = contact_normal_friction_results { force: force.as_mut_ptr(), ..Default::default() };
    // SAFETY: structs with the arrays that they declare.
    let status = unsafe {
        let at = entries.as_ptr();
        let (scene, options) = (&raw const scene.scene, &raw const scene.options);
        contact_normal_solve_tangential(null_mut(), scene, null(), options, 2, at, &mut results, null_mut())
    };
    assert_eq!(status, CONTACT_NORMAL_NOT_FINITE, "{}", last_error());
    assert_eq!(reproduced(&path, "contact_normal_solve_tangential"), status);
}

/// A surface callback that writes a ball.
unsafe extern "C" fn ball(mx: i32, my: i32, dx: f64, dy: f64, h: *mut f64, _: *mut libc::c_void) -> i32 {
    for iy in 0..my {
        for ix in 0..mx {
            let (x, y) = ((f64::from(ix) + 0.5) * dx - 1.5, (f64::from(iy) + 0.5) * dy - 0.625);
            // SAFETY: room for all values.
            unsafe { h.add((iy * mx + ix) as usize).write(0.05 * (x * x + y * y)) };
        }
    }
    0
}

#[test]
fn accuracies_are_asked_for_again_with_the_surfaces_of_a_callback() {
    let path = folder("accuracy").join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new("");
    scene.options.dump = path_text.as_ptr();
    for surface in [None, Some(ball as _)] {
        let mut accuracy = contact_normal_accuracy { surface, max_elements: 400, target: 1e-7, ..Default::default() };
        let mut report = contact_normal_report::default();
        // SAFETY: structs with the arrays that they declare.
        let status = unsafe {
            contact_normal_solve_to_accuracy(&scene.scene, &scene.options, &mut accuracy, null_mut(), &mut report)
        };
        assert!(status > 0, "{status}: {}", last_error());
        assert_eq!(reproduced(&path, "contact_normal_solve_to_accuracy"), status);
    }
    let accuracy = contact_normal_accuracy { surface: Some(ball), ..Default::default() };
    let (targets, mut row) = ([2.0], contact_normal_price::default());
    // SAFETY: as above.
    let status = unsafe {
        let at = targets.as_ptr();
        contact_normal_cost_of_accuracy(&scene.scene, &scene.options, &accuracy, 0, 1, at, &mut row)
    };
    assert_eq!(status, CONTACT_NORMAL_INVALID_ARGUMENT);
    assert_eq!(reproduced(&path, "contact_normal_cost_of_accuracy"), status);
}

#[test]
fn stresses_are_asked_for_again() {
    let path = folder("stress").join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new("patches");
    scene.options.dump = path_text.as_ptr();
    let (pressure, depths, points) = ([1.0; 30], [0.1, -2.0], [0.0, 0.0, -1.0]);
    let (mut values, mut stress) = ([0.0; 60], [0.0; 6]);
    let mut outputs = contact_normal_stress_outputs { von_mises: values.as_mut_ptr(), ..Default::default() };
    let (p, none, options) = (pressure.as_ptr(), null(), &raw const scene.options);
    // SAFETY (both): structs with the arrays that they declare.
    let status = unsafe {
        contact_normal_subsurface_stress(&scene.scene, 1, p, none, none, depths.as_ptr(), 2, options, &mut outputs)
    };
    assert_eq!(status, CONTACT_NORMAL_INVALID_ARGUMENT, "{}", last_error());
    assert_eq!(reproduced(&path, "contact_normal_subsurface_stress"), status);
    let (at, to) = (points.as_ptr(), stress.as_mut_ptr());
    let status = unsafe { contact_normal_stress_at_points(&scene.scene, 1, p, none, none, at, 1, options, to) };
    assert_eq!(status, CONTACT_NORMAL_INVALID_ARGUMENT, "{}", last_error());
    assert_eq!(reproduced(&path, "contact_normal_stress_at_points"), status);
}

#[test]
fn the_program_makes_the_call_again_and_says_whether_it_ends_alike() {
    let folder = folder("program");
    let path = folder.join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new("layer");
    scene.options.dump = path_text.as_ptr();
    (scene.options.max_cycles, scene.options.tolerance) = (1, 1e-13);
    let (status, _) = scene.solve();
    let run = |path: &Path| {
        let output = Command::new(env!("CARGO_BIN_EXE_contact-normal-replay")).arg(path).output().expect("the program");
        (output.status.code(), String::from_utf8(output.stdout).expect("text"))
    };
    let (code, said) = run(&path);
    assert!(code == Some(0) && said.ends_with("\nreproduced\n"), "{code:?}: {said}");
    assert!(said.contains(&format!("again: status {status} (stopped at a limit)")), "{said}");
    // A dump with another status is not reproduced, and the program says so.
    let bytes = std::fs::read(&path).expect("a dump");
    let at = bytes.windows(9).position(|bytes| bytes == b"\nstatus 1").expect("the status");
    let mut other = bytes.clone();
    other[at + 8] = b'3';
    std::fs::write(folder.join("other"), other).expect("a writable folder");
    let (code, said) = run(&folder.join("other"));
    assert!(code == Some(1) && said.ends_with("\nnot reproduced\n"), "{code:?}: {said}");
    assert_eq!(run(&folder.join("none")).0, Some(2));
}
