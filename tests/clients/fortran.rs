//! The Fortran module and examples, compiled with gfortran and run: all exports, expected output, certificates, and the drop-ins norm_solve and
//! tang_solve.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use crate::c::gap_file;
use crate::description::{Description, Kind};
use crate::generated::header;
use crate::support::{
    assert_certified, recompute, root, run, run_linked, run_under_valgrind, scratch, EXAMPLES_OF_EFFECTS,
};
use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace};

/// Every warning is an error: the module must compile cleanly with the strictest users' flags.
const STRICT: [&str; 5] = ["-std=f2018", "-Wall", "-Wextra", "-pedantic", "-Werror"];

/// The command of the compiler with these flags.
pub fn compiler(flags: &[&str]) -> Command {
    let mut gfortran = Command::new("gfortran");
    gfortran.args(STRICT).args(flags);
    gfortran
}

/// Compiles `source` and the module with `flags`, and returns the program.
fn compile(source: &str, flags: &[&str], folder: &Path) -> PathBuf {
    let name = Path::new(source).file_stem().expect("a file name").to_string_lossy().into_owned();
    let (program, module) = (folder.join(name), module(flags));
    let mut gfortran = compiler(flags);
    gfortran.arg("-I").arg(&module).arg(root().join(source));
    gfortran.arg(module.join("contact_normal.o")).arg("-o").arg(&program);
    run(gfortran.arg("-L").arg(folder).arg("-lcontact_normal").current_dir(folder));
    program
}

/// Compiles the module with these flags, unless this has been done, and returns its folder.
pub fn module(flags: &[&str]) -> PathBuf {
    static COMPILED: Mutex<BTreeMap<String, PathBuf>> = Mutex::new(BTreeMap::new());
    let flags_of_name = flags.concat().replace(['=', ','], "_");
    // A failed compilation poisons the lock, but adds nothing to the map.
    let mut compiled = COMPILED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(folder) = compiled.get(&flags_of_name) {
        return folder.clone();
    }
    let folder = scratch(&format!("fortran_compiled{flags_of_name}"));
    let mut gfortran = compiler(flags);
    gfortran.arg("-c").arg(root().join("include/contact_normal.f90"));
    run(gfortran.current_dir(&folder));
    compiled.insert(flags_of_name, folder.clone());
    folder
}

/// The output of a program without the times.
fn without_times(output: &str) -> String {
    output.lines().filter(|line| !line.starts_with("time")).map(|line| format!("{line}\n")).collect()
}

/// Runs an example, and asserts its expected output. Recomputes the certificate of the arrays that it wrote, and asserts the tolerance.
fn check_example(name: &str, arguments: &[&str], flags: &[&str], tolerance: f64) {
    let folder = scratch(&format!("fortran_{name}{}", flags.concat().replace(['=', ','], "_")));
    let program = compile(&format!("fortran_examples/{name}.f90"), flags, &folder);
    let output = run_linked(&program, &[arguments, &["arrays.txt"]].concat(), &folder);
    let expected = std::fs::read_to_string(root().join(format!("fortran_examples/{name}.expected"))).expect("expected");
    assert_eq!(without_times(&output), expected, "{name} {flags:?}");

    let arrays = std::fs::read_to_string(folder.join("arrays.txt")).expect("the arrays");
    let mut numbers = arrays.split_ascii_whitespace().map(|word| word.parse::<f64>().expect("a number"));
    let mut next = || numbers.next().expect("one more number");
    let (mx, my, dx, dy, approach) = (next() as usize, next() as usize, next(), next(), next());
    let grid = Grid::new(mx, my, dx, dy).expect("a grid");
    let (mut h, mut p, mut contact) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..grid.len() {
        h.push(next());
        p.push(next());
        contact.push(next() != 0.0);
    }
    // Steel on steel, as in all examples: 1/E* = 2 (1 - nu) / (2 G).
    let influence = Coefficients::from(HalfSpace::new(dx, dy, (1.0 - 0.28) / 82000.0));
    let measures = recompute(&grid, &influence, &h, approach, &p, &contact);
    assert_certified(&measures, tolerance);
}

#[test]
fn hertz_prints_what_is_expected() {
    // The tolerance is that of the example.
    check_example("hertz", &[], &["-O2"], 1e-8);
}

#[test]
fn ledger_prints_what_is_expected() {
    // The example has the default tolerance.
    check_example("ledger", &[], &["-O2"], 1e-6);
}

#[test]
fn to_accuracy_prints_what_is_expected() {
    check_example("to_accuracy", &[], &["-O2"], 1e-8);
}

fn wheel_rail_case() -> String {
    root().join("data/wheel_rail/y0_10kN.txt").to_string_lossy().into_owned()
}

/// norm_solve stops at an rms update of eps rms(p). If each iteration reduces the error dp to 0.9 or less, dp is then at most 10 updates. A smooth p
/// has the largest displacements, so that `||A dp|| / ||A p||` is at most about `||dp|| / ||p||`.
const PER_UPDATE: f64 = 10.0;

#[test]
fn wheel_rail_prints_what_is_expected() {
    check_example("wheel_rail", &[&wheel_rail_case()], &["-O2"], PER_UPDATE * 1e-8);
}

