//! Files that are generated from the description of the ABI: the `_init` functions of the header; the constants, types and `_init` of the Fortran
//! module; the structs of the Python package; the names that the library finds; and the layout of the structs for the tests. Each file is compared
//! with the generated one. `CONTACT_NORMAL_WRITE_HEADER=1 cargo test --test clients generated` writes the files anew, after the header.

use std::fmt::Write;

use crate::description::{Callback, Description, Kind, Member, Struct};
use crate::support::root;

/// The `_init` functions of C and C++, at the end of the header: each passes the size of its struct to the library.
pub fn c_inits(described: &Description) -> String {
    let mut text = String::new();
    for (kind, constant) in described.kinds() {
        let (name, short, since) = (&kind.name, kind.short_name(), constant.since());
        write!(
            text,
            "\n/*\n Fills a {name} with its defaults, as the comments of its members say them. Since {since}.\n */\n\
             static inline void {name}_init({name} *{short})\n{{\n  \
             contact_normal_init(CONTACT_NORMAL_{}, {short}, (int64_t)sizeof({name}));\n}}\n",
            constant.name
        )
        .expect("text");
    }
    text
}

const FORTRAN_HEAD: &str = "\
! Constants and types of the module; a part of contact_normal.f90, which includes it. Made from contact_normal.h, which says
! what each means; do not edit.
";

fn fortran_types(described: &Description) -> String {
    let mut text = FORTRAN_HEAD.to_owned();
    for constant in &described.constants {
        writeln!(
            text,
            "  integer(c_int32_t), parameter, public :: CONTACT_NORMAL_{} = {}",
            constant.name, constant.value
        )
        .expect("text");
    }
    for each in &described.structs {
        writeln!(text, "\n  type, bind(C), public :: {}", each.name).expect("text");
        for member in &each.members {
            // The struct_size is 0 until `_init` sets it: a structure without `_init` is refused, not misread.
            let (kind, zero) = match &member.kind {
                Kind::Int32 => ("integer(c_int32_t)".to_owned(), " = 0"),
                Kind::Int64 => ("integer(c_int64_t)".to_owned(), " = 0"),
                Kind::Double => ("real(c_double)".to_owned(), " = 0"),
                Kind::Struct(name) => (format!("type({name})"), ""),
                Kind::Callback(_) => ("type(c_funptr)".to_owned(), " = c_null_funptr"),
                Kind::Pointer(_) => ("type(c_ptr)".to_owned(), " = c_null_ptr"),
            };
            let count = member.count.map_or_else(String::new, |count| format!("({count})"));
            writeln!(text, "    {kind} :: {}{count}{zero}", member.name).expect("text");
        }
        text += "  end type\n";
    }
    text
}

fn fortran_inits(described: &Description) -> String {
    let mut text = "\
! The _init of each structure; a part of contact_normal.f90, which includes it. Made from contact_normal.h; do not edit.
"
    .to_owned();
    for (kind, constant) in described.kinds() {
        let (name, short, since) = (&kind.name, kind.short_name(), constant.since());
        write!(
            text,
            "\n  ! Fills a {name} with its defaults. Since {since}.\n  \
             recursive subroutine {name}_init({short})\n    \
             type({name}), intent(out), target :: {short}\n    \
             call c_init(CONTACT_NORMAL_{}, c_loc({short}), int(c_sizeof({short}), c_int64_t))\n  \
             end subroutine\n",
            constant.name
        )
        .expect("text");
    }
    text
}

/// The names of the `_init` procedures, for the part of the module before `contains`.
fn fortran_public(described: &Description) -> String {
    let mut text = String::from("\n");
    for (kind, _) in described.kinds() {
        writeln!(text, "  public :: {}_init", kind.name).expect("text");
    }
    text
}

/// The Python name of a struct: that of contact_normal_pressure_limit is PressureLimit.
fn python_name(name: &str) -> String {
    let words = name.trim_start_matches("contact_normal_").split('_');
    words.map(|word| word[..1].to_uppercase() + &word[1..]).collect()
}

