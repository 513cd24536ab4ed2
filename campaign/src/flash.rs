//! Flash temperatures: compares those of the library with direct sums, for the heat of friction in a random scene and bodies with random speeds.
//!
//! A point source that moves on a half-space with the speed V causes the temperature rise `exp(-p (r - x))/(2 pi lambda r)`, with x downstream of the
//! source, `p = V/(2 kappa)`, the conductivity lambda and the diffusivity kappa. The integral over an element becomes a sum over its edges, seen from
//! the heated point: along a ray of length r the integral is `r (1 - exp(-z))/z`, with `z = p (r - x)`. If d is the distance of the line of an edge,
//! and `d sinh t` the position on this line,
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

/// The largest length of a panel in t. Each panel is at most twice as long as the one before. On a panel z changes by a factor of e to four, and the
/// rule integrates (1 - exp(-z))/z to 1e-12.
const PANEL: f64 = 1.0;
/// The number of nodes of the rule on a panel.
const NODES: usize = 12;
/// The allowed difference of both results, relative to the largest temperature rise: the error of the library by its documentation.
const ACCURACY: f64 = 1e-9;

/// lambda T at the point (x, y), relative to the centre of an element with a unit flux. x is downstream.
fn of_element((x, y): (f64, f64), (dx, dy): (f64, f64), p: f64, rule: &[(f64, f64)]) -> f64 {
    // The edges of the element, seen from the point: a source at the distance x upstream.
    let ((left, right), (low, high)) = ((x - 0.5 * dx, x + 0.5 * dx), (y - 0.5 * dy, y + 0.5 * dy));
    // An edge is given by the distance of its line and by its ends along the line. The edges are taken counterclockwise. On the first two x is the
    // distance, on the other two it is the position along the line.
    let across = |at: f64, ends: (f64, f64)| edge((at, ends), |_| at, p, rule);
    let beside = |at: f64, ends: (f64, f64)| edge((at, ends), |along| along, p, rule);
    (across(right, (low, high)) - across(left, (low, high)) + beside(high, (left, right)) - beside(low, (left, right)))
        / (2.0 * PI)
}

/// The integral over the triangle between the point and an edge. `distance` is that of the edge's line, which may be negative; `x` returns x at a
/// position on the line.
fn edge((distance, (from, to)): (f64, (f64, f64)), x: impl Fn(f64) -> f64, p: f64, rule: &[(f64, f64)]) -> f64 {
    let d = distance.abs();
    // If the point is on the line, the triangle is empty.
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
    distance * ends.windows(2).map(of_panel).sum::<f64>()
}

/// Computes flash temperatures by a heat flux, for random bodies, speeds and a random share of the heat. Checks them at the warmest element of each
/// body and at another one.
pub fn check(random: &mut Random, grid: &Grid, flux: &[f64]) -> Verdict {
    let n = grid.len();
    let mut verdict = Verdict::default();
    let mut heat = initialised(contact_normal_heat_init);
    (heat.mx, heat.my, heat.dx, heat.dy) = (grid.mx as i32, grid.my as i32, grid.dx, grid.dy);
    heat.heat_flux = flux.as_ptr();
    for b in 0..2 {
        (heat.conductivity[b], heat.diffusivity[b]) = (random.decades(0.1, 10.0), random.decades(0.1, 10.0));
        // The Peclet number `V dx/(2 kappa)` of an element.
        let peclet = random.pick(&[0.0, -1.0, 1.0, 1.0]) * random.decades(1e-3, 30.0);
        heat.speed[b] = peclet * 2.0 * heat.diffusivity[b] / grid.dx;
    }
    heat.share = if random.chance(0.5) { -1.0 } else { random.uniform() };
    let (mut rise, mut flash) = (vec![f64::NAN; 2 * n], initialised(contact_normal_flash_init));
    // SAFETY: structs with the arrays that they declare.
    let status = unsafe { contact_normal_flash_temperature(&heat, rise.as_mut_ptr(), &mut flash) };
    let details =
        || format!("status {status}, {grid:?}, speeds {:?}, diffusivities {:?}", heat.speed, heat.diffusivity);
    verdict.unless(status == CONTACT_NORMAL_OK, "flash temperatures are found", details);
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
                format!("{:e} for {exact:e} at {i}, body {b}, {}", rise[i], details())
            });
        }
        let place = |k: usize, m: usize, d: f64| (k as f64 - 0.5 * (m as f64 - 1.0)) * d;
        let (x, y) = (place(warmest % grid.mx, grid.mx, grid.dx), place(warmest / grid.mx, grid.my, grid.dy));
        let is_there = (flash.x[b] - x).abs() <= 1e-9 * grid.dx && (flash.y[b] - y).abs() <= 1e-9 * grid.dy;
        verdict.unless(flash.largest[b] == largest && is_there, "the warmest place is that of the field", || {
            format!("{:e} at {} {} for {largest:e} at {x} {y}: {}", flash.largest[b], flash.x[b], flash.y[b], details())
        });
    }
    let [one, other] = flash.largest;
    let is_shared = if heat.share < 0.0 { (one - other).abs() <= 1e-12 * one } else { flash.share == heat.share };
    verdict
        .unless(is_shared, "heat is shared so that both are as warm", || format!("{one:e} {other:e}: {}", details()));
    verdict
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the sum over edges with Gauss points on the element, at points beside, ahead of and behind the element. Without motion, compares it
    /// with Love's integral in the middle of a square.
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
            // z is a difference of numbers of the size p r. The error of (1 - exp(-z))/z is half of that of z, and edges have the length dy.
            let rounding = 0.5 * p * x.hypot(y) * f64::EPSILON * dy / (2.0 * PI);
            assert!((found - sum).abs() <= 1e-12 * sum + rounding, "{x} {y} {p}: {found} {sum}");
        }
        // The integral of 1/r over a square of side 1, from its middle, is 4 asinh(1).
        let middle = of_element((0.0, 0.0), (1.0, 1.0), 0.0, &rule);
        assert!((2.0 * PI * middle - 4.0 * 1f64.asinh()).abs() <= 1e-13, "{middle}");
    }
}
