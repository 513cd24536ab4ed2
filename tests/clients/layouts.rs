//! Every struct has the same layout in Rust, C, Fortran and Python. The programs that print the layouts are made from the description of the ABI, so
//! that they have all structs and members.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use crate::description::Description;
use crate::generated::header;
use crate::python::python_in;
use crate::rust_layout::layout;
use crate::support::{root, run, run_linked, scratch};

/// The expected lines "struct size" and "struct.member offset", as Rust has them.
fn expected() -> String {
    let described = Description::of(&header());
    let named = described.structs.iter().map(|each| 1 + each.members.len()).sum::<usize>();
    assert_eq!(layout().len(), named, "tests/clients/rust_layout.rs is out of date");
    layout().iter().map(|(name, number)| format!("{name} {number}\n")).collect()
}

/// Compiles a program, runs it with the library, and returns what it printed.
fn printed(mut compiler: Command, sources: &[&Path], folder: &Path) -> String {
    let program = folder.join("layout");
    compiler.args(sources).arg("-o").arg(&program).arg("-L").arg(folder).arg("-lcontact_normal").current_dir(folder);
    run(&mut compiler);
    run_linked(&program, &[], folder)
}

#[test]
fn c_has_the_layout_of_rust() {
    let mut source =
        String::from("#include <contact_normal.h>\n#include <stddef.h>\n#include <stdio.h>\n\nint main(void)\n{\n");
    for each in &Description::of(&header()).structs {
        let name = &each.name;
        writeln!(source, "    printf(\"{name} %zu\\n\", sizeof({name}));").expect("text");
        for member in each.members.iter().map(|member| &member.name) {
            writeln!(source, "    printf(\"{name}.{member} %zu\\n\", offsetof({name}, {member}));").expect("text");
        }
    }
    let folder = scratch("c_layout");
    let file = folder.join("layout.c");
    std::fs::write(&file, source + "    return 0;\n}\n").expect("a source");
    let mut compiler = Command::new("cc");
    compiler.args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-I"]).arg(root().join("include"));
    assert_eq!(printed(compiler, &[&file], &folder), expected());
}

#[test]
fn fortran_has_the_layout_of_rust() {
    let described = Description::of(&header());
    let mut source = String::from(
        "program print_layout\n  use, intrinsic :: iso_c_binding\n  use contact_normal\n  implicit none\n  \
         integer(c_intptr_t) :: base\n",
    );
    for each in &described.structs {
        writeln!(source, "  type({}), target :: the_{}", each.name, each.short_name()).expect("text");
    }
    for each in &described.structs {
        let (name, of) = (&each.name, format!("the_{}", each.short_name()));
        writeln!(source, "  base = place(c_loc({of}))\n  print '(a, i0)', '{name} ', c_sizeof({of})").expect("text");
        for member in each.members.iter().map(|member| &member.name) {
            writeln!(source, "  print '(a, i0)', '{name}.{member} ', place(c_loc({of}%{member})) - base")
                .expect("text");
        }
    }
    source += "contains\n  function place(pointer) result(address)\n    type(c_ptr), intent(in) :: pointer\n    \
               integer(c_intptr_t) :: address\n    address = transfer(pointer, address)\n  end function\nend program\n";
    let folder = scratch("fortran_layout");
    let file = folder.join("layout.f90");
    std::fs::write(&file, source).expect("a source");
    let mut compiler = Command::new("gfortran");
    compiler.arg("-ffree-line-length-none");
    assert_eq!(printed(compiler, &[&root().join("include/contact_normal.f90"), &file], &folder), expected());
}

#[test]
fn python_has_the_layout_of_rust() {
    let script = "
import ctypes, re, contact_normal._structs
for name, kind in vars(contact_normal._structs).items():
    if isinstance(kind, type) and issubclass(kind, ctypes.Structure):
        name = 'contact_normal_' + re.sub('(?<!^)([A-Z])', r'_\\1', name).lower()
        print(name, ctypes.sizeof(kind))
        for member, *_ in kind._fields_:
            print(f'{name}.{member} {getattr(kind, member).offset}')
";
    assert_eq!(run(python_in(&scratch("python_layout")).args(["-c", script])), expected());
}
