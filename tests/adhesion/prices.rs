//! Price lists, and searches for an accuracy, with adhesion.

use std::thread::sleep;
use std::time::Duration;

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::Load;
use contact_normal::solver::{
    cost_of_accuracy, solve_to_accuracy, Accuracy, Obstacle, Options, Outcome, Progress, Quantity,
};

use super::support::Sphere;

/// With adhesion a single grid has no error estimate, so that errors are estimated from three or four grids. A price list must do so on a slow
/// machine, too, where the 35 ms for samples end with the first one. A callback that sleeps for 50 ms imitates such a machine.
#[test]
fn prices_come_from_several_grids_on_a_slow_machine() {
    let sphere = Sphere::by_tabor(1.0, 128, 4.0);
    for load in [Load::Approach(0.5), Load::Force(0.5)] {
        let mut cycles = 0;
        let mut slow = |_: &Progress| {
            cycles += 1;
            if cycles == 1 {
                sleep(Duration::from_millis(50));
            }
            false
        };
        let priced = (Quantity::MaxPressure, &[1e-2, 1e-3][..]);
        let accuracy = Accuracy::new(1e-2);
        let (outcome, prices) =
            cost_of_accuracy(&sphere.scene(load), &Options::default(), &accuracy, priced, None, Some(&mut slow))
                .unwrap();
        assert_eq!(outcome, Outcome::Converged);
        for price in prices {
            assert_ne!(price.obstacle, Some(Obstacle::Singular), "{load:?}");
            assert!(price.seconds > Some(0.0), "{load:?}");
        }
    }
}

/// If a pull is refused, the message names the scene's grid, although a coarser one refuses the force, too.
#[test]
fn a_pull_that_is_refused_names_its_grid() {
    let sphere = Sphere::by_tabor(1.0, 32, 3.0);
    let accuracy = Accuracy::new(1e-2).with(Quantity::MeanGap, 1e-2);
    let found = solve_to_accuracy(&sphere.scene(Load::Force(-3.0)), &Options::default(), &accuracy, None, None);
    let Err(Error::Infeasible(message)) = found.map(|_| ()) else { panic!("solved, or refused otherwise") };
    assert!(message.starts_with("on 32 x 32 elements: "), "{message}");
}

/// Bodies that attract each other without contact have error estimates like bodies in contact. A result on a coarse grid is within the target. A
/// target that needs more elements than the limit is not met.
#[test]
fn bodies_apart_are_solved_to_an_accuracy() {
    let sphere = Sphere::by_tabor(1.0, 8, 3.0);
    let apart = Load::Approach(-2.0 * sphere.adhesion.range);
    let search = |target: f64, most: u64| {
        let mut surface = |grid: &Grid, h: &mut [f64]| {
            h.copy_from_slice(&Sphere::by_tabor(1.0, grid.mx, 3.0).h);
            false
        };
        let accuracy = Accuracy { max_elements: most * most, ..Accuracy::new(target) };
        solve_to_accuracy(&sphere.scene(apart), &Options::default(), &accuracy, Some(&mut surface), None)
            .expect("a solvable scene")
    };
    let reference = Sphere::by_tabor(1.0, 256, 3.0).solve(apart).1.force;
    for target in [1e-2, 1e-4] {
        let found = search(target, 256);
        let off = (found.report.measures.force / reference - 1.0).abs();
        assert!(found.report.measures.contact_count == 0 && reference < 0.0);
        assert_eq!(found.stop, Outcome::Converged, "{}", found.reason);
        assert!(off <= target, "{target:e}: {off:e}, {}", found.reason);
    }
    let found = search(1e-9, 32);
    assert_eq!(found.stop, Outcome::IterationLimit, "{}", found.reason);
    assert!(found.reached.is_some_and(|reached| reached > 1e-9), "{}", found.reason);
}
