//! `contact_normal_fields`: the caller's arrays for the result of a solve.

use super::structs::versioned;

/// The caller's arrays for the result of a solve, `[my][mx]` each, x fastest. NULL (the default of each): not wanted. They are written only if the
/// status is >= 0. No array may overlap with another one, nor with anything that the call reads.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_fields {
    /// Set by `contact_normal_fields_init`.
    pub struct_size: i64,
    /// The pressure p. It is read as the initial guess if initial_guess is GIVEN. Outside the contact area p is exactly 0, except with adhesion,
    /// which acts there.
    pub pressure: *mut f64,
    /// The deformed distance e = h - approach + A p; +infinity where there is no surface.
    pub deformed_distance: *mut f64,
    /// The displacement u = A p.
    pub displacement: *mut f64,
    /// 0: exterior, 1: contact, 2: at the pressure limit. It is read (non-zero: contact) with initial_guess GIVEN and with active_set FIXED. With
    /// FIXED it is not written and keeps your codes.
    pub contact: *mut i32,
    /// With friction: the tractions q on body 1, in x and in y. 0 where there is no contact, and without friction.
    pub traction: [*mut f64; 2],
    /// With friction: the slip s of the step, in x and in y, a length. 0 where there is no contact, and without friction.
    pub slip: [*mut f64; 2],
    /// With friction: CONTACT_NORMAL_STICK_SLIP_... of each element. Without friction: EXTERIOR.
    pub stick_slip: *mut i32,
    /// With adhesion: the contact pressure q = p + sigma in contact, and 0 outside. Without adhesion: p.
    pub contact_pressure: *mut f64,
    /// With adhesion: the attraction sigma(e) >= 0. Without adhesion: 0.
    pub attraction: *mut f64,
    /// With a law of friction or a layer that yields: the coefficient mu of the particles after the step. Else 0.
    pub friction_coefficient: *mut f64,
    /// With a layer that yields: the yield limits of the particles after the step. Else 0.
    pub yield_limit: *mut f64,
}

versioned! { contact_normal_fields, contact_normal_fields_init, 80 }
