//! Friction: random motions and forces, with the conditions of stick and slip recomputed by direct sums.
//!
//! The coefficients are the campaign's own, differences of the closed forms over the corners of an element (Kalker 1990; Johnson,
//! Contact Mechanics, section 3.6), with `r = hypot(X, Y)`:
//!
//! ```text
//! Axx = ((1 - nu) a + b)/(pi G),   Ayy = (a + (1 - nu) b)/(pi G),   Axy = nu c/(pi G)
//! a = [X asinh(Y/|X|)],   b = [Y asinh(X/|Y|)],   c = [-r]
//! ```
//!
//! The slip is `s = w + A q - u'`. What is left of it counts where an element sticks, and where it slips but for what is opposite to q.
//! Every case of like bodies has to be solved but those of steady rolling that are not monotone, whose solution may be none or many.

use std::f64::consts::PI;

use contact_normal::ffi::*;

use crate::friction_call::{call, frictionless, Found};
use crate::friction_case::{Case, Place};
use crate::grid::Grid;
use crate::random::Random;
use crate::rules::Failure;

type Vector = [f64; 2];

/// Tractions of more than this part of the bound slip, by the library's documents.
const ON_THE_CIRCLE: f64 = 1.0 - 1e-7;

/// Own coefficients between elements, displaced by so many lengths.
struct Operator {
    grid: Grid,
    /// Of offsets `-(m - 1)..m`: xx, yy, xy.
    table: Vec<[f64; 3]>,
    /// What rounding may do to a displacement by tractions whose sizes add up to 1.
    rounding: f64,
}

impl Operator {
    fn new(place: &Place, by: Vector) -> Operator {
        let Grid { mx, my, dx, dy } = place.grid;
        let mean = |values: [f64; 2]| 0.5 * (values[0] / place.shear_modulus[0] + values[1] / place.shear_modulus[1]);
        let (shear, poisson) = (mean([1.0; 2]), mean(place.poisson_ratio));
        let mut largest: f64 = 0.0;
        let mut entry = |kx: i64, ky: i64| {
            let (x, y) = (kx as f64 * dx + by[0], ky as f64 * dy + by[1]);
            let mut sums = [0.0; 3];
            for (sx, sy) in [(0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)] {
                let (cx, cy) = (x + sx * dx, y + sy * dy);
                let term = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() };
                let parts = [term(cx, cy), term(cy, cx), -cx.hypot(cy)];
                largest = parts.iter().fold(largest, |largest, part| largest.max(part.abs()));
                (0..3).for_each(|k| sums[k] += 4.0 * sx * sy * parts[k]);
            }
            let [a, b, c] = sums;
            [shear * (a + b) - poisson * a, shear * (a + b) - poisson * b, poisson * c].map(|value| value / PI)
        };
        let reach = |m: usize| 1 - m as i64..m as i64;
        let table = reach(my).flat_map(|ky| reach(mx).map(move |kx| (kx, ky))).map(|(kx, ky)| entry(kx, ky)).collect();
        // Eight terms, each to some units of round-off of the largest; and the library's transforms.
        Operator { grid: place.grid, table, rounding: 64.0 * f64::EPSILON * (shear + poisson.abs()) * largest / PI }
    }

    /// The displacement of element i by tractions of 1 on element j: xx, yy, xy.
    fn between(&self, i: usize, j: usize) -> [f64; 3] {
        let (mx, my) = (self.grid.mx, self.grid.my);
        let (kx, ky) = (i % mx + mx - 1 - j % mx, i / mx + my - 1 - j / mx);
        self.table[ky * (2 * mx - 1) + kx]
    }

    /// Displacements by tractions.
    fn apply(&self, q: &[Vector]) -> Vec<Vector> {
        let displacement = |i: usize| {
            let mut u = [0.0; 2];
            for (j, q) in q.iter().enumerate().filter(|(_, q)| **q != [0.0; 2]) {
                let [xx, yy, xy] = self.between(i, j);
                u = [u[0] + xx * q[0] + xy * q[1], u[1] + xy * q[0] + yy * q[1]];
            }
            u
        };
        (0..q.len()).map(displacement).collect()
    }
}

fn length(v: Vector) -> f64 {
    v[0].hypot(v[1])
}

