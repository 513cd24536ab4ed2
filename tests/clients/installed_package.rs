//! `make install` and pkg-config agree: a program that is compiled with the flags of pkg-config runs, with the shared and with the static library;
//! the version is the same everywhere; and `make uninstall` leaves no file. `make package-test` also tests CMake, fpm and the wheel.

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

/// Runs `make` for a target with these variables, without the job server of a make that may be running these tests.
fn make(target: &str, variables: &[String]) {
    let mut make = Command::new("make");
    run(make.env_remove("MAKEFLAGS").arg("-C").arg(root()).arg(target).args(variables));
}

/// Runs `make` with the library that `cargo test` has built beside the test programs, so that it is not built again.
fn make_built(target: &str, variables: &[String]) {
    let built = std::env::current_exe().expect("this test's path").parent().expect("its folder").to_owned();
    let built = [
        format!("LIBDIR_BUILT={}", built.display()),
        concat!("REPLAY_BUILT=", env!("CARGO_BIN_EXE_contact-normal-replay")).to_owned(),
    ];
    make(target, &[&built, variables].concat());
}

/// The files and links below a folder, in order.
fn files(folder: &Path) -> Vec<String> {
    let found = run(Command::new("find").arg(".").args(["-not", "-type", "d"]).current_dir(folder));
    let mut found: Vec<String> = found.lines().map(|line| line[2..].to_owned()).collect();
    found.sort();
    found
}

/// Runs `pkg-config` on the installed package, and returns the words of its output.
fn pkg_config(prefix: &Path, arguments: &[&str]) -> Vec<String> {
    let mut command = Command::new("pkg-config");
    command.args(arguments).arg("contact-normal").env("PKG_CONFIG_PATH", prefix.join("lib/pkgconfig"));
    run(&mut command).split_whitespace().map(str::to_owned).collect()
}

/// Asserts that the shared library has all its names, and that the headers are copies.
fn has_links_and_headers(prefix: &Path, version: &str) {
    let links = [
        ("libcontact_normal.so", format!("libcontact_normal.so.{version}")),
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
            let [ours, installed] = [root(), prefix].map(|from| std::fs::read(from.join(&file)).expect("a file"));
            assert!(ours == installed, "{name}");
            count += 1;
        }
    }
    assert!(count >= 9, "{count} files");
}

