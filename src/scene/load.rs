//! The load that presses the bodies together.

use crate::error::{invalid, Error, Number, Result};

/// The load: either the approach of the bodies or the normal force is prescribed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// The approach (penetration) in `e = h - approach + A p`.
    Approach(f64),
    /// The normal force, `sum of p dx dy`. The approach is then an unknown. A force may be negative (tension) only on a given contact area or with
    /// adhesion.
    Force(f64),
}

impl Load {
    /// Refuses a load that is not finite.
    pub fn check(&self) -> Result<()> {
        let (name, value) = match *self {
            Load::Approach(approach) => ("approach", approach),
            Load::Force(force) => ("force", force),
        };
        if !value.is_finite() {
            return Err(Error::NotFinite(format!("{name} is {value}; it must be finite")));
        }
        Ok(())
    }

    /// Refuses a negative force, unless `is_fixed`. Callers also set `is_fixed` for scenes with adhesion.
    pub fn check_sign(&self, is_fixed: bool) -> Result<()> {
        match *self {
            Load::Force(force) if force < 0.0 && !is_fixed => invalid(format!(
                "force is {}; it must not be negative: an elastic contact does not pull, only a given contact area (active_set FIXED) or adhesion with a work above 0 does",
                Number(force)
            )),
            _ => Ok(()),
        }
    }
}
