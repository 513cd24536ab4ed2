//! The largest absolute coefficient of a table, its symmetry and finiteness, found while its rows are in cache.

use crate::blocks::LANES;

pub(super) use toeplitz::coefficients::SYMMETRY;

/// The extremes of a table or a part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extremes {
    /// The largest absolute value of a coefficient.
    pub largest: f64,
    /// Whether the coefficients are symmetric, to within round-off of the one at offset (0, 0).
    pub symmetric: bool,
    /// Whether the coefficients are finite.
    pub finite: bool,
}

impl Extremes {
    /// The extremes of no values.
    pub const NONE: Extremes = Extremes { largest: 0.0, symmetric: true, finite: true };

    /// The extremes of an even table or some of its rows.
    pub fn of_even(values: &[f64]) -> Extremes {
        Extremes { largest: largest(values), symmetric: true, finite: are_finite(values, 1.0) }
    }

    /// The extremes of a row and the opposite one, both at all offsets in x; `large`: the coefficient at offset (0, 0).
    pub fn of_opposite(row: &[f64], opposite: &[f64], large: f64) -> Extremes {
        pulp::Arch::new().dispatch(Opposite { row, opposite, large })
    }

    /// The extremes of all `2 my - 1` rows of a table that is not even.
    pub fn of_rows<'a>(rows: impl DoubleEndedIterator<Item = &'a [f64]> + Clone, my: usize, large: f64) -> Extremes {
        let pairs = rows.clone().zip(rows.rev()).take(my);
        pairs.fold(Extremes::NONE, |all, (row, opposite)| all.and(Extremes::of_opposite(row, opposite, large)))
    }

    /// The extremes of both together.
    pub fn and(&self, others: Extremes) -> Extremes {
        Extremes {
            largest: self.largest.max(others.largest),
            symmetric: self.symmetric & others.symmetric,
            finite: self.finite & others.finite,
        }
    }
}

/// A row and the opposite one. Compiled for the vectors of this machine.
struct Opposite<'a> {
    row: &'a [f64],
    opposite: &'a [f64],
    large: f64,
}

impl pulp::NullaryFnOnce for Opposite<'_> {
    type Output = Extremes;

    #[inline(always)]
    fn call(self) -> Extremes {
        let Opposite { row, opposite, large } = self;
        Extremes {
            largest: f64::max(largest(row), largest(opposite)),
            symmetric: are_symmetric(row, opposite, large),
            finite: are_finite(row, 1.0) & are_finite(opposite, 1.0),
        }
    }
}

/// Whether a row is the opposite one reversed, to within round-off of a coefficient `large`.
#[inline(always)]
pub(super) fn are_symmetric(row: &[f64], opposite: &[f64], large: f64) -> bool {
    let allowed = SYMMETRY * large;
    row.iter().zip(opposite.iter().rev()).fold(true, |all, (a, b)| all & ((a - b).abs() <= allowed))
}

/// Whether all scaled values are finite, tested in vectors.
#[inline(always)]
pub(super) fn are_finite(values: &[f64], scale: f64) -> bool {
    values.iter().fold(true, |all, value| all & (scale * value).is_finite())
}

/// The largest absolute value.
#[inline(always)]
pub(super) fn largest(values: &[f64]) -> f64 {
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let mut largest = [0.0; LANES];
    let blocks = values.chunks_exact(LANES);
    let rest = blocks.remainder().iter().fold(0.0, |largest, value| larger(value.abs(), largest));
    for block in blocks {
        for lane in 0..LANES {
            largest[lane] = larger(block[lane].abs(), largest[lane]);
        }
    }
    largest.into_iter().fold(rest, larger)
}
