//! Structs of the ABI and their members by name; `members.rs` lists them.

pub(super) use super::member::{Kind, Member, Struct};
use super::members::STRUCTS;

/// The struct of this name.
pub(super) fn structure(name: &str) -> Option<&'static Struct> {
    STRUCTS.iter().find(|each| each.name == name)
}
