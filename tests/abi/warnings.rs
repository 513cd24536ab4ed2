//! The warnings of a report. A report may have warnings although the status is OK.

use std::ptr::null;

use crate::call::last_error;
use contact_normal::ffi::*;

const M: usize = 32;
const D: f64 = 0.1;

/// The distances of a ball with a spike of this height in its middle.
fn ball(spike: f64) -> Vec<f64> {
    let at = |k: usize| (k as f64 - 15.5) * D;
    let mut h: Vec<f64> = (0..M * M).map(|i| 0.02 * (at(i % M).powi(2) + at(i / M).powi(2))).collect();
    h[M / 2 * M + M / 2] -= spike;
    h
}

/// Solves by force, and asserts the status OK. Returns the report and the message. `change` adds effects and options.
fn solved(
    h: &[f64],
    force: f64,
    change: impl Fn(&mut contact_normal_scene, &mut contact_normal_options),
) -> (contact_normal_report, String) {
    let mut scene = contact_normal_scene {
        undeformed_distance: h.as_ptr(),
        load: CONTACT_NORMAL_PRESCRIBED_FORCE,
        force,
        ..Default::default()
    };
    (scene.mx, scene.my, scene.dx, scene.dy) = (M as i32, (h.len() / M) as i32, D, D);
    (scene.shear_modulus, scene.poisson_ratio) = ([82000.0; 2], [0.28; 2]);
    let (mut options, mut report) = (contact_normal_options::default(), contact_normal_report::default());
    change(&mut scene, &mut options);
    // SAFETY: structs with their arrays.
    let status = unsafe { contact_normal_solve(&scene, &options, std::ptr::null_mut(), &mut report) };
    assert_eq!(status, CONTACT_NORMAL_OK, "{}", last_error());
    (report, if report.warnings == 0 { String::new() } else { last_error() })
}

fn plain(_: &mut contact_normal_scene, _: &mut contact_normal_options) {}

#[test]
fn a_contact_that_is_resolved_has_none() {
    let (report, _) = solved(&ball(0.0), 2000.0, plain);
    assert!(report.normal.contact_count > 50 && report.accuracy.error_force >= 0.0);
    assert_eq!((report.warnings, report.normal.edge_count), (0, 0));
}

/// A batch whose problems are all OK has the message of their warnings. An earlier message is replaced.
#[test]
fn a_batch_says_what_its_problems_warn_of() {
    let surface = ball(0.0);
    let mut scene = contact_normal_scene {
        undeformed_distance: surface.as_ptr(),
        load: CONTACT_NORMAL_PRESCRIBED_FORCE,
        force: 2000.0,
        ..Default::default()
    };
    (scene.mx, scene.my, scene.dx, scene.dy) = (M as i32, M as i32, D, D);
    (scene.shear_modulus, scene.poisson_ratio) = ([82000.0; 2], [0.28; 2]);
    let scenes = [scene, contact_normal_scene { force: 1e6, ..scene }];
    let mut reports = [contact_normal_report::default(); 2];
    let mut solver = std::ptr::null_mut();
    // SAFETY: structs with their arrays, and a handle of ours.
    unsafe {
        assert!(contact_normal_keep(-1) < 0 && !last_error().contains("border"));
        assert_eq!(contact_normal_solver_new(&scene, null(), &mut solver), CONTACT_NORMAL_OK);
        let (fields, statuses) = (std::ptr::null_mut(), std::ptr::null_mut());
        let status = contact_normal_solver_solve_batch(
            solver,
            2,
            scenes.as_ptr(),
            null(),
            fields,
            reports.as_mut_ptr(),
            statuses,
        );
        assert_eq!(status, CONTACT_NORMAL_OK, "{}", last_error());
        contact_normal_solver_free(solver);
    }
    assert_eq!(reports[0].warnings, 0);
    assert_ne!(reports[1].warnings & CONTACT_NORMAL_WARNING_BORDER, 0);
    assert!(last_error().contains("reaches the border"), "{}", last_error());
}

#[test]
fn one_element_in_contact() {
    let (report, message) = solved(&ball(1e-3), 1e-3, plain);
    assert_eq!(report.normal.contact_count, 1);
    assert_ne!(report.warnings & CONTACT_NORMAL_WARNING_ONE_ELEMENT, 0);
    assert_ne!(report.warnings & CONTACT_NORMAL_WARNING_ERROR_UNKNOWN, 0);
    assert_eq!(report.warnings & (CONTACT_NORMAL_WARNING_SPIKE | CONTACT_NORMAL_WARNING_BORDER), 0);
    assert!(message.contains("one element is in contact") && message.contains("error is not known"), "{message}");
}

#[test]
fn contact_at_the_border_where_nothing_repeats_itself() {
    let (report, message) = solved(&ball(0.0), 1e6, plain);
    assert!(report.normal.edge_count > 0);
    assert_ne!(report.warnings & CONTACT_NORMAL_WARNING_BORDER, 0);
    assert!(message.contains("reaches the border"), "{message}");
    // A line contact across the grid reaches both borders in x, and none in y. A period in x joins the borders in x.
    let line: Vec<f64> = (0..M * M).map(|i| 0.02 * ((i / M) as f64 * D - 15.5 * D).powi(2)).collect();
    let mut period = contact_normal_period { x: 1, ..Default::default() };
    let border = |period: &contact_normal_period| {
        let found = solved(&line, 100.0, |scene, _| scene.period = period).0;
        assert!(found.normal.edge_count > 0);
        found.warnings & CONTACT_NORMAL_WARNING_BORDER != 0
    };
    assert!(!border(&period));
    (period.x, period.y) = (0, 1);
    assert!(border(&period));
    assert_ne!(solved(&line, 100.0, |scene, _| scene.period = null()).0.warnings & CONTACT_NORMAL_WARNING_BORDER, 0);
    // A single row of elements is a line contact, whose row does not count as a border.
    let row: Vec<f64> = ball(0.0)[..M].to_vec();
    assert_eq!(solved(&row, 1.0, plain).0.warnings & CONTACT_NORMAL_WARNING_BORDER, 0);
}

