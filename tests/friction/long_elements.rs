//! Rough lines of long elements, as for line contacts, on which each traction displaces the whole line nearly uniformly. Also steady rolling of two
//! elements whose bounds have any ratio.

use std::f64::consts::TAU;

use contact_normal::friction::Request;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Coefficient, Friction, Load, Motion, Prescribed, Scene};
use contact_normal::solver::{self as normal, Options, Outcome};

use super::steady::rolling;
use super::support::{residual, solver};

/// The difference that the round-off of direct sums and of FFT products may make in a residual.
const ROUND_OFF: f64 = 1e-9;

/// Pressures on a line of waves with random phases and amplitudes that fall as `k^-1.3`.
fn pressures(grid: &Grid, seed: u64) -> (Vec<f64>, f64) {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut h = vec![0.0; grid.mx];
    for k in 2..grid.mx / 3 {
        let (phase, amplitude) = (TAU * next(), (0.5 + next()) * (k as f64).powf(-1.3));
        for (i, h) in h.iter_mut().enumerate() {
            *h += amplitude * (TAU * (k * i % grid.mx) as f64 / grid.mx as f64 + phase).cos();
        }
    }
    let load = Load::Force(0.003 * grid.element_area() * grid.len() as f64);
    let scene = Scene::new(*grid, &h, Bodies::same(1.0, 0.3), load);
    let (solved, stop, _) = normal::solve(&scene, &Options::default()).unwrap();
    assert_eq!(stop, Outcome::Converged);
    let largest = solved.state().u.iter().copied().fold(0.0, f64::max);
    (solved.state().p.clone(), largest)
}

/// The gradient method and Newton's method cycle on most of these lines. The projected Newton method, which only descends, solves them.
#[test]
fn shifts_of_rough_lines_are_solved_however_long_their_elements() {
    for (seed, dy) in [(1, 1e5), (2, 1e5), (3, 1e5), (4, 1e5), (5, 1e4), (6, 1e4), (7, 1e3)] {
        let grid = Grid::new(3000, 1, 1.0, dy).unwrap();
        let (p, u) = pressures(&grid, seed);
        let angle = 0.9 * seed as f64;
        let way = [angle.cos(), angle.sin()].map(|part| Prescribed::Creepage(2e-3 * u * part));
        let friction = Friction { prescribed: way, motion: Motion::Shift, ..Friction::new(0.1) };
        let mut solver = solver(&grid, 0.3);
        let (end, report) = solver.solve(&Request::new(&p, &friction, 1e-6), &mut |_, _| true).unwrap();
        assert_eq!(end, Outcome::Converged, "{seed}: {report:?}");
        let none = vec![[0.0; 2]; grid.len()];
        let slip_residual = residual((&grid, 0.3), &p, &friction, &none, (&report, solver.solution().unwrap()));
        assert!(slip_residual <= 1e-6 + ROUND_OFF, "{seed}: {slip_residual:e}");
    }
}

/// The smaller bound may be below the round-off of the larger one. Its traction is then negligible, and the element sticks or slips according to its
/// slip.
#[test]
fn bounds_of_any_ratio_roll() {
    let grid = Grid::new(2, 1, 1.0, 1.0).unwrap();
    for (k, angle) in (10..=40).flat_map(|k| [0.3, 1.5, 2.0, 4.0].map(|angle: f64| (k, angle))) {
        for p in [[10f64.powi(-k), 1.0], [1.0, 10f64.powi(-k)]] {
            let friction = Friction {
                coefficient: Coefficient::Uniform(0.1),
                ..rolling([0.02 * angle.cos(), 0.02 * angle.sin()], 0.0)
            };
            let mut solver = solver(&grid, 0.3);
            let (end, report) = solver.solve(&Request::new(&p, &friction, 1e-6), &mut |_, _| true).unwrap();
            assert_eq!(end, Outcome::Converged, "{p:?} {angle}: {report:?}");
            let slip_residual = residual((&grid, 0.3), &p, &friction, &[], (&report, solver.solution().unwrap()));
            assert!(slip_residual <= 1e-6 + ROUND_OFF, "{p:?} {angle}: {slip_residual:e}");
        }
    }
}
