//! Influence coefficients of viscoelastic bodies in steady rolling at the speed V along x. Material enters at the leading edge and creeps while it
//! passes the contact.
//!
//! Material at x was at `x + V s` a time s ago. The creep of a body is `J(t)/J(0) = 1 + sum of c_i (1 - exp(-lambda_i t))`, with `c_i = 1/(N_i
//! lambda_i)` by its [modes](super::modes). With its instantaneous coefficients a, the coefficients in rolling are
//!
//! ```text
//! a_v(x, y) = a(x, y) + sum of c_i W_i(x, y),       W(x, y) = 1/L integral over s > 0 of exp(-s/L) a(x + s, y),   L = V/lambda
//! W(x) = 1/L integral over 0 < s < dx of exp(-s/L) a(x + s)  +  exp(-dx/L) W(x + dx)
//! ```
//!
//! a is smooth except at the edges of the loaded element. Intervals of integration end at these edges, and panels get shorter towards them: in the
//! row of the element down to a fraction of its shorter side, in other rows down to the distance of the row from the edge. That distance is short if
//! elements are long in x.
//!
//! Lengths are in units of dx, and times in units of the time in which an element passes. In double precision W equals a for times below
//! [`SHORTEST_TIME`], and c_i W is negligible for times above [`LONGEST_TIME`]. So times are clamped to these two. Element sizes and compliances are
//! split into a number near 1 and a power of two. The table is multiplied by these powers at the end.

use super::modes::Mode;
use super::series::Series;
use crate::error::{invalid, not_negative, require, Error, Result};
use crate::grid::Grid;
use crate::influence::{integral_at, rule};
use crate::memory::zeros;
use crate::powers::{apart, times_power, FADED};

/// The number of nodes of the Gauss-Legendre rule on a panel.
const NODES: usize = 12;
/// The length of the longest panel, in units of L.
const LONGEST_PANEL: f64 = 2.0;
/// For a panel near an edge: the distance of its near end from the edge over that of its far end. With this ratio 12 nodes give 14 digits.
const PANEL_RATIO: f64 = 0.35;
/// The last panel at an edge is this fraction of the shorter side of the element. The slope of `a` grows there as a logarithm. The rule integrates it
/// with an error of 5e-5 of the square of the panel's length.
const FINEST_PANEL: f64 = 1e-5;
/// Panels are not shorter than this length, in units of dx: shorter ones change no digit of the integrals.
const LEAST_LENGTH: f64 = 1e-17;
/// Far away the length of a panel is at most this times the distance.
const OF_DISTANCE: f64 = 0.5;
/// The exponent of 2 of the shortest time, in units of the time in which an element passes. `a` changes too little within a shorter time to matter.
const SHORTEST_TIME: i32 = -100;
/// The exponent of 2 of the longest time. It exceeds 1e14 (the slowest mode over its branch's time), times 1e14 (the largest weight of a mode), times
/// 1e16 (all digits): 1e44 < 2^200.
const LONGEST_TIME: i32 = 200;
/// The name of this memory in messages.
const WHAT: &str = "a row of coefficients";

/// One of two bodies that roll.
pub struct RollingBody {
    /// The instantaneous compliance: `(1 - nu)/(2 G)` for normal coefficients, `1/(2 G)` for tangential ones.
    pub compliance: f64,
    /// The Prony series of the shear modulus.
    pub series: Series,
}

/// One term of the coefficients: `weight` times W, or `weight` times the instantaneous coefficients a.
pub struct Part {
    weight: f64,
    /// The length L of W in units of dx; none for a.
    length: Option<f64>,
}

/// A row of elements, with N instantaneous coefficients as functions of a continuous offset in x.
pub struct Row<'a, const N: usize> {
    /// The instantaneous coefficients at an offset in x, in units of dx.
    pub at: &'a dyn Fn(f64) -> [f64; N],
    /// The length of panels at the edges of the loaded element: [`finest`].
    pub finest: f64,
}

