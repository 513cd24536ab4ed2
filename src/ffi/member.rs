//! A struct of the ABI and its members, by name; `members.rs` lists them.

use std::borrow::Cow;

use libc::{c_char, c_void};

use super::structs::Versioned;

/// The type of a member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Int32,
    Int64,
    Double,
    /// A pointer to a callback, a text or data that only the host can interpret.
    OfTheHost,
    /// It points to numbers.
    Array,
    /// It points to a struct of this name, or to many.
    Structs(&'static str),
}

/// The types that members have in Rust.
pub(super) trait Typed {
    const KIND: Kind;
    /// The number of values of an array; none: it is no array.
    const COUNT: Option<usize> = None;
}

macro_rules! typed {
    ($($kind:ident: $($type:ty),+;)+) => {
        $($(impl Typed for $type { const KIND: Kind = Kind::$kind; })+)+
    };
}

typed! {
    Int32: i32;
    Int64: i64;
    Double: f64;
    Array: *const f64, *mut f64, *const i32, *mut i32, *mut i64;
    OfTheHost: *const c_char, *mut c_void;
}

/// Callbacks.
impl<F> Typed for Option<F> {
    const KIND: Kind = Kind::OfTheHost;
}

impl<T: Versioned> Typed for *const T {
    const KIND: Kind = Kind::Structs(T::NAME);
}

impl<T: Versioned> Typed for *mut T {
    const KIND: Kind = Kind::Structs(T::NAME);
}

impl<T: Typed, const N: usize> Typed for [T; N] {
    const KIND: Kind = T::KIND;
    const COUNT: Option<usize> = Some(N);
}

/// A member of a struct.
#[derive(Debug)]
pub(super) struct Member {
    name: &'static str,
    /// Bytes from the beginning of the struct.
    at: usize,
    kind: Kind,
    count: Option<usize>,
}

impl Member {
    /// The member that a function finds in its struct.
    pub const fn of<S, T: Typed>(name: &'static str, at: usize, _: fn(&S) -> &T) -> Member {
        Member { name, at, kind: T::KIND, count: T::COUNT }
    }

    /// The place of its value, or those of the values of an array.
    fn places(&self) -> impl Iterator<Item = Place> + '_ {
        (0..self.count.unwrap_or(1)).map(|k| Place {
            name: self.count.map_or(self.name.into(), |_| format!("{}[{k}]", self.name).into()),
            at: self.at + k * self.kind.bytes(),
            kind: self.kind,
        })
    }
}

impl Kind {
    /// Bytes that a value takes.
    pub fn bytes(self) -> usize {
        if self == Kind::Int32 {
            4
        } else {
            8
        }
    }
}

/// Where a value stands in a struct: its name ("normal.force", "coating[0]"), the bytes from the beginning of the struct, and its type.
#[derive(Debug)]
pub(super) struct Place {
    pub name: Cow<'static, str>,
    pub at: usize,
    pub kind: Kind,
}

impl Place {
    /// The bytes from the beginning of the struct to its end.
    pub fn end(&self) -> usize {
        self.at + self.kind.bytes()
    }
}

/// A struct of the ABI.
#[derive(Debug)]
pub(super) struct Struct {
    pub name: &'static str,
    pub members: &'static [Member],
}

impl Struct {
    /// The places of the values of its members.
    pub fn places(&self) -> impl Iterator<Item = Place> + '_ {
        self.members.iter().flat_map(Member::places)
    }
}

/// Constants of the ABI, each with its name without CONTACT_NORMAL_.
macro_rules! constants {
    ($($name:ident)*) => {
        &[$((stringify!($name).split_at("CONTACT_NORMAL_".len()).1, $name)),*]
    };
}
pub(super) use constants;

/// Structs, each with its members and those of structs within it.
macro_rules! structs {
    ($($struct:ident { $($member:ident $(. $inner:ident)*)* })*) => {
        &[$(Struct {
            name: stringify!($struct),
            members: &[$(Member::of(
                concat!(stringify!($member) $(, ".", stringify!($inner))*),
                std::mem::offset_of!($struct, $member $(. $inner)*),
                |all: &$struct| &all.$member $(. $inner)*,
            )),*],
        }),*]
    };
}
pub(super) use structs;
