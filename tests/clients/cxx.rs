//! The C++ header, contact_normal.hpp: its classes do what they promise, pointers that would dangle do not compile, and a time loop takes as many
//! instructions as in C.

use std::path::Path;
use std::process::{Command, Output};

use crate::c::{compile, compiler};
use crate::description::Description;
use crate::generated::header;
use crate::support::{finished, root, run, run_linked, run_under_valgrind, scratch};

/// The command of the C++ compiler with the warnings of a strict user.
fn strict(standard: &str) -> Command {
    let mut strict = compiler("g++", standard);
    strict.arg("-Wshadow");
    strict
}

#[test]
fn the_cxx_header_keeps_its_promises_in_17() {
    keeps_its_promises("c++17", run_under_valgrind);
}

#[test]
fn the_cxx_header_keeps_its_promises_in_20() {
    keeps_its_promises("c++20", run_linked);
}

/// Joins the checks in one program, because valgrind would translate the library anew for each program.
fn keeps_its_promises(standard: &str, run_it: fn(&Path, &[&str], &Path) -> String) {
    let folder = scratch(&format!("cxx_header_{standard}"));
    let parts = [("cxx_header", 52), ("cxx_rest", 78), ("cxx_refusals", 28)];
    let declared: String = parts.iter().map(|(part, _)| format!("int {part}();\n")).collect();
    let calls: String = parts.iter().map(|(part, _)| format!("    failed += {part}();\n")).collect();
    let main = folder.join("all.cpp");
    let text = format!("{declared}int main()\n{{\n    int failed = 0;\n{calls}    return failed;\n}}\n");
    std::fs::write(&main, text).expect("a source");
    let mut link = Command::new("g++");
    link.arg(main);
    for (part, _) in parts {
        let object = folder.join(format!("{part}.o"));
        let source = root().join(format!("tests/clients/{part}.cpp"));
        run(strict(standard).arg("-O2").arg(format!("-Dmain={part}")).arg("-c").arg(source).arg("-o").arg(&object));
        link.arg(object);
    }
    let program = folder.join("all");
    run(link.arg("-o").arg(&program).arg("-L").arg(&folder).args(["-lcontact_normal", "-lm"]));
    let expected: String = parts.iter().map(|(_, checks)| format!("0 of {checks} checks failed\n")).collect();
    assert_eq!(run_it(&program, &[], &folder), expected, "{standard}");
}

#[test]
fn the_cxx_examples_print_what_is_expected() {
    let folder = scratch("cxx_examples");
    for name in ["hertz", "adhesion", "laws", "visco", "flash_temperature", "wear"] {
        let program = compile(compiler("g++", "c++17"), &format!("cxx_examples/{name}.cpp"), &folder);
        let expected = std::fs::read_to_string(root().join(format!("cxx_examples/{name}.expected"))).expect("expected");
        assert_eq!(run_linked(&program, &[], &folder), expected, "{name}");
    }
}

/// The names of the files of which the C++ header consists.
fn parts() -> Vec<String> {
    let files = std::fs::read_dir(root().join("include")).expect("include/");
    let names = files.map(|file| file.expect("a file").file_name().into_string().expect("UTF-8"));
    let mut parts: Vec<String> = names.filter(|name| name.ends_with(".hpp")).collect();
    parts.sort();
    assert!(parts.len() > 5, "{parts:?}");
    parts
}

#[test]
fn each_part_of_the_cxx_header_can_be_included_alone() {
    let folder = scratch("cxx_parts");
    for part in parts() {
        let source = folder.join("part.cpp");
        std::fs::write(&source, format!("#include <{part}>\nint main() {{}}\n")).expect("a source");
        run(strict("c++17").arg("-fsyntax-only").arg(&source));
    }
}

