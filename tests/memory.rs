//! If an allocation fails, whichever it is, the call returns a status. No memory leaks.

#[path = "handles/limited_memory.rs"]
mod limited_memory;

use std::ptr::{null, null_mut};
use std::sync::{Mutex, MutexGuard, PoisonError};

use contact_normal::ffi::*;

fn initialised<T>(init: unsafe extern "C" fn(*mut T)) -> T {
    let mut value = std::mem::MaybeUninit::uninit();
    // SAFETY: `_init` fills a whole struct.
    unsafe {
        init(value.as_mut_ptr());
        value.assume_init()
    }
}

/// A ball on m x m elements, with an approach for which only a part of them is in contact.
fn scene(m: usize, h: &mut Vec<f64>) -> contact_normal_scene {
    let centre = |i: usize| i as f64 + 0.5 - 0.5 * m as f64;
    *h = (0..m * m).map(|i| (centre(i % m).powi(2) + centre(i / m).powi(2)) / (m * m) as f64).collect();
    let mut scene = initialised(contact_normal_scene_init);
    (scene.mx, scene.my, scene.dx, scene.dy) = (m as i32, m as i32, 1.0 / m as f64, 1.0 / m as f64);
    (scene.shear_modulus, scene.poisson_ratio) = ([1.0, f64::INFINITY], [0.3, 0.3]);
    (scene.approach, scene.undeformed_distance) = (0.15, h.as_ptr());
    scene
}

/// Lets one test at a time run, because each counts the memory that the library keeps for the process.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

const METHODS: [i32; 5] = [
    CONTACT_NORMAL_METHOD_AUTO,
    CONTACT_NORMAL_METHOD_NORM,
    CONTACT_NORMAL_METHOD_MULTIGRID,
    CONTACT_NORMAL_METHOD_FULL_MULTIGRID,
    CONTACT_NORMAL_METHOD_PROJECTED_CG,
];

/// Solves with `allowed` successful large allocations. Asserts that without a result the outputs are unchanged. Returns the status.
fn solve_with(scene: &contact_normal_scene, options: &contact_normal_options, allowed: u64, p: &mut [f64]) -> i32 {
    let mut fields = initialised(contact_normal_fields_init);
    fields.pressure = p.as_mut_ptr();
    let before = p.to_vec();
    // SAFETY: structs with their arrays.
    let solve = || unsafe { contact_normal_solve(scene, options, &mut fields, null_mut()) };
    let status = limited_memory::with(p.len(), allowed, solve);
    limited_memory::release();
    assert!(status >= 0 || p == before, "outputs were written");
    status
}

