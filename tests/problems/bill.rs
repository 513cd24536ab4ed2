//! The bill of effects tells how much each effect of a scene changes a quantity. Its changes are compared with solves on the whole grid, with and
//! without each effect. Also tested: its verdicts, and the effects that it leaves out.

use contact_normal::adhesion::{Law, Start};
use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{
    Adhesion, Bodies, Coating, Coefficient, Each, Fall, Friction, FrictionLaw, Layer, Load, Motion, Patches, Period,
    PlasticLayer, Prescribed, PressureLimit, Scene, Work,
};
use contact_normal::solver::{
    effects_bill, quantities, solve, BillOptions, BillRow, Neglected, Omission, Options, Outcome, Quantity, Verdict,
};

use crate::families::case::distance;
use crate::random::Random;

const M: usize = 64;
pub const WANTED: [Quantity; 3] = [Quantity::Force, Quantity::MaxPressure, Quantity::ContactArea];

fn grid() -> Grid {
    Grid::new(M, M, 0.05, 0.05).expect("a grid")
}

pub fn ball() -> Vec<f64> {
    distance(&grid(), |x, y| (x * x + y * y) / 100.0)
}

pub fn plain(h: &[f64]) -> Scene<'_> {
    Scene::new(grid(), h, Bodies { shear_modulus: [8e4, 3e4], poisson_ratio: [0.28, 0.35] }, Load::Approach(0.02))
}

pub fn bill(scene: &Scene<'_>, target: f64, wanted: &[Quantity]) -> Vec<BillRow> {
    // With this much time the bill's choice of grids does not depend on the machine.
    let asked = BillOptions { max_seconds: 1e3, ..BillOptions::new(target) };
    let (stop, rows) = effects_bill(scene, &Options::default(), &asked, wanted, None).expect("a bill");
    assert_eq!(stop, Outcome::Converged);
    rows
}

/// The values of the quantities on the whole grid.
fn solved(scene: &Scene<'_>, wanted: &[Quantity]) -> Vec<f64> {
    let options = Options { tolerance: 1e-9, ..Options::default() };
    let (_, rows) = quantities(scene, &options, wanted, 0, None).expect("a solvable scene");
    rows.iter().map(|row| row.value.unwrap_or(0.0)).collect()
}

/// A scene with one of the combinations of effects, each of random size.
fn with_effects<'a>(h: &'a [f64], patch: &'a [i32], random: &mut Random) -> Scene<'a> {
    let mut scene = plain(h);
    let size = 10f64.powf(-3.0 + 4.0 * random.uniform());
    match (random.uniform() * 4.0) as usize {
        0 => scene.layer = Some(Layer(Each::Uniform(1e-7 * size))),
        1 => scene.coating = Some(Coating::of_body_1(0.05 * size.min(1.0), 2e5, 0.25)),
        2 => scene.pressure_limit = Some(PressureLimit(Each::Uniform(300.0 + 3000.0 * random.uniform()))),
        _ => {
            scene.patches = Some(Patches { count: 2, patch, factors: &[1.0, 0.9, 0.9, 1.0] });
        }
    }
    if scene.patches.is_none() && scene.coating.is_none() {
        let prescribed = [Prescribed::Creepage(-1e-3), Prescribed::Creepage(0.0)];
        let motion = if random.uniform() < 0.5 { Motion::Shift } else { Motion::SteadyRolling };
        let compliance = Coefficient::Uniform(1e-7 * size);
        scene.friction = Some(Friction { prescribed, motion, spin: 1e-4 * size, compliance, ..Friction::new(0.3) });
    }
    scene
}