fn python_kind(kind: &Kind) -> String {
    match kind {
        Kind::Int32 => "c_int32".into(),
        Kind::Int64 => "c_int64".into(),
        Kind::Double => "c_double".into(),
        Kind::Struct(name) | Kind::Callback(name) => python_name(name),
        Kind::Pointer(Some(to)) => format!("POINTER({})", python_kind(to)),
        Kind::Pointer(None) => "c_void_p".into(),
    }
}

fn python_struct(text: &mut String, each: &Struct) {
    let name = python_name(&each.name);
    write!(text, "\n\nclass {name}(ctypes.Structure):\n    \"\"\"{}.\"\"\"\n\n    _fields_ = [\n", each.name)
        .expect("text");
    for member in &each.members {
        let count = member.count.map_or_else(String::new, |count| format!(" * {count}"));
        writeln!(text, "        (\"{}\", {}{count}),", member.name, python_kind(&member.kind)).expect("text");
    }
    *text += "    ]\n";
}

fn python_callback(text: &mut String, each: &Callback) {
    let argument = |(name, kind): &(String, Kind)| match name.as_str() {
        // The only argument of a callback that is a text.
        "message" => "c_char_p".into(),
        _ => python_kind(kind),
    };
    let arguments: Vec<String> = each.arguments.iter().map(argument).collect();
    let result = each.result.as_ref().map_or("None".into(), python_kind);
    write!(text, "\n\n{} = CFUNCTYPE({result}, {})\n", python_name(&each.name), arguments.join(", ")).expect("text");
}

fn python_structs(described: &Description) -> String {
    let mut text = "\
\"\"\"The structs and callbacks of include/contact_normal.h for ctypes. Made from that; do not edit.\"\"\"

import ctypes
from ctypes import CFUNCTYPE, POINTER, c_char_p, c_double, c_int32, c_int64, c_void_p
"
    .to_owned();
    let mut callbacks: Vec<&Callback> = described.callbacks.iter().collect();
    for each in &described.structs {
        // The class of a callback precedes the first struct that has it as a member.
        let has = |callback: &&Callback| {
            each.members.iter().any(|member| member.kind == Kind::Callback(callback.name.clone()))
        };
        callbacks.iter().filter(|callback| has(callback)).for_each(|callback| python_callback(&mut text, callback));
        callbacks.retain(|callback| !has(callback));
        python_struct(&mut text, each);
    }
    callbacks.iter().for_each(|callback| python_callback(&mut text, callback));
    text += "\n\ndef names(kind: type[ctypes.Structure]) -> list[str]:\n    \"\"\"The members of a struct.\"\"\"\n    \
             return [field[0] for field in kind._fields_]\n";
    text += "\n\n# The structs that have an _init, and the kind of each.\nKINDS: dict[str, tuple[int, type[ctypes.Structure]]] = {\n";
    for (kind, constant) in described.kinds() {
        writeln!(text, "    \"{}\": ({}, {}),", kind.short_name(), constant.value, python_name(&kind.name))
            .expect("text");
    }
    text + "}\n"
}

/// The members of a struct, and those of structs within it: "normal.force".
fn members(described: &Description, each: &Struct) -> Vec<String> {
    let of = |member: &Member| match &member.kind {
        Kind::Struct(name) => {
            let inner = described.structs.iter().find(|inner| inner.name == *name).expect("a struct of the header");
            members(described, inner).into_iter().map(|of_inner| format!("{}.{of_inner}", member.name)).collect()
        }
        _ => vec![member.name.clone()],
    };
    each.members.iter().flat_map(of).collect()
}

/// The structs of calls that `options->dump` writes. A dump also holds the structs that they point to.
const DUMPED: [&str; 8] =
    ["scene", "options", "fields", "report", "accuracy", "price", "friction_results", "stress_outputs"];

