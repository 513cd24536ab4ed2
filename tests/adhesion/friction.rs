//! Friction with adhesion: the bound `mu q + tau0` in contact, with the contact pressure q and the shear strength tau0 (Derjaguin 1934).

use contact_normal::scene::{Adhesion, Bodies, Coefficient, Friction, Load, Prescribed, Previous, Scene};
use contact_normal::solver::{self, Entry, InitialGuess, Options, Outcome, Solver};

use super::support::{Sphere, MODULUS};

/// Two equal bodies with the E* of the sphere, so that tractions do not change the pressures.
fn alike() -> Bodies {
    // E* = G/(1 - nu).
    Bodies { shear_modulus: [0.7 * MODULUS; 2], poisson_ratio: [0.3; 2] }
}

fn scene<'a>(sphere: &'a Sphere, strength: f64, friction: Friction<'a>) -> Scene<'a> {
    let adhesion = Some(Adhesion { shear_strength: strength, ..sphere.adhesion });
    Scene { adhesion, bodies: alike(), friction: Some(friction), ..sphere.scene(Load::Force(-0.5)) }
}

/// Friction with a rigid shift of the bodies in x.
fn moved(mu: f64, by: f64) -> Friction<'static> {
    Friction { prescribed: [Prescribed::Creepage(by), Prescribed::Creepage(0.0)], ..Friction::new(mu) }
}

fn solved(scene: &Scene<'_>) -> (Solver, solver::Report) {
    let (solver, outcome, report) = solver::solve(scene, &Options::default()).expect("a solve");
    assert_eq!(outcome, Outcome::Converged);
    (solver, report)
}

// In full slip the tangential force is that of the bound: mu times the repulsive force, even if the total normal force pulls, plus tau0 times the
// contact area.
#[test]
fn sliding_takes_the_force_of_contact_pressures_and_of_the_strength() {
    let sphere = Sphere::by_tabor(1.0, 40, 3.0);
    for (mu, strength) in [(0.3, 0.0), (0.0, 0.2), (0.3, 0.2)] {
        let (_, report) = solved(&scene(&sphere, strength, moved(mu, -1e5)));
        let (found, friction) = (report.adhesion.expect("adhesion"), report.friction.expect("friction"));
        assert!(report.measures.force < 0.0 && found.repulsive_force > 0.5);
        let bound = mu * found.repulsive_force + strength * report.measures.contact_area;
        assert!((friction.force[0] - bound).abs() < 1e-9 * bound, "{mu} {strength}: {} {bound}", friction.force[0]);
    }
}

// A part of the contact sticks. Tractions are within the bound, and the given tangential force is reached.
#[test]
fn tractions_lie_within_the_bound_and_slip_is_against_them() {
    let sphere = Sphere::by_tabor(1.0, 40, 3.0);
    let friction = Friction { prescribed: [Prescribed::Force(1.6), Prescribed::Creepage(0.0)], ..Friction::new(0.3) };
    let (solver, report) = solved(&scene(&sphere, 0.1, friction));
    let split = solver.adhesion().expect("adhesion");
    let found = solver.friction().expect("friction");
    assert!((report.friction.expect("friction").force[0] - 1.6).abs() < 1e-5);
    let (mut stick, mut slip) = (0, 0);
    for i in 0..sphere.grid.len() {
        let q = split(i).0;
        let bound = if q > 0.0 { 0.3 * q + 0.1 } else { 0.0 };
        let ([x, y], [sx, sy]) = (found.traction[i], found.slip[i]);
        let size = x.hypot(y);
        assert!(size <= bound * (1.0 + 1e-12), "{size} {bound}");
        if q > 0.0 && size < bound * (1.0 - 1e-6) {
            stick += 1;
            assert!(sx.hypot(sy) < 1e-5, "{sx} {sy}");
        } else if q > 0.0 {
            slip += 1;
            assert!(x * sx + y * sy <= 0.0);
        }
    }
    assert!(stick > 20 && slip > 20, "{stick} {slip}");
}

