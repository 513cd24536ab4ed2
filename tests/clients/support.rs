//! Shared by the tests of the C, C++, Fortran and Python clients: the library as a user links it, a scratch folder, and a certificate recomputed from
//! the arrays that a client wrote.
#![allow(dead_code)] // each test uses its part

use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::{mpsc, OnceLock};
use std::time::Duration;

use contact_normal::grid::Grid;
use contact_normal::influence::Coefficients;
use contact_normal::operator::Operator;
use contact_normal::threads::Threads;

/// The examples of effects, which C and Fortran share. Each prints the text of its file `.expected`.
pub const EXAMPLES_OF_EFFECTS: [&str; 15] = [
    "adhesion",
    "laws",
    "visco",
    "layer",
    "pressure_limit",
    "period",
    "patches",
    "row_tables",
    "coating",
    "subsurface",
    "flash_temperature",
    "wear",
    "friction",
    "creep_forces",
    "own_tables",
];

/// The root folder of the project.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Makes an empty scratch folder for one test, with `libcontact_normal.so` and its soname in it, as after an installation.
pub fn scratch(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a scratch folder");
    // `cargo test` builds the shared library beside the test programs.
    let built = std::env::current_exe().expect("this test's path").with_file_name("libcontact_normal.so");
    assert!(built.exists(), "{} is missing", built.display());
    for name in ["libcontact_normal.so", "libcontact_normal.so.2"] {
        std::os::unix::fs::symlink(&built, folder.join(name)).expect("a link to the library");
    }
    folder
}

/// The time limit of a program: several times that of the slowest one, which runs under valgrind on a busy machine. A program that hangs fails at
/// this limit.
const PATIENCE: Duration = Duration::from_secs(600);

/// Runs a program to its end, within `PATIENCE`.
pub fn finished(command: &mut Command) -> Output {
    finished_within(PATIENCE, command)
}

/// Runs a program to its end, or aborts it and all processes that it started. An aborted Python prints the stacks of its threads on stderr.
fn finished_within(patience: Duration, command: &mut Command) -> Output {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).process_group(0);
    let program = command.spawn().unwrap_or_else(|e| panic!("{command:?}: {e}"));
    let group = format!("-{}", program.id());
    let (ended, end) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            if end.recv_timeout(patience) == Err(mpsc::RecvTimeoutError::Timeout) {
                Command::new("kill").args(["-ABRT", "--", &group]).status().expect("kill");
            }
        });
        let output = program.wait_with_output().expect("its output");
        drop(ended);
        output
    })
}

#[test]
fn a_program_that_hangs_is_ended_with_what_it_started() {
    let output = finished_within(
        Duration::from_millis(200),
        Command::new("sh").args(["-c", "echo begun; sleep 3600; echo woken"]),
    );
    assert!(!output.status.success(), "{}", output.status);
    assert_eq!(String::from_utf8_lossy(&output.stdout), "begun\n");
}

/// Runs a command to its end, and asserts that it succeeds. Returns what it printed.
pub fn run(command: &mut Command) -> String {
    let output = finished(command);
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{command:?}: {}\n{out}\n{err}", output.status);
    assert!(err.trim().is_empty(), "{command:?} wrote to stderr:\n{err}");
    out.into_owned()
}

/// Runs a program that was linked with the library in `folder`. Returns what it printed.
pub fn run_linked(program: &Path, arguments: &[&str], folder: &Path) -> String {
    run(Command::new(program).args(arguments).env("LD_LIBRARY_PATH", folder).current_dir(folder))
}

/// Runs a program that was linked with the library in `folder` under valgrind. Asserts that there is no error, and no memory definitely lost. (The
/// run-time library of Fortran keeps memory for its units, and the library's threads for their transforms; this memory is still reachable, or
/// possibly lost.) Returns the output.
pub fn run_under_valgrind(program: &Path, arguments: &[&str], folder: &Path) -> String {
    assert!(
        Command::new("valgrind").arg("--version").output().is_ok(),
        "valgrind is not installed: install it (Debian, Ubuntu: apt-get install valgrind)"
    );
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--error-exitcode=9", "-q", "--leak-check=full"]);
    valgrind.args(["--show-leak-kinds=definite", "--errors-for-leak-kinds=definite"]);
    run(valgrind.arg(program).args(arguments).env("LD_LIBRARY_PATH", without_lines()).current_dir(folder))
}

/// The folder of a copy of the library without line numbers, which valgrind takes seconds to read at each start. The names of functions remain.
fn without_lines() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = scratch("without_lines");
        let library = folder.join("libcontact_normal.so.2");
        let whole = std::fs::canonicalize(&library).expect("the library");
        std::fs::remove_file(&library).expect("a link");
        run(Command::new("strip").args(["--strip-debug", "-o"]).args([&library, &whole]));
        folder
    })
}

/// The measures of a solution, recomputed from its arrays.
#[derive(Debug)]
pub struct Recomputed {
    /// `||h - approach + A p|| / ||h - approach||` over C.
    pub residual: f64,
    /// The largest `-e` outside C, over the rms of `h - approach` in C.
    pub violation: f64,
    /// `sum of p |e| / sum of p |u|`.
    pub complementarity: f64,
    /// The smallest pressure.
    pub min_pressure: f64,
    /// The sum of p dx dy.
    pub force: f64,
}

/// Recomputes the measures with a fresh product (tested against direct summation in tests/problems/operator.rs).
pub fn recompute(
    grid: &Grid,
    influence: &Coefficients,
    h: &[f64],
    approach: f64,
    p: &[f64],
    contact: &[bool],
) -> Recomputed {
    let operator = Operator::new(influence, grid, &Threads::One).expect("an operator");
    let mut u = vec![0.0; grid.len()];
    operator.apply(p, &mut u, &mut operator.workspace().expect("memory"));
    let (mut r2, mut h2, mut outside, mut gaps, mut energy) = (0.0, 0.0, 0.0f64, 0.0, 0.0);
    for i in 0..grid.len() {
        let e = h[i] - approach + u[i];
        if contact[i] {
            r2 += e * e;
            h2 += (h[i] - approach).powi(2);
        } else {
            assert_eq!(p[i], 0.0, "an exterior element carries a pressure");
            outside = outside.max(-e);
        }
        if p[i] != 0.0 {
            gaps += p[i] * e.abs();
            energy += p[i] * u[i].abs();
        }
    }
    let count = contact.iter().filter(|&&inside| inside).count().max(1);
    Recomputed {
        residual: (r2 / h2).sqrt(),
        violation: outside / (h2 / count as f64).sqrt(),
        complementarity: gaps / energy,
        min_pressure: p.iter().copied().fold(f64::INFINITY, f64::min),
        force: p.iter().sum::<f64>() * grid.element_area(),
    }
}

/// Asserts that every measure is at most `tolerance`, as status OK promises.
pub fn assert_certified(measures: &Recomputed, tolerance: f64) {
    assert!(measures.residual <= tolerance, "{measures:?}");
    assert!(measures.violation <= tolerance, "{measures:?}");
    assert!(measures.complementarity <= tolerance, "{measures:?}");
    assert!(measures.min_pressure >= 0.0, "{measures:?}");
}
