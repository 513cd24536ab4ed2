//! Products by block Toeplitz matrices of two levels, by FFT; also by matrices that are Toeplitz in x only.
//!
//! ```text
//! u_I = sum_J c(I - J) p_J = [F^-1 (S . F p)]_I       I, J elements of a grid of mx * my,   S = F c, the symbol
//!
//! c(kx, ky) = c(-kx, ky) = c(kx, -ky)                 S is real and even: half of each of its columns is kept
//! c(k) = c(-k)                                        S is real
//! c(kx, ky) = -c(-kx, ky) = -c(kx, -ky)               S is real and odd: likewise
//! any other c                                         S is complex
//! ```
//!
//! p is padded with zeros to a period `px * py` that keeps the offsets apart. The padding is not stored: only rows with values are
//! transformed in x, and blocks of columns are transformed in y, multiplied by S and transformed back in the nearest cache. Even products of
//! lengths `2^a 3^b 5^c` use stages of this crate, one row or column in each SIMD lane, others rustfft. No bit depends on the number of
//! threads or on the length of vectors.
//!
//! ```
//! use par::threads::Threads;
//! use toeplitz::Product;
//!
//! // c = 1/(1 + |k|) on a grid of 3 x 2 elements.
//! let c = |kx: usize, ky: usize| 1.0 / (1.0 + ((kx * kx + ky * ky) as f64).sqrt());
//! let product = Product::<f64>::even((3, 2), c, &Threads::One)?;
//! let (p, mut u) = ([1.0, 0.0, 0.0, 0.0, 0.0, 2.0], [0.0; 6]);
//! product.apply(&p, &mut u, &mut product.memory()?);
//! // Element (0, 0): its own value, and that of element (2, 1).
//! assert!((u[0] - (1.0 + 2.0 * c(2, 1))).abs() < 1e-14);
//! # Ok::<(), par::OutOfMemory>(())
//! ```
//!
//! | module | contents |
//! |---|---|
//! | [`Product`] | the product of one matrix |
//! | [`VectorProduct`] | the product of two components, by a symmetric 2 x 2 matrix for each offset |
//! | [`ParityProduct`] | sums of products by kernels that are even or odd in either direction |
//! | [`coefficients`] | the coefficients of a matrix |
//! | [`fft`] | transforms of rows and columns: stages in lanes, and any length |
//! | [`plan`] | plans shared by the threads of a process |
//! | [`dense`] | the product term by term, the oracle of tests |

#![warn(missing_docs)]
#![deny(unsafe_code)]

#[allow(unsafe_code)] // the kernel
pub mod block;
pub mod coefficients;
mod convolution;
pub mod dense;
pub mod fft;
pub mod lengths;
#[cfg(feature = "test-panics")]
#[doc(hidden)]
pub mod panics;
mod parity;
mod passes;
pub mod plan;
mod product;
mod real;
mod row_matrices;
mod rows;
mod set_up;
mod set_up_columns;
mod set_up_lanes;
mod symbol;
mod vector_product;
mod vector_set_up;
mod vector_symbol;
mod workspace;

pub use coefficients::{Coefficients, Even, EvenMatrix};
pub use parity::{ParityMemory, ParityProduct, Term};
pub use passes::Real;
pub use product::{even_period, Product};
pub use real::Complex;
pub use row_matrices::OfRows;
pub use set_up::SetUp;
pub use vector_product::{vector_period, VectorProduct};
pub use workspace::{Memory, Room};

/// The examples of README.md, the page of this crate on crates.io.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