/// The C++ header calls every function of the C header, and sets every member of the C structs, except for structs that it passes on unchanged.
#[test]
fn the_cxx_header_has_every_function_and_member_of_the_header() {
    let read = |name: &String| std::fs::read_to_string(root().join("include").join(name)).expect("a part");
    let wrapper: String = parts().iter().map(read).collect();
    let header = header();
    let as_they_are = [
        "options",
        "cycle",
        "report",
        "accuracy",
        "price",
        "quantity_row",
        "effects_row",
        "progress",
        "hertz",
        "ledger",
        "solver_info",
        "stress_maximum",
        "flash",
        "worn",
    ];
    for each in Description::of(&header).structs {
        if as_they_are.iter().any(|name| each.short_name().starts_with(name)) {
            continue;
        }
        for member in each.members.iter().map(|member| &member.name) {
            let is_set = [".", "->"].iter().any(|before| wrapper.contains(&format!("{before}{member}")));
            let is_none = member == "struct_size" || member.starts_with("reserved");
            assert!(is_set || is_none, "{}: {member}", each.name);
        }
    }
    let words = header.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '('));
    let names = words.filter_map(|word| word.split_once('(').map(|(name, _)| name));
    let functions: Vec<&str> = names.filter(|name| name.starts_with("contact_normal_")).collect();
    assert!(functions.contains(&"contact_normal_solver_solve_batch") && functions.len() > 40, "{functions:?}");
    for name in functions {
        // The `_init` functions of the header call `contact_normal_init`.
        assert!(name == "contact_normal_init" || wrapper.contains(name), "{name} is not wrapped");
    }
}

/// The source code before the tested line.
const BEGINNING: &str = "#include <contact_normal.hpp>
#include <array>
#include <vector>
namespace cn = contact_normal;
std::vector<double> made();
const std::vector<double> made_const();
std::vector<std::int32_t> made_integers();
cn::scene made_scene();
";

/// The parameters of the function around the tested line.
const PARAMETERS: &str = "cn::scene &scene, cn::options &how, const std::vector<double> &h, \
const std::vector<std::int32_t> &integers, const cn::stop_flag &flag, const cn::cycle &cycle, cn::solver &solver";

/// Each: a line that keeps a pointer to a variable, the same line with a temporary, and the deleted function that the compiler names for the latter.
const LINES: &[(&str, &str, &str)] = &[
    ("scene.undeformed_distance(h);", "scene.undeformed_distance(made());", "borrowed<T>::borrowed(C&&)"),
    ("scene.undeformed_distance(h);", "scene.undeformed_distance(made_const());", "borrowed<T>::borrowed(C&&)"),
    (
        "scene.undeformed_distance(h);",
        "scene.undeformed_distance(std::array<double, 1>{1.0});",
        "borrowed<T>::borrowed(C&&)",
    ),
    (
        "scene.undeformed_distance(cn::borrowed<double>(h));",
        "scene.undeformed_distance(cn::view<double>(made()));",
        "borrowed<T>::borrowed(C&&)",
    ),
    ("made_scene().undeformed_distance(h);", "made_scene().undeformed_distance(made());", "borrowed<T>::borrowed(C&&)"),
    ("scene.influence(4, 4, h);", "scene.influence(4, 4, made());", "borrowed<T>::borrowed(C&&)"),
    ("scene.row_tables(4, h);", "scene.row_tables(4, made());", "borrowed<T>::borrowed(C&&)"),
    ("scene.layer(h);", "scene.layer(made());", "borrowed<T>::borrowed(C&&)"),
    ("scene.pressure_limit(h);", "scene.pressure_limit(made());", "borrowed<T>::borrowed(C&&)"),
    ("scene.patches(1, integers, h);", "scene.patches(1, made_integers(), h);", "borrowed<T>::borrowed(C&&)"),
    ("scene.patches(1, integers, h);", "scene.patches(1, integers, made());", "borrowed<T>::borrowed(C&&)"),
    ("cn::friction mu(h);", "cn::friction mu(made());", "borrowed<T>::borrowed(C&&)"),
    (
        "cn::friction(0.3).previous_traction(h, h);",
        "cn::friction(0.3).previous_traction(h, made());",
        "borrowed<T>::borrowed(C&&)",
    ),
    ("cn::friction(0.3).rigid_slip(h, h);", "cn::friction(0.3).rigid_slip(made(), h);", "borrowed<T>::borrowed(C&&)"),
    (
        "cn::friction(0.3).influence(4, 4, h, h, h);",
        "cn::friction(0.3).influence(4, 4, h, made(), h);",
        "borrowed<T>::borrowed(C&&)",
    ),
    (
        "cn::friction(0.3).influence_cross(h, h);",
        "cn::friction(0.3).influence_cross(h, made());",
        "borrowed<T>::borrowed(C&&)",
    ),
    (
        "cn::friction(0.3).row_tables(4, 4, h, h, h);",
        "cn::friction(0.3).row_tables(4, 4, h, h, made());",
        "borrowed<T>::borrowed(C&&)",
    ),
    ("cn::loads on{h, h, h};", "cn::loads on{h, made(), h};", "borrowed<T>::borrowed(C&&)"),
    ("auto named = scene.get();", "auto named = made_scene().get();", "get() const &&"),
    ("auto named = scene.layer(1.0).get();", "auto named = made_scene().layer(1.0).get();", "get() const &&"),
    ("auto *handle = solver.get();", "auto *handle = cn::solver(scene).get();", "get() const &&"),
    ("how.stop_by(flag);", "how.stop_by(cn::stop_flag());", "stop_by(const contact_normal::stop_flag&&)"),
    ("how.stop = flag.get();", "how.stop = cn::stop_flag().get();", "get() const &&"),
    ("how.use_cycle(cycle);", "how.use_cycle(cn::cycle());", "use_cycle(const contact_normal_cycle&&)"),
];

