//! The list of methods that solve a scene, in order, and how the allowed cycles are shared among them.

use super::options::Method;
use crate::contact::AdmissibleSet;
use crate::progress::METHOD_SHARE;

/// Each method of the list may take at least this many cycles, or half of those that remain if that is less.
const LEAST_SHARE: u64 = 60;
/// Most cycles of PROJECTED_CG with pressure limits. Most scenes with limits take fewer. A solve that takes more usually repeats the same contact
/// areas; the projected Newton method then continues from the best iterate.
const LIMITED_SHARE: u64 = 100;

/// A method of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    Direct,
    ProjectedCg,
    VCycles,
    FullMultigrid,
    ProjectedNewton,
    Norm,
}

/// The number of cycles at which a method, which is not the last of its list, has to end. `done` are the cycles so far, `most` those of the whole
/// solve. The method gets a part of the rest, so that cycles remain for every method of the list.
pub fn share<S: AdmissibleSet>(stage: Stage, done: u64, most: u64) -> u64 {
    let left = most.saturating_sub(done);
    // Rounded up: a single remaining cycle goes to this method, not to a later one.
    let share = LEAST_SHARE.min(left.div_ceil(2)).max((METHOD_SHARE * left as f64) as u64);
    done + if S::LIMITED && stage == Stage::ProjectedCg { share.min(LIMITED_SHARE) } else { share }
}

/// The list of methods for `method` and the admissible set S, first to last. `symmetric` tells whether A is symmetric, `multigrid` whether V-cycles
/// can solve all effects of the scene.
pub fn stages<S: AdmissibleSet>(method: Method, symmetric: bool, multigrid: bool) -> &'static [Stage] {
    use Stage::{Direct, FullMultigrid, Norm, ProjectedCg, ProjectedNewton, VCycles};
    match method {
        // With limits each of these methods may repeat the same contact areas; then the projected Newton method continues.
        Method::Norm if S::LIMITED && symmetric && !S::FIXED => &[Norm, ProjectedNewton],
        Method::ProjectedCg if S::LIMITED && symmetric && !S::FIXED => &[Direct, ProjectedCg, ProjectedNewton],
        Method::Multigrid if S::LIMITED && symmetric => &[VCycles, ProjectedNewton],
        Method::FullMultigrid if S::LIMITED && symmetric => &[FullMultigrid, ProjectedNewton],
        Method::Norm => &[Norm],
        Method::Multigrid => &[VCycles],
        Method::FullMultigrid => &[FullMultigrid],
        Method::ProjectedCg if S::FIXED => &[ProjectedCg],
        Method::ProjectedCg => &[Direct, ProjectedCg],
        Method::Auto => match (symmetric, S::FIXED, multigrid) {
            (true, true, _) => &[ProjectedCg, Norm],
            (true, false, _) if S::LIMITED => &[Direct, ProjectedCg, ProjectedNewton, Norm],
            (true, false, true) => &[Direct, ProjectedCg, FullMultigrid, ProjectedNewton, Norm],
            (true, false, false) => &[Direct, ProjectedCg, ProjectedNewton, Norm],
            (false, _, true) => &[FullMultigrid, Norm],
            (false, _, false) => &[Norm],
        },
    }
}

#[cfg(test)]
#[path = "../../tests/unit/stages.rs"]
mod tests;