/// The length of the shortest panels, those at the edges of the loaded element, in a row that is ky rows away, for elements of the width dy. Both
/// lengths are in units of dx.
pub fn finest(ky: usize, dy: f64) -> f64 {
    match ky {
        0 => (FINEST_PANEL * dy.min(1.0)).max(LEAST_LENGTH),
        // The distance of the edge.
        _ => ((ky as f64 - 0.5) * dy).max(LEAST_LENGTH),
    }
}

/// `sum + weight value`.
fn plus<const N: usize>(sum: [f64; N], weight: f64, value: [f64; N]) -> [f64; N] {
    std::array::from_fn(|k| sum[k] + weight * value[k])
}

impl<const N: usize> Row<'_, N> {
    /// `1/L` times the integral from s to s + d of `exp(-s/L) a(kx + s)`.
    fn panel(&self, kx: f64, (s, d): (f64, f64), length: f64) -> [f64; N] {
        let sum = rule(NODES).iter().fold([0.0; N], |sum, (node, weight)| {
            let at = s + node * d;
            plus(sum, weight * (-at / length).exp(), (self.at)(kx + at))
        });
        sum.map(|sum| d / length * sum)
    }

    /// As [`panel`](Self::panel), for an interval that is cut into panels of at most [`LONGEST_PANEL`].
    fn interval(&self, kx: f64, (from, to): (f64, f64), length: f64) -> [f64; N] {
        let to = to.min(FADED * length);
        if !(to > from) {
            return [0.0; N];
        }
        let panels = ((to - from) / (LONGEST_PANEL * length)).ceil().max(1.0);
        let d = (to - from) / panels;
        let panel = |k: usize| self.panel(kx, (from + k as f64 * d, d), length);
        (0..panels as usize).fold([0.0; N], |sum, k| plus(sum, 1.0, panel(k)))
    }

    /// The same integral from the offset kx to kx + 1: the first term in the recursion of W.
    fn element(&self, kx: i64, length: f64) -> [f64; N] {
        let (x, mut sum, mut far) = (kx as f64, [0.0; N], 0.5);
        let between = |far: f64, near: f64| {
            let before = self.interval(x, (0.5 - far, 0.5 - near), length);
            plus(before, 1.0, self.interval(x, (0.5 + near, 0.5 + far), length))
        };
        let has_edge = kx == 0 || kx == -1;
        while has_edge && far > self.finest {
            sum = plus(sum, 1.0, between(far, PANEL_RATIO * far));
            far *= PANEL_RATIO;
        }
        plus(sum, 1.0, between(far, 0.0))
    }

    /// W at the offset kx, by integration up to the distance where `exp(-s/L)` has faded.
    fn tail(&self, kx: i64, length: f64) -> [f64; N] {
        let (mut sum, mut s) = ([0.0; N], 0.0);
        while s < FADED * length {
            let d = (OF_DISTANCE * (kx as f64 + s)).max(OF_DISTANCE).min(LONGEST_PANEL * length);
            sum = plus(sum, 1.0, self.panel(kx as f64, (s, d), length));
            s += d;
        }
        sum
    }

    /// Adds a term of the coefficients at the offsets `-cx..=cx` to `out`.
    pub fn add(&self, part: &Part, cx: usize, out: &mut [[f64; N]]) {
        let Some(length) = part.length else {
            let at = |k: usize| (self.at)(k as f64 - cx as f64);
            return out.iter_mut().enumerate().for_each(|(k, value)| *value = plus(*value, part.weight, at(k)));
        };
        let (cx, decay) = (cx as i64, (-1.0 / length).exp());
        let mut w = self.tail(cx, length);
        for (k, value) in out.iter_mut().enumerate().rev() {
            let kx = k as i64 - cx;
            if kx < cx {
                w = plus(self.element(kx, length), decay, w);
            }
            *value = plus(*value, part.weight, w);
        }
    }
}

/// The series with its times in units of the time in which an element passes, clamped to their bounds.
fn by_elements(series: &Series, dx: f64, speed: f64) -> Option<Series> {
    let ((d, of_d), (v, of_v)) = (apart(dx), apart(speed.abs()));
    let passing = |t: &f64| {
        let (t, of_t) = apart(*t);
        let power = of_t + of_v - of_d;
        times_power(t * v / d, power.clamp(SHORTEST_TIME, LONGEST_TIME))
    };
    let times: Vec<f64> = series.times.iter().map(passing).collect();
    Series::new(1.0, &series.fractions, &times)
}

