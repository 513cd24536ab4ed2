//! `options->dump`: a call that fails writes a file (a dump) from which the call can be repeated. The dump changes nothing else of the call.

use std::ffi::{CStr, CString};
use std::path::{Path, PathBuf};
use std::ptr::null;

use contact_normal::ffi::dump::Dump;
use contact_normal::ffi::*;

use crate::call::last_error;
use crate::dump_scene::Everything;

/// An empty folder for one test.
pub fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("dump_{test}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a scratch folder");
    folder
}

pub fn text(path: &Path) -> CString {
    CString::new(path.to_str().expect("text")).expect("no 0 in it")
}

/// The names of the files in a folder.
pub fn files(folder: &Path) -> Vec<String> {
    let files = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        files.map(|file| file.expect("a file").file_name().into_string().expect("text")).collect();
    names.sort();
    names
}

/// Makes a solve that fails and writes a dump, and repeats it from the file. Asserts the same status, and the same bits of the report. Returns the
/// status.
fn reproduces(name: &str, scene: &mut Everything) -> i32 {
    let path = folder(name).join("failed");
    let path_text = text(&path);
    scene.options.dump = path_text.as_ptr();
    let (status, report) = scene.solve();
    assert!(status != CONTACT_NORMAL_OK, "{name} did not fail");
    assert!(last_error().contains("what the call was given is in "), "{name}: {}", last_error());
    let dump = Dump::read(&std::fs::read(&path).expect("a dump")).expect("a dump that can be read");
    assert_eq!((dump.status(), dump.call()), (status, "contact_normal_solve"), "{name}");
    assert_eq!(dump.missing(), Vec::<String>::new(), "{name}");
    let again = dump.replay().expect("a call");
    assert_eq!(again.status, status, "{name}: {}", last_error());
    let bits = |report: &contact_normal_report| {
        let (normal, tangential) = (&report.normal, &report.tangential);
        let numbers = [normal.force, normal.approach, normal.residual, normal.max_pressure, tangential.residual];
        (numbers.map(f64::to_bits), report.statistics.cycles)
    };
    assert_eq!(bits(&again.report.expect("a report")), bits(&report), "{name}");
    status
}

#[test]
fn a_solve_with_every_effect_is_made_again_from_its_file() {
    // Combinations of effects that are supported (docs/effects.md).
    for effects in [
        "",
        "layer pressure_limit",
        "coating layer",
        "influence pressure_limit",
        "row_tables",
        "period",
        "patches layer",
        "friction",
        "friction influence tables",
        "friction pressure_limit",
        "adhesion layer",
        "visco pressure_limit",
    ] {
        let mut scene = Everything::new(effects);
        scene.options.max_cycles = 1;
        scene.options.tolerance = 1e-13;
        let status = reproduces(&effects.replace(' ', "_"), &mut scene);
        assert!(status > 0, "{effects}: {status}: {}", last_error());
    }
}

#[test]
fn guesses_and_fixed_contact_areas_are_in_the_file() {
    for (name, guess, fixed) in [("given", true, false), ("fixed", false, true), ("both", true, true)] {
        let mut scene = Everything::new("");
        scene.options.max_cycles = 1;
        scene.options.tolerance = 1e-14;
        scene.options.initial_guess = if guess { CONTACT_NORMAL_INITIAL_GUESS_GIVEN } else { 0 };
        scene.options.active_set = i32::from(fixed);
        scene.with_outputs = true;
        reproduces(name, &mut scene);
    }
}

/// This scene has all effects with all of their arrays, so that the test shows that each of them is in the file. Add new effects here.
#[test]
fn every_pointer_of_a_scene_is_in_the_file() {
    let path = folder("every").join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new(
        "layer pressure_limit coating influence row_tables period patches friction tables tangential_rows adhesion visco",
    );
    scene.options.dump = path_text.as_ptr();
    // A scene with all effects is not supported, but its dump contains them.
    let (status, _) = scene.solve();
    assert_eq!(status, CONTACT_NORMAL_UNSUPPORTED);
    let bytes = std::fs::read(&path).expect("a dump");
    let end = bytes.windows(6).position(|bytes| bytes == b"\ndata ").expect("the end of the text");
    let text = String::from_utf8(bytes[..end].to_vec()).expect("text");
    let mut structure = "";
    for line in text.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        match words[0] {
            "struct" => structure = words[2],
            "pointer"
                if !["contact_normal_report", "contact_normal_fields", "contact_normal_options"]
                    .contains(&structure) =>
            {
                assert!(words[2].parse::<usize>().is_ok(), "{structure}: {line}");
            }
            "pointer" => assert!(words[2] != "unread", "{structure}: {line}"),
            _ => {}
        }
    }
    // The array has as many values as the scene has elements.
    assert!(text.contains("double 30 undeformed_distance\n"), "{text}");
}

