//! Displacements of coated bodies by tractions: responses to sinusoidal tractions, and influence coefficients.

use std::f64::consts::PI;

use contact_normal::friction::{Compliance, Tangential, Vector};
use contact_normal::grid::Grid;
use contact_normal::influence::{Across, Along, Coat, Response};

use super::coefficients::rule;
use super::dense;

/// The tangential coefficients of two equal bodies: a layer of thickness t with `1/G1 = 1` on a substrate with `G2 = 1/mu`.
fn coated((dx, dy): (f64, f64), t: f64, mu: f64, nu: [f64; 2]) -> Tangential {
    let [surface, below] =
        [(1.0, nu[0]), (mu, nu[1])].map(|(shear, nu)| Compliance { shear, poisson: shear * nu, unlike: 0.0 });
    Tangential::of_coated(dx, dy, surface, (Coat::new(t, mu, nu), below))
}

fn plain((dx, dy): (f64, f64), shear: f64, nu: f64) -> Tangential {
    Tangential::new(dx, dy, Compliance { shear, poisson: shear * nu, unlike: 0.0 })
}

/// `(mu, [nu1, nu2], s, L, T)`: the responses L to tractions along the wave vector and T to tractions across it. The numbers are solutions of the
/// boundary value problems: displacements in the layer and below are sums of waves that decay and grow with the depth, and their 4 or 6 factors meet
/// the conditions at the surface and at the interface. Solved in 130 digits (mpmath).
const RESPONSES: [(f64, [f64; 2], f64, f64, f64); 11] = [
    (0.0, [0.3, 0.3], 0.01, 0.014284285886859718, 0.00999966667999946),
    (0.0, [0.5, 0.3], 1.0, 0.832105526798992, 0.7615941559557649),
    (1e-3, [0.3, 0.3], 0.1, 0.14247865490515124, 0.10065796224771555),
    (0.1, [0.3, 0.25], 0.5, 0.6562970273906114, 0.5372881500088518),
    (0.5, [0.5, 0.0], 1.0, 0.9869681775673788, 0.9136709340400074),
    (2.0, [0.0, 0.5], 0.3, 0.8764617410287779, 1.4477922987684995),
    (10.0, [0.3, 0.3], 0.02, 7.235628670078232, 8.35018330807761),
    (10.0, [0.25, 0.35], 2.0, 1.1840071278496072, 1.030427010105751),
    (100.0, [0.2, 0.3], 0.005, 46.773617646602204, 66.67018516532936),
    (1e4, [0.3, 0.3], 1e-3, 476.33587652338618, 909.0912754820642),
    (1e4, [0.0, 0.5], 4.0, 1.017145659557881, 1.000671016139993),
];

#[test]
fn responses_are_those_of_the_boundary_value_problem() {
    for (mu, nu, s, along, across) in RESPONSES {
        let (l, t) = (Along::new(mu, nu), Across::new(mu));
        for (found, expected) in [(l.at(s), along), (t.at(s), across)] {
            // The formula has some ten operations without cancellation, each with a rounding error of 1e-16.
            assert!((found / expected - 1.0).abs() <= 5e-15, "{mu} {nu:?} {s}: {found:e} {expected:e}");
        }
        for (found, expected) in [(l.less_one(s), along), (t.less_one(s), across)] {
            // `less_one` computes L - 1 without the cancellation that the subtraction has.
            assert!((found - (expected - 1.0)).abs() <= 5e-15 * expected.max(1.0), "{mu} {nu:?} {s}");
        }
    }
}

