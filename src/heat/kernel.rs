//! The steady temperature rise by a heat source on one element of a moving half-space.
//!
//! A point source of strength 1 heats the surface of a body with the conductivity lambda and the diffusivity kappa, which moves past the source at
//! the speed V, in the steady state by (Jaeger 1942; Carslaw & Jaeger, section 10.7)
//!
//! ```text
//! T = 1/(2 pi lambda r) exp(-P (r - x)),    P = V/(2 kappa),    x: the distance downstream of the source
//! ```
//!
//! The integral over an element is, with `y = |x| sinh t`,
//!
//! ```text
//! lambda T = integral of g(x) dx,    g(x) = 1/(2 pi) integral of exp(-P (|x| cosh t - x)) dt
//! ```
//!
//! * g has a logarithmic singularity at x = 0, and behind a fast source it behaves like `x^(-1/2)`. The substitution `x = L s^4` makes the integrand
//!   smooth in both cases. g changes on the scales of half of the element's width and of 1/P. L is the smaller one of these scales, or the end of the
//!   element if that is nearer. Beyond L panels follow, of which each ends [`PANEL_RATIO`] times as far away as it begins.
//! * Without motion the integral is Love's, of 1/r.
//! * On far elements, over which T changes little, a rule with [`FAR_NODES`] nodes in each direction integrates T directly.

use std::f64::consts::PI;

use crate::influence::rule;
use crate::powers::FADED;

/// The length of the longest panel in t. On it the rule integrates exp(-a cosh t) to 1e-10.
const PANEL: f64 = 2.0;
/// The largest t. sinh(t) overflows beyond it, and for a tiny P the integral in t would have no finite end.
const LONGEST: f64 = 700.0;
/// The distance of the end of a panel in x over that of its start.
const PANEL_RATIO: f64 = 4.0;
/// The least length of the first panel in x, over dx.
const SHORTEST_PANEL: f64 = 1e-12;

/// The least distance of a far element, over its longer side. Over such an element 1/r changes by a factor of 1.1, and its rule is right to 24^-12.
const FAR: f64 = 12.0;
/// The largest change of the exponent P (r - x) over a far element. A rule of 6 nodes then integrates the wake of a fast source to 1e-10 of the
/// value.
const FAR_EXPONENT: f64 = 1.0;
/// The number of nodes of the Gauss-Legendre rule on a panel.
const NODES: usize = 20;
/// The number of nodes of the rule on a far element, in each direction.
const FAR_NODES: usize = 6;

/// The temperature rise at `(x, y)` from the centre of an element `dx` by `dy`, where x is positive downstream, by a unit flux into a half-space of
/// unit conductivity. The result is a length. `wave` is P.
pub fn of_element((x, y): (f64, f64), (dx, dy): (f64, f64), wave: f64) -> f64 {
    if wave == 0.0 {
        return love((x, y), (dx, dy)) / (2.0 * PI);
    }
    // The change of the exponent is largest at the farther edge of the element.
    let edge = y.abs() + 0.5 * dy;
    let r = x.hypot(edge);
    let change = wave * (dx * lag(x, edge, r) + dy * edge) / r;
    if r >= FAR * dx.max(dy) && change <= FAR_EXPONENT {
        return of_far_element((x, y), (dx, dy), wave);
    }
    let edges = (y.abs() - 0.5 * dy, y.abs() + 0.5 * dy);
    let (from, to) = (x - 0.5 * dx, x + 0.5 * dx);
    let near = (0.5 * dy).min(1.0 / wave).max(SHORTEST_PANEL * dx);
    let behind = |from: f64, to: f64| along((from, to), near, |distance| strip(distance, edges, (wave, true)));
    let ahead = |from: f64, to: f64| {
        // Ahead, g decays as exp(-2 P x).
        let to = to.min(from + 0.5 * FADED / wave);
        along((from, to), near, |distance| strip(distance, edges, (wave, false)))
    };
    match (from < 0.0, to > 0.0) {
        (true, true) => behind(0.0, to) + ahead(0.0, -from),
        (false, _) => behind(from, to),
        (true, false) => ahead(-to, -from),
    }
}

