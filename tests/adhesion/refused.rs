//! A refused solve does not change the last result of a handle: its contact pressures, its attraction, and its friction.

use contact_normal::error::Error;
use contact_normal::influence::Table;
use contact_normal::scene::{Adhesion, Bodies, Coating, Friction, Load, Period, Prescribed, Scene, Work};
use contact_normal::solver::{InitialGuess, Options, Outcome, Solver};

use super::support::Sphere;

fn split(solver: &Solver) -> Vec<(f64, f64)> {
    let split = solver.adhesion().expect("a result of adhesion");
    (0..solver.grid().len()).map(split).collect()
}

fn refused(solver: &mut Solver, scene: &Scene<'_>) {
    let outcome = solver.solve(scene, &Options::default(), None, None).map(|_| ());
    assert!(
        matches!(outcome, Err(Error::InvalidArgument(_) | Error::NotFinite(_) | Error::Infeasible(_))),
        "{outcome:?}"
    );
}

#[test]
fn what_is_refused_leaves_the_split_of_the_pressures() {
    let sphere = Sphere::by_tabor(1.0, 24, 3.0);
    let adhesive = sphere.scene(Load::Approach(0.1));
    let plain = Scene { adhesion: None, ..adhesive.clone() };
    let friction = Friction { prescribed: [Prescribed::Force(1e3), Prescribed::Creepage(0.0)], ..Friction::new(0.3) };
    let rubbed = Scene { friction: Some(friction), load: Load::Force(0.5), ..plain.clone() };
    let far = Scene { load: Load::Approach(1e150), ..plain.clone() };
    for scene in [far, rubbed] {
        let mut solver = Solver::new(&adhesive, &Options::default()).expect("a solver");
        assert_eq!(solver.solve(&adhesive, &Options::default(), None, None).expect("a solve").0, Outcome::Converged);
        let before = split(&solver);
        assert!(before.iter().any(|(_, attraction)| *attraction > 0.0));
        refused(&mut solver, &scene);
        assert_eq!(before, split(&solver));
        // The next solve of the handle works as before.
        assert_eq!(solver.solve(&plain, &Options::default(), None, None).expect("a solve").0, Outcome::Converged);
        assert!(solver.adhesion().is_none());
    }
}

#[test]
fn what_is_refused_for_its_friction_leaves_a_result_of_adhesion() {
    let sphere = Sphere::by_tabor(1.0, 24, 3.0);
    let of = |force: f64| {
        let prescribed = [Prescribed::Force(force), Prescribed::Creepage(0.0)];
        let friction = Some(Friction { prescribed, ..Friction::new(0.3) });
        // The bodies are equal, so that tractions do not change the pressures.
        let bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3; 2] };
        Scene { friction, bodies, ..sphere.scene(Load::Approach(0.1)) }
    };
    let mut solver = Solver::new(&of(0.1), &Options::default()).expect("a solver");
    assert_eq!(solver.solve(&of(0.1), &Options::default(), None, None).expect("a solve").0, Outcome::Converged);
    let (before, p) = (split(&solver), solver.state().p.clone());
    // A refused scene with another work of adhesion does not change the result, either.
    let own = Adhesion { work: Work::Uniform(0.1), ..sphere.adhesion };
    refused(&mut solver, &Scene { adhesion: Some(own), ..of(1e3) });
    refused(&mut solver, &of(1e3));
    assert_eq!((before, p), (split(&solver), solver.state().p.clone()));
}

/// A new table, and the coefficients of a refused scene, do not change the contact pressures and the attraction of the last result.
#[test]
fn other_coefficients_leave_the_split_of_the_pressures() {
    let sphere = Sphere::by_tabor(1.0, 16, 3.0);
    let adhesive = sphere.scene(Load::Approach(0.1));
    let plain = Scene { adhesion: None, ..adhesive.clone() };
    let half_space = Solver::new(&plain, &Options::default()).expect("a solver");
    let kernel = half_space.influence().kernel();
    // The first row and column are not read.
    let of = |k: i64| if k == -16 { 0 } else { k };
    let offsets = (0..4 * 16 * 16).map(|i| (of(i % 32 - 16), of(i / 32 - 16)));
    let values: Vec<f64> = offsets.map(|to| kernel.between((0, 0), to)).collect();
    let table = || Table::new(16, 16, &values, &sphere.grid).expect("a table");
    let own = Scene { influence: Some(table()), ..adhesive.clone() };
    let mut solver = Solver::new(&own, &Options::default()).expect("a solver");
    assert_eq!(solver.solve(&own, &Options::default(), None, None).expect("a solve").0, Outcome::Converged);
    let before = split(&solver);
    assert!(before.iter().any(|(_, attraction)| *attraction > 0.0));
    solver.set_influence(table()).expect("a table");
    assert_eq!(before, split(&solver));

    let period = Some(Period { x: true, y: true });
    let coating = Some(Coating::of_body_1(0.5, 1.0, 0.3));
    let coated = Scene { period, coating, ..adhesive };
    let mut solver = Solver::new(&coated, &Options::default()).expect("a solver");
    assert_eq!(solver.solve(&coated, &Options::default(), None, None).expect("a solve").0, Outcome::Converged);
    let before = split(&solver);
    refused(&mut solver, &Scene { adhesion: None, load: Load::Force(1e200), ..coated.clone() });
    assert_eq!(before, split(&solver));
}

/// The stiffness that is computed without adhesion does not hold for a result with adhesion, so that the call is refused.
#[test]
fn the_stiffness_of_a_result_with_adhesion_is_in_its_report() {
    let sphere = Sphere::by_tabor(1.0, 24, 3.0);
    let scene = sphere.scene(Load::Approach(0.1));
    let mut solver = Solver::new(&scene, &Options::default()).expect("a solver");
    solver.solve(&scene, &Options::default(), None, None).expect("a solve");
    let Err(Error::Unsupported(message)) = solver.stiffness().map(|_| ()) else { panic!("not refused") };
    assert!(message.contains("adhesion->stiffness"), "{message}");
}

/// Unloading step by step, on a branch with hysteresis: a pull that no state carries is refused, and the next step stays on the branch.
#[test]
fn a_pull_that_is_refused_leaves_the_state_from_which_steps_go_on() {
    let sphere = Sphere::by_tabor(1.0, 24, 3.0);
    let ways = [false, true].map(|is_refused| {
        let mut solver = Solver::new(&sphere.scene(Load::Approach(0.2)), &Options::default()).expect("a solver");
        let mut way = Vec::new();
        for (k, approach) in [0.2, 0.1, 0.0, -0.1, -0.2, -0.3].into_iter().enumerate() {
            if is_refused && k > 0 {
                let before = (split(&solver), solver.state().p.clone(), solver.state().approach);
                refused(&mut solver, &sphere.scene(Load::Force(-1e6)));
                assert!(
                    solver.has_solved()
                        && (split(&solver), solver.state().p.clone(), solver.state().approach) == before
                );
            }
            let initial_guess = if k == 0 { InitialGuess::None } else { InitialGuess::Previous };
            let options = Options { initial_guess, ..Options::default() };
            let scene = sphere.scene(Load::Approach(approach));
            assert_eq!(solver.solve(&scene, &options, None, None).expect("a step").0, Outcome::Converged);
            way.push((solver.state().p.clone(), solver.state().contact.clone()));
        }
        way
    });
    assert!(ways[0] == ways[1]);
}
