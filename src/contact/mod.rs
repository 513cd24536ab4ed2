//! The state of a solve (pressures, displacements, contact area), the exchange of elements between contact and exterior area (steps (4.1) and (4.2)
//! of the paper), and the certificate.

mod admissible;
mod balance;
mod bearing_area;
mod certificate;
mod exchange;
mod guard;
mod operators;
mod outline;
mod problem;
mod snapshot;
mod start;
mod state;
mod survey_pass;
mod values;

pub use admissible::{AdmissibleSet, Fixed, NonNegative};
pub(crate) use balance::CANCELLED;
pub use bearing_area::UNDECIDED_SHARE;
pub use certificate::{largest, norm_of_distance, relative, residual_norm, Certificate, Survey, ROUND_OFF};
pub use exchange::{admit, all_stay, enter, leave, truncate};
pub use guard::ExchangeGuard;
pub(crate) use outline::STRAIGHT;
pub use outline::{touching, Outline};
pub use problem::{Problem, PRODUCT_ROUND_OFF};
pub use snapshot::Snapshot;
pub use state::State;
pub use values::{lowest, presses, Freshness};
