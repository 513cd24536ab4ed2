//! The elastic normal contact problem: where two bodies pressed together touch, and with what pressure.
//!
//! On a grid of `mx * my` rectangular elements (the potential contact area), find pressures p and the contact area C with
//!
//! ```text
//! e = h - approach + A p        deformed distance = undeformed distance - approach + displacement u = A p
//! e = 0,  p >= 0   in C         (contact area)
//! e > 0,  p = 0    outside      (exterior area)
//! ```
//!
//! A is dense, symmetric and block Toeplitz: `A_IJ` is the displacement at the centre of element I by a unit pressure on
//! element J, for the elastic half-space the Boussinesq integral of `(1 - nu)/(pi G) / rho` over element J. It is a linear
//! complementarity problem; the approach is given, or the force `sum of p dx dy` is and the approach is found.
//!
//! The methods are those of J. Zhao, E.A.H. Vollebregt and C.W. Oosterlee, "A Full Multigrid Method for Linear
//! Complementarity Problems arising from Elastic Normal Contact Problems" ("the paper"; its section and step numbers are
//! used throughout), Kalker's NORM, and the production method [`projected_cg`], which is what `AUTO` is.
//!
//! ```
//! use contact_normal::grid::Grid;
//! use contact_normal::scene::{Bodies, Load, Scene};
//! use contact_normal::solver::{solve, Options, Stop};
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
//! let (solver, stop, report) = solve(&scene, &Options::default())?;
//! assert_eq!(stop, Stop::Converged);
//! assert!((report.measures.force - 1000.0).abs() < 1e-6);
//! assert!(solver.state().p.iter().all(|p| *p >= 0.0));
//! # Ok::<(), contact_normal::error::Error>(())
//! ```
//!
//! # Map of the modules
//!
//! Arrows point one way: `ffi -> solver -> {multigrid, active_set, norm, projected_cg} -> operator -> influence -> grid, error`.
//!
//! | module | what it holds |
//! |---|---|
//! | [`scene`] | what is simulated: bodies, undeformed distance, load, effects |
//! | [`effects`] | one file per effect, and the list of them |
//! | [`solver`] | how: options, the loops of the methods as prose, the report and its ledger; an accuracy instead of a grid |
//! | [`projected_cg`] | projected preconditioned conjugate gradients on one grid, and its window |
//! | [`multigrid`] | section 4.2: grids, transfers, smoothers, the V-cycle |
//! | [`active_set`] | steps 4.1 and 4.2, the guard against cycling, the certificate |
//! | [`norm`] | section 3: the inner solves of NORM |
//! | [`operator`] | u = A p by FFT, and by direct summation |
//! | [`influence`] | kernels (Love's, periodic, the caller's own tables), diagonal and coupling |
//! | [`analytic`] | the Hertz solution |
//! | [`threads`] | the pool |
//! | [`ffi`] | the C ABI, translation only |

#![warn(missing_docs)]
#![deny(unsafe_code)]

pub mod analytic;
pub mod contact;
pub mod effects;
pub mod error;
#[allow(unsafe_code)]
pub mod ffi;
pub mod grid;
pub mod influence;
mod memory;
pub mod methods;
pub mod operator;
#[cfg(feature = "test-panics")]
#[doc(hidden)]
pub mod panics;
pub mod progress;
pub mod scene;
pub mod solver;
pub mod threads;

#[cfg(panic = "abort")]
compile_error!("contact-normal turns panics into a status at the C boundary: build it with panic = \"unwind\"");
