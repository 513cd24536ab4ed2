//! Adhesion: attractive forces across the gap. docs/adhesion.md says what it computes.
//!
//! ```text
//! e = h - approach + A p,    p = q - sigma(e),    q >= 0,  e >= 0,  q e = 0
//! ```
//!
//! with total pressures p, which pull where they are negative, contact pressures q, and the attraction sigma. Stable states are local minima of
//! `1/2 (p, A p) - sum W(e)`, less the work of a force that is given; there may be several, and a step of the load may snap from one to another.
//!
//! | module | what it holds |
//! |---|---|
//! | `law` | the laws of attraction |
//! | `unknowns`, `level`, `levels` | the unknowns of one grid and how well the conditions hold; operator and preconditioner; all grids |
//! | `newton`, `system`, `parts` | semismooth Newton with flexible GMRES, bordered where the force is given; linear systems that are solved firmly |
//! | `majorise`, `robust` | descent by contact problems whose attraction stands still, and Newton's method with that behind it |
//! | `nested` | nested iteration; the starts from contact and from apart |
//! | `pull`, `way`, `place`, `held` | the way down to the pull-off, its steps, and states on it; the stable state of a force |
//! | `stability`, `tangent` | how near a state is to a snap; how its force changes with the approach, and whether it is stable |
//! | `begin` | the starts from nothing |
//! | `request`, `solver`, `report` | the whole solve |

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
mod stability;
mod system;
mod tangent;
mod unknowns;
mod way;

pub use law::{Attraction, Law};
pub use level::Frozen;
pub use levels::Surfaces;
pub use report::{Report, CONTAINED, RESOLVED, UNSTABLE};
pub use request::{Request, Start, State};
pub use solver::Solver;
