//! The tangential problem: tractions q on C with `|q| <= g = mu p`, and slip opposite to them. docs/friction.md says what it computes.
//!
//! | module | what it holds |
//! |---|---|
//! | [`coefficients`] | influence of tangential tractions |
//! | [`Toeplitz`], [`dense`] | products of two components, by FFT and by direct summation |
//! | `problem`, `certificate`, `tangent` | the problem on one grid, how well its conditions hold, which elements slip |
//! | `tables` | coefficients of the caller's own |
//! | `extension` | residuals continued outside C, for the preconditioner |
//! | `shift` | projected conjugate gradients on discs, for motions that are given |
//! | `newton`, `fgmres` | semismooth Newton, for forces that are given and where the gradients stall |
//! | [`cross`] | unlike bodies: what couples the normal and the tangential problem |
//! | `levels`, `solver` | nested iteration, and the whole solve |

mod certificate;
pub mod coefficients;
pub mod cross;
pub mod dense;
mod extension;
mod fgmres;
mod forces;
mod levels;
mod march;
mod newton;
mod problem;
mod sensitivity;
mod shift;
mod solver;
mod system;
mod tables;
mod tangent;
mod toeplitz;
mod vectors;

pub use certificate::Certificate;
pub use coefficients::{Compliance, Tangential};
pub use cross::Coupling;
pub use solver::{Report, Request, Solution, Solver, EXTERIOR, SLIP, STICK};
pub use toeplitz::{Toeplitz, Workspace};

/// A vector of the plane: `[x, y]`.
pub type Vector = [f64; 2];