#[test]
fn a_failed_allocation_is_out_of_memory_whichever_it_is() {
    let _alone = alone();
    // Arrays of one byte per element count as large, but no array of a row or of a transform does.
    let m = 256;
    let mut h = Vec::new();
    let scene = scene(m, &mut h);
    let mut table = vec![0.0; 4 * m * m];
    let mut influence = initialised(contact_normal_influence_init);
    let (g, nu) = (scene.shear_modulus, scene.poisson_ratio);
    // SAFETY: two values each, and room for 2 m by 2 m.
    let status = unsafe {
        let (size, values) = (m as i32, table.as_mut_ptr());
        contact_normal_influence_half_space(size, size, scene.dx, scene.dy, g.as_ptr(), nu.as_ptr(), values)
    };
    assert_eq!(status, CONTACT_NORMAL_OK);
    (influence.cx, influence.cy, influence.coefficients) = (m as i32, m as i32, table.as_ptr());
    let with_table = contact_normal_scene { influence: &influence, ..scene };
    // There are few rows, so that the row tables do not take gigabytes, but enough rows that the FFT plans of a row are small: the FFT crate cannot
    // refuse a lack of memory.
    let my = 64;
    let mx = m * m / my;
    let mut values = vec![0.0; my * my * 2 * mx];
    for (k, row) in values.chunks_exact_mut(2 * mx).enumerate() {
        let apart = (k % my).abs_diff(k / my) as f64;
        let offsets = row.iter_mut().zip(-(mx as i64)..);
        offsets.for_each(|(value, kx)| *value = 0.01 / (1.0 + (kx * kx) as f64 + apart * apart).sqrt());
    }
    let mut row_tables = initialised(contact_normal_row_tables_init);
    (row_tables.cx, row_tables.rows, row_tables.coefficients) = (mx as i32, my as i32, values.as_ptr());
    let (mx, my) = (mx as i32, my as i32);
    let with_rows = contact_normal_scene { mx, my, row_tables: &row_tables, ..scene };
    let scenes = [
        ("half-space", &scene, &METHODS[..]),
        ("table", &with_table, &METHODS[..1]),
        ("row tables", &with_rows, &METHODS[..1]),
    ];
    for (name, scene, methods) in scenes {
        for &method in methods {
            let mut options = initialised(contact_normal_options_init);
            (options.method, options.tolerance, options.max_cycles) = (method, 1e-3, 2);
            // The first solve of each kind leaves memory that the library keeps for the process.
            assert!(solve_with(scene, &options, u64::MAX, &mut vec![0.0; m * m]) >= 0);
            let what = format!("{name}, method {method}");
            let refused = limited_memory::until_enough(&what, |allowed| {
                let mut p = vec![-7.0; m * m];
                let held = limited_memory::held();
                let status = solve_with(scene, &options, allowed, &mut p);
                // The thread keeps the message of the last refusal, less than 500 bytes.
                let kept = limited_memory::held() - held;
                assert!(kept.abs() < 500, "{what}, {allowed} allocations: {kept} bytes are held");
                // The two cycles that are allowed need not converge: any status of a result counts as enough memory.
                status.min(CONTACT_NORMAL_OK)
            });
            assert!(refused > 8, "{what}: {refused} refusals");
        }
    }
}

#[test]
fn an_absurd_size_is_out_of_memory() {
    let _alone = alone();
    // The distances are zeros without memory pages behind them. The operator would be even larger.
    let m = 8_000;
    let bytes = m * m * size_of::<f64>();
    let flags = libc::MAP_PRIVATE | libc::MAP_ANONYMOUS | libc::MAP_NORESERVE;
    // SAFETY: a new mapping, unmapped below.
    let h = unsafe { libc::mmap(null_mut(), bytes, libc::PROT_READ, flags, -1, 0) };
    assert!(h != libc::MAP_FAILED);
    let mut none = Vec::new();
    let mut scene = scene(1, &mut none);
    (scene.mx, scene.my, scene.undeformed_distance) = (m as i32, m as i32, h.cast());
    let mut handle = null_mut();
    // SAFETY: the scene's array has m * m zeros.
    let new = || unsafe { contact_normal_solver_new(&scene, null(), &mut handle) };
    let status = limited_memory::with(1 << 28, 0, new);
    // SAFETY: mapped above.
    unsafe { libc::munmap(h, bytes) };
    assert_eq!(status, CONTACT_NORMAL_OUT_OF_MEMORY);
    assert!(handle.is_null());
}

#[test]
fn ten_thousand_handles_leave_nothing_behind() {
    let _alone = alone();
    let mut h = Vec::new();
    let scene = scene(9, &mut h);
    let mut p = vec![0.0; 81];
    let mut fields = initialised(contact_normal_fields_init);
    fields.pressure = p.as_mut_ptr();
    let mut held = 0;
    for number in 0..10_000 {
        let mut options = initialised(contact_normal_options_init);
        options.method = METHODS[number % METHODS.len()];
        let mut handle = null_mut();
        // SAFETY: structs with their arrays; the handle is freed once.
        unsafe {
            assert_eq!(contact_normal_solver_new(&scene, &options, &mut handle), CONTACT_NORMAL_OK);
            let status = contact_normal_solver_solve(handle, &scene, &options, &mut fields, null_mut());
            assert_eq!(status, CONTACT_NORMAL_OK);
            contact_normal_solver_free(handle);
        }
        // The first handle of each kind leaves memory that the library keeps for the process.
        if number == METHODS.len() {
            held = limited_memory::held();
        }
    }
    assert_eq!(limited_memory::held(), held, "bytes are held after 10^4 handles");
}

