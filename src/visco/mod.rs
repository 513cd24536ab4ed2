//! Bodies that relax: Prony series, and one step of time of them.
//!
//! The shear modulus of a body falls from G at once to less, at a constant Poisson ratio:
//!
//! ```text
//! G(t) = G (1 - sum of r_k (1 - exp(-t/t_k))),   r_k = G_k/G,   sum of r_k <= 1
//! ```
//!
//! Each branch k is a spring and a dashpot in series. With w, what the body would give way at once (its share of A p), and q_k, what the dashpots
//! have given way,
//!
//! ```text
//! u = w + sum of r_k q_k,     t_k dq_k/dt = u - q_k
//! ```
//!
//! So a step is linear in q, in w before it and in w after it ([`Map`]): an elastic problem with another compliance and a displacement that is known.
//! (The same equations with stresses of the branches in the place of q: Kaliske & Rothert 1997; of contact: Panek & Kalker 1980.)

mod map;
mod modes;
pub(crate) mod rolling;
mod series;

pub use map::{Form, Map};
pub use rolling::{rolling_table, RollingBody};
pub use series::{Series, MOST};

/// The results of a step in time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// Since the bodies were at rest.
    pub time: f64,
    /// The difference of the form of the step and another one: rms of the displacements in contact, over that of h - approach.
    pub step_error: f64,
    /// The same of all steps since then, added up as lengths: nothing of them is taken for forgotten.
    pub time_error: f64,
    /// The compliance of the bodies in the step, in that at once.
    pub compliance: f64,
}
