//! A struct of the ABI and its members, by name.

/// The type of a member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Int32,
    Int64,
    Double,
    /// A callback, a text or anything: only the host knows what it points to.
    OfTheHost,
    /// It points to numbers.
    Array,
    /// It points to a struct of this name, or to many.
    Structs(&'static str),
}

/// A member of a struct; of an array each of its values is one.
#[derive(Debug)]
pub(super) struct Member {
    pub name: &'static str,
    /// Bytes from the beginning of the struct.
    pub at: usize,
    pub kind: Kind,
}

impl Member {
    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        if self.kind == Kind::Int32 {
            4
        } else {
            8
        }
    }
}

/// A struct of the ABI.
#[derive(Debug)]
pub(super) struct Struct {
    pub name: &'static str,
    pub members: &'static [Member],
}

/// The members of a struct: for each its name, its place, the bytes from there to a value of an array, and its type.
macro_rules! members {
    ($struct:ident: $(($name:literal, $($place:ident).+, $more:literal, $kind:expr))*) => {
        &[$(Member { name: $name, at: std::mem::offset_of!($struct, $($place).+) + $more, kind: $kind }),*]
    };
}
pub(super) use members;
