//! The exact Hertz solution for two smooth bodies with the distance `A x^2 + B y^2 - approach` before deformation. The bodies are half-spaces whose
//! compliances add up to `1/E*`.
//!
//! The contact area is an ellipse with the semi-axes `a`, `b`, and the pressure is `p0 sqrt(1 - (x/a)^2 - (y/b)^2)` (Johnson, Contact Mechanics,
//! section 4.2). The shorter semi-axis b lies in the direction of the larger curvature B. Let `k = b/a` and `e^2 = 1 - k^2`, and let K and E be the
//! complete elliptic integrals of the modulus e. Then the displacement at the centre and the curvatures are
//!
//! ```text
//! u(0) = p0 b K / E*,    A = p0 b (K - E) / (E* e^2 a^2),    B = p0 b (E / k^2 - K) / (E* e^2 a^2)
//! ```
//!
//! The ratio `B/A` determines k. Then `approach = u(0)` determines `a^2 = approach (K - E) / (A e^2 K)`, and the force is `F = (2/3) pi a b p0`.

use std::f64::consts::PI;

use crate::bisection::bisect;
use crate::error::{invalid, positive, Number, Result};

/// The exact solution of a Hertz contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    /// The semi-axis of the contact ellipse in x.
    pub semi_axis_x: f64,
    /// The semi-axis of the contact ellipse in y.
    pub semi_axis_y: f64,
    /// The pressure p0 at the centre.
    pub max_pressure: f64,
    /// The approach of the bodies.
    pub approach: f64,
    /// The normal force F.
    pub force: f64,
    /// The area of the contact ellipse.
    pub area: f64,
}

/// Computes the Hertz contact of bodies with the undeformed distance `curvature_x x^2 + curvature_y y^2` for a prescribed approach. `compliance` is
/// `1/E*`.
pub fn hertz(curvature_x: f64, curvature_y: f64, approach: f64, compliance: f64) -> Result<Hertz> {
    check(curvature_x, curvature_y, ("approach", approach), compliance)?;
    let contact = ellipse(curvature_x, curvature_y, approach, compliance);
    contact.map_or_else(|| out_of_range(curvature_x, curvature_y, ("approach", approach)), Ok)
}

/// Computes the Hertz contact for a prescribed force F, which is proportional to the approach to the power 3/2.
pub fn hertz_by_force(curvature_x: f64, curvature_y: f64, force: f64, compliance: f64) -> Result<Hertz> {
    check(curvature_x, curvature_y, ("force", force), compliance)?;
    let unit = ellipse(curvature_x, curvature_y, 1.0, compliance);
    let by_force = |unit: Hertz| (force / unit.force).powf(2.0 / 3.0);
    let contact = unit.and_then(|unit| ellipse(curvature_x, curvature_y, by_force(unit), compliance));
    contact.map_or_else(|| out_of_range(curvature_x, curvature_y, ("force", force)), Ok)
}

/// Refuses inputs that are not positive.
fn check(curvature_x: f64, curvature_y: f64, load: (&str, f64), compliance: f64) -> Result<()> {
    let named = [("curvature_x", curvature_x), ("curvature_y", curvature_y), load, ("1/E*", compliance)];
    named.into_iter().try_for_each(|(name, value)| positive(name, value))
}

/// The error of a contact whose size, pressure or force is not a positive finite number.
fn out_of_range(curvature_x: f64, curvature_y: f64, (name, load): (&str, f64)) -> Result<Hertz> {
    let [x, y, load] = [curvature_x, curvature_y, load].map(Number);
    invalid(format!("curvature_x {x}, curvature_y {y} and {name} {load} give a contact out of range"))
}

/// Computes the contact; None if its size, pressure or force is not a positive finite number.
fn ellipse(curvature_x: f64, curvature_y: f64, approach: f64, compliance: f64) -> Option<Hertz> {
    // The long semi-axis lies in the direction of the smaller curvature.
    let (small, large) = (curvature_x.min(curvature_y), curvature_x.max(curvature_y));
    let shape = Shape::of(large / small);
    let long = (approach / (small * shape.approach_ratio)).sqrt();
    let short = shape.k * long;
    let max_pressure = approach / (compliance * short * shape.first);
    let (semi_axis_x, semi_axis_y) = if curvature_x <= curvature_y { (long, short) } else { (short, long) };
    let area = PI * long * short;
    let exact =
        Hertz { semi_axis_x, semi_axis_y, max_pressure, approach, force: 2.0 / 3.0 * area * max_pressure, area };
    let values = [long, short, area, max_pressure, exact.force];
    values.iter().all(|value| *value > 0.0 && value.is_finite()).then_some(exact)
}

/// The shape of the contact ellipse, which depends on the ratio of the curvatures only.
struct Shape {
    /// The short over the long semi-axis.
    k: f64,
    /// The complete elliptic integral of the first kind, `K(e)`.
    first: f64,
    /// `approach / (A a^2) = e^2 K / (K - E)`, with the smaller curvature A.
    approach_ratio: f64,
}

impl Shape {
    /// The shape for the ratio B/A of the larger to the smaller curvature.
    fn of(ratio: f64) -> Shape {
        // B/A is a function of k that falls from infinity at k = 0 to 1 at k = 1. Bisection in log k finds k to the last bit.
        let curvature_ratio = |k: f64| {
            let (_, d, b) = elliptic(k);
            b / d / (k * k)
        };
        let is_enough = |low: f64, high: f64| high - low <= f64::EPSILON * (1.0 - low);
        let ends = (ratio.recip().min(1.0).ln() - 1.0, 0.0);
        let (low, high) = bisect(ends, is_enough, |log| curvature_ratio(log.exp()) > ratio);
        let k = if ratio == 1.0 { 1.0 } else { (0.5 * (low + high)).exp() };
        let (first, d, _) = elliptic(k);
        Shape { k, first, approach_ratio: first / d }
    }
}

/// Computes the elliptic integrals `K`, `D = (K - E)/e^2` and `B = (E - k^2 K)/e^2` of the modulus e, where `e^2 = 1 - k^2`. The method is the
/// arithmetic-geometric mean (Abramowitz & Stegun 17.6), where `c_0 = e` and `K - E = K sum of 2^(n-1) c_n^2` over n >= 0. Then `B = K - D`.
fn elliptic(k: f64) -> (f64, f64, f64) {
    let e2 = (1.0 - k) * (1.0 + k);
    let (mut a, mut g) = (1.0, k);
    // `sum` is the sum over n >= 1 of 2^(n-1) c_n^2 / e^2. Its first term has c_1 = (1 - k)/2 and e^2 = (1 - k)(1 + k), so a factor 1 - k cancels.
    let (mut power, mut sum) = (1.0, 0.0);
    let mut c2_over_e2 = 0.25 * (1.0 - k) / (1.0 + k);
    for _ in 0..60 {
        let mean = 0.5 * (a + g);
        sum += power * c2_over_e2;
        power *= 2.0;
        g = (a * g).sqrt();
        a = mean;
        let c = 0.5 * (a - g);
        c2_over_e2 = if e2 > 0.0 { c * c / e2 } else { 0.0 };
        if c <= f64::EPSILON * a * 1e-3 {
            break;
        }
    }
    let first = PI / (2.0 * a);
    let d = first * (0.5 + sum);
    (first, d, first - d)
}
