//! Stresses below the surface, compared with direct sums, with closed forms of elasticity, with equilibrium, and with the exact stresses under a
//! ball.

use std::f64::consts::PI;

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::stress::{
    principal, stress_at_points, subsurface_stress, von_mises, Body, Depth, Loads, Maximum, Tensor, Wanted,
};
use contact_normal::threads::Threads;

const ALL: Wanted =
    Wanted { components: [true; 6], von_mises: true, maximum_shear: true, principal: true, directions: true };
const TENSOR: Wanted =
    Wanted { components: [true; 6], von_mises: false, maximum_shear: false, principal: false, directions: false };

/// Pseudo-random numbers in [-1, 1], the same each time.
fn noise(seed: u64, n: usize) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    (0..n)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        })
        .collect()
}

fn body(mx: usize, my: usize, dx: f64, dy: f64, poisson_ratio: f64) -> Body {
    Body { grid: Grid::new(mx, my, dx, dy).unwrap(), poisson_ratio, periodic: false }
}

fn all_depths(body: &Body, loads: &Loads<'_>, depths: &[f64], wanted: &Wanted, threads: usize) -> Vec<Depth> {
    let mut found = Vec::new();
    let threads = Threads::new(threads).unwrap();
    let done = subsurface_stress(body, loads, depths, wanted, &threads, None, |k, depth| {
        assert_eq!(k, found.len());
        found.push(depth.clone());
    });
    assert!(done.unwrap());
    found
}

fn tensor(depth: &Depth, i: usize) -> Tensor {
    std::array::from_fn(|c| depth.stress[c][i])
}

fn at(body: &Body, loads: &Loads<'_>, points: &[[f64; 3]]) -> Vec<Tensor> {
    let half = [0.5 * body.grid.mx as f64 * body.grid.dx, 0.5 * body.grid.my as f64 * body.grid.dy];
    let points: Vec<[f64; 3]> = points.iter().map(|[x, y, z]| [x - half[0], y - half[1], *z]).collect();
    let mut out = vec![[f64::NAN; 6]; points.len()];
    stress_at_points(body, loads, &points, &Threads::One, None, &mut out).unwrap();
    out
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |l: f64, v| l.max(v.abs()))
}

/// Products by FFT equal direct sums, for random loads on many grids, also slender ones and a single element.
#[test]
fn products_are_direct_sums() {
    let depths = [0.0, 1e-12, 0.3, 2.0, 17.0, 1e6];
    for (mx, my, dx, dy) in
        [(13, 8, 1.0, 0.7), (1, 1, 1.0, 1.0), (40, 1, 1.0, 1.0), (2, 37, 0.1, 0.1), (9, 9, 1.0, 6.0)]
    {
        let body = body(mx, my, dx, dy, 0.3);
        let [p, qx, qy] = [1, 2, 3].map(|seed| noise(seed, mx * my));
        let loads = Loads { pressure: Some(&p), traction_x: Some(&qx), traction_y: Some(&qy), ..Loads::default() };
        for (depth, z) in all_depths(&body, &loads, &depths, &TENSOR, 1).iter().zip(depths) {
            let centre = |i: usize| [((i % mx) as f64 + 0.5) * dx, ((i / mx) as f64 + 0.5) * dy, z];
            let points: Vec<_> = (0..mx * my).map(centre).collect();
            for (i, exact) in at(&body, &loads, &points).iter().enumerate() {
                for (found, exact) in tensor(depth, i).iter().zip(exact) {
                    let error = (found - exact).abs();
                    // Loads are at most 1. Only far away, where kernels are small, those of both sums differ, by 1e-12 of their largest value.
                    assert!(error <= 1e-13, "{mx} x {my}, z {z}, element {i}: {error:e}");
                }
            }
        }
    }
}

