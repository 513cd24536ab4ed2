//! The correction of one layer on a grid: the integral of the radial function F over each element.
//!
//! The method depends on the larger of two lengths, the thickness t and the distance of the element, in longer sides of an element:
//!
//! * beyond [`LEAST_DISTANCE`], means over elements from the values of F at the centres of the element and its neighbours (see [`means`]), with
//!   one evaluation per element;
//! * nearer, tensor Gauss quadrature;
//! * up to a distance of [`CORNERS`] diagonals of an element, corner differences of `S(x, y) = integral from 0 to x and 0 to y of F`:
//!
//! ```text
//! S(x, y) = t^2 (T(x, y) + T(y, x)),    T(a, b) = integral from 0 to asinh(b/a) of M(a cosh(u)/t)/cosh(u) du
//! ```
//!
//! The integrand of T is smooth for any ratio of element size to thickness.

use super::base::Base;
use super::offsets::{first_beyond, first_of_half, first_of_substrate, COATED};
use super::radial::Radial;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::gauss::rule;
use crate::influence::means::{self, LEAST_DISTANCE};
use crate::influence::{HalfSpace, Kernel};
use crate::memory::zeros;

/// The distance up to which corner differences are used, in diagonals of an element.
pub(super) const CORNERS: f64 = 2.5;
/// The number of points per side of tensor Gauss quadrature, below each distance in longer sides of an element.
const POINTS: [(f64, usize); 2] = [(12.0, 7), (LEAST_DISTANCE, 4)];
/// The number of points of the Gauss rule for the integral T.
pub(super) const LINE_POINTS: usize = 40;

/// The correction of one layer on a grid.
pub struct LayerCorrection<'a> {
    /// The radial functions of the layer.
    pub radial: &'a Radial,
    /// The thickness of the layer.
    pub t: f64,
    /// The grid.
    pub grid: Grid,
    /// The integrals of 1/r over elements.
    pub half_space: &'a HalfSpace,
}

impl LayerCorrection<'_> {
    /// Adds `(c/t) integral of F` to the `table`, in each row from [`first_of_half`] on. At distances below t the layer is the base, beyond the
    /// substrate.
    pub fn add(&self, c: f64, table: &mut [f64]) -> Result<()> {
        let Grid { mx, my, dx, dy } = self.grid;
        let far = LEAST_DISTANCE * dx.max(dy);
        let first = |ky: usize| first_of_half(&self.grid, ky);
        let scale = c * dx * dy / self.t;
        let fill = |base: Base| {
            move |ky: usize, first: usize, row: &mut [f64]| {
                let y = ky as f64 * dy / self.t;
                let skipped = usize::from(ky == 0 && base == Base::Substrate);
                // F with the substrate as base is infinite at offset 0. Means near this offset are not used.
                row[..skipped].fill(0.0);
                let x = (first + skipped) as f64 * dx / self.t;
                self.radial.fill_f((x, dx / self.t, y), base, &mut row[skipped..]);
            }
        };
        let mut add_row = |ky: usize, means: &[f64], from: usize, to: usize| {
            let row = table[ky * mx..(ky + 1) * mx].iter_mut().zip(means);
            row.take(to).skip(from.max(first(ky))).for_each(|(value, mean)| *value += scale * mean);
        };
        let last = ((mx - 1) as f64 * dx).hypot((my - 1) as f64 * dy);
        if self.t >= far {
            // All offsets nearer than t lie in a rectangle of these counts.
            let count = |d: f64, m: usize| ((self.t / d) as usize).saturating_add(1).min(m);
            means::means((count(dx, mx), count(dy, my)), first, fill(Base::Layer), |ky, means| {
                add_row(ky, means, 0, first_beyond(self.t, &self.grid, ky));
            })?;
        }
        if last >= self.t {
            means::means((mx, my), first, fill(Base::Substrate), |ky, means| {
                add_row(ky, means, first_beyond(self.t.max(far), &self.grid, ky), mx);
            })?;
        }
        if self.t < far {
            self.add_near(c, table)?;
        }
        Ok(())
    }

    /// Adds the correction at offsets nearer than [`LEAST_DISTANCE`].
    fn add_near(&self, c: f64, table: &mut [f64]) -> Result<()> {
        let Grid { mx, my, dx, dy } = self.grid;
        let h = dx.max(dy);
        let count = |d: f64, distance: f64, m: usize| ((distance / d) as usize).saturating_add(2).min(m);
        let by_corners = CORNERS * dx.hypot(dy);
        let base = if h < self.t { Base::Layer } else { Base::Substrate };
        let corners = Corners::new(self, base, (count(dx, by_corners, mx), count(dy, by_corners, my)))?;
        for ky in 0..count(dy, LEAST_DISTANCE * h, my) {
            let first_of_substrate = first_of_substrate(self.t, &self.grid, ky);
            for kx in first_of_half(&self.grid, ky)..first_beyond(LEAST_DISTANCE * h, &self.grid, ky) {
                let (x, y) = (kx as f64 * dx, ky as f64 * dy);
                let r = x.hypot(y);
                let here = if kx >= first_of_substrate { Base::Substrate } else { Base::Layer };
                let value = &mut table[ky * mx + kx];
                if r > by_corners {
                    let (_, points) = POINTS[usize::from(r.max(self.t) > POINTS[0].0 * h)];
                    *value += c * self.gauss(rule(points), (x, y), here);
                    continue;
                }
                // The corner values have the same base at all offsets. If this offset has the other base, the integral of the difference `(1 -
                // B0)/rho` is added.
                let other = base.to(here) * (1.0 - self.radial.transfer.substrate);
                let half_space = if other == 0.0 { 0.0 } else { other * self.half_space.at(kx as i64, ky as i64) };
                *value += c * (corners.difference(kx, ky) + half_space);
            }
        }
        Ok(())
    }

    /// `(1/t) integral of F` over the element centred at `(x, y)`, by tensor Gauss quadrature.
    pub fn gauss(&self, rule: &[(f64, f64)], (x, y): (f64, f64), base: Base) -> f64 {
        let Grid { dx, dy, .. } = self.grid;
        let mut sum = 0.0;
        let square = |value: f64| value * value;
        for (sx, wx) in rule {
            let x2 = square((x + (sx - 0.5) * dx) / self.t);
            for (sy, wy) in rule {
                let y2 = square((y + (sy - 0.5) * dy) / self.t);
                sum += wx * wy * self.radial.f_at_square(x2 + y2, base);
            }
        }
        sum * dx * dy / self.t
    }
}

