//! Link arguments of the shared library: its soname, and that it stays loaded (its thread pool must not lose its code). And a link of that
//! name beside the library, so that a program finds it in the folder that it was built in.

use std::path::Path;

/// The version in it is that of the ABI that broke last.
pub const SONAME: &str = "libcontact_normal.so.2";
/// The same on macOS.
pub const INSTALL_NAME: &str = "libcontact_normal.2.dylib";

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let out = std::env::var("OUT_DIR").expect("cargo sets it");
    match std::env::var("CARGO_CFG_TARGET_OS").as_deref() {
        Ok("linux") => {
            println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,{SONAME}");
            println!("cargo:rustc-cdylib-link-arg=-Wl,-z,nodelete");
            link(Path::new(&out), "libcontact_normal.so", SONAME);
        }
        Ok("macos") => {
            println!("cargo:rustc-cdylib-link-arg=-Wl,-install_name,@rpath/{INSTALL_NAME}");
            link(Path::new(&out), "libcontact_normal.dylib", INSTALL_NAME);
        }
        // A DLL has one name. Nothing keeps a program from unloading it.
        _ => {}
    }
}

/// Links the name to the library in target/release, whose folder build/contact-normal-.../out is that of this program. Where that is laid
/// out otherwise, there is no link.
pub fn link(out: &Path, library: &str, name: &str) {
    let build = out.parent().and_then(Path::parent).filter(|build| build.ends_with("build"));
    let Some(profile) = build.and_then(Path::parent) else { return };
    #[cfg(unix)]
    if std::fs::symlink_metadata(profile.join(name)).is_err() {
        // Without it the library is built all the same.
        let _ = std::os::unix::fs::symlink(library, profile.join(name));
    }
    #[cfg(not(unix))]
    let _ = (profile, library, name);
}
