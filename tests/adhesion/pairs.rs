//! Adhesion together with other effects: solved, or refused with a message that names the effect.

use contact_normal::adhesion::Law;
use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{Coating, Each, Friction, Layer, Load, Patches, PressureLimit, Scene};
use contact_normal::solver::{self, solve_to_accuracy, Accuracy, Criterion, Method, Options, Outcome, Solver};

use super::certificate::{displacements, traction, worst};
use super::support::{adhesion, bodies, Sphere, MODULUS};

fn refusal(scene: &Scene<'_>, options: &Options) -> String {
    match solver::solve(scene, options) {
        Err(Error::Unsupported(message)) => message,
        other => panic!("{:?}", other.map(|(_, outcome, _)| outcome)),
    }
}

#[test]
fn effects_that_adhesion_excludes_are_refused_by_name() {
    let sphere = Sphere::by_tabor(1.0, 16, 3.0);
    let plain = sphere.scene(Load::Approach(0.5));
    let friction = Friction::new(0.3);
    let refused = [
        ("pressure_limit", Scene { pressure_limit: Some(PressureLimit(Each::Uniform(1.0))), ..plain.clone() }),
        // The bodies are unlike, because one is rigid: tractions would change the pressures.
        ("friction", Scene { friction: Some(friction), ..plain.clone() }),
    ];
    for (name, scene) in refused {
        let message = refusal(&scene, &Options::default());
        assert!(message.contains(name) && message.contains("adhesion"), "{message}");
    }
    for options in [
        Options { method: Method::Norm, ..Options::default() },
        Options { criterion: Criterion::Update, ..Options::default() },
    ] {
        assert!(refusal(&plain, &options).contains("adhesion"));
    }
}

// A layer adds c p to the displacements of the half-space.
#[test]
fn a_layer_gives_way_by_its_compliance() {
    let sphere = Sphere::by_tabor(1.0, 40, 3.0);
    let compliances: Vec<f64> = (0..1600).map(|i| if i % 40 < 20 { 0.02 } else { 0.05 }).collect();
    for layer in [Layer(Each::Uniform(0.03)), Layer(Each::PerElement(&compliances))] {
        for load in [Load::Approach(0.5), Load::Force(-0.5)] {
            let scene = Scene { layer: Some(layer), ..sphere.scene(load) };
            let (solver, outcome, _) = solver::solve(&scene, &Options::default()).expect("a solve");
            assert_eq!(outcome, Outcome::Converged);
            let state = solver.state();
            let mut u = displacements(&sphere.grid, MODULUS, &state.p);
            for (i, u) in u.iter_mut().enumerate() {
                *u += state.p[i]
                    * match layer {
                        Layer(Each::Uniform(c)) => c,
                        Layer(Each::PerElement(c)) => c[i],
                    };
            }
            let worst = worst(state, &u, |_, e| traction(Law::Exponential, sphere_work(), sphere.adhesion.range, e));
            assert!(worst < 2e-6, "{layer:?} {load:?}: {worst:e}");
        }
    }
}

fn sphere_work() -> f64 {
    1.0 / std::f64::consts::PI
}

// A coating with nearly the stiffness of the substrate changes the result a little.
#[test]
fn a_coating_of_nearly_the_same_material_changes_little() {
    let sphere = Sphere::by_tabor(1.0, 32, 3.0);
    let plain = sphere.scene(Load::Approach(0.3));
    let modulus = plain.bodies.shear_modulus[0];
    let (_, _, without) = solver::solve(&plain, &Options::default()).expect("a solve");
    let coated = Scene { coating: Some(Coating::of_body_1(0.5, 1.001 * modulus, 0.0)), ..plain };
    let (_, outcome, with) = solver::solve(&coated, &Options::default()).expect("a solve");
    assert_eq!(outcome, Outcome::Converged);
    let change = with.measures.force - without.measures.force;
    assert!(change.abs() < 2e-3 && change != 0.0, "{change}");
}

