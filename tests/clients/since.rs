//! The comment of each function of the header, and of each procedure of the Fortran module, ends with the version that introduced it. The reference
//! of the site repeats it. names_of_0.1.txt has the names of version 0.1.

use std::collections::{BTreeMap, BTreeSet};

use crate::generated::header;
use crate::support::root;

fn names_of_0_1(language: &str) -> BTreeSet<String> {
    let list = std::fs::read_to_string(root().join("tests/clients/names_of_0.1.txt")).expect("the names");
    let names = list.lines().filter_map(|line| line.strip_prefix(language)).map(|name| name.trim().to_owned());
    let names: BTreeSet<String> = names.collect();
    assert!(names.len() > 20, "{language}");
    names
}

/// The version in the last "Since ..." of a comment.
fn since(comment: &str) -> String {
    let version = comment.rsplit_once("Since ").map_or("nothing", |(_, version)| version);
    version.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect::<String>().trim_end_matches('.').to_owned()
}

/// The functions of the header, with those of `_init`, each with its version.
fn of_c() -> BTreeMap<String, String> {
    let header = header();
    let mut found = BTreeMap::new();
    for part in header.split("\n/*\n").skip(1) {
        let (comment, code) = part.split_once("*/\n").expect("the end of a comment");
        if let Some((before, _)) = code.split_once('(').filter(|(before, _)| !before.contains(['#', '{', ';'])) {
            let name = before.rsplit([' ', '*', '\n']).next().expect("a name");
            if name.starts_with("contact_normal_") {
                found.insert(name.to_owned(), since(comment));
            }
        }
    }
    assert!(found.contains_key("contact_normal_solve") && found.contains_key("contact_normal_cycle_init"), "{found:?}");
    found
}

/// The public procedures and callbacks of the module, each with its version.
fn of_fortran() -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for file in std::fs::read_dir(root().join("include")).expect("include/") {
        let path = file.expect("a file").path();
        if path.extension().is_none_or(|extension| extension != "inc" && extension != "f90") {
            continue;
        }
        let mut comment = String::new();
        for line in std::fs::read_to_string(&path).expect("a part of the module").lines().map(str::trim) {
            if line.starts_with('!') {
                comment += line;
                continue;
            }
            let line = line.strip_prefix("recursive ").unwrap_or(line);
            let code = line.strip_prefix("subroutine ").or_else(|| line.strip_prefix("function "));
            if let Some((name, _)) = code.and_then(|code| code.split_once('(')) {
                let is_public = name.starts_with("contact_normal_") || ["norm_solve", "tang_solve"].contains(&name);
                if is_public {
                    // Later additions, such as optional arguments, are noted in parentheses: "(since 0.2)".
                    found.insert(name.to_owned(), since(&comment));
                }
            }
            comment.clear();
        }
    }
    assert!(found.contains_key("norm_solve") && found.contains_key("contact_normal_set_fields"), "{found:?}");
    found
}

#[test]
fn each_function_says_since_which_version_there_is_it() {
    for (language, found) in [("c ", of_c()), ("fortran ", of_fortran())] {
        let old = names_of_0_1(language);
        let wrong: Vec<_> =
            found.iter().filter(|(name, since)| *since != if old.contains(*name) { "0.1" } else { "0.2" }).collect();
        assert!(wrong.is_empty(), "{language}: {wrong:?}");
        let lost: Vec<_> = old.iter().filter(|name| !found.contains_key(*name)).collect();
        let renamed = ["contact_normal_abi_version", "contact_normal_version", "contact_normal_last_error"];
        assert!(lost.iter().all(|name| renamed.contains(&name.as_str())), "{language}: {lost:?}");
    }
}
