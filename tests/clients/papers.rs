//! The documents that accompany the code: notices of third parties, versions, licences.

use std::collections::BTreeSet;
use std::process::Command;

use crate::support::{root, run};

fn read(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The name and version of every package in Cargo.lock.
fn locked() -> BTreeSet<String> {
    let lock = read("Cargo.lock");
    let value = |line: &str| line.split('"').nth(1).expect("a value").to_owned();
    let names = lock.lines().filter(|line| line.starts_with("name = ")).map(value);
    // Cargo.lock begins with the version of its own format, without quotation marks.
    let versions = lock.lines().filter(|line| line.starts_with("version = \"")).map(value);
    names.zip(versions).map(|(name, version)| format!("{name} {version}")).collect()
}

#[test]
fn the_notices_name_every_crate_that_is_linked() {
    let notices = read("THIRD_PARTY_NOTICES");
    let named: BTreeSet<String> = notices
        .lines()
        .skip_while(|line| *line != "Crates:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .map(|line| line.trim().split(':').next().expect("a name").to_owned())
        .filter(|crate_name| !crate_name.starts_with("contact-normal "))
        .collect();
    let cargo = std::env::var_os("CARGO").expect("cargo runs this test");
    let mut tree = Command::new(cargo);
    tree.current_dir(root()).args(["tree", "--locked", "--quiet", "--edges", "normal", "--prefix", "none"]);
    let linked: BTreeSet<String> = run(tree.args(["--package", "contact-normal", "--format", "{p}"]))
        .lines()
        .map(|line| line.split(' ').take(2).collect::<Vec<_>>().join(" ").replace(" v", " "))
        .filter(|crate_name| !crate_name.starts_with("contact-normal "))
        .collect();
    assert!(linked.len() > 20, "{linked:?}");
    let missing: Vec<_> = linked.difference(&named).collect();
    assert!(missing.is_empty(), "THIRD_PARTY_NOTICES is out of date, run `make notices`; it lacks {missing:?}");
    // Cargo.lock has the crates of all platforms, and so have the notices. A notice of any other crate is out of date.
    let known = locked();
    let unknown: Vec<_> = named.difference(&known).collect();
    assert!(
        unknown.is_empty(),
        "THIRD_PARTY_NOTICES is out of date, run `make notices`; not in Cargo.lock: {unknown:?}"
    );
}

#[test]
fn the_version_is_the_same_wherever_it_stands() {
    let version = env!("CARGO_PKG_VERSION");
    for (file, stands) in [
        ("CITATION.cff", format!("\nversion: {version}\n")),
        ("crates/par/Cargo.toml", format!("\nversion = \"{version}\"\n")),
        ("crates/toeplitz/Cargo.toml", format!("\nversion = \"{version}\"\n")),
        ("CHANGELOG.md", format!("\n## [{version}] - ")),
        ("fpm.toml", format!("\nversion = \"{version}\"\n")),
        ("include/contact_normal.hpp", format!("contact-normal {version}: ")),
    ] {
        assert!(read(file).contains(&stands), "{file} has no {stands:?}");
    }
}

#[test]
fn the_licences_are_those_that_the_packages_name() {
    for file in ["Cargo.toml", "pyproject.toml"] {
        assert!(read(file).contains("license = \"MIT OR Apache-2.0\""), "{file}");
    }
    assert!(read("LICENSE-MIT").contains("Permission is hereby granted, free of charge"));
    assert!(read("LICENSE-APACHE").contains("Apache License\n                        Version 2.0, January 2004"));
}