/// Long waves have the response of the substrate. On a rigid substrate the response of a layer to long waves is that of its thickness, t/G1, whether
/// it is compressible or not. The Taylor coefficients are those of the function.
#[test]
fn responses_have_their_limits() {
    for mu in [0.0, 1e-6, 0.01, 0.3, 1.0, 3.0, 100.0, 1e4] {
        for nu in [[0.3, 0.3], [0.0, 0.5], [0.5, 0.0], [0.45, 0.2], [-0.5, 0.3]] {
            let (l, t) = (Along::new(mu, nu), Across::new(mu));
            let responses: [(&dyn Response, f64, f64); 2] =
                [(&l, mu * (1.0 - nu[1]) / (1.0 - nu[0]), 1.0 / (1.0 - nu[0])), (&t, mu, 1.0)];
            for (of, substrate, slope) in responses {
                let near = 1e-3 / mu.max(1.0);
                let (taylor, at) = (of.taylor(), of.at(near));
                assert!((of.substrate() - substrate).abs() <= 1e-14 * substrate);
                let series = taylor.iter().rev().fold(0.0, |sum, c| sum * near + c);
                assert!((series - at).abs() <= 1e-13 * at, "{mu} {nu:?}: {series} {at}");
                assert!((of.at(50.0) - 1.0).abs() <= 1e-15 && of.less_one(25.0).abs() <= 1e-15);
                if mu == 0.0 {
                    // The neglected terms are of relative order s^2.
                    assert!((at / (slope * near) - 1.0).abs() <= 3.0 * near * near, "{nu:?}: {at}");
                }
            }
        }
    }
}

/// `(mu, nu, t, (dx, dy), offset, Axx, Ayy, Axy)`, in 1/(pi G1) of both bodies: Hankel integrals of order 0 and 2 at 20 x 20 Gauss points of the
/// element, in 25 digits (mpmath), and the half-space's closed forms.
type Digits = (f64, [f64; 2], f64, (f64, f64), (f64, f64), [f64; 3]);

#[rustfmt::skip]
const COEFFICIENTS: [Digits; 10] = [
    (0.0, [0.3, 0.3], 1.0, (1.0, 1.0), (0.0, 0.0), [2.417339977825346, 2.417339977825346, 0.0]),
    (0.0, [0.3, 0.3], 1.0, (1.0, 1.0), (2.0, 1.0), [0.0891465496147398, 0.02960746867201025, 0.03949169967886915]),
    (0.0, [0.5, 0.3], 0.5, (1.0, 0.7), (1.0, 3.0 / 0.7), [-0.0002889395032838709, 0.004200340356422985, 0.001623223220403824]),
    (0.1, [0.25, 0.35], 0.7, (1.0, 0.5), (0.5, 0.0), [1.083380793362898, 0.9389779439750356, 0.0]),
    (0.1, [0.25, 0.35], 0.7, (1.0, 0.5), (3.0, 3.0), [0.01787252461690824, 0.01262380510255245, 0.00362696442048446]),
    (0.01, [0.0, 0.4], 2.0, (1.0, 1.3), (7.0, 2.0), [0.006425593397133447, 0.003045887856805142, 0.001446146178901681]),
    (5.0, [0.2, 0.3], 0.4, (1.0, 1.0), (1.0, 0.0), [2.511062984364987, 2.308023985645267, 0.0]),
    (5.0, [0.2, 0.3], 0.4, (1.0, 1.0), (0.25, -0.4), [4.385306396432143, 4.39756525130653, -0.04118946276931905]),
    (5.0, [0.2, 0.3], 3.0, (1.0, 1.0), (20.0, 11.0), [0.1598666058477024, 0.1381784328493525, 0.01710178297915676]),
    (100.0, [0.3, 0.2], 0.5, (1.0, 1.0), (2.0, 2.0), [4.409859288596899, 4.409859288596899, 0.09153232699854864]),
];

#[test]
fn coefficients_are_those_of_hankel_integrals() {
    for (mu, nu, t, size, (x, y), expected) in COEFFICIENTS {
        let coated = coated(size, t, mu, nu);
        let largest = coated.at(0.0, 0.0)[0];
        for (sign_x, sign_y) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
            let found = coated.at(sign_x * x, sign_y * y).map(|value| PI * value);
            for (k, sign) in [1.0, 1.0, sign_x * sign_y].into_iter().enumerate() {
                let error = (sign * found[k] - expected[k]).abs();
                // The reference is printed to 16 digits. The rest of the tolerance allows for the quadrature rules of the library beyond the
                // neighbouring elements.
                assert!(
                    error <= 2e-13 * expected[0].max(1e-2 * PI * largest),
                    "{mu} {t} ({x}, {y}) {k}: {found:?} {expected:?}"
                );
            }
        }
    }
}

