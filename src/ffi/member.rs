//! Structs of the ABI and their members by name, with type and offset. `members.rs` lists them.

use std::borrow::Cow;

use libc::{c_char, c_void};

use super::structs::Versioned;

/// The type of a member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Int32,
    Int64,
    Double,
    /// A pointer to a callback, to a text, or to data that only the calling program can interpret.
    OfTheHost,
    /// A pointer to numbers.
    Array,
    /// A pointer to one or more structs of this name.
    Structs(&'static str),
}

/// A Rust type that members have.
pub(super) trait Typed {
    const KIND: Kind;
    /// The number of values of an array within the struct. None: the member is a single value.
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

// Callbacks.
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
    /// The bytes from the beginning of the struct.
    offset: usize,
    kind: Kind,
    /// The number of values of an array within the struct. None: a single value.
    count: Option<usize>,
}

impl Member {
    /// The member `name` at `offset`. The last argument, which returns the member of a struct, determines the type.
    pub const fn of<S, T: Typed>(name: &'static str, offset: usize, _: fn(&S) -> &T) -> Member {
        Member { name, offset, kind: T::KIND, count: T::COUNT }
    }

    /// The place of the value, or of each value of an array.
    fn places(&self) -> impl Iterator<Item = Place> + '_ {
        (0..self.count.unwrap_or(1)).map(|k| Place {
            name: self.count.map_or(self.name.into(), |_| format!("{}[{k}]", self.name).into()),
            offset: self.offset + k * self.kind.bytes(),
            kind: self.kind,
        })
    }
}

impl Kind {
    /// The bytes that a value takes.
    pub fn bytes(self) -> usize {
        if self == Kind::Int32 {
            4
        } else {
            8
        }
    }
}

/// A single value in a struct.
#[derive(Debug)]
pub(super) struct Place {
    /// The name of the value, as "normal.force" or "coating[0]".
    pub name: Cow<'static, str>,
    /// The bytes from the beginning of the struct.
    pub offset: usize,
    /// The type of the value.
    pub kind: Kind,
}

impl Place {
    /// The bytes from the beginning of the struct to the end of the value.
    pub fn end(&self) -> usize {
        self.offset + self.kind.bytes()
    }
}

/// A struct of the ABI.
#[derive(Debug)]
pub(super) struct Struct {
    pub name: &'static str,
    pub members: &'static [Member],
}

impl Struct {
    /// The places of all values in the struct.
    pub fn places(&self) -> impl Iterator<Item = Place> + '_ {
        self.members.iter().flat_map(Member::places)
    }
}

/// Lists constants of the ABI, each with its name without CONTACT_NORMAL_.
macro_rules! constants {
    ($($name:ident)*) => {
        &[$((stringify!($name).split_at("CONTACT_NORMAL_".len()).1, $name)),*]
    };
}
pub(super) use constants;

/// Lists structs with their members. A member of a struct within a struct is written `outer.inner`.
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
