//! Solves the elastic normal contact problem: where two bodies that are pressed together touch, and with which pressures.
//!
//! The potential contact area is a grid of `mx * my` rectangular elements. The unknowns are pressures p and the contact area C with
//!
//! ```text
//! e = h - approach + A p        deformed distance = undeformed distance - approach + displacement u = A p
//! e = 0,  p >= 0   in C         (contact area)
//! e > 0,  p = 0    outside      (exterior area)
//! ```
//!
//! This is a linear complementarity problem. A is dense, symmetric and block Toeplitz. `A_IJ` is the displacement at the centre of element I by a
//! unit pressure on element J. For two equal elastic half-spaces it is the Boussinesq integral of `(1 - nu)/(pi G) / rho` over element J, with the
//! distance rho from the centre of I. Either the approach is prescribed; or the force `sum of p dx dy` is prescribed, and the approach is an unknown.
//!
//! The methods are those of J. Zhao, E.A.H. Vollebregt and C.W. Oosterlee, "A Full Multigrid Method for Linear
//! Complementarity Problems arising from Elastic Normal Contact Problems" ("the paper"; its section and step numbers are
//! used throughout), Kalker's NORM, and the production method [`methods::projected_cg`], with which `AUTO` begins.
//!
//! ```
//! use contact_normal::grid::Grid;
//! use contact_normal::scene::{Bodies, Load, Scene};
//! use contact_normal::solver::{solve, Options, Outcome};
//!
//! // A ball of radius 500 mm on a plane, both of steel (mm, N), pressed by 1000 N.
//! let grid = Grid::new(32, 32, 0.25, 0.25)?;
//! let h: Vec<f64> = (0..grid.len())
//!     .map(|i| {
//!         let (x, y) = (((i % 32) as f64 - 15.5) * grid.dx, ((i / 32) as f64 - 15.5) * grid.dy);
//!         (x * x + y * y) / 1000.0
//!     })
//!     .collect();
//! let scene = Scene::new(grid, &h, Bodies::same(82000.0, 0.28), Load::Force(1000.0));
//! let (solver, outcome, report) = solve(&scene, &Options::default())?;
//! assert_eq!(outcome, Outcome::Converged);
//! assert!((report.measures.force - 1000.0).abs() < 1e-6);
//! assert!(solver.state().p.iter().all(|p| *p >= 0.0));
//! # Ok::<(), contact_normal::error::Error>(())
//! ```
//!
//! # Map of the modules
//!
//! Arrows point one way: `ffi -> solver -> friction, adhesion -> methods -> progress -> contact -> operator -> influence -> grid, error`.
//! `scene` and `effects` know no method.
//!
//! | module | contents |
//! |---|---|
//! | [`scene`] | the problem: bodies, undeformed distance, load, and effects |
//! | [`effects`] | one file per effect, and the list of effects |
//! | [`influence`] | kernels (half-space, periodic, the caller's tables) and their coefficients |
//! | [`operator`] | u = A p by FFT (of the crate `toeplitz`) |
//! | [`contact`] | the unknowns, steps (4.1) and (4.2) on an admissible set, the guard against cycling, the certificate |
//! | [`progress`] | the goal of an iteration loop, why it ended, its counters, the ledger |
//! | [`methods`] | NORM (section 3), V-cycles (section 4.2), projected conjugate gradients, projected Newton, direct solve: one step at a time |
//! | [`solver`] | the iteration loop (section 4.1), nested iteration (section 4.3), the choice of methods, the report |
//! | [`friction`], [`adhesion`] | the tangential problem; attraction across the gap |
//! | [`heat`] | flash temperature, from a flux of heat |
//! | [`wear`] | frictional work and depth of wear, from tractions and slips |
//! | [`stress`] | stresses below the surface, from pressures and tractions |
//! | [`visco`] | Prony series of visco-elastic bodies, and their time steps |
//! | [`analytic`] | the Hertz solution |
//! | `bisection` | bisection of an interval |
//! | `direction` | the two directions of a grid, and positions along them |
//! | `powers` | numbers as a power of two times a factor near 1, for products that would overflow or underflow |
//! | `blocks`, `lanes`, `rectangle` | parallel, vectorised passes over a grid; formulas in SIMD vectors; a part of a grid |
//! | [`threads`], and of the same crate, `par`, `memory` and `sums` | the pool, large arrays, sums in a fixed order |
//! | [`ffi`] | the C ABI, translation only |

#![warn(missing_docs)]
#![deny(unsafe_code)]

pub mod adhesion;
pub mod analytic;
mod bisection;
mod blocks;
pub mod contact;
mod direction;
pub mod effects;
pub mod error;
#[allow(unsafe_code)]
pub mod ffi;
pub mod friction;
pub mod grid;
pub mod heat;
pub mod influence;
mod lanes;
pub mod methods;
pub mod operator;
mod powers;
pub mod progress;
mod rectangle;
pub mod scene;
pub mod solver;
pub mod stress;
pub mod visco;
pub mod wear;

pub use par::threads;
pub(crate) use par::{memory, sums};
#[cfg(feature = "test-panics")]
#[doc(hidden)]
pub use toeplitz::panics;

#[cfg(panic = "abort")]
compile_error!("contact-normal turns panics into a status at the C boundary: build it with panic = \"unwind\"");

/// Runs the examples of the readme on crates.io as tests.
#[cfg(doctest)]
#[doc = include_str!("../packaging/crate.md")]
struct Readme;
