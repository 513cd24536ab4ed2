//! Properties of a table: its largest absolute coefficient, whether it is symmetric, and whether all its values are finite. They are found while
//! the rows are in the cache.

use crate::blocks::LANES;

pub(super) use toeplitz::coefficients::SYMMETRY;

/// Properties of a table or of a part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TableProperties {
    /// The largest absolute value of a coefficient.
    pub largest: f64,
    /// Whether `c(k)` and `c(-k)` differ by at most [`SYMMETRY`] times the coefficient at offset (0, 0), which is the largest one in most tables.
    /// `Table::is_symmetric` repeats a failed test with the largest one.
    pub symmetric: bool,
    /// Whether all coefficients are finite.
    pub finite: bool,
}

impl TableProperties {
    /// The properties of no values, with which a fold begins.
    pub const NONE: TableProperties = TableProperties { largest: 0.0, symmetric: true, finite: true };

    /// The properties of an even table or of some of its rows.
    pub fn of_even(values: &[f64]) -> TableProperties {
        TableProperties { largest: largest(values), symmetric: true, finite: are_finite(values, 1.0) }
    }

    /// The properties of the rows at offsets ky and -ky, each at all offsets `1 - mx ..= mx - 1` in x. `reference` is the coefficient at offset
    /// (0, 0).
    pub fn of_opposite(row: &[f64], opposite: &[f64], reference: f64) -> TableProperties {
        pulp::Arch::new().dispatch(Opposite { row, opposite, reference })
    }

    /// The properties of a table that is not even, from its `2 my - 1` rows in order. `reference` is the coefficient at offset (0, 0).
    pub fn of_rows<'a>(
        rows: impl DoubleEndedIterator<Item = &'a [f64]> + Clone,
        my: usize,
        reference: f64,
    ) -> TableProperties {
        let pairs = rows.clone().zip(rows.rev()).take(my);
        pairs.fold(TableProperties::NONE, |all, (row, opposite)| {
            all.and(TableProperties::of_opposite(row, opposite, reference))
        })
    }

    /// The properties of two parts together.
    pub fn and(&self, others: TableProperties) -> TableProperties {
        TableProperties {
            largest: self.largest.max(others.largest),
            symmetric: self.symmetric & others.symmetric,
            finite: self.finite & others.finite,
        }
    }
}

/// The work of [`TableProperties::of_opposite`], which pulp compiles for the vector instructions of the machine.
struct Opposite<'a> {
    row: &'a [f64],
    opposite: &'a [f64],
    reference: f64,
}

impl pulp::NullaryFnOnce for Opposite<'_> {
    type Output = TableProperties;

    #[inline(always)]
    fn call(self) -> TableProperties {
        let Opposite { row, opposite, reference } = self;
        TableProperties {
            largest: f64::max(largest(row), largest(opposite)),
            symmetric: are_symmetric(row, opposite, reference),
            finite: are_finite(row, 1.0) & are_finite(opposite, 1.0),
        }
    }
}

/// Whether `row` is `opposite` in reverse order, up to [`SYMMETRY`] times `reference`.
#[inline(always)]
pub(super) fn are_symmetric(row: &[f64], opposite: &[f64], reference: f64) -> bool {
    let allowed = SYMMETRY * reference;
    row.iter().zip(opposite.iter().rev()).fold(true, |all, (a, b)| all & ((a - b).abs() <= allowed))
}

/// Whether all values times `scale` are finite. The fold has no early exit, so that the compiler vectorises it.
#[inline(always)]
pub(super) fn are_finite(values: &[f64], scale: f64) -> bool {
    values.iter().fold(true, |all, value| all & (scale * value).is_finite())
}

/// The largest absolute value. NaN is ignored.
#[inline(always)]
pub(super) fn largest(values: &[f64]) -> f64 {
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let mut lanes = [0.0; LANES];
    let blocks = values.chunks_exact(LANES);
    let rest = blocks.remainder().iter().fold(0.0, |so_far, value| larger(value.abs(), so_far));
    for block in blocks {
        for lane in 0..LANES {
            lanes[lane] = larger(block[lane].abs(), lanes[lane]);
        }
    }
    lanes.into_iter().fold(rest, larger)
}
