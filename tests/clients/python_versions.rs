//! What depends on the version of Python.

use std::path::PathBuf;
use std::process::Command;

use crate::python::in_folder;
use crate::support::{finished, root, scratch};

/// Signals and pickles differ between versions of Python, so that the test runs on each installed version that has numpy.
#[test]
fn signals_and_pickles_work_on_every_python_there_is() {
    let folder = scratch("every_python");
    let versions = (9..30).map(|minor| PathBuf::from(format!("python3.{minor}")));
    let mut tried = 0;
    for python in versions.chain(["python3".into(), "/usr/bin/python3".into()]) {
        let has_numpy =
            Command::new(&python).args(["-c", "import sys, numpy; assert sys.version_info >= (3, 9)"]).output();
        if !has_numpy.is_ok_and(|output| output.status.success()) {
            continue;
        }
        for tests in ["test_interrupts.py", "test_copies.py"] {
            let mut command = in_folder(Command::new(&python), &folder);
            command.args(["-m", "unittest", "discover", "-p", tests, "-s"]).arg(root().join("python/tests"));
            let output = finished(&mut command);
            let told = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success() && !told.contains("Ran 0 tests"), "{}: {told}", python.display());
        }
        tried += 1;
    }
    assert!(tried > 0, "no Python with numpy");
}
