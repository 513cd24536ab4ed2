//! All quantities of a scene: values and estimated errors compared with the closed forms of a ball on a plate, targets and price lists.
//!
//! Ball of radius R, approach d: a^2 = R d, F = 4/3 E* a d, p0 = 2/pi E* a/R, dF/dd = 2 E* a (Johnson 1985, section 4.2). On the axis below a Hertz
//! pressure `sr = st`, and the von Mises stress is `|sz - sr|` (Johnson, eq. 3.45); the largest shear stress is half of it. Under a tangential force
//! Q the ball sticks in a circle of radius `a (1 - Q/(mu F))^(1/3)`, and is shifted by `3 mu F (2 - nu)/(8 G a) (1 - (1 - Q/(mu F))^(2/3))` (Cattaneo
//! 1938, Mindlin 1949; both bodies together).

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{
    Bodies, Coating, Each, Friction, Load, Motion, Period, Prescribed, PressureLimit, Previous, Scene,
};
use contact_normal::solver::{
    cost_of_accuracy, quantities, solve_to_accuracy, Accuracy, Lack, Options, Outcome, Quantity, QuantityRow,
};

use crate::families::case::distance;

const RADIUS: f64 = 50.0;
const APPROACH: f64 = 0.02;
const G: f64 = 8e4;
const NU: f64 = 0.3;
const MU: f64 = 0.3;

fn radius_of_contact() -> f64 {
    (RADIUS * APPROACH).sqrt()
}

fn modulus() -> f64 {
    1.0 / Bodies::same(G, NU).compliance()
}

fn force() -> f64 {
    4.0 / 3.0 * modulus() * radius_of_contact() * APPROACH
}

/// The ball on m x m elements. The contact is about .6 of the grid wide.
fn ball(m: usize) -> (Grid, Vec<f64>) {
    let d = 3.3 * radius_of_contact() / m as f64;
    let grid = Grid::new(m, m, d, d).expect("a grid");
    (grid, distance(&grid, |x, y| (x * x + y * y) / (2.0 * RADIUS)))
}

fn scene<'a>(grid: Grid, h: &'a [f64]) -> Scene<'a> {
    Scene::new(grid, h, Bodies::same(G, NU), Load::Approach(APPROACH))
}

/// Friction with half the tangential force of full slip.
fn shifted() -> Friction<'static> {
    let prescribed = [Prescribed::Force(0.5 * MU * force()), Prescribed::Creepage(0.0)];
    Friction { prescribed, ..Friction::new(MU) }
}

/// The largest von Mises stress on the axis, and its depth, by a search over the closed form.
fn on_the_axis() -> (f64, f64) {
    let (a, p0) = (radius_of_contact(), 2.0 / std::f64::consts::PI * modulus() * radius_of_contact() / RADIUS);
    let at = |z: f64| {
        let ratio = z / a;
        let sr = -(1.0 + NU) * (1.0 - ratio * (1.0 / ratio).atan()) + 0.5 / (1.0 + ratio * ratio);
        let sz = -1.0 / (1.0 + ratio * ratio);
        p0 * (sz - sr).abs()
    };
    let depths = (1..20_000).map(|k| 1e-4 * k as f64 * a);
    depths.map(|z| (at(z), z)).fold((0.0, 0.0), |best, one| if one.0 > best.0 { one } else { best })
}

fn truth(quantity: Quantity) -> f64 {
    let (a, stuck) = (radius_of_contact(), 0.5f64.cbrt());
    let pi = std::f64::consts::PI;
    match quantity {
        Quantity::Force => force(),
        Quantity::MaxPressure => 2.0 / pi * modulus() * a / RADIUS,
        Quantity::ContactArea => pi * a * a,
        Quantity::Stiffness => 2.0 * modulus() * a,
        Quantity::MaxVonMises => on_the_axis().0,
        Quantity::VonMisesDepth => on_the_axis().1,
        Quantity::MaxShear => 0.5 * on_the_axis().0,
        Quantity::StickArea => pi * (a * stuck).powi(2),
        Quantity::Creepage => 3.0 * MU * force() * (2.0 - NU) / (8.0 * G * a) * (1.0 - stuck * stuck),
        _ => unreachable!("no closed form"),
    }
}

const NORMAL: [Quantity; 7] = [
    Quantity::Force,
    Quantity::MaxPressure,
    Quantity::ContactArea,
    Quantity::Stiffness,
    Quantity::MaxVonMises,
    Quantity::VonMisesDepth,
    Quantity::MaxShear,
];
const TANGENTIAL: [Quantity; 2] = [Quantity::StickArea, Quantity::Creepage];