#[test]
fn one_element_that_carries_more_than_half() {
    let mut seen = [false; 2];
    for spike in [0.0, 1e-4, 1e-3, 3e-3, 6e-3, 8e-3, 1e-2, 1.2e-2, 1.5e-2] {
        let (report, message) = solved(&ball(spike), 100.0, plain);
        let carries = report.normal.contact_count > 1 && report.normal.max_pressure * D * D > 0.5 * report.normal.force;
        assert_eq!(report.warnings & CONTACT_NORMAL_WARNING_SPIKE != 0, carries, "{spike}");
        assert_eq!(message.contains("more than half of the force"), carries, "{message}");
        seen[usize::from(carries)] = true;
    }
    assert_eq!(seen, [true; 2]);
}

/// On a fixed area elements may pull, so that the total force may be less than that of one pressing element. This does not count as a spike.
#[test]
fn an_area_that_pulls_has_no_spike() {
    let surface = ball(0.0);
    let mut contact: Vec<i32> = surface.iter().map(|h| i32::from(*h < 0.02)).collect();
    let (mut p, mut report) = (vec![0.0; M * M], contact_normal_report::default());
    let scene = contact_normal_scene {
        undeformed_distance: surface.as_ptr(),
        load: CONTACT_NORMAL_PRESCRIBED_APPROACH,
        approach: 0.008,
        mx: M as i32,
        my: M as i32,
        dx: D,
        dy: D,
        shear_modulus: [82000.0; 2],
        poisson_ratio: [0.28; 2],
        ..Default::default()
    };
    let options = contact_normal_options { active_set: CONTACT_NORMAL_ACTIVE_SET_FIXED, ..Default::default() };
    let mut fields =
        contact_normal_fields { pressure: p.as_mut_ptr(), contact: contact.as_mut_ptr(), ..Default::default() };
    // SAFETY: structs with their arrays.
    let status = unsafe { contact_normal_solve(&scene, &options, &mut fields, &mut report) };
    assert_eq!(status, CONTACT_NORMAL_OK, "{}", last_error());
    let largest = report.normal.max_pressure * D * D;
    assert!(
        report.normal.min_pressure < 0.0 && largest > 0.5 * report.normal.force,
        "{largest} {}",
        report.normal.force
    );
    assert_eq!(report.warnings & CONTACT_NORMAL_WARNING_SPIKE, 0);
}

/// Elements at their limit are in contact, so that they count at the border, too.
#[test]
fn elements_at_their_limit_reach_the_border() {
    // A ridge along the first column, which is at its limit.
    let h: Vec<f64> = (0..M * M).map(|i| 0.02 * (i % M) as f64).collect();
    let limit = contact_normal_pressure_limit { limit: 10.0, ..Default::default() };
    let (report, message) = solved(&h, 0.0, |scene, _| {
        scene.pressure_limit = &limit;
        scene.load = CONTACT_NORMAL_PRESCRIBED_APPROACH;
        scene.approach = 0.001;
    });
    assert!(report.normal.edge_count > 0);
    assert_ne!(report.warnings & CONTACT_NORMAL_WARNING_BORDER, 0, "{message}");
    assert_eq!(report.normal.contact_count, M as i64);
}

/// A search for an accuracy begins on few elements, but its warnings are those of its last grid. With a pressure limit several grids give an estimate
/// of the error, so that the error is known.
#[test]
fn a_search_warns_of_its_last_grid() {
    let h: Vec<f64> = (0..64)
        .map(|i| 0.02 * 0.16 * ((i % 8) as f64 - 3.5).powi(2) + 0.02 * 0.16 * ((i / 8) as f64 - 3.5).powi(2))
        .collect();
    let limit = contact_normal_pressure_limit { limit: 900.0, ..Default::default() };
    for limit in [null(), &raw const limit] {
        let mut scene = contact_normal_scene {
            undeformed_distance: h.as_ptr(),
            load: CONTACT_NORMAL_PRESCRIBED_FORCE,
            force: 50.0,
            pressure_limit: limit,
            ..Default::default()
        };
        (scene.mx, scene.my, scene.dx, scene.dy) = (8, 8, 0.4, 0.4);
        (scene.shear_modulus, scene.poisson_ratio) = ([82000.0; 2], [0.28; 2]);
        let mut accuracy = contact_normal_accuracy { target: 0.02, ..Default::default() };
        let mut report = contact_normal_report::default();
        // SAFETY: structs with their arrays.
        let status = unsafe {
            let no_solver = std::ptr::null_mut();
            contact_normal_solve_to_accuracy(&scene, null(), &mut accuracy, no_solver, &mut report)
        };
        assert_eq!(status, CONTACT_NORMAL_OK, "{}", last_error());
        assert!(accuracy.mx > 32 && report.normal.contact_count > 50);
        assert_eq!(report.warnings, 0, "{}", limit.is_null());
    }
}