/// Products by FFT equal direct sums at some of the elements, in hard cases: a long strip, one element, nu = 1/2, and depths from 0 to a million
/// elements.
#[test]
fn hard_cases_are_direct_sums() {
    for (mx, my, dx, dy, nu) in [(4099, 7, 1.0, 1.0, 0.5), (7, 4099, 0.3, 1.0, 0.0), (1, 1, 2.0, 0.5, 0.5)] {
        let (body, unit) = (body(mx, my, dx, dy, nu), f64::max(dx, dy));
        let [p, qx, qy] = [1, 2, 3].map(|seed| noise(seed, mx * my));
        let loads = Loads { pressure: Some(&p), traction_x: Some(&qx), traction_y: Some(&qy), ..Loads::default() };
        let depths = [0.0, 1e-12 * unit, 0.5 * unit, 30.0 * unit, 1e6 * unit];
        for (depth, z) in all_depths(&body, &loads, &depths, &TENSOR, 1).iter().zip(depths) {
            let chosen: Vec<usize> = (0..4).map(|k| k * (mx * my - 1) / 3).collect();
            let centre = |i: usize| [((i % mx) as f64 + 0.5) * dx, ((i / mx) as f64 + 0.5) * dy, z];
            let points: Vec<_> = chosen.iter().map(|&i| centre(i)).collect();
            for (&i, exact) in chosen.iter().zip(at(&body, &loads, &points)) {
                for (c, (found, exact)) in tensor(depth, i).into_iter().zip(exact).enumerate() {
                    // Loads are at most 1, as above. Far away, kernels by Gauss points and by means differ by 1e-12 of their small values.
                    let error = (found - exact).abs();
                    assert!(error <= 1e-13, "{mx} x {my}, z {z}, element {i}, component {c}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn at_the_surface_stresses_are_the_loads() {
    let body = body(33, 20, 0.2, 0.3, 0.28);
    let [p, qx, qy] = [4, 5, 6].map(|seed| noise(seed, 33 * 20));
    let loads = Loads { pressure: Some(&p), traction_x: Some(&qx), traction_y: Some(&qy), ..Loads::default() };
    let surface = &all_depths(&body, &loads, &[0.0], &TENSOR, 1)[0];
    for (c, load) in [(2, &p), (4, &qx), (5, &qy)] {
        for (stress, load) in surface.stress[c].iter().zip(load) {
            assert!((stress + load).abs() <= 1e-13, "component {c}: {stress} for {}", -load);
        }
    }
}

/// Closed forms: on the axis of a rectangle (Love 1929), and plane strain under a long strip (Johnson, section 2.5).
#[test]
fn a_rectangle_and_a_strip_have_their_closed_forms() {
    let (a, b) = (1.5, 0.5);
    let rectangle = body(1, 1, 2.0 * a, 2.0 * b, 0.3);
    for z in [0.01, 0.4, 1.0, 3.0, 20.0] {
        let found = at(&rectangle, &Loads::pressure(&[1.0]), &[[a, b, z]])[0];
        let r = (a * a + b * b + z * z).sqrt();
        let sum = (a * b / (z * r)).atan() + a * b * z / r * (1.0 / (a * a + z * z) + 1.0 / (b * b + z * z));
        assert!((found[2] + 2.0 / PI * sum).abs() <= 2e-14, "z {z}: {}", found[2]);
    }
    // A strip of half-width 1 and length 2e4. The closed form is in terms of angles; the ends change it by about 1/length.
    let strip = body(1, 1, 2.0, 2e4, 0.3);
    for (x, z) in [(0.0, 1.0), (0.7, 0.5), (1.4, 0.3)] {
        let [xx, yy, zz, ..] = at(&strip, &Loads::pressure(&[1.0]), &[[x + 1.0, 1e4, z]])[0];
        let (one, two) = (f64::atan2(z, x - 1.0), f64::atan2(z, x + 1.0));
        let (sum, difference) = (2.0 * (one - two), (2.0 * one).sin() - (2.0 * two).sin());
        let exact = [-(sum + difference) / (2.0 * PI), -(sum - difference) / (2.0 * PI)];
        assert!((xx - exact[0]).abs() <= 1e-4 && (zz - exact[1]).abs() <= 1e-4, "{x}, {z}: {xx} {zz} for {exact:?}");
        assert!((yy - 0.3 * (xx + zz)).abs() <= 1e-4);
    }
}

/// Equilibrium, `d sij/dxj = 0`, by central differences. Their error is of second order in the step of 1e-3, plus round-off of 1e-16 over 2e-3.
#[test]
fn stresses_are_in_equilibrium() {
    let body = body(5, 4, 1.0, 0.8, 0.3);
    let [p, qx, qy] = [7, 8, 9].map(|seed| noise(seed, 20));
    let loads = Loads { pressure: Some(&p), traction_x: Some(&qx), traction_y: Some(&qy), ..Loads::default() };
    let step = 1e-3;
    for point in [[2.3, 1.1, 0.4], [0.2, 3.0, 1.5], [7.1, -2.0, 0.7], [30.0, 11.0, 4.0]] {
        let moved = |axis: usize, by: f64| {
            let mut point = point;
            point[axis] += by;
            point
        };
        let places: Vec<_> = (0..3).flat_map(|axis| [moved(axis, step), moved(axis, -step)]).collect();
        let found = at(&body, &loads, &places);
        let slope = |axis: usize, c: usize| (found[2 * axis][c] - found[2 * axis + 1][c]) / (2.0 * step);
        // The components of the rows of the tensor: xx xy xz, xy yy yz, xz yz zz.
        for row in [[0, 3, 4], [3, 1, 5], [4, 5, 2]] {
            let sum: f64 = row.into_iter().enumerate().map(|(axis, c)| slope(axis, c)).sum();
            assert!(sum.abs() <= 2e-5, "{point:?}: {sum:e}");
        }
    }
}

/// The force on the surface passes through the plane at each depth. Kernels are even. So the sum of a stress over a window of elements below one
/// loaded element equals the stress below the middle of a load on the whole window. For pressures this is Love's closed form (1929), for tractions
/// that of `V_z - z V_xx`. The rest of the force passes through the plane outside the window.
#[test]
fn forces_pass_through_each_depth() {
    let m = 121;
    let (body, half) = (body(m, m, 1.0, 1.0, 0.3), 0.5 * m as f64);
    let load: Vec<f64> = (0..m * m).map(|i| f64::from(i == m * m / 2)).collect();
    let loads = Loads { pressure: Some(&load), traction_x: Some(&load), traction_y: Some(&load), ..Loads::default() };
    let depths = [0.0, 0.5, 2.0, 8.0, 32.0, 200.0];
    for (depth, z) in all_depths(&body, &loads, &depths, &TENSOR, 1).iter().zip(depths) {
        let (a2, r) = (half * half, (2.0 * half * half + z * z).sqrt());
        let angle = 2.0 * a2.atan2(a2 + z * z + z * r);
        let normal = 2.0 / PI * (angle + 2.0 * a2 * z / (r * (a2 + z * z)));
        let shear = 2.0 / PI * (angle - a2 * z / (r * (a2 + z * z)));
        let sum = |c: usize| -depth.stress[c].iter().sum::<f64>();
        println!("z {z}: szz {:.6}, sxz {:.6}", sum(2), sum(4));
        for (found, exact) in [(sum(2), normal), (sum(4), shear), (sum(5), shear)] {
            // The error of a kernel is 1e-12 of the largest component at its place. The largest components add up to about 3.
            assert!((found - exact).abs() <= 1e-11, "z {z}: {found} for {exact}");
        }
        // sxy is odd in x or in y for each load, so that its sum is 0.
        assert!(depth.stress[3].iter().sum::<f64>().abs() <= 1e-11);
    }
}

/// The Hertz pressures of a ball, sqrt(1 - (r/a)^2) at the centres of elements. The radius a = 1 has n elements, with `more` elements outside.
fn ball(n: usize, more: usize) -> (Body, Vec<f64>) {
    let m = 2 * (n + more) + 1;
    let d = 1.0 / n as f64;
    let body = body(m, m, d, d, 0.3);
    let place = |k: usize| (k as f64 - (n + more) as f64) * d;
    let pressure = (0..m * m).map(|i| (1.0 - place(i % m).powi(2) - place(i / m).powi(2)).max(0.0).sqrt()).collect();
    (body, pressure)
}

#[test]
fn under_a_ball_are_the_stresses_of_hertz() {
    // The largest error is of second order in dx/a, 1.4e-4 p0 for dx = a/32. The shear at .48 a is 0.310020 (Johnson, eq. 3.45 and 4.24).
    for (n, tolerance, of_shear) in [(16, 6e-4, 2e-4), (32, 2e-4, 5e-5)] {
        let (body, pressure) = ball(n, 0);
        let depths: Vec<f64> = (1..=100).map(|k| 0.02 * k as f64).collect();
        let found = all_depths(&body, &Loads::pressure(&pressure), &depths, &ALL, 1);
        let centre = body.grid.len() / 2;
        for (depth, z) in found.iter().zip(&depths) {
            let zz = -1.0 / (1.0 + z * z);
            let radial = -1.3 * (1.0 - z * (1.0 / z).atan()) - 0.5 * zz;
            let [xx, yy, now, xy, xz, yz] = tensor(depth, centre);
            assert!((now - zz).abs() <= tolerance && (xx - radial).abs() <= tolerance, "z {z}: {now} {xx}");
            assert!((yy - xx).abs() <= 1e-13 && largest(&[xy, xz, yz]) <= 1e-13);
        }
        let (shear, mises) = (found[23].maximum_shear[centre], found[23].von_mises[centre]);
        assert!((shear - 0.310020).abs() <= of_shear, "{shear}");
        assert!((mises - 2.0 * shear).abs() <= 1e-13, "{mises}");
    }
}

/// The largest shear is .3100205 p0 at .480864 a (from the closed form on the axis). The depths are .001 a apart, and the depth that is found is off
/// by at most two of these.
#[test]
fn the_largest_shear_under_a_ball_is_at_its_depth() {
    let (body, pressure) = ball(32, 0);
    let depths: Vec<f64> = (0..81).map(|k| 0.44 + 0.001 * k as f64).collect();
    let wanted = Wanted { maximum_shear: true, ..Wanted::default() };
    let mut maximum = None;
    let loads = Loads::pressure(&pressure);
    for (k, depth) in all_depths(&body, &loads, &depths, &wanted, 2).iter().enumerate() {
        Maximum::join(&mut maximum, &depth.maximum_shear, k, (&body.grid, &loads));
    }
    let Maximum { value, depth, ix, iy } = maximum.unwrap();
    println!("{value} at {}", depths[depth]);
    assert!(
        (value - 0.3100205).abs() <= 1e-4 && (depths[depth] - 0.480864).abs() <= 2e-3,
        "{value} at {}",
        depths[depth]
    );
    assert_eq!((ix, iy), (32, 32));
}

/// The reference is a polar quadrature of point forces over the disc, without a grid: the largest von Mises stress is .647593 p0 at x = .2703 a, z =
/// .4441 a.
#[test]
fn a_sliding_ball_yields_first_where_it_should() {
    let n = 32;
    let (body, pressure) = ball(n, 0);
    let traction: Vec<f64> = pressure.iter().map(|p| 0.25 * p).collect();
    let depths: Vec<f64> = (40..50).map(|k| 0.01 * k as f64).collect();
    let wanted = Wanted { von_mises: true, ..Wanted::default() };
    let loads = Loads { pressure: Some(&pressure), traction_x: Some(&traction), traction_y: None, ..Loads::default() };
    let mut maximum = None;
    for (k, depth) in all_depths(&body, &loads, &depths, &wanted, 2).iter().enumerate() {
        Maximum::join(&mut maximum, &depth.von_mises, k, (&body.grid, &loads));
    }
    let Maximum { value, depth, ix, iy } = maximum.unwrap();
    let (x, z) = ((ix as f64 - n as f64) / n as f64, depths[depth]);
    assert!((value - 0.647593).abs() <= 5e-4, "{value}");
    assert!((x - 0.2703).abs() <= 1.0 / n as f64 && iy == n && (z - 0.4441).abs() <= 0.02, "({x}, {iy}, {z})");
}

#[test]
fn principal_stresses_turn_the_tensor_into_a_diagonal() {
    let mut tensors: Vec<Tensor> = (0..200).map(|k| noise(k, 6).try_into().unwrap()).collect();
    tensors.extend([[0.0; 6], [1.0, 1.0, 1.0, 0.0, 0.0, 0.0], [2.0, 2.0, -1.0, 1e-9, 0.0, 1e-12]]);
    tensors.extend([
        [1e-200, 0.0, 0.0, 1e-200, 0.0, 0.0],
        [1e200, -1e200, 3.0, 1e200, 1.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    ]);
    for tensor in tensors {
        let [xx, yy, zz, xy, xz, yz] = tensor;
        let (matrix, scale) = ([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], largest(&tensor));
        let found = principal(tensor);
        let [one, two, three] = found.stresses;
        assert!(one >= two && two >= three, "{found:?}");
        for k in 0..3 {
            let v = found.directions[k];
            for i in 0..3 {
                let product: f64 = (0..3).map(|j| matrix[i][j] * v[j]).sum();
                assert!((product - found.stresses[k] * v[i]).abs() <= 4e-15 * scale, "{tensor:?}: {found:?}");
                let dot: f64 = (0..3).map(|j| found.directions[i][j] * v[j]).sum();
                assert!((dot - f64::from(i == k)).abs() <= 4e-15, "{tensor:?}: {found:?}");
            }
        }
        let by_principal = (0.5 * ((one - two).powi(2) + (two - three).powi(2) + (three - one).powi(2))).sqrt();
        let mises = von_mises(tensor);
        assert!(!by_principal.is_normal() || (mises - by_principal).abs() <= 1e-14 * scale, "{mises} {by_principal}");
    }
}

#[test]
fn what_is_not_wanted_is_not_computed_and_does_not_change_what_is() {
    let body = body(12, 9, 1.0, 1.0, 0.3);
    let pressure = noise(1, 108);
    let loads = Loads::pressure(&pressure);
    let all = &all_depths(&body, &loads, &[0.7], &ALL, 1)[0];
    let only = Wanted { components: [false, false, true, false, false, false], ..Wanted::default() };
    let one = &all_depths(&body, &loads, &[0.7], &only, 1)[0];
    assert_eq!(one.stress[2], all.stress[2]);
    assert!([0, 1, 3, 4, 5].into_iter().all(|c| one.stress[c].is_empty()));
    assert!(one.von_mises.is_empty() && one.maximum_shear.is_empty() && one.principal[0].is_empty());
}

#[test]
fn threads_units_and_depths_in_any_order_change_no_bit() {
    let [p, q] = [1, 2].map(|seed| noise(seed, 35 * 21));
    let loads = Loads { pressure: Some(&p), traction_x: None, traction_y: Some(&q), ..Loads::default() };
    let depths = [3.0, 0.0, 0.4, 40.0, 0.1];
    let one = all_depths(&body(35, 21, 1.0, 0.5, 0.3), &loads, &depths, &ALL, 1);
    let two = all_depths(&body(35, 21, 1.0, 0.5, 0.3), &loads, &depths, &ALL, 2);
    let (large_p, large_q) =
        (p.iter().map(|p| p * 1024.0).collect::<Vec<_>>(), q.iter().map(|q| q * 1024.0).collect::<Vec<_>>());
    let larger = Loads { pressure: Some(&large_p), traction_x: None, traction_y: Some(&large_q), ..Loads::default() };
    let scaled = all_depths(&body(35, 21, 4.0, 2.0, 0.3), &larger, &depths.map(|z| 4.0 * z), &ALL, 1);
    for k in 0..depths.len() {
        assert_eq!(one[k].stress, two[k].stress);
        assert_eq!(one[k].principal, two[k].principal);
        for (value, scaled) in one[k].von_mises.iter().zip(&scaled[k].von_mises) {
            assert_eq!(value * 1024.0, *scaled);
        }
    }
}

#[test]
fn hard_cases_are_numbers() {
    for (mx, my, dx, dy, nu) in
        [(4099, 7, 1.0, 1.0, 0.5), (1, 1, 1e-9, 1e9, 0.3), (3, 2, 1e150, 1e150, -0.9), (3, 2, 1e-150, 2e-150, 0.0)]
    {
        let body = body(mx, my, dx, dy, nu);
        let p = vec![1e300; mx * my];
        let loads = Loads { pressure: Some(&p), traction_x: Some(&p), traction_y: Some(&p), ..Loads::default() };
        let unit = dx.max(dy);
        for depth in
            all_depths(&body, &loads, &[0.0, 1e-12 * unit, f64::MIN_POSITIVE, unit, 1e6 * unit, 1e300], &ALL, 1)
        {
            for c in 0..6 {
                assert!(depth.stress[c].iter().all(|s| s.is_finite()), "{mx} x {my}, component {c}");
            }
            assert!(depth.von_mises.iter().chain(&depth.maximum_shear).all(|s| s.is_finite()));
            assert!(depth.directions.iter().flatten().flatten().all(|s| s.is_finite()));
        }
    }
}

#[test]
fn what_is_no_question_is_refused_by_name() {
    let body = body(3, 2, 1.0, 1.0, 0.3);
    let (p, short, nan) = ([1.0; 6], [1.0; 5], [1.0, 1.0, f64::NAN, 1.0, 1.0, 1.0]);
    let ask = |body: &Body, loads: &Loads<'_>, z: f64| {
        subsurface_stress(body, loads, &[0.0, z], &TENSOR, &Threads::One, None, |_, _| {}).unwrap_err()
    };
    let message = |error: Error, part: &str| assert!(error.to_string().contains(part), "{error}");
    message(ask(&body, &Loads::default(), 1.0), "neither a pressure nor a traction");
    message(ask(&body, &Loads::pressure(&short), 1.0), "pressure has 5 values");
    message(
        ask(&body, &Loads { traction_y: Some(&nan), ..Loads::pressure(&p) }, 1.0),
        "traction_y of element (2, 0) is NaN",
    );
    message(ask(&body, &Loads::pressure(&p), -0.5), "depths[1] is -0.5");
    message(ask(&body, &Loads::pressure(&p), f64::NAN), "depths[1] is NaN");
    message(ask(&Body { poisson_ratio: 0.51, ..body }, &Loads::pressure(&p), 1.0), "poisson_ratio is 0.51");
    let at =
        |point: [f64; 3]| stress_at_points(&body, &Loads::pressure(&p), &[point], &Threads::One, None, &mut [[0.0; 6]]);
    message(at([-0.5, -0.5, 0.0]).unwrap_err(), "on the edge of an element");
    message(at([-1.0, 1.0, 0.0]).unwrap_err(), "on the edge of an element");
    message(at([0.5, 0.5, -1.0]).unwrap_err(), "z of point 0 is -1");
    message(at([0.5, f64::INFINITY, 1.0]).unwrap_err(), "y of point 0 is inf");
    for point in [[-0.5, -0.5, 1e-9], [-2.5, 1.0, 0.0], [1.5, 4.0, 0.0], [-1.0, -0.5, 0.0]] {
        let mut out = [[f64::NAN; 6]];
        stress_at_points(
            &body,
            &Loads { traction_x: Some(&p), ..Loads::pressure(&p) },
            &[point],
            &Threads::One,
            None,
            &mut out,
        )
        .unwrap();
        assert!(out[0].iter().all(|s| s.is_finite()), "{point:?}: {out:?}");
    }
}

#[test]
fn progress_counts_depths_and_cancels() {
    let body = body(3, 2, 1.0, 1.0, 0.3);
    let (mut told, mut kept) = (Vec::new(), 0);
    let mut progress = |progress: &contact_normal::progress::Progress| {
        told.push(progress.cycles);
        progress.cycles == 2
    };
    let loads = Loads::pressure(&[1.0; 6]);
    let depths = [0.0, 1.0, 2.0, 3.0];
    let done = subsurface_stress(&body, &loads, &depths, &TENSOR, &Threads::One, Some(&mut progress), |_, _| kept += 1);
    assert_eq!((done, told, kept), (Ok(false), vec![1, 2], 2));
}

/// The stresses xx, yy, zz and xz by a pressure and by a traction, both constant on each element and varying in x alone: a sum of waves, term by
/// term.
fn waves(load: &[f64], d: f64, nu: f64, i: usize, z: f64) -> [[f64; 4]; 2] {
    let m = load.len();
    let mean = load.iter().sum::<f64>() / m as f64;
    let sideways = -nu / (1.0 - nu) * mean;
    let (mut p, mut q) = ([sideways, sideways, -mean, 0.0], [0.0, 0.0, 0.0, -mean]);
    for wave in 1.. {
        let number = 2.0 * PI * wave as f64 / (m as f64 * d);
        let kz = number * z;
        if kz > 40.0 {
            break;
        }
        let fade = (-kz).exp() * (0.5 * number * d).sin() / (0.5 * number * d) * 2.0 / m as f64;
        let phase = |j: usize| number * d * (i as f64 - j as f64);
        let cos: f64 = (0..m).map(|j| load[j] * phase(j).cos()).sum::<f64>() * fade;
        let sin: f64 = (0..m).map(|j| load[j] * phase(j).sin()).sum::<f64>() * fade;
        let of_pressure = [-(1.0 - kz) * cos, -2.0 * nu * cos, -(1.0 + kz) * cos, -kz * sin];
        let of_traction = [-(2.0 - kz) * sin, -2.0 * nu * sin, -kz * sin, -(1.0 - kz) * cos];
        p.iter_mut().zip(of_pressure).for_each(|(sum, value)| *sum += value);
        q.iter_mut().zip(of_traction).for_each(|(sum, value)| *sum += value);
    }
    [p, q]
}

#[test]
fn a_periodic_load_is_a_sum_of_waves() {
    let (m, rows, d, nu) = (6, 4, 0.5, 0.3);
    let load = noise(11, m);
    let body = Body { periodic: true, ..body(m, rows, d, 0.7, nu) };
    let everywhere: Vec<f64> = (0..rows).flat_map(|_| load.iter().copied()).collect();
    let depths = [0.0, 0.05, 0.3, 0.65, 0.71, 2.0, 30.0];
    let pressed = all_depths(&body, &Loads::pressure(&everywhere), &depths, &TENSOR, 1);
    let traction = Loads { traction_x: Some(&everywhere), ..Loads::default() };
    let sheared = all_depths(&body, &traction, &depths, &TENSOR, 1);
    let mean = load.iter().sum::<f64>() / m as f64;
    for (k, z) in depths.into_iter().enumerate() {
        for (i, p) in everywhere.iter().enumerate() {
            // At the surface szz = -p and sxz = -q, and without the mean of p sxx = -p and syy = -2 nu p.
            let sideways = -nu / (1.0 - nu) * mean;
            let surface = [sideways - (p - mean), sideways - 2.0 * nu * (p - mean), -p, 0.0];
            let exact = if z > 0.0 { waves(&load, d, nu, i % m, z) } else { [surface, [f64::NAN, f64::NAN, 0.0, -p]] };
            for (found, exact) in [&pressed[k], &sheared[k]].into_iter().zip(exact) {
                for (c, exact) in [0, 1, 2, 4].into_iter().zip(exact).filter(|(_, exact)| !exact.is_nan()) {
                    // Near the surface kernels are tenth differences. Their error is round-off times weights of up to 252, and that of the images
                    // that are left out.
                    let found = found.stress[c][i];
                    assert!((found - exact).abs() <= 1e-11, "z {z}, element {i}, component {c}: {found} for {exact}");
                }
                assert!(found.stress[3][i].abs() <= 1e-11 && found.stress[5][i].abs() <= 1e-11);
            }
        }
    }
}

/// Loads in two dimensions have the same stresses on a grid whose elements are a third as long. At depths between the sides of both elements the fine
/// grid sums waves and the coarse one takes tenth differences. The cases have odd and even numbers of elements, slender elements, more frequencies
/// than a lane has, and depths at which most or all waves have decayed.
#[test]
fn periodic_stresses_are_those_of_finer_elements() {
    for (mx, my, dx, dy) in [(5, 4, 1.0, 0.8), (31, 16, 0.4, 1.0), (2, 33, 1.0, 0.3), (1, 1, 1.0, 1.0)] {
        let coarse = Body { periodic: true, ..body(mx, my, dx, dy, 0.25) };
        let fine = Body { periodic: true, ..body(3 * mx, 3 * my, dx / 3.0, dy / 3.0, 0.25) };
        let loads: [Vec<f64>; 3] = [1, 2, 3].map(|seed| noise(seed, mx * my));
        let refined =
            |load: &Vec<f64>| (0..9 * mx * my).map(|i| load[i / (3 * mx) / 3 * mx + i % (3 * mx) / 3]).collect();
        let depths = [0.0, 0.1, 0.5, 0.9, 1.0, 1.5, 9.0, 20.0, 1e3];
        let of = |body: &Body, loads: &[Vec<f64>; 3], threads: usize| {
            let [p, qx, qy] = loads.each_ref().map(|load| load.as_slice());
            let loads = Loads { pressure: Some(p), traction_x: Some(qx), traction_y: Some(qy), ..Loads::default() };
            all_depths(body, &loads, &depths, &TENSOR, threads)
        };
        let both = (of(&coarse, &loads, 2), of(&fine, &loads.each_ref().map(refined), 1));
        for (z, (one, other)) in depths.into_iter().zip(both.0.iter().zip(&both.1)) {
            // Deeper than the side of a coarse element both grids sum waves. Nearer to the surface, tenth differences have an error of 1e-12.
            let tolerance = if z < 1.0 { 1e-11 } else { 1e-14 };
            for i in 0..mx * my {
                let middle = (3 * (i / mx) + 1) * 3 * mx + 3 * (i % mx) + 1;
                for c in 0..6 {
                    let error = (one.stress[c][i] - other.stress[c][middle]).abs();
                    assert!(error <= tolerance, "{mx} x {my}, z {z}, element {i}, component {c}: {error:e}");
                }
            }
        }
    }
}

/// On a line of elements with two periods the load is uniform along each element. The stresses are those of plane strain, whatever the length of the
/// elements.
#[test]
fn a_periodic_line_has_the_stresses_of_plane_strain() {
    let (m, d, load) = (24, 0.3, noise(7, 24));
    let stresses = |body: &Body| {
        let loads = Loads { pressure: Some(&load), traction_x: None, traction_y: None, patches: None };
        let depths = all_depths(body, &loads, &[0.0, 0.1, 2.0], &Wanted { von_mises: true, ..Wanted::default() }, 1);
        depths.into_iter().flat_map(|depth| depth.von_mises).collect::<Vec<f64>>()
    };
    for (mx, my) in [(m, 1), (1, m)] {
        let on = |long: f64| {
            let (dx, dy) = if my == 1 { (d, long) } else { (long, d) };
            stresses(&Body { periodic: true, ..body(mx, my, dx, dy, 0.3) })
        };
        let square = on(d);
        // Three equal rows must have the stresses of one.
        let rows: Vec<f64> = (0..3 * m).map(|i| load[if my == 1 { i % m } else { i / 3 }]).collect();
        let (wide, high) = if my == 1 { (m, 3) } else { (3, m) };
        let three = Body { periodic: true, ..body(wide, high, d, d, 0.3) };
        let loads = Loads { pressure: Some(&rows), traction_x: None, traction_y: None, patches: None };
        let wanted = Wanted { von_mises: true, ..Wanted::default() };
        let expected: Vec<f64> = all_depths(&three, &loads, &[0.0, 0.1, 2.0], &wanted, 1)
            .into_iter()
            .flat_map(|depth| (0..m).map(|i| depth.von_mises[if my == 1 { i } else { 3 * i }]).collect::<Vec<f64>>())
            .collect();
        // The error of a kernel is 1e-12 (tests above), and that of a sum of 24 of them is below 1e-10.
        assert!(square.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-10 * largest(&expected)), "{mx} x {my}");
        for long in [1e-4, 1e4] {
            assert!(on(long) == square, "{mx} x {my}, elements {long} long");
        }
    }
}
