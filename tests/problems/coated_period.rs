//! Coatings in scenes with two periods: coefficients compared with sums over waves, the compression by the mean pressure, and thin coatings.

use std::f64::consts::PI;
use std::sync::Arc;

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::influence::{radial, CoatedBody, CoatedPeriodic, HalfSpace, Kernel, Periodic, Response, Transfer};
use contact_normal::scene::{Bodies, Coating, CoatingLayer, Each, Layer, Load, Period, Scene};
use contact_normal::solver::{solve, ActiveSet, Guess, InitialGuess, Method, Options, Outcome, Problem, Solver};

use super::dense;
use crate::support::{assert_conditions, run};

const METHODS: [Method; 3] = [Method::Auto, Method::Norm, Method::ProjectedCg];
const BOTH: Option<Period> = Some(Period { x: true, y: true });

fn layer(thickness: f64, shear_modulus: f64, poisson_ratio: f64) -> Option<CoatingLayer> {
    Some(CoatingLayer { thickness, shear_modulus, poisson_ratio })
}

/// The coefficients of a coated body less those of a half-space of the coating, by definition: a sum over all waves of the grid and those aliases of
/// them that are not below 1e-17.
fn by_waves(mu: f64, nu: [f64; 2], t: f64, grid: &Grid, offsets: &[(usize, usize)]) -> Vec<f64> {
    let (transfer, sinc) = (Transfer::new(mu, nu), |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x });
    let last = |d: f64| (21.0 * d / (2.0 * PI * t)).ceil() as i64 + 1;
    let mut sums = vec![0.0; offsets.len()];
    for (i, j) in (0..grid.my).flat_map(|j| (0..grid.mx).map(move |i| (i, j))) {
        let mut wave = 0.0;
        for (a, b) in
            (-last(grid.dx)..=last(grid.dx)).flat_map(|a| (-last(grid.dy)..=last(grid.dy)).map(move |b| (a, b)))
        {
            let number = |i: usize, m: usize, alias: i64, d: f64| 2.0 * PI * (i as f64 / m as f64 + alias as f64) / d;
            let (kx, ky) = (number(i, grid.mx, a, grid.dx), number(j, grid.my, b, grid.dy));
            let k = kx.hypot(ky);
            if k > 1e-9 && k * t < 21.0 {
                let change = 2.0 * PI / k * transfer.less_one(k * t);
                wave += change * sinc(0.5 * kx * grid.dx) * sinc(0.5 * ky * grid.dy);
            }
        }
        for (sum, (kx, ky)) in sums.iter_mut().zip(offsets) {
            let turn = |i: usize, k: usize, m: usize| 2.0 * PI * ((i * k) % m) as f64 / m as f64;
            *sum += wave * (turn(i, *kx, grid.mx) + turn(j, *ky, grid.my)).cos() / grid.len() as f64;
        }
    }
    sums
}

/// Grids with many aliases and with few, with more and with fewer waves than the library's polynomial has nodes, with slender elements, and with odd
/// numbers of elements.
#[test]
fn coefficients_are_sums_over_all_aliases() {
    let mut worst: f64 = 0.0;
    for (mx, my, dx, dy) in [
        (50, 49, 1.0, 1.0),
        (52, 51, 0.3, 0.4),
        (20, 12, 1.0, 1.0),
        (61, 50, 0.25, 2.0),
        (9, 120, 3.0, 1.0),
        (101, 1, 1.0, 1.0),
    ] {
        let grid = Grid::new(mx, my, dx, dy).unwrap();
        let longer = f64::max(dx, dy);
        for (mu, nu, t) in [
            (0.01, [0.3, 0.25], longer / 15.5),
            (100.0, [0.3, 0.2], longer / 10.0),
            (3.0, [0.5, 0.0], 0.4 * longer),
            (1e-3, [0.45, 0.3], 2.0 * longer),
            (20.0, [0.0, 0.5], 9.0 * longer),
            (0.5, [0.3, 0.3], 1e3 * longer),
        ] {
            let rigid = CoatedBody { compliance: 0.0, layer: None };
            let coated = CoatedBody { compliance: 1.0, layer: Some((t, radial(mu, nu))) };
            let kernel = CoatedPeriodic::new([coated, rigid], &grid).unwrap();
            let without = kernel.without_constant();
            assert_eq!(without.is_some(), nu[0] < 0.5, "what cannot be compressed has no mean compression");
            let kernel = without.unwrap_or_else(|| Arc::new(kernel));
            let half_space = Periodic::new(HalfSpace::new(dx, dy, PI), (true, true), &grid).unwrap();
            let offsets = [(0, 0), (1, 0), (mx / 2, my / 2), (mx / 3, my - 1), (mx - 1, 0)];
            for ((kx, ky), exact) in offsets.into_iter().zip(by_waves(mu, nu, t, &grid, &offsets)) {
                let (kx, ky) = (kx as i64, ky as i64);
                let scale = half_space.at(0, 0).abs() + kernel.at(0, 0).abs();
                let error = (kernel.at(kx, ky) - half_space.at(kx, ky) - exact).abs() / scale;
                // The tolerance is the round-off of sums over some thousand waves, in the test and in the library.
                assert!(error <= 1e-13, "{mx} x {my}, mu {mu}, t {t}, ({kx}, {ky}): {error:e}");
                worst = worst.max(error);
            }
        }
    }
    println!("largest difference from sums over waves: {worst:e}");
}

