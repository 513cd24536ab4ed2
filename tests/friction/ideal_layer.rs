//! An ideally plastic layer (hardening 0) keeps a yield limit for each particle. Its tractions are compared with those of a layer with a hardening
//! near 0, for which the library uses another method.

use contact_normal::friction::{Request, Solution};
use contact_normal::grid::Grid;
use contact_normal::scene::{Friction, FrictionLaw, Motion, PlasticLayer, Prescribed, Previous};

use super::case::{distance, grid};
use super::laws::{pressures, solver, RUNNING};
use super::support::run;

const TOLERANCE: f64 = 1e-9;
const FORCE: f64 = 1e4;

/// The pressures of a ball on 24 x 24 elements.
fn ball() -> (Grid, Vec<f64>) {
    let grid = grid(24, 24, 0.2, 0.2);
    let h = distance(&grid, |x, y| (x * x + y * y) / 600.0);
    (grid, pressures(grid, &h, FORCE))
}

/// Solves with an ideally plastic layer and with one that hardens by 1e-6. If `hardened`, a first step hardens the layer, so that its limits vary.
fn both(pressure: &[f64], grid: &Grid, friction: &Friction<'_>, hardened: bool) -> [Solution; 2] {
    [0.0, 1e-6].map(|hardening| {
        let mut solver = solver(grid);
        let layer = |hardening| Some(PlasticLayer { yield_limit: 40.0, hardening });
        if hardened {
            let previous = Previous::None;
            run(&mut solver, pressure, &Friction { layer: layer(1e5), previous, ..*friction }, TOLERANCE);
        }
        run(&mut solver, pressure, &Friction { layer: layer(hardening), ..*friction }, TOLERANCE).1
    })
}

fn assert_same([ideal, hardly]: [Solution; 2], what: &str) {
    let largest = hardly.traction.iter().flatten().fold(0.0f64, |most, q| most.max(q.abs()));
    for (i, (a, b)) in ideal.traction.iter().zip(&hardly.traction).enumerate() {
        // Two causes of a difference: a residual of 1e-9 of the rms slip, which may be concentrated in one of 576 elements; and the hardening of 1e-6
        // MPa/mm times slips of up to 1e-6 mm.
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-6 * largest, "{what}, element {i}: {a:?} {b:?}");
        let limit = ideal.particles[i].yield_limit;
        assert!(a[0].hypot(a[1]) <= limit * (1.0 + 1e-12), "{what}, element {i}: {a:?} of {limit}");
    }
}

#[test]
fn a_step_that_continues_has_the_limits_of_the_step_before() {
    let (grid, pressure) = ball();
    let prescribed = [Prescribed::Creepage(-0.02), Prescribed::Creepage(0.004)];
    let friction = Friction { prescribed, previous: Previous::Kept, ..Friction::new(0.3) };
    let [fresh, _] = both(&pressure, &grid, &Friction { previous: Previous::None, ..friction }, false);
    let after = both(&pressure, &grid, &friction, true);
    let most = |of: &Solution| of.traction.iter().fold(0.0f64, |most, q| most.max(q[0].hypot(q[1])));
    assert!(most(&fresh) <= 40.0 * (1.0 + 1e-12) && most(&after[0]) > 50.0, "{} {}", most(&fresh), most(&after[0]));
    assert_same(after, "continues");
}

#[test]
fn limits_move_with_the_particles_in_rolling() {
    let (grid, pressure) = ball();
    let limits: Vec<f64> = (0..grid.len()).map(|i| if i % 24 == 12 { 5.0 } else { 40.0 }).collect();
    let prescribed = [Prescribed::Creepage(-0.01), Prescribed::Creepage(0.0)];
    for motion in [Motion::TransientRolling, Motion::SteadyRolling] {
        let friction = Friction { motion, prescribed, yield_limits: Some(&limits), ..Friction::new(0.3) };
        let found = both(&pressure, &grid, &friction, false);
        let low = found[0].particles.iter().filter(|particle| particle.yield_limit < 39.0).count();
        // In transient rolling by one element the column of low limits moves by one element. In steady rolling all particles enter the contact with
        // fresh limits.
        assert_eq!(low, if motion == Motion::SteadyRolling { 0 } else { 24 }, "{motion:?}");
        assert_same(found, &format!("{motion:?}"));
    }
}

#[test]
fn a_force_beyond_the_limits_of_the_particles_is_refused() {
    let (grid, pressure) = ball();
    let reach = 40.0 * pressure.iter().filter(|p| **p > 0.0).count() as f64 * grid.element_area();
    let prescribed = [Prescribed::Force(1.05 * reach), Prescribed::Creepage(0.0)];
    let layer = Some(PlasticLayer { yield_limit: 40.0, hardening: 0.0 });
    let friction = Friction { prescribed, layer, ..Friction::new(0.3) };
    let refused = solver(&grid).solve(&Request::new(&pressure, &friction, TOLERANCE), &mut |_, _| true);
    assert!(refused.is_err());
    // If the caller gives the higher limits of hardened particles, the same force is carried.
    let limits = vec![80.0; grid.len()];
    run(&mut solver(&grid), &pressure, &Friction { yield_limits: Some(&limits), ..friction }, TOLERANCE);
}

/// A step with a friction law but without a plastic layer keeps no yield limits. The layer of the next step is fresh, as if the caller gave the same
/// tractions.
#[test]
fn a_layer_that_begins_after_a_law_is_fresh() {
    let (grid, pressure) = ball();
    let prescribed = [Prescribed::Creepage(-0.02), Prescribed::Creepage(0.004)];
    let law = Some(FrictionLaw { memory_distance: 0.0, time_step: 1e-4, ..RUNNING });
    let coulomb = Friction { prescribed, ..Friction::new(0.33) };
    for (hardening, with_law) in [(0.0, None), (0.0, law), (1e4, law)] {
        let layer = Some(PlasticLayer { yield_limit: 40.0, hardening });
        let [kept, given] = [true, false].map(|is_kept| {
            let mut of = solver(&grid);
            let (_, first) = run(&mut of, &pressure, &Friction { law, ..coulomb }, TOLERANCE);
            let second = |previous| Friction { layer, law: with_law, previous, ..coulomb };
            if is_kept {
                run(&mut of, &pressure, &second(Previous::Kept), TOLERANCE).1
            } else {
                let [x, y] = [0, 1].map(|k| first.traction.iter().map(|q| q[k]).collect::<Vec<f64>>());
                run(&mut solver(&grid), &pressure, &second(Previous::Given([&x, &y])), TOLERANCE).1
            }
        });
        let most = |of: &Solution| of.traction.iter().fold(0.0f64, |most, q| most.max(q[0].hypot(q[1])));
        assert!(
            most(&given) > 39.0 && (most(&kept) - most(&given)).abs() < 1e-6 * most(&given),
            "{hardening}: {} {}",
            most(&kept),
            most(&given)
        );
        for (a, b) in kept.particles.iter().zip(&given.particles) {
            assert!((a.yield_limit - b.yield_limit).abs() < 1e-6 * b.yield_limit, "{hardening}: {a:?} {b:?}");
        }
    }
}