/// A gap that the Python package wrote, with the tolerance that the example asks for.
#[test]
fn gap_prints_what_is_expected() {
    check_example("gap", &[&gap_file("wheel_rail"), "80000"], &["-O2"], 1e-9);
}

/// Other tests compare the solutions of these examples with closed forms and direct sums.
#[test]
fn the_effects_print_what_is_expected() {
    for name in EXAMPLES_OF_EFFECTS {
        let folder = scratch(&format!("fortran_{name}"));
        let program = compile(&format!("fortran_examples/{name}.f90"), &["-O2"], &folder);
        let expected =
            std::fs::read_to_string(root().join(format!("fortran_examples/{name}.expected"))).expect("expected");
        assert_eq!(run_linked(&program, &[], &folder), expected, "{name}");
    }
}

#[test]
fn norm_drop_in_prints_what_is_expected() {
    check_example("norm_drop_in", &[], &["-O2"], PER_UPDATE * 1e-9);
}

/// -ffast-math flushes denormals to zero, and the traps kill a program at its first NaN. Neither changes the results of the library.
#[test]
fn a_host_with_its_own_floating_point_environment_gets_the_same() {
    for flags in [&["-O3", "-ffast-math"][..], &["-O2", "-ffpe-trap=invalid,zero,overflow"]] {
        check_example("hertz", &[], flags, 1e-8);
        check_example("wheel_rail", &[&wheel_rail_case()], flags, PER_UPDATE * 1e-8);
        check_example("norm_drop_in", &[], flags, PER_UPDATE * 1e-9);
    }
}

#[test]
fn norm_solve_keeps_its_promises() {
    let all = [
        &["-g", "-O1", "-fcheck=all"][..],
        &["-O3", "-ffast-math"],
        &["-g", "-O1", "-ffpe-trap=invalid,zero,overflow"],
    ];
    for (i, flags) in all.into_iter().enumerate() {
        let folder = scratch(&format!("fortran_norm_solve_{i}"));
        let program = compile("tests/clients/norm_solve_cases.f90", flags, &folder);
        let output = run_linked(&program, &[], &folder);
        // The program stops at the first case that fails; this is its last one.
        assert_eq!(output.lines().last(), Some("the external subroutine"), "{flags:?}\n{output}");
    }
}

#[test]
fn the_optional_arguments_of_norm_solve_do_what_they_say() {
    for (i, flags) in [&["-g", "-O1", "-fcheck=all"][..], &["-O3", "-ffast-math"]].into_iter().enumerate() {
        let folder = scratch(&format!("fortran_norm_solve_options_{i}"));
        let program = compile("tests/clients/norm_solve_options.f90", flags, &folder);
        let output = run_linked(&program, &[], &folder);
        assert_eq!(output.lines().last(), Some("handles"), "{flags:?}\n{output}");
        if i == 0 {
            run_under_valgrind(&program, &[], &folder);
        }
    }
}

#[test]
fn tang_solve_without_the_module_is_that_of_the_module() {
    prints("tang_solve_external", [&["-g", "-O1", "-fcheck=all"], &["-O3", "-ffast-math"]], "the same bits\n");
}

/// Asserts that a program of tests/clients prints `expected`, compiled with either set of flags.
fn prints(name: &str, both: [&[&str]; 2], expected: &str) {
    for (i, flags) in both.into_iter().enumerate() {
        let folder = scratch(&format!("fortran_{name}_{i}"));
        let program = compile(&format!("tests/clients/{name}.f90"), flags, &folder);
        assert_eq!(run_linked(&program, &[], &folder), expected, "{flags:?}");
    }
}

#[test]
fn norm_solve_and_tang_solve_share_a_handle() {
    let folder = scratch("fortran_tang_solve_handles");
    let program = compile("tests/clients/tang_solve_handles.f90", &["-g", "-O1", "-fcheck=all"], &folder);
    assert_eq!(run_linked(&program, &[], &folder), "the same bits\n");
}

#[test]
fn the_wrappers_of_the_module_work() {
    let folder = scratch("fortran_module");
    let program = compile("tests/clients/fortran_module.f90", &["-g", "-O1", "-fcheck=all"], &folder);
    assert_eq!(run_linked(&program, &[], &folder), format!("{}\nall hold\n", env!("CARGO_PKG_VERSION")));
}

/// Programs with wider default kinds compile the module with the same flags.
#[test]
fn the_module_works_with_other_default_kinds() {
    let wide = ["-fdefault-integer-8", "-fdefault-real-8", "-fdefault-double-8"];
    for (i, flags) in [&wide[..1], &wide[1..], &wide[..]].into_iter().enumerate() {
        for name in ["hertz", "coating", "creep_forces", "own_tables"] {
            let folder = scratch(&format!("fortran_kinds_{name}_{i}"));
            let program = compile(&format!("fortran_examples/{name}.f90"), flags, &folder);
            let arguments: &[&str] = if name == "hertz" { &["arrays.txt"] } else { &[] };
            let output = without_times(&run_linked(&program, arguments, &folder));
            let expected = std::fs::read_to_string(root().join(format!("fortran_examples/{name}.expected")));
            assert_eq!(output, expected.expect("expected"), "{name} {flags:?}");
        }
    }
}

