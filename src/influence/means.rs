//! Means over elements from values at their centres.
//!
//! With d the central difference between neighbours, for a function that is smooth on the scale of an element,
//!
//! ```text
//! mean f = (d/2)/asinh(d/2) f = (1 + d^2/24 - 17 d^4/5760 + 367 d^6/967680 - 27859 d^8/464486400 + ...) f
//! ```
//!
//! in x, then in y: one evaluation per element. At 32 elements from a singularity what is left out is 1e-12 of f.

use crate::error::Result;
use crate::memory::zeros;

/// Neighbours on either side that a mean takes.
pub const HALO: usize = 4;
/// Elements that a mean takes in one direction.
pub const ROWS: usize = 2 * HALO + 1;

/// The weights of an element and of its neighbours at distance 1 to 4, to the eighth difference.
const MEAN: [f64; HALO + 1] = {
    let (a, b, c, d) = (1.0 / 24.0, -17.0 / 5760.0, 367.0 / 967_680.0, -27859.0 / 464_486_400.0);
    [
        1.0 - 2.0 * a + 6.0 * b - 20.0 * c + 70.0 * d,
        a - 4.0 * b + 15.0 * c - 56.0 * d,
        b - 6.0 * c + 28.0 * d,
        c - 8.0 * d,
        d,
    ]
};

/// Means along a row: `out[k]` is that of `points[k + HALO]`.
pub fn in_x(points: &[f64], out: &mut [f64]) {
    let n = out.len();
    combine(std::array::from_fn(|k| &points[k..k + n]), out);
}

/// Means across rows, the last [`ROWS`] of which are kept at `row % ROWS`; that of the row `middle`.
pub fn in_y(rows: &[f64], middle: usize, out: &mut [f64]) {
    let n = out.len();
    let slot = |k: usize| (middle - HALO + k) % ROWS;
    combine(std::array::from_fn(|k| &rows[slot(k) * n..(slot(k) + 1) * n]), out);
}

fn combine([a, b, c, d, e, f, g, h, i]: [&[f64]; ROWS], out: &mut [f64]) {
    let n = out.len();
    let (a, b, c, d, e) = (&a[..n], &b[..n], &c[..n], &d[..n], &e[..n]);
    let (f, g, h, i) = (&f[..n], &g[..n], &h[..n], &i[..n]);
    for (k, out) in out.iter_mut().enumerate() {
        *out = MEAN[0] * e[k]
            + MEAN[1] * (d[k] + f[k])
            + MEAN[2] * (c[k] + g[k])
            + MEAN[3] * (b[k] + h[k])
            + MEAN[4] * (a[k] + i[k]);
    }
}

/// Means of an even function at offsets `0.., 0..` less than `columns` and `rows`: `fill(ky, row)` gives its values at `(0.., |ky|)`;
/// `each(ky, means)` is given the means row by row.
pub fn means(
    (columns, rows): (usize, usize),
    fill: impl Fn(usize, &mut [f64]),
    mut each: impl FnMut(usize, &[f64]),
) -> Result<()> {
    let what = "means over elements";
    let mut points = zeros(columns + 2 * HALO, what)?;
    let mut last = zeros(ROWS * columns, what)?;
    let mut out = zeros(columns, what)?;
    for row in 0..rows + 2 * HALO {
        fill(row.abs_diff(HALO), &mut points[HALO..]);
        for k in 1..=HALO {
            points[HALO - k] = points[HALO + k];
        }
        let slot = row % ROWS;
        in_x(&points, &mut last[slot * columns..(slot + 1) * columns]);
        if row >= 2 * HALO {
            in_y(&last, row - HALO, &mut out);
            each(row - 2 * HALO, &out);
        }
    }
    Ok(())
}