// Two spheres side by side on two patches, whose interaction is scaled. One element between them is in no patch.
#[test]
fn patches_scale_the_displacements_by_each_other() {
    let n = 32;
    let grid = Grid::new(2 * n, n, 0.15, 0.15).expect("a grid");
    let centre = |i: usize| {
        let (x, y) = (i % grid.mx, i / grid.mx);
        ((x % n) as f64 - 15.5, y as f64 - 15.5)
    };
    let h: Vec<f64> =
        (0..grid.len()).map(|i| 0.5 * 0.15f64.powi(2) * (centre(i).0.powi(2) + centre(i).1.powi(2))).collect();
    let patch: Vec<i32> = (0..grid.len()).map(|i| if i == n { -1 } else { i32::from(i % grid.mx >= n) }).collect();
    let patches = Patches { count: 2, patch: &patch, factors: &[1.0, 0.4, 0.4, 1.0] };
    for load in [Load::Approach(0.3), Load::Force(-1.5)] {
        let own = adhesion(Law::Exponential, sphere_work(), 0.6);
        let scene =
            Scene { adhesion: Some(own), patches: Some(patches), ..Scene::new(grid, &h, bodies(MODULUS), load) };
        let (solver, outcome, _) = solver::solve(&scene, &Options::default()).expect("a solve");
        assert_eq!(outcome, Outcome::Converged, "{load:?}");
        let state = solver.state();
        let of = |k: i32| -> Vec<f64> {
            let part: Vec<f64> = (0..grid.len()).map(|i| if patch[i].max(0) == k { state.p[i] } else { 0.0 }).collect();
            displacements(&grid, MODULUS, &part)
        };
        let parts = [of(0), of(1)];
        let u: Vec<f64> = (0..grid.len())
            .map(|i| {
                let own = patch[i].max(0) as usize;
                parts[own][i] + 0.4 * parts[1 - own][i]
            })
            .collect();
        assert!(state.p[n] == 0.0);
        let worst =
            worst(
                state,
                &u,
                |_, e| if e.is_finite() { traction(Law::Exponential, sphere_work(), 0.6, e) } else { 0.0 },
            );
        assert!(worst < 2e-6, "{load:?}: {worst:e}");
        // The patches reduce the interaction of the spheres, so that the result differs from that without patches.
        let whole = Scene { patches: None, ..scene.clone() };
        let (_, _, whole) = solver::solve(&whole, &Options::default()).expect("a solve");
        assert!(
            (whole.measures.approach - state.approach).abs() + (whole.measures.force - solver_force(&solver)).abs()
                > 1e-3
        );
    }
}

fn solver_force(solver: &Solver) -> f64 {
    solver.state().p.iter().sum::<f64>() * solver.grid().element_area()
}

// A row and a column of elements give the same result.
#[test]
fn a_row_and_a_column_have_the_same_share_on_their_border() {
    let (n, d, work, range) = (64, 0.1, 0.3, 0.3);
    let h: Vec<f64> = (0..n).map(|i| 0.5 * ((i as f64 - 31.5) * d).powi(2)).collect();
    let shares = [(n, 1), (1, n)].map(|(mx, my)| {
        let grid = Grid::new(mx, my, d, d).expect("a grid");
        let own = Some(adhesion(Law::Exponential, work, range));
        let scene = Scene { adhesion: own, ..Scene::new(grid, &h, bodies(MODULUS), Load::Approach(0.2)) };
        let (solver, outcome, report) = solver::solve(&scene, &Options::default()).expect("a solve");
        assert_eq!(outcome, Outcome::Converged);
        let u = displacements(&grid, MODULUS, &solver.state().p);
        let sigma = |i: usize| traction(Law::Exponential, work, range, solver.state().h[i] - 0.2 + u[i]);
        let own = (sigma(0) + sigma(n - 1)) / (0..n).map(sigma).sum::<f64>();
        let found = report.adhesion.expect("adhesion").border_share;
        // The error of pressures at a residual of 1e-6, and 1e-12 for round-off.
        assert!((found - own).abs() < 1e-5 * own + 1e-12 && own < 1e-3, "{mx} x {my}: {found:e} {own:e}");
        found
    });
    assert!((shares[0] - shares[1]).abs() < 1e-5 * shares[0] + 1e-12, "{shares:?}");
}

// For a pull, as for a force that presses, the error is estimated from three grids.
#[test]
fn a_pull_is_solved_to_an_accuracy() {
    let n = 32;
    let sphere = Sphere::by_tabor(1.0, n, 3.0);
    let scene = sphere.scene(Load::Force(-1.0));
    let accuracy = Accuracy { max_elements: (256 * 256) as u64, ..Accuracy::new(3e-3) };
    let found = solve_to_accuracy(&scene, &Options::default(), &accuracy, None, None).expect("a solvable scene");
    println!("{:?}: {} {:?}", found.stop, found.reason, found.reached);
    assert!((found.report.measures.force + 1.0).abs() < 1e-5);
    let found = found.report.adhesion.expect("adhesion");
    assert!((found.range - sphere.adhesion.range).abs() < 1e-12);
}
