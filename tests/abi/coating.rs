//! Scenes with `contact_normal_coating` that are refused, with messages that name the member; and `contact_normal_coating_compliance`.

use std::ptr::null_mut;

use crate::call::{initialised, last_error, Call, Through};
use contact_normal::ffi::*;

fn coating(thickness: f64, shear_modulus: f64, poisson_ratio: f64) -> contact_normal_coating {
    contact_normal_coating { thickness, shear_modulus, poisson_ratio, ..initialised(contact_normal_coating_init) }
}

#[test]
fn a_coating_is_refused_by_name() {
    let cases = [
        (coating(-1.0, 1e3, 0.3), CONTACT_NORMAL_INVALID_ARGUMENT, "coating[1]->thickness is -1"),
        (coating(f64::INFINITY, 1e3, 0.3), CONTACT_NORMAL_NOT_FINITE, "coating[1]->thickness is inf"),
        (coating(0.1, 0.0, 0.3), CONTACT_NORMAL_INVALID_ARGUMENT, "coating[1]->shear_modulus is 0"),
        (coating(0.1, f64::NAN, 0.3), CONTACT_NORMAL_NOT_FINITE, "coating[1]->shear_modulus is NaN"),
        (coating(0.1, 1e9, 0.3), CONTACT_NORMAL_INVALID_ARGUMENT, "their ratio must be at most 1e4"),
        (coating(0.1, 1e3, 0.6), CONTACT_NORMAL_INVALID_ARGUMENT, "coating[1]->poisson_ratio is 0.6"),
    ];
    for (coating, status, words) in cases {
        let mut call = Call::new();
        call.scene.known.coating[1] = &coating;
        let (got, message) = call.run(Through::Solve, null_mut());
        assert_eq!(got, status, "{words}: {message}");
        assert!(message.contains(words), "\"{message}\" does not say {words}");
    }
    let mut short = coating(0.1, 1e3, 0.3);
    short.struct_size = 24;
    let mut call = Call::new();
    call.scene.known.coating[0] = &short;
    let (got, message) = call.run(Through::Solve, null_mut());
    assert!(got == CONTACT_NORMAL_STRUCT_SIZE && message.contains("scene->coating[0]->struct_size is 24"), "{message}");
}

#[test]
fn pairs_that_are_not_solved_are_refused_by_name() {
    let layer = coating(0.1, 1e3, 0.3);
    type Spoil = fn(&mut Call);
    let spoils: [(Spoil, &str); 4] = [
        (|c| _ = c.use_table(), "influence"),
        (|c| _ = c.use_row_tables(), "row_tables"),
        (|c| c.use_period(1, 0), "a period in one direction"),
        // With a coating on one body only the bodies are unlike, for which friction with coatings is not supported.
        (|c| _ = c.use_friction(), "friction and coating are both given, and coating[1] is none"),
    ];
    for (spoil, words) in spoils {
        let mut call = Call::new();
        call.scene.known.coating[0] = &layer;
        call.scene.known.shear_modulus = [2e3; 2];
        spoil(&mut call);
        let before = call.outputs();
        let (got, message) = call.run(Through::Solve, null_mut());
        assert!(got == CONTACT_NORMAL_UNSUPPORTED && message.contains(words), "{got} {message}");
        assert!(message.contains("coating"), "{message}");
        assert!(call.outputs() == before, "{words}: refused, but written");
    }
    // Friction is supported if both bodies have the same coating.
    let mut call = Call::new();
    call.scene.known.coating = [&raw const layer; 2];
    call.scene.known.shear_modulus = [2e3; 2];
    call.use_friction();
    let (got, message) = call.run(Through::Solve, null_mut());
    assert!(got == CONTACT_NORMAL_OK, "{got} {message}");
}