#[test]
fn changes_and_verdicts_are_those_of_the_whole_grid() {
    let h = ball();
    let patch: Vec<i32> = (0..M * M).map(|i| i32::from(i % M >= M / 2)).collect();
    let mut decided = 0;
    for seed in 0..8 {
        let scene = with_effects(&h, &patch, &mut Random::new(seed));
        let mut wanted = WANTED.to_vec();
        if scene.friction.is_some() {
            wanted.push(Quantity::TangentialForce);
        }
        let before = solved(&scene, &wanted);
        for row in bill(&scene, 1e-2, &wanted) {
            let left = [Some(row.omission), row.other].into_iter().flatten();
            let without = left.fold(scene.clone(), |scene, one| one.leave_out(&scene));
            let q = wanted.iter().position(|quantity| *quantity == row.quantity).expect("asked for");
            let change = solved(&without, &wanted)[q] - before[q];
            let (value, found) = (row.value.expect("a value"), row.change.expect("a change"));
            // Here the bill's last grid is the whole grid. The differences are due to tolerances, which are at most a hundredth of the target.
            let allowed = 2e-4 * before[q].abs();
            assert!((found - change).abs() <= allowed, "{seed} {row:?}: {change:e}");
            assert!((value - before[q]).abs() <= allowed, "{seed} {row:?}");
            match row.verdict {
                Verdict::Negligible => assert!(change.abs() <= 1e-2 * value.abs(), "{seed} {row:?}"),
                Verdict::Needed => assert!(change.abs() > 1e-2 * value.abs(), "{seed} {row:?}"),
                Verdict::NotDecided => continue,
            }
            decided += 1;
        }
    }
    assert!(decided > 40, "{decided}");
}

/// With the default time limit, the bill of a large scene is computed on much smaller grids.
#[test]
fn small_grids_tell_of_the_whole_one() {
    let m = 256;
    let grid = Grid::new(m, m, 0.0125, 0.0125).expect("a grid");
    let at = |k: usize| (k as f64 - 0.5 * (m as f64 - 1.0)) * 0.0125;
    let h: Vec<f64> = (0..m * m).map(|i| (at(i % m).powi(2) + at(i / m).powi(2)) / 100.0).collect();
    let scene = Scene { layer: Some(Layer(Each::Uniform(2e-7))), grid, ..plain(&h) };
    let (stop, rows) =
        effects_bill(&scene, &Options::default(), &BillOptions::new(1e-3), &WANTED, None).expect("a bill");
    assert_eq!((stop, rows.len()), (Outcome::Converged, 3));
    let (with, without) = (solved(&scene, &WANTED), solved(&Omission::Layer.leave_out(&scene), &WANTED));
    for (q, row) in rows.iter().enumerate() {
        let (change, error) = (row.change.expect("a change"), row.error.expect("an error"));
        let truth = without[q] - with[q];
        // The solves on the whole grid have a residual of 1e-9, hence the 1e-6.
        assert!((change - truth).abs() <= 1.5 * error + 1e-6 * with[q].abs(), "{row:?}: {truth:e}");
        assert!(row.seconds[0] > 0.0 && row.bytes[0] > 1e6, "{row:?}");
    }
}

#[test]
fn like_bodies_in_the_place_of_unlike_ones_have_their_compliances() {
    let h = ball();
    let scene = Scene { friction: Some(Friction::new(0.3)), ..plain(&h) };
    let left = Omission::Coupling.leave_out(&scene);
    let of = |bodies: &Bodies, f: fn(f64) -> f64| -> f64 {
        (0..2).map(|b| f(bodies.poisson_ratio[b]) / bodies.shear_modulus[b]).sum()
    };
    for f in [|nu: f64| 1.0 - nu, |_| 1.0, |nu: f64| nu] {
        let (before, after) = (of(&scene.bodies, f), of(&left.bodies, f));
        assert!((after / before - 1.0).abs() < 1e-14, "{before:e} {after:e}");
    }
    let couples = |nu: f64| 1.0 - 2.0 * nu;
    let [a, b] = [0, 1].map(|b| couples(left.bodies.poisson_ratio[b]) / left.bodies.shear_modulus[b]);
    assert_eq!(a, b);
}

#[test]
fn a_thin_coating_is_a_layer() {
    let h = ball();
    // A coating that is a hundredth of an element thick, and so soft that it has an effect.
    let scene = Scene { coating: Some(Coating::of_body_1(5e-4, 40.0, 0.3)), ..plain(&h) };
    let rows = bill(&scene, 1e-2, &WANTED);
    let verdicts = |omission: Omission| -> Vec<Verdict> {
        rows.iter().filter(|row| row.omission == omission).map(|row| row.verdict).collect()
    };
    assert!(verdicts(Omission::Coating).contains(&Verdict::Needed), "{rows:#?}");
    assert_eq!(verdicts(Omission::CoatingAsLayer), vec![Verdict::Negligible; 3], "{rows:#?}");
    // Two rows replace the same coating, so that they are not listed as a pair of effects.
    assert!(rows.iter().all(|row| row.other.is_none()));
}

