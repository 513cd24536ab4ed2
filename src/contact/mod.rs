//! The active set: which elements are in contact, steps 4.1 and 4.2 of the paper, and how well the conditions hold.

pub mod admissible;
mod balance;
mod certificate;
mod exchange;
mod guard;
mod limited;
mod outline;
mod state;

pub use certificate::{certify, norm_of_distance, residual_norm, Certificate, Survey};
pub use exchange::{admit, starting_contact, truncate};
pub use guard::ExchangeGuard;
pub use outline::Outline;
pub use state::{Freshness, State};