#[test]
fn the_compliance_of_a_wave_is_that_of_one_material_where_the_layer_is() {
    let ask = |coating: &contact_normal_coating, k: f64| {
        let mut compliance = f64::NAN;
        // SAFETY: a whole struct, and room for a value.
        let status = unsafe { contact_normal_coating_compliance(coating, 500.0, 0.25, k, &mut compliance) };
        (status, compliance)
    };
    let close = |found: (i32, f64), exact: f64| {
        assert!(found.0 == CONTACT_NORMAL_OK && (found.1 / exact - 1.0).abs() <= 1e-12, "{found:?} for {exact}");
    };
    close(ask(&coating(0.0, 1e3, 0.3), 2.0), 0.75 / (500.0 * 2.0));
    close(ask(&coating(1.0, 500.0, 0.25), 2.0), 0.75 / (500.0 * 2.0));
    close(ask(&coating(1.0, 1e3, 0.3), 100.0), 0.7 / (1e3 * 100.0));
    close(ask(&coating(1.0, 1e3, 0.3), 1e-15), 0.75 / (500.0 * 1e-15));
    assert_eq!(ask(&coating(1.0, 1e3, 0.3), 0.0).0, CONTACT_NORMAL_INVALID_ARGUMENT);
    assert_eq!(ask(&coating(1.0, 1e3, 0.3), f64::NAN).0, CONTACT_NORMAL_NOT_FINITE);
    // The layer is thick relative to the wavelength. k^2 may overflow.
    for k in [1e150, 1e155, 1e200] {
        close(ask(&coating(1.0, 1.0, 0.3), k), 0.7 / k);
    }
    // A compliance that overflows is refused.
    assert_eq!(ask(&coating(1.0, 1e-300, 0.3), 1e-300).0, CONTACT_NORMAL_NOT_FINITE);
    // SAFETY: NULL is allowed, and refused.
    let status = unsafe { contact_normal_coating_compliance(&coating(1.0, 1e3, 0.3), 500.0, 0.25, 1.0, null_mut()) };
    assert_eq!((status, last_error().contains("compliance")), (CONTACT_NORMAL_NULL_POINTER, true));
}

#[test]
fn a_rigid_body_below_a_coating_is_solved_and_two_rigid_surfaces_are_refused() {
    let layer = coating(0.1, 1e3, 0.3);
    let none = coating(0.0, 1e3, 0.3);
    for (moduli, coating, status) in [
        ([f64::INFINITY; 2], &layer, CONTACT_NORMAL_OK),
        ([f64::INFINITY, 1e3], &layer, CONTACT_NORMAL_OK),
        ([f64::INFINITY; 2], &none, CONTACT_NORMAL_INVALID_ARGUMENT),
    ] {
        let mut call = Call::new();
        (call.scene.known.shear_modulus, call.scene.known.coating[0]) = (moduli, coating);
        for through in [Through::Solve, Through::SolverNew] {
            let (got, message) = call.run(through, null_mut());
            assert_eq!(got, status, "{message}");
            assert!(got == CONTACT_NORMAL_OK || message.contains("shear_modulus is infinite for both"), "{message}");
        }
    }
    let mut call = Call::new();
    call.scene.known.shear_modulus = [f64::NEG_INFINITY, 1e3];
    call.scene.known.coating[0] = &layer;
    let (got, message) = call.run(Through::Solve, null_mut());
    assert!(got == CONTACT_NORMAL_INVALID_ARGUMENT && message.contains("shear_modulus[0] is -inf"), "{message}");
}

#[test]
fn the_compliance_on_a_rigid_body_is_that_of_the_layer() {
    let ask = |nu: f64, k: f64| {
        let (layer, mut compliance) = (coating(0.5, 1e3, nu), f64::NAN);
        // SAFETY: a whole struct, and room for a value.
        let status = unsafe { contact_normal_coating_compliance(&layer, f64::INFINITY, 0.0, k, &mut compliance) };
        assert_eq!(status, CONTACT_NORMAL_OK);
        compliance
    };
    // Long waves have the compliance t/M with M = 2 G (1 - nu)/(1 - 2 nu), and k^2 t^3/(3 G) if nu = 1/2. The relative error is of order (k t)^2.
    assert!((ask(0.3, 1e-6) / (0.5 * 0.4 / (2e3 * 0.7)) - 1.0).abs() <= 1e-11);
    assert!((ask(0.5, 1e-6) / (1e-12 * 0.125 / 3e3) - 1.0).abs() <= 1e-11);
}
