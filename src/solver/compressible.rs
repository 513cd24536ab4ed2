//! Coefficients with a constant, without which a given force is solved: see [`compression`](super::compression).

use crate::influence::Coefficients;
use crate::scene::Load;

/// Coefficients with a constant, and whether the solver is set up without it.
#[derive(Clone)]
pub struct Compressible {
    pub coefficients: Coefficients,
    /// Whether the solver is set up without the constant. None after a change that failed.
    pub is_without: Option<bool>,
}

impl Compressible {
    /// The coefficients for a load, and the compressible ones if there is a constant.
    pub fn of(coefficients: Coefficients, load: Load) -> (Coefficients, Option<Compressible>) {
        let Some(without) = coefficients.without_constant() else { return (coefficients, None) };
        let is_without = matches!(load, Load::Force(_));
        let used = if is_without { without } else { coefficients.clone() };
        (used, Some(Compressible { coefficients, is_without: Some(is_without) }))
    }

    /// The compression by a uniform pressure that adds up to this over all elements.
    pub fn by(&self, sum: f64) -> f64 {
        self.coefficients.kernel().constant() * sum
    }
}
