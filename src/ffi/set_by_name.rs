//! Options and constants by name, for programs that read them from files: `contact_normal_set_option`, `contact_normal_constant`.

use std::ffi::CStr;

use libc::c_char;

use super::guard::guard;
use super::member::{Kind, Place};
use super::members::{structure, CONSTANTS};
use super::options::{contact_normal_cycle, contact_normal_options};
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::structs::{self, Versioned};

/// Sets the option `name` to the `value` that a text has: "tolerance" to "1e-8", "method" to "PROJECTED_CG" (or "METHOD_PROJECTED_CG", or
/// "4"). This is for programs that read options from a file. Upper and lower case are the same, blanks around a text do not matter, and numbers may
/// be written as in Fortran, "1d-8". INVALID_ARGUMENT: there is no such option, or the text is not a value of the option. The message lists similar
/// names, or all names. The range of a number is checked by the call that uses the options. A text cannot set callbacks, `cycle`, `stop` and `dump`.
/// Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_set_option(
    options: *mut contact_normal_options,
    name: *const c_char,
    value: *const c_char,
) -> contact_normal_status {
    // SAFETY: NULL, or a struct that declares its size and texts that end with 0, by the conventions of the ABI.
    guard(|| unsafe { set("options", options, name, value) })
}

/// As `contact_normal_set_option`, for a member of a cycle: "smoother" to "RED_BLACK", "relaxation" to "0.9". Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_set_cycle_option(
    cycle: *mut contact_normal_cycle,
    name: *const c_char,
    value: *const c_char,
) -> contact_normal_status {
    // SAFETY: as above.
    guard(|| unsafe { set("cycle", cycle, name, value) })
}

/// Writes the value of the constant `name`, which may be written without CONTACT_NORMAL_, and in upper or lower case: 1 for "METHOD_NORM".
/// INVALID_ARGUMENT: there is no such constant; the message lists similar names. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_constant(name: *const c_char, value: *mut i32) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a text that ends with 0, by the conventions of the ABI.
        let name = unsafe { text("name", name)? };
        if value.is_null() {
            return Err(Refusal::null("value"));
        }
        let found = CONSTANTS.iter().find(|(known, _)| known.eq_ignore_ascii_case(without_prefix(&name)));
        let advice = || similar(without_prefix(&name), CONSTANTS.iter().map(|(known, _)| *known));
        let (_, number) =
            found.ok_or_else(|| Refusal::invalid(format!("there is no constant {name}: {}", advice())))?;
        // SAFETY: not NULL, so room for a value.
        unsafe { value.write(*number) };
        Ok(CONTACT_NORMAL_OK)
    })
}

/// A copy of the caller's text, without the blanks around it. NULL is refused with the `name` of the argument.
unsafe fn text(name: &str, from: *const c_char) -> Result<String, Refusal> {
    if from.is_null() {
        return Err(Refusal::null(name));
    }
    // SAFETY: not NULL, and a text that ends with 0, by the caller.
    Ok(unsafe { CStr::from_ptr(from) }.to_string_lossy().trim().to_owned())
}

fn without_prefix(name: &str) -> &str {
    let prefix = "CONTACT_NORMAL_";
    match name.get(..prefix.len()) {
        Some(begin) if begin.eq_ignore_ascii_case(prefix) => &name[prefix.len()..],
        _ => name,
    }
}

/// Whether a text can set this member.
fn can_be_set(member: &Place) -> bool {
    let is_number = matches!(member.kind, Kind::Int32 | Kind::Int64 | Kind::Double);
    is_number && !["struct_size", "reserved"].contains(&&*member.name)
}