/// The terms of the coefficients of body `b`, with compliances in units of `2^power`. Refuses bodies without a long-time modulus, which creep for
/// ever.
pub fn parts(b: usize, body: &RollingBody, power: i32, dx: f64, speed: f64) -> Result<Vec<Part>> {
    let mut parts = Vec::new();
    let compliance = times_power(body.compliance, -power);
    if compliance == 0.0 {
        return Ok(parts);
    }
    parts.push(Part { weight: compliance, length: None });
    if body.series.is_empty() {
        return Ok(parts);
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
    parts.retain(|part| part.weight > 0.0);
    Ok(parts)
}

/// Checks the arguments of a table. Returns the larger compliance of the two bodies.
pub fn check((cx, cy): (usize, usize), (dx, dy): (f64, f64), bodies: &[RollingBody; 2], speed: f64) -> Result<f64> {
    require(speed.is_finite() && speed != 0.0, "speed", speed, "it must be finite, and not 0")?;
    if cx == 0 || cy == 0 {
        return invalid(format!("cx and cy are {cx} and {cy}; they must be positive"));
    }
    Grid::new(1, 1, dx, dy)?;
    bodies.iter().try_for_each(|body| not_negative("compliance", body.compliance))?;
    let most = bodies.iter().map(|body| body.compliance).fold(0.0, f64::max);
    require(most > 0.0, "compliance", most, "a body must give way")?;
    Ok(most)
}

/// The part of a message that tells why a coefficient is invalid.
pub const OUT_OF_RANGE: &str = "element sizes, moduli and times take it out of the range of numbers";

/// Computes the normal coefficients of two bodies in steady rolling, a table of the offsets `-cx..cx` by `-cy..cy`. The bodies roll towards +x if the
/// speed is positive, towards -x if it is negative.
///
/// # Errors
/// `InvalidArgument` or `NotFinite` for invalid sizes, a speed of 0, or coefficients beyond the range of numbers; `Unsupported` for a body that
/// creeps for ever; `OutOfMemory`.
pub fn rolling_table(
    (cx, cy): (usize, usize),
    (dx, dy): (f64, f64),
    bodies: &[RollingBody; 2],
    speed: f64,
) -> Result<Vec<f64>> {
    let most = check((cx, cy), (dx, dy), bodies, speed)?;
    let ((d, of_d), (_, of_compliance)) = (apart(dx), apart(most));
    let mut of_bodies = parts(0, &bodies[0], of_compliance, dx, speed)?;
    of_bodies.extend(parts(1, &bodies[1], of_compliance, dx, speed)?);
    let mut table: Vec<f64> = zeros(4 * cx * cy, WHAT)?;
    let mut row: Vec<[f64; 1]> = zeros(2 * cx + 1, WHAT)?;
    for ky in 0..=cy {
        row.fill([0.0]);
        let width = times_power(dy, -of_d);
        let at = |kx: f64| [integral_at((kx.abs(), ky as f64), (d, width))];
        let elements = Row { at: &at, finest: finest(ky, width / d) };
        of_bodies.iter().for_each(|part| elements.add(part, cx, &mut row));
        if speed < 0.0 {
            row.reverse();
        }
        for [value] in &mut row {
            *value = times_power(*value / std::f64::consts::PI, of_d + of_compliance);
            let is_in_range = value.is_normal() && *value > 0.0;
            require(is_in_range, "a coefficient", *value, OUT_OF_RANGE)?;
        }
        // The coefficients are even in y.
        for iy in [cy.checked_sub(ky), Some(cy + ky)].into_iter().flatten().filter(|iy| *iy < 2 * cy) {
            table[iy * 2 * cx..][..2 * cx].iter_mut().zip(&row).for_each(|(value, [at])| *value = *at);
        }
    }
    Ok(table)
}
