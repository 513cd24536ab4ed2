//! The C clients: the header compiled alone, every example with its expected output and a certificate of the solution that it wrote, and a program in
//! C++11.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::{
    assert_certified, finished, recompute, root, run, run_linked, scratch, Recomputed, EXAMPLES_OF_EFFECTS,
};
use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace};
use contact_normal::scene::Bodies;

const WARNINGS: [&str; 5] = ["-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Werror"];

/// The tolerance that the examples set.
const TOLERANCE: f64 = 1e-9;

/// The command of a compiler with the warning flags of the repository.
pub fn compiler(name: &str, standard: &str) -> Command {
    let mut command = Command::new(name);
    command.arg(format!("-std={standard}")).args(WARNINGS).arg("-I").arg(root().join("include"));
    command
}

/// Compiles one source, and links it with the library in `folder`. Returns the program.
pub fn compile(mut compiler: Command, source: &str, folder: &Path) -> PathBuf {
    let program = folder.join(Path::new(source).file_stem().expect("a file name"));
    compiler.arg("-O2").arg(root().join(source)).arg("-o").arg(&program);
    run(compiler.arg("-L").arg(folder).args(["-lcontact_normal", "-lm"]));
    program
}

/// Compiles and runs an example, and compares its output. Returns the measures of the solution that it wrote, recomputed.
fn check_example(name: &str, arguments: &[&str]) -> Recomputed {
    let folder = scratch(&format!("c_{name}"));
    let program = compile(compiler("cc", "c99"), &format!("c_examples/{name}.c"), &folder);
    let solution = folder.join("solution.txt");
    let mut arguments = arguments.to_vec();
    arguments.push(solution.to_str().expect("a path in UTF-8"));
    let printed = run_linked(&program, &arguments, &folder);
    let printed: String =
        printed.lines().filter(|line| !line.starts_with("time:")).map(|line| format!("{line}\n")).collect();
    let expected = root().join(format!("c_examples/{name}.expected"));
    let expected = std::fs::read_to_string(&expected).unwrap_or_else(|e| panic!("{}: {e}", expected.display()));
    assert!(printed == expected, "{name} printed\n{printed}\nexpected was\n{expected}");
    certificate(&solution)
}

/// The measures of a solution in a file: "mx my dx dy approach", then "h p contact" for each element. All examples have two steel bodies.
fn certificate(solution: &Path) -> Recomputed {
    let text = std::fs::read_to_string(solution).expect("the file that the example wrote");
    let mut lines = text.lines().map(|line| -> Vec<f64> {
        line.split_whitespace().map(|word| word.parse().unwrap_or_else(|e| panic!("{word}: {e}"))).collect()
    });
    let head = lines.next().expect("a first line");
    let grid = Grid::new(head[0] as usize, head[1] as usize, head[2], head[3]).expect("a grid");
    let elements: Vec<Vec<f64>> = lines.collect();
    assert_eq!(elements.len(), grid.len(), "one line per element");
    let column = |k: usize| -> Vec<f64> { elements.iter().map(|element| element[k]).collect() };
    let contact: Vec<bool> = elements.iter().map(|element| element[2] != 0.0).collect();
    assert!(contact.contains(&true), "there is contact");
    let steel = Bodies::same(82000.0, 0.28);
    let influence = Coefficients::from(HalfSpace::new(grid.dx, grid.dy, steel.compliance()));
    recompute(&grid, &influence, &column(0), head[4], &column(1), &contact)
}

/// The sum of p dx dy equals the prescribed force to round-off: 1e-12 is some 5000 units in the last place, more than the error of a sum of n <= 8360
/// pressures.
fn assert_force(found: f64, prescribed: f64) {
    assert!((found - prescribed).abs() <= 1e-12 * prescribed, "force is {found}; prescribed was {prescribed}");
}

#[test]
fn ledger() {
    // The example has the default tolerance.
    assert_certified(&check_example("ledger", &["256"]), 1e-6);
}

#[test]
fn hertz() {
    assert_certified(&check_example("hertz", &["128"]), TOLERANCE);
}

