//! contact-normal
#![warn(missing_docs)]
pub mod active_set;
pub mod analytic;
pub mod error;
pub mod grid;
pub mod influence;
pub mod multigrid;
pub mod norm;
pub mod operator;
pub mod projected_cg;
pub mod scene;
pub mod solver;
pub mod threads;

pub mod ffi;

#[cfg(panic = "abort")]
compile_error!("contact-normal turns panics into a status at the C boundary: build it with panic = \"unwind\"");
