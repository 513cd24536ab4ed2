//! The campaign solves and checks the scene of a dump.

use std::ffi::CString;

use campaign::replay;
use contact_normal::ffi::dump::Dump;
use contact_normal::ffi::*;

#[test]
fn the_scene_of_a_dump_is_solved_and_judged() {
    let path = std::env::temp_dir().join(format!("contact_normal_campaign_{}", std::process::id()));
    let path_text = CString::new(path.to_str().expect("text")).expect("no 0 in it");
    let h: Vec<f64> =
        (0..120).map(|i| 0.01 * f64::from(i % 12 - 5).powi(2) + 0.02 * f64::from(i / 12 - 4).powi(2)).collect();
    let limits: Vec<f64> = (0..120).map(|i| 900.0 + f64::from(i)).collect();
    let limit = contact_normal_pressure_limit { limits: limits.as_ptr(), ..Default::default() };
    let layer = contact_normal_layer { compliance: 1e-6, ..Default::default() };
    let scene = contact_normal_scene {
        mx: 12,
        my: 10,
        dx: 0.5,
        dy: 0.5,
        undeformed_distance: h.as_ptr(),
        shear_modulus: [82000.0; 2],
        poisson_ratio: [0.28; 2],
        approach: 0.05,
        pressure_limit: &limit,
        layer: &layer,
        ..Default::default()
    };
    let options =
        contact_normal_options { max_cycles: 1, tolerance: 1e-12, dump: path_text.as_ptr(), ..Default::default() };
    // SAFETY: structs with the arrays that they declare.
    let status = unsafe { contact_normal_solve(&scene, &options, std::ptr::null_mut(), std::ptr::null_mut()) };
    assert!(status > 0, "{status}");
    let bytes = std::fs::read(&path).expect("a dump");
    std::fs::remove_file(&path).expect("a dump");
    let run = replay::run(&Dump::read(&bytes).expect("a dump that can be read")).expect("a case");
    assert_eq!(run.statuses, [status]);
    assert!(run.verdict.failures.is_empty(), "{:?}", run.verdict.failures);
    // The scene that is solved is the given one.
    assert_eq!((run.case.h.len(), run.case.h[17].to_bits()), (120, h[17].to_bits()));
    assert_eq!(run.case.effects.name(), "layer + limit per element");
}
