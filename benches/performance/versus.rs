//! This library beside an older one: whole cold calls through the C ABI, in turns, each library in processes of its own.

use std::ffi::{c_void, CString};
use std::process::Command;
use std::ptr::null_mut;

use contact_normal::ffi::*;
use contact_normal::scene::Load;

use crate::case::{by_name, Case};
use crate::measure::{cold, median, seconds, shown};
use crate::summary;

/// The argument that makes a process do nothing but [`call`].
pub const CALL: &str = "--call";

/// Turns, and seconds of each.
const TURNS: usize = 5;
const SECONDS: f64 = 0.5;

/// The older library, and this one as it is shipped: `CONTACT_NORMAL_OLD` and `CONTACT_NORMAL_NEW`; none: `make bench` sets them.
fn libraries() -> Option<[String; 2]> {
    Some([std::env::var("CONTACT_NORMAL_OLD").ok()?, std::env::var("CONTACT_NORMAL_NEW").ok()?])
}

/// The table.
pub fn versus(threads: usize, sizes: &[usize]) {
    println!("\n### Cold calls through the C ABI beside commit 9fd3772, {threads} thread(s)\n");
    let Some(libraries) = libraries() else {
        println!("CONTACT_NORMAL_OLD and CONTACT_NORMAL_NEW name no libraries: use `make bench`.");
        return;
    };
    println!("| case | load | old | new | new / old |");
    println!("|---|---|---|---|---|");
    let small = [("ellipse", 16), ("ellipse", 64), ("ellipse", 128)];
    let large = sizes.iter().flat_map(|&m| [("ellipse", m), ("rough", m)]);
    for ((name, m), load) in small.into_iter().chain(large).flat_map(|case| [(case, "approach"), (case, "force")]) {
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..TURNS {
            for (times, library) in times.iter_mut().zip(&libraries) {
                times.push(of_process(&[CALL, library, name, &m.to_string(), load, &threads.to_string()]));
            }
        }
        let [old, new] = times.map(|times| median(&times));
        if threads == 1 && m >= 512 {
            summary::note(summary::VERSUS, old / new);
        }
        println!("| {name} {m} | {load} | {} | {} | {:.2} |", shown(old), shown(new), new / old);
    }
}

/// What a process of this program prints.
fn of_process(arguments: &[&str]) -> f64 {
    let program = std::env::current_exe().expect("this program's path");
    let out = Command::new(program).args(arguments).output().expect("a process");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8_lossy(&out.stdout).trim().parse().expect("a time")
}

/// A library, loaded.
struct Library(*mut c_void);

impl Library {
    fn open(path: &str) -> Library {
        let path = CString::new(path).expect("a path");
        // SAFETY: a path that ends with 0; our own libraries do nothing when they are loaded.
        let library = unsafe { libc::dlopen(path.as_ptr(), libc::RTLD_NOW | libc::RTLD_LOCAL) };
        assert!(!library.is_null(), "{path:?} cannot be loaded");
        Library(library)
    }

    /// # Safety
    /// `F` is the type of the function of that name.
    unsafe fn function<F: Copy>(&self, name: &str) -> F {
        let symbol = CString::new(name).expect("a name");
        // SAFETY: the library is open.
        let address = unsafe { libc::dlsym(self.0, symbol.as_ptr()) };
        assert!(!address.is_null(), "{name} is not exported");
        // SAFETY: by the caller: a pointer to a function, as large as any.
        unsafe { std::mem::transmute_copy(&address) }
    }

    /// A struct as this library begins it: an older one fills less of it, and accepts the rest if that is zero.
    ///
    /// # Safety
    /// `init` is the name of the `_init` of `T`.
    unsafe fn initialised<T>(&self, init: &str) -> T {
        // SAFETY: all bytes are valid in structs of the ABI.
        let mut value: T = unsafe { std::mem::zeroed() };
        // SAFETY: by the caller.
        unsafe { self.function::<unsafe extern "C" fn(*mut T)>(init)(&mut value) };
        value
    }
}

/// Prints the median time of cold calls of one case by one library.
pub fn call(library: &str, name: &str, m: usize, load: &str, threads: usize) {
    let case = by_name(name, m);
    let (approach, force) = both_loads(&case);
    let library = Library::open(library);
    type Solve = unsafe extern "C" fn(
        *const contact_normal_scene,
        *const contact_normal_options,
        *mut contact_normal_fields,
        *mut contact_normal_report,
    ) -> contact_normal_status;
    // SAFETY (all): the types of the header.
    let (mut scene, mut options, mut fields, solve) = unsafe {
        (
            library.initialised::<contact_normal_scene>("contact_normal_scene_init"),
            library.initialised::<contact_normal_options>("contact_normal_options_init"),
            library.initialised::<contact_normal_fields>("contact_normal_fields_init"),
            library.function::<Solve>("contact_normal_solve"),
        )
    };
    (scene.mx, scene.my, scene.dx, scene.dy) = (m as i32, m as i32, case.grid.dx, case.grid.dy);
    (scene.undeformed_distance, scene.approach, scene.force) = (case.h.as_ptr(), approach, force);
    (scene.shear_modulus, scene.poisson_ratio) = (case.bodies.shear_modulus, case.bodies.poisson_ratio);
    scene.load = i32::from(load == "force");
    options.threads = threads as i32;
    let mut p = vec![0.0; m * m];
    fields.pressure = p.as_mut_ptr();
    let mut once = || {
        // SAFETY: structs with their arrays.
        let status = unsafe { solve(&scene, &options, &mut fields, null_mut()) };
        assert_eq!(status, CONTACT_NORMAL_OK, "{name} {m}");
    };
    once();
    let (began, mut times) = (std::time::Instant::now(), Vec::new());
    while times.is_empty() || began.elapsed().as_secs_f64() < SECONDS {
        times.push(seconds(&mut once));
    }
    println!("{:e}", median(&times));
}

/// The case's own load, and the other one that belongs to it.
fn both_loads(case: &Case) -> (f64, f64) {
    let (_, report) = cold(&case.scene(), &Default::default());
    match case.load {
        Load::Approach(approach) => (approach, report.measures.force),
        Load::Force(force) => (report.measures.approach, force),
    }
}
