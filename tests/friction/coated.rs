//! Friction of two equal coated bodies: motions, forces and derivatives compared with direct sums, thin layers compared with closed forms, and
//! refusals.

use contact_normal::error::Error;
use contact_normal::friction::{Compliance, Report, Solution, Solver, Tangential, Vector};
use contact_normal::grid::Grid;
use contact_normal::influence::Coat;
use contact_normal::scene::{
    Bodies, Coating, CoatingLayer, Friction, Load, Motion, Prescribed, Previous, Scene, TangentialInfluence,
};
use contact_normal::solver::{solve, solve_tangential, Options, Outcome, Solver as SceneSolver};
use contact_normal::threads::Threads;

use super::dense;
use super::steady_scenes::ellipse;
use super::support::{ball, residual_by, run};

/// The tangential coefficients of two equal bodies: a layer of thickness t with `1/G1 = 1` on a substrate with `G2 = 1/mu`.
pub fn coated(grid: &Grid, t: f64, mu: f64, [nu1, nu2]: [f64; 2]) -> Tangential {
    let [surface, below] =
        [(1.0, nu1), (mu, nu2)].map(|(shear, nu)| Compliance { shear, poisson: shear * nu, unlike: 0.0 });
    Tangential::of_coated(grid.dx, grid.dy, surface, (Coat::new(t, mu, [nu1, nu2]), below))
}

/// Coatings: the thickness in contact radii, G1/G2, and the Poisson ratios of layer and substrate.
const COATS: [(f64, f64, [f64; 2]); 4] =
    [(0.2, 0.0, [0.45, 0.3]), (0.5, 0.05, [0.0, 0.4]), (0.1, 8.0, [0.25, 0.3]), (2.0, 60.0, [0.3, 0.2])];

/// Motions whose rigid slip is of the order of the layer's displacement.
fn motions(scale: f64) -> Vec<Friction<'static>> {
    let creepages = [Prescribed::Creepage(-0.3 * scale), Prescribed::Creepage(0.1 * scale)];
    let shift = Friction { prescribed: creepages, spin: 0.2 * scale, ..Friction::new(0.4) };
    let forced = Friction { prescribed: [Prescribed::Force(0.2), Prescribed::Creepage(0.0)], ..shift };
    let steady = Friction { motion: Motion::SteadyRolling, ..shift };
    let transient = Friction {
        motion: Motion::TransientRolling,
        prescribed: creepages.map(|_| Prescribed::Creepage(-scale)),
        ..shift
    };
    // A rolling step that is no multiple of an element, and not along x.
    let aside = Friction { rolling_direction: 0.7, rolling_distance: 0.11, ..steady };
    vec![
        shift,
        forced,
        transient,
        Friction { rolling_direction: -2.0, rolling_distance: 0.17, ..transient },
        steady,
        aside,
        Friction { prescribed: [Prescribed::Force(0.1), Prescribed::Force(-0.2)], ..steady },
    ]
}

#[test]
fn motions_and_forces_meet_the_conditions() {
    let (grid, g) = ellipse(0.8, 26);
    for (t, mu, nu) in COATS {
        let coated = coated(&grid, t, mu, nu);
        // The order of the displacements per traction: the layer as a spring, and the substrate.
        let scale = t.min(1.0) + mu;
        for friction in motions(scale) {
            let mut solver = Solver::new(grid, coated.clone(), true, &Threads::One);
            let (report, solution) = run(&mut solver, &g, &friction, 1e-7);
            let none = vec![[0.0; 2]; grid.len()];
            let sums = |by: (f64, f64), q: &[Vector], u: &mut [Vector]| dense::apply(&coated, &grid, by, q, u);
            let slip_residual = residual_by(sums, &grid, &g, &friction, &none, (&report, &solution));
            assert!(slip_residual <= 1.01e-7, "{t} {mu} {friction:?}: {slip_residual:e}");
        }
    }
}

