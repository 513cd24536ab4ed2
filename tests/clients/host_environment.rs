//! The library does not change the host: its floating-point environment, its standard output and error, and its ability to fork.

use std::process::Command;

use crate::support::{root, run, run_linked, scratch};

/// Compiles tests/clients/host_environment.c and runs one of its parts, which must succeed and print nothing (`run` also refuses output on stderr).
fn host(part: &str) {
    let folder = scratch(&format!("host_{part}"));
    let program = folder.join("host_environment");
    let mut cc = Command::new("cc");
    // The flag -frounding-math forbids constant folding across a change of the rounding mode.
    cc.args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Werror", "-O1", "-frounding-math"]);
    cc.arg("-I")
        .arg(root().join("include"))
        .arg(root().join("tests/clients/host_environment.c"))
        .arg("-o")
        .arg(&program);
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

/// Compiles tests/clients/host_threads.c with optimisation, as fast hosts are, and runs one of its parts.
fn host_with_threads(part: &str) {
    let folder = scratch(&format!("host_threads_{part}"));
    let program = folder.join("host_threads");
    let mut cc = Command::new("cc");
    cc.args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Werror", "-Ofast", "-fopenmp"]);
    cc.arg("-I").arg(root().join("include")).arg(root().join("tests/clients/host_threads.c")).arg("-o").arg(&program);
    run(cc.arg("-L").arg(&folder).args(["-lcontact_normal", "-lm", "-lpthread"]));
    let mut host = Command::new(&program);
    host.arg(part).env("LD_LIBRARY_PATH", &folder).env("OMP_WAIT_POLICY", "active").current_dir(&folder);
    assert_eq!(run(&mut host), "", "something was printed");
}

#[test]
fn eight_threads_solve_on_handles_of_their_own() {
    host_with_threads("own_handles");
}

#[test]
fn a_solve_beside_spinning_openmp_threads_is_the_same() {
    host_with_threads("openmp");
}

#[test]
fn a_child_that_is_forked_beside_a_first_call_does_not_wait() {
    host_with_threads("first_calls");
}

#[test]
fn signals_reach_the_threads_of_the_host() {
    host_with_threads("signals");
}

#[test]
fn calls_at_the_end_of_the_process_solve_and_have_messages() {
    host_with_threads("at_the_end");
}
