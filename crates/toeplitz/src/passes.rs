//! The passes of transforms (loops over rows or columns), compiled in this crate once for each precision. Generic passes would be compiled again in
//! each crate that uses products, which would take two fifths of its optimisation time.

use std::sync::Arc;

use pulp::Arch;
use rustfft::{Fft, FftPlanner};

use crate::fft::column_pass::{EvenSymbol, Multiply};
use crate::fft::factors::{ComplexMatrix, ComplexSymbol, Displaced, RealMatrix};
use crate::fft::row_pass::{Forward, Inverse};
use crate::real::Scalar;

macro_rules! passes {
    ($($(#[$doc:meta])* $name:ident: $pass:ty;)*) => {
        /// A real number, `f32` or `f64`, with the passes of this precision. Each pass uses the instruction set `arch`.
        pub trait Real: Scalar {
            $($(#[$doc])* fn $name(arch: Arch, pass: $pass);)*

            /// The plans of rustfft for columns of length `n`: of the transform and of its inverse.
            fn plans(n: usize) -> [Arc<dyn Fft<Self>>; 2];
        }
        passes!(@of f32: $($name: $pass;)*);
        passes!(@of f64: $($name: $pass;)*);
    };
    (@of $t:ident: $($name:ident: $pass:ty;)*) => {
        impl Real for $t {
            $(fn $name(arch: Arch, pass: $pass) {
                arch.dispatch(pass);
            })*

            fn plans(n: usize) -> [Arc<dyn Fft<$t>>; 2] {
                let mut planner = FftPlanner::new();
                [planner.plan_fft_forward(n), planner.plan_fft_inverse(n)]
            }
        }
    };
}

passes!(
    /// Transforms rows to bins.
    rows_forward: Forward<'_, '_, Self>;
    /// Transforms bins back to rows.
    rows_inverse: Inverse<'_, '_, Self>;
    /// Multiplies columns by an even symbol.
    by_even: Multiply<'_, Self, EvenSymbol<'_, Self>, 1>;
    /// Multiplies columns by an even symbol and a complex factor for each column, for displacements further on in x.
    by_even_displaced: Multiply<'_, Self, Displaced<'_, Self, EvenSymbol<'_, Self>>, 1>;
    /// Multiplies columns by a complex symbol.
    by_complex: Multiply<'_, Self, ComplexSymbol<'_, Self>, 1>;
    /// Multiplies columns of two components by a real matrix for each bin.
    by_matrix: Multiply<'_, Self, RealMatrix<'_, Self>, 2>;
    /// Multiplies columns of two components by a real matrix for each bin and a complex factor for each column, for displacements further on in x.
    by_matrix_displaced: Multiply<'_, Self, Displaced<'_, Self, RealMatrix<'_, Self>>, 2>;
    /// Multiplies columns of two components by a complex matrix for each bin.
    by_complex_matrix: Multiply<'_, Self, ComplexMatrix<'_, Self>, 2>;
);
