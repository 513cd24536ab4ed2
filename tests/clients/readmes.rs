//! The commands in the READMEs of the examples work as they are printed, after `cargo build --release`.

use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

use crate::support::{root, run, scratch};

#[path = "../../build.rs"]
#[allow(dead_code)] // its `main`
mod build;

/// The commands of a README, from indented blocks and fences of sh.
fn commands(readme: &str) -> String {
    let mut script = String::from("set -e\n");
    let mut is_fenced = false;
    for line in readme.lines() {
        match line {
            "```sh" => is_fenced = true,
            "```" => is_fenced = false,
            _ if is_fenced => script += &format!("{line}\n"),
            _ => script.extend(line.strip_prefix("    ").map(|command| format!("{command}\n"))),
        }
    }
    script
}

/// Makes a copy of the project as far as the commands need it, with the library of these tests in the place of that of a release.
fn project(folder: &Path) {
    let release = folder.join("target/release");
    let out = release.join("build/contact-normal-0/out");
    std::fs::create_dir_all(&out).expect("folders");
    let built = std::fs::canonicalize(folder.join("libcontact_normal.so")).expect("the library");
    symlink(built, release.join("libcontact_normal.so")).expect("a link");
    build::link(&out, "libcontact_normal.so", build::SONAME);
    for name in ["include", "data"] {
        symlink(root().join(name), folder.join(name)).expect("a link");
    }
}

#[test]
fn the_commands_of_the_examples_work_as_printed() {
    let folder = scratch("readmes");
    project(&folder);
    for (language, compiler) in [("c", "cc "), ("cxx", "g++ "), ("fortran", "gfortran ")] {
        let examples = format!("{language}_examples");
        let readme = std::fs::read_to_string(root().join(&examples).join("README.md")).expect("a README");
        let script = commands(&readme);
        assert!(script.contains(compiler) && script.contains("./hertz"), "{script}");
        run(Command::new("cp").arg("-r").arg(root().join(&examples)).arg(&folder));
        let printed = run(Command::new("sh")
            .args(["-c", &script])
            .env_remove("LD_LIBRARY_PATH")
            .current_dir(folder.join(&examples)));
        let printed: String =
            printed.lines().filter(|line| !line.starts_with("time")).map(|line| format!("{line}\n")).collect();
        let expected = std::fs::read_to_string(root().join(examples).join("hertz.expected")).expect("what is expected");
        assert_eq!(printed, expected, "{script}");
    }
}

/// The build makes the link of the soname beside the library, if cargo has put the library at its usual place.
#[test]
fn the_build_links_the_soname() {
    let test = std::env::current_exe().expect("this test's path");
    let profile = test.ancestors().nth(2).expect("target/<profile>");
    let link = std::fs::read_link(profile.join(build::SONAME)).expect("a link of the soname");
    assert_eq!(link, Path::new("libcontact_normal.so"));
}

/// If cargo puts the library elsewhere, there is no link, and no error.
#[test]
fn a_build_that_is_laid_out_otherwise_has_no_link() {
    let folder = scratch("no_soname");
    let out = folder.join("elsewhere/contact-normal-0/out");
    std::fs::create_dir_all(&out).expect("folders");
    build::link(&out, "libcontact_normal.so", build::SONAME);
    assert_eq!(std::fs::read_dir(folder.join("elsewhere")).expect("a folder").count(), 1);
}
