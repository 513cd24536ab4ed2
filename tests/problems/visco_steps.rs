//! Steps in time of bodies that relax. The contact conditions hold with displacements that the test integrates itself, together with other effects,
//! and on handles.

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::influence::Table;
use contact_normal::scene::{
    Adhesion, Bodies, Branches, Coating, CoatingLayer, Each, Friction, Layer, Load, Patches, Period, PressureLimit,
    Scene, Visco, Work,
};
use contact_normal::solver::{
    effects_bill, solve, solve_to_accuracy, Accuracy, ActiveSet, BillOptions, Guess, Method, Options, Outcome, Problem,
    Quantity, Solver,
};
use contact_normal::visco::Form;

use crate::dashpots::{assert_path, MX, MY, SIDE};
use crate::visco::{G, MODULI, TIMES};

/// Two bodies that relax in different ways; the second one is a fluid.
const BODIES: Bodies = Bodies { shear_modulus: [G, 5.0], poisson_ratio: [0.5, 0.3] };
const FLUID: Branches<'_> = Branches { modulus: &[2.0, 3.0], time: &[0.2, 6.0] };
const SOLID: Branches<'_> = Branches { modulus: &MODULI, time: &TIMES };

fn grid() -> Grid {
    Grid::new(MX, MY, SIDE, SIDE).unwrap()
}

fn ball() -> Vec<f64> {
    let place = |i: usize| ((i % MX) as f64 - 8.2, (i / MX) as f64 - 6.4);
    (0..MX * MY).map(|i| 0.5 * place(i).0.hypot(place(i).1).powi(2) * SIDE * SIDE).collect()
}

/// Durations and loads of steps: pressing, holding, a smaller force, a jump, lift-off, and contact again.
const PATH: [(f64, Load); 9] = [
    (0.3, Load::Approach(0.04)),
    (0.5, Load::Approach(0.04)),
    (0.2, Load::Force(0.25)),
    (0.7, Load::Force(0.1)),
    (0.0, Load::Approach(0.09)),
    (0.4, Load::Approach(0.03)),
    (0.1, Load::Approach(-0.01)),
    (1.0, Load::Approach(0.02)),
    (1.5, Load::Force(0.02)),
];

/// The share of each body in the instantaneous compliance.
fn shares(bodies: &Bodies) -> [f64; 2] {
    let of = |b: usize| (1.0 - bodies.poisson_ratio[b]) / bodies.shear_modulus[b];
    [of(0) / (of(0) + of(1)), of(1) / (of(0) + of(1))]
}