/// The coefficients of 3 x 3 elements add up to that of one element three times as long and wide, by each method that the library has for
/// coefficients.
#[test]
fn coefficients_add_up() {
    let mut worst: f64 = 0.0;
    for (mu, nu) in [
        (0.0, [0.3, 0.3]),
        (0.0, [0.5, 0.3]),
        (0.01, [0.3, 0.2]),
        (0.4, [0.0, 0.5]),
        (8.0, [0.25, 0.3]),
        (300.0, [0.3, 0.3]),
    ] {
        for t in [1e-3, 0.05, 0.9, 2.5, 7.0, 45.0, 1e3] {
            for (dx, dy) in [(1.0, 1.0), (1.0, 0.3), (0.05, 1.0)] {
                let (fine, coarse) = (coated((dx, dy), t, mu, nu), coated((3.0 * dx, 3.0 * dy), t, mu, nu));
                let largest = coarse.at(0.0, 0.0)[0];
                for (x, y) in [
                    (0.0, 0.0),
                    (1.0, 0.0),
                    (0.0, 2.0),
                    (0.4, 0.1),
                    (3.0, 2.0),
                    (5.7, 0.3),
                    (12.0, 17.0),
                    (60.0, 1.0),
                    (0.0, 500.0),
                ] {
                    let mut sum = [0.0; 3];
                    for (i, j) in (0..9).map(|k| ((k % 3) as f64 - 1.0, (k / 3) as f64 - 1.0)) {
                        let at = fine.at(3.0 * x + i, 3.0 * y + j);
                        (0..3).for_each(|k| sum[k] += at[k]);
                    }
                    let whole = coarse.at(x, y);
                    for k in 0..3 {
                        let error = (sum[k] - whole[k]).abs() / largest;
                        worst = worst.max(error);
                        assert!(error <= 1e-12, "{mu} {t} {dx} x {dy} ({x}, {y}) {k}: {sum:?} {whole:?} of {largest}");
                    }
                }
            }
        }
    }
    println!("worst: {worst:e}");
}

/// Three limits: a layer of the substrate's own material, a layer much thinner than an element, and a layer thicker than the grid is long. Each acts
/// as a half-space.
#[test]
fn limits_are_half_spaces() {
    let size = (1.0, 0.7);
    for (t, mu, nu, expected, off) in [
        (2.0, 1.0, [0.3, 0.3], plain(size, 1.0, 0.3), 1e-15),
        (1e-9, 5.0, [0.2, 0.4], plain(size, 5.0, 0.4), 3e-8),
        (1e-9, 0.2, [0.4, 0.1], plain(size, 0.2, 0.1), 3e-8),
        (1e60, 0.2, [0.4, 0.1], plain(size, 1.0, 0.4), 1e-15),
        (1e9, 1e3, [0.3, 0.1], plain(size, 1.0, 0.3), 1e-5),
    ] {
        let coated = coated(size, t, mu, nu);
        let largest = expected.at(0.0, 0.0)[0];
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.3, -0.6), (4.0, 5.0), (40.0, 3.0), (-7.0, 300.0)] {
            let (found, expected) = (coated.at(x, y), expected.at(x, y));
            let error = (0..3).map(|k| (found[k] - expected[k]).abs()).fold(0.0, f64::max);
            assert!(error <= off * largest, "{t} {mu} ({x}, {y}): {found:?} {expected:?}");
        }
    }
}

/// A thin layer on a rigid substrate is a spring: the traction of an element displaces this element alone, by t/G1 of each body.
#[test]
fn thin_layers_on_rigid_bodies_are_springs() {
    for nu in [0.0, 0.3, 0.5] {
        let t = 1e-3;
        let coated = coated((1.0, 1.0), t, 0.0, [nu, 0.3]);
        let [xx, yy, _] = coated.at(0.0, 0.0);
        // Within some t of its edges the element has smaller displacements, because there are no tractions outside. This has no effect at the centre.
        assert!((xx - 2.0 * t).abs() <= 1e-13 && (yy - 2.0 * t).abs() <= 1e-13, "{nu}: {xx} {yy}");
        let far = coated.at(1.0, 0.0);
        assert!(far.iter().all(|value| value.abs() <= 1e-13), "{nu}: {far:?}");
    }
}

