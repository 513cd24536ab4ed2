//! Effect: a thin compliant layer between the bodies, `e = h - approach + A p + c p`: a coating, a paint, compliant roughness.

use super::effect::{Effect, Value};
use super::properties::{Properties, Stresses};
use crate::error::{not_negative, Result};
use crate::grid::{check_values, Grid};
use crate::influence::{self, Coefficients};
use crate::scene::Plain;

/// The compliance c of the layer: length per pressure, as influence coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Layer<'a> {
    /// The same everywhere.
    Uniform(f64),
    /// One per element, `[my][mx]`.
    PerElement(&'a [f64]),
}

impl Layer<'_> {
    /// Whether the compliance is 0 everywhere. Then there is no layer.
    fn is_rigid(&self) -> bool {
        match self {
            Layer::Uniform(c) => *c == 0.0,
            Layer::PerElement(c) => c.iter().all(|c| *c == 0.0),
        }
    }
}

impl Effect for Layer<'_> {
    fn name(&self) -> &'static str {
        "layer"
    }

    fn properties(&self) -> Properties<'_> {
        Properties {
            excludes: &[],
            without_multigrid: matches!(self, Layer::PerElement(_)).then_some("a layer of one compliance per element"),
            with_given_area: true,
            one_grid: None,
            own_coefficients: None,
            repeats: (false, false),
            limits: None,
            is_beside: false,
            continues: None,
        }
    }

    fn check(&self, grid: &Grid) -> Result<()> {
        match self {
            Layer::Uniform(c) => not_negative("layer->compliance", *c),
            Layer::PerElement(c) => check_values("layer->compliances", c, grid, not_negative),
        }
    }

    fn gives_way(&self, _scene: &Plain<'_>) -> bool {
        !self.is_rigid()
    }

    fn apply(&self, coefficients: Coefficients) -> Result<Coefficients> {
        let layer = match self {
            layer if layer.is_rigid() => return Ok(coefficients),
            Layer::Uniform(c) => influence::Layer::uniform(*c),
            Layer::PerElement(c) => influence::Layer::per_element(c, coefficients.self_influence())?,
        };
        Ok(coefficients.with_layer(layer))
    }

    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>)) {
        match self {
            layer if layer.is_rigid() => {}
            Layer::Uniform(c) => tell("layer->compliance", Value::Number(*c)),
            Layer::PerElement(c) => tell("layer->compliances", Value::Array(c)),
        }
    }

    fn stresses(&self, _b: usize, _scene: &Plain<'_>) -> Stresses<'_> {
        Stresses::Same
    }
}