fn rows(scene: &Scene<'_>, wanted: &[Quantity], coarser: usize) -> Vec<QuantityRow> {
    let (stop, rows) = quantities(scene, &Options::default(), wanted, coarser, None).expect("a solvable scene");
    assert_eq!(stop, Outcome::Converged);
    rows
}

/// Asserts that the estimate is at least the true error (from one grid alone, at least a third of it), and at most ten times the true error plus a
/// twentieth of the value. `theory`: the relative error of the closed form. Cattaneo's shift of a ball is an approximation for like bodies of nu > 0,
/// by 2 % at most, because slip is not quite along the force (Munisamy, Hills & Nowell 1994).
fn assert_covered(row: &QuantityRow, theory: f64) {
    let (value, error) = (row.value.expect("a value"), row.error.unwrap_or_else(|| panic!("an error: {row:?}")));
    let off = (value - truth(row.quantity)).abs();
    let known = theory * truth(row.quantity).abs();
    let part = if row.quantity.has_estimate() { 3.0 } else { 1.0 };
    assert!(off <= part * error + known, "{row:?}: off by {off:e}");
    assert!(error <= 10.0 * off + 0.05 * value.abs(), "{row:?}: off by {off:e}");
}

#[test]
fn values_and_errors_of_a_ball_on_a_plate() {
    for m in [48, 64] {
        let (grid, h) = ball(m);
        let found = rows(&scene(grid, &h), &NORMAL, 2);
        assert_eq!(found.len(), 3 * NORMAL.len());
        for (k, row) in found.iter().enumerate() {
            assert_eq!(row.quantity, NORMAL[k % NORMAL.len()]);
            assert_eq!(row.grid.mx, m >> (2 - k / NORMAL.len()));
        }
        for row in &found[2 * NORMAL.len()..] {
            assert_covered(row, 0.0);
        }
        // The coarsest grid has no estimate, because there is no coarser one to compare with.
        assert_eq!((found[3].error, found[3].lack), (None, Some(Lack::OneGrid)));
        let of_friction = Scene { friction: Some(shifted()), ..scene(grid, &h) };
        for row in &rows(&of_friction, &TANGENTIAL, 2)[2 * TANGENTIAL.len()..] {
            assert_covered(row, 0.02);
        }
    }
}

#[test]
fn the_mean_gap_and_the_moment_are_those_of_the_fields() {
    let (grid, h) = ball(32);
    let friction = Friction { motion: Motion::SteadyRolling, spin: 1e-4, spin_centre: [0.2, 0.0], ..Friction::new(MU) };
    let scene = Scene { friction: Some(friction), ..scene(grid, &h) };
    let found = rows(&scene, &[Quantity::MeanGap, Quantity::SpinMoment, Quantity::TangentialForce], 0);
    let (solver, _, _) = contact_normal::solver::solve(&scene, &Options::default()).expect("a solvable scene");
    let (state, q) = (solver.state(), &solver.friction().expect("tractions").traction);
    let n = grid.len() as f64;
    let gap: f64 = (0..grid.len()).map(|i| h[i] - APPROACH + state.u[i]).sum::<f64>() / n;
    let at = |k: usize| (k as f64 - 15.5) * grid.dx;
    let moment = |i: usize| (at(i % 32) - 0.2) * q[i][1] - at(i / 32) * q[i][0];
    let moment: f64 = (0..grid.len()).map(moment).sum::<f64>() * grid.element_area();
    let force = [0, 1].map(|k| q.iter().map(|q| q[k]).sum::<f64>() * grid.element_area());
    for (row, value) in found.iter().zip([gap, moment, force[0].hypot(force[1])]) {
        // Sums of 1024 terms, taken in another order.
        assert!((row.value.expect("a value") - value).abs() <= 1e-10 * value.abs(), "{row:?}: {value:e}");
    }
}

