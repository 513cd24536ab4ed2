//! include/contact_normal.h is what cbindgen makes of src/ffi, byte for byte.
//! `CONTACT_NORMAL_WRITE_HEADER=1 cargo test --test header` writes it anew.

use std::path::Path;

#[test]
fn the_committed_header_is_the_generated_one() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("cbindgen.toml");
    let mut builder = cbindgen::Builder::new().with_config(config);
    for file in
        ["status", "scene", "effects", "options", "report", "solve", "solver", "batch", "accuracy", "special", "log"]
    {
        builder = builder.with_src(root.join(format!("src/ffi/{file}.rs")));
    }
    let mut header = Vec::new();
    builder.generate().expect("bindings").write(&mut header);
    let header = String::from_utf8(header).expect("text");
    let path = root.join("include/contact_normal.h");
    if std::env::var_os("CONTACT_NORMAL_WRITE_HEADER").is_some() {
        std::fs::write(&path, &header).expect("a writable include/");
    }
    let committed = std::fs::read_to_string(&path).expect("include/contact_normal.h");
    assert!(
        header == committed,
        "include/contact_normal.h is out of date: run CONTACT_NORMAL_WRITE_HEADER=1 cargo test --test header"
    );
}