#[test]
fn a_plain_scene_has_no_bill() {
    let h = ball();
    assert!(bill(&plain(&h), 1e-2, &WANTED).is_empty());
    let neglected = Neglected::of(&plain(&h), &Options::default(), 1e-2, None).expect("nothing");
    assert_eq!(neglected, Neglected::default());
}

#[test]
fn what_has_no_bill_is_refused_by_name() {
    let h = ball();
    let scene = plain(&h);
    for (target, seconds, name) in [(0.0, 0.0, "target"), (1.0, 0.0, "target"), (0.1, f64::NAN, "max_seconds")] {
        let asked = BillOptions { max_seconds: seconds, ..BillOptions::new(target) };
        let refused = effects_bill(&scene, &Options::default(), &asked, &WANTED, None);
        let message = refused.expect_err("refused").to_string();
        assert!(message.contains(name), "{message}");
    }
    let table = contact_normal::influence::Table::new(M, M, &vec![1.0; 4 * M * M], &grid()).expect("a table");
    let own = Scene { influence: Some(table), ..plain(&h) };
    let refused = effects_bill(&own, &Options::default(), &BillOptions::new(0.1), &WANTED, None);
    assert!(matches!(refused, Err(Error::Unsupported(message)) if message.contains("influence")));
}

/// The effects that are left out change no quantity by more than the target, on the whole grid. In half of the scenes at least one effect is left
/// out.
#[test]
fn what_is_neglected_changes_less_than_the_target() {
    let h = ball();
    let patch: Vec<i32> = (0..M * M).map(|i| i32::from(i % M >= M / 2)).collect();
    let target = 1e-2;
    let mut left_out = 0;
    for seed in 100..124 {
        let scene = with_effects(&h, &patch, &mut Random::new(seed));
        let neglected = Neglected::of(&scene, &Options::default(), target, None).expect("a scene");
        assert!(neglected.error <= target, "{seed} {neglected:?}");
        assert!(!neglected.omissions.contains(&Omission::Friction));
        left_out += usize::from(!neglected.omissions.is_empty());
        let (with, without) = (solved(&scene, &WANTED), solved(&neglected.leave_out(&scene), &WANTED));
        for (a, b) in with.iter().zip(&without) {
            assert!((a - b).abs() <= target * a.abs(), "{seed} {neglected:?}: {a} {b}");
        }
        if neglected.omissions.is_empty() {
            assert_eq!(with, without);
        }
    }
    assert!(left_out >= 6, "{left_out}");
}

/// The peak of a cone grows with the number of elements, so that pressures on small grids do not reach a limit that those on the whole grid reach.
/// The bill must not call this limit negligible.
#[test]
fn a_pressure_limit_stays() {
    let h: Vec<f64> = ball().iter().map(|h| h.sqrt()).collect();
    let (.., report) = solve(&plain(&h), &Options::default()).expect("a solvable scene");
    let peak = report.measures.max_pressure;
    for limit in [0.95 * peak, 2.0 * peak] {
        let scene = Scene { pressure_limit: Some(PressureLimit(Each::Uniform(limit))), ..plain(&h) };
        let neglected = Neglected::of(&scene, &Options::default(), 0.1, None).expect("a scene");
        assert_eq!(neglected, Neglected::default(), "{limit} beside {peak}");
    }
}

#[test]
fn a_period_that_does_not_matter_is_negligible() {
    // The contact is a hundredth of the grid's length in each direction, so that the images of a period hardly matter.
    let h: Vec<f64> = ball().iter().map(|h| 400.0 * h).collect();
    let scene = Scene { period: Some(Period { x: false, y: true }), ..plain(&h) };
    let verdicts =
        |scene: &Scene<'_>| -> Vec<Verdict> { bill(scene, 0.2, &WANTED).iter().map(|row| row.verdict).collect() };
    assert!(!verdicts(&scene).contains(&Verdict::Needed));
    let near = ball();
    let scene = Scene { period: Some(Period { x: true, y: true }), load: Load::Approach(0.012), ..plain(&near) };
    let (stop, rows) =
        effects_bill(&scene, &Options::default(), &BillOptions::new(1e-2), &[Quantity::Force], None).expect("a bill");
    assert_eq!((stop, rows[0].verdict), (Outcome::Converged, Verdict::Needed), "{rows:?}");
}