/// Sets the member `name` of the struct `to`, which messages call `called`, to the `value` of a text.
unsafe fn set<T: Versioned>(
    called: &str,
    to: *mut T,
    name: *const c_char,
    value: *const c_char,
) -> Result<contact_normal_status, Refusal> {
    // SAFETY (all): by the caller.
    let (size, name, value) =
        unsafe { (structs::declared_size(to.cast_const(), called)?, text("name", name)?, text("value", value)?) };
    let members: Vec<Place> = structure(T::NAME).into_iter().flat_map(|known| known.places()).collect();
    let found = members.iter().find(|member| member.name.eq_ignore_ascii_case(&name));
    let names = || members.iter().filter(|member| can_be_set(member)).map(|member| &*member.name);
    let member = match found {
        Some(member) if can_be_set(member) => member,
        Some(member) => {
            return Err(Refusal::invalid(format!("{} is not set by a text: {}", member.name, all(names()))))
        }
        None => return Err(Refusal::invalid(format!("there is no option {name}: {}", similar(&name, names())))),
    };
    if member.end() > size {
        return Err(Refusal::invalid(format!("{name} is an option that the header of this program does not have")));
    }
    // SAFETY: the caller's struct has this member, of this kind; any bytes are a value.
    unsafe {
        let address = to.cast::<u8>().add(member.offset);
        match member.kind {
            Kind::Double => address.cast::<f64>().write_unaligned(double(&member.name, &value)?),
            Kind::Int64 => address.cast::<i64>().write_unaligned(integer(&member.name, &value)?.into()),
            _ => address.cast::<i32>().write_unaligned(integer(&member.name, &value)?),
        }
    }
    Ok(CONTACT_NORMAL_OK)
}

/// The number that a text has. The exponent may be written with d, as in Fortran.
fn double(name: &str, value: &str) -> Result<f64, Refusal> {
    let refuse = |_| Refusal::invalid(format!("{name} is \"{value}\"; it must be a number"));
    // "inf" and "nan" contain no d.
    value.replace(['d', 'D'], "e").parse().map_err(refuse)
}

/// The whole number that a text has, or the value of the constant that the text names, of those that the option `name` may have.
fn integer(name: &str, value: &str) -> Result<i32, Refusal> {
    if let Ok(number) = value.parse() {
        return Ok(number);
    }
    let prefix = format!("{}_", name.to_uppercase());
    let of_option = || CONSTANTS.iter().filter_map(|(known, number)| Some((known.strip_prefix(&prefix)?, *number)));
    let given = without_prefix(value).to_uppercase();
    let short = given.strip_prefix(&prefix).unwrap_or(&given);
    let found = of_option().find(|(known, _)| *known == short).map(|(_, number)| number);
    found.ok_or_else(|| {
        let rule = match of_option().next() {
            Some(_) => similar(short, of_option().map(|(known, _)| known)),
            None => "it must be a whole number".into(),
        };
        Refusal::invalid(format!("{name} is \"{value}\"; {rule}"))
    })
}

fn all<'a>(names: impl Iterator<Item = &'a str>) -> String {
    format!("there are {}", names.collect::<Vec<_>>().join(", "))
}

/// A message lists all names if there are at most this many.
const FEW: usize = 20;

/// The advice in a message about an unknown `name`: up to three similar names, or all names if there are few.
fn similar<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    let given = name.to_uppercase();
    let mut near: Vec<(usize, &str)> =
        names.iter().map(|known| (distance(&given, &known.to_uppercase()), *known)).collect();
    near.sort();
    let is_near = |(changes, known): &&(usize, &str)| *changes <= 2.max(known.len() / 4);
    let mut nearest = near.iter().filter(is_near).take(3).map(|(_, known)| *known).peekable();
    match nearest.peek() {
        Some(_) => format!("is it {}?", nearest.collect::<Vec<_>>().join(", ")),
        None if names.len() <= FEW => all(names.into_iter()),
        None => "none is called nearly so".into(),
    }
}

/// The Levenshtein distance of two texts: the least number of letters to change, to leave out or to insert.
fn distance(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (i, letter) in one.chars().enumerate() {
        let mut before = row[0];
        row[0] = i + 1;
        for (j, known) in other.iter().enumerate() {
            let changed = before + usize::from(letter != *known);
            before = row[j + 1];
            row[j + 1] = changed.min(row[j] + 1).min(before + 1);
        }
    }
    row[other.len()]
}
