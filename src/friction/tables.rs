//! The caller's tangential influence coefficients: Axx, Ayy and Axy at offsets of whole elements.
//!
//! On a grid coarsened in x the coefficient is the mean displacement of the fine elements of one coarse element by a unit traction on
//! those of another, `c_H(K) = c(2K-1)/2 + c(2K) + c(2K+1)/2`, and likewise in y, as for the normal coefficients.
//!
//! In steady rolling `c(-x)` may differ from `c(x)`: such tables are called uneven. Products use them unchanged. A preconditioner uses the even part
//! in x of Axx and Ayy, and the odd part of Axy.

use std::sync::Arc;

use crate::effects::TangentialInfluence;
use crate::error::Result;
use crate::memory::zeros;

/// The coefficients of one offset: `[Axx, Ayy, Axy]`.
pub type Entry = [f64; 3];

/// The caller's coefficients. Axx and Ayy are even in y, Axy is odd in y. In x the same holds, unless the tables are uneven.
#[derive(Clone, Debug)]
pub struct Tables {
    /// The tables have the offsets below `cx` in x and below `cy` in y.
    cx: usize,
    cy: usize,
    /// The coefficients at the offsets `0..cx` by `0..cy`, `[y][x]`. For uneven tables: the even part in x of Axx and Ayy, the odd part of Axy.
    values: Arc<Vec<Entry>>,
    /// For uneven tables: the coefficients at the offsets `1 - cx..cx` by `0..cy`, `[y][x]`.
    uneven: Option<Arc<Vec<Entry>>>,
    /// A power of two, by which stored coefficients are multiplied.
    factor: f64,
}

impl Tables {
    /// Copies the caller's tables, which have been checked.
    pub fn new(influence: &TangentialInfluence<'_>) -> Result<Tables> {
        match influence.is_uneven() {
            true => Tables::of_uneven(influence.cx, influence.cy, |x, y| influence.at(x, y)),
            false => Tables::of(influence.cx, influence.cy, |x, y| influence.at(x, y)),
        }
    }

    /// Uneven tables with the coefficients `at(x, y)` at the offsets `1 - cx..cx` by `0..cy`.
    fn of_uneven(cx: usize, cy: usize, at: impl Fn(i64, i64) -> Entry) -> Result<Tables> {
        let (width, last) = (2 * cx - 1, cx as i64 - 1);
        let mut values: Vec<Entry> = zeros(width * cy, "the tangential influence coefficients")?;
        for (k, entry) in values.iter_mut().enumerate() {
            *entry = at((k % width) as i64 - last, (k / width) as i64);
        }
        let part = |x: i64, y: i64| {
            let row = &values[y as usize * width..][..width];
            let (right, left) = (row[(last + x) as usize], row[(last - x) as usize]);
            [0.5 * (right[0] + left[0]), 0.5 * (right[1] + left[1]), 0.5 * (right[2] - left[2])]
        };
        let tables = Tables::of(cx, cy, part)?;
        Ok(Tables { uneven: Some(Arc::new(values)), ..tables })
    }

    /// Whether the coefficients are uneven in x.
    pub fn is_uneven(&self) -> bool {
        self.uneven.is_some()
    }

    /// Whether Axy is 0 everywhere.
    pub fn is_uncoupled(&self) -> bool {
        self.uneven.as_ref().unwrap_or(&self.values).iter().all(|entry| entry[2] == 0.0)
    }

    /// The coefficients at an offset, also of uneven tables. Beyond the tables the outermost coefficients are used.
    pub fn whole_at(&self, x: i64, y: i64) -> Entry {
        let Some(values) = &self.uneven else { return self.at(x, y) };
        let last = self.cx as i64 - 1;
        let row = (y.unsigned_abs() as usize).min(self.cy - 1);
        let [xx, yy, xy] =
            values[row * (2 * self.cx - 1) + (x.clamp(-last, last) + last) as usize].map(|value| self.factor * value);
        [xx, yy, if y < 0 { -xy } else { xy }]
    }

    /// Tables with the coefficients `at(x, y)` at the offsets `0..cx` by `0..cy`.
    pub fn of(cx: usize, cy: usize, at: impl Fn(i64, i64) -> Entry) -> Result<Tables> {
        let mut values: Vec<Entry> = zeros(cx * cy, "the tangential influence coefficients")?;
        for (k, entry) in values.iter_mut().enumerate() {
            *entry = at((k % cx) as i64, (k / cx) as i64);
        }
        Ok(Tables { cx, cy, values: Arc::new(values), uneven: None, factor: 1.0 })
    }

    /// The offsets of the tables in x and in y are below these numbers.
    pub fn reach(&self) -> (usize, usize) {
        (self.cx, self.cy)
    }

    /// The tables divided by `unit`.
    pub fn in_units_of(&self, unit: f64) -> Tables {
        Tables { factor: self.factor / unit, ..self.clone() }
    }

    /// The coefficients at an offset, of uneven tables the even and odd parts in x. Beyond the tables the outermost coefficients are used.
    pub fn at(&self, x: i64, y: i64) -> Entry {
        let clamp = |k: i64, c: usize| (k.unsigned_abs() as usize).min(c - 1);
        let [xx, yy, xy] =
            self.values[clamp(y, self.cy) * self.cx + clamp(x, self.cx)].map(|value| self.factor * value);
        [xx, yy, if (x < 0) == (y < 0) { xy } else { -xy }]
    }

    /// The tables on a grid coarsened in x, in y, or in both.
    pub fn coarsened(&self, in_x: bool, in_y: bool) -> Result<Tables> {
        let stencil = |is_halved: bool, k: i64| match is_halved {
            true => [(2 * k - 1, 0.5), (2 * k, 1.0), (2 * k + 1, 0.5)],
            // Padded with weights of 0 to the length of the other stencil.
            false => [(k, 1.0), (k, 0.0), (k, 0.0)],
        };
        let half = |c: usize, is_halved: bool| if is_halved { c.div_ceil(2) } else { c };
        let mean = |kx: i64, ky: i64| {
            let mut sum = [0.0; 3];
            for (x, in_x) in stencil(in_x, kx) {
                for (y, in_y) in stencil(in_y, ky) {
                    let entry = self.whole_at(x, y);
                    (0..3).for_each(|component| sum[component] += in_x * in_y * entry[component]);
                }
            }
            sum
        };
        let (cx, cy) = (half(self.cx, in_x), half(self.cy, in_y));
        match self.is_uneven() {
            true => Tables::of_uneven(cx, cy, mean),
            false => Tables::of(cx, cy, mean),
        }
    }
}