#[test]
fn the_installed_package_is_what_pkg_config_says() {
    let folder = scratch("installed_package");
    let prefix = folder.join("prefix");
    let version = env!("CARGO_PKG_VERSION");
    make_built("install", &[format!("PREFIX={}", prefix.display())]);

    assert_eq!(pkg_config(&prefix, &["--modversion"]), [version]);
    has_links_and_headers(&prefix, version);

    // The installed replay program runs. Without a file it prints its usage.
    let replay = Command::new(prefix.join("bin/contact-normal-replay")).output().expect("the program");
    assert!(String::from_utf8_lossy(&replay.stderr).starts_with("usage: contact-normal-replay FILE"));

    let source = folder.join("program.c");
    std::fs::write(&source, PROGRAM).expect("a source file");
    let compile = |name: &str, flags: Vec<String>| {
        let program = folder.join(name);
        let mut gcc = Command::new("gcc");
        gcc.args(["-std=c99", "-Wall", "-o"]).arg(&program).arg(&source).args(&flags);
        if flags.iter().any(|flag| flag == "-static") {
            // The linker warns of functions that glibc has in its shared form only. The library calls none of them.
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

    // The library has no debug information.
    let sections = run(Command::new("readelf").args(["-SW"]).arg(prefix.join("lib/libcontact_normal.so")));
    assert!(sections.contains(".dynsym") && !sections.contains(".debug_info"), "{sections}");

    // The flags of `pkg-config --static` link the static library, although the shared one exists. With -static all libraries are static.
    for (name, more) in [("static", None), ("all_static", Some("-static"))] {
        let flags = pkg_config(&prefix, &["--static", "--cflags", "--libs"]);
        let fixed = compile(name, more.map(str::to_owned).into_iter().chain(flags).collect());
        let dynamic = run(Command::new("readelf").arg("-d").arg(&fixed));
        assert!(!dynamic.contains("contact_normal"), "{name}: {dynamic}");
        assert_eq!(run(&mut Command::new(&fixed)), expected, "{name}");
    }
}

/// All files are installed below a packager's staging folder, and no file contains its name. The library folder is below or beside the prefix.
#[test]
fn a_packager_chooses_the_folders() {
    let version = env!("CARGO_PKG_VERSION");
    let staged = scratch("staged_package").join("staged");
    for (libraries, told) in
        [("/opt/contact/lib/some-machine", "${prefix}/lib/some-machine"), ("/opt/lib64", "/opt/lib64")]
    {
        let variables = [
            format!("DESTDIR={}", staged.display()),
            "PREFIX=/opt/contact".to_owned(),
            format!("LIBDIR={libraries}"),
            "DEBUGDIR=/opt/debug".to_owned(),
        ];
        make_built("install", &variables);
        let libraries = &libraries[1..];
        let described = staged.join(libraries).join("pkgconfig/contact-normal.pc");
        let described = std::fs::read_to_string(described).expect("a .pc");
        assert!(described.starts_with("prefix=/opt/contact\n") && !described.contains("staged"), "{described}");
        assert!(described.contains(&format!("libdir={told}\n")), "{described}");
        // For the library /a/b.so debuggers look in DEBUGDIR/a.
        let real = format!("{libraries}/libcontact_normal.so.{version}");
        assert!(staged.join(format!("opt/debug/{real}.debug")).exists());
        let sections = run(Command::new("readelf").args(["-SW"]).arg(staged.join(real)));
        assert!(sections.contains(".gnu_debuglink") && !sections.contains(".debug_info"), "{sections}");
        cmake_finds(&staged.join(libraries), &staged.join("opt/contact"));
        // `make uninstall` leaves only empty folders.
        make_built("uninstall", &variables);
        assert_eq!(files(&staged), [""; 0]);
    }
}

/// A relocatable installation may be moved: pkg-config gives the folder in which it is now.
#[test]
fn an_archive_is_unpacked_anywhere() {
    let folder = scratch("moved_package");
    let made = folder.join("made");
    make_built("install", &[format!("PREFIX={}", made.display()), "RELOCATABLE=yes".to_owned()]);
    let moved = folder.join("moved");
    std::fs::rename(made, &moved).expect("moved");
    let flags = pkg_config(&moved, &["--cflags"]);
    let named = flags[0].strip_prefix("-I").expect("a folder of headers");
    assert_eq!(
        std::fs::canonicalize(named).expect("the folder"),
        moved.join("include").canonicalize().expect("the folder")
    );
    cmake_finds(&moved.join("lib"), &moved);
}

/// Variables that exclude each other are refused before any file is written.
#[test]
fn variables_that_do_not_go_together_are_refused() {
    for (variables, says) in [
        (["RELOCATABLE=yes", "PREFIX=/opt/a", "LIBDIR=/opt/b"], "LIBDIR is /opt/b"),
        (["DEBUGDIR=/usr/lib/debug", "TARGET=aarch64-apple-darwin", "PREFIX=/opt/a"], "DEBUGDIR: on macOS"),
    ] {
        let mut make = Command::new("make");
        make.env_remove("MAKEFLAGS").arg("-C").arg(root()).args(["-n", "install"]).args(variables);
        let output = make.output().expect("make");
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && told.contains(says), "{variables:?}: {told}");
    }
}

/// Asserts what CMake's file of an installation says: the library in the folder `libraries`, and the headers in the prefix.
fn cmake_finds(libraries: &Path, prefix: &Path) {
    let script = libraries.join("found.cmake");
    // A CMake script cannot have targets, so that these macros print the properties instead.
    let text = format!(
        "cmake_minimum_required(VERSION 3.10)\nmacro(add_library)\nendmacro()\nmacro(set_target_properties)\nmessage(\"${{ARGN}}\")\nendmacro()\n\
         macro(get_property)\nendmacro()\ninclude({}/cmake/contact-normal/contact-normal-config.cmake)\n",
        libraries.display()
    );
    std::fs::write(&script, text).expect("a script");
    let output = Command::new("cmake").arg("-P").arg(&script).output().expect("cmake");
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    std::fs::remove_file(&script).expect("removed");
    assert!(output.status.success(), "{told}");
    assert!(told.contains(&format!("IMPORTED_LOCATION;{}/libcontact_normal.so", libraries.display())), "{told}");
    // With DESTDIR an absolute prefix is that on the machine where the files will be used.
    let moved = prefix.join("include");
    let include = if libraries.starts_with(prefix) { moved.as_path() } else { Path::new("/opt/contact/include") };
    assert!(told.contains(&format!("INTERFACE_INCLUDE_DIRECTORIES;{}", include.display())), "{told}");
}

/// The names of files on other systems: the files that cargo builds are installed under the names that programs use there.
#[test]
fn other_systems_have_their_own_names() {
    let folder = scratch("other_systems");
    let version = env!("CARGO_PKG_VERSION");
    let (real, soname) = (format!("lib/libcontact_normal.{version}.dylib"), "lib/libcontact_normal.2.dylib".to_owned());
    let systems = [
        (
            "aarch64-apple-darwin",
            ["libcontact_normal.dylib", "libcontact_normal.a", "contact-normal-replay"].as_slice(),
            vec!["bin/contact-normal-replay".to_owned(), soname, real, "lib/libcontact_normal.dylib".to_owned()],
            "-Wl,-dead_strip_dylibs -lcontact_normal",
        ),
        (
            "x86_64-pc-windows-gnu",
            ["contact_normal.dll", "libcontact_normal.dll.a", "libcontact_normal.a", "contact-normal-replay.exe"]
                .as_slice(),
            vec![
                "bin/contact-normal-replay.exe".to_owned(),
                "bin/contact_normal.dll".to_owned(),
                "lib/libcontact_normal.dll.a".to_owned(),
            ],
            "-L${libdir} -lcontact_normal",
        ),
    ];
    for (target, built, expected, flags) in systems {
        let from = folder.join(format!("{target}/release"));
        std::fs::create_dir_all(&from).expect("folders");
        for name in built {
            std::fs::write(from.join(name), name).expect("a file");
        }
        let prefix = folder.join(target).join("prefix");
        let variables = [
            format!("TARGET={target}"),
            format!("LIBDIR_BUILT={}", from.display()),
            "STRIPPED=no".to_owned(),
            format!("PREFIX={}", prefix.display()),
        ];
        make("install", &variables);
        let installed = files(&prefix);
        for name in expected.iter().map(String::as_str).chain(["lib/libcontact_normal.a"]) {
            assert!(installed.iter().any(|file| file == name), "{name} of {target}: {installed:?}");
        }
        assert!(!installed.iter().any(|file| file.contains(".so")), "{installed:?}");
        let described = std::fs::read_to_string(prefix.join("lib/pkgconfig/contact-normal-shared.pc")).expect("a .pc");
        assert!(described.contains(flags), "{described}");
        make("uninstall", &variables);
        assert_eq!(files(&prefix), [""; 0]);
    }
}
