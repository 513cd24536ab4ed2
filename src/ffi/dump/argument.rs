//! The arguments of a call, for a dump.

use crate::ffi::structs::Versioned;

/// An argument of a call.
#[derive(Clone, Copy)]
pub(in crate::ffi) enum Argument {
    /// A pointer to a struct: the name of the struct, and the address.
    Struct(&'static str, usize),
    /// A pointer to numbers: the address.
    Array(usize),
    /// A number.
    Integer(i64),
}

/// The types that arguments have.
pub(in crate::ffi) trait Given {
    fn given(self) -> Argument;
}

impl<T: Versioned> Given for *const T {
    fn given(self) -> Argument {
        Argument::Struct(T::NAME, self as usize)
    }
}

impl<T: Versioned> Given for *mut T {
    fn given(self) -> Argument {
        self.cast_const().given()
    }
}

impl Given for *const f64 {
    fn given(self) -> Argument {
        Argument::Array(self as usize)
    }
}

impl Given for *mut f64 {
    fn given(self) -> Argument {
        Argument::Array(self as usize)
    }
}

impl Given for i32 {
    fn given(self) -> Argument {
        Argument::Integer(self.into())
    }
}
