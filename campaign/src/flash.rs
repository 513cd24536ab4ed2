//! Flash temperatures: by the heat of friction in a random scene, between bodies with random speeds, compared with direct sums.
//!
//! A moving point source heats a half-space by `exp(-p (r - x))/(2 pi lambda r)`, with x downstream and `p = V/(2 kappa)`. For an element this
//! becomes a sum over its edges, as seen from the heated place. Along a ray of length r the integral is `r (1 - exp(-z))/z`, `z = p (r - x)`. With d
//! the distance of an edge's line, and `d sinh t` the place on it,
//!
//! ```text
//! 2 pi lambda T = sum over edges of d integral of (1 - exp(-z))/z dt,    r = d cosh t
//! ```

use std::f64::consts::PI;

use contact_normal::ffi::*;

use crate::grid::Grid;
use crate::hankel::gauss;
use crate::init::initialised;
use crate::random::Random;
use crate::verdict::Verdict;

/// The greatest length of a panel in t; panels are at most twice as long as the one before. With the nodes of the rule they integrate (1 - exp(-z))/z
/// to 1e-12, while z changes by a factor of e to four.
const PANEL: f64 = 1.0;
const NODES: usize = 12;
/// The error of both quadratures, relative to the largest rise: that of the library as documented.
const ACCURACY: f64 = 1e-9;

/// lambda T at (x, y), downstream of and beside the centre of an element, for a unit flux.
fn of_element((x, y): (f64, f64), (dx, dy): (f64, f64), p: f64, rule: &[(f64, f64)]) -> f64 {
    // The element as seen from the place: a source at x is upstream by x.
    let ((left, right), (low, high)) = ((x - 0.5 * dx, x + 0.5 * dx), (y - 0.5 * dy, y + 0.5 * dy));
    // Edges (distance of the line, its ends along the line), counterclockwise, and x at a place `along` them.
    let across = |at: f64, ends: (f64, f64)| edge((at, ends), |_| at, p, rule);
    let beside = |at: f64, ends: (f64, f64)| edge((at, ends), |along| along, p, rule);
    (across(right, (low, high)) - across(left, (low, high)) + beside(high, (left, right)) - beside(low, (left, right)))
        / (2.0 * PI)
}

/// The integral over the triangle between the place and an edge; `at` may be negative.
fn edge((at, (from, to)): (f64, (f64, f64)), x: impl Fn(f64) -> f64, p: f64, rule: &[(f64, f64)]) -> f64 {
    let d = at.abs();
    // For a place on the line the triangle is empty.
    if d == 0.0 {
        return 0.0;
    }
    let (from, to) = ((from / d).asinh(), (to / d).asinh());
    let value = |t: f64| {
        let z = p * (d * t.cosh() - x(d * t.sinh()));
        if z > 1e-8 {
            -(-z).exp_m1() / z
        } else {
            1.0 - 0.5 * z
        }
    };
    // Straight behind a fast source the integrand has a peak of width sqrt(2/(p d)).
    let narrowest = (2.0 / (p * d)).sqrt().clamp(1e-9, PANEL);
    let (mut ends, mut end) = (vec![from, to, 0.0], narrowest);
    while end < from.abs().max(to.abs()) {
        ends.extend([end, -end]);
        end += end.min(PANEL);
    }
    ends.retain(|end| (from..=to).contains(end));
    ends.sort_by(f64::total_cmp);
    let of_panel = |ends: &[f64]| {
        let length = ends[1] - ends[0];
        rule.iter().map(|(s, weight)| weight * value(ends[0] + s * length)).sum::<f64>() * length
    };
    at * ends.windows(2).map(of_panel).sum::<f64>()
}

