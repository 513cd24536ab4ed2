//! Surfaces with exact solutions for E* = 1. Their sizes and positions are random numbers of a fixed seed.
//!
//! For axisymmetric bodies with the profile f(r) and a contact of radius a let `g(x) = x integral from 0 to x of f'(r)/sqrt(x^2 - r^2) dr`. Then
//! (Galin 1946; Sneddon 1965)
//!
//! ```text
//! approach = g(a),    F = 2 integral from 0 to a of (g(a) - g(x)) dx,    p(r) = 1/pi integral from r to a of g'(x)/sqrt(x^2 - r^2) dx
//! ```
//!
//! For `f = c r^n` this gives `g = k c x^n` with `k = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2)`. As g is linear in f, sums of powers have sums of
//! these.
//!
//! The wave, of length L and amplitude D, is Westergaard's (1939). The mean pressure `p* = pi D/L` closes it. Under `p = p* sin^2(pi a/L)` the
//! contact is `|x| <= a` around each crest, and the approach of the mean planes is `(L p/pi)(1 - log(p/p*))`.

use std::f64::consts::{PI, TAU};

use contact_normal::analytic::hertz;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Period, Scene};

use super::random::Random;

/// Bodies with E* = 1.
pub const BODIES: Bodies = Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0, 0.0] };

/// A surface over a rectangle, with its exact solution.
pub struct Surface {
    /// The kind of surface. Tables have one row for each kind.
    pub family: &'static str,
    /// The sides of the rectangle, whose middle is the origin.
    pub size: (f64, f64),
    /// The columns and the rows of a grid for the size m, in eighths of m.
    pub eighths: (usize, usize),
    pub h: Box<dyn Fn(f64, f64) -> f64>,
    pub period: Option<Period>,
    pub approach: f64,
    pub force: f64,
    /// The largest pressure; `None`: it is infinite.
    pub max_pressure: Option<f64>,
    pub area: f64,
}

impl Surface {
    pub fn grid(&self, m: usize) -> Grid {
        let (mx, my) = (m * self.eighths.0 / 8, (m * self.eighths.1 / 8).max(1));
        Grid::new(mx, my, self.size.0 / mx as f64, self.size.1 / my as f64).expect("a grid")
    }

    /// The undeformed distance at the centres of the elements.
    pub fn distance(&self, grid: &Grid) -> Vec<f64> {
        let mut h = vec![0.0; grid.len()];
        self.write(grid, &mut h);
        h
    }

    /// Writes the undeformed distance at the centres of the elements into `h`.
    pub fn write(&self, grid: &Grid, h: &mut [f64]) {
        let centre = |i: usize, d: f64, m: usize| (i as f64 + 0.5 - 0.5 * m as f64) * d;
        for (i, value) in h.iter_mut().enumerate() {
            *value = (self.h)(centre(i % grid.mx, grid.dx, grid.mx), centre(i / grid.mx, grid.dy, grid.my));
        }
    }

    pub fn load(&self, by_force: bool) -> Load {
        if by_force {
            Load::Force(self.force)
        } else {
            Load::Approach(self.approach)
        }
    }

    pub fn scene<'a>(&self, grid: Grid, h: &'a [f64], by_force: bool) -> Scene<'a> {
        Scene { period: self.period, ..Scene::new(grid, h, BODIES, self.load(by_force)) }
    }

    /// The exact approach if the force is given, otherwise the exact force.
    pub fn exact(&self, by_force: bool) -> f64 {
        if by_force {
            self.approach
        } else {
            self.force
        }
    }
}

/// A sum of powers `c r^n` around a centre, given as pairs (n, c), with a contact of radius a.
fn axisymmetric(family: &'static str, powers: &[(f64, f64)], a: f64, centre: (f64, f64)) -> Surface {
    let terms: Vec<(f64, f64, f64)> = powers.iter().map(|&(n, c)| (n, c, c * share(n))).collect();
    let h_terms = terms.clone();
    let h = move |x: f64, y: f64| {
        let r = (x - centre.0).hypot(y - centre.1);
        h_terms.iter().map(|(n, c, _)| c * r.powf(*n)).sum()
    };
    let approach = terms.iter().map(|(n, _, k)| k * a.powf(*n)).sum();
    let force = terms.iter().map(|(n, _, k)| 2.0 * n / (n + 1.0) * k * a.powf(n + 1.0)).sum();
    let finite = terms.iter().all(|(n, ..)| *n > 1.0);
    Surface {
        family,
        size: (1.0, 1.0),
        eighths: (8, 8),
        h: Box::new(h),
        period: None,
        approach,
        force,
        max_pressure: finite.then(|| highest_pressure(&terms, a)),
        area: PI * a * a,
    }
}