/// Callbacks may call the library with other handles. One of the sets of flags has `-fno-automatic`, which is usual with Fortran 77.
#[test]
fn callbacks_call_the_library() {
    prints("fortran_callbacks", [&["-g", "-O1", "-fcheck=all"], &["-O2", "-fno-automatic"]], "all hold\n");
}

/// Runs a program that checks itself, under valgrind, with default integers of 4 and of 8 bytes.
fn all_hold(name: &str) {
    for (i, flags) in [&["-g", "-O1", "-fcheck=all"][..], &["-O2", "-fdefault-integer-8"]].into_iter().enumerate() {
        let folder = scratch(&format!("{name}_{i}"));
        let program = compile(&format!("tests/clients/{name}.f90"), flags, &folder);
        assert_eq!(run_under_valgrind(&program, &[], &folder), "all hold\n", "{flags:?}");
    }
}

#[test]
fn what_is_attached_wrong_is_said() {
    all_hold("fortran_setters");
}

#[test]
fn arrays_of_another_shape_are_said() {
    all_hold("fortran_shapes");
}

/// A part of an array with gaps would be copied, and the copy would no longer exist when the library reads it. The compiler refuses such a part.
#[test]
fn arrays_with_gaps_are_refused_at_compile_time() {
    let folder = scratch("fortran_gaps");
    let source = |part: &str| {
        format!(
            "program attach\n  use contact_normal\n  use iso_c_binding\n  real(c_double), target :: h(4, 4)\n  \
             type(contact_normal_scene) :: scene\n  call contact_normal_set_undeformed_distance(scene, {part})\nend program\n"
        )
    };
    for (part, compiles) in [("h", true), ("h(:, 2:3)", true), ("h(::2, :)", false), ("(h)", false), ("2*h", false)] {
        std::fs::write(folder.join("attach.f90"), source(part)).expect("a source");
        let mut gfortran = Command::new("gfortran");
        gfortran.arg("-c").arg(root().join("include/contact_normal.f90")).arg("attach.f90").current_dir(&folder);
        assert_eq!(gfortran.output().expect("gfortran").status.success(), compiles, "{part}");
    }
}

/// An array without the attribute `target` might be kept in registers while the library writes it. The compiler refuses to attach such an array.
#[test]
fn arrays_that_are_no_targets_are_refused_at_compile_time() {
    let folder = scratch("fortran_no_target");
    let source = |attribute: &str| {
        format!(
            "program attach\n  use contact_normal\n  use iso_c_binding\n  real(c_double){attribute} :: p(2, 2)\n  \
             type(contact_normal_fields) :: fields\n  call contact_normal_set_fields(fields, pressure=p)\nend program\n"
        )
    };
    for (attribute, compiles) in [(", target", true), ("", false)] {
        std::fs::write(folder.join("attach.f90"), source(attribute)).expect("a source");
        let mut gfortran = Command::new("gfortran");
        gfortran.arg("-c").arg(root().join("include/contact_normal.f90")).arg("attach.f90").current_dir(&folder);
        assert_eq!(gfortran.output().expect("gfortran").status.success(), compiles, "{attribute}");
    }
}

#[test]
fn the_module_has_every_export_of_the_header() {
    let read = |name: &str| std::fs::read_to_string(root().join("include").join(name)).expect("an include file");
    let (header, module) = (header(), read("contact_normal_exports.inc"));
    let exports: Vec<&str> = header
        .split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '('))
        .filter_map(|word| word.split_once('(').map(|(name, _)| name))
        .filter(|name| name.starts_with("contact_normal_") && !name.ends_with("_init"))
        .chain(["contact_normal_init"])
        .collect();
    assert!(exports.contains(&"contact_normal_solve") && exports.len() > 15, "{exports:?}");
    for name in exports {
        assert!(module.contains(&format!("name=\"{name}\"")), "{name} has no interface in the module");
    }
}

/// Each pointer of a struct can be set by the module. Its procedures name the struct by the last word of the struct's name, or `given` for a copy.
#[test]
fn the_module_attaches_every_array_of_the_header() {
    let files = std::fs::read_dir(root().join("include")).expect("include/").map(|file| file.expect("a file").path());
    let parts = files.filter(|path| path.extension().is_some_and(|extension| extension == "inc"));
    let module: String = parts.map(|path| std::fs::read_to_string(path).expect("a part")).collect();
    let mut count = 0;
    for each in Description::of(&header()).structs {
        let last = each.short_name().rsplit('_').next().expect("a name");
        for member in each.members.iter().filter(|member| matches!(member.kind, Kind::Pointer(_))) {
            let is_set = [last, "given"].iter().any(|of| module.contains(&format!("{of}%{}", member.name)));
            // Programs set these two members themselves, by c_loc.
            let is_plain = member.name == "user" || member.name == "stop";
            assert!(is_set || is_plain, "{}: {}", each.name, member.name);
            count += 1;
        }
    }
    assert!(count > 50, "{count} arrays");
}