// The tractions equal those of a scene without adhesion, with the contact pressures and with coefficients of friction that give the same bound.
#[test]
fn the_tangential_problem_is_that_of_a_plain_scene_with_this_bound() {
    let sphere = Sphere::by_tabor(1.0, 40, 3.0);
    let given = scene(&sphere, 0.1, moved(0.3, -0.4));
    let (solver, _) = solved(&given);
    let split = solver.adhesion().expect("adhesion");
    let q: Vec<f64> = (0..sphere.grid.len()).map(|i| split(i).0).collect();
    let mu: Vec<f64> = q.iter().map(|q| if *q > 0.0 { 0.3 + 0.1 / q } else { 0.0 }).collect();
    let friction = Friction { coefficient: Coefficient::PerElement(&mu), ..moved(0.3, -0.4) };
    let plain = Scene { adhesion: None, friction: Some(friction), ..given.clone() };
    let options = Options { tolerance: 1e-9, ..Options::default() };
    let (_, same, _) = solver::solve_tangential(&plain, &q, &options, None).expect("a solve");
    // The tangential problem with given contact pressures uses the bound of the adhesive scene, too.
    let (_, also, _) = solver::solve_tangential(&given, &q, &options, None).expect("a solve");
    let most = same.traction.iter().map(|q| q[0].abs()).fold(0.0, f64::max);
    let found = solver.friction().expect("friction");
    for i in 0..q.len() {
        for (other, tolerance) in [(&found.traction, 1e-4), (&also.traction, 1e-7)] {
            for (one, two) in other[i].iter().zip(same.traction[i]) {
                assert!((one - two).abs() < tolerance * most, "{i}: {one} {two}");
            }
        }
    }
    let entries = [Entry { amount: [-0.4, 0.0], spin: 0.0 }];
    let check = |_: usize, ended: solver::Ended, found: Option<&contact_normal::friction::Solution>| {
        assert_eq!(ended.expect("an entry").0, Outcome::Converged);
        let found = found.expect("tractions");
        assert!(found.traction.iter().zip(&same.traction).all(|(one, two)| (one[0] - two[0]).abs() < 1e-4 * most));
    };
    solver::solve_friction_batch(&given, None, &entries, &Options::default(), None, check).expect("a table");
}

// Steps of loads and shifts. Each begins with the tractions of the last step, and a refused step does not change them.
#[test]
fn a_handle_continues_from_its_tractions() {
    let sphere = Sphere::by_tabor(1.0, 32, 3.0);
    let first = scene(&sphere, 0.1, moved(0.3, -0.1));
    let mut solver = Solver::new(&first, &Options::default()).expect("a solver");
    solver.solve(&first, &Options::default(), None, None).expect("a step");
    let before = solver.friction().expect("friction").traction.clone();
    let next = |by: f64, previous| scene(&sphere, 0.1, Friction { previous, ..moved(0.3, by) });
    let options = Options { initial_guess: InitialGuess::Previous, ..Options::default() };
    let too_much = Friction { prescribed: [Prescribed::Force(1e3), Prescribed::Creepage(0.0)], ..Friction::new(0.3) };
    assert!(solver.solve(&scene(&sphere, 0.1, too_much), &options, None, None).is_err());
    let (x, y): (Vec<f64>, Vec<f64>) = before.iter().map(|q| (q[0], q[1])).unzip();
    let mut own = Solver::new(&first, &Options::default()).expect("a solver");
    own.solve(&next(0.05, Previous::Given([&x, &y])), &Options::default(), None, None).expect("a step");
    let mut again = Solver::new(&first, &Options::default()).expect("a solver");
    again.solve(&first, &Options::default(), None, None).expect("a step");
    again.solve(&next(0.05, Previous::Kept), &options, None, None).expect("a step");
    let most = x.iter().fold(0.0, |most: f64, q| most.max(q.abs()));
    let pair = (own.friction().expect("friction"), again.friction().expect("friction"));
    assert!(pair.0.traction.iter().zip(&pair.1.traction).all(|(one, two)| (one[0] - two[0]).abs() < 1e-3 * most));
}
