//! Products by block Toeplitz matrices of two levels, by FFT. One kind of product is by matrices that are Toeplitz in x only.
//!
//! ```text
//! u_I = sum_J c(I - J) p_J = [F^-1 (S . F p)]_I       I, J elements of a grid of mx * my,   S = F c, the symbol
//! ```
//!
//! | coefficients | symbol |
//! |---|---|
//! | `c(kx, ky) = c(-kx, ky) = c(kx, -ky)` | S is real and even; half of each column is stored |
//! | `c(kx, ky) = -c(-kx, ky) = -c(kx, -ky)` | S is real and odd; half of each column is stored |
//! | `c(k) = c(-k)` | S is real |
//! | any other | S is complex |
//!
//! p is padded with zeros to a period `px * py`, which is so long that different offsets with different coefficients do not coincide. The padding is
//! not stored: only rows with values are transformed in x. In y, one block of columns after the other is transformed, multiplied by S and transformed
//! back, in the first-level cache. Products of even coefficients with periods `2^a 3^b 5^c` use stages of this crate, which transform one row or
//! column in each SIMD lane. Other products use rustfft. No bit of a result depends on the number of threads or on the length of vectors.
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
//! // p is 1 in element (0, 0) and 2 in element (2, 1). Both contribute to u in element (0, 0).
//! assert!((u[0] - (1.0 + 2.0 * c(2, 1))).abs() < 1e-14);
//! # Ok::<(), par::OutOfMemory>(())
//! ```
//!
//! | module | contents |
//! |---|---|
//! | [`Product`] | products by one matrix |
//! | [`VectorProduct`] | products of fields with two components, by a symmetric 2 x 2 matrix for each offset |
//! | [`ParityProduct`] | sums of products by kernels that are even or odd in either direction |
//! | [`coefficients`] | the coefficients of a matrix, as functions of the offset |
//! | [`fft`] | Fourier transforms of rows and columns: by stages of this crate, or of any length |
//! | [`plan`] | the plans of transforms, which the threads of a process share |
//! | [`dense`] | the product term by term, with which tests compare |

#![warn(missing_docs)]
#![deny(unsafe_code)]

#[allow(unsafe_code)] // The only module with unsafe code.
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

/// Runs the examples of README.md, the page of this crate on crates.io, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
