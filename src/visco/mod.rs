//! Relaxing bodies: Prony series, and one step in time.
//!
//! The shear modulus of a body decreases from the instantaneous G, at a constant Poisson ratio:
//!
//! ```text
//! G(t) = G (1 - sum of r_k (1 - exp(-t/t_k))),   r_k = G_k/G,   sum of r_k <= 1
//! ```
//!
//! Each branch k is a spring and a dashpot in series. With w, the instantaneous displacement of the body (its share of A p), and q_k, the
//! displacements of the dashpots,
//!
//! ```text
//! u = w + sum of r_k q_k,     t_k dq_k/dt = u - q_k
//! ```
//!
//! So a step is linear in q, in w before it and in w after it ([`Map`]): an elastic problem with another compliance and a known displacement.
//! (The same equations with stresses of the branches instead of q: Kaliske & Rothert 1997; for contact: Panek & Kalker 1980.)

mod map;
mod modes;
pub(crate) mod rolling;
mod series;

pub use map::{Form, Map};
pub use rolling::{rolling_table, RollingBody};
pub use series::{Series, MOST_BRANCHES};

/// The results of a step in time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// The time since the bodies were at rest.
    pub time: f64,
    /// An estimate of the error of the step: the difference between its displacements in contact and those by another
    /// form of the step, as rms over that of h - approach.
    pub step_error: f64,
    /// The step errors of all steps since rest, added up as lengths, without decay.
    pub time_error: f64,
    /// The compliance of the bodies in the step, relative to the instantaneous one.
    pub compliance: f64,
}
