//! What random bytes do to the C ABI: they become a scene, options, guesses and a table of coefficients, and whatever comes of that keeps
//! the promises of the ABI. campaign/tests/random_bytes.rs and the cargo-fuzz targets in fuzz/ call this.

use std::ptr::null_mut;

use contact_normal::ffi::*;

use crate::bytes_call::{Call, Target};

/// Arrays have room for so many elements.
pub const ROOM: usize = 256;
/// What outputs hold before a call.
pub const SENTINEL: f64 = -12345.678;
pub const SENTINEL_CONTACT: i32 = -77;

/// Bytes, read one value after the other; zeros when there are no more.
pub struct Bytes<'a> {
    data: &'a [u8],
}

impl Bytes<'_> {
    pub fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.data.split_first() else { return 0 };
        self.data = rest;
        *first
    }

    pub fn word(&mut self) -> u64 {
        (0..8).fold(0, |word, _| word << 8 | u64::from(self.byte()))
    }

    /// A usual number, or any bits at all.
    pub fn number(&mut self) -> f64 {
        match self.byte() {
            0 => f64::from_bits(self.word()),
            1 => [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, f64::MAX, f64::MIN_POSITIVE, 5e-324]
                [usize::from(self.byte() % 8)],
            2 => f64::from(self.byte() as i8) * 10f64.powi(i32::from(self.byte() as i8)),
            _ => f64::from(self.byte()) / 100.0,
        }
    }

    /// `usual`, or a number.
    pub fn sometimes(&mut self, usual: f64) -> f64 {
        if self.byte() % 16 == 1 {
            self.number()
        } else {
            usual
        }
    }

    /// Mostly below `limit`; now and then any integer at all.
    pub fn integer(&mut self, limit: u8) -> i32 {
        match self.byte() {
            255 => self.word() as i32,
            byte => i32::from(byte % limit),
        }
    }

    /// A size that keeps to the room, or one that no grid has.
    pub fn size(&mut self) -> i32 {
        match self.byte() {
            255 => [0, -1, i32::MIN, i32::MAX, 65536][usize::from(self.byte() % 5)],
            byte => 1 + i32::from(byte % 16),
        }
    }
}

/// A scene and options from bytes, through the plain call and through a handle. Returns the statuses, here as below.
pub fn scene_and_options(data: &[u8]) -> Vec<i32> {
    solve(data, Target::Scene)
}

/// The same with a table of coefficients.
pub fn tables(data: &[u8]) -> Vec<i32> {
    solve(data, Target::Table)
}

/// The same with friction.
pub fn friction(data: &[u8]) -> Vec<i32> {
    solve(data, Target::Friction)
}

fn solve(data: &[u8], target: Target) -> Vec<i32> {
    let mut bytes = Bytes { data };
    let through_handle = bytes.byte() % 2 == 1;
    let mut call = Call::new(&mut bytes, target);
    if !call.may_be_tried() {
        return Vec::new();
    }
    let call = &mut *call;
    let before = call.outputs();
    // SAFETY: structs with the arrays that they declare.
    unsafe {
        if !through_handle {
            let fixed = call.contact.clone();
            let status = contact_normal_solve(&call.scene, &call.options, &mut call.fields, &mut call.report);
            call.check(status, &before, &fixed);
            return vec![status];
        }
        let (mut handle, mut statuses) = (null_mut(), Vec::new());
        let status = contact_normal_solver_new(&call.scene, &call.options, &mut handle);
        if status == CONTACT_NORMAL_OK {
            for _ in 0..2 {
                let (before, fixed) = (call.outputs(), call.contact.clone());
                let (options, fields) = (&call.options, &mut call.fields);
                let status = contact_normal_solver_solve(handle, &call.scene, options, fields, &mut call.report);
                call.check(status, &before, &fixed);
                statuses.push(status);
            }
        } else {
            call.check(status, &before, &[]);
            assert!(handle.is_null());
            statuses.push(status);
        }
        contact_normal_solver_free(handle);
        statuses
    }
}
