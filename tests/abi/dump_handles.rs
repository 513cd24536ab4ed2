//! Dumps of solves with a handle, and files that are no valid dumps.

use std::path::Path;
use std::ptr::{null, null_mut};

use contact_normal::ffi::dump::Dump;
use contact_normal::ffi::*;

use crate::call::last_error;
use crate::dump::{files, folder, text};
use crate::dump_scene::Everything;

/// The status and the report of a solve with a handle.
unsafe fn solve(handle: *mut contact_normal_solver, scene: &Everything) -> (i32, contact_normal_report) {
    let mut report = contact_normal_report::default();
    // SAFETY: the caller's handle, and structs with the arrays that they declare.
    let status = unsafe { contact_normal_solver_solve(handle, &scene.scene, &scene.options, null_mut(), &mut report) };
    (status, report)
}

fn written(path: &Path) -> Dump {
    Dump::read(&std::fs::read(path).expect("a dump")).expect("a dump that can be read")
}

#[test]
fn a_handle_goes_on_from_what_is_in_the_file() {
    for effects in ["", "influence", "row_tables", "friction"] {
        let path = folder(&format!("handle_{effects}")).join("failed");
        let path_text = text(&path);
        let mut scene = Everything::new(effects);
        let mut handle = null_mut();
        // SAFETY (all): structs with the arrays that they declare, and a handle of this test.
        unsafe {
            assert_eq!(contact_normal_solver_new(&scene.scene, &scene.options, &mut handle), CONTACT_NORMAL_OK);
            let solve = |scene: &Everything| solve(handle, scene);
            assert_eq!(solve(&scene).0, CONTACT_NORMAL_OK, "{}", last_error());
            if effects == "friction" {
                // A solve without friction does not change the tractions from which the next step continues.
                let friction = std::mem::replace(&mut scene.scene.friction, null());
                assert_eq!(solve(&scene).0, CONTACT_NORMAL_OK, "{}", last_error());
                scene.scene.friction = friction;
            }
            let mut before = vec![f64::NAN; 30];
            let mut fields = contact_normal_fields { pressure: before.as_mut_ptr(), ..Default::default() };
            assert_eq!(contact_normal_solver_fields(handle, &mut fields), CONTACT_NORMAL_OK);
            // The handle has the coefficients, so that the scene need not have them.
            (scene.scene.influence, scene.scene.row_tables) = (null(), null());
            scene.options.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS;
            (scene.options.max_cycles, scene.options.tolerance) = (1, 1e-18);
            scene.scene.approach *= 1.1;
            if effects == "friction" {
                scene.friction.previous_traction = [null(); 2];
                scene.friction.continues = 1;
            }
            scene.options.dump = path_text.as_ptr();
            let (status, _) = solve(&scene);
            assert!(status > 0, "{effects}: {status}: {}", last_error());
            let dump = written(&path);
            assert_eq!(dump.doubles("handle.pressure"), Some(before), "{effects}");
            assert_eq!(dump.doubles("handle.traction_x").is_some(), effects == "friction");
            assert_eq!(
                dump.doubles(&format!("handle.{effects}")).is_some(),
                effects.contains("_") || effects == "influence"
            );
            let again = dump.replay().expect("a call");
            assert_eq!(again.status, status, "{effects}: {}", last_error());
            contact_normal_solver_free(handle);
        }
    }
}

/// A step of unlike bodies continues from the previous pressures, because the tangential displacements are those by the change of the pressures.
#[test]
fn a_step_of_unlike_bodies_goes_on_from_the_pressures_in_the_file() {
    let path = folder("unlike").join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new("friction");
    (scene.scene.shear_modulus[1], scene.scene.poisson_ratio[1]) = (1e4, 0.1);
    let mut handle = null_mut();
    // SAFETY (all): structs with the arrays that they declare, and a handle of this test.
    unsafe {
        assert_eq!(contact_normal_solver_new(&scene.scene, &scene.options, &mut handle), CONTACT_NORMAL_OK);
        let solve = |scene: &Everything| solve(handle, scene);
        assert_eq!(solve(&scene).0, CONTACT_NORMAL_OK, "{}", last_error());
        scene.friction.previous_traction = [null(); 2];
        scene.friction.continues = 1;
        (scene.options.max_cycles, scene.options.tolerance) = (400, 1e-18);
        scene.options.dump = path_text.as_ptr();
        scene.scene.approach *= 1.5;
        let (status, report) = solve(&scene);
        assert!(status > 0, "{}", last_error());
        contact_normal_solver_free(handle);
        let dump = written(&path);
        assert!(dump.doubles("handle.pressure_before").is_some());
        let again = dump.replay().expect("a call");
        assert_eq!(again.status, status, "{}", last_error());
        let (force, other) = (report.tangential.force, again.report.expect("a report").tangential.force);
        let off = (force[0] - other[0]).hypot(force[1] - other[1]);
        assert!(off <= 1e-9 * force[0].hypot(force[1]), "{force:?} {other:?}");
    }
}