/// Displacements equal a Fourier integral that the test computes itself. The load has the shape of a Gaussian so wide that the sampling by elements
/// causes no aliases.
#[test]
fn products_are_those_of_the_fourier_plane() {
    let (width, mu, nu, t) = (1.6, 0.2, [0.35, 0.2], 4.0);
    let grid = Grid::new(41, 45, 1.0, 0.8).unwrap();
    let coated = coated((grid.dx, grid.dy), t, mu, nu);
    let place = |i: usize| [((i % 41) as f64 - 14.0) * grid.dx, ((i / 41) as f64 - 20.0) * grid.dy];
    let q: Vec<Vector> = (0..grid.len())
        .map(|i| {
            let [x, y] = place(i);
            let shape = (-0.5 * (x * x + y * y) / (width * width)).exp();
            [shape, -0.6 * shape]
        })
        .collect();
    let by = (0.4, -0.25);
    let mut u = vec![[0.0; 2]; grid.len()];
    dense::apply(&coated, &grid, by, &q, &mut u);
    // The half-space of the layer's material is subtracted: the rest of the response decays as exp(-2 k t), and so do the aliases.
    let mut half_space = vec![[0.0; 2]; grid.len()];
    dense::apply(&plain((grid.dx, grid.dy), 1.0, nu[0]), &grid, by, &q, &mut half_space);
    let response = |k: f64| {
        let (s, th) = (k * t, (-2.0 * k * t).exp());
        let lambda = 1.0 - 4.0 * (1.0 - nu[0]) / (1.0 + mu * (3.0 - 4.0 * nu[1]));
        let kappa = (mu - 1.0) / (mu + 3.0 - 4.0 * nu[0]);
        let n = 1.0 - 4.0 * s * kappa * th - lambda * kappa * th * th;
        let d = 1.0 - (lambda + kappa + 4.0 * kappa * s * s) * th + lambda * kappa * th * th;
        [2.0 * (1.0 - nu[0]) * (n / d - 1.0) / k, 2.0 * ((mu + s.tanh()) / (1.0 + mu * s.tanh()) - 1.0) / k]
    };
    let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
    for (ix, iy) in [(14, 20), (17, 21), (25, 36), (38, 15)] {
        let i = iy * 41 + ix;
        let [x, y] = place(i);
        let (x, y) = (x + by.0 * grid.dx, y + by.1 * grid.dy);
        let mut sum = [0.0; 2];
        let (last, panels, rays) = (7.0, 24, 240);
        for panel in 0..panels {
            for (node, weight) in rule() {
                let (width_of, middle) = (last / panels as f64, (panel as f64 + 0.5) * last / panels as f64);
                let k = middle + 0.5 * width_of * node;
                let [along, across] = response(k);
                let amplitude = 2.0 * PI * width * width * (-0.5 * (k * width).powi(2)).exp();
                for ray in 0..rays {
                    let (sine, cosine) = (2.0 * PI * ray as f64 / rays as f64).sin_cos();
                    let (kx, ky) = (k * cosine, k * sine);
                    let wave =
                        amplitude * sinc(0.5 * kx * grid.dx) * sinc(0.5 * ky * grid.dy) * (kx * x + ky * y).cos();
                    let part = 0.5 * width_of * weight * k * wave * 2.0 * PI / rays as f64 / (4.0 * PI * PI);
                    let lengthwise = cosine * 1.0 - sine * 0.6;
                    let sideways = -sine * 1.0 - cosine * 0.6;
                    sum[0] += part * (along * lengthwise * cosine - across * sideways * sine);
                    sum[1] += part * (along * lengthwise * sine + across * sideways * cosine);
                }
            }
        }
        // Loads beyond the grid and aliases are 1e-16 of the largest displacement. 1e-12 leaves room for the round-off of the sums.
        for k in 0..2 {
            let found = u[i][k] - half_space[i][k];
            assert!((found - sum[k]).abs() <= 1e-12 * u[20 * 41 + 14][0], "({ix}, {iy}) {k}: {found} {sum:?}");
        }
    }
}
