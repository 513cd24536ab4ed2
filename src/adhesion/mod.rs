//! Adhesion: attractive forces across the gap (docs/adhesion.md).
//!
//! ```text
//! e = h - approach + A p,    p = q - sigma(e),    q >= 0,  e >= 0,  q e = 0
//! ```
//!
//! with total pressures p, contact pressures q, and the attraction sigma. Negative p pull. Stable states are local minima of
//! `1/2 (p, A p) - sum W(e)`, minus the work of a prescribed force. There may be several, and a load step may snap from one to another.
//!
//! | module | contents |
//! |---|---|
//! | `law` | the laws of attraction |
//! | `unknowns`, `level`, `levels` | the unknowns of one grid and their residuals; operator and preconditioner; all grids |
//! | `newton`, `system`, `parts` | semismooth Newton with flexible GMRES, bordered for a prescribed force; linear systems with a small tolerance |
//! | `majorise`, `robust` | descent by contact problems with fixed attraction, and Newton's method with this descent as its fallback |
//! | `nested` | nested iteration; the starts from contact and from apart |
//! | `pull`, `way`, `place`, `held` | continuation to the pull-off, its steps, and states on it; the stable state of a force |
//! | `stability`, `tangent` | the distance of a state from a snap; dF/dapproach of a state, and its stability |
//! | `start`, `begin` | the starts without a previous state |
//! | `request`, `solver`, `report` | the whole solve |
//! | `split` | the pressures of a result, split into contact pressures and attraction |

mod begin;
mod held;
mod law;
mod level;
mod levels;
mod majorise;
mod nested;
mod newton;
mod parts;
mod place;
mod pull;
mod report;
mod request;
mod robust;
mod solver;
mod split;
mod stability;
mod start;
mod system;
mod tangent;
mod unknowns;
mod way;

pub use law::{Attraction, Law};
pub use level::Frozen;
pub use levels::Surfaces;
pub use report::{Report, LARGEST_BORDER_SHARE, RESOLVED, UNSTABLE_KAPPA};
pub use request::{Request, State};
pub use solver::Solver;
pub use split::Split;
pub use start::Start;