/// Random bodies, speeds and a share; checks temperatures at the warmest place and at another one.
pub fn check(random: &mut Random, grid: &Grid, flux: &[f64]) -> Verdict {
    let n = grid.len();
    let mut verdict = Verdict::default();
    let mut heat = initialised(contact_normal_heat_init);
    (heat.mx, heat.my, heat.dx, heat.dy) = (grid.mx as i32, grid.my as i32, grid.dx, grid.dy);
    heat.heat_flux = flux.as_ptr();
    for b in 0..2 {
        (heat.conductivity[b], heat.diffusivity[b]) = (random.decades(0.1, 10.0), random.decades(0.1, 10.0));
        let of_an_element = random.pick(&[0.0, -1.0, 1.0, 1.0]) * random.decades(1e-3, 30.0);
        heat.speed[b] = of_an_element * 2.0 * heat.diffusivity[b] / grid.dx;
    }
    heat.share = if random.chance(0.5) { -1.0 } else { random.uniform() };
    let (mut rise, mut flash) = (vec![f64::NAN; 2 * n], initialised(contact_normal_flash_init));
    // SAFETY: structs with the arrays that they declare.
    let status = unsafe { contact_normal_flash_temperature(&heat, rise.as_mut_ptr(), &mut flash) };
    let told = || format!("status {status}, {grid:?}, speeds {:?}, diffusivities {:?}", heat.speed, heat.diffusivity);
    verdict.unless(status == CONTACT_NORMAL_OK, "flash temperatures are found", told);
    if status != CONTACT_NORMAL_OK {
        return verdict;
    }
    let rule = gauss(NODES);
    for b in 0..2 {
        let (rise, part) = (&rise[b * n..][..n], [flash.share, 1.0 - flash.share][b]);
        let (p, sign) =
            (heat.speed[b].abs() / (2.0 * heat.diffusivity[b]), if heat.speed[b] < 0.0 { -1.0 } else { 1.0 });
        let at = |i: usize| {
            let of = |j: usize| {
                let x = sign * ((i % grid.mx) as f64 - (j % grid.mx) as f64) * grid.dx;
                let y = ((i / grid.mx) as f64 - (j / grid.mx) as f64) * grid.dy;
                flux[j] * of_element((x, y), (grid.dx, grid.dy), p, &rule)
            };
            part / heat.conductivity[b] * (0..n).filter(|&j| flux[j] != 0.0).map(of).sum::<f64>()
        };
        let warmest = (0..n).fold(0, |top, i| if rise[i] > rise[top] { i } else { top });
        let largest = rise[warmest];
        for i in [warmest, random.integer(0, n - 1)] {
            let exact = at(i);
            verdict.unless((rise[i] - exact).abs() <= ACCURACY * largest, "flash temperatures are sums", || {
                format!("{:e} for {exact:e} at {i}, body {b}, {}", rise[i], told())
            });
        }
        let place = |k: usize, m: usize, d: f64| (k as f64 - 0.5 * (m as f64 - 1.0)) * d;
        let (x, y) = (place(warmest % grid.mx, grid.mx, grid.dx), place(warmest / grid.mx, grid.my, grid.dy));
        let is_there = (flash.x[b] - x).abs() <= 1e-9 * grid.dx && (flash.y[b] - y).abs() <= 1e-9 * grid.dy;
        verdict.unless(flash.largest[b] == largest && is_there, "the warmest place is that of the field", || {
            format!("{:e} at {} {} for {largest:e} at {x} {y}: {}", flash.largest[b], flash.x[b], flash.y[b], told())
        });
    }
    let [one, other] = flash.largest;
    let is_shared = if heat.share < 0.0 { (one - other).abs() <= 1e-12 * one } else { flash.share == heat.share };
    verdict.unless(is_shared, "heat is shared so that both are as warm", || format!("{one:e} {other:e}: {}", told()));
    verdict
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compared with Gauss points on an element, at places beside, ahead and behind; without motion with Love's integral in its middle.
    #[test]
    fn edges_add_up_to_elements() {
        let (rule, fine) = (gauss(NODES), gauss(40));
        for (x, y, p) in [(3.0, 0.4, 0.7), (-2.0, 1.0, 0.3), (2.5, -2.0, 5.0), (4.0, 0.0, 20.0), (300.0, 0.3, 20.0)] {
            let (dx, dy) = (1.0, 0.6);
            let mut sum = 0.0;
            for (u, wu) in &fine {
                for (v, wv) in &fine {
                    let (x, y) = (x - (u - 0.5) * dx, y - (v - 0.5) * dy);
                    let r = x.hypot(y);
                    sum += wu * wv * dx * dy * (-p * (r - x)).exp() / (2.0 * PI * r);
                }
            }
            let found = of_element((x, y), (dx, dy), p, &rule);
            // z is a difference of numbers of the size p r, and (1 - exp(-z))/z has half its error, over edges of the length dy.
            let rounding = 0.5 * p * x.hypot(y) * f64::EPSILON * dy / (2.0 * PI);
            assert!((found - sum).abs() <= 1e-12 * sum + rounding, "{x} {y} {p}: {found} {sum}");
        }
        // A square of side 1: 4 asinh(1).
        let middle = of_element((0.0, 0.0), (1.0, 1.0), 0.0, &rule);
        assert!((2.0 * PI * middle - 4.0 * 1f64.asinh()).abs() <= 1e-13, "{middle}");
    }
}
