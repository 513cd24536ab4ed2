//! Compares this library with an older one: whole cold calls through the C ABI, in turns. Each call of a library is made in a process of its own.

use std::ffi::{c_void, CString};
use std::process::Command;
use std::ptr::null_mut;

use contact_normal::ffi::*;
use contact_normal::scene::Load;

use crate::case::{by_name, Case};
use crate::measure::{cold, median, seconds, shown};
use crate::summary;

/// The first argument of a process of this program that only calls [`call`].
pub const CALL: &str = "--call";

/// The number of turns.
const TURNS: usize = 5;
/// The seconds for which a process repeats its call.
const SECONDS: f64 = 0.5;

/// The paths of the older library and of this one as it is shipped, from `CONTACT_NORMAL_OLD` and `CONTACT_NORMAL_NEW`, which `make bench` sets.
fn libraries() -> Option<[String; 2]> {
    Some([std::env::var("CONTACT_NORMAL_OLD").ok()?, std::env::var("CONTACT_NORMAL_NEW").ok()?])
}

/// Prints the median times of both libraries, and their ratio.
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

/// The number that a process of this program prints when it gets these arguments.
fn of_process(arguments: &[&str]) -> f64 {
    let program = std::env::current_exe().expect("this program's path");
    let out = Command::new(program).args(arguments).output().expect("a process");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8_lossy(&out.stdout).trim().parse().expect("a time")
}

/// A loaded shared library.
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
    /// `F` is the type of the function of that name, if there is one.
    unsafe fn find<F: Copy>(&self, name: &str) -> Option<F> {
        let symbol = CString::new(name).expect("a name");
        // SAFETY: the library is open.
        let address = unsafe { libc::dlsym(self.0, symbol.as_ptr()) };
        // SAFETY: by the caller: a pointer to a function, as large as any.
        (!address.is_null()).then(|| unsafe { std::mem::transmute_copy(&address) })
    }

    fn is_abi_2(&self) -> bool {
        // SAFETY: any symbol will do, it is not called.
        unsafe { self.find::<unsafe extern "C" fn()>("contact_normal_init") }.is_some()
    }

    /// A struct with the defaults of this library. ABI 2 has one function for all structs, which gets the kind and the size. ABI 1 has a function
    /// for each struct, which sets fewer members; the library accepts the others if they are zero.
    ///
    /// # Safety
    /// `T` is the struct `contact_normal_<name>` of this kind, as the library has it.
    unsafe fn initialised<T>(&self, name: &str, kind: i32) -> T {
        // SAFETY: all bytes are valid in structs of the ABI.
        let mut value: T = unsafe { std::mem::zeroed() };
        let to = &raw mut value;
        // SAFETY (both): the types of the headers.
        unsafe {
            match self.find::<unsafe extern "C" fn(i32, *mut c_void, i64)>("contact_normal_init") {
                Some(init) => init(kind, to.cast(), size_of::<T>() as i64),
                None => {
                    let init = format!("contact_normal_{name}_init");
                    self.find::<unsafe extern "C" fn(*mut T)>(&init).expect("an _init")(to);
                }
            }
        }
        value
    }

    /// The default options with another number of threads, as bytes. ABI 1 and ABI 2 lay them out in different orders.
    ///
    /// # Safety
    /// The library is one of this project.
    unsafe fn options(&self, threads: i32) -> Vec<u64> {
        // In words of 8 bytes: in ABI 1 `max_cycles` and `threads` share word 8.
        if self.is_abi_2() {
            // SAFETY: the struct of this header.
            let mut options: contact_normal_options =
                unsafe { self.initialised("options", CONTACT_NORMAL_KIND_OPTIONS) };
            options.threads = threads;
            // SAFETY: integers, numbers and pointers, in whole words.
            return unsafe { std::mem::transmute::<contact_normal_options, [u64; WORDS]>(options) }.to_vec();
        }
        // SAFETY: 12 words, as in ABI 1.
        let mut options: [u64; 12] = unsafe { self.initialised("options", CONTACT_NORMAL_KIND_OPTIONS) };
        options[8] = (options[8] & 0xFFFF_FFFF) | (threads as u64) << 32;
        options.to_vec()
    }
}

/// The number of 8-byte words of `contact_normal_options`.
const WORDS: usize = size_of::<contact_normal_options>() / 8;

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
    let (mut scene, options, mut fields, solve) = unsafe {
        (
            library.initialised::<contact_normal_scene>("scene", CONTACT_NORMAL_KIND_SCENE),
            library.options(threads as i32),
            library.initialised::<contact_normal_fields>("fields", CONTACT_NORMAL_KIND_FIELDS),
            library.find::<Solve>("contact_normal_solve").expect("contact_normal_solve"),
        )
    };
    (scene.mx, scene.my, scene.dx, scene.dy) = (m as i32, m as i32, case.grid.dx, case.grid.dy);
    scene.undeformed_distance = case.h.as_ptr();
    (scene.shear_modulus, scene.poisson_ratio) = (case.bodies.shear_modulus, case.bodies.poisson_ratio);
    // ABI 1 has no UNSET: there a load of 0 is an approach, and of 1 a force.
    match (load, library.is_abi_2()) {
        ("force", true) => scene.force = force,
        ("force", false) => (scene.load, scene.force) = (1, force),
        _ => scene.approach = approach,
    }
    let mut p = vec![0.0; m * m];
    fields.pressure = p.as_mut_ptr();
    let mut once = || {
        // SAFETY: structs with their arrays.
        let status = unsafe { solve(&scene, options.as_ptr().cast(), &mut fields, null_mut()) };
        assert_eq!(status, CONTACT_NORMAL_OK, "{name} {m}");
    };
    once();
    let (began, mut times) = (std::time::Instant::now(), Vec::new());
    while times.is_empty() || began.elapsed().as_secs_f64() < SECONDS {
        times.push(seconds(&mut once));
    }
    println!("{:e}", median(&times));
}

/// The approach and the force of a case: one is its load, the other one that of the solution.
fn both_loads(case: &Case) -> (f64, f64) {
    let (_, report) = cold(&case.scene(), &Default::default());
    match case.load {
        Load::Approach(approach) => (approach, report.measures.force),
        Load::Force(force) => (report.measures.approach, force),
    }
}
