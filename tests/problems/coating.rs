//! Coatings: the transfer function and the coefficients, Hertz' contact of coated bodies, preconditioners, and combinations with other effects.

use std::f64::consts::PI;

use astro_float::{BigFloat, Consts, RoundingMode};
use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::influence::{
    radial, Base, Coated, CoatedBody, Coefficients, HalfSpace, Kernel, Response, Transfer,
};
use contact_normal::operator::Operator;
use contact_normal::scene::{Bodies, Coating, CoatingLayer, Each, Layer, Load, Patches, Period, PressureLimit, Scene};
use contact_normal::solver::{Method, Options, Outcome, Solver};
use contact_normal::threads::Threads;

use super::dense;
use crate::families::case::paraboloid;
use crate::support::{assert_conditions, run};

const RATIOS: [f64; 9] = [1e-4, 0.01, 0.1, 0.5, 0.999, 2.0, 10.0, 100.0, 1e4];

/// The coefficients of a coated body on a rigid one, with (1 - nu)/(2 pi G) = 1 for the coating.
pub fn coated(mu: f64, nu: [f64; 2], t: f64, grid: &Grid) -> Coated {
    let rigid = CoatedBody { compliance: 0.0, layer: None };
    let layer = CoatedBody { compliance: 1.0, layer: Some((t, radial(mu, nu))) };
    Coated::new([layer, rigid], grid).unwrap()
}

/// The precision of the reference for B in bits: some 100 of them cancel at s = 1e-6 and G1/G2 = 1e6.
const BITS: usize = 320;
const RM: RoundingMode = RoundingMode::ToEven;

/// The transfer function B(s) by its definition, in `BITS` bits.
fn exact_transfer(mu: f64, [nu1, nu2]: [f64; 2], s: f64, consts: &mut Consts) -> f64 {
    let big = |x: f64| BigFloat::from_f64(x, BITS);
    let (add, sub) = (|a: &BigFloat, b: &BigFloat| a.add(b, BITS, RM), |a: &BigFloat, b: &BigFloat| a.sub(b, BITS, RM));
    let (mul, div) = (|a: &BigFloat, b: &BigFloat| a.mul(b, BITS, RM), |a: &BigFloat, b: &BigFloat| a.div(b, BITS, RM));
    let (one, three, four) = (big(1.0), big(3.0), big(4.0));
    let (mu, nu1, nu2, s) = (big(mu), big(nu1), big(nu2), big(s));
    let of_substrate = add(&one, &mul(&mu, &sub(&three, &mul(&four, &nu2))));
    let lambda = sub(&one, &div(&mul(&four, &sub(&one, &nu1)), &of_substrate));
    let kappa = div(&sub(&mu, &one), &sub(&add(&mu, &three), &mul(&four, &nu1)));
    let th = mul(&big(-2.0), &s).exp(BITS, RM, consts);
    let both = mul(&mul(&lambda, &kappa), &mul(&th, &th));
    let n = sub(&add(&one, &mul(&mul(&four, &s), &mul(&kappa, &th))), &both);
    let sum = add(&add(&lambda, &kappa), &mul(&mul(&four, &kappa), &mul(&s, &s)));
    let d = add(&sub(&one, &mul(&sum, &th)), &both);
    format!("{}", div(&n, &d)).parse().unwrap()
}

#[test]
fn the_transfer_function_has_all_digits() {
    let mut consts = Consts::new().unwrap();
    let mut worst: f64 = 0.0;
    for mu in [1e-6, 1e-3, 0.1, 0.7, 1.0, 1.5, 30.0, 1e3, 1e6] {
        for nu in [[0.0, 0.0], [0.3, 0.3], [0.5, 0.0], [0.0, 0.5], [0.5, 0.5], [0.25, 0.45]] {
            let transfer = Transfer::new(mu, nu);
            for s in [1e-8, 1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.5, 0.99, 1.01, 2.0, 5.0, 10.0, 19.0, 21.0, 100.0, 300.0] {
                let exact = exact_transfer(mu, nu, s, &mut consts);
                let error = (transfer.at(s) / exact - 1.0).abs();
                assert!(error <= 5e-14, "mu {mu} nu {nu:?} s {s}: {} for {exact}", transfer.at(s));
                worst = worst.max(error);
            }
            // The Taylor coefficients give B(0), and B at a place s where twelve of them give ten digits.
            let (taylor, s) = (transfer.taylor(), 0.02 / mu.max(1.0));
            let series = taylor.iter().rev().fold(0.0, |sum, b| sum * s + b);
            assert!((taylor[0] / transfer.substrate - 1.0).abs() <= 1e-14);
            assert!((series / transfer.at(s) - 1.0).abs() <= 1e-10, "mu {mu} nu {nu:?}: {series} {}", transfer.at(s));
        }
    }
    println!("largest error of B: {worst:e}");
}

