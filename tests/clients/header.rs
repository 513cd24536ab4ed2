//! include/contact_normal.h equals the header that cbindgen generates from src/ffi, byte for byte, and the versions in all files are equal.
//! `CONTACT_NORMAL_WRITE_HEADER=1 cargo test --test clients header` writes the header anew.

use std::path::Path;

use crate::description::Description;
use crate::generated::c_inits;
use contact_normal::ffi::CONTACT_NORMAL_ABI_VERSION;

#[test]
fn the_committed_header_is_the_generated_one() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("cbindgen.toml");
    let mut builder = cbindgen::Builder::new().with_config(config);
    for file in [
        "status",
        "init",
        "scene",
        "influence",
        "coating",
        "effects",
        "friction",
        "adhesion",
        "visco",
        "options",
        "warnings",
        "fields",
        "ledger",
        "progress",
        "report",
        "solve",
        "pull_off",
        "solver",
        "linear",
        "tangential",
        "friction_results",
        "batch",
        "accuracy",
        "price_list",
        "quantities",
        "effects_bill",
        "special",
        "stress_outputs",
        "stress",
        "heat",
        "wear",
        "log",
        "kept",
        "has",
        "set_by_name",
    ] {
        builder = builder.with_src(root.join(format!("src/ffi/{file}.rs")));
    }
    let mut header = Vec::new();
    builder.generate().expect("bindings").write(&mut header);
    let header = with_inits(&String::from_utf8(header).expect("text"));
    let path = root.join("include/contact_normal.h");
    if std::env::var_os("CONTACT_NORMAL_WRITE_HEADER").is_some() {
        std::fs::write(&path, &header).expect("a writable include/");
    }
    let committed = std::fs::read_to_string(&path).expect("include/contact_normal.h");
    assert!(
        header == committed,
        "include/contact_normal.h is out of date: run CONTACT_NORMAL_WRITE_HEADER=1 cargo test --test clients header"
    );
}

/// Inserts the `_init` functions before the end of the header's include guard.
fn with_inits(header: &str) -> String {
    let end = header.rfind("\n#endif").expect("the include guard");
    format!("{}{}{}", &header[..end], c_inits(&Description::of(header)), &header[end..])
}

/// tests/clients/installed_package.rs compares the versions of the library and of the installed package.
#[test]
fn the_header_and_the_modules_have_the_versions_of_the_library() {
    let read = |name: &str| std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).expect("a file");
    let abi = CONTACT_NORMAL_ABI_VERSION;
    let version: Vec<&str> = env!("CARGO_PKG_VERSION").split('.').collect();
    for (name, number) in ["MAJOR", "MINOR", "PATCH"].into_iter().zip(version) {
        let stands = format!("\n#define CONTACT_NORMAL_VERSION_{name} {number}\n");
        assert!(read("include/contact_normal.h").contains(&stands), "{stands:?}");
    }
    for (file, stands) in [
        ("include/contact_normal.h", format!("\n * contact-normal {}: ", env!("CARGO_PKG_VERSION"))),
        ("include/contact_normal.h", format!("\n#define CONTACT_NORMAL_ABI_VERSION {abi}\n")),
        ("include/contact_normal_types.inc", format!(":: CONTACT_NORMAL_ABI_VERSION = {abi}\n")),
        ("python/contact_normal/_constants.py", format!("\nABI_VERSION = {abi}\n")),
    ] {
        assert!(read(file).contains(&stands), "{file} has no {stands:?}");
    }
}