/// The derivatives of forces in steady rolling equal differences of forces.
#[test]
fn derivatives_are_those_of_differences() {
    let (grid, g) = ellipse(0.8, 30);
    for (t, mu, nu) in COATS {
        let (coated, scale) = (coated(&grid, t, mu, nu), t.min(1.0) + mu);
        let solved = |xi: f64, sensitivities: bool, tolerance: f64| -> Report {
            let prescribed = [Prescribed::Creepage(xi), Prescribed::Creepage(0.1 * scale)];
            let friction = Friction { motion: Motion::SteadyRolling, prescribed, sensitivities, ..Friction::new(0.4) };
            run(&mut Solver::new(grid, coated.clone(), true, &Threads::One), &g, &friction, tolerance).0
        };
        let (xi, step) = (-0.2 * scale, 1e-5 * scale);
        let found = solved(xi, true, 1e-8).sensitivities.unwrap();
        let (up, down) = (solved(xi + step, false, 1e-10), solved(xi - step, false, 1e-10));
        for k in 0..2 {
            let difference = (up.force[k] - down.force[k]) / (2.0 * step);
            // A difference has an error of about 1e-3 of the largest derivative if an element changes between stick and slip (as in
            // sensitivities.rs).
            assert!(
                (found[k][0] - difference).abs() <= 3e-3 * found[0][0].abs(),
                "{t} {mu} {k}: {found:?} {difference}"
            );
        }
    }
}

/// Steady rolling of bodies with thin layers on rigid substrates. Each layer is a spring of compliance t/G1, both together 2 t/G1: tractions grow
/// with the slip from the leading edge on, up to mu p.
#[test]
fn a_thin_layer_on_rigid_bodies_rolls_by_the_linear_theory() {
    let m = 40;
    let (grid, g) = ellipse(1.0, m);
    let (t, xi) = (1e-3, -4e-4);
    let coated = coated(&grid, t, 0.0, [0.3, 0.3]);
    let prescribed = [Prescribed::Creepage(xi), Prescribed::Creepage(0.0)];
    let friction = Friction { motion: Motion::SteadyRolling, prescribed, ..Friction::new(0.4) };
    let (_, found) = run(&mut Solver::new(grid, coated, true, &Threads::One), &g, &friction, 1e-10);
    let mut slips = 0;
    for row in 0..m {
        let mut ahead = 0.0;
        for i in (row * m..(row + 1) * m).rev() {
            let free = ahead - xi * grid.dx / (2.0 * t);
            let expected = free.min(0.4 * g[i]);
            slips += usize::from(expected < free && g[i] > 0.0);
            // 1e-9 allows for the tolerance of the solve. The influence of one element on another is below the round-off of 2 t.
            assert!((found.traction[i][0] - expected).abs() <= 1e-9, "{i}: {:?} {expected}", found.traction[i]);
            assert!(found.traction[i][1].abs() <= 1e-9);
            ahead = expected;
        }
    }
    assert!(slips > 50 && slips < 1000, "{slips}");
}

const STEEL: Bodies = Bodies { shear_modulus: [80.0; 2], poisson_ratio: [0.3; 2] };
const RUBBER: CoatingLayer = CoatingLayer { thickness: 0.3, shear_modulus: 2.0, poisson_ratio: 0.45 };

fn both(layer: CoatingLayer) -> Option<Coating> {
    Some(Coating { layers: [Some(layer); 2] })
}

fn pushed() -> Friction<'static> {
    Friction { prescribed: [Prescribed::Force(0.4), Prescribed::Creepage(0.002)], spin: 1e-3, ..Friction::new(0.3) }
}

/// Solves three steps on one handle: a shift, a step of transient rolling, and steady rolling.
fn steps<'a>(scene: &Scene<'a>, own: Option<TangentialInfluence<'a>>) -> (Vec<f64>, Vec<Solution>) {
    let options = Options { tolerance: 1e-9, ..Options::default() };
    let kept = Friction { previous: Previous::Kept, ..pushed() };
    let prescribed = [Prescribed::Creepage(-0.02), Prescribed::Force(0.1)];
    let friction = [
        pushed(),
        Friction { motion: Motion::TransientRolling, ..kept },
        Friction { motion: Motion::SteadyRolling, prescribed, ..kept },
    ]
    .map(|friction| Friction { influence: own, ..friction });
    let with = |friction| Scene { friction: Some(friction), ..scene.clone() };
    let mut handle = SceneSolver::new(&with(friction[0]), &options).unwrap();
    let solved = friction.into_iter().map(|friction| {
        let (stop, _) = handle.solve(&with(friction), &options, None, None).unwrap();
        assert_eq!(stop, Outcome::Converged, "{friction:?}");
        handle.friction().unwrap().clone()
    });
    let solved = solved.collect();
    (handle.state().p.clone(), solved)
}

