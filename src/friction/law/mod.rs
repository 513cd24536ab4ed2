//! Traction bounds that depend on the slip: laws of friction whose coefficient falls, and a plastic layer that hardens or softens.
//!
//! ```text
//! stick: s = 0, |q| <= g(0)        slip: q = -g(|s|) s/|s|        outside C: q = 0
//! ```
//!
//! with `g = min(mu p, yield limit + hardening |s|)`. mu depends on |s| by a [`FrictionLaw`](crate::effects::FrictionLaw), and may depend on the mu
//! before the step. mu and the yield limit are properties of particles of the interface, which move through the contact: in steady rolling a particle
//! enters at the leading edge and passes from element to element; otherwise its state is that after the step before. Creepages or forces are given.
//! Coulomb's friction does not use this module.
//!
//! If bounds fall with the slip, there may be several solutions. This module finds one. A single element has one solution if the largest slope of g
//! times its coefficient on itself (`law_slope` of a report) is below 1. From 0.5 on the iteration may end without its certificate.
//!
//! | module | contents |
//! |---|---|
//! | `element` | one element: its bound and particle as functions of the slip, and the slip that belongs to a traction |
//! | `march` | the transport of particles from element to element |
//! | `bounds` | the bounds of all elements from their slips, and the residuals with these bounds |
//! | `slope` | the steepest slopes with which bounds fall and rise |
//! | `system`, `stages` | Newton steps with the derivatives of the bounds; the solve |
//! | `branch` | the solutions LOW and HIGH, by turns |

/// From this `law_slope` on there may be several solutions, and the iteration may end without its certificate.
pub const STEEP: f64 = 0.5;
/// Bounds rise steeply if their slope times an element's influence on itself is more than this. Then bounds must not be computed from the slips of
/// the step before, because bounds and slips would alternate. On 40 x 40 elements, which move together, they alternate from 0.1 on.
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
