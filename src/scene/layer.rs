//! Effect: a thin compliant layer between the bodies, `e = h - approach + A p + c p`: a coating, a paint, roughness that gives way.

use crate::error::{invalid, Error, Result};
use crate::grid::Grid;
use crate::influence::{Influence, Layered};

/// The compliance c of the layer, a length per pressure: of the same kind as influence coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Layer<'a> {
    /// The same everywhere.
    Uniform(f64),
    /// One per element, `[my][mx]`.
    PerElement(&'a [f64]),
}

impl Layer<'_> {
    /// Refuses what is no compliance.
    pub(super) fn check(&self, grid: &Grid) -> Result<()> {
        let require = |name: &dyn Fn() -> String, c: f64| match c {
            c if !c.is_finite() => Err(Error::NotFinite(format!("{} is {c}; it must be finite", name()))),
            c if c < 0.0 => invalid(format!("{} is {c}; a compliance must not be negative", name())),
            _ => Ok(()),
        };
        match self {
            Layer::Uniform(c) => require(&|| "layer->compliance".into(), *c),
            Layer::PerElement(c) if c.len() != grid.len() => {
                invalid(format!("layer->compliances has {} values; the grid has {} elements", c.len(), grid.len()))
            }
            Layer::PerElement(c) => c.iter().enumerate().try_for_each(|(i, c)| {
                require(&|| format!("layer->compliances of element ({}, {})", i % grid.mx, i / grid.mx), *c)
            }),
        }
    }

    /// Whether it gives way nowhere: then it is none.
    pub(super) fn is_rigid(&self) -> bool {
        match self {
            Layer::Uniform(c) => *c == 0.0,
            Layer::PerElement(c) => c.iter().all(|c| *c == 0.0),
        }
    }

    /// The coefficients with this layer.
    pub(super) fn on(&self, base: Influence) -> Influence {
        match self {
            layer if layer.is_rigid() => base,
            Layer::Uniform(c) => Influence::Layered(Layered::uniform(base, *c)),
            Layer::PerElement(c) => Influence::Layered(Layered::per_element(base, c)),
        }
    }
}