/// The root of the mean square, whatever the unit.
fn rms(lengths: &[f64]) -> f64 {
    let largest = lengths.iter().copied().fold(0.0, f64::max);
    if !(largest > 0.0) {
        return largest;
    }
    largest * (lengths.iter().map(|l| (l / largest).powi(2)).sum::<f64>() / lengths.len() as f64).sqrt()
}

/// What a call left of the conditions, and what it is compared with.
struct Conditions {
    left: f64,
    scale: f64,
    rounding: f64,
    /// The largest difference between the slip of the library and this one's.
    slip_error: f64,
}

/// The conditions by direct sums, of like bodies.
fn conditions(case: &Case, found: &Found, before: &[Vector]) -> Conditions {
    let slide = &case.slide;
    let step = slide.step(&case.place.grid);
    let is_steady = slide.motion == CONTACT_NORMAL_MOTION_STEADY_ROLLING;
    let (here, there) = (Operator::new(&case.place, [0.0; 2]), Operator::new(&case.place, step));
    let earlier = if is_steady { &found.q } else { before };
    let (u, u_before) = (here.apply(&found.q), there.apply(earlier));
    let size = |q: &[Vector]| q.iter().map(|q| length(*q)).sum::<f64>();
    let mut rounding = here.rounding * size(&found.q) + there.rounding * size(earlier);
    let (mut left, mut rigid, mut displaced, mut slip_error) = (Vec::new(), Vec::new(), Vec::new(), 0.0f64);
    for i in 0..found.q.len() {
        let (q, bound) = (found.q[i], slide.mu[i] * found.p[i]);
        if !(bound > 0.0) {
            continue;
        }
        let (w, largest) = slide.rigid_slip(&case.place.grid, i, found.report.creepage);
        rounding = rounding.max(8.0 * f64::EPSILON * largest + here.rounding * size(&found.q));
        let s = [0, 1].map(|k| w[k] + u[i][k] - u_before[i][k]);
        slip_error = slip_error.max(length([0, 1].map(|k| s[k] - found.slip[i][k])) - 8.0 * f64::EPSILON * largest);
        let mut rest = s;
        if length(q) >= bound * ON_THE_CIRCLE {
            let outward = q.map(|value| value / length(q));
            let along = (s[0] * outward[0] + s[1] * outward[1]).min(0.0);
            rest = [0, 1].map(|k| s[k] - along * outward[k]);
        }
        left.push(length(rest));
        rigid.push(length(w));
        displaced.push(length(if is_steady { [0, 1].map(|k| u[i][k] - u_before[i][k]) } else { u[i] }));
    }
    let or_displacements = match slide.motion {
        CONTACT_NORMAL_MOTION_SHIFT => 1.0,
        CONTACT_NORMAL_MOTION_STEADY_ROLLING if slide.has_forces() => 1.0,
        // Rolling slowly: what round-off of the displacements leaves.
        _ => 1.5e-8,
    };
    let scale = rms(&rigid).max(or_displacements * rms(&displaced));
    Conditions { left: rms(&left), scale, rounding, slip_error }
}

/// Whether steady rolling is a monotone problem, which has one solution: `B + B'` on C is positive definite, by Cholesky's
/// factors. It is not where a step is shorter than elements that are long in its direction.
fn is_monotone(case: &Case, found: &Found) -> bool {
    let step = case.slide.step(&case.place.grid);
    let (here, there) = (Operator::new(&case.place, [0.0; 2]), Operator::new(&case.place, step));
    let contact: Vec<usize> = (0..found.q.len()).filter(|&i| case.slide.mu[i] * found.p[i] > 0.0).collect();
    let n = 2 * contact.len();
    let entry = |row: usize, column: usize| {
        let [here, there] = [&here, &there].map(|operator| operator.between(contact[row / 2], contact[column / 2]));
        let k = if row % 2 == column % 2 { row % 2 } else { 2 };
        here[k] - there[k]
    };
    let mut factor = vec![0.0; n * n];
    for row in 0..n {
        for column in 0..=row {
            let (of_row, of_column) = (&factor[row * n..][..column], &factor[column * n..][..column]);
            let rest =
                entry(row, column) + entry(column, row) - of_row.iter().zip(of_column).map(|(a, b)| a * b).sum::<f64>();
            if row == column && !(rest > 0.0) {
                return false;
            }
            factor[row * n + column] = if row == column { rest.sqrt() } else { rest / factor[column * n + column] };
        }
    }
    true
}

