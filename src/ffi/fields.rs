//! `contact_normal_fields`: the arrays of a solve.

use super::structs::versioned;

/// Arrays of the caller's, `[my][mx]`, x fastest. NULL (the default of each): not wanted. Written only when the status is >= 0. No
/// array may overlap with another one, nor with anything that is read.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_fields {
    /// Set by `contact_normal_fields_init`.
    pub struct_size: i64,
    /// p. Read as the initial guess when that is GIVEN. Exactly 0 outside the contact area, but with adhesion: that acts there.
    pub pressure: *mut f64,
    /// e = h - approach + A p; +infinity where there is no surface.
    pub deformed_distance: *mut f64,
    /// u = A p.
    pub displacement: *mut f64,
    /// 0: exterior, 1: contact, 2: at the pressure limit. Read (non-zero: contact) with initial_guess GIVEN and with
    /// active_set FIXED: then it is not written, and keeps whatever codes it has.
    pub contact: *mut i32,
    /// With friction: tractions q on body 1, in x and y; 0 where there is no contact, and without friction.
    pub traction: [*mut f64; 2],
    /// With friction: the slip s of the step, in x and y, a length; 0 where there is no contact, and without friction.
    pub slip: [*mut f64; 2],
    /// With friction: CONTACT_NORMAL_STICK_SLIP_... of each element; EXTERIOR without friction.
    pub stick_slip: *mut i32,
    /// With adhesion: q = p + sigma in contact, 0 outside; without adhesion p.
    pub contact_pressure: *mut f64,
    /// With adhesion: sigma(e) >= 0; 0 without adhesion.
    pub attraction: *mut f64,
    /// With a law of friction or a layer that yields: mu that particles carry after the step; else 0.
    pub friction_coefficient: *mut f64,
    /// With a layer that yields: the limits that particles carry after the step; else 0.
    pub yield_limit: *mut f64,
}

versioned! { contact_normal_fields, contact_normal_fields_init, 80 }
