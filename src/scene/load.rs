//! What presses the bodies together.

use crate::error::{invalid, Error, Result};

/// The load: the approach of the bodies or the normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// Prescribed approach (penetration): `e = h - approach + A p`.
    Approach(f64),
    /// Prescribed normal force, `sum of p dx dy`; the approach is found.
    Force(f64),
}

impl Load {
    /// Refuses what is no load.
    pub fn check(&self) -> Result<()> {
        let (name, value) = match *self {
            Load::Approach(approach) => ("approach", approach),
            Load::Force(force) => ("force", force),
        };
        if !value.is_finite() {
            return Err(Error::NotFinite(format!("{name} is {value}; it must be finite")));
        }
        if name == "force" && value < 0.0 {
            return invalid(format!("force is {value}; it must not be negative: an elastic contact does not pull"));
        }
        Ok(())
    }
}