/// r - x, computed without cancellation.
fn lag(x: f64, y: f64, r: f64) -> f64 {
    if x > 0.0 {
        y * (y / (r + x))
    } else {
        r - x
    }
}

/// [`of_element`] for a far element, by a Gauss-Legendre rule in each direction.
fn of_far_element((x, y): (f64, f64), (dx, dy): (f64, f64), wave: f64) -> f64 {
    let rule = rule(FAR_NODES);
    let at = |x: f64, y: f64| {
        let r = x.hypot(y);
        (-wave * lag(x, y, r)).exp() / r
    };
    let along = |y: f64| rule.iter().map(|(s, weight)| weight * at(x + (s - 0.5) * dx, y)).sum::<f64>();
    let sum: f64 = rule.iter().map(|(s, weight)| weight * along(y + (s - 0.5) * dy)).sum();
    sum * dx * dy / (2.0 * PI)
}

/// Love's integral of 1/r over an element.
fn love((x, y): (f64, f64), (dx, dy): (f64, f64)) -> f64 {
    let term = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() };
    let corner = |a: f64, b: f64| term(a, b) + term(b, a);
    let ((left, right), (low, high)) = ((x - 0.5 * dx, x + 0.5 * dx), (y - 0.5 * dy, y + 0.5 * dy));
    corner(right, high) - corner(left, high) - corner(right, low) + corner(left, low)
}

/// The integral of f over a range of distances. f changes on the scale `near`, and at the distance 0 it may be singular like `log x` or `x^(-1/2)`.
fn along((from, to): (f64, f64), near: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (rule, mut start, mut sum) = (rule(NODES), from, 0.0);
    if !(from > 0.0) {
        start = to.min(near);
        sum = rule.iter().map(|(s, weight)| weight * 4.0 * start * s.powi(3) * f(start * s.powi(4))).sum();
    }
    while start < to {
        let end = to.min(PANEL_RATIO * start);
        let length = end - start;
        sum += length * rule.iter().map(|(s, weight)| weight * f(start + length * s)).sum::<f64>();
        start = end;
    }
    sum
}

/// g for a source between two edges in y, of which the first may be negative, at a distance behind the source or ahead of it.
fn strip(distance: f64, (low, high): (f64, f64), (wave, behind): (f64, bool)) -> f64 {
    let a = 2.0 * wave * distance;
    // -P (|x| cosh t - x) = -a sinh^2(t/2) behind, -a cosh^2(t/2) ahead.
    let most = (2.0 * (FADED / a).sqrt().asinh()).min(LONGEST);
    let end = (high / distance).asinh().min(most);
    let of = |from: f64| if from < end { panels(from, end, a) } else { 0.0 };
    let begin = (low / distance).asinh();
    let sum = if begin < 0.0 { of(0.0) + panels(0.0, (-begin).min(most), a) } else { of(begin) };
    // cosh^2 = 1 + sinh^2.
    let factor = if behind { 1.0 } else { (-a).exp() };
    factor * sum / (2.0 * PI)
}

/// The integral over t of `exp(-a sinh^2(t/2))`, by panels.
fn panels(from: f64, to: f64, a: f64) -> f64 {
    let count = ((to - from) / PANEL).ceil().max(1.0);
    let (rule, length) = (rule(NODES), (to - from) / count);
    let of_panel = |k: usize| {
        let start = from + k as f64 * length;
        let at = |s: f64| (-a * (0.5 * (start + length * s)).sinh().powi(2)).exp();
        rule.iter().map(|(s, weight)| weight * at(*s)).sum::<f64>()
    };
    length * (0..count as usize).map(of_panel).sum::<f64>()
}