/// A coated scene with friction has the pressures of the scene without friction, and the tractions that tables of the same coefficients give.
#[test]
fn scenes_give_what_tables_of_the_coefficients_give() {
    let (grid, h) = ball(22, 0.2);
    for (layer, bodies) in [
        (RUBBER, STEEL),
        (RUBBER, Bodies { shear_modulus: [f64::INFINITY; 2], ..STEEL }),
        (CoatingLayer { thickness: 0.2, shear_modulus: 400.0, poisson_ratio: 0.2 }, STEEL),
    ] {
        let scene = Scene { coating: both(layer), ..Scene::new(grid, &h, bodies, Load::Force(3.0)) };
        let (pressure, found) = steps(&scene, None);
        let (without, ..) = solve(&scene, &Options { tolerance: 1e-9, ..Options::default() }).unwrap();
        assert_eq!(pressure, without.state().p);
        let (nu, mu) = (layer.poisson_ratio, layer.shear_modulus / bodies.shear_modulus[0]);
        let coated = coated(&grid, layer.thickness, mu, [nu, bodies.poisson_ratio[0]]);
        let (cx, cy) = (24_i64, 24_i64);
        let tables = [0, 1, 2].map(|k| -> Vec<f64> {
            let offsets = (-cy..cy).flat_map(|y| (-cx..cx).map(move |x| (x as f64, y as f64)));
            offsets.map(|(x, y)| coated.at(x, y)[k] / layer.shear_modulus).collect()
        });
        let coefficients = [&tables[0][..], &tables[1][..], &tables[2][..]];
        let own = TangentialInfluence { cx: 24, cy: 24, by_row: false, coefficients, cross: None, scale: 1.0 };
        let (_, expected) = steps(&scene, Some(own));
        for (found, expected) in found.iter().zip(&expected) {
            let largest = expected.traction.iter().map(|q| q[0].hypot(q[1])).fold(0.0, f64::max);
            assert!(largest > 0.0);
            for (a, b) in found.traction.iter().zip(&expected.traction) {
                // A residual of 1e-9 leaves an error of some 3e-7 in the tractions (docs/friction.md). Two solves are compared.
                assert!((a[0] - b[0]).hypot(a[1] - b[1]) <= 1e-6 * largest, "{a:?} {b:?} of {largest}");
            }
        }
        // The tangential problem alone, with given pressures, is solved as well.
        let alone = Scene { friction: Some(pushed()), ..scene.clone() };
        let options = Options { tolerance: 1e-9, ..Options::default() };
        let (stop, again, _) = solve_tangential(&alone, &pressure, &options, None).unwrap();
        assert!(stop == Outcome::Converged && again.traction.len() == grid.len());
        let off = again.traction.iter().zip(&found[0].traction).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
        assert!(off.fold(0.0, f64::max) <= 1e-6);
    }
}

/// The estimated errors of the forces of shifts and of steady rolling cover the differences from forces on grids that are 3 and 6 times finer.
#[test]
fn errors_of_forces_are_covered() {
    let force_on = |m: usize, (layer, bodies): (CoatingLayer, Bodies), motion: Motion, creepage: f64| {
        let d = 2.4 / m as f64;
        let (grid, h) = ball(m, d);
        let prescribed = [Prescribed::Creepage(-creepage), Prescribed::Creepage(0.0)];
        let friction = Friction { motion, prescribed, ..Friction::new(0.3) };
        let normal = Scene { coating: both(layer), ..Scene::new(grid, &h, bodies, Load::Approach(0.012)) };
        let options = Options { estimates: true, tolerance: 1e-7, ..Options::default() };
        let (_, stop, report) = solve(&Scene { friction: Some(friction), ..normal }, &options).unwrap();
        assert_eq!(stop, Outcome::Converged);
        report.friction.unwrap()
    };
    let stiff = |shear_modulus: f64| Bodies { shear_modulus: [shear_modulus; 2], poisson_ratio: [0.3; 2] };
    for (layer, bodies) in [
        (CoatingLayer { thickness: 0.25, shear_modulus: 1.0, poisson_ratio: 0.3 }, stiff(f64::INFINITY)),
        (CoatingLayer { thickness: 0.05, shear_modulus: 1.0, poisson_ratio: 0.3 }, stiff(10.0)),
        (CoatingLayer { thickness: 0.3, shear_modulus: 5.0, poisson_ratio: 0.2 }, stiff(1.0)),
    ] {
        for (motion, part) in [(Motion::Shift, 1.0), (Motion::SteadyRolling, 0.5)] {
            // `part` of the creepage at which all elements slip, about .0036 here.
            let creepage = part * 0.3 * 0.012;
            let exact = force_on(120, (layer, bodies), motion, creepage);
            for m in [20, 40] {
                let found = force_on(m, (layer, bodies), motion, creepage);
                let error = (found.force[0] - exact.force[0]).abs() / exact.carried;
                let estimated = found.error[0].map(|error| error / exact.carried);
                // For rolling there is no estimate if the contact has fewer than 24 elements across.
                let is_covered = estimated.map_or(motion == Motion::SteadyRolling, |estimated| error <= estimated);
                assert!(is_covered, "{m} {motion:?} {}: {error:e}, estimated {estimated:?}", layer.thickness);
            }
        }
    }
}

