//! After a first pass over some scenes, further solves on the same solver allocate nothing. Allocations are counted on the solving thread, which is
//! the only one with threads = 1. (With more threads the queues of the pool grow now and then.)

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ptr::null_mut;

use contact_normal::ffi::*;
use contact_normal::grid::Grid;
use contact_normal::influence::Table;
use contact_normal::methods::multigrid::{CycleShape, SmootherKind};
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{ActiveSet, Criterion, Guess, InitialGuess, Method, Options, Outcome, Solver};

struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    ALLOCATIONS.with(|allocations| allocations.set(allocations.get() + 1));
}

// SAFETY: the system's allocator; counting allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: by the caller.
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: by the caller.
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: by the caller.
        unsafe { System.realloc(old, layout, size) }
    }
    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        // SAFETY: by the caller.
        unsafe { System.dealloc(old, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// The number of allocations on this thread during `work`.
fn allocations(work: impl FnOnce()) -> u64 {
    let before = ALLOCATIONS.get();
    work();
    ALLOCATIONS.get() - before
}

const STEEL: Bodies = Bodies { shear_modulus: [82000.0; 2], poisson_ratio: [0.28; 2] };
const LOADS: [Load; 3] = [Load::Approach(0.02), Load::Force(2000.0), Load::Approach(0.025)];

/// The distances of a wavy ball that touches at `(shift, 0)` elements from the middle of m x m elements. Grids below 64 x 64 have no windows.
fn surface(m: usize, shift: f64) -> Vec<f64> {
    let middle = 0.5 * (m as f64 - 1.0);
    (0..m * m)
        .map(|i| {
            let (x, y) = ((i % m) as f64 - middle - shift, (i / m) as f64 - middle);
            3e-4 * (x * x + y * y) + 0.002 * (0.9 * x).sin() * (0.7 * y).cos()
        })
        .collect()
}

fn grid(m: usize) -> Grid {
    Grid::new(m, m, 0.25, 0.2).expect("a grid")
}

/// Solves all surfaces with all loads three times on one solver. Returns the number of allocations of the third pass.
fn third_pass(m: usize, shifts: &[f64], table: Option<&Table>, options: &Options) -> u64 {
    let surfaces: Vec<Vec<f64>> = shifts.iter().map(|&shift| surface(m, shift)).collect();
    let scenes: Vec<Scene<'_>> = surfaces
        .iter()
        .flat_map(|h| LOADS.map(|load| Scene { influence: table.cloned(), ..Scene::new(grid(m), h, STEEL, load) }))
        .collect();
    let mut solver = Solver::new(&scenes[0], options).expect("a solver");
    // A solver that was set up with a table does not read the tables of later scenes.
    let pressure = vec![100.0; m * m];
    let contact: Vec<bool> = (0..m * m).map(|i| (i % m).abs_diff(m / 2) < 6 && (i / m).abs_diff(m / 2) < 7).collect();
    let guess = Guess { pressure: &pressure, contact: &contact };
    let fixed = options.active_set == ActiveSet::Fixed;
    let guess = (fixed || options.initial_guess == InitialGuess::Given).then_some(guess);
    let mut pass = || {
        for scene in &scenes {
            let (stop, _) = solver.solve(scene, options, guess, None).expect("a solve");
            assert_eq!(stop, Outcome::Converged, "{options:?}");
            let some_pressure = solver.state().p.iter().any(|p| *p > 0.0);
            assert!(some_pressure && !solver.ledger().is_empty(), "something was solved");
        }
    };
    assert!(allocations(&mut pass) > 0, "the first pass allocates, or nothing is counted");
    pass();
    allocations(pass)
}

#[test]
fn every_method_and_start_solves_again_without_allocating() {
    let methods = [Method::Auto, Method::ProjectedCg, Method::Norm, Method::Multigrid, Method::FullMultigrid];
    let guesses = [InitialGuess::None, InitialGuess::Given, InitialGuess::Previous];
    for method in methods {
        for initial_guess in guesses {
            for criterion in [Criterion::Residual, Criterion::Update] {
                let options = Options { method, initial_guess, criterion, max_cycles: 5000, ..Options::default() };
                assert_eq!(third_pass(48, &[0.0, 3.0], None, &options), 0, "{options:?}");
            }
        }
        let options = Options { method, active_set: ActiveSet::Fixed, max_cycles: 5000, ..Options::default() };
        assert_eq!(third_pass(48, &[0.0, 3.0], None, &options), 0, "{options:?}");
    }
}

#[test]
fn few_elements_solve_again_without_allocating() {
    for m in [1, 2] {
        for method in [Method::Auto, Method::ProjectedCg, Method::Norm] {
            for initial_guess in [InitialGuess::None, InitialGuess::Given, InitialGuess::Previous] {
                let options = Options { method, initial_guess, max_cycles: 5000, ..Options::default() };
                assert_eq!(third_pass(m, &[0.0, 0.2], None, &options), 0, "{m} x {m}, {options:?}");
            }
        }
    }
}

#[test]
fn every_smoother_solves_again_without_allocating() {
    for smoother in [SmootherKind::GaussSeidel, SmootherKind::RedBlack, SmootherKind::Fft] {
        for method in [Method::Multigrid, Method::FullMultigrid] {
            for coarsest in [4, 16] {
                let cycle = CycleShape { smoother, coarsest, ..CycleShape::default() };
                let options = Options { method, cycle, ..Options::default() };
                assert_eq!(third_pass(48, &[0.0, 3.0], None, &options), 0, "{options:?}");
            }
        }
    }
}

#[test]
fn coefficients_that_are_not_symmetric_solve_again_without_allocating() {
    let m = 24;
    let mut values = vec![0.0; 4 * m * m];
    for (i, value) in values.iter_mut().enumerate() {
        let (kx, ky) = ((i % (2 * m)) as f64 - m as f64, (i / (2 * m)) as f64 - m as f64);
        *value = 1e-6 * (1.0 + 0.01 * kx / m as f64) / (0.3 + kx.hypot(ky));
    }
    let table = Table::new(m, m, &values, &grid(m)).expect("a table");
    for method in [Method::Auto, Method::Norm] {
        for criterion in [Criterion::Residual, Criterion::Update] {
            let options = Options { method, criterion, max_cycles: 5000, ..Options::default() };
            assert_eq!(third_pass(m, &[0.0, 2.0], Some(&table), &options), 0, "{options:?}");
        }
    }
}

#[test]
fn a_window_that_moves_allocates_nothing_and_one_of_another_size_does() {
    let options = Options::default();
    // Solves for balls that touch at these places. Returns the allocations when all are solved again, and when they are solved with a larger
    // approach.
    let moves = |shifts: &[f64]| {
        let surfaces: Vec<Vec<f64>> = shifts.iter().map(|&shift| surface(96, shift)).collect();
        let scenes: Vec<Scene<'_>> =
            surfaces.iter().map(|h| Scene::new(grid(96), h, STEEL, Load::Approach(0.05))).collect();
        let mut solver = Solver::new(&scenes[0], &options).expect("a solver");
        let mut pass = |load: Load| {
            for scene in &scenes {
                let scene = Scene { load, ..scene.clone() };
                assert_eq!(solver.solve(&scene, &options, None, None).expect("a solve").0, Outcome::Converged);
            }
        };
        pass(Load::Approach(0.05));
        let again = allocations(|| pass(Load::Approach(0.05)));
        let larger = allocations(|| pass(Load::Approach(0.15)));
        (again, larger)
    };
    let (again, larger) = moves(&[0.0, 8.0]);
    assert_eq!(again, 0);
    assert!(larger > 0, "no new operator for a larger window?");
}

#[test]
fn handles_of_the_c_abi_solve_again_without_allocating() {
    fn initialised<T>(init: unsafe extern "C" fn(*mut T)) -> T {
        let mut value = std::mem::MaybeUninit::uninit();
        // SAFETY: `_init` fills a whole struct.
        unsafe {
            init(value.as_mut_ptr());
            value.assume_init()
        }
    }
    const M: usize = 48;
    let surfaces = [surface(M, 0.0), surface(M, 3.0)];
    let mut scene = initialised(contact_normal_scene_init);
    (scene.mx, scene.my, scene.dx, scene.dy) = (M as i32, M as i32, 0.25, 0.2);
    (scene.shear_modulus, scene.poisson_ratio) = (STEEL.shear_modulus, STEEL.poisson_ratio);
    scene.undeformed_distance = surfaces[0].as_ptr();
    (scene.load, scene.approach, scene.force) = (CONTACT_NORMAL_PRESCRIBED_APPROACH, 0.02, 2000.0);
    let (mut p, mut u, mut e, mut contact) = (vec![0.0; M * M], vec![0.0; M * M], vec![0.0; M * M], vec![0; M * M]);
    let mut rows = vec![contact_normal_ledger_row::default(); 16];
    let mut fields = initialised(contact_normal_fields_init);
    (fields.pressure, fields.displacement) = (p.as_mut_ptr(), u.as_mut_ptr());
    (fields.deformed_distance, fields.contact) = (e.as_mut_ptr(), contact.as_mut_ptr());
    let mut report = initialised(contact_normal_report_init);
    (report.ledger, report.ledger_capacity) = (rows.as_mut_ptr(), 16);
    for method in CONTACT_NORMAL_METHOD_AUTO..=CONTACT_NORMAL_METHOD_PROJECTED_CG {
        for initial_guess in CONTACT_NORMAL_INITIAL_GUESS_NONE..=CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS {
            for active_set in [CONTACT_NORMAL_ACTIVE_SET_FREE, CONTACT_NORMAL_ACTIVE_SET_FIXED] {
                let mut options = initialised(contact_normal_options_init);
                (options.method, options.initial_guess, options.active_set) = (method, initial_guess, active_set);
                options.max_cycles = 5000;
                let mut handle = null_mut();
                // SAFETY: structs that declare their size.
                assert_eq!(unsafe { contact_normal_solver_new(&scene, &options, &mut handle) }, CONTACT_NORMAL_OK);
                let mut pass = || {
                    for h in &surfaces {
                        for load in [CONTACT_NORMAL_PRESCRIBED_APPROACH, CONTACT_NORMAL_PRESCRIBED_FORCE] {
                            (scene.undeformed_distance, scene.load) = (h.as_ptr(), load);
                            let inside = |i: usize| (i % M).abs_diff(M / 2) < 6 && (i / M).abs_diff(M / 2) < 7;
                            // SAFETY: room for M * M values; then the handle and structs that declare their size.
                            let status = unsafe {
                                (0..M * M).for_each(|i| fields.contact.add(i).write(i32::from(inside(i))));
                                contact_normal_solver_solve(handle, &scene, &options, &mut fields, &mut report)
                            };
                            assert_eq!(status, CONTACT_NORMAL_OK);
                        }
                    }
                };
                pass();
                pass();
                assert_eq!(allocations(pass), 0, "method {method}, guess {initial_guess}, active set {active_set}");
                // SAFETY: made above.
                unsafe { contact_normal_solver_free(handle) };
            }
        }
    }
}
