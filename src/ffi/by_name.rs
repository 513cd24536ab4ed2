//! What is found by its name: the structs of the ABI and their members, which `members.rs` lists.

pub(super) use super::member::{Kind, Member, Struct};
use super::members::STRUCTS;

/// The struct of this name.
pub(super) fn structure(name: &str) -> Option<&'static Struct> {
    STRUCTS.iter().find(|each| each.name == name)
}