/// A very thick layer acts as a half-space, whatever the substrate. A layer of the body's own material gives the bits of the plain scene.
#[test]
fn thick_layers_and_equal_ones_are_half_spaces() {
    let (grid, h) = ball(22, 0.2);
    let plain = Scene::new(grid, &h, Bodies::same(2.0, 0.45), Load::Force(3.0));
    let (_, expected) = steps(&plain, None);
    let own = CoatingLayer { thickness: 0.7, ..RUBBER };
    let equal = Scene { coating: both(own), ..plain.clone() };
    for (found, expected) in steps(&equal, None).1.iter().zip(&expected) {
        assert_eq!(found.traction, expected.traction);
    }
    let thick = Scene { coating: both(CoatingLayer { thickness: 1e7, ..RUBBER }), bodies: STEEL, ..plain.clone() };
    for (found, expected) in steps(&thick, None).1.iter().zip(&expected) {
        for (a, b) in found.traction.iter().zip(&expected.traction) {
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) <= 1e-5, "{a:?} {b:?}");
        }
    }
}

/// Bodies with unequal coatings or substrates are refused. The message names the member that differs.
#[test]
fn other_bodies_are_refused_by_name() {
    let (grid, h) = ball(12, 0.2);
    let stiff = |shear_modulus| CoatingLayer { shear_modulus, ..RUBBER };
    let layers = |one, two| Some(Coating { layers: [one, two] });
    let bodies = |shear_modulus, poisson_ratio| Bodies { shear_modulus, poisson_ratio };
    for (coating, bodies, words) in [
        (layers(Some(RUBBER), None), STEEL, "coating[1] is none"),
        (layers(None, Some(RUBBER)), STEEL, "coating[0] is none"),
        // A coating of thickness 0 counts as no coating.
        (layers(Some(RUBBER), Some(CoatingLayer { thickness: 0.0, ..RUBBER })), STEEL, "coating[1] is none"),
        (
            layers(Some(RUBBER), Some(stiff(3.0))),
            STEEL,
            "coating[0]->shear_modulus is 2 and coating[1]->shear_modulus 3",
        ),
        (
            layers(Some(RUBBER), Some(CoatingLayer { thickness: 0.31, ..RUBBER })),
            STEEL,
            "coating[0]->thickness is 0.3 and coating[1]->thickness 0.31",
        ),
        (
            layers(Some(RUBBER), Some(CoatingLayer { poisson_ratio: 0.4, ..RUBBER })),
            STEEL,
            "coating[0]->poisson_ratio is 0.45 and coating[1]->poisson_ratio 0.4",
        ),
        (both(RUBBER), bodies([80.0, 81.0], [0.3; 2]), "shear_modulus[0] is 80 and shear_modulus[1] 81"),
        (both(RUBBER), bodies([80.0; 2], [0.3, 0.31]), "poisson_ratio[0] is 0.3 and poisson_ratio[1] 0.31"),
    ] {
        let scene = Scene { coating, friction: Some(pushed()), ..Scene::new(grid, &h, bodies, Load::Force(3.0)) };
        let pressure = vec![0.1; grid.len()];
        let refused = [
            solve(&scene, &Options::default()).map(|_| ()),
            solve_tangential(&scene, &pressure, &Options::default(), None).map(|_| ()),
        ];
        for refused in refused {
            let Err(Error::Unsupported(message)) = refused else { panic!("{words}: {refused:?}") };
            assert!(message.contains("friction and coating are both given") && message.contains(words), "{message}");
        }
    }
    // With given pressures a Poisson ratio out of range is refused, too.
    let scene =
        Scene { coating: both(stiff(1e7)), friction: Some(pushed()), ..Scene::new(grid, &h, STEEL, Load::Force(3.0)) };
    let refused = solve_tangential(&scene, &vec![0.1; grid.len()], &Options::default(), None).map(|_| ());
    assert!(matches!(refused, Err(Error::InvalidArgument(message)) if message.contains("ratio must be at most")));
}
