//! Turns random bytes into a scene, options, guesses and a table of coefficients, makes the call, and checks the promises of the ABI.
//! campaign/tests/random_bytes.rs and the cargo-fuzz targets in fuzz/ use these functions.

use std::ptr::null_mut;

use contact_normal::ffi::dump::Dump;
use contact_normal::ffi::*;

use crate::bytes_call::Call;
use crate::bytes_reader::{Bytes, Target};

/// Solves a scene with options from bytes, by one call or by a handle. Returns the statuses of the calls, as the functions below do.
pub fn scene_and_options(data: &[u8]) -> Vec<i32> {
    solve(data, Target::Scene)
}

/// [`scene_and_options`] with a table of coefficients.
pub fn tables(data: &[u8]) -> Vec<i32> {
    solve(data, Target::Table)
}

/// [`scene_and_options`] with friction.
pub fn friction(data: &[u8]) -> Vec<i32> {
    solve(data, Target::Friction)
}

/// Reads bytes as the file of a dump. If its call is short, makes the call again.
pub fn dump(data: &[u8]) -> Vec<i32> {
    let Ok(dump) = Dump::read(data) else { return Vec::new() };
    let is_short = dump.options().is_some_and(|options| (0..=8).contains(&options.max_cycles))
        && dump.scene().is_some_and(|scene| i64::from(scene.mx) * i64::from(scene.my) <= 4096);
    if !is_short {
        return Vec::new();
    }
    dump.replay().map_or_else(|_| Vec::new(), |again| vec![again.status])
}

/// Makes the calls of one target and checks their results.
fn solve(data: &[u8], target: Target) -> Vec<i32> {
    let mut bytes = Bytes::new(data);
    let through_handle = bytes.byte() % 2 == 1;
    let mut call = Call::new(&mut bytes, target);
    if !call.may_be_tried() {
        return Vec::new();
    }
    let call = &mut *call;
    let before = call.outputs();
    // SAFETY: all structs have the arrays that they declare.
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
