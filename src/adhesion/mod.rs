//! Adhesion: attractive tractions across the gap between the bodies (docs/adhesion.md).
//!
//! ```text
//! e = h - approach + A p,    p = q - sigma(e),    q >= 0,  e >= 0,  q e = 0
//! ```
//!
//! with total pressures p, contact pressures q, and the attraction sigma. Negative p pull. Stable states are local minima of the energy `1/2 (p,
//! A p) - sum W(e)`, less the work of a prescribed force. One load may have several stable states, and in a load step the bodies may snap from
//! one to another. States that change continuously with the approach form a branch.
//!
//! | module | contents |
//! |---|---|
//! | `law` | the laws of attraction |
//! | `unknowns`, `level`, `levels` | unknowns and residuals of one grid; its operator and preconditioner; the grids of nested iteration |
//! | `newton`, `system`, `parts` | semismooth Newton steps; their linear systems, by flexible GMRES; linear systems with a small tolerance |
//! | `majorise`, `robust` | descent by contact problems with frozen attraction; Newton's method with this descent as its fallback |
//! | `nested` | nested iteration; starts from bodies in contact and from bodies apart |
//! | `pull`, `path`, `states`, `held` | continuation to the pull-off; its steps; states along it; the stable state of a prescribed force |
//! | `stability`, `tangent` | the stability margin 1 - lambda; dF/dapproach and a test of stability |
//! | `start`, `begin` | the options of a start without an initial state; solves without an initial state |
//! | `request`, `solver`, `report` | what a solve is asked for; the solve; its results |
//! | `split` | contact pressures and attraction of a result, from its total pressures |

mod begin;
mod held;
mod law;
mod level;
mod levels;
mod majorise;
mod nested;
mod newton;
mod parts;
mod path;
mod pull;
mod report;
mod request;
mod robust;
mod solver;
mod split;
mod stability;
mod start;
mod states;
mod system;
mod tangent;
mod unknowns;

pub use law::{Attraction, Law};
pub use level::Frozen;
pub use levels::Surfaces;
pub use report::{Report, LARGEST_BORDER_SHARE, RESOLVED, UNSTABLE_KAPPA};
pub use request::{InitialState, Request};
pub use solver::Solver;
pub use split::Split;
pub use start::Start;
