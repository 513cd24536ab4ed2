//! The dynamic symbols of the shared library are those of include/exported_symbols.txt, and the header declares each with its first version.

use std::process::Command;

use crate::support::{root, run, scratch};

/// The symbols in include/exported_symbols.txt.
fn committed() -> Vec<String> {
    let list =
        std::fs::read_to_string(root().join("include/exported_symbols.txt")).expect("include/exported_symbols.txt");
    list.lines().map(String::from).collect()
}

#[test]
fn the_library_exports_what_the_committed_list_says() {
    let library = scratch("exported_symbols").join("libcontact_normal.so");
    let mut exported: Vec<String> = run(Command::new("nm").args(["-D", "--defined-only"]).arg(library))
        .lines()
        .map(|line| line.rsplit(' ').next().expect("a symbol").to_string())
        .collect();
    exported.sort();
    assert_eq!(exported, committed(), "exported (left) and include/exported_symbols.txt (right) differ");
}

#[test]
fn the_header_declares_each_export_and_since_when() {
    let header = std::fs::read_to_string(root().join("include/contact_normal.h")).expect("the header");
    let (_, functions) = header.split_once("extern \"C\" {").expect("functions");
    // Each declaration follows its comment, "/* ... */ declaration;".
    let declarations: Vec<(&str, &str)> = functions
        .split("/*")
        .skip(1)
        .filter_map(|part| part.split_once("*/"))
        .filter(|(_, code)| code.contains('(') && !code.trim_start().starts_with("static inline"))
        .collect();
    let mut declared: Vec<String> = Vec::new();
    for (comment, code) in declarations {
        // "contact_normal_status contact_normal_solve(const ...": the word before the first parenthesis.
        let before = code.split('(').next().expect("text");
        let name = before.rsplit([' ', '\n', '*']).next().expect("a name");
        let since = ["Since 0.1.", "Since 0.2."].iter().any(|since| comment.trim_end().ends_with(since));
        assert!(since, "the comment of {name} does not end with the version that brought it:{comment}");
        declared.push(name.to_string());
    }
    declared.sort();
    assert_eq!(declared, committed(), "the header (left) and include/exported_symbols.txt (right) differ");
}
