//! Means of a function over elements, from its values at the centres of the elements.
//!
//! Let d be the central difference between neighbouring centres. For a function that is smooth on the scale of an element,
//!
//! ```text
//! mean f = (d/2)/asinh(d/2) f = (1 + d^2/24 - 17 d^4/5760 + 367 d^6/967680 - 27859 d^8/464486400 + ...) f
//! ```
//!
//! The series is applied in x, then in y, and needs one evaluation of f per element. At 32 elements from a singularity the omitted terms are
//! 1e-12 of f.

use crate::error::Result;
use crate::memory::zeros;

/// The number of neighbours on either side that a mean takes.
pub const HALO: usize = 4;
/// The number of elements that a mean takes in one direction.
pub const ROWS: usize = 2 * HALO + 1;

/// The least distance from a singularity, in longer sides of an element, at which means are computed from the values at centres.
pub const LEAST_DISTANCE: f64 = 32.0;
/// The coefficients of `d^2, d^4, ...` in the series.
const SERIES: [f64; HALO] = [1.0 / 24.0, -17.0 / 5760.0, 367.0 / 967_680.0, -27859.0 / 464_486_400.0];

/// The weights of an element and of its neighbours at distances 1 to 4: the series up to the eighth difference.
const MEAN: [f64; HALO + 1] = {
    let [a, b, c, d] = SERIES;
    [
        1.0 - 2.0 * a + 6.0 * b - 20.0 * c + 70.0 * d,
        a - 4.0 * b + 15.0 * c - 56.0 * d,
        b - 6.0 * c + 28.0 * d,
        c - 8.0 * d,
        d,
    ]
};

/// Means in x along one row: `out[k]` is the mean over the element whose value is `points[k + HALO]`.
pub fn in_x(points: &[f64], out: &mut [f64]) {
    let n = out.len();
    combine(std::array::from_fn(|k| &points[k..k + n]), out);
}

/// Means in y over the elements of the row `middle`. `rows` is a ring of the last [`ROWS`] rows, in which row r is at `r % ROWS`.
pub fn in_y(rows: &[f64], middle: usize, out: &mut [f64]) {
    let n = out.len();
    let slot = |k: usize| (middle - HALO + k) % ROWS;
    combine(std::array::from_fn(|k| &rows[slot(k) * n..(slot(k) + 1) * n]), out);
}

/// Writes the weighted sum of [`ROWS`] neighbouring rows to `out`.
fn combine(rows: [&[f64]; ROWS], out: &mut [f64]) {
    pulp::Arch::new().dispatch(Combine { rows, out });
}

/// The work of [`combine`], which pulp compiles for the vector instructions of the machine.
struct Combine<'a> {
    rows: [&'a [f64]; ROWS],
    out: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Combine<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let ([a, b, c, d, e, f, g, h, i], n) = (self.rows, self.out.len());
        let (a, b, c, d, e) = (&a[..n], &b[..n], &c[..n], &d[..n], &e[..n]);
        let (f, g, h, i) = (&f[..n], &g[..n], &h[..n], &i[..n]);
        for (k, out) in self.out.iter_mut().enumerate() {
            *out = MEAN[0] * e[k]
                + MEAN[1] * (d[k] + f[k])
                + MEAN[2] * (c[k] + g[k])
                + MEAN[3] * (b[k] + h[k])
                + MEAN[4] * (a[k] + i[k]);
        }
    }
}

/// Computes the means of a function that is even in x and y, at the offsets `0..columns` in x and `0..rows` in y.
///
/// * Row ky begins at the offset `first(ky)`, which does not decrease with ky.
/// * `fill(ky, from, values)` writes the function at the offsets `(from.., ky)`.
/// * `each(ky, means)` gets the means of one row after another. Its first valid value is at `first(ky)`.
pub fn means(
    (columns, rows): (usize, usize),
    first: impl Fn(usize) -> usize,
    fill: impl Fn(usize, usize, &mut [f64]),
    mut each: impl FnMut(usize, &[f64]),
) -> Result<()> {
    let memory = "means over elements";
    let mut points = zeros(columns + 2 * HALO, memory)?;
    let mut last = zeros(ROWS * columns, memory)?;
    let mut out = zeros(columns, memory)?;
    for row in 0..rows + 2 * HALO {
        let ky = row.abs_diff(HALO);
        // The values of row ky enter the means of the rows from ky - HALO on. The means of this first row begin at `start`, and the values for
        // them at `from`.
        let start = first(ky.saturating_sub(HALO));
        let from = start.saturating_sub(HALO);
        fill(ky, from, &mut points[HALO + from..]);
        if from == 0 {
            (1..=HALO).for_each(|k| points[HALO - k] = points[HALO + k]);
        }
        let slot = row % ROWS;
        let of_row = &mut last[slot * columns + start..(slot + 1) * columns];
        in_x(&points[start..], of_row);
        if row >= 2 * HALO {
            let (ky, middle) = (row - 2 * HALO, row - HALO);
            let start = first(ky);
            let row = |k: usize| &last[(middle - HALO + k) % ROWS * columns + start..];
            combine(std::array::from_fn(row), &mut out[start..]);
            each(ky, &out);
        }
    }
    Ok(())
}