fn relaxing<'a>(h: &'a [f64], bodies: [Branches<'a>; 2]) -> Scene<'a> {
    let visco = Some(Visco { bodies, ..Visco::default() });
    Scene { visco, ..Scene::new(grid(), h, BODIES, Load::Approach(0.0)) }
}

#[test]
fn steps_of_two_bodies_meet_the_conditions_by_every_method_and_form() {
    let h = ball();
    for method in [Method::Auto, Method::Norm, Method::ProjectedCg, Method::Multigrid, Method::FullMultigrid] {
        let options = Options { method, ..Options::default() };
        assert_path("two bodies", &relaxing(&h, [SOLID, FLUID]), shares(&BODIES), &PATH, &options);
    }
    for form in [Form::Relaxation, Form::Creep, Form::BackwardEuler] {
        for bodies in [[SOLID, FLUID], [Branches::default(), SOLID], [FLUID, Branches::default()]] {
            let scene = relaxing(&h, bodies);
            let scene = Scene { visco: scene.visco.map(|visco| Visco { form: Some(form), ..visco }), ..scene };
            // The second body has a modulus of 5, but the branches of the first one add up to 7, so that it needs a larger modulus here.
            let of = Bodies { shear_modulus: [G, 7.5], ..BODIES };
            let scene = Scene { bodies: of, ..scene };
            assert_path(&format!("{form:?}"), &scene, shares(&of), &PATH, &Options::default());
        }
    }
}

#[test]
fn beside_other_effects_steps_meet_the_conditions() {
    let (h, mut hole) = (ball(), ball());
    hole[6 * MX + 9] = f64::INFINITY;
    let patch: Vec<i32> = (0..h.len()).map(|i| i32::from(i % MX > 8)).collect();
    let plain = relaxing(&h, [SOLID, FLUID]);
    let by_force = PATH.map(|(dt, load)| (dt, if let Load::Force(_) = load { load } else { Load::Force(0.15) }));
    let both = shares(&BODIES);
    let patches = Some(Patches { count: 2, patch: &patch, factors: &[1.0, 0.2, 0.2, 1.0] });
    let options = Options::default();
    assert_path("hole", &Scene { undeformed_distance: &hole, ..plain.clone() }, both, &PATH, &options);
    assert_path("patches", &Scene { patches, ..plain.clone() }, both, &PATH, &options);
    let pressure_limit = Some(PressureLimit(Each::Uniform(0.9)));
    assert_path("limit", &Scene { pressure_limit, ..plain.clone() }, both, &PATH, &options);
    for (x, y) in [(true, false), (true, true)] {
        let period = Some(Period { x, y });
        assert_path("period", &Scene { period, ..plain.clone() }, both, &by_force, &options);
    }
    // A caller's table, 1.3 times the coefficients of the second body. It stands for both bodies together, and relaxes as the second one.
    let alone = Bodies { shear_modulus: [f64::INFINITY, G], ..BODIES };
    let kernel = Scene::new(grid(), &h, alone, Load::Approach(0.0)).coefficients().unwrap();
    let entry = |i: usize| kernel.at((i % (2 * MX)) as i64 - MX as i64, (i / (2 * MX)) as i64 - MY as i64);
    let table: Vec<f64> = (0..4 * MX * MY).map(|i| 1.3 * entry(i)).collect();
    let influence = Some(Table::new(MX, MY, &table, &grid()).unwrap());
    let own = Scene { influence, bodies: alone, ..relaxing(&h, [Branches::default(), SOLID]) };
    assert_path("influence", &own, [0.0, 1.0], &PATH, &options);
    // Layers that relax on rigid bodies: one pressed by a rigid body, one with two periods, and two like ones.
    let rigid = Bodies { shear_modulus: [f64::INFINITY; 2], ..BODIES };
    let layer = Some(CoatingLayer { thickness: 0.3, shear_modulus: G, poisson_ratio: 0.45 });
    for (layers, period, shares) in [
        ([None, layer], None, [0.0, 1.0]),
        ([None, layer], Some(Period { x: true, y: true }), [0.0, 1.0]),
        ([layer; 2], None, [0.5; 2]),
    ] {
        let relax = if layers[0].is_some() { [SOLID; 2] } else { [Branches::default(), SOLID] };
        let scene = Scene { coating: Some(Coating { layers }), bodies: rigid, period, ..relaxing(&h, relax) };
        assert_path("coating", &scene, shares, if period.is_some() { &by_force } else { &PATH }, &options);
    }
}

/// Moduli `f G` and times as a host may compute them, so that the quotients by G, and the times, differ in their last bits. The bodies must count as
/// alike. A step of no duration is the elastic solve, to the last bit.
#[test]
fn bodies_of_one_series_are_alike_whatever_their_moduli() {
    let h = ball();
    let (mut beside_tables, options) = (0, Options { tolerance: 1e-6, ..Options::default() });
    for k in 0..60 {
        let moduli = [34.31 * 1.37f64.powi(k), 710.22 / 1.13f64.powi(k)];
        let bodies = Bodies { shear_modulus: moduli, ..BODIES };
        let series = moduli.map(|g| [0.01, 0.91, 0.06].map(|part| part * g));
        let times = [[0.3, 2.0, 0.007], [0.1 * 3.0, 2.0, 0.07 * 0.1]];
        let branches = [0, 1].map(|b| Branches { modulus: &series[b], time: &times[b] });
        let elastic = Scene {
            bodies,
            load: Load::Force(0.02 * moduli[0]),
            ..Scene::new(grid(), &h, BODIES, Load::Approach(0.0))
        };
        let mut table = vec![0.0; 4 * MX * MY];
        let kernel = elastic.coefficients().unwrap();
        for (i, entry) in table.iter_mut().enumerate() {
            *entry = kernel.at((i % (2 * MX)) as i64 - MX as i64, (i / (2 * MX)) as i64 - MY as i64);
        }
        let influence = Some(Table::new(MX, MY, &table, &grid()).unwrap());
        let after = |time_step: f64| Some(Visco { bodies: branches, time_step, ..Visco::default() });
        let (_, outcome, _) = solve(&Scene { influence, visco: after(1.0), ..elastic.clone() }, &options).unwrap();
        beside_tables += usize::from(outcome == Outcome::Converged);
        // The same with bodies that do not relax alike.
        let other = [branches[0], Branches { modulus: &series[1][..2], time: &times[1][..2] }];
        let jump = Some(Visco { bodies: other, ..Visco::default() });
        let found = [elastic.clone(), Scene { visco: jump, ..elastic }].map(|scene| solve(&scene, &options).unwrap().0);
        let [elastic, jump] = found.each_ref().map(|solver| (&solver.state().p, solver.state().approach));
        assert!(elastic == jump, "{moduli:?}");
    }
    assert_eq!(beside_tables, 60);
}

#[test]
fn on_a_given_contact_area_steps_relax_as_the_body_does() {
    let h = ball();
    let bodies = Bodies { shear_modulus: [f64::INFINITY, G], ..BODIES };
    let plain = Scene { bodies, ..relaxing(&h, [Branches::default(), SOLID]) };
    let inside: Vec<bool> = h.iter().map(|h| *h < 0.03).collect();
    let options = Options { active_set: ActiveSet::Fixed, tolerance: 1e-10, ..Options::default() };
    let guess = Some(Guess { pressure: &h, contact: &inside });
    let mut solver = Solver::new(&plain, &options).unwrap();
    let mut forces = Vec::new();
    for (dt, continues) in [(0.0, false), (0.5, true)] {
        let visco = plain.visco.map(|visco| Visco { time_step: dt, continues, ..visco });
        let scene = Scene { visco, load: Load::Approach(0.05), ..plain.clone() };
        let (stop, report) = solver.solve(&scene, &options, guess, None).unwrap();
        assert_eq!(stop, Outcome::Converged);
        forces.push(report.measures.force);
    }
    let left = 1.0 - (0..2).map(|k| MODULI[k] / G * (1.0 - (-0.5 / TIMES[k]).exp())).sum::<f64>();
    assert!((forces[1] / forces[0] / left - 1.0).abs() <= 1e-9, "{forces:?}");
}

#[test]
fn a_jump_from_rest_and_bodies_without_branches_have_the_bits_of_the_plain_scene() {
    let h = ball();
    for load in [Load::Approach(0.06), Load::Force(0.2)] {
        let plain = Scene::new(grid(), &h, BODIES, load);
        let (without, _, report) = solve(&plain, &Options::default()).unwrap();
        for bodies in [[SOLID, FLUID], [Branches::default(); 2]] {
            let scene = Scene { load, ..relaxing(&h, bodies) };
            let (with, _, found) = solve(&scene, &Options::default()).unwrap();
            assert_eq!((&with.state().p, &with.state().u), (&without.state().p, &without.state().u));
            assert_eq!(found.measures.approach, report.measures.approach);
            assert_eq!(found.visco.is_some(), !bodies[0].modulus.is_empty(), "nothing is told of what is not there");
        }
    }
}

#[test]
fn a_handle_goes_on_begins_anew_and_keeps_what_it_remembers_where_a_step_is_refused() {
    let (h, options) = (ball(), Options::default());
    let step = |dt: f64, continues: bool, load: Load| {
        let scene = relaxing(&h, [SOLID, FLUID]);
        Scene { visco: scene.visco.map(|visco| Visco { time_step: dt, continues, ..visco }), load, ..scene }
    };
    let mut solver = Solver::new(&step(0.0, false, Load::Approach(0.0)), &options).unwrap();
    let refused = solver.solve(&step(0.1, true, Load::Approach(0.05)), &options, None, None).unwrap_err();
    assert!(refused.to_string().contains("visco continues"), "{refused}");
    let mut twice = Vec::new();
    for round in 0..2 {
        solver.solve(&step(0.2, false, Load::Approach(0.05)), &options, None, None).unwrap();
        if round == 1 {
            // A scene without a surface, in which no pressures carry a force, is refused.
            let hole = vec![f64::INFINITY; h.len()];
            let nothing = Scene { undeformed_distance: &hole, ..step(0.3, true, Load::Force(1.0)) };
            solver.solve(&nothing, &options, None, None).unwrap_err();
            let units = Scene { load: Load::Approach(1e200), ..step(0.3, true, Load::Force(1.0)) };
            solver.solve(&units, &options, None, None).unwrap_err();
        }
        let (_, report) = solver.solve(&step(0.4, true, Load::Force(0.1)), &options, None, None).unwrap();
        assert!((report.visco.unwrap().time - 0.6).abs() <= 1e-15);
        twice.push((solver.state().p.clone(), solver.state().u.clone()));
    }
    assert!(twice[0] == twice[1], "a step that begins at rest remembers nothing, and refusals change nothing");
    let other = Visco { bodies: [SOLID, SOLID], ..Visco::default() };
    let scene = Scene { visco: Some(other), bodies: BODIES, ..step(0.1, true, Load::Approach(0.05)) };
    let refused = solver.solve(&scene, &options, None, None).unwrap_err().to_string();
    assert!(refused.contains("visco->modulus[1]"), "{refused}");
    let without = Scene { visco: None, ..step(0.0, false, Load::Approach(0.05)) };
    let refused = solver.solve(&without, &options, None, None).unwrap_err().to_string();
    assert!(refused.contains("visco is not given"), "{refused}");
    let problems = [Problem { scene: step(0.1, true, Load::Approach(0.05)), guess: None }];
    let found = solver.solve_batch(&problems, &options, |_, found, _| found.map(drop)).unwrap();
    assert!(matches!(&found[0], Err(Error::InvalidArgument(text)) if text.contains("visco->continues")), "{found:?}");
}

/// At the end of a step the force grows with the approach by the reported stiffness.
#[test]
fn the_stiffness_is_that_of_the_step() {
    let (h, options) = (ball(), Options { tolerance: 1e-11, ..Options::default() });
    let force = |last: f64| {
        let plain = relaxing(&h, [SOLID, FLUID]);
        let mut solver = Solver::new(&plain, &options).unwrap();
        for (k, approach) in [0.04, last].into_iter().enumerate() {
            let visco = plain.visco.map(|visco| Visco { time_step: 0.3, continues: k > 0, ..visco });
            let scene = Scene { visco, load: Load::Approach(approach), ..plain.clone() };
            solver.solve(&scene, &options, None, None).unwrap();
        }
        let stiffness = solver.stiffness().unwrap().1.value;
        (solver.state().force(), solver.state().contact.clone(), stiffness)
    };
    let ((f0, c0, stiffness), (f1, c1, _)) = (force(0.06), force(0.060001));
    assert_eq!(c0, c1, "the contact area is the same");
    assert!(((f1 - f0) / 1e-6 / stiffness - 1.0).abs() <= 1e-4, "{} for {stiffness}", (f1 - f0) / 1e-6);
}

#[test]
fn what_is_not_solved_is_refused_by_name() {
    let h = ball();
    let plain = Scene { load: Load::Approach(0.05), ..relaxing(&h, [SOLID, FLUID]) };
    let refusal = |scene: Scene<'_>| solve(&scene, &Options::default()).map(drop).unwrap_err();
    let visco = |change: &dyn Fn(&mut Visco<'_>)| {
        let mut visco = plain.visco.unwrap();
        change(&mut visco);
        refusal(Scene { visco: Some(visco), ..plain.clone() }).to_string()
    };
    const NAN: [f64; 2] = [f64::NAN, 1.0];
    for (message, words) in [
        (visco(&|v| v.time_step = -0.1), "visco->time_step is -0.1"),
        (visco(&|v| v.time_step = f64::INFINITY), "visco->time_step is inf"),
        (visco(&|v| v.bodies[1].time = &[1.0]), "visco->branches[1] is 2 and 1"),
        (visco(&|v| v.bodies[0].time = &[1.0, 0.0]), "visco->time[0] is 0"),
        (visco(&|v| v.bodies[0].modulus = &[-1.0, 0.0]), "visco->modulus[0] is -1"),
        (visco(&|v| v.bodies[0].modulus = &NAN), "visco->modulus[0] is NaN"),
        (visco(&|v| v.bodies[1].modulus = &[2.0, 3.1]), "visco->modulus[1] adds up to 5.1"),
        (
            refusal(Scene { bodies: Bodies { shear_modulus: [f64::INFINITY, 5.0], ..BODIES }, ..plain.clone() })
                .to_string(),
            "rigid body",
        ),
    ] {
        assert!(message.contains(words), "\"{message}\" does not say {words}");
    }
    let table = Table::new(MX, MY, &vec![1.0; 4 * MX * MY], &grid()).unwrap();
    let adhesion = Adhesion {
        law: contact_normal::adhesion::Law::Exponential,
        work: Work::Uniform(1e-3),
        range: 0.01,
        start: contact_normal::adhesion::Start::Auto,
        stiffness: false,
        stability: false,
        shear_strength: 0.0,
    };
    let layer = Some(CoatingLayer { thickness: 0.3, shear_modulus: 5.0, poisson_ratio: 0.4 });
    let coating = |layers| Some(Coating { layers });
    for (scene, words) in [
        (Scene { influence: Some(table), ..plain.clone() }, "visco and influence"),
        (Scene { layer: Some(Layer(Each::Uniform(0.1))), ..plain.clone() }, "visco and layer"),
        (Scene { friction: Some(Friction::new(0.3)), ..plain.clone() }, "visco and friction"),
        (Scene { adhesion: Some(adhesion), ..plain.clone() }, "visco and adhesion"),
        (Scene { coating: coating([None, layer]), ..plain.clone() }, "body 2 below its coating"),
        (
            Scene {
                coating: coating([None, layer]),
                bodies: Bodies { shear_modulus: [G, f64::INFINITY], ..BODIES },
                ..plain.clone()
            },
            "do not relax alike",
        ),
    ] {
        let refused = refusal(scene);
        assert!(matches!(&refused, Error::Unsupported(text) if text.contains(words)), "{words}: {refused}");
    }
    // A step that continues is refused, because its history belongs to one grid.
    let later = Scene { visco: plain.visco.map(|visco| Visco { continues: true, ..visco }), ..plain };
    let bill = effects_bill(&later, &Options::default(), &BillOptions::new(1e-2), &[Quantity::Force], None);
    let accuracy = solve_to_accuracy(&later, &Options::default(), &Accuracy::new(1e-2), None, None);
    for refused in [bill.map(drop).unwrap_err(), accuracy.map(drop).unwrap_err()] {
        assert!(matches!(&refused, Error::Unsupported(text) if text.contains("visco")), "{refused}");
    }
}