/// The coefficients of 3 x 3 elements add up to that of one element three times as long and wide, by whatever method they were computed.
#[test]
fn coefficients_add_up_to_those_of_larger_elements() {
    let mut worst: f64 = 0.0;
    for mu in RATIOS {
        for (t, nu, shape) in [
            (1e3, [0.3, 0.3], 1.0),
            (40.0, [0.5, 0.3], 0.8),
            (10.0, [0.3, 0.3], 1.0),
            (3.0, [0.0, 0.5], 0.125),
            (1.0, [0.3, 0.3], 1.0),
            (0.1, [0.5, 0.5], 8.0),
            (1e-3, [0.3, 0.2], 1.0),
        ] {
            let fine = coated(mu, nu, t, &Grid::new(154, 154, 1.0, shape).unwrap());
            let triple = coated(mu, nu, t, &Grid::new(52, 52, 3.0, 3.0 * shape).unwrap());
            for (kx, ky) in (0..50).flat_map(|ky| (0..50).map(move |kx| (kx, ky))) {
                let nine = (-1..2).flat_map(|j| (-1..2).map(move |i| (3 * kx + i, 3 * ky + j)));
                let sum: f64 = nine.map(|(kx, ky)| fine.at(kx, ky)).sum();
                let error = (sum / triple.at(kx, ky) - 1.0).abs();
                let tolerance = if (0.01..=100.0).contains(&mu) { 1e-10 } else { 1e-8 };
                assert!(error <= tolerance, "mu {mu} t {t} shape {shape} ({kx}, {ky}): {error:e}");
                worst = worst.max(error);
            }
        }
    }
    println!("largest error of nine elements: {worst:e}");
}

