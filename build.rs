//! Link arguments of the shared library: its soname, and that it stays loaded (its thread pool must not lose its code). And a link of that
//! name beside the library, so that a program finds it in the folder that it was built in.

use std::path::Path;

/// The version in it is that of the ABI that broke last.
pub const SONAME: &str = "libcontact_normal.so.2";

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,{SONAME}");
        println!("cargo:rustc-cdylib-link-arg=-Wl,-z,nodelete");
        let out = std::env::var("OUT_DIR").expect("cargo sets it");
        link(Path::new(&out));
    }
}

/// Links the soname in target/release, whose folder build/contact-normal-.../out is that of this program. Where that is laid out
/// otherwise, there is no link.
pub fn link(out: &Path) {
    let build = out.parent().and_then(Path::parent).filter(|build| build.ends_with("build"));
    let Some(profile) = build.and_then(Path::parent) else { return };
    #[cfg(unix)]
    if std::fs::symlink_metadata(profile.join(SONAME)).is_err() {
        // Without it the library is built all the same.
        let _ = std::os::unix::fs::symlink("libcontact_normal.so", profile.join(SONAME));
    }
    #[cfg(not(unix))]
    let _ = profile;
}
