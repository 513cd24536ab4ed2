//! Coefficients of bodies that relax and roll steadily: material comes in at the leading edge, and gives way while it passes.
//!
//! Material at x was at `x + V s` a time s ago. With the creep of a body, `J(t)/J(0) = 1 + sum of c_i (1 - exp(-lambda_i t))` (its [modes](super::modes):
//! `c_i = 1/(N_i lambda_i)`), and its coefficients at once a,
//!
//! ```text
//! a_v(x, y) = a(x, y) + sum of c_i W_i(x, y),       W(x, y) = 1/L integral over s > 0 of exp(-s/L) a(x + s, y),   L = V/lambda
//! W(x) = 1/L integral over 0 < s < dx of exp(-s/L) a(x + s)  +  exp(-dx/L) W(x + dx)
//! ```
//!
//! a is smooth but at the edges of the element, where intervals end and panels become short. Lengths are in elements, times those in which one passes:
//! of such a time that is below [`SHORTEST`] W is a, and of one above [`LONGEST_TIME`] nothing, to all digits, so they are taken for these. Element
//! sizes and compliances are taken apart into a number near 1 and a power of two, which the table is multiplied by in the end.

use super::modes::Mode;
use super::series::Series;
use crate::error::{invalid, not_negative, require, Error, Result};
use crate::grid::Grid;
use crate::influence::{gauss_legendre, integral_at};
use crate::memory::zeros;
use crate::powers::{apart, times_power};

/// Nodes of a panel.
const NODES: usize = 12;
/// Panels are at most so many L long, and what decays for longer than so many L is nothing.
const LONGEST: f64 = 2.0;
const DECAYED: f64 = 40.0;
/// Panels beside an edge: each is this part of the one before.
const GRADED: i32 = 10;
const SHORTER: f64 = 0.15;
/// Far away a panel is at most this part of the distance.
const OF_DISTANCE: f64 = 0.5;
/// Powers of two of times, in passages of an element. Within the shorter one the slope of `a` changes nothing. The longer one exceeds 1e14 (the slowest
/// mode over its branch's time), times 1e14 (the largest weight of a mode), times 1e16 (all digits).
const SHORTEST: i32 = -100;
const LONGEST_TIME: i32 = 200;
const WHAT: &str = "a row of coefficients";

/// A body: its compliance at once `(1 - nu)/(2 G)`, and how it relaxes.
pub struct RollingBody {
    /// At once.
    pub compliance: f64,
    /// Of its modulus.
    pub series: Series,
}

/// A part of the coefficients: W times `weight`, with the decay length L in elements; a itself without one.
struct Part {
    weight: f64,
    length: Option<f64>,
}

/// A row of elements, whose coefficients at once are known between offsets, too.
struct Row<'a> {
    ky: f64,
    element: (f64, f64),
    rule: &'a [(f64, f64)],
}

impl Row<'_> {
    fn at(&self, kx: f64) -> f64 {
        integral_at((kx.abs(), self.ky), self.element)
    }

    /// `1/L` times the integral from s to s + d of `exp(-s/L) a(kx + s)`.
    fn panel(&self, kx: f64, (s, d): (f64, f64), length: f64) -> f64 {
        let term = |(node, weight): &(f64, f64)| {
            let at = s + node * d;
            weight * (-at / length).exp() * self.at(kx + at)
        };
        d / length * self.rule.iter().map(term).sum::<f64>()
    }

    /// The same of an interval, in panels that are short beside L.
    fn interval(&self, kx: f64, (from, to): (f64, f64), length: f64) -> f64 {
        let to = to.min(DECAYED * length);
        if !(to > from) {
            return 0.0;
        }
        let panels = ((to - from) / (LONGEST * length)).ceil().max(1.0);
        let d = (to - from) / panels;
        (0..panels as usize).map(|k| self.panel(kx, (from + k as f64 * d, d), length)).sum()
    }

    /// From an offset to the next.
    fn element(&self, kx: i64, length: f64) -> f64 {
        let x = kx as f64;
        let has_edge = self.ky == 0.0 && (kx == 0 || kx == -1);
        if !has_edge {
            return self.interval(x, (0.0, 0.5), length) + self.interval(x, (0.5, 1.0), length);
        }
        let end = |k: i32| if k == GRADED { 0.0 } else { 0.5 * SHORTER.powi(k) };
        let beside = |k: i32| {
            let (far, near) = (end(k), end(k + 1));
            self.interval(x, (0.5 - far, 0.5 - near), length) + self.interval(x, (0.5 + near, 0.5 + far), length)
        };
        (0..GRADED).map(beside).sum()
    }

    /// W far ahead.
    fn tail(&self, kx: i64, length: f64) -> f64 {
        let (mut sum, mut s) = (0.0, 0.0);
        while s < DECAYED * length {
            let d = (OF_DISTANCE * (kx as f64 + s)).max(OF_DISTANCE).min(LONGEST * length);
            sum += self.panel(kx as f64, (s, d), length);
            s += d;
        }
        sum
    }

    /// Adds a part of the offsets `-cx..=cx`.
    fn add(&self, part: &Part, cx: usize, out: &mut [f64]) {
        let Some(length) = part.length else {
            let at = |k: usize| self.at(k as f64 - cx as f64);
            return out.iter_mut().enumerate().for_each(|(k, value)| *value += part.weight * at(k));
        };
        let (cx, decay) = (cx as i64, (-1.0 / length).exp());
        let mut w = self.tail(cx, length);
        for (k, value) in out.iter_mut().enumerate().rev() {
            let kx = k as i64 - cx;
            if kx < cx {
                w = self.element(kx, length) + decay * w;
            }
            *value += part.weight * w;
        }
    }
}