/// The bytes of a handle after a solve: those that its report says, and those that it holds.
fn bytes_of(scene: &contact_normal_scene, what: &str) -> [f64; 2] {
    let options: contact_normal_options = initialised(contact_normal_options_init);
    let mut bytes = [0.0; 2];
    // Plans of transforms belong to the thread. When the loop is repeated, they exist already.
    for _ in 0..2 {
        // SAFETY (all): structs with their arrays, a handle of ours, and NULL.
        contact_normal_release();
        let before = limited_memory::held();
        let mut handle = null_mut();
        let mut report: contact_normal_report = initialised(contact_normal_report_init);
        let status = unsafe {
            assert_eq!(contact_normal_solver_new(scene, &options, &mut handle), CONTACT_NORMAL_OK);
            contact_normal_solver_solve(handle, scene, &options, null_mut(), &mut report)
        };
        assert_eq!(status, CONTACT_NORMAL_OK, "{what}");
        contact_normal_release();
        bytes = [report.statistics.bytes as f64, (limited_memory::held() - before) as f64];
        unsafe { contact_normal_solver_free(handle) };
    }
    bytes
}

/// `bytes` of a report grow with friction as the memory of the handle does: by its operators, their workspaces and the arrays of its iterations.
#[test]
fn reported_bytes_grow_by_what_friction_holds() {
    let _alone = alone();
    let mut h = Vec::new();
    let mut scene = scene(96, &mut h);
    for moduli in [[1.0; 2], [1.0, 3.0]] {
        for (motion, force) in (0..3).flat_map(|motion| [false, true].map(|force| (motion, force))) {
            let mut friction: contact_normal_friction = initialised(contact_normal_friction_init);
            (friction.coefficient, friction.motion) = (0.3, motion);
            (friction.creepage, friction.force) = ([-0.003, 0.001], [1e-3, 0.0]);
            friction.prescribed = [i32::from(force); 2];
            scene.shear_modulus = moduli;
            let what = format!("{moduli:?} {motion} {force}");
            let without = bytes_of(&contact_normal_scene { friction: null(), ..scene }, &what);
            let with = bytes_of(&contact_normal_scene { friction: &friction, ..scene }, &what);
            let [reported, held] = [0, 1].map(|i| with[i] - without[i]);
            // Memory blocks may be larger than requested, and the report does not count the reserved room of lists: hence 10 %.
            assert!((reported / held - 1.0).abs() <= 0.1, "{what}: {reported} bytes reported, {held} held");
        }
    }
}

/// `bytes` of a report count the directions of GMRES, which solves scenes with coefficients that are not symmetric.
#[test]
fn reported_bytes_count_gmres() {
    let _alone = alone();
    let (m, mut h) = (96, Vec::new());
    let scene = scene(m, &mut h);
    // Coefficients of a half-space, roughly, that fall with the distance. To one side they are larger by a hundredth.
    let coefficient = |k: usize, slope: f64| {
        let [x, y] = [k % (2 * m), k / (2 * m)].map(|place| place as f64 - m as f64);
        (1.0 + slope * x / m as f64) / (0.3 + x.hypot(y)) / m as f64
    };
    let [symmetric, leaning] =
        [0.0, 0.01].map(|slope| -> Vec<f64> { (0..4 * m * m).map(|k| coefficient(k, slope)).collect() });
    let [symmetric, leaning] = [&symmetric, &leaning].map(|values| {
        let mut influence: contact_normal_influence = initialised(contact_normal_influence_init);
        (influence.cx, influence.cy, influence.coefficients) = (m as i32, m as i32, values.as_ptr());
        let [reported, _] = bytes_of(&contact_normal_scene { influence: &influence, ..scene }, "own coefficients");
        reported
    });
    let more = leaning - symmetric;
    // 41 directions on more than a tenth of the elements.
    assert!(more > 41.0 * 8.0 * 0.1 * (m * m) as f64, "{more} bytes more");
}
