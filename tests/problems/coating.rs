//! Coatings: the transfer function and the coefficients, Hertz contact of coated bodies, preconditioners, effects that combine.

use std::f64::consts::PI;

use astro_float::{BigFloat, Consts, RoundingMode};
use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::influence::{radial, Coated, CoatedBody, Coefficients, HalfSpace, Kernel, Transfer};
use contact_normal::operator::{dense, Operator};
use contact_normal::scene::{Bodies, Coating, CoatingLayer, Layer, Load, Patches, Period, PressureLimit, Scene};
use contact_normal::solver::{solve, Method, Options, Solver, Stop};
use contact_normal::threads::Threads;

use crate::support::{assert_conditions, run};

const RATIOS: [f64; 9] = [1e-4, 0.01, 0.1, 0.5, 0.999, 2.0, 10.0, 100.0, 1e4];

/// One coated body on a rigid one, with (1 - nu)/(2 pi G) = 1 at its surface.
fn coated(mu: f64, nu: [f64; 2], t: f64, grid: &Grid) -> Coated {
    let rigid = CoatedBody { compliance: 0.0, layer: None };
    let layer = CoatedBody { compliance: 1.0, layer: Some((t, radial(mu, nu))) };
    Coated::new([layer, rigid], grid).unwrap()
}

/// Bits of the reference for B: at s = 1e-6 and G1/G2 = 1e6 some 100 of them cancel.
const BITS: usize = 320;
const RM: RoundingMode = RoundingMode::ToEven;

/// B(s) from its definition.
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
            // Its Taylor coefficients: B(0), and B at a place where twelve of them have ten digits.
            let (taylor, s) = (transfer.taylor(), 0.02 / mu.max(1.0));
            let series = taylor.iter().rev().fold(0.0, |sum, b| sum * s + b);
            assert!((taylor[0] / transfer.substrate - 1.0).abs() <= 1e-14);
            assert!((series / transfer.at(s) - 1.0).abs() <= 1e-10, "mu {mu} nu {nu:?}: {series} {}", transfer.at(s));
        }
    }
    println!("largest error of B: {worst:e}");
}

/// Nine elements are one that is three times as long and wide: sums that know nothing of how either was computed.
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

#[test]
fn thin_thick_and_equal_coatings_are_what_they_should_be() {
    let grid = Grid::new(40, 40, 1.0, 1.0).unwrap();
    let love = HalfSpace::new(1.0, 1.0, PI);
    // Thin: the substrate, and the compliance B1 of a layer on the diagonal; what is left is of second order.
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

/// A rigid ball on a coated body: `a/aH` and `p0/pH` of an axisymmetric solution by Hankel transforms, without a grid, nu = 0.3; aH and pH
/// are those of the same force on the substrate alone.
const HERTZ: [(f64, [(f64, f64, f64); 4]); 6] = [
    (0.1, [(0.25, 1.45451, 0.56987), (0.5, 1.634207, 0.442380), (1.0, 1.834127, 0.331111), (2.0, 2.014819, 0.254691)]),
    (0.25, [(0.25, 1.22637, 0.75955), (0.5, 1.330897, 0.634832), (1.0, 1.446997, 0.507138), (2.0, 1.538662, 0.427224)]),
    (0.5, [(0.25, 1.09873, 0.89296), (0.5, 1.149909, 0.807562), (1.0, 1.206608, 0.704682), (2.0, 1.244859, 0.647357)]),
    (2.0, [(0.25, 0.92034, 1.07393), (0.5, 0.869692, 1.228033), (1.0, 0.818478, 1.475437), (2.0, 0.798224, 1.568452)]),
    (4.0, [(0.25, 0.84941, 1.11741), (0.5, 0.745816, 1.574471), (1.0, 0.658088, 2.283466), (2.0, 0.634293, 2.484389)]),
    (10.0, [(0.25, 0.75150, 1.14534), (0.5, 0.574649, 2.669873), (1.0, 0.482055, 4.282251), (2.0, 0.466579, 4.592785)]),
];

/// E* = 1 of the substrate and R = 1: a force of 4/3 gives aH = 1 and pH = 2/pi.
fn ball(mu: f64, t: f64, radius: f64, elements: usize) -> (Grid, Vec<f64>, Bodies, Coating) {
    let m = 2 * (elements + elements / 5) + 1;
    let d = radius / elements as f64;
    let grid = Grid::new(m, m, d, d).unwrap();
    let place = |k: usize| (k as f64 - (m / 2) as f64) * d;
    let h = (0..grid.len()).map(|i| 0.5 * (place(i % m).powi(2) + place(i / m).powi(2))).collect();
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
            // Of stiff thin coatings the largest pressure is not in the middle.
            let error = (solver.state().p[grid.len() / 2] / (pressure * 2.0 / PI) - 1.0).abs();
            // Second order in the elements to the radius: 5e-5 at 40, and the digits of the table.
            assert!(error <= 1e-4, "mu {mu} t {t}: p0 off by {error:e}");
            let found = (report.measures.contact_area / PI).sqrt();
            assert!((found - radius).abs() <= 0.5 * grid.dx, "mu {mu} t {t}: a {found} for {radius}");
            worst = worst.max(error);
        }
    }
    println!("largest error of p0: {worst:e}");
}

/// Steps of conjugate gradients on a fixed disc of 80 elements across, to 1e-8 of the right-hand side.
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
    let table = [
        (0.01, 0.01, 5, 7),
        (0.01, 0.1, 6, 7),
        (0.01, 1.0, 8, 12),
        (0.01, 3.0, 8, 12),
        (10.0, 0.01, 11, 16),
        (10.0, 0.1, 9, 22),
        (10.0, 0.3, 8, 17),
        (10.0, 1.0, 8, 14),
        (10.0, 3.0, 8, 14),
        (100.0, 0.01, 17, 31),
        (100.0, 0.1, 13, 31),
        (100.0, 0.3, 9, 18),
        (100.0, 1.0, 9, 14),
        (100.0, 3.0, 9, 13),
    ];
    for (mu, t, smooth, rough) in table {
        let found = (steps(mu, t, false), steps(mu, t, true));
        println!("{mu} {t}: {found:?} for ({smooth}, {rough})");
        assert!(found.0 <= smooth + 2 && found.1 <= rough + 2, "mu {mu} t {t}: {found:?} for ({smooth}, {rough})");
    }
}