/// A list of what was not kept.
struct Broken<'a> {
    case: &'a Case,
    failures: Vec<Failure>,
}

impl Broken<'_> {
    fn unless(&mut self, kept: bool, promise: &'static str, details: impl FnOnce() -> String) {
        if !kept {
            let details = format!("{}: {}", self.case.describe(), details());
            self.failures.push(Failure { promise, details });
        }
    }
}

/// One answer. `before`: the tractions before the step.
fn check_answer(case: &Case, found: &Found, before: &[Vector], broken: &mut Broken<'_>) {
    let status = found.status;
    if status < 0 {
        broken.unless(!found.written, "friction refused leaves outputs alone", || format!("status {status}"));
        broken.unless(!found.message.is_empty(), "friction refused says why", || format!("status {status}"));
        let reason = status == CONTACT_NORMAL_INFEASIBLE && case.may_be_infeasible();
        broken.unless(reason, "friction is refused for a reason", || format!("status {status}, {}", found.message));
        return;
    }
    if check_bounds(case, found, broken) > 0.0 && case.place.is_alike() {
        check_conditions(case, found, before, broken);
    }
}

/// Numbers, tractions within their bounds, stick and slip, and the forces; returns mu N.
fn check_bounds(case: &Case, found: &Found, broken: &mut Broken<'_>) -> f64 {
    let (status, slide) = (found.status, &case.slide);
    let numbers = found.p.iter().chain(found.q.iter().chain(&found.slip).flatten());
    broken.unless(numbers.copied().all(f64::is_finite), "friction returns numbers", || format!("status {status}"));
    let area = case.place.grid.element_area();
    let (mut carried, mut sum) = (0.0, [0.0; 2]);
    for i in 0..found.q.len() {
        // Within an area that is fixed some elements may pull.
        let (q, bound) = (found.q[i], slide.mu[i] * found.p[i].max(0.0));
        // mu p of 0 and of numbers below the smallest have tractions of 0.
        broken.unless(length(q) <= bound, "|q| <= mu p to the last bit", || {
            format!("element {i}: {q:?}, bound {bound:e}, status {status}")
        });
        let adhesion = found.adhesion[i];
        let expected = match found.p[i] > 0.0 {
            false => CONTACT_NORMAL_ADHESION_EXTERIOR,
            true if length(q) >= bound * ON_THE_CIRCLE => CONTACT_NORMAL_ADHESION_SLIP,
            true => CONTACT_NORMAL_ADHESION_STICK,
        };
        let at_edge = (length(q) - bound * ON_THE_CIRCLE).abs() <= 4.0 * f64::EPSILON * bound;
        broken.unless(adhesion == expected || at_edge && adhesion > 0, "adhesion is that of the tractions", || {
            format!("element {i}: {adhesion} for {expected}, {q:?}, bound {bound:e}, status {status}")
        });
        carried += bound * area;
        sum = [0, 1].map(|k| sum[k] + q[k] * area);
    }
    for (k, sum) in sum.into_iter().enumerate() {
        let reported = found.report.tangential_force[k];
        broken.unless((reported - sum).abs() <= 1e-12 * carried, "the force is the sum of tractions", || {
            format!("{reported:e} for {sum:e}, status {status}")
        });
        if status == CONTACT_NORMAL_OK && slide.prescribed[k] == CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE {
            let given = slide.amount[k];
            broken.unless((sum - given).abs() <= 1.001 * case.stop.tolerance * carried, "forces are met", || {
                format!("{sum:e} for {given:e}, {carried:e} carried")
            });
        }
    }
    carried
}

fn check_conditions(case: &Case, found: &Found, before: &[Vector], broken: &mut Broken<'_>) {
    let Conditions { left, scale, rounding, slip_error } = conditions(case, found, before);
    let (status, allowed) = (found.status, case.stop.tolerance * scale);
    if status == CONTACT_NORMAL_OK {
        broken.unless(
            left <= 1.000001 * allowed + rounding,
            "OK: what is left of the slip is within the tolerance",
            || {
                format!(
                    "{left:e} left of {scale:e}, rounding {rounding:e}, reported {:e}",
                    found.report.tangential_residual
                )
            },
        );
        broken.unless(slip_error <= rounding, "the slip is w + A q - u'", || format!("{slip_error:e}, {rounding:e}"));
    } else if case.stop.is_unhindered() && allowed > 10.0 * rounding {
        let is_steady = case.slide.motion == CONTACT_NORMAL_MOTION_STEADY_ROLLING;
        broken.unless(is_steady && !is_monotone(case, found), "friction of like bodies is solved", || {
            format!("status {status}, {left:e} left of {scale:e}, rounding {rounding:e}: {}", found.message)
        });
    }
}

