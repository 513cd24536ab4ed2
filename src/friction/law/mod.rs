//! Bounds that depend on the slip: falling laws of friction, and a layer that hardens or softens.
//!
//! ```text
//! stick: s = 0, |q| <= g(0)        slip: q = -g(|s|) s/|s|        outside C: q = 0
//! ```
//!
//! with `g = min(mu p, yield limit + hardening |s|)`, mu by a [`FrictionLaw`](crate::effects::FrictionLaw). mu and the yield limit are transported
//! with the particles of the interface: in steady rolling along the direction of rolling from the leading edge, otherwise from the step before.
//! Creepages or forces are prescribed. Coulomb's friction does not use this module.
//!
//! If bounds fall with the slip, there may be several solutions. This module finds one. A single element has one solution if the largest slope of g
//! times its coefficient on itself (`law_slope` of a report) is below 1. From 0.5 on the iteration may end without its certificate.
//!
//! | module | contents |
//! |---|---|
//! | `element` | bounds, particles, and the slip for a traction |
//! | `bounds` | bounds from slips, and their residuals |
//! | `march` | transport by particles from element to element |
//! | `slope` | the steepest slope of bounds |
//! | `system`, `stages` | Newton steps with the derivatives of bounds; the solve |
//! | `branch` | named solutions, if there are several |

/// From this `law_slope` on there may be several solutions, and the iteration may end without its certificate.
pub const STEEP: f64 = 0.5;
/// From this slope times an element's influence on itself on, bounds rise too steeply to lag behind the slips: both would alternate. On 40 x 40
/// elements, which move together, they alternate from 0.1 on.
const RISING: f64 = 0.05;

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
