//! The C and C++ clients: the header alone, every example with its expected output and a certificate recomputed from what it
//! wrote, the layout of every struct, a C++ program, the examples under valgrind.

use std::mem::{offset_of, size_of};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::{
    assert_certified, finished, recompute, root, run, run_linked, run_under_valgrind, scratch, Recomputed,
    EXAMPLES_OF_EFFECTS,
};
use contact_normal::ffi::*;
use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace};
use contact_normal::scene::Bodies;

const WARNINGS: [&str; 5] = ["-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Werror"];

/// The tolerance that the examples set.
const TOLERANCE: f64 = 1e-9;

/// A compiler with the flags of the house.
fn compiler(name: &str, standard: &str) -> Command {
    let mut command = Command::new(name);
    command.arg(format!("-std={standard}")).args(WARNINGS).arg("-I").arg(root().join("include"));
    command
}

/// Compiles one source against the library in `folder`.
fn compile(mut compiler: Command, source: &str, folder: &Path) -> PathBuf {
    let program = folder.join(Path::new(source).file_stem().expect("a file name"));
    compiler.arg("-O2").arg(root().join(source)).arg("-o").arg(&program);
    run(compiler.arg("-L").arg(folder).args(["-lcontact_normal", "-lm"]));
    program
}

/// Compiles and runs an example, compares its output, and returns the certificate of the solution that it wrote.
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

/// The certificate of a file "mx my dx dy approach", then "h p contact" per element. All examples are of steel on steel.
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

/// The sum of p dx dy equals the prescribed force to round-off: 1e-12 is some 5000 units in the last place, more than the sum
/// of n <= 8360 pressures can lose.
fn assert_force(found: f64, prescribed: f64) {
    assert!((found - prescribed).abs() <= 1e-12 * prescribed, "force is {found}; prescribed was {prescribed}");
}

