//! `contact_normal_coating`, and the compliance of a coated body.

use super::arguments::GivenEffect;
use super::guard::guard;
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::structs::{self, versioned};
use crate::error::{positive, require};
use crate::grid::Grid;
use crate::scene::{Bodies, Coating, CoatingLayer, Load, Plain};

/// Effect: a coating, an elastic layer bonded to a body. `shear_modulus` and `poisson_ratio` of the scene are then those of the body below,
/// which may be rigid (`shear_modulus` +infinity).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_coating {
    /// Set by `contact_normal_coating_init`.
    pub struct_size: i64,
    /// The thickness of the coating, a length >= 0; default 0: no coating.
    pub thickness: f64,
    /// The shear modulus G of the coating, a pressure > 0, at most 1e4 times that of the body; default 0: to be set.
    pub shear_modulus: f64,
    /// The Poisson ratio nu of the coating, in (-1, 0.5]; default 0.
    pub poisson_ratio: f64,
}

versioned! { contact_normal_coating, contact_normal_coating_init, 32 }

/// Computes the `compliance` of a coated body under a pressure wave: the amplitude of the displacement divided by the amplitude of the
/// pressure. `shear_modulus` (+infinity: rigid) and `poisson_ratio` are those of the body below the coating.
/// `wave_number` is k = 2 pi over the wavelength, > 0. The function is for comparisons with other formulas; without a coating the compliance is
/// `(1 - nu)/(G k)`. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_coating_compliance(
    coating: *const contact_normal_coating,
    shear_modulus: f64,
    poisson_ratio: f64,
    wave_number: f64,
    compliance: *mut f64,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a struct that declares its size.
        let given = unsafe { structs::read(coating, "coating")? };
        if compliance.is_null() {
            return Err(Refusal::null("compliance"));
        }
        positive("wave_number", wave_number)?;
        let bodies = Bodies { shear_modulus: [shear_modulus, f64::INFINITY], poisson_ratio: [poisson_ratio, 0.0] };
        let coating = Coating { layers: [Some(given.translate()), None] };
        let grid = Grid { mx: 1, my: 1, dx: 1.0, dy: 1.0 };
        let plain = Plain { grid, undeformed_distance: &[], bodies, load: Load::Approach(0.0) };
        let value = coating.compliance(&plain, wave_number)?;
        require(
            value.is_finite(),
            "the compliance",
            value,
            "moduli and wave_number take it out of the range of numbers",
        )?;
        // SAFETY: not null: room for a value.
        unsafe { compliance.write(value) };
        Ok(CONTACT_NORMAL_OK)
    })
}

impl contact_normal_coating {
    pub(super) fn translate(&self) -> CoatingLayer {
        let contact_normal_coating { thickness, shear_modulus, poisson_ratio, .. } = *self;
        CoatingLayer { thickness, shear_modulus, poisson_ratio }
    }
}

impl GivenEffect for contact_normal_coating {}
