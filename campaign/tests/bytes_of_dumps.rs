//! Reads dumps with changed bytes. Nothing is read beyond the file, and every call returns a status. fuzz/ has the same target for cargo-fuzz.

use std::ffi::CString;

use campaign::bytes;
use campaign::random::Random;
use contact_normal::ffi::*;

/// A dump of a scene with friction, a layer and a limit.
fn file() -> Vec<u8> {
    let path = std::env::temp_dir().join(format!("contact_normal_bytes_{}", std::process::id()));
    let path_text = CString::new(path.to_str().expect("text")).expect("no 0 in it");
    let h: Vec<f64> =
        (0..48).map(|i| 0.01 * f64::from(i % 8 - 3).powi(2) + 0.02 * f64::from(i / 8 - 2).powi(2)).collect();
    let each: Vec<f64> = (0..48).map(|i| 0.1 + 0.01 * f64::from(i)).collect();
    let layer = contact_normal_layer { compliances: each.as_ptr(), ..Default::default() };
    let friction = contact_normal_friction { coefficients: each.as_ptr(), creepage: [0.01, 0.0], ..Default::default() };
    let scene = contact_normal_scene {
        mx: 8,
        my: 6,
        dx: 0.5,
        dy: 0.5,
        undeformed_distance: h.as_ptr(),
        shear_modulus: [1.0; 2],
        poisson_ratio: [0.28; 2],
        approach: 0.05,
        layer: &layer,
        friction: &friction,
        ..Default::default()
    };
    let options =
        contact_normal_options { max_cycles: 1, tolerance: 1e-18, dump: path_text.as_ptr(), ..Default::default() };
    let mut report = contact_normal_report::default();
    // SAFETY: structs with the arrays that they declare.
    let status = unsafe { contact_normal_solve(&scene, &options, std::ptr::null_mut(), &mut report) };
    assert!(status > 0, "{status}");
    let bytes = std::fs::read(&path).expect("a dump");
    std::fs::remove_file(&path).expect("a dump");
    bytes
}

#[test]
fn changed_bytes_of_a_dump_do_no_harm() {
    let (file, mut random) = (file(), Random::new(7));
    let (mut made, mut refused) = (0, 0);
    let text = file.windows(6).position(|bytes| bytes == b"\ndata ").expect("the end of the text");
    for k in 0..16000 {
        // In half of the dumps only the text is changed, which is the shorter part.
        let end = if k % 2 == 0 { text } else { file.len() };
        let mut bytes = file.clone();
        for _ in 0..random.integer(1, 3) {
            let at = random.integer(0, end - 1);
            bytes[at] = random.pick(&[b'0', b'1', b'7', b'9', b' ', b'-', b'\n', 0xff]);
        }
        let statuses = bytes::dump(&bytes);
        made += statuses.len();
        refused += statuses.iter().filter(|status| **status < 0).count();
    }
    // Usually about 2000 calls are made, and about 50 are refused.
    assert!(made > 1000 && refused > 20, "{made} made, {refused} refused");
}
