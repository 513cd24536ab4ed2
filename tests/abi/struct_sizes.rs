//! Structs of other sizes than this library's. A size that no version has is refused. A larger struct is accepted if its unknown members are 0.

use std::ptr::null_mut;

use crate::call::{Call, Through};
use crate::rows::*;
use contact_normal::ffi::*;

/// Sets the size that a struct declares, from its own size, which `_init` wrote. Returns the new size.
fn declare(call: &mut Call, name: &str, size: impl Fn(i64) -> i64) -> i64 {
    match name {
        "layer" => _ = call.use_layer(),
        "pressure_limit" => _ = call.use_limit(),
        "period" => call.use_period(1, 0),
        "patches" => _ = call.use_patches(HALF),
        "row_tables" => _ = call.use_row_tables(),
        "friction" => _ = call.use_friction(),
        "influence" => _ = call.use_table(),
        "cycle" => _ = call.use_cycle(),
        _ => {}
    }
    let declared = match name {
        "scene" => &mut call.scene.known.struct_size,
        "influence" => &mut call.influence.known.struct_size,
        "layer" => &mut call.layer.known.struct_size,
        "pressure_limit" => &mut call.limit.known.struct_size,
        "period" => &mut call.period.known.struct_size,
        "patches" => &mut call.patches.known.struct_size,
        "row_tables" => &mut call.row_tables.known.struct_size,
        "friction" => &mut call.friction.known.struct_size,
        "options" => &mut call.options.known.struct_size,
        "cycle" => &mut call.cycle.known.struct_size,
        "fields" => &mut call.fields.known.struct_size,
        "accuracy" => &mut call.accuracy.known.struct_size,
        _ => &mut call.report.known.struct_size,
    };
    *declared = size(*declared);
    *declared
}

fn excess<'a>(call: &'a mut Call, name: &str) -> &'a mut [u8; 64] {
    match name {
        "scene" => &mut call.scene.excess,
        "influence" => &mut call.influence.excess,
        "layer" => &mut call.layer.excess,
        "pressure_limit" => &mut call.limit.excess,
        "period" => &mut call.period.excess,
        "patches" => &mut call.patches.excess,
        "row_tables" => &mut call.row_tables.excess,
        "friction" => &mut call.friction.excess,
        "options" => &mut call.options.excess,
        "cycle" => &mut call.cycle.excess,
        "fields" => &mut call.fields.excess,
        "accuracy" => &mut call.accuracy.excess,
        _ => &mut call.report.excess,
    }
}

const STRUCTS: [&str; 13] = [
    "scene",
    "influence",
    "layer",
    "pressure_limit",
    "period",
    "patches",
    "row_tables",
    "friction",
    "options",
    "cycle",
    "fields",
    "report",
    "accuracy",
];

/// A function that reads the struct.
fn reader(name: &str) -> Through {
    if name == "accuracy" {
        Through::ToAccuracy
    } else {
        Through::Solve
    }
}

#[test]
fn a_struct_of_no_known_size_is_refused() {
    let sizes: [fn(i64) -> i64; 7] = [|_| 0, |_| 7, |_| -1, |_| i64::MIN, |_| 8, |_| 4097, |_| i64::MAX];
    for name in STRUCTS {
        for size in sizes {
            let mut call = Call::new();
            let declared = declare(&mut call, name, size);
            let before = call.outputs();
            let (status, message) = call.run(reader(name), null_mut());
            assert_eq!(status, SIZE, "{name} of {declared} bytes: {message}");
            for word in [name, "struct_size", &declared.to_string(), "_init"] {
                assert!(message.contains(word), "\"{message}\" does not say {word}");
            }
            assert!(call.outputs() == before, "{name} of {declared} bytes: outputs were written");
        }
    }
}

#[test]
fn a_larger_struct_is_accepted_if_what_we_do_not_know_is_zero() {
    for name in STRUCTS {
        let mut call = Call::new();
        declare(&mut call, name, |own| own + 64);
        assert_eq!(call.run(reader(name), null_mut()), (CONTACT_NORMAL_OK, String::new()), "{name}");
        assert_eq!(*excess(&mut call, name), [0; 64], "{name}: unknown members were written");
        for byte in [0, 63] {
            let mut call = Call::new();
            declare(&mut call, name, |own| own + 64);
            excess(&mut call, name)[byte] = 1;
            let before = call.outputs();
            let (status, message) = call.run(reader(name), null_mut());
            assert_eq!(status, SIZE, "{name}, byte {byte}: {message}");
            assert!(message.contains(name), "{message}");
            assert!(call.outputs() == before, "{name}, byte {byte}: outputs were written");
        }
    }
}
