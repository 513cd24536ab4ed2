//! A host keeps what is its own: floating-point environment, standard output and error, and its right to fork.

mod clients;

use std::process::Command;

use clients::{root, run, run_linked, scratch};

/// Compiles tests/host_environment.c and runs one of its parts, which must succeed and print nothing (`run` refuses a word on
/// stderr).
fn host(part: &str) {
    let folder = scratch(&format!("host_{part}"));
    let program = folder.join("host_environment");
    let mut cc = Command::new("cc");
    // No constant folding across a change of the rounding mode.
    cc.args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Werror", "-O1", "-frounding-math"]);
    cc.arg("-I").arg(root().join("include")).arg(root().join("tests/host_environment.c")).arg("-o").arg(&program);
    run(cc.arg("-L").arg(&folder).args(["-lcontact_normal", "-lm"]));
    assert_eq!(run_linked(&program, &[part], &folder), "", "something was printed");
}

#[test]
fn a_strange_rounding_mode_changes_no_bit_and_is_given_back() {
    host("rounding");
}

#[test]
fn a_child_after_a_fork_solves_with_threads() {
    host("fork");
}

#[test]
fn nothing_is_printed_when_a_call_is_refused() {
    host("silent");
}