/// `k = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2)`: the integral of `n t^(n-1)/sqrt(1 - t^2)` from 0 to 1, with t = sin s and by the midpoint rule.
fn share(n: f64) -> f64 {
    // The integrand is n sin^(n-1) s over a quarter of a period. The substitution s = v^2 (3 - 2 v) pi/2 removes its singular derivatives at 0.
    const POINTS: usize = 4000;
    let sum: f64 = (0..POINTS)
        .map(|i| {
            let v = (i as f64 + 0.5) / POINTS as f64;
            let (s, ds) = (v * v * (3.0 - 2.0 * v), 6.0 * v * (1.0 - v));
            n * (s * PI / 2.0).sin().powf(n - 1.0) * ds * PI / 2.0
        })
        .sum();
    sum / POINTS as f64
}

/// The maximum over r of `p(r) = 1/pi integral from 0 to sqrt(a^2 - r^2) of sum of k n (r^2 + t^2)^((n-2)/2) dt`.
fn highest_pressure(terms: &[(f64, f64, f64)], a: f64) -> f64 {
    const POINTS: usize = 2000;
    let pressure = |r: f64| {
        let end = (a * a - r * r).max(0.0).sqrt();
        let sum: f64 = (0..POINTS)
            .map(|i| {
                // The substitution t = end v^4 removes a singularity at 0.
                let v = (i as f64 + 0.5) / POINTS as f64;
                let (t, dt) = (end * v.powi(4), 4.0 * end * v.powi(3));
                let x = r * r + t * t;
                terms.iter().map(|(n, _, k)| k * n * x.powf(0.5 * (n - 2.0))).sum::<f64>() * dt
            })
            .sum();
        sum / (POINTS as f64 * PI)
    };
    let (mut best, mut at, mut step) = (pressure(0.0), 0.0, 0.02 * a);
    for i in 1..50 {
        let (r, p) = (i as f64 * step, pressure(i as f64 * step));
        if p > best {
            (best, at) = (p, r);
        }
    }
    while step > 1e-6 * a {
        step *= 0.5;
        for r in [at - step, at + step] {
            let p = if r > 0.0 { pressure(r) } else { 0.0 };
            if p > best {
                (best, at) = (p, r);
            }
        }
    }
    best
}

/// A flat punch of radius a, whose force at the approach d is F = 2 a d.
fn flat_punch(family: &'static str, a: f64, centre: (f64, f64), approach: f64) -> Surface {
    let h = move |x: f64, y: f64| if (x - centre.0).hypot(y - centre.1) < a { 0.0 } else { f64::INFINITY };
    Surface {
        h: Box::new(h),
        approach,
        force: 2.0 * a * approach,
        max_pressure: None,
        area: PI * a * a,
        ..axisymmetric(family, &[(2.0, 1.0)], a, centre)
    }
}

/// An elliptic paraboloid with rotated axes, whose curvatures have this ratio and whose contact (Hertz) has the longer semi-axis `extent`.
fn ellipse(family: &'static str, ratio: f64, angle: f64, extent: f64, centre: (f64, f64)) -> Surface {
    let (small, large) = (1.0, ratio);
    let unit = hertz(small, large, 1.0, 1.0).expect("a contact");
    // The semi-axes are proportional to the square root of the approach.
    let approach = (extent / unit.semi_axis_x).powi(2);
    let exact = hertz(small, large, approach, 1.0).expect("a contact");
    let (s, c) = angle.sin_cos();
    let h = move |x: f64, y: f64| {
        let (x, y) = (x - centre.0, y - centre.1);
        small * (c * x + s * y).powi(2) + large * (c * y - s * x).powi(2)
    };
    Surface {
        h: Box::new(h),
        approach,
        force: exact.force,
        max_pressure: Some(exact.max_pressure),
        area: exact.area,
        ..axisymmetric(family, &[(2.0, 1.0)], extent, centre)
    }
}

