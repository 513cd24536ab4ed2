//! If a scene is refused for its friction after its normal problem is solved, the handle does not change: it keeps its last result (or none), and the
//! state from which a step in time continues.

use contact_normal::friction::Solution;
use contact_normal::grid::Grid;
use contact_normal::scene::{
    Bodies, Coefficient, Each, Friction, Load, Motion, Prescribed, PressureLimit, Previous, Scene, TangentialInfluence,
};
use contact_normal::solver::{InitialGuess, Options, Outcome, Solver};

use super::support::ball;

const LIKE: Bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3; 2] };
const UNLIKE: Bodies = Bodies { shear_modulus: [1.0, 3.0], poisson_ratio: [0.2, 0.4] };

/// The tractions and slips as bits, and whether each element sticks or slips.
type Tractions = (Vec<[u64; 2]>, Vec<[u64; 2]>, Vec<i32>);

/// Everything that a caller can read of a handle's last result.
#[derive(Debug, PartialEq)]
struct Shown {
    has_solved: bool,
    numbers: Vec<u64>,
    contact: Vec<bool>,
    at_limit: Vec<bool>,
    traction: Option<Tractions>,
    rows: usize,
}

fn shown(solver: &Solver) -> Shown {
    let state = solver.state();
    let of_friction = |found: &Solution| {
        let bits = |field: &[[f64; 2]]| field.iter().map(|v| v.map(f64::to_bits)).collect();
        (bits(&found.traction), bits(&found.slip), found.stick_slip.clone())
    };
    let numbers = state.h.iter().chain(&state.p).chain(&state.u).chain([&state.approach]);
    Shown {
        has_solved: solver.has_solved(),
        numbers: numbers.map(|value| value.to_bits()).collect(),
        contact: state.contact.clone(),
        at_limit: state.at_limit.clone(),
        traction: solver.friction().map(of_friction),
        rows: solver.ledger().len(),
    }
}

fn pushed() -> Friction<'static> {
    Friction { prescribed: [Prescribed::Creepage(-0.004), Prescribed::Creepage(0.001)], ..Friction::new(0.3) }
}

/// Settings of friction that are refused, most of them only after the pressures are known.
fn refused(first_has_tractions: bool) -> Vec<(&'static str, Friction<'static>)> {
    let forces = |x, y| Friction { prescribed: [Prescribed::Force(x), Prescribed::Force(y)], ..Friction::new(0.3) };
    let creepage = |x| Friction { prescribed: [Prescribed::Creepage(x); 2], ..Friction::new(0.3) };
    let mut all = vec![
        ("a force of 2 mu N", forces(0.0, 0.6)),
        ("both forces", forces(-0.29, 0.29)),
        ("a force without friction", Friction { coefficient: Coefficient::Uniform(0.0), ..forces(0.01, 0.0) }),
        ("a force in rolling", Friction { motion: Motion::SteadyRolling, ..forces(5.0, 0.0) }),
        ("a huge slip", creepage(1e60)),
        ("a huge spin", Friction { spin: 1e45, ..Friction::new(0.3) }),
        ("no number", Friction { spin: f64::NAN, ..Friction::new(0.3) }),
        ("a negative coefficient", Friction::new(-1.0)),
    ];
    if !first_has_tractions {
        all.push(("continues from nothing", Friction { previous: Previous::Kept, ..pushed() }));
    }
    all
}

#[test]
fn a_handle_keeps_its_result_and_its_way_on() {
    let (grid, h) = ball(40, 0.06);
    let higher: Vec<f64> = h.iter().map(|h| 1.3 * h).collect();
    for bodies in [LIKE, UNLIKE] {
        for load in [Load::Force(0.03), Load::Approach(0.01)] {
            let plain = Scene::new(grid, &h, bodies, load);
            for (first, limit) in
                [(None, None), (Some(pushed()), None), (Some(pushed()), Some(PressureLimit(Each::Uniform(0.012))))]
            {
                let first_scene = Scene { friction: first, pressure_limit: limit, ..plain.clone() };
                for (what, friction) in refused(first.is_some()) {
                    for initial_guess in [InitialGuess::None, InitialGuess::Previous] {
                        let new = || {
                            let mut solver = Solver::new(&first_scene, &Options::default()).unwrap();
                            for part in [0.98, 1.0] {
                                let scene = Scene { load: times(load, part), ..first_scene.clone() };
                                let again = Options { initial_guess, ..Options::default() };
                                let (stop, _) = solver.solve(&scene, &again, None, None).unwrap();
                                assert_eq!(stop, Outcome::Converged);
                            }
                            solver
                        };
                        let (mut undisturbed, mut solver) = (new(), new());
                        let before = shown(&solver);
                        let bad = Scene {
                            friction: Some(friction),
                            undeformed_distance: &higher,
                            // With an approach the force is known only after the solve.
                            load: times(load, 0.8),
                            ..plain.clone()
                        };
                        let options = Options { initial_guess, ..Options::default() };
                        let what = format!("{what}, {bodies:?} {load:?} {initial_guess:?} {}", first.is_some());
                        assert!(solver.solve(&bad, &options, None, None).is_err(), "{what}");
                        assert!(shown(&solver) == before, "{what}: another result");
                        // The next step has the result that it would have without the refused solve.
                        let again = Options { initial_guess: InitialGuess::Previous, ..Options::default() };
                        let previous = if first.is_some() { Previous::Kept } else { Previous::None };
                        let friction = first.map(|friction| Friction { previous, ..friction });
                        let next = Scene { friction, load: times(load, 1.03), ..first_scene.clone() };
                        for handle in [&mut undisturbed, &mut solver] {
                            let (stop, _) = handle.solve(&next, &again, None, None).unwrap();
                            assert_eq!(stop, Outcome::Converged, "{what}");
                        }
                        assert!(shown(&solver) == shown(&undisturbed), "{what}: another next step");
                    }
                }
            }
        }
    }
}

