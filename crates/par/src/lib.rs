//! Threads, memory and sums for programs over large arrays.
//!
//! ```
//! use par::sums::Sums;
//! use par::{memory, threads::Threads};
//!
//! // The caller's thread and one worker.
//! let threads = Threads::new(2)?;
//! // An array of 1e6 values, or an error that names its purpose.
//! let mut values: Vec<f64> = memory::zeros(1_000_000, "the example")?;
//! threads.for_each_plain_row(&mut values, 1000, |row, values| values.fill(row as f64));
//! let mut sums = Sums::new();
//! sums.add::<f64, 1, 0>([&values], [], |[x], []| [x, x * x]);
//! assert_eq!(sums.values()[0], 1000.0 * (999.0 * 1000.0 / 2.0));
//! // The memory is kept for the next array of this type and size.
//! memory::keep([&mut values]);
//! # Ok::<(), par::OutOfMemory>(())
//! ```
//!
//! | module | contents |
//! |---|---|
//! | [`threads`] | the worker threads of a process; work is divided into pieces, so the bits of a result do not depend on the number of threads |
//! | [`memory`] | arrays whose allocation returns an error if memory is short; the memory of released arrays is kept for later ones |
//! | [`sums`] | sums in a fixed order, which the compiler can vectorise, and the smallest of values |

#![warn(missing_docs)]
#![deny(unsafe_code)]

mod error;
pub mod memory;
pub mod sums;
pub mod threads;

pub use error::{OutOfMemory, Result};

/// Runs the examples of the readme on crates.io as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
