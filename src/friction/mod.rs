//! The tangential problem: find tractions q on the contact area C with `|q| <= g = mu p`, so that elements with `|q| < g` stick and the slip of the
//! others is opposite to q. docs/friction.md describes the problem for users.
//!
//! | module | contents |
//! |---|---|
//! | [`coefficients`], `half_space`, `compliance`, `near_element`, `series` | influence coefficients, near an element and far from it |
//! | `quadrant` | the coefficients of one box, computed once for all of its operators |
//! | [`Toeplitz`] | products with coefficients of two components, by FFT |
//! | `operators`, `displaced` | the operators of the box around C; displacements at points between the centres of its elements |
//! | `problem`, `plane`, `certificate`, `tangent` | the problem on one grid, its certificate, the prediction of stick and slip |
//! | `tables`, `row_tables`, `row_product` | the caller's coefficients: one table, or one per loaded row; products with the latter |
//! | `rolling_tables` | tables of viscoelastic bodies in steady rolling |
//! | `excess` | a layer between the bodies whose compliance differs between elements |
//! | `pairs`, `beside` | SIMD passes over fields of two components; the extension of residuals beyond C |
//! | `shift`, `discs`, `disc`, `places` | projected conjugate gradients on discs, for given motions; their fields |
//! | `newton`, `step`, `system`, `sweep`, `forces`, `best` | semismooth Newton: steady rolling, given forces, other stalls |
//! | `downhill` | the projected Newton method: for given motions, if the other methods cycle |
//! | `glued` | bounds far above the tractions, which are lowered before the solve |
//! | `balance`, `corral`, `bracket` | the search for the creepages that belong to given forces |
//! | `sensitivity`, `derivatives` | derivatives of the forces by creepages and spin |
//! | [`cross`] | unlike bodies: the coupling of the normal and the tangential problem |
//! | [`law`], `with_law`, `iterate_with_law` | bounds that depend on the slip, and the state of the interface's particles |
//! | `levels`, `interpolation`, `nested` | coarser grids and nested iteration |
//! | `request`, `unit`, `scales`, `take_over`, `solver`, `result`, `last` | the whole solve: request, units, start, result and its copy |

mod balance;
mod beside;
mod best;
mod bracket;
mod certificate;
pub mod coefficients;
mod compliance;
mod corral;
pub mod cross;
mod derivatives;
mod disc;
mod discs;
mod displaced;
mod downhill;
mod excess;
mod forces;
mod glued;
mod half_space;
mod interpolation;
mod iterate_with_law;
mod last;
pub mod law;
mod levels;
mod near_element;
mod nested;
mod newton;
mod operators;
mod pairs;
mod places;
mod plane;
mod problem;
mod quadrant;
mod request;
mod result;
mod rolling_tables;
mod row_product;
mod row_tables;
mod scales;
mod sensitivity;
mod series;
mod shift;
mod solution;
mod solver;
mod step;
mod sweep;
mod system;
mod tables;
mod take_over;
mod tangent;
mod toeplitz;
mod unit;
mod with_law;

pub(crate) use bracket::FINISHING_PRODUCTS;
pub use certificate::Certificate;
pub use coefficients::{Compliance, Tangential};
pub use cross::{Coupling, CrossTables, Source};
pub use last::Last;
pub use law::Particle;
pub use plane::{dot, length, Vector};
pub use request::{Request, Start};
pub use rolling_tables::rolling_tables;
pub use solution::{Report, Solution, EXTERIOR, PLASTIC, SLIP, STICK};
pub use solver::Solver;
pub use toeplitz::Toeplitz;
