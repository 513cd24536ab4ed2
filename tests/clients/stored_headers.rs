//! Programs and libraries of different versions. A program that was compiled with the header of a released version runs unchanged on today's library,
//! which writes nothing beyond the program's structs. A program of a later header runs on it, too; if it sets members that the library does not know,
//! the call is refused, and the message names them. The headers of released versions are in tests/clients/headers.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::description::Description;
use crate::generated::header;
use crate::support::{finished, root, run, run_under_valgrind, scratch};

const FOLDER: &str = "tests/clients/headers";

/// The folders of the stored headers, each named by its version.
fn stored() -> Vec<PathBuf> {
    let folders = std::fs::read_dir(root().join(FOLDER)).expect("stored headers");
    let mut folders: Vec<PathBuf> = folders.map(|folder| folder.expect("a folder").path()).collect();
    folders.sort();
    assert!(!folders.is_empty());
    folders
}

/// Compiles tests/clients/versions.c with the header in `include`, and links it with the library in `folder`.
fn compiled(include: &Path, folder: &Path, flags: &[&str]) -> PathBuf {
    let program = folder.join("versions");
    let mut compiler = Command::new("cc");
    compiler.args(["-std=c99", "-g", "-Wall", "-Wextra", "-pedantic", "-Werror"]).args(flags).arg("-I").arg(include);
    compiler.arg(root().join("tests/clients/versions.c")).arg("-o").arg(&program);
    run(compiler.arg("-L").arg(folder).args(["-lcontact_normal", "-lm"]));
    program
}

/// Until a version is released, its stored header equals today's.
#[test]
fn the_header_of_this_version_is_stored() {
    let version = env!("CARGO_PKG_VERSION");
    let changes = std::fs::read_to_string(root().join("CHANGELOG.md")).expect("CHANGELOG.md");
    let path = root().join(FOLDER).join(version).join("contact_normal.h");
    if changes.contains(&format!("\n## [{version}] - unreleased\n")) {
        if std::env::var_os("CONTACT_NORMAL_WRITE_HEADER").is_some() {
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            std::fs::write(&path, header()).expect("a writable folder");
        }
        let is_same = std::fs::read_to_string(&path).is_ok_and(|stored| stored == header());
        assert!(
            is_same,
            "{} is out of date: run CONTACT_NORMAL_WRITE_HEADER=1 cargo test --test clients stored",
            path.display()
        );
    }
    assert!(path.exists(), "{} is missing", path.display());
}

#[test]
fn programs_of_older_headers_run_on_the_library_of_today() {
    for include in stored() {
        let name = include.file_name().expect("a version").to_string_lossy().into_owned();
        let folder = scratch(&format!("stored_header_{name}"));
        let program = compiled(&include, &folder, &[]);
        assert_eq!(run_under_valgrind(&program, &[], &folder), "all as expected\n", "{name}");
    }
}

/// Writes today's header as that of a later version: each struct that has a kind has two more members.
fn later_header(folder: &Path) -> PathBuf {
    let mut text = header();
    for (each, _) in Description::of(&text).kinds() {
        let end = format!("\n}} {};", each.name);
        assert!(text.contains(&end), "{end}");
        text = text.replace(&end, &format!("\n  double added_later;\n  const void *added_last;{end}"));
    }
    let include = folder.join("include");
    std::fs::create_dir(&include).expect("a folder");
    std::fs::write(include.join("contact_normal.h"), text).expect("a header");
    include
}

#[test]
fn programs_of_a_later_header_run_on_it_and_are_told_what_it_does_not_know() {
    let folder = scratch("later_header");
    let program = compiled(&later_header(&folder), &folder, &["-DLATER"]);
    assert_eq!(run_under_valgrind(&program, &[], &folder), "all as expected\n");
}

/// Before 0.2.0 each struct had an exported `_init`, which wrote the library's whole struct. Programs of that time cannot start with this library,
/// because the soname is another one. A program that loads the library by its file name does not find the function.
#[test]
fn programs_of_abi_1_cannot_call_the_library() {
    let folder = scratch("abi_1");
    let source = folder.join("old.c");
    let text = "extern void contact_normal_scene_init(void *scene);\n\
                int main(void) { char scene[144]; contact_normal_scene_init(scene); return 0; }\n";
    std::fs::write(&source, text).expect("a source");
    let mut compiler = Command::new("cc");
    compiler.arg(&source).arg("-o").arg(folder.join("old")).arg("-L").arg(&folder).arg("-lcontact_normal");
    let output = finished(&mut compiler);
    assert!(!output.status.success());
    assert!(String::from_utf8_lossy(&output.stderr).contains("undefined reference"), "{output:?}");
    let library = folder.join("libcontact_normal.so");
    assert!(
        run(Command::new("objdump").arg("-p").arg(library)).contains("SONAME               libcontact_normal.so.2\n")
    );
}
