//! What accuracy costs where something attracts.

use std::thread::sleep;
use std::time::Duration;

use contact_normal::scene::Load;
use contact_normal::solver::{cost_of_accuracy, Accuracy, Obstacle, Options, Outcome, Progress, Quantity};

use super::support::Sphere;

/// One grid has no estimate there, so the error follows from three or four: on a machine that is slow, too, where the seconds of the list end with the first
/// sample. A machine is made slow by a callback that sleeps longer than these 35 ms.
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
            assert!(price.seconds > 0.0, "{load:?}");
        }
    }
}
