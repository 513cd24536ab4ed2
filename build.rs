//! Link arguments of the shared library: its soname, and that it stays loaded (its thread pool must not lose its code).

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libcontact_normal.so.2");
        println!("cargo:rustc-cdylib-link-arg=-Wl,-z,nodelete");
    }
}
