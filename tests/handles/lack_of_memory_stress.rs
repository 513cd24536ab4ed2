//! Stresses below the surface if memory is lacking: the status is OUT_OF_MEMORY whichever allocation fails, and the next call works.

use std::ptr::null;

use super::alone;
use super::call::initialised;
use super::limited_memory::{self, release, until_enough};
use contact_normal::ffi::*;

/// The number of elements in each direction.
const M: usize = 48;
const N: usize = M * M;
/// The second depth is near the surface, where stresses with periods also need images.
const DEPTHS: [f64; 2] = [2.0, 0.25];
const SENTINEL: f64 = -7.0;

/// Computes von Mises stresses and principal directions, which need all components, into `fields`. Returns the status.
fn stresses(scene: &contact_normal_scene, load: &[f64], fields: &mut [Vec<f64>; 2]) -> i32 {
    fields.iter_mut().for_each(|field| field.fill(SENTINEL));
    let mut outputs = initialised(contact_normal_stress_outputs_init);
    (outputs.von_mises, outputs.directions[0]) = (fields[0].as_mut_ptr(), fields[1].as_mut_ptr());
    let (p, z) = (load.as_ptr(), DEPTHS.as_ptr());
    // SAFETY: arrays as long as the call says.
    unsafe { contact_normal_subsurface_stress(scene, 1, p, p, null(), z, 2, null(), &mut outputs) }
}

#[test]
fn stresses_without_memory_are_refused_and_the_next_call_works() {
    let _alone = alone();
    let load: Vec<f64> = (0..N).map(|i| 1.0 + (i % 7) as f64).collect();
    let both = contact_normal_period { x: 1, y: 1, ..initialised(contact_normal_period_init) };
    for (what, period) in [("free", null()), ("two periods", &raw const both)] {
        let scene = contact_normal_scene {
            mx: M as i32,
            my: M as i32,
            dx: 1.0,
            dy: 1.0,
            shear_modulus: [1.0; 2],
            poisson_ratio: [0.3; 2],
            period,
            ..initialised(contact_normal_scene_init)
        };
        let room = || [vec![SENTINEL; 2 * N], vec![SENTINEL; 6 * N]];
        let (mut expected, mut found) = (room(), room());
        assert_eq!(stresses(&scene, &load, &mut expected), CONTACT_NORMAL_OK, "{what}");
        let failures = until_enough(what, |allowed| {
            let status = limited_memory::with(4 * N, allowed, || stresses(&scene, &load, &mut found));
            let untouched = found.iter().flatten().all(|value| *value == SENTINEL);
            assert!(status == CONTACT_NORMAL_OK || untouched, "{what}: refused, but written");
            status
        });
        // The allocations are those of the transforms of two loads, of the tables of kernels, and of the fields of a depth.
        assert!(failures >= 10, "{what}: {failures} allocations");
        assert!(found == expected, "{what}: other bits after {failures} failures");
    }
}

#[test]
fn stresses_at_points_without_memory_are_refused() {
    let _alone = alone();
    let scene = contact_normal_scene {
        mx: 1,
        my: 1,
        dx: 1.0,
        dy: 1.0,
        shear_modulus: [1.0; 2],
        ..initialised(contact_normal_scene_init)
    };
    let points = vec![[0.5, 0.5, 1.0]; N];
    let mut stress = vec![[SENTINEL; 6]; N];
    let ask = |stress: &mut Vec<[f64; 6]>| {
        // SAFETY: arrays as long as the call says.
        unsafe {
            let (p, to) = ([1.0].as_ptr(), stress.as_mut_ptr().cast());
            contact_normal_stress_at_points(&scene, 1, p, null(), null(), points.as_ptr().cast(), N as i32, null(), to)
        }
    };
    release();
    assert_eq!(limited_memory::with(8 * N, 0, || ask(&mut stress)), CONTACT_NORMAL_OUT_OF_MEMORY);
    assert!(stress.iter().flatten().all(|value| *value == SENTINEL));
    assert_eq!(ask(&mut stress), CONTACT_NORMAL_OK);
    assert!(stress.iter().flatten().all(|value| *value != SENTINEL));
}
