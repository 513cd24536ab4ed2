//! Closed forms: what numerical answers are held to.

mod hertz;

pub use hertz::{hertz, hertz_by_force, Hertz};