#[test]
fn what_a_scene_does_not_have_is_said() {
    let (grid, h) = ball(16);
    let plain = scene(grid, &h);
    let lack = |scene: &Scene<'_>, quantity: Quantity| {
        let row = rows(scene, &[quantity], 1)[1];
        assert_eq!((row.value, row.error), (None, None), "{row:?}");
        row.lack
    };
    for quantity in [Quantity::TangentialForce, Quantity::Creepage, Quantity::SpinMoment, Quantity::StickArea] {
        assert_eq!(lack(&plain, quantity), Some(Lack::NoFriction));
        let refused =
            cost_of_accuracy(&plain, &Options::default(), &Accuracy::new(0.1), (quantity, &[0.1]), None, None);
        assert!(matches!(refused, Err(Error::InvalidArgument(message)) if message.contains(quantity.name())));
    }
    let given = Scene { friction: Some(Friction::new(MU)), ..scene(grid, &h) };
    assert_eq!(lack(&given, Quantity::Creepage), Some(Lack::Prescribed));
    let coated = Scene { coating: Some(Coating::of_body_1(0.1, 2.0 * G, NU)), ..scene(grid, &h) };
    assert_eq!(lack(&coated, Quantity::MaxVonMises), Some(Lack::Effect));
    let line = Scene { period: Some(Period { x: false, y: true }), ..scene(grid, &h) };
    assert_eq!(lack(&line, Quantity::MaxShear), Some(Lack::Effect));
    let apart = Scene { load: Load::Approach(-1.0), ..scene(grid, &h) };
    assert_eq!(lack(&apart, Quantity::Stiffness), Some(Lack::NoContact));
    assert_eq!(lack(&apart, Quantity::MaxVonMises), Some(Lack::NoContact));
}

#[test]
fn what_belongs_to_one_grid_is_refused_by_name() {
    let (grid, h) = ball(16);
    let kept = Friction { previous: Previous::Kept, ..Friction::new(MU) };
    let refused = quantities(&Scene { friction: Some(kept), ..scene(grid, &h) }, &Options::default(), &[], 1, None);
    assert!(matches!(refused, Err(Error::Unsupported(message)) if message.contains("friction->continues")));
}

/// The tip of a cone has infinite pressures, and infinite stresses below them. Their estimates must be unknown.
#[test]
fn a_singular_stress_has_no_error() {
    let (grid, _) = ball(128);
    let at = |k: usize| (k as f64 - 63.5) * grid.dx;
    let h: Vec<f64> = (0..grid.len()).map(|i| 0.03 * at(i % 128).hypot(at(i / 128))).collect();
    let cone = scene(grid, &h);
    let row = *rows(&cone, &[Quantity::MaxPressure], 3).last().expect("a row");
    assert_eq!((row.error, row.lack), (None, Some(Lack::Singular)), "{row:?}");
}

#[test]
fn accuracies_and_prices_of_every_quantity_are_kept() {
    let (grid, h) = ball(16);
    let scenes = [
        (scene(grid, &h), Quantity::Stiffness, 0.01, 0.0),
        (scene(grid, &h), Quantity::MaxVonMises, 0.02, 0.0),
        (Scene { friction: Some(shifted()), ..scene(grid, &h) }, Quantity::Creepage, 0.02, 0.02),
        (Scene { friction: Some(shifted()), ..scene(grid, &h) }, Quantity::StickArea, 0.05, 0.02),
    ];
    for (scene, quantity, target, theory) in scenes {
        let accuracy = Accuracy::new(0.05).with(quantity, target);
        let surface = |grid: &Grid, h: &mut [f64]| {
            h.copy_from_slice(&ball(grid.mx).1);
            false
        };
        let found = solve_to_accuracy(&scene, &Options::default(), &accuracy, Some(&mut { surface }), None);
        let found = found.expect("a solvable scene");
        assert_eq!(found.stop, Outcome::Converged, "{}", found.reason);
        let grid = *found.solver.expect("a result").grid();
        let (_, h) = ball(grid.mx);
        let fine = Scene { grid, undeformed_distance: &h, ..scene.clone() };
        let value = rows(&fine, &[quantity], 0)[0].value.expect("a value");
        let off = (value / truth(quantity) - 1.0).abs();
        assert!(off <= target + theory, "{quantity:?} on {}: {off:e}", grid.mx);
        let wanted = (quantity, &[10.0 * target, target][..]);
        let limits = Accuracy::new(0.5);
        let (stop, list) = cost_of_accuracy(&scene, &Options::default(), &limits, wanted, Some(&mut { surface }), None)
            .expect("a list");
        assert_eq!(stop, Outcome::Converged);
        for price in &list {
            assert!(
                price.obstacle.is_none() && price.error.is_some_and(|error| error <= price.target + price.tolerance),
                "{quantity:?}: {price:?}"
            );
        }
        assert!(list[0].grid.expect("a grid").mx <= list[1].grid.expect("a grid").mx);
    }
}