/// A friction law and a plastic layer have rows of their own. The law is needed where slips are fast, the layer where tractions exceed the yield
/// limit. Their changes are those of the whole grid.
#[test]
fn laws_of_friction_and_layers_that_yield_are_in_the_bill() {
    let h = ball();
    let scene = |half_speed: f64, yield_limit: f64| {
        let law = FrictionLaw::new(Fall::Rational, (0.5, 0.5), half_speed, 1.0);
        let friction = Friction {
            motion: Motion::SteadyRolling,
            prescribed: [Prescribed::Creepage(-1e-2), Prescribed::Creepage(0.0)],
            law: Some(law),
            layer: Some(PlasticLayer { yield_limit, hardening: 0.0 }),
            ..Friction::new(0.3)
        };
        let bodies = Bodies::same(8e4, 0.28);
        Scene { friction: Some(friction), bodies, ..plain(&h) }
    };
    let wanted = [Quantity::TangentialForce];
    let of = |rows: &[BillRow], omission: Omission| {
        *rows.iter().find(|row| row.omission == omission && row.other.is_none()).expect("a row")
    };
    // Slip velocities are about 1e-2, pressures about 1000.
    for (half_speed, yield_limit, verdicts) in
        [(1e-2, 1e9, [Verdict::Needed, Verdict::Negligible]), (1e5, 100.0, [Verdict::Negligible, Verdict::Needed])]
    {
        let scene = scene(half_speed, yield_limit);
        let (rows, before) = (bill(&scene, 1e-2, &wanted), solved(&scene, &wanted)[0]);
        for (omission, verdict) in [Omission::FrictionLaw, Omission::FrictionLayer].into_iter().zip(verdicts) {
            let row = of(&rows, omission);
            assert_eq!(row.verdict, verdict, "{row:?}");
            let change = solved(&omission.leave_out(&scene), &wanted)[0] - before;
            // The bill's tolerance is a hundredth of its target, here 2e-4.
            assert!((row.change.expect("a change") - change).abs() <= 2e-4 * before.abs(), "{row:?} {change:e}");
        }
        let pair = |row: &&BillRow| (row.omission, row.other) == (Omission::FrictionLaw, Some(Omission::FrictionLayer));
        assert!(rows.iter().any(|row| pair(&row)), "both are a pair");
        assert!(rows.iter().all(|row| row.omission != Omission::Friction || row.other != Some(Omission::FrictionLaw)));
    }
}

/// E* is 65000. With a work of adhesion of 1 the pull-off force is 1.5 pi w R = 236, beside a load of 1100. A work of 1e-7 has an effect below 1 %.
#[test]
fn adhesion_is_needed_where_it_is_strong() {
    let h = ball();
    let sticky = |work: f64, range: f64| Scene {
        adhesion: Some(Adhesion {
            law: Law::Exponential,
            work: Work::Uniform(work),
            range,
            start: Start::Auto,
            stiffness: false,
            stability: false,
            shear_strength: 0.0,
        }),
        ..plain(&h)
    };
    let strong = bill(&sticky(1.0, 0.005), 1e-2, &WANTED);
    assert!(
        strong.iter().any(|row| row.omission == Omission::Adhesion && row.verdict == Verdict::Needed),
        "{strong:?}"
    );
    let change = strong[0].change.expect("a change") / strong[0].value.expect("a force");
    assert!(change > 0.05, "without attraction the force of an approach is larger: {change}");
    let weak = bill(&sticky(1e-7, 0.005), 1e-2, &WANTED);
    assert!(weak.iter().all(|row| row.verdict == Verdict::Negligible), "{weak:?}");
    // A solve with adhesion has another type of result, so that adhesion is never left out.
    let neglected = Neglected::of(&sticky(1e-7, 0.005), &Options::default(), 1e-2, None).expect("a scene");
    assert!(neglected.omissions.is_empty());
    let refused = effects_bill(&sticky(1.0, 0.0), &Options::default(), &BillOptions::new(0.1), &WANTED, None);
    assert!(matches!(refused, Err(Error::Unsupported(message)) if message.contains("range 0")));
}
