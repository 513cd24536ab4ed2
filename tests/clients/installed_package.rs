//! `make install` gives what pkg-config says: a program compiled with its flags runs, with the shared and with the static
//! library, the version is the same wherever it stands, and `make uninstall` leaves nothing. `make package-test` goes further:
//! CMake, fpm, the wheel.

use std::path::Path;
use std::process::Command;

use crate::support::{root, run, scratch};
use contact_normal::ffi::CONTACT_NORMAL_ABI_VERSION;

const PROGRAM: &str = r#"
#include <contact_normal.h>
#include <stdio.h>

int main(void)
{
    const double shear_modulus[2] = {82000.0, 82000.0}, poisson_ratio[2] = {0.28, 0.28};
    contact_normal_hertz_solution exact;
    contact_normal_hertz_solution_init(&exact);
    contact_normal_status status = contact_normal_hertz(0.0016681, 0.0030671, shear_modulus, poisson_ratio,
                                                        CONTACT_NORMAL_PRESCRIBED_APPROACH, 0.1091, &exact);
    if (status != CONTACT_NORMAL_OK) {
        return 1;
    }
    printf("%s %d %d %.0f\n", contact_normal_version(), (int)contact_normal_abi_version(), CONTACT_NORMAL_ABI_VERSION,
           exact.force);
    return 0;
}
"#;

/// `pkg-config` on the installed package; what it says, split at blanks.
fn pkg_config(prefix: &Path, arguments: &[&str]) -> Vec<String> {
    let mut command = Command::new("pkg-config");
    command.args(arguments).arg("contact-normal").env("PKG_CONFIG_PATH", prefix.join("lib/pkgconfig"));
    run(&mut command).split_whitespace().map(str::to_owned).collect()
}

#[test]
fn the_installed_package_is_what_pkg_config_says() {
    let folder = scratch("installed_package");
    let prefix = folder.join("prefix");
    // The libraries that `cargo test` has built beside the test programs, not a second build.
    let built = std::env::current_exe().expect("this test's path").parent().expect("its folder").to_owned();
    let make = |target: &str, variables: &[String]| {
        let built = format!("LIBDIR_BUILT={}", built.display());
        // Without the job server of a make that may run these tests.
        let mut make = Command::new("make");
        make.arg(concat!("REPLAY_BUILT=", env!("CARGO_BIN_EXE_contact-normal-replay")));
        make.env_remove("MAKEFLAGS").arg("-C").arg(root()).arg(target).arg(built).args(variables);
        run(&mut make)
    };
    make("install", &[format!("PREFIX={}", prefix.display())]);

    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(pkg_config(&prefix, &["--modversion"]), [version]);
    let links = [
        ("libcontact_normal.so", "libcontact_normal.so.2".to_owned()),
        ("libcontact_normal.so.2", format!("libcontact_normal.so.{version}")),
    ];
    for (link, target) in links {
        let to = std::fs::read_link(prefix.join("lib").join(link)).expect("a link");
        assert_eq!(to, Path::new(&target), "{link}");
    }
    let mut count = 0;
    for file in std::fs::read_dir(root().join("include")).expect("include/") {
        let name = file.expect("a file").file_name().into_string().expect("UTF-8");
        if [".h", ".hpp", ".f90", ".inc"].iter().any(|end| name.ends_with(end)) {
            let file = Path::new("include").join(&name);
            let [ours, installed] = [root(), &prefix].map(|from| std::fs::read(from.join(&file)).expect("a file"));
            assert!(ours == installed, "{name}");
            count += 1;
        }
    }
    assert!(count >= 9, "{count} files");

    // It runs from there; without a file it says how it is used.
    let replay = Command::new(prefix.join("bin/contact-normal-replay")).output().expect("the program");
    assert!(String::from_utf8_lossy(&replay.stderr).starts_with("usage: contact-normal-replay FILE"));

    let source = folder.join("program.c");
    std::fs::write(&source, PROGRAM).expect("a source file");
    let compile = |name: &str, flags: Vec<String>| {
        let program = folder.join(name);
        let mut gcc = Command::new("gcc");
        gcc.args(["-std=c99", "-Wall", "-o"]).arg(&program).arg(&source).args(&flags);
        if flags.iter().any(|flag| flag == "-static") {
            // The linker warns of what glibc can only do shared; nothing of it is called.
            assert!(gcc.output().expect("gcc").status.success());
        } else {
            run(&mut gcc);
        }
        program
    };
    // 81987 N: the paper's problem (tests/problems/hertz.rs checks the closed form).
    let expected = format!("{version} {CONTACT_NORMAL_ABI_VERSION} {CONTACT_NORMAL_ABI_VERSION} 81987\n");
    let shared = compile("shared", pkg_config(&prefix, &["--cflags", "--libs"]));
    let dynamic = run(Command::new("readelf").arg("-d").arg(&shared));
    assert!(dynamic.contains("Shared library: [libcontact_normal.so.2]"), "{dynamic}");
    assert_eq!(run(Command::new(&shared).env("LD_LIBRARY_PATH", prefix.join("lib"))), expected);

    // Without debug information, which a debugger finds by the link.
    let sections = run(Command::new("readelf").args(["-SW"]).arg(prefix.join("lib/libcontact_normal.so")));
    assert!(sections.contains(".gnu_debuglink") && !sections.contains(".debug_info"), "{sections}");
    assert!(prefix.join(format!("lib/.debug/libcontact_normal.so.{version}.debug")).exists());

    // The flags of --static take the static library though the shared one is there; with -static everything is.
    for (name, more) in [("static", None), ("all_static", Some("-static"))] {
        let flags = pkg_config(&prefix, &["--static", "--cflags", "--libs"]);
        let fixed = compile(name, more.map(str::to_owned).into_iter().chain(flags).collect());
        let dynamic = run(Command::new("readelf").arg("-d").arg(&fixed));
        assert!(!dynamic.contains("contact_normal"), "{name}: {dynamic}");
        assert_eq!(run(&mut Command::new(&fixed)), expected, "{name}");
    }

    // A packager's staging folder takes the files, and leaves no trace in them.
    let staged = folder.join("staged");
    make("install", &[format!("DESTDIR={}", staged.display()), "PREFIX=/opt/contact".to_owned()]);
    let described = std::fs::read_to_string(staged.join("opt/contact/lib/pkgconfig/contact-normal.pc")).expect("a .pc");
    assert!(described.starts_with("prefix=/opt/contact\n") && !described.contains("staged"), "{described}");

    // Nothing is left of it but empty folders.
    make("uninstall", &[format!("DESTDIR={}", staged.display()), "PREFIX=/opt/contact".to_owned()]);
    let left = run(Command::new("find").arg(&staged).args(["-not", "-type", "d"]));
    assert!(left.is_empty(), "{left}");
}
