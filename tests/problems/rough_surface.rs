//! The self-affine rough surface of the benchmarks: many spots of contact.

#[allow(dead_code)]
use crate::performance as case;

use contact_normal::scene::Load;
use contact_normal::solver::{solve, Options, Outcome};

/// If the approach is given, the force on the coarse grids is not that on the fine one, so that the first iterations change all pressures and
/// truncate many: 1.4 times the work of a given force. Search directions that do not descend after clipped steps are dropped; otherwise the contact
/// area would cycle.
#[test]
fn the_approach_that_a_force_leads_to_costs_about_as_much_as_that_force() {
    for m in [128, 256, 512] {
        let case = case::rough(m);
        let options = Options::default();
        let (by_force, stop, forced) = solve(&case.scene(), &options).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let scene = case.scene_with(Load::Approach(forced.measures.approach));
        let (by_approach, stop, approached) = solve(&scene, &options).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let (approached, forced) = (approached.count.work_units, forced.count.work_units);
        assert!(approached <= 2.0 * forced, "{m}: {approached} work units by approach, {forced} by force");
        let pairs = by_force.state().contact.iter().zip(&by_approach.state().contact);
        let different = pairs.filter(|(a, b)| a != b).count();
        // Elements at the edge may differ within the tolerance: up to 1 in 200 of the elements in contact.
        assert!(different <= by_force.state().contact_count() / 200, "{m}: {different} elements differ");
    }
}