/// The structs that a dump may hold, in their order in the header.
fn dumped(described: &Description) -> Vec<&Struct> {
    // In the header a struct comes after those to which it points, so that the list is searched backwards.
    let mut found: Vec<&Struct> = Vec::new();
    for each in described.structs.iter().rev() {
        let pointer = Kind::Pointer(Some(Box::new(Kind::Struct(each.name.clone()))));
        let points_to_it = |member: &Member| member.kind == pointer;
        if DUMPED.contains(&each.short_name()) || found.iter().any(|other| other.members.iter().any(points_to_it)) {
            found.push(each);
        }
    }
    found.reverse();
    found
}

/// Adds these items to the text, with as many per line as fit.
fn fill(text: &mut String, indent: &str, items: impl Iterator<Item = String>) {
    let mut line = indent.to_owned();
    for item in items {
        if line.len() > indent.len() && line.len() + item.len() > 150 {
            *text += line.trim_end();
            *text += "\n";
            line.truncate(indent.len());
        }
        line += &item;
        line += " ";
    }
    *text += line.trim_end();
    *text += "\n";
}

/// Adds structs to the text, each with the names of its members.
fn add_structs<'a>(
    text: &mut String,
    structs: impl Iterator<Item = &'a Struct>,
    members: impl Fn(&Struct) -> Vec<String>,
) {
    for each in structs {
        writeln!(text, "    {} {{", each.name).expect("text");
        fill(text, "        ", members(each).into_iter());
        *text += "    }\n";
    }
}

fn rust_layout(described: &Description) -> String {
    let mut text = "\
//! The sizes of the structs, and the offsets of their members, as Rust has them. Made from include/contact_normal.h; do not edit.

use std::mem::offset_of;

use contact_normal::ffi::*;

macro_rules! layout {
    ($($struct:ident { $($member:ident)* })*) => {
        /// \"struct\" and its size, then \"struct.member\" and its offset.
        pub fn layout() -> Vec<(&'static str, usize)> {
            vec![$(
                (stringify!($struct), size_of::<$struct>()),
                $((concat!(stringify!($struct), \".\", stringify!($member)), offset_of!($struct, $member)),)*
            )*]
        }
    };
}

layout! {
"
    .to_owned();
    add_structs(&mut text, described.structs.iter(), |each| {
        each.members.iter().map(|member| member.name.clone()).collect()
    });
    text + "}\n"
}

fn rust_members(described: &Description) -> String {
    let mut text = "\
//! The constants, the structs and their members by name. Made from include/contact_normal.h; do not edit.

use super::member::{constants, structs, Member, Struct};
use super::*;

/// The constants of the header. Each comes with its name without `CONTACT_NORMAL_`.
#[rustfmt::skip]
pub(super) const CONSTANTS: &[(&str, i32)] = constants! {
"
    .to_owned();
    fill(&mut text, "    ", described.constants.iter().map(|each| format!("CONTACT_NORMAL_{}", each.name)));
    text += "};\n\n/// The structs that a dump may hold.\n#[rustfmt::skip]\nconst STRUCTS: &[Struct] = structs! {\n";
    add_structs(&mut text, dumped(described).into_iter(), |each| members(described, each));
    text + "\
};

/// The struct of this name.
pub(super) fn structure(name: &str) -> Option<&'static Struct> {
    STRUCTS.iter().find(|each| each.name == name)
}
"
}

/// The header of this clone.
pub fn header() -> String {
    std::fs::read_to_string(root().join("include/contact_normal.h")).expect("include/contact_normal.h")
}

#[test]
fn the_committed_files_are_the_generated_ones() {
    let described = Description::of(&header());
    for (file, made) in [
        ("include/contact_normal_types.inc", fortran_types(&described) + &fortran_public(&described)),
        ("include/contact_normal_inits.inc", fortran_inits(&described)),
        ("python/contact_normal/_structs.py", python_structs(&described)),
        ("src/ffi/members.rs", rust_members(&described)),
        ("tests/clients/rust_layout.rs", rust_layout(&described)),
    ] {
        let path = root().join(file);
        if std::env::var_os("CONTACT_NORMAL_WRITE_HEADER").is_some() {
            std::fs::write(&path, &made).expect("a writable folder");
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            committed == made,
            "{file} is out of date: run CONTACT_NORMAL_WRITE_HEADER=1 cargo test --test clients generated"
        );
    }
}