#[test]
fn wheel_rail() {
    let data = root().join("data/wheel_rail/y4_82kN.txt");
    let measures = check_example("wheel_rail", &[data.to_str().expect("a path in UTF-8")]);
    assert_certified(&measures, TOLERANCE);
    let text = std::fs::read_to_string(&data).expect("the data");
    let prescribed = text.lines().nth(3).and_then(|line| line.split(' ').nth(5)).expect("the fourth line");
    assert_force(measures.force, prescribed.parse().expect("a force"));
}

/// Gaps from files that the Python package wrote: heights of a rough surface with holes, and a wheel on a rail.
#[test]
fn gap() {
    let file = gap_file("ground");
    let measures = check_example("gap", &[&file, "1.2288"]);
    assert_certified(&measures, TOLERANCE);
    assert_force(measures.force, 1.2288);
}

/// The path of a gap that Python's `Gap.write` wrote.
pub fn gap_file(name: &str) -> String {
    root().join(format!("data/gaps/{name}.txt")).to_string_lossy().into_owned()
}

#[test]
fn norm_inner_solve() {
    // The example's inner solves have a tolerance of 1e-9.
    assert_certified(&check_example("norm_inner_solve", &[]), 1e-9);
}

#[test]
fn batch() {
    assert_certified(&check_example("batch", &[]), TOLERANCE);
}

#[test]
fn to_accuracy() {
    let measures = check_example("to_accuracy", &[]);
    assert_certified(&measures, TOLERANCE);
    assert_force(measures.force, 82000.0);
}

#[test]
fn time_steps() {
    let measures = check_example("time_steps", &[]);
    assert_certified(&measures, TOLERANCE);
    // The force of the last step, as the example computes it.
    let phase = 2.0 * std::f64::consts::PI * 99.0 / 100.0;
    assert_force(measures.force, 80000.0 * (1.0 + 0.1 * phase.sin()));
}

/// The other examples print what is expected. Other tests compare their solutions with closed forms and direct sums.
#[test]
fn the_effects() {
    for name in EXAMPLES_OF_EFFECTS {
        let folder = scratch(&format!("c_{name}"));
        let program = compile(compiler("cc", "c99"), &format!("c_examples/{name}.c"), &folder);
        let printed = run_linked(&program, &[], &folder);
        let expected = std::fs::read_to_string(root().join(format!("c_examples/{name}.expected"))).expect("expected");
        assert!(printed == expected, "{name} printed\n{printed}\nexpected was\n{expected}");
    }
}

#[test]
fn an_example_fails_with_the_message_of_the_library() {
    let folder = scratch("c_failure");
    let program = compile(compiler("cc", "c99"), "c_examples/wheel_rail.c", &folder);
    let data = folder.join("bad.txt");
    std::fs::write(&data, "#\n#\n#\n1 1 0.2 0.2 0.1 -5 82000 0.28\n0 0 0\n").expect("a writable scratch folder");
    let output = finished(Command::new(program).arg(&data).env("LD_LIBRARY_PATH", &folder));
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("force is -5") && output.stdout.is_empty(), "{said}");
}

#[test]
fn the_header_alone_is_clean_c99_and_cxx11() {
    let header = root().join("include/contact_normal.h");
    // The header is the only include of the source, as in a user's program.
    let folder = scratch("header_alone");
    let source = folder.join("header_alone.c");
    std::fs::write(&source, format!("#include \"{}\"\nint main(void) {{ return 0; }}\n", header.display()))
        .expect("scratch");
    let object = folder.join("header_alone.o");
    run(compiler("cc", "c99").arg("-c").arg(&source).arg("-o").arg(&object));
    run(compiler("g++", "c++11").args(["-x", "c++", "-c"]).arg(&source).arg("-o").arg(&object));
}

#[test]
fn a_cxx11_client() {
    let folder = scratch("cxx_client");
    let program = compile(compiler("g++", "c++11"), "tests/clients/cxx_client.cpp", &folder);
    assert_eq!(run_linked(&program, &[], &folder), "C++ client: all as expected\n");
}