/// Compiles a function that consists of these lines. The first is in the third line after `BEGINNING`.
fn tried(lines: &[String], folder: &Path) -> Output {
    let source = folder.join("lines.cpp");
    let body = lines.join("\n");
    std::fs::write(&source, format!("{BEGINNING}void f({PARAMETERS});\nvoid f({PARAMETERS}) {{\n{body}\n}}\n"))
        .expect("a source");
    let mut gxx = Command::new("g++");
    finished(gxx.args(["-std=c++17", "-fsyntax-only", "-I"]).arg(root().join("include")).arg(source))
}

#[test]
fn what_would_dangle_does_not_compile() {
    let folder = scratch("cxx_dangling");
    let alone = |line: &str| format!("{{ {line} }}");
    let good: Vec<String> = LINES.iter().map(|(good, ..)| alone(good)).collect();
    let output = tried(&good, &folder);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let bad: Vec<String> = LINES.iter().map(|(_, bad, _)| alone(bad)).collect();
    let said = String::from_utf8_lossy(&tried(&bad, &folder).stderr).into_owned();
    let errors: Vec<&str> = said.lines().filter(|line| line.contains("error:")).collect();
    assert_eq!(errors.len(), LINES.len(), "{said}");
    for (k, (_, bad, deleted)) in LINES.iter().enumerate() {
        let line = format!("lines.cpp:{}:", BEGINNING.lines().count() + 3 + k);
        let of_line: Vec<&&str> = errors.iter().filter(|error| error.contains(&line)).collect();
        assert_eq!(of_line.len(), 1, "{bad}:\n{said}");
        assert!(of_line[0].contains("use of deleted function") && of_line[0].contains(deleted), "{bad}:\n{said}");
    }
}

/// An array that is read only during the call may be a temporary, and so may a span of a variable.
#[test]
fn what_does_not_dangle_compiles() {
    let folder = scratch("cxx_temporaries");
    let source = folder.join("temporaries.cpp");
    let line = "cn::subsurface_stress(scene, 1, {h}, made()); solver.set_influence(1, 1, made()); \
                cn::solve_tangential(scene, made()); cn::cost_of_accuracy(scene, made()); \
                const cn::scene &lives = made_scene().layer(1.0).force(2.0); auto named = lives.get(); (void)named; \
                scene.undeformed_distance(std::span<const double>(h)); scene.undeformed_distance({h.data(), h.size()});";
    let text = format!("{BEGINNING}#include <span>\nvoid f({PARAMETERS});\nvoid f({PARAMETERS})\n{{\n    {line}\n    (void)how, (void)integers, (void)flag, (void)cycle;\n}}\n");
    std::fs::write(&source, text).expect("a source");
    run(strict("c++20").arg("-fsyntax-only").arg(&source));
}

/// The instructions of 50 solves, counted by callgrind: those of a loop of 60 solves less those of 10.
fn instructions(program: &Path, kind: &str, folder: &Path) -> u64 {
    let count = |steps: &str| -> u64 {
        let mut valgrind = Command::new("valgrind");
        valgrind.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(program).args([kind, steps]);
        let output = finished(valgrind.env("LD_LIBRARY_PATH", folder));
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let collected = said.lines().find_map(|line| line.split_once("Collected : ")).expect("a count");
        collected.1.trim().parse().expect("a number")
    };
    count("60") - count("10")
}

/// In a time loop with a handle the C++ wrapper adds at most 3 % to the instructions of C.
#[test]
fn the_time_loop_takes_no_more_than_that_of_c() {
    let folder = scratch("cxx_overhead");
    let program = compile(strict("c++17"), "tests/clients/cxx_time_loop.cpp", &folder);
    let [cxx, c] = ["cxx", "c"].map(|kind| instructions(&program, kind, &folder));
    assert!(cxx as f64 <= 1.03 * c as f64, "{cxx} instructions; C takes {c}");
}
