//! The largest coefficient of a table, and how far the table is from symmetric: found while its rows are near.

/// Values that are looked at together: that the compiler can vectorise.
const LANES: usize = 8;

/// Round-off allowed in a symmetric table, relative to its largest coefficient: single-precision tables pass.
pub(crate) const SYMMETRY: f64 = 1e-7;

/// Of some coefficients, none at first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Extremes {
    /// The largest, whatever its sign.
    pub largest: f64,
    /// The largest difference `|c(k) - c(-k)|`.
    asymmetry: f64,
    /// Of zero times all coefficients: 0 as long as they are finite.
    sum: f64,
}

impl Extremes {
    /// Of an even table, or some rows of it.
    pub fn of_even(values: &[f64]) -> Extremes {
        let sum = if are_finite(values, 1.0) { 0.0 } else { f64::NAN };
        Extremes { largest: largest(values), asymmetry: 0.0, sum }
    }

    /// Of a row and the opposite one, both of all offsets in x.
    pub fn of_opposite(row: &[f64], opposite: &[f64]) -> Extremes {
        pulp::Arch::new().dispatch(Opposite { row, opposite })
    }

    /// Of all rows, `2 my - 1`, of a table that is not even.
    pub fn of_rows<'a>(rows: impl DoubleEndedIterator<Item = &'a [f64]> + Clone, my: usize) -> Extremes {
        let pairs = rows.clone().zip(rows.rev()).take(my);
        pairs.fold(Extremes::default(), |all, (row, opposite)| all.and(Extremes::of_opposite(row, opposite)))
    }

    /// Of these and others.
    pub fn and(&self, others: Extremes) -> Extremes {
        Extremes {
            largest: larger(self.largest, others.largest),
            asymmetry: larger(self.asymmetry, others.asymmetry),
            sum: self.sum + others.sum,
        }
    }

    /// Whether all are finite.
    pub fn are_finite(&self) -> bool {
        self.sum == 0.0
    }

    /// Whether the coefficients are symmetric, to within round-off of one that is `large`.
    pub fn are_symmetric_beside(&self, large: f64) -> bool {
        self.asymmetry <= SYMMETRY * large
    }
}

/// A row and the opposite one. Compiled for the vectors of this machine.
struct Opposite<'a> {
    row: &'a [f64],
    opposite: &'a [f64],
}

impl pulp::NullaryFnOnce for Opposite<'_> {
    type Output = Extremes;

    #[inline(always)]
    fn call(self) -> Extremes {
        let Opposite { row, opposite } = self;
        let (mut lanes, mut rest) = ([[0.0; LANES]; 3], [0.0; 3]);
        let (row, opposite) = (row.chunks_exact(LANES), opposite.rchunks_exact(LANES));
        for (a, b) in row.remainder().iter().zip(opposite.remainder().iter().rev()) {
            rest = looked_at(rest, *a, *b);
        }
        for (a, b) in row.zip(opposite) {
            for lane in 0..LANES {
                let (a, b) = (a[lane], b[LANES - 1 - lane]);
                let of_lane = looked_at([lanes[0][lane], lanes[1][lane], lanes[2][lane]], a, b);
                (lanes[0][lane], lanes[1][lane], lanes[2][lane]) = (of_lane[0], of_lane[1], of_lane[2]);
            }
        }
        let [largest, asymmetry] = [0, 1].map(|k| lanes[k].into_iter().fold(rest[k], larger));
        Extremes { largest, asymmetry, sum: lanes[2].into_iter().fold(rest[2], |sum, value| sum + value) }
    }
}

#[inline(always)]
fn looked_at([largest, asymmetry, sum]: [f64; 3], a: f64, b: f64) -> [f64; 3] {
    let both = larger(a.abs(), b.abs());
    [larger(both, largest), larger((a - b).abs(), asymmetry), sum + 0.0 * a + 0.0 * b]
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b {
        a
    } else {
        b
    }
}

/// Whether all are finite, looked at many at a time.
pub(super) fn are_finite(values: &[f64], scale: f64) -> bool {
    values.iter().fold(true, |all, value| all & (scale * value).is_finite())
}

/// The largest of some values, whatever their sign.
pub(super) fn largest(values: &[f64]) -> f64 {
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
