//! Calls of the C ABI with friction.

use std::ptr::{null, null_mut};

use contact_normal::ffi::*;

use crate::call::{bare_scene, cancel, last_error, Canceller, SENTINEL};
use crate::friction_case::{Case, Place, Slide, Stop};
use crate::friction_found::Found;
use crate::init::initialised;

fn scene(place: &Place) -> contact_normal_scene {
    bare_scene(&place.grid, &place.h, (place.shear_modulus, place.poisson_ratio), place.load)
}

/// `continues`: from what the handle holds.
fn friction(slide: &Slide, continues: bool) -> contact_normal_friction {
    let mut friction = initialised(contact_normal_friction_init);
    if slide.uniform {
        friction.coefficient = slide.mu[0];
    } else {
        friction.coefficients = slide.mu.as_ptr();
    }
    (friction.motion, friction.prescribed) = (slide.motion, slide.prescribed);
    (friction.creepage, friction.force) = (slide.amount, slide.amount);
    (friction.spin, friction.spin_centre) = (slide.spin, slide.spin_centre);
    (friction.rolling_distance, friction.rolling_direction) = (slide.distance, slide.direction);
    let pointers = |arrays: &Option<[Vec<f64>; 2]>| {
        arrays.as_ref().map_or([null(); 2], |arrays| [arrays[0].as_ptr(), arrays[1].as_ptr()])
    };
    friction.rigid_slip = pointers(&slide.rigid);
    (friction.continues, friction.sensitivities) = (i32::from(continues), i32::from(slide.sensitivities));
    if !continues {
        friction.previous_traction = pointers(&slide.previous);
    }
    friction
}

fn options(stop: &Stop, canceller: &mut Canceller) -> contact_normal_options {
    let mut options = initialised(contact_normal_options_init);
    (options.tolerance, options.precision, options.threads) = (stop.tolerance, stop.precision, stop.threads);
    options.max_cycles = stop.max_cycles;
    if let Some(at) = stop.cancel_at {
        *canceller = Canceller { calls: 0, at };
        options.progress = Some(cancel);
        options.user = (&raw mut *canceller).cast();
    }
    options
}

/// Calls with outputs full of sentinels.
fn run(n: usize, call: impl FnOnce(*mut contact_normal_fields, *mut contact_normal_report) -> i32) -> Found {
    let mut numbers = vec![vec![SENTINEL; n]; 6];
    let mut adhesion = vec![-77; n];
    let mut report = initialised(contact_normal_report_init);
    report.force = SENTINEL;
    let mut fields = initialised(contact_normal_fields_init);
    let at: Vec<*mut f64> = numbers.iter_mut().map(|values| values.as_mut_ptr()).collect();
    (fields.pressure, fields.displacement) = (at[0], at[1]);
    (fields.traction, fields.slip, fields.adhesion) = ([at[2], at[3]], [at[4], at[5]], adhesion.as_mut_ptr());
    let status = call(&mut fields, &mut report);
    let written = numbers.iter().flatten().any(|value| value.to_bits() != SENTINEL.to_bits())
        || adhesion.iter().any(|&a| a != -77)
        || report.force.to_bits() != SENTINEL.to_bits();
    let message = if status == CONTACT_NORMAL_OK { String::new() } else { last_error() };
    let pairs = |x: usize| numbers[x].iter().zip(&numbers[x + 1]).map(|(x, y)| [*x, *y]).collect();
    let (q, slip) = (pairs(2), pairs(4));
    let (p, u) = (numbers[0].clone(), numbers[1].clone());
    Found { status, message, p, u, q, slip, adhesion, report, written }
}

/// The same without friction.
pub fn frictionless(place: &Place, stop: &Stop) -> Found {
    let mut canceller = Canceller { calls: 0, at: 0 };
    let (scene, options) = (scene(place), options(stop, &mut canceller));
    run(place.grid.len(), |fields, report| {
        // SAFETY: structs with the arrays that they declare.
        unsafe { contact_normal_solve(&scene, &options, fields, report) }
    })
}

/// Solves a case: once on its own, or twice with a handle, from what it holds then.
pub fn call(case: &Case, twice: bool) -> Vec<Found> {
    let n = case.place.grid.len();
    let mut canceller = Canceller { calls: 0, at: 0 };
    let (mut scene, first) = (scene(&case.place), friction(&case.slide, false));
    scene.friction = &first;
    let options = options(&case.stop, &mut canceller);
    if !twice {
        // SAFETY: structs with the arrays that they declare.
        return vec![run(n, |fields, report| unsafe { contact_normal_solve(&scene, &options, fields, report) })];
    }
    let mut handle = null_mut();
    // SAFETY: as above.
    let status = unsafe { contact_normal_solver_new(&scene, &options, &mut handle) };
    if status != CONTACT_NORMAL_OK {
        return vec![run(n, |_, _| status)];
    }
    // SAFETY: as above, and a handle that no one else uses.
    let found =
        run(n, |fields, report| unsafe { contact_normal_solver_solve(handle, &scene, &options, fields, report) });
    if found.status < 0 {
        // SAFETY: made above.
        unsafe { contact_normal_solver_free(handle) };
        return vec![found];
    }
    let continued = friction(&case.slide, true);
    scene.friction = &continued;
    // SAFETY: as above.
    let next =
        run(n, |fields, report| unsafe { contact_normal_solver_solve(handle, &scene, &options, fields, report) });
    // SAFETY: made above.
    unsafe { contact_normal_solver_free(handle) };
    vec![found, next]
}
