//! Exact solutions, with which numerical results are compared.

mod hertz;

pub use hertz::{hertz, hertz_by_force, Hertz};
