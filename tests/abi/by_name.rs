//! Options and constants by their names.

use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

use contact_normal::ffi::*;

use crate::call::last_error;

fn set(options: &mut contact_normal_options, name: &str, value: &str) -> i32 {
    let (name, value) = (CString::new(name).expect("text"), CString::new(value).expect("text"));
    // SAFETY: a struct that declares its size, and texts.
    unsafe { contact_normal_set_option(options, name.as_ptr(), value.as_ptr()) }
}

fn constant(name: &str) -> Option<i32> {
    let name = CString::new(name).expect("text");
    let mut value = -77;
    // SAFETY: a text, and room for a value.
    let status = unsafe { contact_normal_constant(name.as_ptr(), &mut value) };
    (status == CONTACT_NORMAL_OK).then_some(value)
}

/// The type and the name of each member of a struct in the header, such as `("double", "tolerance")`.
fn members(name: &str) -> Vec<(String, String)> {
    let header = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/include/contact_normal.h")).expect("it");
    let body = header.split_once(&format!("typedef struct {name} {{")).expect("a struct").1;
    let body = body.split_once(&format!("}} {name};")).expect("its end").0;
    let without_comments: String =
        body.split("/*").map(|part| part.split_once("*/").map_or(part, |(_, code)| code)).collect();
    let declared = without_comments.split(';').map(str::trim).filter(|declared| !declared.is_empty());
    declared
        .map(|declared| {
            let (kind, name) = declared.rsplit_once(' ').expect("a type");
            (kind.into(), name.trim_start_matches('*').into())
        })
        .collect()
}

#[test]
fn every_option_of_the_header_is_set_by_its_name() {
    let mut numbers = 0;
    for (kind, name) in members("contact_normal_options") {
        let mut options = contact_normal_options::default();
        let is_number = ["int32_t", "double"].contains(&&*kind) && name != "reserved";
        assert_eq!(set(&mut options, &name.to_uppercase(), " 3 ") == CONTACT_NORMAL_OK, is_number, "{name}");
        numbers += i32::from(is_number);
        if !is_number {
            assert!(last_error().contains("is not set by a text"), "{}", last_error());
        }
    }
    assert!(numbers >= 10);
    let mut options = contact_normal_options::default();
    for (name, value) in [
        ("method", "projected_cg"),
        ("active_set", "ACTIVE_SET_FIXED"),
        ("Criterion", "contact_normal_criterion_update"),
        ("tolerance", "1d-8"),
        ("max_cycles", "17"),
        ("max_seconds", "2.5"),
        ("precision", "2"),
    ] {
        assert_eq!(set(&mut options, name, value), CONTACT_NORMAL_OK, "{name}: {}", last_error());
    }
    assert_eq!((options.method, options.active_set, options.criterion), (4, 1, 1));
    assert_eq!((options.tolerance, options.max_cycles, options.max_seconds, options.precision), (1e-8, 17, 2.5, 2));
    let mut cycle = contact_normal_cycle::default();
    let status = |cycle: &mut contact_normal_cycle, name: &CStr, value: &CStr| {
        // SAFETY: a struct that declares its size, and texts.
        unsafe { contact_normal_set_cycle_option(cycle, name.as_ptr(), value.as_ptr()) }
    };
    assert_eq!(status(&mut cycle, c"smoother", c"red_black"), CONTACT_NORMAL_OK);
    assert_eq!(status(&mut cycle, c"relaxation", c"0.75"), CONTACT_NORMAL_OK);
    assert_eq!((cycle.smoother, cycle.relaxation), (CONTACT_NORMAL_SMOOTHER_RED_BLACK, 0.75));
}

#[test]
fn every_constant_of_the_header_has_its_value() {
    let header = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/include/contact_normal.h")).expect("it");
    let mut count = 0;
    for line in header.lines().filter_map(|line| line.strip_prefix("#define CONTACT_NORMAL_")) {
        let Some((name, Ok(value))) = line.split_once(' ').map(|(name, value)| (name, value.parse())) else { continue };
        assert_eq!(constant(name), Some(value), "{name}");
        assert_eq!(constant(&format!("contact_normal_{}", name.to_lowercase())), Some(value), "{name}");
        count += 1;
    }
    assert!(count > 60, "{count}");
}

#[test]
fn what_is_unknown_is_refused_by_name_and_changes_nothing() {
    let mut options = contact_normal_options::default();
    for (name, value, said) in [
        ("tolerence", "1", "there is no option tolerence: is it tolerance?"),
        ("colour", "1", "there is no option colour: there are method, active_set,"),
        ("method", "projected_gc", "method is \"projected_gc\"; is it PROJECTED_CG?"),
        ("method", "", "method is \"\"; there are AUTO, NORM, MULTIGRID, FULL_MULTIGRID, PROJECTED_CG"),
        ("threads", "two", "threads is \"two\"; it must be a whole number"),
        ("threads", "99999999999", "threads is \"99999999999\"; it must be a whole number"),
        ("tolerance", "small", "tolerance is \"small\"; it must be a number"),
        ("struct_size", "8", "struct_size is not set by a text"),
    ] {
        assert_eq!(set(&mut options, name, value), CONTACT_NORMAL_INVALID_ARGUMENT, "{name}");
        assert!(last_error().starts_with(said), "{}", last_error());
    }
    let same = contact_normal_options::default();
    assert_eq!((options.method, options.threads, options.tolerance), (same.method, same.threads, same.tolerance));
    assert_eq!(constant("METHOD_PROJECTED_GC"), None);
    assert_eq!(last_error(), "there is no constant METHOD_PROJECTED_GC: is it METHOD_PROJECTED_CG?");
    assert_eq!(constant("x\u{e9}"), None);
    // SAFETY: NULL is refused.
    unsafe {
        assert_eq!(contact_normal_constant(null(), null_mut()), CONTACT_NORMAL_NULL_POINTER);
        assert_eq!(contact_normal_constant(c"OK".as_ptr(), null_mut()), CONTACT_NORMAL_NULL_POINTER);
        assert_eq!(contact_normal_set_option(null_mut(), c"".as_ptr(), c"".as_ptr()), CONTACT_NORMAL_NULL_POINTER);
        assert_eq!(contact_normal_set_option(&mut options, null(), c"".as_ptr()), CONTACT_NORMAL_NULL_POINTER);
        assert_eq!(contact_normal_set_option(&mut options, c"".as_ptr(), null()), CONTACT_NORMAL_NULL_POINTER);
    }
}

/// An option that lies beyond the struct of an older header is refused, and nothing is written there.
#[test]
fn an_option_beyond_the_callers_struct_is_refused() {
    let mut options = contact_normal_options { struct_size: 8, ..Default::default() };
    assert_eq!(set(&mut options, "tolerance", "1"), CONTACT_NORMAL_STRUCT_SIZE);
}