/// Elements at their limit belong to the contact area of an initial guess. Otherwise their p would begin at 0, and the repeated call would differ.
#[test]
fn a_start_beside_a_limit_is_the_same_again() {
    let path = folder("limit").join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new("pressure_limit");
    let mut handle = null_mut();
    // SAFETY (all): structs with the arrays that they declare, and a handle of this test.
    unsafe {
        assert_eq!(contact_normal_solver_new(&scene.scene, &scene.options, &mut handle), CONTACT_NORMAL_OK);
        let solve = |scene: &Everything| solve(handle, scene);
        assert_eq!(solve(&scene).0, CONTACT_NORMAL_OK, "{}", last_error());
        let mut contact = vec![0; 30];
        let mut fields = contact_normal_fields { contact: contact.as_mut_ptr(), ..Default::default() };
        assert_eq!(contact_normal_solver_fields(handle, &mut fields), CONTACT_NORMAL_OK);
        assert!(contact.contains(&2), "no element is at its limit");
        scene.options.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS;
        (scene.options.max_cycles, scene.options.tolerance) = (1, 1e-18);
        scene.options.dump = path_text.as_ptr();
        let (status, report) = solve(&scene);
        assert!(status > 0, "{}", last_error());
        contact_normal_solver_free(handle);
        let dump = written(&path);
        let again = dump.replay().expect("a call").report.expect("a report");
        let (force, other) = (report.normal.force, again.normal.force);
        assert!((force - other).abs() <= 1e-9 * force, "{force} {other}");
    }
}

/// A step of viscoelastic bodies continues from the history in the file, with the pressures and the time of the call.
#[test]
fn a_step_in_time_goes_on_from_the_history_in_the_file() {
    let path = folder("history").join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new("visco");
    let mut visco = contact_normal_visco::default();
    let mut handle = null_mut();
    // SAFETY (all): structs with the arrays that they declare, and a handle of this test.
    unsafe {
        visco.clone_from(&*scene.scene.visco);
        scene.scene.visco = &visco;
        assert_eq!(contact_normal_solver_new(&scene.scene, &scene.options, &mut handle), CONTACT_NORMAL_OK);
        let solve = |scene: &Everything| solve(handle, scene);
        assert_eq!(solve(&scene).0, CONTACT_NORMAL_OK, "{}", last_error());
        let later = contact_normal_visco { continues: 1, time_step: 0.3, ..visco };
        scene.scene.visco = &later;
        assert_eq!(solve(&scene).0, CONTACT_NORMAL_OK, "{}", last_error());
        let last = contact_normal_visco { time_step: 0.2, ..later };
        scene.scene.visco = &last;
        (scene.options.max_cycles, scene.options.tolerance) = (1, 1e-18);
        scene.options.dump = path_text.as_ptr();
        let (status, report) = solve(&scene);
        assert!(status > 0, "{status}: {}", last_error());
        contact_normal_solver_free(handle);
        let dump = written(&path);
        // The history has u = A p and, for each branch of a body, a field of 30 elements.
        assert_eq!(dump.doubles("handle.history").map(|history| history.len()), Some(2 + 6 * 30));
        let again = dump.replay().expect("a call");
        assert_eq!(again.status, status, "{}", last_error());
        // The steps are 0.4 (from rest), 0.3 and 0.2.
        assert!(
            (report.visco.time - 0.9).abs() <= 1e-15 && again.report.expect("a report").visco.time == report.visco.time
        );
        assert_eq!(again.report.expect("a report").visco.compliance, report.visco.compliance);
        // The call and its repetition make one iteration each.
        let (force, other) = (report.normal.force, again.report.expect("a report").normal.force);
        assert!((other / force - 1.0).abs() <= 1e-12, "{force} {other}");
        // Refused: the scene has one branch less than the history.
        let mut changed = std::fs::read(&path).expect("a dump");
        let line = b"int32 branches[0] 2\n";
        let at = changed.windows(line.len()).rposition(|bytes| bytes == line).expect("the branches of body 1");
        changed[at + line.len() - 2] = b'1';
        let less = Dump::read(&changed).expect("a dump that can be read").replay().expect("a call");
        assert_eq!(less.status, CONTACT_NORMAL_INVALID_ARGUMENT, "{}", last_error());
        assert!(last_error().contains("a history has 6 fields; steps of these bodies keep 5"), "{}", last_error());
    }
}