/// If a coating is too thin for the elements of a coarser grid, the coefficients of that grid are mean displacements of 2 x 2 elements by a pressure
/// on 2 x 2 elements.
#[test]
fn coefficients_of_coarser_grids_are_means_where_a_coating_is_thin() {
    let (fine, coarse) = (Grid::new(24, 16, 1.0, 1.0).unwrap(), Grid::new(12, 8, 2.0, 2.0).unwrap());
    let rigid = CoatedBody { compliance: 0.0, layer: None };
    let coated = CoatedBody { compliance: 1.0, layer: Some((0.1, radial(0.05, [0.3, 0.3]))) };
    let kernel = CoatedPeriodic::new([coated, rigid], &fine).unwrap();
    let joined = kernel.coarsen(&fine, &coarse).unwrap();
    for (kx, ky) in [(0, 0), (1, 0), (3, 2), (6, 4), (11, 7)] {
        let mut mean = 0.0;
        for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
            mean += 0.25 * kernel.at(2 * kx + i % 2 - j % 2, 2 * ky + i / 2 - j / 2);
        }
        let found = joined.at(kx, ky);
        assert!((found - mean).abs() <= 1e-13 * kernel.at(0, 0), "({kx}, {ky}): {found} for {mean}");
    }
}

/// The oedometric compliance of a material.
fn oedometric(g: f64, nu: f64) -> f64 {
    (1.0 - 2.0 * nu) / (2.0 * g * (1.0 - nu))
}

/// The compression of the coatings by a uniform pressure of 1.
fn compression(coating: &Coating) -> f64 {
    let of = |layer: CoatingLayer| layer.thickness * oedometric(layer.shear_modulus, layer.poisson_ratio);
    coating.layers.iter().flatten().copied().map(of).sum()
}

const BODIES: Bodies = Bodies { shear_modulus: [2.0, 5.0], poisson_ratio: [0.25, 0.4] };

fn coatings() -> [Coating; 4] {
    [
        Coating { layers: [layer(0.3, 0.1, 0.3), None] },
        Coating { layers: [None, layer(0.8, 0.02, 0.45)] },
        Coating { layers: [layer(0.1, 0.4, 0.0), layer(0.5, 1.0, 0.2)] },
        // A coating that is stiffer than the body below it.
        Coating { layers: [layer(0.2, 9.0, 0.3), None] },
    ]
}

/// Two flat surfaces: the pressure is uniform, and the approach is the compression of the coatings.
#[test]
fn a_uniform_pressure_compresses_by_the_oedometric_moduli() {
    let grid = Grid::new(12, 10, 0.5, 0.4).unwrap();
    let h = vec![0.7; grid.len()];
    let (area, all) = (grid.len() as f64 * grid.element_area(), vec![true; grid.len()]);
    for coating in coatings() {
        let of_unit = compression(&coating);
        for (c, method) in [0.0, 0.03].into_iter().flat_map(|c| METHODS.map(move |method| (c, method))) {
            let scene = Scene {
                coating: Some(coating),
                period: BOTH,
                layer: (c > 0.0).then_some(Layer(Each::Uniform(c))),
                ..Scene::new(grid, &h, BODIES, Load::Force(2.0))
            };
            let options = Options { method, ..Options::default() };
            let (solver, report) = run(&scene, &options);
            let expected = 0.7 + (of_unit + c) * 2.0 / area;
            let what = format!("{coating:?} {method:?} {c}");
            assert!(
                (report.measures.approach - expected).abs() <= 1e-12,
                "{what}: {} {expected}",
                report.measures.approach
            );
            for (p, u) in solver.state().p.iter().zip(&solver.state().u) {
                assert!(
                    (p * area / 2.0 - 1.0).abs() <= 1e-9 && (u - (expected - 0.7)).abs() <= 1e-9,
                    "{what}: {p} {u}"
                );
            }
            // The same with a given approach, and with a force that pulls on a given area.
            let (_, report) = run(&Scene { load: Load::Approach(expected), ..scene.clone() }, &options);
            assert!((report.measures.force / 2.0 - 1.0).abs() <= 1e-6, "{what}: force {}", report.measures.force);
            let fixed = Options { active_set: ActiveSet::Fixed, ..options };
            let guess = Some(Guess { pressure: &h, contact: &all });
            let pulled = Scene { load: Load::Force(-2.0), ..scene.clone() };
            let mut solver = Solver::new(&pulled, &fixed).unwrap();
            let (stop, report) = solver.solve(&pulled, &fixed, guess, None).unwrap();
            assert_eq!(stop, Outcome::Converged, "{what}");
            assert!(
                (report.measures.approach - (1.4 - expected)).abs() <= 1e-12,
                "{what}: {}",
                report.measures.approach
            );
        }
    }
}

