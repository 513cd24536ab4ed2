//! Influence coefficients that contain a constant. A given force is solved without the constant: see [`compression`](super::compression).

use crate::influence::Coefficients;
use crate::scene::Load;

/// Influence coefficients that contain a constant, and which ones the solver uses now.
#[derive(Clone)]
pub struct Compressible {
    /// The coefficients with the constant.
    pub coefficients: Coefficients,
    /// Whether the operators of the solver are those without the constant. None if the last change of the operators failed.
    pub is_without: Option<bool>,
}

impl Compressible {
    /// Returns the coefficients to use for a load, and, if they have a constant, the record of both.
    pub fn of(coefficients: Coefficients, load: Load) -> (Coefficients, Option<Compressible>) {
        let Some(without) = coefficients.without_constant() else { return (coefficients, None) };
        let is_without = matches!(load, Load::Force(_));
        let used = if is_without { without } else { coefficients.clone() };
        (used, Some(Compressible { coefficients, is_without: Some(is_without) }))
    }

    /// The displacement of every element by the constant, for pressures with the sum `sum` over all elements.
    pub fn by(&self, sum: f64) -> f64 {
        self.coefficients.kernel().constant() * sum
    }
}