/// Half of the contact is at its pressure limit. One grid alone has no estimates then, but several grids have.
#[test]
fn reached_limits_have_errors_from_several_grids() {
    let limited = |grid: Grid, h: &'static [f64]| Scene {
        pressure_limit: Some(PressureLimit(Each::Uniform(0.7 * truth(Quantity::MaxPressure)))),
        ..scene(grid, h)
    };
    let on = |m: usize| -> (Grid, &'static [f64]) {
        let (grid, h) = ball(m);
        (grid, h.leak())
    };
    let (grid, h) = on(512);
    let fine = rows(&limited(grid, h), &[Quantity::Force], 0)[0].value.expect("a force");
    let (grid, h) = on(64);
    let found = rows(&limited(grid, h), &[Quantity::Force, Quantity::ContactArea], 2);
    assert_eq!((found[2].error, found[2].lack), (None, Some(Lack::OneGrid)), "two grids are too few");
    let (value, error) = (found[4].value.expect("a force"), found[4].error.expect("an error"));
    let off = (value - fine).abs();
    assert!(off <= 3.0 * error && error <= 0.05 * value, "{value:e}: off by {off:e}, estimated {error:e}");
    let (grid, h) = on(16);
    let accuracy = Accuracy::new(1e-2);
    let outcome = solve_to_accuracy(&limited(grid, h), &Options::default(), &accuracy, None, None).expect("a scene");
    assert_eq!(outcome.stop, Outcome::Converged, "{}", outcome.reason);
    let off = (outcome.report.measures.force / fine - 1.0).abs();
    assert!(off <= 1e-2, "{off:e}: {}", outcome.reason);
}

/// Forces of steady rolling have errors of first order. Here the last change between grids is fifteen times smaller than the one before, by chance.
/// The estimate is half of the change before. One grid alone has no estimate.
#[test]
fn errors_of_tangential_forces_follow_from_the_grids() {
    let grid = Grid::new(48, 48, 0.1, 0.1).expect("a grid");
    let at = |k: usize| (k as f64 - 23.5) * 0.1;
    let h: Vec<f64> = (0..grid.len()).map(|i| (at(i % 48).powi(2) + at(i / 48).powi(2)) / 200.0).collect();
    let prescribed = [Prescribed::Creepage(-1e-3), Prescribed::Creepage(0.0)];
    let rolling = Friction { prescribed, motion: Motion::SteadyRolling, spin: 1e-4, ..Friction::new(MU) };
    let shift = Friction { motion: Motion::Shift, spin: 0.0, ..rolling };
    let of = |friction: Friction<'static>| {
        let plain = Scene::new(grid, &h, Bodies::same(82000.0, 0.28), Load::Force(3000.0));
        rows(&Scene { friction: Some(friction), ..plain }, &[Quantity::TangentialForce], 2)
    };
    for found in [of(rolling), of(shift)] {
        assert_eq!((found[0].error, found[0].lack), (None, Some(Lack::OneGrid)), "{found:?}");
        assert!(found[1..].iter().all(|row| row.error.is_some()), "{found:?}");
    }
    let found = of(rolling);
    let [coarse, middle, last] = [0, 1, 2].map(|k| found[k].value.expect("a force"));
    let (error, before) = (found[2].error.expect("an error"), (middle - coarse).abs());
    assert!((last - middle).abs() < 0.1 * before, "{found:?}");
    // The residual of 1e-6 adds less than 1e-3 of the estimate.
    assert!((error / (0.5 * before) - 1.0).abs() < 1e-3, "{found:?}");
    assert!((found[1].error.expect("an error") / before - 1.0).abs() < 1e-3, "{found:?}");
}

/// In full contact the gap is nothing but a residual, and counts as 0. A search must not refine because of it.
#[test]
fn full_contact_has_no_gap() {
    let (m, d) = (16, 1.0);
    let grid = Grid::new(m, m, d, d).unwrap();
    let wave = |k: usize| (2.0 * std::f64::consts::PI * k as f64 / m as f64).cos();
    let h: Vec<f64> = (0..m * m).map(|i| 0.01 * (wave(i % m) + wave(i / m))).collect();
    let period = Some(Period { x: true, y: true });
    let scene = Scene { period, ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(5.0)) };
    let (_, rows) = quantities(&scene, &Options::default(), &[Quantity::MeanGap], 2, None).unwrap();
    for row in &rows {
        assert_eq!(row.value, Some(0.0), "{row:?}");
    }
    let accuracy = Accuracy::new(1e-2).with(Quantity::MeanGap, 1e-2);
    let found = solve_to_accuracy(&scene, &Options::default(), &accuracy, None, None).unwrap();
    assert_eq!(found.stop, Outcome::Converged, "{}", found.reason);
}