/// A wavy surface.
fn wavy(grid: &Grid) -> Vec<f64> {
    let turn = |k: usize, m: usize| 2.0 * PI * (k as f64 + 0.3) / m as f64;
    let at = |i: usize| {
        let (x, y) = (turn(i % grid.mx, grid.mx), turn(i / grid.mx, grid.my));
        0.02 * (2.0 + x.cos() + 0.7 * y.cos() + 0.2 * (3.0 * x + 2.0 * y).sin())
    };
    (0..grid.len()).map(at).collect()
}

/// The conditions of contact hold, by direct sums, for the reported approach and displacements: by force and by approach, from light contact to
/// approaches beyond the mean of h.
#[test]
fn the_approach_of_a_force_has_that_force() {
    let grid = Grid::new(24, 21, 0.25, 0.3).unwrap();
    let (h, area) = (wavy(&grid), grid.len() as f64 * grid.element_area());
    for coating in coatings() {
        let of_unit = compression(&coating);
        for pressure in [1e-4, 5e-3, 0.2] {
            let by_force = Scene {
                coating: Some(coating),
                period: BOTH,
                ..Scene::new(grid, &h, BODIES, Load::Force(pressure * area))
            };
            let product = |p: &[f64]| {
                let mut u = vec![0.0; p.len()];
                dense::apply(&by_force.coefficients().unwrap(), &grid, p, &mut u);
                u
            };
            for method in METHODS {
                let (options, what) =
                    (Options { method, ..Options::default() }, format!("{coating:?} {pressure} {method:?}"));
                let (solver, report) = run(&by_force, &options);
                let (p, approach) = (&solver.state().p, report.measures.approach);
                let u = product(p);
                assert_conditions(&h, approach, p, &u, &what);
                let mean = solver.state().u.iter().sum::<f64>() / h.len() as f64;
                assert!((mean - of_unit * pressure).abs() <= 1e-12, "{what}: mean displacement {mean}");
                let largest = u.iter().fold(0.0, |largest: f64, u| largest.max(u.abs()));
                assert!(u.iter().zip(&solver.state().u).all(|(a, b)| (a - b).abs() <= 1e-12 * largest), "{what}");
                let (solver, report) = run(&Scene { load: Load::Approach(approach), ..by_force.clone() }, &options);
                let p = &solver.state().p;
                assert_conditions(&h, approach, p, &product(p), &format!("{what}, by approach"));
                let force = report.measures.force / (pressure * area);
                assert!((force - 1.0).abs() <= 1e-4, "{what}: {force} of the force");
            }
        }
    }
}

/// A thin soft coating is a `layer` with the compliance that docs/effects.md gives.
#[test]
fn a_thin_coating_has_the_approach_of_a_layer() {
    let grid = Grid::new(32, 32, 0.125, 0.125).unwrap();
    let h = wavy(&grid);
    let (t, g, nu, bodies) = (0.02, 0.01, 0.3, Bodies { shear_modulus: [4.0, 9.0], poisson_ratio: [0.3, 0.2] });
    let c = oedometric(g, nu) - nu * (1.0 - 0.6) / (0.7 * 4.0) - g * 0.16 / (1.4 * 16.0);
    let plain = Scene { period: BOTH, ..Scene::new(grid, &h, bodies, Load::Force(0.2)) };
    let (_, coated) = run(&Scene { coating: Some(Coating::of_body_1(t, g, nu)), ..plain.clone() }, &Options::default());
    let (_, layered) = run(&Scene { layer: Some(Layer(Each::Uniform(c * t))), ..plain.clone() }, &Options::default());
    let (mean, difference) = (c * t * 0.2 / 16.0, coated.measures.approach - layered.measures.approach);
    // The difference is of second order in the thickness; 3 % of the compression is ample.
    assert!(difference.abs() <= 0.03 * mean, "{difference} of {mean}");
}

