//! A quantity that has a value on each element: one value for all elements, or an array.

use crate::error::Result;
use crate::grid::{check_values, Grid};

/// A quantity that has a value on each element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Each<'a> {
    /// One value for all elements.
    Uniform(f64),
    /// One value for each element, `[my][mx]`.
    PerElement(&'a [f64]),
}

impl<'a> Each<'a> {
    /// The array `each` if it is given, otherwise the value `uniform` for all elements.
    pub fn of(each: Option<&'a [f64]>, uniform: f64) -> Each<'a> {
        each.map_or(Each::Uniform(uniform), Each::PerElement)
    }

    /// The value at element i.
    #[inline]
    pub fn at(&self, i: usize) -> f64 {
        match self {
            Each::Uniform(value) => *value,
            Each::PerElement(values) => values[i],
        }
    }

    /// Whether the value is 0 on all elements.
    pub fn is_zero(&self) -> bool {
        match self {
            Each::Uniform(value) => *value == 0.0,
            Each::PerElement(values) => values.iter().all(|value| *value == 0.0),
        }
    }

    /// The array of values. None: one value holds for all elements.
    pub fn per_element(&self) -> Option<&'a [f64]> {
        match self {
            Each::Uniform(_) => None,
            Each::PerElement(values) => Some(values),
        }
    }

    /// Checks all values by `require`. Messages call a uniform value `one`, and an array `each`.
    pub(crate) fn check(
        &self,
        [one, each]: [&str; 2],
        grid: &Grid,
        require: impl Fn(&str, f64) -> Result<()>,
    ) -> Result<()> {
        match self {
            Each::Uniform(value) => require(one, *value),
            Each::PerElement(values) => check_values(each, values, grid, require),
        }
    }
}
