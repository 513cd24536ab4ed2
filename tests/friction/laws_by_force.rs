//! Friction laws with given tangential forces. The force of a given creepage is computed; as a given force it must give the creepage back.

use contact_normal::friction::{Report, Request, Solution};
use contact_normal::scene::{Coefficient, Friction, FrictionLaw, Motion, PlasticLayer, Prescribed, Previous};
use contact_normal::solver::Outcome;

use super::laws::{residuals, solver, Wheel, FORCE, RUNNING};

const TOLERANCE: f64 = 1e-7;

fn by_force(friction: &Friction<'static>, force: [f64; 2]) -> Friction<'static> {
    Friction { prescribed: force.map(Prescribed::Force), ..*friction }
}

/// Solves for given creepages, and then for the forces that they cause. Returns both reports and solutions.
fn there_and_back(wheel: &Wheel, friction: &Friction<'static>) -> [(Report, Solution); 2] {
    let (end, report, solution) = wheel.ended(friction, TOLERANCE);
    assert_eq!(end, Outcome::Converged, "{friction:?} {report:?}");
    let (end, back, found) = wheel.ended(&by_force(friction, report.force), TOLERANCE);
    assert_eq!(end, Outcome::Converged, "{friction:?} {back:?}");
    assert!(back.missing <= TOLERANCE, "{back:?}");
    [(report, solution), (back, found)]
}

/// The allowed difference of creepages. A residual relative to the rigid slip allows the tolerance times the creepage. A force to the tolerance times
/// mu N allows the tolerance divided by the slope of the creep curve, which is computed from a chord to 2 % more creepage. The sum is doubled,
/// because the force comes from a solve, too.
fn allowed(wheel: &Wheel, friction: &Friction<'static>, (xi, force): (f64, f64)) -> f64 {
    let more = Friction { prescribed: [Prescribed::Creepage(1.02 * xi), friction.prescribed[1]], ..*friction };
    let (end, report, _) = wheel.ended(&more, TOLERANCE);
    assert_eq!(end, Outcome::Converged);
    let chord = (report.force[0] - force).abs() / (0.33 * FORCE * 0.02 * xi);
    2.0 * TOLERANCE * (xi + 1.0 / chord)
}

#[test]
fn forces_below_the_maximum_give_the_creepages_back() {
    let wheel = Wheel::new(1);
    for law in [RUNNING, FrictionLaw { memory_distance: 0.0, ..RUNNING }] {
        for (xi, spin) in [(0.001, 0.0), (0.004, 0.0), (0.008, 0.0), (0.011, 0.0), (0.003, 4e-4)] {
            let friction = wheel.friction(xi, spin, Some(law));
            let [(report, solution), (back, found)] = there_and_back(&wheel, &friction);
            let (count, again) = (report.certificate.stick_count, back.certificate.stick_count);
            println!("{xi} {spin} {:?} {count} {again} products {} {}", back.creepage, report.products, back.products);
            let allowed = allowed(&wheel, &friction, (xi, report.force[0]));
            for (creepage, exact) in back.creepage.into_iter().zip([xi, 0.0]) {
                assert!((creepage - exact).abs() <= allowed, "{xi} {spin}: {:?} {allowed}", back.creepage);
            }
            assert_eq!(count, again);
            let largest = solution.traction.iter().map(|q| q[0].hypot(q[1])).fold(0.0, f64::max);
            // Tractions are slips times the inverse of an operator. Its condition number is below 1000: with 48 elements across it is 48^2/2 at most.
            // So 1e-4 is ample for the tolerances of two solves.
            for (q, other) in solution.traction.iter().zip(&found.traction) {
                assert!((q[0] - other[0]).hypot(q[1] - other[1]) <= 1e-4 * largest);
            }
            let as_found = Friction { prescribed: back.creepage.map(Prescribed::Creepage), ..friction };
            let [slip, bound, displaced] = residuals(&wheel, &as_found, &found);
            // With given forces the residual may be relative to the displacements. 1 % allows for the round-off of direct sums.
            let tolerance = 1.01 * TOLERANCE;
            assert!(slip <= tolerance * displaced.max(1.0) && bound <= tolerance, "{slip} {bound} {displaced}");
            assert!(back.products <= 2.5 * report.products, "{} {}", back.products, report.products);
        }
    }
}

/// A falling law has two creepages for a force below the maximum of the creep curve. The smaller one is found. A force above the maximum has no
/// solution.
#[test]
fn the_smaller_creepage_is_found_and_a_force_above_the_maximum_is_none() {
    let wheel = Wheel::new(1);
    let (_, falling, _) = wheel.ended(&wheel.friction(0.05, 0.0, Some(RUNNING)), TOLERANCE);
    let (end, report, _) = wheel.ended(&by_force(&wheel.friction(0.0, 0.0, Some(RUNNING)), falling.force), TOLERANCE);
    assert_eq!(end, Outcome::Converged);
    // CONTACT's creep curve (laws.rs) has .8652 at a creepage of .008 and .8622 at .05, so that the force of .05 belongs to a creepage just below
    // .008, too.
    assert!((0.0075..0.008).contains(&report.creepage[0]), "{:?}", report.creepage);
    // The maximum of CONTACT's creep curve is .9445.
    let above = by_force(&wheel.friction(0.0, 0.0, Some(RUNNING)), [-0.96 * 0.33 * FORCE, 0.0]);
    let (end, ..) = wheel.ended(&above, TOLERANCE);
    assert!(matches!(end, Outcome::Stagnated | Outcome::IterationLimit), "{end:?}");
}

/// Given forces in transient rolling, in shifts, and with a layer that hardens.
#[test]
fn steps_by_force_give_the_creepages_back() {
    let wheel = Wheel::new(1);
    let law = FrictionLaw { memory_distance: 0.02, time_step: 0.289e-4, ..RUNNING };
    let hard = Some(PlasticLayer { yield_limit: 120.0, hardening: 1e4 });
    let rolls = Friction { motion: Motion::TransientRolling, ..wheel.friction(0.004, 0.0, Some(law)) };
    let shifts = Friction { motion: Motion::Shift, ..wheel.friction(0.02, 0.0, Some(law)) };
    let hardens = Friction { law: None, layer: hard, ..wheel.friction(0.004, 0.0, None) };
    for (friction, steps) in [(rolls, 3), (shifts, 2), (hardens, 1)] {
        let (mut of_creepage, mut of_force) = (solver(&wheel.grid), solver(&wheel.grid));
        let mut creepage = friction.prescribed;
        for step in 0..steps {
            let previous = if step > 0 { Previous::Kept } else { Previous::None };
            let moved = Friction { prescribed: creepage, previous, ..friction };
            let request = Request::new(&wheel.pressure, &moved, TOLERANCE);
            let (end, report) = of_creepage.solve(&request, &mut |_, _| true).unwrap();
            assert_eq!(end, Outcome::Converged, "{moved:?}");
            let given = by_force(&moved, report.force);
            let request = Request::new(&wheel.pressure, &given, TOLERANCE);
            let (end, back) = of_force.solve(&request, &mut |_, _| true).unwrap();
            assert_eq!(end, Outcome::Converged, "{given:?} {back:?}");
            let Prescribed::Creepage(exact) = creepage[0] else { panic!("creepages") };
            println!("{step} {exact} {:?} products {} {}", back.creepage, report.products, back.products);
            // Both solves have a tolerance of forces over mu N. `d(F/(mu N))/d(ln creepage)` is above .2, so that the creepage may be off by 5 times
            // each tolerance.
            assert!((back.creepage[0] / exact - 1.0).abs() <= 10.0 * TOLERANCE, "{exact} {:?}", back.creepage);
            assert!(back.creepage[1].abs() <= 10.0 * TOLERANCE * exact);
            assert_eq!(report.certificate.slip_count, back.certificate.slip_count);
            creepage[0] = Prescribed::Creepage(0.8 * exact);
        }
    }
}

#[test]
fn one_force_may_be_given_beside_a_creepage() {
    let wheel = Wheel::new(1);
    let friction = wheel.friction(0.003, 8e-4, Some(RUNNING));
    let (_, report, _) = wheel.ended(&friction, TOLERANCE);
    let mixed = Friction { prescribed: [Prescribed::Creepage(0.003), Prescribed::Force(report.force[1])], ..friction };
    let (end, back, _) = wheel.ended(&mixed, TOLERANCE);
    assert_eq!(end, Outcome::Converged);
    // The allowed difference is relative to the creepages, although the second one is compared with 0.
    let allowed = allowed(&wheel, &friction, (0.003, report.force[0]));
    assert!((back.force[0] / report.force[0] - 1.0).abs() <= 10.0 * TOLERANCE, "{:?} {:?}", back.force, report.force);
    assert!(back.creepage[1].abs() <= allowed, "{:?} {allowed}", back.creepage);
    assert_eq!(mixed.coefficient, Coefficient::Uniform(0.33));
}

/// After a solve that is cut short the residual includes the missing part of the force.
#[test]
fn a_force_that_is_not_met_counts_in_the_residual() {
    let wheel = Wheel::new(1);
    let friction = by_force(&wheel.friction(0.0, 0.0, Some(RUNNING)), [-0.15 * FORCE, 0.0]);
    for limit in [1, 3, 6, 10] {
        let (end, report, solution) = wheel.limited(&friction, TOLERANCE, limit);
        let lack = report.missing;
        assert!(end != Outcome::Converged && lack > TOLERANCE, "{limit}: {report:?}");
        assert!(report.certificate.residual >= 0.999 * lack, "{limit}: {report:?}");
        drop(solution);
    }
}