#[test]
fn a_batch_leaves_the_scenes_that_fail() {
    let folder = folder("batch");
    let path_text = text(&folder.join("%n"));
    let (good, mut bad) = (Everything::new(""), Everything::new(""));
    bad.h[3] = f64::NAN;
    let scenes = [good.scene, bad.scene, good.scene];
    let mut options = good.options;
    options.dump = path_text.as_ptr();
    let mut handle = null_mut();
    // SAFETY: structs with the arrays that they declare, and a handle of this test.
    unsafe {
        assert_eq!(contact_normal_solver_new(&good.scene, &options, &mut handle), CONTACT_NORMAL_OK);
        let status =
            contact_normal_solver_solve_batch(handle, 3, scenes.as_ptr(), &options, null_mut(), null_mut(), null_mut());
        contact_normal_solver_free(handle);
        assert_eq!(status, CONTACT_NORMAL_NOT_FINITE);
    }
    assert!(last_error().contains("problem 1: ") && last_error().contains("is in "), "{}", last_error());
    let names = files(&folder);
    assert_eq!(names.len(), 1, "{names:?}");
    let dump = Dump::read(&std::fs::read(folder.join(&names[0])).expect("a dump")).expect("a dump that can be read");
    assert_eq!(dump.call(), "contact_normal_solver_solve");
    assert_eq!(dump.replay().expect("a call").status, CONTACT_NORMAL_NOT_FINITE);
}

/// A damaged file is an error, and a call with wrong lengths is refused, whatever the file contains. Nothing crashes.
#[test]
fn files_that_were_changed_are_read_without_harm() {
    let path = folder("changed").join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new("layer pressure_limit patches");
    scene.options.dump = path_text.as_ptr();
    (scene.options.max_cycles, scene.options.tolerance) = (1, 1e-13);
    scene.solve();
    let bytes = std::fs::read(&path).expect("a dump");
    let mut state = 12345u64;
    let mut random = |n: usize| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize % n
    };
    let (mut read, mut refused) = (0, 0);
    for _ in 0..2000 {
        let mut changed = bytes.clone();
        for _ in 0..1 + random(3) {
            // Most of the file, and so most changes, are text.
            let at = random(changed.len());
            match random(4) {
                0 => changed[at] = random(256) as u8,
                1 => changed[at] = b"0123456789-NULL \n"[random(17)],
                2 => drop(changed.drain(at..(at + random(40)).min(bytes.len().min(changed.len())).max(at))),
                _ => changed.insert(at, b'9'),
            }
        }
        match Dump::read(&changed) {
            Err(why) => assert!(!why.is_empty()),
            Ok(dump) if dump.options().is_some_and(|options| options.max_cycles <= 1) => {
                read += 1;
                refused += i32::from(dump.replay().is_ok_and(|again| again.status < 0));
            }
            Ok(_) => read += 1,
        }
    }
    assert!(read > 20 && refused > 0, "{read} read, {refused} refused");
}

#[test]
fn a_file_that_says_more_than_it_holds_is_refused() {
    let path = folder("lies").join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new("");
    scene.options.dump = path_text.as_ptr();
    (scene.options.max_cycles, scene.options.tolerance) = (1, 1e-13);
    scene.solve();
    let bytes = std::fs::read(&path).expect("a dump");
    let find = |what: &[u8]| bytes.windows(what.len()).position(|bytes| bytes == what).expect("a line");
    let mut larger = bytes.clone();
    // The text of a dump with 6 elements in x is changed to 9.
    larger[find(b"int32 mx 6") + 9] = b'9';
    let dump = Dump::read(&larger).expect("a dump that can be read");
    assert_eq!(dump.replay().expect("a call").status, CONTACT_NORMAL_INVALID_ARGUMENT);
    assert!(last_error().contains("there are less in the file"), "{}", last_error());
    assert!(Dump::read(&bytes[..bytes.len() - 8]).is_err());
    assert!(Dump::read(b"").is_err() && Dump::read(b"contact-normal dump 2\n").is_err());
}