#[test]
fn what_is_refused_is_refused_again() {
    type Break = fn(&mut Everything);
    let broken: [(&str, Break, i32); 6] = [
        ("not_a_number", |scene| scene.h[7] = f64::NAN, CONTACT_NORMAL_NOT_FINITE),
        ("null", |scene| scene.scene.undeformed_distance = null(), CONTACT_NORMAL_NULL_POINTER),
        ("method", |scene| scene.options.method = 77, CONTACT_NORMAL_INVALID_ARGUMENT),
        ("grid", |scene| scene.scene.mx = -3, CONTACT_NORMAL_INVALID_ARGUMENT),
        ("size", |scene| scene.scene.struct_size = 16, CONTACT_NORMAL_STRUCT_SIZE),
        ("modulus", |scene| scene.scene.shear_modulus[1] = -0.0, CONTACT_NORMAL_INVALID_ARGUMENT),
    ];
    for (name, spoil, expected) in broken {
        let mut scene = Everything::new("");
        spoil(&mut scene);
        let path = folder(name).join("failed");
        let path_text = text(&path);
        scene.options.dump = path_text.as_ptr();
        assert_eq!(scene.solve().0, expected, "{name}");
        let dump = Dump::read(&std::fs::read(&path).expect("a dump")).expect("a dump that can be read");
        assert_eq!(dump.replay().expect("a call").status, expected, "{name}");
    }
}

unsafe extern "C" fn cancels(_: *const contact_normal_progress, _: *mut libc::c_void) -> i32 {
    1
}

#[test]
fn what_is_solved_or_cancelled_leaves_no_file() {
    let folder = folder("none");
    let path_text = text(&folder.join("failed"));
    let mut scene = Everything::new("layer");
    scene.options.dump = path_text.as_ptr();
    assert_eq!(scene.solve().0, CONTACT_NORMAL_OK);
    scene.options.progress = Some(cancels);
    assert_eq!(scene.solve().0, CONTACT_NORMAL_CANCELLED);
    assert_eq!(files(&folder), Vec::<String>::new());
}

#[test]
fn a_file_that_cannot_be_written_changes_nothing_but_the_message() {
    let mut scene = Everything::new("layer");
    scene.options.max_cycles = 1;
    scene.options.tolerance = 1e-13;
    let (status, report) = scene.solve();
    let folder = folder("unwritable");
    for path in [folder.join("no such folder/failed"), folder.clone(), PathBuf::from("")] {
        let path_text = text(&path);
        scene.options.dump = path_text.as_ptr();
        let (with_dump, again) = scene.solve();
        assert_eq!(with_dump, status);
        assert_eq!(again.normal.force.to_bits(), report.normal.force.to_bits());
        assert!(last_error().contains("; there is no dump: "), "{}", last_error());
    }
    assert_eq!(files(&folder), Vec::<String>::new());
}

/// A dump replaces a regular file, and nothing else: through a link it replaces the link's target, and a pipe or a device stays what it is.
#[test]
fn a_link_stays_and_a_pipe_is_not_replaced() {
    use std::os::unix::fs::{symlink, FileTypeExt};
    let folder = folder("links");
    let (link, pipe, target) = (folder.join("latest"), folder.join("pipe"), folder.join("target"));
    std::fs::write(&target, "before").expect("a file");
    symlink(&target, &link).expect("a link");
    let name = text(&pipe);
    // SAFETY: a path that ends with 0.
    assert_eq!(unsafe { libc::mkfifo(name.as_ptr(), 0o600) }, 0);
    let mut scene = Everything::new("");
    (scene.options.max_cycles, scene.options.tolerance) = (1, 1e-13);
    let to_link = text(&link);
    scene.options.dump = to_link.as_ptr();
    scene.solve();
    assert!(last_error().contains(target.to_str().expect("text")), "{}", last_error());
    assert!(std::fs::symlink_metadata(&link).expect("a link").is_symlink());
    assert!(Dump::read(&std::fs::read(&target).expect("a dump")).is_ok());
    // A link may lead to a file that does not exist yet.
    std::fs::remove_file(&target).expect("a file");
    scene.solve();
    assert!(Dump::read(&std::fs::read(&target).expect("a dump")).is_ok());
    scene.options.dump = name.as_ptr();
    scene.solve();
    assert!(last_error().contains("pipe is no file"), "{}", last_error());
    assert!(std::fs::symlink_metadata(&pipe).expect("a pipe").file_type().is_fifo());
    assert_eq!(files(&folder), ["latest", "pipe", "target"]);
}

#[test]
fn a_path_names_the_process_and_the_dump() {
    let folder = folder("names");
    let path_text = text(&folder.join("%p-%n-%%-%x"));
    let mut scene = Everything::new("");
    scene.options.dump = path_text.as_ptr();
    scene.options.max_cycles = 1;
    scene.options.tolerance = 1e-13;
    scene.solve();
    scene.solve();
    let names = files(&folder);
    assert_eq!(names.len(), 2, "{names:?}");
    let process = std::process::id().to_string();
    assert!(names.iter().all(|name| name.starts_with(&process) && name.ends_with("-%-%x")), "{names:?}");
}

#[test]
fn the_message_of_the_file_is_that_of_the_call() {
    let path = folder("message").join("failed");
    let path_text = text(&path);
    let mut scene = Everything::new("");
    scene.h[0] = f64::NAN;
    scene.options.dump = path_text.as_ptr();
    scene.solve();
    let dump = Dump::read(&std::fs::read(&path).expect("a dump")).expect("a dump that can be read");
    assert!(last_error().starts_with(dump.message()), "{} {}", last_error(), dump.message());
    assert_eq!(CString::new(dump.library()).expect("text").as_c_str(), unsafe {
        // SAFETY: never NULL, static storage.
        CStr::from_ptr(contact_normal_version())
    });
}