/// What does not hold of an answer with status >= 0. `certified`: the coefficients and the slip are those that this module knows.
pub fn answer(case: &Case, found: &Found, certified: bool) -> Vec<Failure> {
    let mut broken = Broken { case, failures: Vec::new() };
    let carried = check_bounds(case, found, &mut broken);
    if certified && case.place.is_alike() && carried > 0.0 {
        check_conditions(case, found, &case.slide.before(), &mut broken);
    }
    broken.failures
}

/// Own tables xx, yy and xy over the offsets `-mx..mx` by `-my..my` of a place.
pub fn tables(place: &Place) -> Vec<Vec<f64>> {
    let Grid { mx, my, .. } = place.grid;
    let wider = Grid { mx: mx + 1, my: my + 1, ..place.grid };
    let operator = Operator::new(&Place::new(wider, place.shear_modulus, place.poisson_ratio), [0.0; 2]);
    let offsets = || (0..2 * my).flat_map(|y| (0..2 * mx).map(move |x| y * (2 * mx + 1) + x));
    (0..3).map(|k| offsets().map(|at| operator.table[at][k]).collect()).collect()
}

/// A random case: the statuses of its calls, and what was not kept.
pub fn check(random: &mut Random) -> (Case, Vec<i32>, Vec<Failure>) {
    let place = Place::random(random);
    let without = frictionless(&place, &crate::friction_case::Stop::unhindered(random));
    let case = Case::random(random, place, &without);
    let mut broken = Broken { case: &case, failures: Vec::new() };
    let twice = random.chance(0.25);
    let found = call(&case, twice);
    let before = case.slide.before();
    check_answer(&case, &found[0], &before, &mut broken);
    if let [first, second] = &found[..] {
        // From the tractions that the handle holds, where both calls came to an end.
        if first.status == CONTACT_NORMAL_OK {
            check_answer(&case, second, &first.q, &mut broken);
        }
    } else {
        let again = call(&case, false);
        let same = again[0].bits() == found[0].bits();
        broken.unless(same, "the same call with friction twice has the same bits", String::new);
    }
    if case.place.is_alike() && case.stop.cancel_at.is_none() && found[0].status >= 0 {
        let alone = frictionless(&case.place, &case.stop);
        let same = alone.p.iter().zip(&found[0].p).all(|(a, b)| a.to_bits() == b.to_bits());
        broken.unless(same, "friction of like bodies leaves the pressures alone", || format!("{}", found[0].status));
    }
    let failures = broken.failures;
    let statuses = found.iter().map(|found| found.status).collect();
    (case, statuses, failures)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By midpoints of the kernels `((1 - nu)/r + nu x^2/r^3)/(2 pi G)`, twice: two like bodies.
    #[test]
    fn the_closed_form_is_the_integral() {
        let grid = Grid { mx: 4, my: 3, dx: 0.7, dy: 0.4 };
        let place = Place::new(grid, [2.0; 2], [0.3; 2]);
        let operator = Operator::new(&place, [0.2, -0.1]);
        let (x, y, m) = (3.0 * 0.7 + 0.2, 2.0 * 0.4 - 0.1, 200);
        let mut sums = [0.0; 3];
        for i in 0..m * m {
            let at = |i: usize, d: f64| ((i as f64 + 0.5) / m as f64 - 0.5) * d;
            let (x, y) = (x - at(i % m, 0.7), y - at(i / m, 0.4));
            let r = x.hypot(y);
            let kernel =
                [0.7 / r + 0.3 * x * x / r.powi(3), 0.7 / r + 0.3 * y * y / r.powi(3), 0.3 * x * y / r.powi(3)];
            (0..3).for_each(|k| sums[k] += kernel[k] / (PI * 2.0) * 0.28 / (m * m) as f64);
        }
        let found = operator.table[4 * 7 + 6];
        for k in 0..3 {
            assert!((found[k] - sums[k]).abs() <= 1e-5 * sums[0], "{k}: {} for {}", found[k], sums[k]);
        }
    }
}
