//! Tangential influence coefficients compared with quadrature, and products with direct sums.

use std::f64::consts::PI;

use contact_normal::friction::{Compliance, Tangential, Toeplitz, Vector};
use contact_normal::grid::Grid;
use contact_normal::threads::Threads;

use super::dense;

/// A generator of numbers in [-1, 1) (Knuth's MMIX).
pub fn numbers(n: usize, mut seed: u64) -> Vec<f64> {
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..n).map(|_| next()).collect()
}

/// Nodes and weights of the 16-point Gauss-Legendre rule on [-1, 1], by Newton's method on P_16.
pub fn rule() -> Vec<(f64, f64)> {
    let n = 16;
    let legendre = |x: f64| {
        let (mut p, mut before) = (x, 1.0);
        for k in 2..=n {
            (p, before) = (((2 * k - 1) as f64 * x * p - (k - 1) as f64 * before) / k as f64, p);
        }
        (p, n as f64 * (x * p - before) / (x * x - 1.0))
    };
    let node = |i: usize| {
        let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        for _ in 0..20 {
            let (p, slope) = legendre(x);
            x -= p / slope;
        }
        let slope = legendre(x).1;
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

/// The ends of intervals whose lengths halve towards 0 if the range contains 0. On each interval a power of the distance from 0 is smooth.
pub fn panels(from: f64, to: f64) -> Vec<(f64, f64)> {
    if from < 0.0 && to > 0.0 {
        let mut all = panels(0.0, to);
        all.extend(panels(0.0, -from).into_iter().map(|(a, b)| (-b, -a)));
        return all;
    }
    // Each is at most as long as its distance from 0, down to round-off of the largest.
    let (near, far, sign) = if from.abs() < to.abs() { (from, to, 1.0) } else { (to, from, -1.0) };
    let (mut all, mut end) = (Vec::new(), far.abs());
    while end > near.abs() {
        let start = if end < 1e-18 * far.abs() { near.abs() } else { (0.5 * end).max(near.abs()) };
        all.push(if sign > 0.0 {
            (start * far.signum(), end * far.signum())
        } else {
            (end * far.signum(), start * far.signum())
        });
        end = start;
    }
    all
}

/// The integrals a, b and c of the tangential coefficients over the element: in y by the Gauss rule, on panels graded towards the singular point, and
/// in x in closed form, by the differences between both ends of `[x/r]`, `[asinh(x/|y|) - x/r]` and `[-y/r]`.
fn integrals(kx: f64, ky: f64, dx: f64, dy: f64) -> [f64; 3] {
    let (xp, xm) = ((kx + 0.5) * dx, (kx - 0.5) * dx);
    let mut sums = [0.0; 3];
    let panels = panels((ky - 0.5) * dy, (ky + 0.5) * dy);
    // Far from the element the round-off of the ends of panels exceeds that of the width, so that the sum of the weights is corrected to dy.
    let width: f64 = dy / panels.iter().map(|(from, to)| to - from).sum::<f64>();
    for (from, to) in panels {
        for (node, weight) in rule() {
            let (y, weight) = (0.5 * (from + to) + 0.5 * (to - from) * node, 0.5 * (to - from) * weight);
            let (rp, rm) = (xp.hypot(y), xm.hypot(y));
            // Both differences are computed without cancellation: that of the sines by the angle between them, and that of the asinh by the sinh of
            // the difference.
            let angle = (y.abs() * dx).atan2(xp * xm + y * y);
            let (middle, half) = (0.5 * ((xp / y.abs()).atan() + (xm / y.abs()).atan()), 0.5 * angle);
            let sine = 2.0 * middle.cos() * half.sin();
            let sinh = if xm > 0.0 { 2.0 * kx * dx * dx / (xp * rm + xm * rp) } else { (xp * rm - xm * rp) / (y * y) };
            sums[0] += weight * sine;
            sums[1] += weight * (sinh.asinh() - sine);
            sums[2] += weight * y * dx * (2.0 * kx * dx) / (rp * rm * (rp + rm));
        }
    }
    sums.map(|sum| width * sum)
}

#[test]
fn tangential_coefficients_are_those_of_quadrature() {
    let compliance = Compliance { shear: 1.0, poisson: 0.3, unlike: 0.0 };
    let near: Vec<f64> =
        (0..14).map(|k| k as f64).chain([0.3, 0.5, 1.7, 30.0, 130.0, 999.0, 16383.0, 16384.0]).collect();
    let mut worst: f64 = 0.0;
    for aspect in [1e-3, 0.02, 0.5, 1.0, 1.7, 40.0, 1e3] {
        let tangential = Tangential::new(aspect, 1.0, compliance);
        for &kx in &near {
            for &ky in &near {
                // Far along x the closed form in x loses digits: with x and y exchanged the smooth direction is integrated by the rule.
                let [a, b, c] = if kx * aspect > ky {
                    let [b, a, c] = integrals(ky, kx, 1.0, aspect);
                    [a, b, c]
                } else {
                    integrals(kx, ky, aspect, 1.0)
                };
                let expected = [(0.7 * a + b) / PI, (a + 0.7 * b) / PI, 0.3 * c / PI];
                for (sign_x, sign_y) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
                    let found = tangential.at(sign_x * kx, sign_y * ky);
                    for (component, sign) in [(0, 1.0), (1, 1.0), (2, sign_x * sign_y)] {
                        let error = (sign * found[component] - expected[component]).abs() / expected[0];
                        worst = worst.max(error);
                        // The closed form in x that the quadrature itself uses loses digits: some thousand units of round-off (1e-16).
                        assert!(error <= 1e-12, "{aspect} ({kx}, {ky}) {component}: {found:?} {expected:?}");
                    }
                }
            }
        }
    }
    assert!(worst > 0.0);
}

#[test]
fn a_tangential_line_of_elements_is_as_stiff_as_flamant_says() {
    // A strip of infinite length in y: anti-plane shear for qy, plane strain for qx (Flamant). The displacement at x by a uniform strip of width dx
    // is a constant minus (2/(pi G)) log(x) for qy and minus (2 (1 - nu)/(pi G)) log(x) for qx, with log(x) the integral of ln|x - s| over the strip.
    // The sums over ky converge for differences between two kx only.
    let (nu, m) = (0.3, 4000);
    let tangential = Tangential::new(1.0, 1.0, Compliance { shear: 1.0, poisson: nu, unlike: 0.0 });
    let column = |kx: f64, component: usize| -> f64 {
        (1..=m).rev().map(|ky| 2.0 * tangential.at(kx, ky as f64)[component]).sum::<f64>()
            + tangential.at(kx, 0.0)[component]
    };
    // The integral of ln|x - s| over the strip, s from -1/2 to 1/2.
    let log = |x: f64| (x + 0.5) * (x + 0.5).abs().ln() - (x - 0.5) * (x - 0.5).abs().ln() - 1.0;
    for (component, factor) in [(0, 1.0 - nu), (1, 1.0)] {
        let found = column(1.0, component) - column(6.0, component);
        let exact = -2.0 * factor / PI * (log(1.0) - log(6.0));
        // The sum leaves out |ky| > m: the integral of the difference of 1/r there is some (36/m^2)/pi.
        assert!((found - exact).abs() <= 36.0 / f64::from(m).powi(2), "{component}: {found} {exact}");
    }
}

#[test]
fn products_are_direct_sums() {
    // Pairs of Poisson's ratio and factors of the tractions in x and y. With a Poisson's ratio of 0 the displacements across a traction are exactly
    // 0.
    let cases = [(0.6, [1.0, 1.0]), (0.6, [0.0, 1.0]), (0.0, [1.0, 1.0]), (0.0, [1.0, 0.0]), (0.0, [0.0, 1.0])];
    for ((mx, my), (poisson, directions)) in
        [(9, 7), (1, 6), (8, 1), (1, 1), (16, 16), (5, 33)].into_iter().flat_map(|size| cases.map(|case| (size, case)))
    {
        let grid = Grid::new(mx, my, 0.5, 0.8).unwrap();
        let n = grid.len();
        let tangential = Tangential::new(0.5, 0.8, Compliance { shear: 2.0, poisson, unlike: 0.0 });
        let numbers = numbers(n, 1).into_iter().zip(numbers(n, 2));
        let q: Vec<Vector> = numbers.map(|(x, y)| [directions[0] * x, directions[1] * y]).collect();
        let scale: f64 = tangential.at(0.0, 0.0)[0] * n as f64;
        for by in [(0.0, 0.0), (1.0, 0.0), (0.3, -0.4)] {
            let mut exact = vec![[0.0; 2]; n];
            dense::apply(&tangential, &grid, by, &q, &mut exact);
            let displaced = Toeplitz::<f64>::displaced(&tangential, &grid, by, &Threads::One).unwrap();
            let single = Toeplitz::<f32>::displaced(&tangential, &grid, by, &Threads::One).unwrap();
            let mut found = vec![[0.0; 2]; n];
            let check = |found: &[Vector], allowed: f64, what: &str| {
                for (found, exact) in found.iter().zip(&exact) {
                    let error = (found[0] - exact[0]).abs().max((found[1] - exact[1]).abs());
                    let is_alone = |component: usize| directions[1 - component] == 0.0 && exact[1 - component] == 0.0;
                    let leaks =
                        (0..2).any(|component| poisson == 0.0 && is_alone(component) && found[1 - component] != 0.0);
                    assert!(!leaks, "{mx} x {my} {by:?} {what}: {found:?} leaks");
                    assert!(error <= allowed * scale, "{mx} x {my} {by:?} {what}: {found:?} {exact:?}");
                }
            };
            displaced.apply(&q, 1.0, &mut found, &mut displaced.workspace().unwrap());
            check(&found, 8.0 * f64::EPSILON, "displaced");
            single.apply(&q, 1.0, &mut found, &mut single.workspace().unwrap());
            check(&found, 8.0 * f64::from(f32::EPSILON), "single");
            if by == (0.0, 0.0) {
                let product = Toeplitz::<f64>::new(&tangential, &grid, &Threads::One).unwrap();
                product.apply(&q, 4.0, &mut found, &mut product.workspace().unwrap());
                check(&found, 8.0 * f64::EPSILON, "even");
            }
        }
    }
}

#[test]
fn the_inverse_of_the_circulant_is_near_that_of_a_product() {
    // M is the inverse of the circulant of the coefficients. For a smooth traction that ends far from the rim of the grid, M A q is q, but for
    // effects of the rim and of the periodicity.
    let grid = Grid::new(48, 40, 1.0, 1.2).unwrap();
    let tangential = Tangential::new(1.0, 1.2, Compliance { shear: 1.0, poisson: 0.3, unlike: 0.0 });
    let q: Vec<Vector> = (0..grid.len())
        .map(|i| {
            let (x, y) = ((i % 48) as f64 / 23.5 - 1.0, (i / 48) as f64 / 19.5 - 1.0);
            let bump = (1.0 - x * x).max(0.0) * (1.0 - y * y).max(0.0) * (4.0 * PI * x).cos();
            [bump, -0.5 * bump]
        })
        .collect();
    let product = Toeplitz::<f64>::new(&tangential, &grid, &Threads::One).unwrap();
    let inverse = Toeplitz::<f64>::inverse(&tangential, &grid, &Threads::One).unwrap().unwrap();
    let (mut u, mut back) = (vec![[0.0; 2]; grid.len()], vec![[0.0; 2]; grid.len()]);
    product.apply(&q, 1.0, &mut u, &mut product.workspace().unwrap());
    inverse.apply(&u, 1.0, &mut back, &mut inverse.workspace().unwrap());
    let norm = |v: &[Vector]| v.iter().map(|v| v[0] * v[0] + v[1] * v[1]).sum::<f64>().sqrt();
    let difference: Vec<Vector> = q.iter().zip(&back).map(|(q, b)| [q[0] - b[0], q[1] - b[1]]).collect();
    // M is a preconditioner, which need only be an approximate inverse: 20 % is ample.
    assert!(norm(&difference) < 0.2 * norm(&q), "{}", norm(&difference) / norm(&q));
}