fn times(load: Load, factor: f64) -> Load {
    match load {
        Load::Approach(approach) => Load::Approach(factor * approach),
        Load::Force(force) => Load::Force(factor * force),
    }
}

#[test]
fn without_a_result_there_is_none_after_a_refusal() {
    let (grid, h) = ball(24, 0.1);
    for bodies in [LIKE, UNLIKE] {
        for (what, friction) in refused(false) {
            let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(0.03)) };
            let good = Scene { friction: Some(pushed()), ..scene.clone() };
            let mut solver = Solver::new(&good, &Options::default()).unwrap();
            assert!(solver.solve(&scene, &Options::default(), None, None).is_err(), "{what}");
            assert!(!solver.has_solved() && solver.friction().is_none(), "{what}");
            let (stop, _) = solver.solve(&good, &Options::default(), None, None).unwrap();
            assert_eq!(stop, Outcome::Converged, "{what}");
            // The last result is that of a scene without friction, which has no tractions, although a next step may continue from earlier ones.
            if friction.previous == Previous::Kept {
                continue;
            }
            solver.solve(&Scene { friction: None, ..good.clone() }, &Options::default(), None, None).unwrap();
            let before = shown(&solver);
            assert!(solver.solve(&scene, &Options::default(), None, None).is_err(), "{what}");
            assert!(shown(&solver) == before && solver.friction().is_none(), "{what}");
        }
    }
}

/// Other tangential coefficients need other operators. If they are refused, the last result remains: the tractions with the earlier coefficients.
#[test]
fn other_tables_that_are_refused_leave_the_tractions_of_those_before() {
    let (grid, h) = ball(16, 0.15);
    let table = |scale: f64| -> [Vec<f64>; 3] {
        let Grid { mx, my, .. } = grid;
        let at = |i: usize| {
            let (x, y) = ((i % (2 * mx)) as f64 - mx as f64, (i / (2 * mx)) as f64 - my as f64);
            scale * (-x.hypot(y) / 3.0).exp()
        };
        let even: Vec<f64> = (0..4 * mx * my).map(at).collect();
        [even.clone(), even, vec![0.0; 4 * mx * my]]
    };
    let (one, other) = (table(0.1), table(0.2));
    let plain = Scene::new(grid, &h, LIKE, Load::Force(0.03));
    fn with<'a>(plain: &Scene<'a>, [xx, yy, xy]: &'a [Vec<f64>; 3], friction: Friction<'a>) -> Scene<'a> {
        let influence =
            TangentialInfluence { cx: 16, cy: 16, coefficients: [xx, yy, xy], cross: None, scale: 1.0, by_row: false };
        Scene { friction: Some(Friction { influence: Some(influence), ..friction }), ..plain.clone() }
    }
    let options = Options::default();
    let mut solver = Solver::new(&with(&plain, &one, pushed()), &options).unwrap();
    solver.solve(&with(&plain, &one, pushed()), &options, None, None).unwrap();
    let before = shown(&solver);
    assert!(before.traction.is_some());
    let too_much = Friction { prescribed: [Prescribed::Force(5.0); 2], ..Friction::new(0.3) };
    assert!(solver.solve(&with(&plain, &other, too_much), &options, None, None).is_err());
    assert!(shown(&solver) == before);
    let kept = Friction { previous: Previous::Kept, ..pushed() };
    assert!(
        solver.solve(&with(&plain, &other, kept), &options, None, None).is_err(),
        "tractions of other coefficients"
    );
    assert!(shown(&solver) == before);
    let (stop, _) = solver.solve(&with(&plain, &one, kept), &options, None, None).unwrap();
    assert_eq!(stop, Outcome::Converged);
}
