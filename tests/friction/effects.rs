//! Friction together with each other effect of a scene: none is ignored, and unsupported pairs are refused with a message that names the effect. Also
//! the reuse of handles, and the precisions.

use contact_normal::error::Error;
use contact_normal::influence::{RowTables, Table};
use contact_normal::scene::{
    Bodies, Coating, CoatingLayer, Coefficient, Each, Friction, Layer, Load, Patches, Period, Prescribed,
    PressureLimit, Scene,
};
use contact_normal::solver::{solve, ActiveSet, Guess, Options, Outcome, Progress, Solver};

use super::support::{ball, residual};

const STEEL: Bodies = Bodies { shear_modulus: [82000.0; 2], poisson_ratio: [0.28; 2] };

fn pushed() -> Friction<'static> {
    Friction { prescribed: [Prescribed::Creepage(-2e-3), Prescribed::Creepage(5e-4)], ..Friction::new(0.3) }
}

#[test]
fn each_effect_changes_the_tractions_or_is_refused() {
    let (grid, h) = ball(32, 0.06);
    let mut holes = h.clone();
    (0..32).for_each(|k| holes[16 * 32 + k] = f64::INFINITY);
    let compliance = 1.0 / 65536.0;
    let bodies = Bodies::same(1.0 / compliance, 0.28);
    let plain = Scene { friction: Some(pushed()), ..Scene::new(grid, &h, bodies, Load::Force(1000.0)) };
    let (alone, ..) = solve(&plain, &Options::default()).unwrap();
    let alone = alone.friction().unwrap().traction.clone();
    let patch = vec![0; grid.len()];
    let table = vec![1e-6; 4 * grid.len()];
    let row_tables = vec![1e-6; 2 * 32 * 32 * 32];
    // A fixed contact area: a part of the ball's contact area, and elements beside it, whose pressures become negative.
    let fixed: Vec<bool> =
        (0..grid.len()).map(|i| (12..31).contains(&(i % 32)) && (8..24).contains(&(i / 32))).collect();
    for name in [
        "layer",
        "pressure_limit",
        "excluded elements",
        "fixed contact area",
        "period",
        "patches",
        "influence",
        "row_tables",
    ] {
        let mut scene = plain.clone();
        let mut options = Options::default();
        match name {
            "layer" => scene.layer = Some(Layer(Each::Uniform(1e-6))),
            "pressure_limit" => scene.pressure_limit = Some(PressureLimit(Each::Uniform(600.0))),
            "excluded elements" => scene.undeformed_distance = &holes,
            "fixed contact area" => options.active_set = ActiveSet::Fixed,
            "period" => scene.period = Some(Period { x: true, y: false }),
            "patches" => scene.patches = Some(Patches { count: 1, patch: &patch, factors: &[1.0] }),
            "influence" => scene.influence = Some(Table::new(32, 32, &table, &grid).unwrap()),
            _ => scene.row_tables = Some(RowTables::new(32, 32, &row_tables, &grid).unwrap()),
        }
        if ["period", "patches", "influence", "row_tables"].contains(&name) {
            let Err(Error::Unsupported(message)) = solve(&scene, &Options::default()) else { panic!("{name}") };
            assert!(message.contains(name) && message.contains("friction"), "{message}");
            continue;
        }
        let mut solver = Solver::new(&scene, &options).unwrap();
        let nothing = vec![0.0; grid.len()];
        let guess = (options.active_set == ActiveSet::Fixed).then_some(Guess { pressure: &nothing, contact: &fixed });
        let (stop, report) = solver.solve(&scene, &options, guess, None).unwrap();
        assert_eq!(stop, Outcome::Converged, "{name}");
        // `residual` has 1/G = 1, so that tractions and pressures are scaled. The factor is a power of two, which is exact.
        let mut solution = solver.friction().unwrap().clone();
        solution.traction.iter_mut().flatten().for_each(|q| *q *= compliance);
        let pressures: Vec<f64> = solver.state().p.iter().map(|p| p.max(0.0) * compliance).collect();
        let conditions = (&report.friction.unwrap(), &solution);
        let slip_residual = residual((&grid, 0.28), &pressures, &pushed(), &vec![[0.0; 2]; grid.len()], conditions);
        assert!(slip_residual <= 1.001e-6, "{name}: {slip_residual}");
        let found = &solver.friction().unwrap().traction;
        let change = found.iter().zip(&alone).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max);
        // Tractions are up to mu times pressures of some 1000, so that a change of 1 is not the solver's tolerance.
        assert!(change > 1.0, "{name}: {change}");
        assert!(name != "fixed contact area" || solver.state().p.iter().any(|p| *p < 0.0), "no element pulls");
    }
}

