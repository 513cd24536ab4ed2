//! Adhesion beside other effects: solved, or refused by name.

use contact_normal::adhesion::Law;
use contact_normal::error::Error;
use contact_normal::scene::{Coating, Friction, Layer, Load, Patches, PressureLimit, Scene};
use contact_normal::solver::{self, Criterion, Method, Options, Outcome};

use super::certificate::{displacements, traction, worst};
use super::support::{Sphere, MODULUS};

fn refusal(scene: &Scene<'_>, options: &Options) -> String {
    match solver::solve(scene, options) {
        Err(Error::Unsupported(message)) => message,
        other => panic!("{:?}", other.map(|(_, outcome, _)| outcome)),
    }
}

#[test]
fn effects_that_are_not_solved_with_it_are_refused_by_name() {
    let sphere = Sphere::by_tabor(1.0, 16, 3.0);
    let plain = sphere.scene(Load::Approach(0.5));
    let friction = Friction::new(0.3);
    let patch = vec![0; 256];
    let refused = [
        ("pressure_limit", Scene { pressure_limit: Some(PressureLimit::Uniform(1.0)), ..plain.clone() }),
        ("friction", Scene { friction: Some(friction), ..plain.clone() }),
        ("patches", Scene { patches: Some(Patches { count: 1, patch: &patch, factors: &[1.0] }), ..plain.clone() }),
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
    for layer in [Layer::Uniform(0.03), Layer::PerElement(&compliances)] {
        for load in [Load::Approach(0.5), Load::Force(-0.5)] {
            let scene = Scene { layer: Some(layer), ..sphere.scene(load) };
            let (solver, outcome, _) = solver::solve(&scene, &Options::default()).expect("a solve");
            assert_eq!(outcome, Outcome::Converged);
            let state = solver.state();
            let mut u = displacements(&sphere.grid, MODULUS, &state.p);
            for (i, u) in u.iter_mut().enumerate() {
                *u += state.p[i]
                    * match layer {
                        Layer::Uniform(c) => c,
                        Layer::PerElement(c) => c[i],
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

// A coating of the substrate's own stiffness, but for a hair, changes the result by as much.
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
