//! A value for each element, uniform or not.

use crate::error::Result;
use crate::grid::{check_values, Grid};

/// A value for each element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Each<'a> {
    /// One value for all elements.
    Uniform(f64),
    /// One per element, `[my][mx]`.
    PerElement(&'a [f64]),
}

impl<'a> Each<'a> {
    /// The values `each` if they are given, otherwise `uniform`.
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

    /// Whether it is 0 everywhere.
    pub fn is_zero(&self) -> bool {
        match self {
            Each::Uniform(value) => *value == 0.0,
            Each::PerElement(values) => values.iter().all(|value| *value == 0.0),
        }
    }

    /// The values, if they are given per element.
    pub fn per_element(&self) -> Option<&'a [f64]> {
        match self {
            Each::Uniform(_) => None,
            Each::PerElement(values) => Some(values),
        }
    }

    /// Checks all values by `require`. `one` and `each` are the names in messages of the uniform value and of the values per element.
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