/// A coating of thickness 0, or of the same material as its body, counts as no coating: it is allowed with friction, tables, a period, and on a
/// handle.
#[test]
fn a_coating_that_is_none_is_beside_everything() {
    let (grid, h) = ball(24, 0.08);
    let bodies = Bodies { shear_modulus: [82000.0, 40000.0], poisson_ratio: [0.28, 0.35] };
    let plain = Scene::new(grid, &h, bodies, Load::Force(1000.0));
    let table: Vec<f64> = (0..4 * grid.len())
        .map(|i| 1e-6 * (-((i % 48) as f64 - 24.0).hypot((i / 48) as f64 - 24.0) / 4.0).exp())
        .collect();
    let scenes = [
        Scene { friction: Some(pushed()), ..plain.clone() },
        Scene { influence: Some(Table::new(24, 24, &table, &grid).unwrap()), ..plain.clone() },
        Scene { period: Some(Period { x: true, y: false }), ..plain.clone() },
        plain,
    ];
    let layer =
        |thickness, shear_modulus, poisson_ratio| Some(CoatingLayer { thickness, shear_modulus, poisson_ratio });
    let none = [
        [layer(0.0, 5.0, 0.3), None],
        [None, layer(1.0, 40000.0, 0.35)],
        [layer(2.0, 82000.0, 0.28), layer(0.0, 1e9, 0.1)],
        [None, None],
    ];
    for scene in &scenes {
        let options = Options::default();
        let mut handle = Solver::new(scene, &options).unwrap();
        let bits = |solver: &Solver| {
            let q = solver.friction().map(|found| found.traction.clone());
            (solver.state().p.clone(), solver.state().u.clone(), q)
        };
        handle.solve(scene, &options, None, None).unwrap();
        let expected = bits(&handle);
        for layers in none {
            let coated = Scene { coating: Some(Coating { layers }), ..scene.clone() };
            let (new, stop, _) = solve(&coated, &options).unwrap();
            assert!(stop == Outcome::Converged && bits(&new) == expected, "{layers:?}");
            handle.solve(&coated, &options, None, None).unwrap();
            assert!(bits(&handle) == expected, "{layers:?}");
        }
        // Invalid coatings are still refused, and so is a coating that has an effect.
        for (layers, word) in [
            ([layer(-1.0, 82000.0, 0.28), None], "thickness"),
            ([layer(0.0, -1.0, 0.28), None], "shear_modulus"),
            ([layer(1.0, 82000.0, 0.28), layer(0.0, 1.0, 0.7)], "poisson_ratio"),
        ] {
            let refused = solve(&Scene { coating: Some(Coating { layers }), ..scene.clone() }, &options).map(|_| ());
            assert!(refused.unwrap_err().to_string().contains(word), "{layers:?}");
        }
        if scene.friction.is_some() {
            let coating = Some(Coating { layers: [layer(0.1, 1e5, 0.28), None] });
            let Err(Error::Unsupported(message)) = solve(&Scene { coating, ..scene.clone() }, &options) else {
                panic!("a coating beside friction")
            };
            assert!(message.contains("coating") && message.contains("friction"), "{message}");
        }
    }
}

#[test]
fn pressures_are_those_without_friction_where_bodies_are_alike() {
    let (grid, h) = ball(32, 0.06);
    let without = Scene::new(grid, &h, STEEL, Load::Force(1000.0));
    let with = Scene { friction: Some(pushed()), ..without.clone() };
    let (a, ..) = solve(&without, &Options::default()).unwrap();
    let (b, ..) = solve(&with, &Options::default()).unwrap();
    assert_eq!(a.state().p, b.state().p);
    assert!(a.friction().is_none());
}

