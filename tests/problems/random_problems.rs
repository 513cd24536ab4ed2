//! AUTO and NORM agree on 200 random problems of every kind.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{solve, Method, Options, Outcome};

use crate::families::case::Random;

fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * random.next()
}

fn size(random: &mut Random) -> usize {
    1 + (random.next() * 96.0) as usize
}

/// The undeformed distances of a kind of surface, with a depth of order 1, and an approach at which there is contact.
fn distance(kind: usize, grid: &Grid, random: &mut Random) -> (Vec<f64>, f64) {
    let position = |i: usize| {
        let x = ((i % grid.mx) as f64 + 0.5) / grid.mx as f64 - 0.5;
        let y = ((i / grid.mx) as f64 + 0.5) / grid.my as f64 - 0.5;
        (x, y)
    };
    let (ax, ay) = (between(random, 1.0, 20.0), between(random, 1.0, 20.0));
    let waves: Vec<[f64; 4]> = (0..8)
        .map(|k| {
            let frequency = 3.0 * (1.0 + k as f64);
            [
                between(random, -frequency, frequency),
                between(random, -frequency, frequency),
                between(random, 0.0, 6.3),
                0.3 / (1.0 + k as f64),
            ]
        })
        .collect();
    let spots: Vec<[f64; 3]> =
        (0..5).map(|_| [between(random, -0.5, 0.5), between(random, -0.5, 0.5), between(random, 0.0, 0.3)]).collect();
    let h: Vec<f64> = (0..grid.len())
        .map(|i| {
            let (x, y) = position(i);
            match kind {
                // smooth
                0 => ax * x * x + ay * y * y,
                // rough
                1 => {
                    let rough: f64 = waves.iter().map(|w| w[3] * (6.3 * (w[0] * x + w[1] * y) + w[2]).cos()).sum();
                    1.0 - rough
                }
                // several spots
                2 => spots
                    .iter()
                    .map(|s| 30.0 * ((x - s[0]).powi(2) + (y - s[1]).powi(2)) + s[2])
                    .fold(f64::INFINITY, f64::min),
                // flat: full contact
                3 => 0.0,
                // one element far below the others
                _ => {
                    if i == grid.len() / 2 {
                        0.0
                    } else {
                        1e3
                    }
                }
            }
        })
        .collect();
    let lowest = h.iter().copied().fold(f64::INFINITY, f64::min);
    (h, lowest + between(random, 0.05, 0.5))
}

#[test]
fn auto_and_norm_agree_on_200_random_problems() {
    let mut random = Random(2026);
    let tolerance = 1e-8;
    for number in 0..200 {
        let (mx, my) = match number % 10 {
            0 => (1, size(&mut random)),
            1 => (size(&mut random), 1),
            _ => (size(&mut random), size(&mut random)),
        };
        let aspect = 10f64.powf(between(&mut random, -2.0, 2.0));
        let grid = Grid::new(mx, my, aspect.sqrt(), 1.0 / aspect.sqrt()).unwrap();
        let (h, approach) = distance(number % 5, &grid, &mut random);
        let bodies =
            Bodies { shear_modulus: [between(&mut random, 0.1, 10.0), f64::INFINITY], poisson_ratio: [0.3, 0.3] };
        let by_approach = Scene::new(grid, &h, bodies, Load::Approach(approach));
        let run = |scene: &Scene<'_>, method, tolerance| {
            let options = Options { method, tolerance, max_cycles: 20_000, ..Options::default() };
            let (solver, stop, report) = solve(scene, &options).unwrap();
            assert_eq!(stop, Outcome::Converged, "problem {number}, {method:?}, {:?} on {grid:?}", scene.load);
            (solver, report)
        };
        // NORM is the reference. It has a smaller tolerance, because its residual consists of short waves, to which large errors of p belong.
        let (norm, report) = run(&by_approach, Method::Norm, 1e-3 * tolerance);
        let by_force = Scene { load: Load::Force(report.measures.force), ..by_approach.clone() };
        for scene in [&by_approach, &by_force] {
            let (auto, _) = run(scene, Method::Auto, tolerance);
            let (a, b) = (auto.state(), norm.state());
            let size = b.p.iter().map(|p| p * p).sum::<f64>().sqrt();
            let difference = a.p.iter().zip(&b.p).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            // The condition number of A on the contact area amplifies the residual, for which a factor of 10 is allowed.
            assert!(
                difference <= 10.0 * tolerance * size.max(f64::MIN_POSITIVE),
                "problem {number}, {:?} on {grid:?}: p differs by {:e}",
                scene.load,
                difference / size
            );
            // Elements that only one method has in contact lie on the boundary of the contact area: their pressure and gap are near 0.
            let (largest, depth) = (b.p.iter().copied().fold(0.0, f64::max), approach.abs());
            for i in (0..grid.len()).filter(|&i| a.contact[i] != b.contact[i]) {
                let on_boundary = a.p[i].max(b.p[i]) <= 100.0 * tolerance * largest
                    && a.deformed_distance(i).abs().max(b.deformed_distance(i).abs()) <= 100.0 * tolerance * depth;
                assert!(on_boundary, "problem {number}, {:?} on {grid:?}: element {i}", scene.load);
            }
        }
    }
}