/// A wave along x of length 1 and amplitude 0.01 with two periods, of which `part` is in contact.
fn wave(family: &'static str, part: f64, shift: f64) -> Surface {
    let amplitude = 0.01;
    let closing = PI * amplitude;
    let mean = closing * (0.5 * PI * part).sin().powi(2);
    let h = move |x: f64, _: f64| amplitude * (1.0 - (TAU * (x - shift)).cos());
    Surface {
        // All elements in x are along the wave; in y an eighth of their number is enough.
        size: (1.0, 1.0),
        eighths: (8, 1),
        h: Box::new(h),
        period: Some(Period { x: true, y: true }),
        approach: mean / PI * (1.0 - (mean / closing).ln()),
        force: mean,
        max_pressure: Some(2.0 * mean / (0.5 * PI * part).sin()),
        area: part,
        ..axisymmetric(family, &[(2.0, 1.0)], 0.25, (0.0, 0.0))
    }
}

const POWERS: [&str; 8] = ["cone", "r^2", "r^3", "r^4", "r^5", "r^6", "r^7", "r^8"];

/// The surfaces by which the estimates were developed. Those of one family differ in size and position.
pub fn studied(random: &mut Random) -> Vec<Surface> {
    let mut all = Vec::new();
    let radius = |random: &mut Random| random.between(0.2, 0.42);
    for (n, family) in POWERS.into_iter().enumerate() {
        all.push(axisymmetric(family, &[((n + 1) as f64, 1.0)], radius(random), (0.0, 0.0)));
    }
    let place = |random: &mut Random| (random.between(-0.06, 0.06), random.between(-0.06, 0.06));
    all.push(axisymmetric("sphere off centre", &[(2.0, 1.0)], radius(random), place(random)));
    all.push(ellipse("rotated ellipse", random.between(2.0, 6.0), random.between(0.0, PI), radius(random), (0.0, 0.0)));
    let stretched = axisymmetric("elements 3:1", &[(2.0, 1.0)], radius(random), (0.0, 0.0));
    all.push(Surface { size: (1.125, 1.0), eighths: (3, 8), ..stretched });
    all.push(wave("wave", random.between(0.15, 0.85), 0.0));
    all.push(flat_punch("flat punch", radius(random), (0.0, 0.0), 0.1));
    all
}

/// Surfaces for validation only: no constant of the library was chosen by them.
pub fn held_back(random: &mut Random) -> Vec<Surface> {
    let radius = |random: &mut Random| random.between(0.2, 0.42);
    let place = |random: &mut Random| (random.between(-0.06, 0.06), random.between(-0.06, 0.06));
    let mut all = vec![
        axisymmetric("r^1.5", &[(1.5, 1.0)], radius(random), place(random)),
        axisymmetric("r^2.5", &[(2.5, 1.0)], radius(random), place(random)),
        axisymmetric("r^2 + 100 r^6", &[(2.0, 1.0), (6.0, 100.0)], radius(random), place(random)),
        axisymmetric("r^4 off centre", &[(4.0, 1.0)], radius(random), place(random)),
        axisymmetric("r^10", &[(10.0, 1.0)], radius(random), place(random)),
        axisymmetric("r + 20 r^4", &[(1.0, 1.0), (4.0, 20.0)], radius(random), place(random)),
        ellipse("slender ellipse", random.between(15.0, 30.0), random.between(0.0, PI), radius(random), place(random)),
        wave("shifted wave", random.between(0.15, 0.85), random.between(0.0, 1.0)),
        flat_punch("flat punch off centre", radius(random), place(random), 0.1),
    ];
    let stretched = axisymmetric("r^4 elements 3:1", &[(4.0, 1.0)], radius(random), place(random));
    all.push(Surface { eighths: (6, 18), ..stretched });
    all
}