#[test]
fn ledger() {
    // The default tolerance.
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

#[test]
fn norm_inner_solve() {
    // The tolerance of its inner solves.
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
    // The force of the last step, as the example prescribes it.
    let phase = 2.0 * std::f64::consts::PI * 99.0 / 100.0;
    assert_force(measures.force, 80000.0 * (1.0 + 0.1 * phase.sin()));
}

/// Their solutions are compared with closed forms and direct sums in tests of their own.
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

/// All of them, as the folder has them, on small inputs: valgrind is some 50 times slower.
#[test]
fn the_examples_under_valgrind() {
    let folder = scratch("c_valgrind");
    let data = root().join("data/wheel_rail/y4_82kN.txt").to_string_lossy().into_owned();
    let small = |text: String| {
        text.replace("COUNT = 200", "COUNT = 5")
            .replace("N = 32, M = 2 * N + 1, DEPTHS = 101", "N = 8, M = 2 * N + 1, DEPTHS = 3")
            .replace("STEPS = 100", "STEPS = 4")
            .replace("MX = 48, MY = 36, CREEPAGES = 7", "MX = 16, MY = 12, CREEPAGES = 7")
            .replace("MX = 48, MY = 48", "MX = 16, MY = 16")
    };
    std::fs::copy(root().join("c_examples/example.h"), folder.join("example.h")).expect("a header");
    let mut count = 0;
    for file in std::fs::read_dir(root().join("c_examples")).expect("the examples") {
        let file = file.expect("a file").path();
        if file.extension().is_none_or(|extension| extension != "c") {
            continue;
        }
        let name = file.file_stem().expect("a name").to_string_lossy().into_owned();
        let source = folder.join(format!("{name}.c"));
        std::fs::write(&source, small(std::fs::read_to_string(&file).expect("a source"))).expect("a smaller source");
        let program = compile(compiler("cc", "c99"), source.to_str().expect("a path in UTF-8"), &folder);
        let arguments = match name.as_str() {
            "hertz" | "ledger" => vec!["24"],
            "wheel_rail" => vec![data.as_str()],
            _ => Vec::new(),
        };
        let printed = run_under_valgrind(&program, &arguments, &folder);
        assert!(!printed.is_empty(), "{name}");
        count += 1;
    }
    assert!(count >= 11, "{count} examples");
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
    // As the only include of a source, as a user has it.
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

#[test]
fn the_cxx_header_keeps_its_promises() {
    let folder = scratch("cxx_header");
    for standard in ["c++17", "c++20"] {
        let mut with_shadow = compiler("g++", standard);
        with_shadow.arg("-Wshadow");
        let program = compile(with_shadow, "tests/clients/cxx_header.cpp", &folder);
        assert_eq!(run_under_valgrind(&program, &[], &folder), "0 of 45 checks failed\n", "{standard}");
    }
    let program = compile(compiler("g++", "c++17"), "cxx_examples/hertz.cpp", &folder);
    let expected = std::fs::read_to_string(root().join("cxx_examples/hertz.expected")).expect("hertz.expected");
    assert_eq!(run_linked(&program, &[], &folder), expected);
}

/// Lines "struct size" and "struct.member offset", as tests/clients/abi_sizes.c prints them.
macro_rules! layout {
    ($($name:ident { $($member:ident),+ $(,)? })+) => {{
        let mut lines = Vec::new();
        $(
            lines.push(format!("{} {}", stringify!($name), size_of::<$name>()));
            $(lines.push(format!("{}.{} {}", stringify!($name), stringify!($member), offset_of!($name, $member)));)+
        )+
        lines
    }};
}

#[test]
fn c_and_rust_agree_on_every_struct() {
    let rust = layout! {
        contact_normal_influence {
            struct_size, cx, cy, coefficients, scale
        }
        contact_normal_layer {
            struct_size, compliance, compliances
        }
        contact_normal_pressure_limit {
            struct_size, limit, limits
        }
        contact_normal_period {
            struct_size, x, y
        }
        contact_normal_patches {
            struct_size, count, reserved, patch, factors
        }
        contact_normal_row_tables {
            struct_size, cx, rows, coefficients, scale
        }
        contact_normal_coating {
            struct_size, thickness, shear_modulus, poisson_ratio
        }
        contact_normal_friction {
            struct_size, coefficient, coefficients, motion, continues, prescribed, creepage, spin, spin_centre, force,
            rolling_distance, rolling_direction, spin_offset, previous_traction, rigid_slip,
            influence, influence_cx, influence_cy, influence_scale, sensitivities, reserved, influence_cross
        }
        contact_normal_scene {
            struct_size, mx, my, dx, dy, undeformed_distance, shear_modulus, poisson_ratio, load, reserved,
            approach, force, influence, layer, pressure_limit, period, patches, row_tables, coating, friction
        }
        contact_normal_progress {
            struct_size, mx, my, cycles, active_set_changes, seconds, work_units, update, residual
        }
        contact_normal_options {
            struct_size, method, smoother, pre_sweeps, post_sweeps, relaxation, coarsest, active_set, initial_guess,
            criterion, tolerance, error_ratio, max_cycles, threads, precision, reserved, progress, user
        }
        contact_normal_fields {
            struct_size, pressure, deformed_distance, displacement, contact, traction, slip, adhesion
        }
        contact_normal_ledger_row {
            mx, my, cycles, seconds, work_units, residual, approach, force, max_pressure, contact_area,
            corrected_area, error_force, error_max_pressure, error_contact_area, error_corrected_area, error_pressure,
            contact_count, untrusted, reserved
        }
        contact_normal_report {
            struct_size, cycles, active_set_steps, active_set_changes, matrix_products, work_units, update,
            residual, violation, complementarity, min_pressure, approach, force, max_pressure, contact_area,
            contact_count, error_force, error_max_pressure, error_contact_area, setup_seconds, solve_seconds, bytes,
            ledger_rows, ledger_capacity, ledger, corrected_area, error_corrected_area, error_pressure, untrusted, limited_by,
            halved_seconds, halved_error_force, edge_count, tolerance, tangential_force, tangential_moment, creepage,
            tangential_residual, tangential_gap, stick_count, slip_count, tangential_products, tangential_seconds,
            sensitivities, error_tangential
        }
        contact_normal_friction_results {
            struct_size, force, moment, creepage, residual, gap, products, stick_count, slip_count, status, traction, slip,
            adhesion
        }
        contact_normal_accuracy {
            struct_size, target, max_seconds, max_bytes, max_elements, surface, user, mx, my, dx, dy, reached, seconds,
            max_pressure_target, contact_area_target
        }
        contact_normal_price {
            target, error, tolerance, seconds, seconds_one_thread, bytes, mx, my, dx, dy, obstacle, reserved
        }
        contact_normal_hertz_solution {
            semi_axis_x, semi_axis_y, max_pressure, approach, force, area
        }
        contact_normal_stress_maximum {
            value, x, y, z, ix, iy, depth, reserved
        }
        contact_normal_stress_outputs {
            struct_size, stress, von_mises, maximum_shear, principal, directions, largest_von_mises, largest_shear
        }
    };
    let folder = scratch("abi_sizes");
    let program = compile(compiler("cc", "c99"), "tests/clients/abi_sizes.c", &folder);
    let c: Vec<String> = run_linked(&program, &[], &folder).lines().map(String::from).collect();
    assert_eq!(c, rust);
    let compared: Vec<&str> = c.iter().map(|line| line.split(' ').next().expect("a name")).collect();
    assert_eq!(compared, structs_of_the_header(), "a struct or a member of the header is not compared");
}

/// "struct", then "struct.member" for each of its members, for all structs that the header defines.
fn structs_of_the_header() -> Vec<String> {
    let header = std::fs::read_to_string(root().join("include/contact_normal.h")).expect("the header");
    let (mut names, mut open) = (Vec::new(), None);
    for line in header.lines() {
        if let Some(name) = line.strip_prefix("typedef struct ").and_then(|rest| rest.strip_suffix(" {")) {
            names.push(name.to_string());
            open = Some(name);
        } else if line.starts_with('}') {
            open = None;
        } else if let (Some(name), Some(declaration)) = (open, line.strip_suffix(';')) {
            // "  double shear_modulus[2]": the last word, without its dimensions. Lines of comments end otherwise.
            let word = declaration.rsplit([' ', '*']).next().expect("a word");
            names.push(format!("{name}.{}", word.split('[').next().expect("a member")));
        }
    }
    names
}