#[test]
fn one_coefficient_is_as_many_alike() {
    let (grid, h) = ball(32, 0.06);
    let each = vec![0.3; grid.len()];
    let found = |coefficient: Coefficient<'_>| {
        let friction = Friction { coefficient, ..pushed() };
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, STEEL, Load::Force(1000.0)) };
        solve(&scene, &Options::default()).unwrap().0.friction().unwrap().traction.clone()
    };
    assert_eq!(found(Coefficient::Uniform(0.3)), found(Coefficient::PerElement(&each)));
    // Where the coefficient is 0, on one half of the grid, there are no tractions, and all elements slip.
    let half: Vec<f64> = (0..grid.len()).map(|i| if i % 32 < 16 { 0.0 } else { 0.3 }).collect();
    let tractions = found(Coefficient::PerElement(&half));
    assert!((0..grid.len()).all(|i| i % 32 >= 16 || tractions[i] == [0.0; 2]));
}

#[test]
fn a_handle_finds_what_a_new_one_finds() {
    let (grid, h) = ball(48, 0.04);
    let scene = |force: f64, friction| Scene { friction, ..Scene::new(grid, &h, STEEL, Load::Force(force)) };
    let mut solver = Solver::new(&scene(1.0, None), &Options::default()).unwrap();
    for (force, friction) in
        [(1000.0, Some(pushed())), (300.0, Some(pushed())), (300.0, None), (1000.0, Some(pushed()))]
    {
        solver.solve(&scene(force, friction), &Options::default(), None, None).unwrap();
        let (new, ..) = solve(&scene(force, friction), &Options::default()).unwrap();
        let traction = |solver: &Solver| solver.friction().map(|found| found.traction.clone());
        assert_eq!(traction(&solver), traction(&new), "{force}");
    }
}

#[test]
fn the_precisions_agree() {
    use contact_normal::solver::Precision;
    let (grid, h) = ball(64, 0.03);
    let scene = Scene { friction: Some(pushed()), ..Scene::new(grid, &h, STEEL, Load::Force(1000.0)) };
    let found = |precision| {
        let options = Options { precision, tolerance: 1e-9, ..Options::default() };
        let (solver, stop, report) = solve(&scene, &options).unwrap();
        assert_eq!(stop, Outcome::Converged);
        assert!(report.friction.unwrap().certificate.residual <= 1e-9);
        solver.friction().unwrap().traction.clone()
    };
    let (double, mixed) = (found(Precision::Double), found(Precision::Mixed));
    let apart = double.iter().zip(&mixed).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max);
    // A residual of 1e-9 in the displacements is an error of some 1e-6 in short-wave tractions, of which the largest are 300.
    assert!(apart <= 1e-3, "{apart}");
}

/// If the normal problem is stopped early, its pressures may carry less than the given tangential force, although those of the solved problem carry
/// it. The library must not refuse the force then.
#[test]
fn a_stop_of_the_normal_problem_is_not_a_force_that_is_too_large() {
    let (grid, h) = ball(32, 0.06);
    let friction = Friction { prescribed: [Prescribed::Force(300.0), Prescribed::Creepage(0.0)], ..Friction::new(0.5) };
    let plain = Scene { friction: Some(friction), ..Scene::new(grid, &h, STEEL, Load::Approach(0.02)) };
    let (solved, stop, report) = solve(&plain, &Options::default()).unwrap();
    assert!(stop == Outcome::Converged && 0.5 * report.measures.force > 300.0);
    let mut too_little = 0;
    for last in 1..=6 {
        let mut told = 0;
        let mut watch = |_: &Progress| {
            told += 1;
            told >= last
        };
        let mut solver = Solver::new(&plain, &Options::default()).unwrap();
        let (stop, report) = solver.solve(&plain, &Options::default(), None, Some(&mut watch)).unwrap();
        assert_eq!(stop, Outcome::Cancelled);
        too_little += usize::from(0.5 * report.measures.force <= 300.0);
        let found = solver.friction().unwrap();
        let admissible = found.traction.iter().zip(&solver.state().p).all(|(q, p)| q[0].hypot(q[1]) <= 0.5 * p);
        assert!(admissible && solver.state().p != solved.state().p, "{last}");
    }
    assert!(too_little > 0);
}
