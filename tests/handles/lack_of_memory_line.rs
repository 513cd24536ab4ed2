//! Friction on long lines, whose rows or columns are as large as the grid. Any lack of memory, also in plans of transforms, becomes a status.

use std::ptr::{null, null_mut};

use super::alone;
use super::call::initialised;
use super::limited_memory::{self, release};
use contact_normal::ffi::*;

/// The number of elements of a line.
const N: usize = 3200;
/// The least size of an allocation that counts: three quarters of a number per element. The arrays of coarser grids are smaller.
const LARGE: usize = 8 * N * 3 / 4;

/// Solves for elastic cylinders along x or along y: the tangential problem if pressures are given, otherwise both problems. Returns the status.
fn solve(sides: (usize, usize), modulus: f64, motion: i32, pressures: Option<&[f64]>) -> i32 {
    solve_by(CONTACT_NORMAL_METHOD_AUTO, sides, modulus, motion, pressures)
}

/// [`solve`] by a given method.
fn solve_by(method: i32, (mx, my): (usize, usize), modulus: f64, motion: i32, pressures: Option<&[f64]>) -> i32 {
    let mut scene = initialised(contact_normal_scene_init);
    let mut friction = initialised(contact_normal_friction_init);
    let h: Vec<f64> = (0..N).map(|i| ((i as f64 + 0.5) / N as f64 - 0.5).powi(2)).collect();
    (scene.mx, scene.my, scene.undeformed_distance) = (mx as i32, my as i32, h.as_ptr());
    (scene.dx, scene.dy) = if mx > 1 { (1.0 / N as f64, 1.0) } else { (1.0, 1.0 / N as f64) };
    (scene.shear_modulus, scene.poisson_ratio) = ([1.0, modulus], [0.3; 2]);
    (scene.load, scene.force) = (CONTACT_NORMAL_PRESCRIBED_FORCE, 0.01);
    friction.coefficient = 0.3;
    (friction.motion, friction.creepage, friction.sensitivities) = (motion, [-0.001, 1e-4], 1);
    friction.rolling_direction = if mx > 1 { 0.0 } else { std::f64::consts::FRAC_PI_2 };
    friction.rolling_distance = 1.0 / N as f64;
    scene.friction = if method == CONTACT_NORMAL_METHOD_AUTO { &friction } else { null() };
    let mut options = initialised(contact_normal_options_init);
    (options.method, options.tolerance, options.threads) = (method, 1e-3, 1);
    // SAFETY (both): structs with their arrays.
    match pressures {
        Some(p) => unsafe {
            let (p, report) = (p.as_ptr(), null_mut());
            contact_normal_solve_tangential(null_mut(), &scene, p, &options, 1, null(), null_mut(), report)
        },
        None => unsafe { contact_normal_solve(&scene, &options, null_mut(), null_mut()) },
    }
}

/// Solves with more and more memory until a solve succeeds, each time on a new thread, which has no plans of transforms. Returns the number of
/// failures.
fn with_more_and_more(what: &str, run: impl Fn() -> i32 + Sync) -> usize {
    let mut lacks = 0;
    // Memory grows in steps that are small relative to the largest array, which has some 100 numbers per element.
    let mut room = 16 * N;
    loop {
        release();
        let status = std::thread::scope(|scope| {
            scope.spawn(|| limited_memory::within(LARGE, room as i64, &run)).join().expect("a status")
        });
        if status != CONTACT_NORMAL_OUT_OF_MEMORY {
            assert_eq!(status, CONTACT_NORMAL_OK, "{what}, room for {} bytes an element", room / N);
            return lacks;
        }
        lacks += 1;
        room += (room / 14).max(8 * N);
    }
}

#[test]
fn friction_on_a_line_without_memory_is_refused() {
    let _alone = alone();
    let pressure: Vec<f64> = (0..N)
        .map(|i| 0.1 * (1.0 - ((i as f64 + 0.5) / (0.3 * N as f64) - 1.0 / 0.6).powi(2)).max(0.0).sqrt())
        .collect();
    for sides in [(N, 1), (1, N)] {
        for modulus in [1.0, 3.0] {
            for motion in 0..3 {
                let what = format!("{sides:?}, modulus {modulus}, motion {motion}");
                let lacks = with_more_and_more(&what, || solve(sides, modulus, motion, Some(&pressure)));
                assert!(lacks > 20, "{what}: {lacks}");
            }
        }
    }
}

/// The normal problem of the same lines, and both problems in turns. A lack of memory becomes a status here, too.
#[test]
fn a_line_that_rolls_without_memory_is_refused() {
    let _alone = alone();
    for sides in [(N, 1), (1, N)] {
        for (modulus, motion) in [(1.0, 0), (3.0, 1), (1.0, 2)] {
            let what = format!("{sides:?}, modulus {modulus}, motion {motion}");
            let lacks = with_more_and_more(&what, || solve(sides, modulus, motion, None));
            assert!(lacks > 20, "{what}: {lacks}");
        }
    }
}

#[test]
fn a_line_without_memory_is_refused_by_each_method() {
    let _alone = alone();
    for sides in [(N, 1), (1, N)] {
        for method in CONTACT_NORMAL_METHOD_NORM..=CONTACT_NORMAL_METHOD_PROJECTED_CG {
            let what = format!("{sides:?}, method {method}");
            let lacks = with_more_and_more(&what, || solve_by(method, sides, 1.0, 0, None));
            assert!(lacks > 10, "{what}: {lacks}");
        }
    }
}
