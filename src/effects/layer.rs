//! Effect: a thin compliant layer between the bodies, `e = h - approach + A p + c p`: a coating, a paint, compliant roughness.

use super::each::Each;
use super::effect::{Effect, Value};
use super::properties::{Properties, Stresses};
use crate::error::{not_negative, Result};
use crate::grid::Grid;
use crate::influence::{self, Coefficients};
use crate::scene::Plain;

/// The compliance c of the layer: a length per pressure, as influence coefficients have. If c is 0 on all elements, there is no layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer<'a>(pub Each<'a>);

impl Effect for Layer<'_> {
    fn name(&self) -> &'static str {
        "layer"
    }

    fn properties(&self) -> Properties<'_> {
        Properties {
            excludes: &[],
            without_multigrid: self.0.per_element().map(|_| "a layer of one compliance per element"),
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
        self.0.check(["layer->compliance", "layer->compliances"], grid, not_negative)
    }

    fn gives_way(&self, _scene: &Plain<'_>) -> bool {
        !self.0.is_zero()
    }

    fn apply(&self, coefficients: Coefficients) -> Result<Coefficients> {
        let layer = match self.0 {
            c if c.is_zero() => return Ok(coefficients),
            Each::Uniform(c) => influence::Layer::uniform(c),
            Each::PerElement(c) => influence::Layer::per_element(c, coefficients.self_influence())?,
        };
        Ok(coefficients.with_layer(layer))
    }

    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>)) {
        match self.0 {
            c if c.is_zero() => {}
            Each::Uniform(c) => tell("layer->compliance", Value::Number(c)),
            Each::PerElement(c) => tell("layer->compliances", Value::Array(c)),
        }
    }

    fn stresses(&self, _b: usize, _scene: &Plain<'_>) -> Stresses<'_> {
        Stresses::Same
    }
}