/// Nodes and weights of the Gauss-Legendre rule on [0, 1], by Newton's method on the polynomial.
fn gauss(n: usize) -> Vec<(f64, f64)> {
    let rule = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..6 {
            let (mut p, mut before) = (1.0, 0.0);
            for j in (0..n).map(|j| j as f64) {
                (p, before) = (((2.0 * j + 1.0) * x * p - j * before) / (j + 1.0), p);
            }
            slope = n as f64 * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        (0.5 - 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(rule).collect()
}

/// The coefficient at an offset in x by its definition: Hankel's integral `F(rho) = integral of (B(s) - 1) J0(s rho) ds` at each of the `n x n` Gauss
/// points of each of `parts x parts` parts of the element, plus Love's integral of 1/r.
pub fn by_hankel_integrals(
    mu: f64,
    nu: [f64; 2],
    t: f64,
    (dx, dy): (f64, f64),
    kx: usize,
    (parts, n): (usize, usize),
) -> f64 {
    let transfer = Transfer::new(mu, nu);
    let farthest = (kx as f64 + 1.0) * dx.max(dy) / t;
    // The panels grow from the length that belongs to a stiff plate to a part of a wave of J0. B - 1 is at most 1e-21 beyond s = 25.
    let (mut s, mut width, mut waves) = (0.0, 0.02 / mu.max(1.0), Vec::new());
    while s < 25.0 {
        for (x, weight) in gauss(12) {
            let s = s + x * width;
            waves.push((s, weight * width * (transfer.at(s) - 1.0)));
        }
        s += width;
        width = (1.4 * width).min(0.3).min(5.0 / farthest);
    }
    let mut sum = 0.0;
    let points: Vec<(f64, f64)> = (0..parts)
        .flat_map(|k| gauss(n).into_iter().map(move |(x, w)| ((k as f64 + x) / parts as f64 - 0.5, w / parts as f64)))
        .collect();
    for (x, wx) in &points {
        // The integrand is even in y.
        for (y, wy) in points.iter().filter(|(y, _)| *y > 0.0) {
            let rho = ((kx as f64 + x) * dx).hypot(y * dy) / t;
            let f: f64 = waves.iter().map(|(s, part)| part * libm::j0(s * rho)).sum();
            sum += 2.0 * wx * wy * f;
        }
    }
    HalfSpace::new(dx, dy, PI).at(kx as i64, 0) + dx * dy / t * sum
}

/// For a soft coating a coefficient is far smaller than the two parts of its definition, which cancel: as many digits are lost as 1/B(0) has.
#[test]
fn coefficients_are_direct_hankel_integrals() {
    let mut worst: f64 = 0.0;
    for mu in RATIOS {
        let nu = [0.3, 0.25];
        for (t, dy, offsets, points) in [
            (1e3, 1.0, &[0, 1, 5, 700, 16384][..], (1, 4)),
            (10.0, 0.8, &[0, 1, 4, 9, 60], (1, 6)),
            (1.0, 0.125, &[0, 1, 2, 9, 23], (1, 12)),
            (0.4, 1.0, &[0, 1, 7], (2, 12)),
        ] {
            let table = coated(mu, nu, t, &Grid::new(offsets[offsets.len() - 1] + 1, 1, 1.0, dy).unwrap());
            for &kx in offsets {
                let exact = by_hankel_integrals(mu, nu, t, (1.0, dy), kx, points);
                let error = (table.at(kx as i64, 0) / exact - 1.0).abs();
                let tolerance = if (0.01..=100.0).contains(&mu) { 1e-10 } else { 1e-8 };
                assert!(error <= tolerance, "mu {mu} t {t} offset {kx}: {error:e}");
                worst = worst.max(error);
            }
        }
    }
    println!("largest difference from Hankel integrals: {worst:e}");
}

#[test]
fn thin_thick_and_equal_coatings_are_what_they_should_be() {
    let grid = Grid::new(40, 40, 1.0, 1.0).unwrap();
    let love = HalfSpace::new(1.0, 1.0, PI);
    // A thin coating is the substrate plus the compliance B1 of a layer on the diagonal; the error is of second order.
    let (mu, t) = (0.01, 1e-3);
    let transfer = Transfer::new(mu, [0.3, 0.3]);
    let thin = transfer.substrate * love.at(0, 0) + 2.0 * PI * transfer.taylor()[1] * t;
    let found = coated(mu, [0.3, 0.3], t, &grid).at(0, 0);
    assert!((found / thin - 1.0).abs() <= 1e-6, "{found} for {thin}");
    for (t, base) in [(1e-300, transfer.substrate), (1e-30, transfer.substrate), (1e30, 1.0), (1e300, 1.0)] {
        let layer = coated(mu, [0.3, 0.3], t, &grid);
        for (kx, ky) in [(0, 0), (1, 0), (3, 7), (39, 39)] {
            let exact = base * love.at(kx, ky);
            assert!((layer.at(kx, ky) / exact - 1.0).abs() <= 1e-12, "t {t}: {} for {exact}", layer.at(kx, ky));
        }
    }
    for (kx, ky) in [(0, 0), (1, 0), (3, 7), (39, 39), (39, 45)] {
        let equal = coated(1.0, [0.3, 0.3], 2.0, &grid).at(kx, ky);
        assert!((equal / love.at(kx, ky) - 1.0).abs() <= 1e-12);
    }
}

/// One of the columns below: t/aH, a/aH, p0/pH.
type Column = (f64, f64, f64);

/// A rigid ball on a coated body, for each G1/G2: `a/aH` and `p0/pH` for four thicknesses, from an axisymmetric solution by Hankel transforms,
/// without a grid, for nu = 0.3. aH and pH are the contact radius and the largest pressure under the same force without the coating.
const HERTZ: [(f64, [Column; 4]); 6] = [
    (0.1, [(0.25, 1.45451, 0.56987), (0.5, 1.634207, 0.442380), (1.0, 1.834127, 0.331111), (2.0, 2.014819, 0.254691)]),
    (0.25, [(0.25, 1.22637, 0.75955), (0.5, 1.330897, 0.634832), (1.0, 1.446997, 0.507138), (2.0, 1.538662, 0.427224)]),
    (0.5, [(0.25, 1.09873, 0.89296), (0.5, 1.149909, 0.807562), (1.0, 1.206608, 0.704682), (2.0, 1.244859, 0.647357)]),
    (2.0, [(0.25, 0.92034, 1.07393), (0.5, 0.869692, 1.228033), (1.0, 0.818478, 1.475437), (2.0, 0.798224, 1.568452)]),
    (4.0, [(0.25, 0.84941, 1.11741), (0.5, 0.745816, 1.574471), (1.0, 0.658088, 2.283466), (2.0, 0.634293, 2.484389)]),
    (10.0, [(0.25, 0.75150, 1.14534), (0.5, 0.574649, 2.669873), (1.0, 0.482055, 4.282251), (2.0, 0.466579, 4.592785)]),
];

/// A ball of R = 1 on a substrate with E* = 1: a force of 4/3 gives aH = 1 and pH = 2/pi. The contact radius has `elements` elements.
fn ball(mu: f64, t: f64, radius: f64, elements: usize) -> (Grid, Vec<f64>, Bodies, Coating) {
    let m = 2 * (elements + elements / 5) + 1;
    let d = radius / elements as f64;
    let grid = Grid::new(m, m, d, d).unwrap();
    let h = paraboloid(&grid, 0.5);
    let bodies = Bodies { shear_modulus: [f64::INFINITY, 0.35], poisson_ratio: [0.0, 0.3] };
    let layer = CoatingLayer { thickness: t, shear_modulus: 0.35 * mu, poisson_ratio: 0.3 };
    (grid, h, bodies, Coating { layers: [None, Some(layer)] })
}

#[test]
fn a_ball_on_a_coated_body_has_the_pressures_of_the_axisymmetric_solution() {
    let mut worst: f64 = 0.0;
    for (mu, columns) in HERTZ {
        for (t, radius, pressure) in columns {
            let (grid, h, bodies, coating) = ball(mu, t, radius, 40);
            let scene = Scene { coating: Some(coating), ..Scene::new(grid, &h, bodies, Load::Force(4.0 / 3.0)) };
            let (solver, report) = run(&scene, &Options { tolerance: 1e-9, ..Options::default() });
            // The pressure in the middle is compared, because with stiff thin coatings the largest pressure is elsewhere.
            let error = (solver.state().p[grid.len() / 2] / (pressure * 2.0 / PI) - 1.0).abs();
            // The error is of second order in the elements per radius, 5e-5 for 40 of them. The digits of the table add to it.
            assert!(error <= 1e-4, "mu {mu} t {t}: p0 off by {error:e}");
            let found = (report.measures.contact_area / PI).sqrt();
            assert!((found - radius).abs() <= 0.5 * grid.dx, "mu {mu} t {t}: a {found} for {radius}");
            worst = worst.max(error);
        }
    }
    println!("largest error of p0: {worst:e}");
}

/// The number of conjugate gradient steps to 1e-8 of the right-hand side, on a fixed disc of 80 elements across.
fn steps(mu: f64, t: f64, rough: bool) -> usize {
    let m = 128;
    let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
    let coefficients = Coefficients::from(coated(mu, [0.3, 0.3], 40.0 * t, &grid));
    let operator = Operator::<f64>::new(&coefficients, &grid, &Threads::One).unwrap();
    let inverse = Operator::<f64>::inverse_circulant(&coefficients, &grid, (m, m), &Threads::One).unwrap();
    let inverse = inverse.expect("a positive preconditioner");
    let (mut memory, mut inverse_memory) = (operator.workspace().unwrap(), inverse.workspace().unwrap());
    let place = |k: usize| k as f64 - 63.5;
    let inside: Vec<bool> = (0..m * m).map(|i| place(i % m).powi(2) + place(i / m).powi(2) < 1600.0).collect();
    let masked = |v: &mut Vec<f64>| v.iter_mut().zip(&inside).for_each(|(v, inside)| *v *= f64::from(*inside));
    let mut state = 7u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let mut r: Vec<f64> = (0..m * m)
        .map(|i| if rough { random() } else { 1.0 - (place(i % m).powi(2) + place(i / m).powi(2)) / 3200.0 })
        .collect();
    masked(&mut r);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let goal = 1e-16 * dot(&r, &r);
    let (mut z, mut v, mut direction) = (vec![0.0; m * m], vec![0.0; m * m], vec![0.0; m * m]);
    let mut before = 1.0;
    for step in 0..1000 {
        if dot(&r, &r) <= goal {
            return step;
        }
        inverse.apply(&r, &mut z, &mut inverse_memory);
        masked(&mut z);
        let now = dot(&r, &z);
        let ratio = if step > 0 { now / before } else { 0.0 };
        direction.iter_mut().zip(&z).for_each(|(d, z)| *d = z + ratio * *d);
        operator.apply(&direction, &mut v, &mut memory);
        masked(&mut v);
        let length = now / dot(&direction, &v);
        r.iter_mut().zip(&v).for_each(|(r, v)| *r -= length * v);
        before = now;
    }
    panic!("mu {mu} t {t}: no end");
}

#[test]
fn preconditioners_are_positive_and_as_good_as_they_were_measured() {
    // The columns are mu, t, and the measured numbers of steps for a smooth and for a rough right-hand side. A change of the coefficients by half a
    // unit in the last place changes a number by up to two.
    #[rustfmt::skip]
    let table = [
        (0.01, 0.01, 5, 7), (0.01, 0.1, 6, 7), (0.01, 1.0, 8, 12), (0.01, 3.0, 8, 12),
        (10.0, 0.01, 11, 16), (10.0, 0.1, 9, 22), (10.0, 0.3, 8, 17), (10.0, 1.0, 8, 14), (10.0, 3.0, 8, 14),
        (100.0, 0.01, 17, 32), (100.0, 0.1, 13, 31), (100.0, 0.3, 9, 18), (100.0, 1.0, 9, 14), (100.0, 3.0, 9, 13),
    ];
    for (mu, t, smooth, rough) in table {
        let found = (steps(mu, t, false), steps(mu, t, true));
        println!("{mu} {t}: {found:?} for ({smooth}, {rough})");
        assert!(found.0 <= smooth + 2 && found.1 <= rough + 2, "mu {mu} t {t}: {found:?} for ({smooth}, {rough})");
    }
}

/// Values of a radial function: `G1/G2`, `(nu1, nu2)`, and pairs `(rho, F)`.
type Radial = (f64, [f64; 2], &'static [(f64, f64)]);

/// The radial function F_1 of a coating, computed with 30 digits (mpmath: composite quadrature of `(B - 1) J0`).
#[rustfmt::skip]
const RADIAL: [Radial; 4] = [
    (1e-4, [0.3, 0.3], &[
        (0.0, -1.3766917667552365), (0.01, -1.3766290230613736), (0.7, -1.1230244283336073),
        (1.9, -0.538762588539679), (2.1, -0.4851459620968778), (5.0, -0.20011773076526435),
        (13.0, -0.07691543254347602), (60.0, -0.016664999886491946), (300.0, -0.0033329999990929),
    ]),
    (0.01, [0.5, 0.25], &[
        (0.0, -1.7461482226213492), (0.01, -1.7460540107467197), (0.7, -1.371055653943529),
        (1.9, -0.5798081579283788), (2.1, -0.5157504676823769), (5.0, -0.20012983363098896),
        (13.0, -0.075775429864726), (60.0, -0.016416667554492243), (300.0, -0.00328333333900267),
    ]),
    (0.5, [0.3, 0.3], &[
        (0.0, -0.6404588176700088), (0.01, -0.640432341896339), (0.7, -0.5323963742470471),
        (1.9, -0.2691356475519988), (2.1, -0.24305702973069843), (5.0, -0.09967710656031595),
        (13.0, -0.038416715110213134), (60.0, -0.008332861265603616), (300.0, -0.0016666628874830664),
    ]),
    (2.0, [0.3, 0.5], &[
        (0.0, 0.8313658713185441), (0.01, 0.8313310823549201), (0.7, 0.6879729561899315),
        (1.9, 0.3205866272305541), (2.1, 0.28241082350202273), (5.0, 0.09000359201100432),
        (13.0, 0.03313063977359653), (60.0, 0.0071444792721844985),
    ]),
];

#[test]
fn radial_functions_have_fourteen_digits() {
    for (mu, ratios, values) in RADIAL {
        for &(rho, exact) in values {
            let found = radial(mu, ratios).f(rho, Base::Layer);
            // The tolerance is the round-off of sums of some 500 terms of order 1.
            assert!((found - exact).abs() <= 2e-14 * exact.abs().max(1.0), "mu {mu} rho {rho}: {found} for {exact}");
        }
    }
}

/// A surface with several contact areas, and one place without a surface.
fn bumps(m: usize, d: f64) -> (Grid, Vec<f64>) {
    let grid = Grid::new(m, m, d, d).unwrap();
    let mut h: Vec<f64> = (0..m * m)
        .map(|i| {
            let (x, y) = ((i % m) as f64 * d, (i / m) as f64 * d);
            0.02 * (2.0 - (2.1 * x).cos() - (1.7 * y).cos())
        })
        .collect();
    h[m + 3] = f64::INFINITY;
    (grid, h)
}

fn soft_and_stiff() -> Coating {
    let layer =
        |thickness, shear_modulus, poisson_ratio| Some(CoatingLayer { thickness, shear_modulus, poisson_ratio });
    Coating { layers: [layer(0.3, 0.2, 0.4), layer(0.15, 6.0, 0.2)] }
}

/// The conditions of contact hold for coated bodies with other effects and by each method, with u by direct sums over the coefficients.
#[test]
fn a_coating_goes_with_other_effects_and_methods() {
    let (m, d) = (32, 0.2);
    let (grid, h) = bumps(m, d);
    let bodies = Bodies { shear_modulus: [1.0, 2.0], poisson_ratio: [0.3, 0.25] };
    let plain = Scene { coating: Some(soft_and_stiff()), ..Scene::new(grid, &h, bodies, Load::Force(0.2)) };
    let patch: Vec<i32> = (0..m * m).map(|i| i32::from(i % m >= m / 2)).collect();
    let patches = Patches { count: 2, patch: &patch, factors: &[1.0, 0.5, 0.5, 1.0] };
    let compliances: Vec<f64> = (0..m * m).map(|i| 0.01 * (i % 7) as f64).collect();
    let scenes = [
        ("alone", plain.clone()),
        ("approach", Scene { load: Load::Approach(0.03), ..plain.clone() }),
        ("layer", Scene { layer: Some(Layer(Each::Uniform(0.02))), ..plain.clone() }),
        ("layers", Scene { layer: Some(Layer(Each::PerElement(&compliances))), ..plain.clone() }),
        ("patches", Scene { patches: Some(patches), ..plain.clone() }),
        ("period", Scene { period: Some(Period { x: true, y: true }), ..plain.clone() }),
    ];
    for (name, scene) in &scenes {
        for method in [Method::Auto, Method::ProjectedCg, Method::Norm, Method::Multigrid, Method::FullMultigrid] {
            if matches!(method, Method::Multigrid | Method::FullMultigrid)
                && ["layers", "patches", "period"].contains(name)
            {
                continue;
            }
            let (solver, report) = run(scene, &Options { method, ..Options::default() });
            let p = &solver.state().p;
            let mut u = vec![0.0; p.len()];
            dense::apply(&scene.coefficients().unwrap(), &grid, p, &mut u);
            assert_conditions(&h, report.measures.approach, p, &u, &format!("{name} {method:?}"));
        }
    }
    let limited = Scene { pressure_limit: Some(PressureLimit(Each::Uniform(0.05))), ..plain.clone() };
    let (solver, report) = run(&limited, &Options::default());
    let state = solver.state();
    let largest = state.p.iter().copied().fold(0.0, f64::max);
    assert!(largest == 0.05 && state.at_limit.contains(&true), "{largest} {report:?}");
    assert!((state.p.iter().sum::<f64>() * d * d / 0.2 - 1.0).abs() <= 1e-9);
}

#[test]
fn no_coating_in_effect_is_the_plain_scene() {
    let (grid, h) = bumps(32, 0.2);
    let bodies = Bodies { shear_modulus: [1.0, 2.0], poisson_ratio: [0.3, 0.25] };
    let plain = Scene::new(grid, &h, bodies, Load::Force(0.2));
    let (without, _) = run(&plain, &Options::default());
    let layer =
        |thickness, shear_modulus, poisson_ratio| Some(CoatingLayer { thickness, shear_modulus, poisson_ratio });
    for layers in [[None, None], [layer(0.0, 5.0, 0.1), None], [layer(0.7, 1.0, 0.3), layer(1.0, 2.0, 0.25)]] {
        let (with, _) = run(&Scene { coating: Some(Coating { layers }), ..plain.clone() }, &Options::default());
        assert_eq!(with.state().p, without.state().p);
    }
    // A coating that is so thick that it acts as a half-space.
    let thick = Coating { layers: [layer(1e15, 1.0, 0.3), None] };
    let bodies = Bodies { shear_modulus: [3.0, 2.0], poisson_ratio: [0.1, 0.25] };
    let scene = Scene { coating: Some(thick), bodies, ..plain.clone() };
    let (with, _) = run(&scene, &Options { tolerance: 1e-12, ..Options::default() });
    let (without, _) = run(&plain, &Options { tolerance: 1e-12, ..Options::default() });
    let largest = without.state().p.iter().copied().fold(0.0, f64::max);
    for (one, other) in with.state().p.iter().zip(&without.state().p) {
        assert!((one - other).abs() <= 1e-10 * largest, "{one} {other}");
    }
}

/// The displacement by a wave of pressures that are constant on elements is a sum over the aliases of the wave.
#[test]
fn periodic_coefficients_have_the_transform_of_the_layer() {
    let grid = Grid::new(12, 9, 0.3, 0.5).unwrap();
    let bodies = Bodies { shear_modulus: [1.0, 2.0], poisson_ratio: [0.3, 0.25] };
    let h = vec![0.0; grid.len()];
    let period = Some(Period { x: true, y: true });
    let scene = Scene { coating: Some(soft_and_stiff()), period, ..Scene::new(grid, &h, bodies, Load::Force(0.2)) };
    let coefficients = scene.coefficients().unwrap();
    let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
    for (i, j) in [(1, 0), (0, 2), (3, 1), (6, 4)] {
        let mut found = 0.0;
        for (kx, ky) in (0..9).flat_map(|ky| (0..12).map(move |kx| (kx, ky))) {
            found += coefficients.at(kx, ky)
                * (2.0 * PI * (i * kx) as f64 / 12.0).cos()
                * (2.0 * PI * (j * ky) as f64 / 9.0).cos();
        }
        // The aliases beyond n make 1/n^2 of the sum: the test extrapolates from n and 2 n, where a quarter of the error remains.
        let sum = |n: i64| -> f64 {
            let aliases = (-n..=n).flat_map(|a| (-n..=n).map(move |b| (a, b)));
            aliases
                .map(|(a, b)| {
                    let kx = 2.0 * PI * (i as f64 / 12.0 + a as f64) / 0.3;
                    let ky = 2.0 * PI * (j as f64 / 9.0 + b as f64) / 0.5;
                    let k = kx.hypot(ky);
                    let of = |g: f64, nu: f64, t: f64, mu: f64, below: f64| {
                        (1.0 - nu) / (g * k) * Transfer::new(mu, [nu, below]).at(k * t)
                    };
                    (of(0.2, 0.4, 0.3, 0.2, 0.3) + of(6.0, 0.2, 0.15, 3.0, 0.25)) * sinc(0.15 * kx) * sinc(0.25 * ky)
                })
                .sum()
        };
        let (less, more) = (sum(100), sum(200));
        let exact = more + (more - less) / 3.0;
        assert!((found / exact - 1.0).abs() <= 2e-5, "({i}, {j}): {found} for {exact}");
    }
}

#[test]
fn a_handle_refuses_another_coating_and_tables() {
    let (grid, h) = bumps(16, 0.2);
    let bodies = Bodies { shear_modulus: [1.0, 2.0], poisson_ratio: [0.3, 0.25] };
    let scene = Scene { coating: Some(soft_and_stiff()), ..Scene::new(grid, &h, bodies, Load::Force(0.2)) };
    let mut solver = Solver::new(&scene, &Options::default()).unwrap();
    let (stop, _) = solver.solve(&scene, &Options::default(), None, None).unwrap();
    assert_eq!(stop, Outcome::Converged);
    let mut other = scene.clone();
    other.coating = Some(Coating::of_body_1(0.3, 0.2, 0.4));
    let refused = solver.solve(&other, &Options::default(), None, None).unwrap_err();
    assert!(matches!(refused, Error::InvalidArgument(_)), "{refused}");
    other.coating = None;
    let refused = solver.solve(&other, &Options::default(), None, None).unwrap_err();
    assert!(refused.to_string().contains("coating is not given"), "{refused}");
}