/// Only the caller's grid decides whether a coating is too thin, not the coarser grids of a method.
#[test]
fn a_coating_may_be_a_sixteenth_of_an_element() {
    for (mx, my, dx, dy) in
        [(32, 32, 1.0, 1.0), (33, 20, 0.1, 0.1), (3, 20, 1.0, 2.9), (16, 64, 1.0, 4.0), (70, 9, 1.0, 1.0)]
    {
        let grid = Grid::new(mx, my, dx, dy).unwrap();
        let h = wavy(&grid);
        for elements in [1.001 / 16.0, 0.13, 0.3, 1.0, 6.0] {
            for (mu, method) in [0.01, 0.3, 40.0].into_iter().flat_map(|mu| METHODS.map(move |method| (mu, method))) {
                let coating = Some(Coating::of_body_1(elements * dx.max(dy), 2.0 * mu, 0.3));
                let scene =
                    Scene { coating, period: BOTH, ..Scene::new(grid, &h, BODIES, Load::Force(0.05 * dx * dy)) };
                let (solver, report) = run(&scene, &Options { method, ..Options::default() });
                let mut u = vec![0.0; h.len()];
                dense::apply(&scene.coefficients().unwrap(), &grid, &solver.state().p, &mut u);
                let what = format!("{mx} x {my}, {elements} elements, mu {mu}, {method:?}");
                assert_conditions(&h, report.measures.approach, &solver.state().p, &u, &what);
            }
        }
        let coating = Some(Coating::of_body_1(0.99 / 16.0 * dx.max(dy), 0.1, 0.3));
        let scene = Scene { coating, period: BOTH, ..Scene::new(grid, &h, BODIES, Load::Force(1.0)) };
        let refused = solve(&scene, &Options::default()).map(drop).unwrap_err();
        assert!(matches!(&refused, Error::Unsupported(text) if text.contains(&format!("{dx} x {dy}"))), "{refused}");
    }
}

/// A handle that changes between forces and approaches, and a batch of both, have the results of single solves.
#[test]
fn loads_of_both_kinds_go_with_one_handle() {
    let grid = Grid::new(20, 20, 0.3, 0.3).unwrap();
    let h = wavy(&grid);
    let scene = |load| Scene { coating: Some(coatings()[2]), period: BOTH, ..Scene::new(grid, &h, BODIES, load) };
    let loads = [
        Load::Force(0.1),
        Load::Approach(0.05),
        Load::Approach(0.06),
        Load::Force(0.2),
        Load::Force(0.0),
        Load::Approach(0.03),
    ];
    let single = loads.map(|load| run(&scene(load), &Options::default()));
    let mut solver = Solver::new(&scene(loads[1]), &Options::default()).unwrap();
    for (load, (expected, _)) in loads.into_iter().zip(&single) {
        let (stop, report) = solver.solve(&scene(load), &Options::default(), None, None).unwrap();
        assert_eq!(
            (stop, &solver.state().p, &solver.state().u),
            (Outcome::Converged, &expected.state().p, &expected.state().u)
        );
        assert_eq!(report.measures.approach, expected.state().approach);
        let again = Options { initial_guess: InitialGuess::Previous, ..Options::default() };
        let (stop, report) = solver.solve(&scene(load), &again, None, None).unwrap();
        let off = (report.measures.approach - expected.state().approach).abs();
        assert!(stop == Outcome::Converged && off <= 1e-14, "{load:?}: {off}");
    }
    let problems: Vec<Problem<'_>> = loads.iter().map(|load| Problem { scene: scene(*load), guess: None }).collect();
    let found = solver.solve_batch(&problems, &Options::default(), |_, outcome, state| {
        outcome.map(|(stop, _)| (stop, state.p.clone(), state.approach))
    });
    for (found, (expected, _)) in found.unwrap().into_iter().zip(&single) {
        let (stop, p, approach) = found.unwrap();
        assert_eq!((stop, &p, approach), (Outcome::Converged, &expected.state().p, expected.state().approach));
    }
}
