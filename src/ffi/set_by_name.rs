//! Options and constants by name, for hosts that read them from files: `contact_normal_set_option`, `contact_normal_constant`.

use std::ffi::CStr;

use libc::c_char;

use super::guard::guard;
use super::member::{Kind, Place};
use super::members::{structure, CONSTANTS};
use super::options::{contact_normal_cycle, contact_normal_options};
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::structs::{self, Versioned};

/// Sets the option of this `name` to the `value` of a text: "tolerance" to "1e-8", "method" to "PROJECTED_CG" (or "METHOD_PROJECTED_CG", or
/// "4"). Upper and lower case are the same, blanks around do not matter, and numbers may be written as in Fortran, "1d-8". For hosts that
/// read options from a file. INVALID_ARGUMENT: there is no such option, or the text is no value of it; the message has similar names, or all.
/// The call that uses a number checks its range. Callbacks, `cycle`, `stop` and `dump` are set by the program. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_set_option(
    options: *mut contact_normal_options,
    name: *const c_char,
    value: *const c_char,
) -> contact_normal_status {
    // SAFETY: NULL, or a struct that declares its size and texts that end with 0, by the conventions of the ABI.
    guard(|| unsafe { set("options", options, name, value) })
}

/// The same of a cycle: "smoother" to "RED_BLACK", "relaxation" to "0.9". Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_set_cycle_option(
    cycle: *mut contact_normal_cycle,
    name: *const c_char,
    value: *const c_char,
) -> contact_normal_status {
    // SAFETY: as above.
    guard(|| unsafe { set("cycle", cycle, name, value) })
}

/// Writes the value of the constant that is called `name`, with or without CONTACT_NORMAL_, in upper or lower case: of "METHOD_NORM" 1.
/// INVALID_ARGUMENT: there is none; the message says which are called nearly so. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_constant(name: *const c_char, value: *mut i32) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a text that ends with 0, by the conventions of the ABI.
        let name = unsafe { text("name", name)? };
        if value.is_null() {
            return Err(Refusal::null("value"));
        }
        let found = CONSTANTS.iter().find(|(known, _)| known.eq_ignore_ascii_case(without_prefix(&name)));
        let there_are = || said(without_prefix(&name), CONSTANTS.iter().map(|(known, _)| *known));
        let found = found.ok_or_else(|| Refusal::invalid(format!("there is no constant {name}: {}", there_are())))?;
        // SAFETY: not NULL: room for a value.
        unsafe { value.write(found.1) };
        Ok(CONTACT_NORMAL_OK)
    })
}

/// A text of the caller's, without blanks around it.
unsafe fn text(name: &str, from: *const c_char) -> Result<String, Refusal> {
    if from.is_null() {
        return Err(Refusal::null(name));
    }
    // SAFETY: not NULL: by the caller.
    Ok(unsafe { CStr::from_ptr(from) }.to_string_lossy().trim().to_owned())
}

fn without_prefix(name: &str) -> &str {
    let prefix = "CONTACT_NORMAL_";
    match name.get(..prefix.len()) {
        Some(begin) if begin.eq_ignore_ascii_case(prefix) => &name[prefix.len()..],
        _ => name,
    }
}

/// Members that a text can set.
fn can_be_set(member: &Place) -> bool {
    let is_number = matches!(member.kind, Kind::Int32 | Kind::Int64 | Kind::Double);
    is_number && !["struct_size", "reserved"].contains(&&*member.name)
}

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
        None => return Err(Refusal::invalid(format!("there is no option {name}: {}", said(&name, names())))),
    };
    if member.end() > size {
        return Err(Refusal::invalid(format!("{name} is an option that the header of this program does not have")));
    }
    // SAFETY: the caller's struct has this member, of this kind; any bytes are a value.
    unsafe {
        let at = to.cast::<u8>().add(member.at);
        match member.kind {
            Kind::Double => at.cast::<f64>().write_unaligned(double(&member.name, &value)?),
            Kind::Int64 => at.cast::<i64>().write_unaligned(integer(&member.name, &value)?.into()),
            _ => at.cast::<i32>().write_unaligned(integer(&member.name, &value)?),
        }
    }
    Ok(CONTACT_NORMAL_OK)
}

fn double(name: &str, value: &str) -> Result<f64, Refusal> {
    let refuse = |_| Refusal::invalid(format!("{name} is \"{value}\"; it must be a number"));
    // "inf" and "nan" contain no d.
    value.replace(['d', 'D'], "e").parse().map_err(refuse)
}

/// A number, or the constant of this name that the option may have.
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
            Some(_) => said(short, of_option().map(|(known, _)| known)),
            None => "it must be a whole number".into(),
        };
        Refusal::invalid(format!("{name} is \"{value}\"; {rule}"))
    })
}

fn all<'a>(names: impl Iterator<Item = &'a str>) -> String {
    format!("there are {}", names.collect::<Vec<_>>().join(", "))
}

/// A message lists all names if there are no more than these.
const FEW: usize = 20;

/// Lists the names; of many only those similar to `name`.
fn said<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> String {
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

/// The Levenshtein distance: letters to change, to leave out or to insert.
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
