//! All examples in C and in Fortran run under valgrind without errors. Valgrind is some 50 times slower, so that the examples have small inputs. They
//! are joined in one program, because valgrind translates the library for each program, which takes longer than most examples.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::c::{self, gap_file};
use crate::fortran;
use crate::support::{root, run, run_under_valgrind, scratch};

/// Sizes in the sources of the examples, and the smaller ones that replace them.
const SIZES: [(&str, &str); 21] = [
    (":: M = 48\n", ":: M = 16\n"),
    ("step = 1, 100", "step = 1, 4"),
    ("ROLLED = 32", "ROLLED = 10"),
    (":: n = 32, reach", ":: n = 10, reach"),
    ("COUNT = 200", "COUNT = 5"),
    ("N = 32, M = 2 * N + 1, DEPTHS = 101", "N = 8, M = 2 * N + 1, DEPTHS = 3"),
    ("N = 32, M = 2*N + 1, DEPTHS = 101", "N = 8, M = 2*N + 1, DEPTHS = 3"),
    ("STEPS = 100", "STEPS = 4"),
    ("M = 64, STEPS = 8", "M = 16, STEPS = 3"),
    ("m = 64, steps = 8", "m = 16, steps = 3"),
    ("M = 48, N = 32, STEPS = 12", "M = 20, N = 12, STEPS = 2"),
    ("m = 48, n = 32, steps = 12", "m = 20, n = 12, steps = 2"),
    ("MX = 48, MY = 36, CREEPAGES = 7", "MX = 16, MY = 12, CREEPAGES = 7"),
    ("MX = 48, MY = 48", "MX = 16, MY = 16"),
    ("MX = 40, MY = 40", "MX = 12, MY = 12"),
    ("{ M = 64", "{ M = 16"),
    (":: M = 64", ":: M = 16"),
    (" m = 64", " m = 16"),
    ("M = 96", "M = 24"),
    (" M = 80", " M = 20"),
    (" m = 80", " m = 20"),
];

/// The example of friction laws, whose elements have a fixed size: only the first creepage, and the first steps.
const FEWER_STEPS: [(&str, &str); 2] = [("i < 6; i++", "i < 1; i++"), ("step = 1, 60", "step = 1, 10")];

/// The source of an example with smaller sizes. The forces of one example need its grid.
fn smaller(name: &str, source: &str) -> String {
    let sizes = match name {
        "laws" => &FEWER_STEPS[..],
        "pressure_limit" => &[][..],
        _ => &SIZES[..],
    };
    sizes.iter().fold(source.to_owned(), |text, (of, by)| text.replace(of, by))
}

/// A compiled example, and its arguments.
struct Example {
    name: String,
    object: PathBuf,
    arguments: Vec<String>,
}

/// Compiles the examples of a folder of the project into a scratch folder, by `compile` from smaller sources.
fn examples(of: &str, extension: &str, folder: &Path, compile: impl Fn(&Path, &Path)) -> Vec<Example> {
    let files = std::fs::read_dir(root().join(of)).expect("the examples").map(|file| file.expect("a file").path());
    let mut sources: Vec<PathBuf> = files.filter(|file| file.extension().is_some_and(|e| e == extension)).collect();
    sources.sort();
    let one = |file: PathBuf| {
        let name = file.file_stem().expect("a name").to_string_lossy().into_owned();
        let source = folder.join(format!("{name}.{extension}"));
        let object = folder.join(format!("{name}_{extension}.o"));
        let text = std::fs::read_to_string(&file).expect("a source");
        std::fs::write(&source, smaller(&name, &text)).expect("a smaller source");
        compile(&source, &object);
        let arguments = match name.as_str() {
            "hertz" | "ledger" if extension == "c" => vec!["24".to_owned()],
            "wheel_rail" => vec![root().join("data/wheel_rail/y4_82kN.txt").to_string_lossy().into_owned()],
            "gap" if extension == "c" => vec![gap_file("ground"), "1.2288".to_owned()],
            "gap" => vec![gap_file("wheel_rail"), "80000".to_owned()],
            _ => Vec::new(),
        };
        Example { name: format!("{name}_{extension}"), object, arguments }
    };
    sources.into_iter().map(one).collect()
}

/// Writes a source in C whose `main` runs the examples in turn. The `main` of each example is renamed with the name of the example in front.
fn driver(examples: &[Example], folder: &Path) -> PathBuf {
    let (mut declared, mut calls) = (String::new(), String::new());
    for Example { name, object, arguments } in examples {
        run(Command::new("objcopy").arg("--redefine-sym").arg(format!("main={name}_main")).arg(object));
        let given: String = arguments.iter().map(|argument| format!(" \"{argument}\",")).collect();
        writeln!(declared, "int {name}_main(int, char **);").expect("a text");
        writeln!(calls, "    char *{name}[] = {{\"{name}\",{given} NULL}};").expect("a text");
        writeln!(calls, "    puts(\"== {name}\");").expect("a text");
        writeln!(calls, "    fflush(stdout);").expect("a text");
        writeln!(calls, "    if ({name}_main({}, {name}) != 0) return 1;", 1 + arguments.len()).expect("a text");
    }
    let source = folder.join("all_examples.c");
    let text = format!("#include <stdio.h>\n{declared}int main(void)\n{{\n{calls}    return 0;\n}}\n");
    std::fs::write(&source, text).expect("a source");
    source
}

/// Links the examples with the module of those in Fortran, and runs them all. Asserts that each prints something.
fn run_all(examples: &[Example], folder: &Path, module: &Path) {
    let (source, object, program) = (driver(examples, folder), folder.join("driver.o"), folder.join("all_examples"));
    run(Command::new("cc").args(["-std=c99", "-c"]).arg(&source).arg("-o").arg(&object));
    let mut link = Command::new("gfortran");
    link.args([&object, module]).args(examples.iter().map(|example| &example.object)).arg("-o").arg(&program);
    run(link.arg("-L").arg(folder).args(["-lcontact_normal", "-lm"]));
    let printed = run_under_valgrind(&program, &[], folder);
    let parts: Vec<(&str, &str)> = printed.split("== ").filter_map(|part| part.split_once('\n')).collect();
    for Example { name, .. } in examples {
        assert!(parts.iter().any(|(of, rest)| of == name && !rest.trim().is_empty()), "{name}\n{printed}");
    }
}

#[test]
fn the_examples_in_c_and_in_fortran() {
    let folder = scratch("examples_under_valgrind");
    std::fs::copy(root().join("c_examples/example.h"), folder.join("example.h")).expect("a header");
    let mut all = examples("c_examples", "c", &folder, |source, object| {
        run(c::compiler("cc", "c99").args(["-O2", "-c"]).arg(source).arg("-o").arg(object));
    });
    let in_c = all.len();
    let flags = ["-g", "-O1"];
    let module = fortran::module(&flags);
    all.extend(examples("fortran_examples", "f90", &folder, |source, object| {
        let mut gfortran = fortran::compiler(&flags);
        gfortran.arg("-I").arg(&module).arg("-c").arg(source).arg("-o").arg(object);
        run(gfortran.current_dir(&folder));
    }));
    assert!(in_c >= 23 && all.len() >= in_c + 21, "{in_c} of {} examples in C", all.len());
    run_all(&all, &folder, &module.join("contact_normal.o"));
}
