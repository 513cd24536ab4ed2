//! Passes of transforms, compiled in this crate, once for each precision. Generic passes would be compiled again in each build of a crate that
//! multiplies. That takes two fifths of the optimiser's time.

use std::sync::Arc;

use pulp::Arch;
use rustfft::{Fft, FftPlanner};

use crate::fft::column_pass::{EvenSymbol, Multiply};
use crate::fft::factors::{ComplexMatrix, ComplexSymbol, Displaced, RealMatrix};
use crate::fft::row_pass::{Forward, Inverse};
use crate::real::Scalar;

macro_rules! passes {
    ($($(#[$doc:meta])* $name:ident: $pass:ty;)*) => {
        /// `f32` or `f64`, with the passes of this precision by the instructions `arch`.
        pub trait Real: Scalar {
            $($(#[$doc])* fn $name(arch: Arch, pass: $pass);)*

            /// Plans of rustfft for columns of length `n`: forward, and the inverse.
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
    /// Rows to bins.
    rows_forward: Forward<'_, '_, Self>;
    /// Bins to rows.
    rows_inverse: Inverse<'_, '_, Self>;
    /// Columns times an even symbol.
    by_even: Multiply<'_, Self, EvenSymbol<'_, Self>, 1>;
    /// Columns times an even symbol, displaced.
    by_even_displaced: Multiply<'_, Self, Displaced<'_, Self, EvenSymbol<'_, Self>>, 1>;
    /// Columns times a complex symbol.
    by_complex: Multiply<'_, Self, ComplexSymbol<'_, Self>, 1>;
    /// Columns of two components times a real matrix.
    by_matrix: Multiply<'_, Self, RealMatrix<'_, Self>, 2>;
    /// Columns of two components times a real matrix, displaced.
    by_matrix_displaced: Multiply<'_, Self, Displaced<'_, Self, RealMatrix<'_, Self>>, 2>;
    /// Columns of two components times a complex matrix.
    by_complex_matrix: Multiply<'_, Self, ComplexMatrix<'_, Self>, 2>;
);
