//! `contact_normal_flash_temperature`: speeds out of range, too many threads and overlapping memory are refused; a flux that cools is shared equally.

use crate::call::{initialised, last_error};
use contact_normal::ffi::*;

const N: usize = 16;

/// The input for `mx` by `my` elements with this flux.
fn of((mx, my): (i32, i32), flux: &[f64]) -> contact_normal_heat {
    let mut heat: contact_normal_heat = initialised(contact_normal_heat_init);
    (heat.mx, heat.my, heat.dx, heat.dy) = (mx, my, 0.1, 0.1);
    (heat.heat_flux, heat.conductivity, heat.diffusivity) = (flux.as_ptr(), [1.0; 2], [1.0; 2]);
    heat
}

fn run(heat: &contact_normal_heat) -> (i32, contact_normal_flash) {
    let mut flash: contact_normal_flash = initialised(contact_normal_flash_init);
    // SAFETY: structs and arrays of this test.
    let status = unsafe { contact_normal_flash_temperature(heat, std::ptr::null_mut(), &mut flash) };
    (status, flash)
}

/// Speeds whose quotient by the diffusivity overflows are refused.
#[test]
fn speeds_beyond_the_range_of_numbers_are_refused() {
    let flux = [1.0; N];
    for (speed, diffusivity) in [(1e300, 1e-9), (-1e305, 1e-5), (1e308, 1e-300)] {
        let heat = contact_normal_heat { speed: [speed, 0.0], diffusivity: [diffusivity, 1.0], ..of((4, 4), &flux) };
        let (status, message) = (run(&heat).0, last_error());
        assert!(status == CONTACT_NORMAL_NOT_FINITE && message.contains("speed[0]"), "{status} {message}");
    }
}

#[test]
fn threads_have_the_limit_of_all_calls() {
    let flux = [1.0; N];
    let heat = contact_normal_heat { threads: 1025, ..of((4, 4), &flux) };
    let (status, message) = (run(&heat).0, last_error());
    assert!(status == CONTACT_NORMAL_INVALID_ARGUMENT && message.contains("1024"), "{status} {message}");
    assert_eq!(run(&contact_normal_heat { threads: 1024, ..of((4, 4), &flux) }).0, CONTACT_NORMAL_OK);
}

/// A negative flux warms no element, so that each body gets one half. Round-off of 1e-17 upstream must not count as warming.
#[test]
fn a_flux_that_cools_is_shared_equally() {
    let cools = |i: usize| (8..16).contains(&(i % 32)) && (4..12).contains(&(i / 32));
    let flux: Vec<f64> = (0..32 * 16).map(|i| if cools(i) { -1.0 } else { 0.0 }).collect();
    for speed in [[0.0, 0.0], [1.0, 2.0], [100.0, 50.0], [-1000.0, 3.0]] {
        let (status, flash) =
            run(&contact_normal_heat { speed, conductivity: [1.0, 2.0], dx: 1.0, dy: 1.0, ..of((32, 16), &flux) });
        assert_eq!((status, flash.share), (CONTACT_NORMAL_OK, 0.5), "{speed:?}");
    }
}

#[test]
fn results_that_overlap_with_a_struct_are_refused() {
    let mut heat: contact_normal_heat = initialised(contact_normal_heat_init);
    let mut flash: contact_normal_flash = initialised(contact_normal_flash_init);
    let flux = [1.0; N];
    (heat.mx, heat.my, heat.dx, heat.dy) = (4, 4, 0.1, 0.1);
    (heat.heat_flux, heat.conductivity, heat.diffusivity) = (flux.as_ptr(), [1.0; 2], [1.0; 2]);
    let mut temperature = vec![7.0; 2 * N];
    let mut at_heat = [heat; 3];
    let own: *mut contact_normal_flash = &raw mut flash;
    let cases: [(*const contact_normal_heat, *mut f64, *mut contact_normal_flash, &str); 3] = [
        (&raw const heat, temperature.as_mut_ptr(), own, ""),
        (&raw const at_heat[0], (&raw mut at_heat[0]).cast(), own, "heat"),
        (&raw const heat, own.cast(), own, "flash"),
    ];
    for (heat, to, flash, name) in cases {
        // SAFETY: structs and arrays of this test; room for 32 values, or refused.
        let status = unsafe { contact_normal_flash_temperature(heat, to, flash) };
        if name.is_empty() {
            assert_eq!(status, CONTACT_NORMAL_OK);
            continue;
        }
        let message = last_error();
        assert!(status == CONTACT_NORMAL_INVALID_ARGUMENT && message.contains("overlap"), "{name}: {status} {message}");
        assert!(message.contains(name), "{message}");
    }
    assert!(temperature.iter().all(|rise| *rise > 0.0 && *rise < 7.0), "{temperature:?}");
}