/// A series with the times in which an element passes in the place of its times.
fn by_elements(series: &Series, dx: f64, speed: f64) -> Option<Series> {
    let ((d, of_d), (v, of_v)) = (apart(dx), apart(speed.abs()));
    let passing = |t: &f64| {
        let (t, of_t) = apart(*t);
        let power = of_t + of_v - of_d;
        times_power(t * v / d, power.clamp(SHORTEST, LONGEST_TIME))
    };
    let times: Vec<f64> = series.times.iter().map(passing).collect();
    Series::new(1.0, &series.fractions, &times)
}

/// The parts of both bodies, with compliances in units of 2 to this power; refuses what creeps for ever.
fn parts(bodies: &[RollingBody; 2], power: i32, dx: f64, speed: f64) -> Result<Vec<Part>> {
    let mut parts = Vec::new();
    for (b, body) in bodies.iter().enumerate() {
        let compliance = times_power(body.compliance, -power);
        if compliance == 0.0 {
            continue;
        }
        parts.push(Part { weight: compliance, length: None });
        if body.series.is_empty() {
            continue;
        }
        if body.series.rest == 0.0 {
            return Err(Error::Unsupported(format!(
                "nothing is left of the modulus of body {} in the end: in steady rolling it gives way without limit",
                b + 1
            )));
        }
        let Some(series) = by_elements(&body.series, dx, speed) else {
            return invalid(format!("the branches of body {} add up to more than its modulus", b + 1));
        };
        for mode in Mode::of(&Series { rest: body.series.rest, ..series }) {
            parts.push(Part { weight: compliance / (mode.inertia * mode.rate), length: Some(1.0 / mode.rate) });
        }
    }
    Ok(parts)
}

/// The coefficients of two bodies that roll steadily towards +x at a speed, or towards -x at one below 0, as a table of the offsets
/// `-cx..cx` by `-cy..cy`.
///
/// # Errors
/// `InvalidArgument`, `NotFinite`: sizes that are none, a speed of 0, coefficients beyond the range of numbers. `Unsupported`: a body that creeps for
/// ever. `OutOfMemory`.
pub fn rolling_table(
    (cx, cy): (usize, usize),
    (dx, dy): (f64, f64),
    bodies: &[RollingBody; 2],
    speed: f64,
) -> Result<Vec<f64>> {
    require(speed.is_finite() && speed != 0.0, "speed", speed, "it must be finite, and not 0")?;
    if cx == 0 || cy == 0 {
        return invalid(format!("cx and cy are {cx} and {cy}; they must be positive"));
    }
    Grid::new(1, 1, dx, dy)?;
    bodies.iter().try_for_each(|body| not_negative("compliance", body.compliance))?;
    let most = bodies.iter().map(|body| body.compliance).fold(0.0, f64::max);
    require(most > 0.0, "compliance", most, "a body must give way")?;
    let ((d, of_d), (_, of_compliance)) = (apart(dx), apart(most));
    let (rule, parts) = (gauss_legendre(NODES), parts(bodies, of_compliance, dx, speed)?);
    let mut table: Vec<f64> = zeros(4 * cx * cy, WHAT)?;
    let mut row: Vec<f64> = zeros(2 * cx + 1, WHAT)?;
    for ky in 0..=cy {
        row.fill(0.0);
        let of = Row { ky: ky as f64, element: (d, times_power(dy, -of_d)), rule: &rule };
        parts.iter().filter(|part| part.weight > 0.0).for_each(|part| of.add(part, cx, &mut row));
        if speed < 0.0 {
            row.reverse();
        }
        for value in &mut row {
            *value = times_power(*value / std::f64::consts::PI, of_d + of_compliance);
            let is_one = value.is_normal() && *value > 0.0;
            require(
                is_one,
                "a coefficient",
                *value,
                "element sizes, moduli and times take it out of the range of numbers",
            )?;
        }
        // Even in y.
        for iy in [cy.checked_sub(ky), Some(cy + ky)].into_iter().flatten().filter(|iy| *iy < 2 * cy) {
            table[iy * 2 * cx..][..2 * cx].copy_from_slice(&row[..2 * cx]);
        }
    }
    Ok(table)
}
