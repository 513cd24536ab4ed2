//! The tangential problem: tractions q on C with `|q| <= g = mu p`, and slip opposite to them. docs/friction.md describes it.
//!
//! | module | contents |
//! |---|---|
//! | [`coefficients`], `half_space`, `compliance`, `near_element`, `series`, `quadrant` | influence coefficients of tangential tractions: their sources, near and far from an element; those kept for all operators |
//! | [`Toeplitz`] | products of two components, by FFT |
//! | `operators`, `displaced` | the operators of the box around C, and displacements between its centres |
//! | `problem`, `plane`, `certificate`, `tangent` | the problem on one grid, its certificate, stick and slip |
//! | `tables`, `row_tables`, `row_product` | the caller's coefficients, also per loaded row, and products with these |
//! | `rolling_tables` | tables of bodies that relax and roll steadily |
//! | `excess` | a layer between the bodies that differs between elements |
//! | `pairs`, `beside` | SIMD passes over fields by component, extension of residuals beyond C; fields of pairs: `methods::fields` |
//! | `shift`, `discs`, `disc`, `places` | projected conjugate gradients on discs, for given motions; their fields, on C alone |
//! | `newton`, `step`, `system`, `sweep`, `forces`, `best` | semismooth Newton, for steady rolling, for given forces and if the gradients stall |
//! | `downhill` | projected Newton, for given motions if the other methods cycle |
//! | `glued` | bounds that no traction reaches |
//! | `balance`, `corral`, `bracket` | creepages of given forces if Newton's method stalls |
//! | `sensitivity`, `derivatives` | derivatives of the forces by creepages and spin |
//! | [`cross`] | unlike bodies: the coupling of the normal and the tangential problem |
//! | [`law`], `with_law`, `iterate_with_law` | bounds that depend on the slip, and the state of the interface's particles |
//! | `levels`, `interpolation`, `nested`, `request`, `unit`, `scales`, `take_over`, `solver`, `result`, `last` | coarser grids, nested iteration, units, the whole solve, and its undoing |

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
