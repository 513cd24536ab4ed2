//! How the methods of a list share the cycles.

use super::{share, stages, Stage, LEAST_SHARE};
use crate::contact::{AdmissibleSet, NonNegative};
use crate::scene::PressureLimit;
use crate::solver::Method;

/// The number of cycles of each method of a list if none of them converges. `most`: the cycles of all.
fn cycles<S: AdmissibleSet>(list: &[Stage], most: u64) -> Vec<u64> {
    let mut done = 0;
    let last = list.len() - 1;
    let each = list.iter().enumerate().map(|(k, stage)| {
        let until = if k == last { most } else { share::<S>(*stage, done, most) };
        until - std::mem::replace(&mut done, until)
    });
    each.collect()
}

#[test]
fn every_method_of_a_list_has_its_turn() {
    for most in [60, 300, 1000, 5000] {
        for (multigrid, symmetric) in [(true, true), (true, false), (false, true), (false, false)] {
            let plain = cycles::<NonNegative>(stages::<NonNegative>(Method::Auto, symmetric, multigrid), most);
            let limited =
                cycles::<PressureLimit<'_>>(stages::<PressureLimit<'_>>(Method::Auto, symmetric, multigrid), most);
            for counts in [plain, limited] {
                assert_eq!(counts.iter().sum::<u64>(), most);
                assert!(counts.iter().all(|count| *count > 0), "{counts:?}");
                assert!(most < 1000 || counts.iter().all(|count| *count >= LEAST_SHARE), "{counts:?}");
            }
        }
    }
    // With pressure limits each method is followed by the projected Newton method.
    for method in [Method::Norm, Method::Multigrid, Method::FullMultigrid, Method::ProjectedCg] {
        assert_eq!(stages::<PressureLimit<'_>>(method, true, true).last(), Some(&Stage::ProjectedNewton));
    }
    let auto = stages::<NonNegative>(Method::Auto, true, false);
    // Each method of AUTO gets 0.4 of the remaining cycles, and the last one the rest.
    assert_eq!(cycles::<NonNegative>(auto, 1000), [400, 240, 144, 216]);
}
