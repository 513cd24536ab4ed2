//! Bounds that depend on the slip: laws of friction that fall, and a layer that hardens or softens.
//!
//! ```text
//! stick: s = 0, |q| <= g(0)        slip: q = -g(|s|) s/|s|        outside C: q = 0
//! ```
//!
//! with `g = min(mu p, yield limit + hardening |s|)`, mu by a [`FrictionLaw`](crate::effects::FrictionLaw). mu and the yield limit are carried with
//! the particles of the interface: in steady rolling along each row from the leading edge, else from the step before. Creepages or forces are
//! given. Coulomb's friction does not come here.
//!
//! Where bounds fall there may be several solutions; this finds one. A single element has one where the largest slope of g times its
//! influence on itself (`law_slope` of a report) is below 1; from .5 on the iteration may end without its certificate.
//!
//! | module | what it holds |
//! |---|---|
//! | `element` | bounds, particles, and the slip that goes with a traction |
//! | `bounds` | bounds by slips, and what they leave |
//! | `march` | what particles carry from element to element |
//! | `slope` | how steeply bounds fall |
//! | `system`, `stages` | Newton steps with the derivatives of bounds; the solve |
//! | `branch` | solutions by name, where there are several |

/// From this `law_slope` on the iteration may end without its certificate.
pub const STEEP: f64 = 0.5;

mod bounds;
pub(super) mod branch;
mod element;
mod march;
pub(super) mod slope;
pub(super) mod stages;
mod system;

pub use element::Particle;
pub(super) use element::{Law, Place};
pub(super) use march::March;
