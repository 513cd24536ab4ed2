//! Viscoelastic bodies whose stresses relax: Prony series, steps in time, and steady rolling.
//!
//! After a step of strain the shear modulus of a body decreases from the instantaneous G, at a constant Poisson ratio:
//!
//! ```text
//! G(t) = G (1 - sum of r_k (1 - exp(-t/t_k))),   r_k = G_k/G,   sum of r_k <= 1
//! ```
//!
//! Each branch k is a spring and a dashpot in series. w is the displacement that the present pressures would cause instantaneously (the body's part
//! of A p), and q_k is the displacement of dashpot k. The displacement u of the body follows from
//!
//! ```text
//! u = w + sum of r_k q_k,     t_k dq_k/dt = u - q_k
//! ```
//!
//! So u after a step of time is linear in q, in w before the step and in w after it ([`Map`]). A step is therefore an elastic problem with another
//! compliance and a known displacement. (Kaliske & Rothert 1997 have the same equations with the stresses of the branches instead of q; for contact
//! see Panek & Kalker 1980.)

mod map;
mod modes;
pub(crate) mod rolling;
mod series;

pub use map::{Form, Map};
pub use rolling::{rolling_table, RollingBody};
pub use series::{Series, MOST_BRANCHES};

/// What a step in time reports.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// The time since the bodies were at rest.
    pub time: f64,
    /// An estimate of the error of the step: the rms in contact of the difference between its displacements and those by another [form](Form) of the
    /// step, relative to the rms of h - approach there.
    pub step_error: f64,
    /// The sum of the errors of all steps since rest, added as lengths, without decay, and relative as `step_error`.
    pub time_error: f64,
    /// The compliance of the bodies in the step, relative to the instantaneous one.
    pub compliance: f64,
}