/// The values S/t at the corners of the elements near the loaded one.
struct Corners {
    /// The number of corners in a row.
    columns: usize,
    /// S/t, `[row][column]`, at half-integer offsets from 1/2 on.
    values: Vec<f64>,
}

impl Corners {
    /// Computes S/t at the corners of `columns` by `rows` elements.
    fn new(layer: &LayerCorrection<'_>, base: Base, (columns, rows): (usize, usize)) -> Result<Corners> {
        let rule = rule(LINE_POINTS);
        let (dx, dy) = (layer.grid.dx / layer.t, layer.grid.dy / layer.t);
        let side = |a: f64, b: f64| {
            let end = (b / a).asinh();
            let at = |(u, w): &(f64, f64)| {
                let cosh = (end * u).cosh();
                w * layer.radial.m(a * cosh, base) / cosh
            };
            end * rule.iter().map(at).sum::<f64>()
        };
        let mut values = zeros((columns + 1) * (rows + 1), COATED)?;
        for (i, value) in values.iter_mut().enumerate() {
            // Corners are at half-integer offsets, from 1/2 on. S is odd, so that a value at -1/2 is the opposite of that at 1/2.
            let (x, y) = ((i % (columns + 1)) as f64 + 0.5, (i / (columns + 1)) as f64 + 0.5);
            *value = layer.t * (side(x * dx, y * dy) + side(y * dy, x * dx));
        }
        Ok(Corners { columns: columns + 1, values })
    }

    /// `(1/t) integral of F` over the element at an offset.
    fn difference(&self, kx: usize, ky: usize) -> f64 {
        let corner = |kx: i64, ky: i64| {
            let place = |k: i64| if k < 0 { (0, -1.0) } else { (k as usize, 1.0) };
            let ((x, sx), (y, sy)) = (place(kx), place(ky));
            sx * sy * self.values[y * self.columns + x]
        };
        let (kx, ky) = (kx as i64, ky as i64);
        corner(kx, ky) - corner(kx - 1, ky) - corner(kx, ky - 1) + corner(kx - 1, ky - 1)
    }
}
