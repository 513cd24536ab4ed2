//! A macro for enumerations that have names and numbers in the C ABI.

/// Defines an enumeration with `ALL`, `number()` and `name()`. A variant is written as `Variant = number: "name"`; without a number it has that of
/// the variant before plus 1.
macro_rules! numbered {
    ($(#[$doc:meta])* $kind:ident { $($(#[$each:meta])* $variant:ident $(= $number:literal)?: $name:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $kind {
            $($(#[$each])* $variant $(= $number)?),+
        }

        impl $kind {
            /// All variants, in the order of their numbers in the C ABI.
            pub const ALL: [$kind; [$($name),+].len()] = [$($kind::$variant),+];

            /// The number in the C ABI.
            pub fn number(self) -> usize {
                self as usize
            }

            /// The name, the same in C, Fortran and Python.
            pub fn name(self) -> &'static str {
                match self {
                    $($kind::$variant => $name),+
                }
            }
        }
    };
}
pub(super) use numbered;
