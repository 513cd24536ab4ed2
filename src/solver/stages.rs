//! The methods that solve a scene, their order, and their cycles.

use super::options::Method;
use crate::contact::AdmissibleSet;
use crate::progress::METHOD_SHARE;

/// The least cycles of a method; half of those that remain if that is less.
const LEAST_SHARE: u64 = 60;
/// Most cycles of PROJECTED_CG with limits. Most scenes with limits take fewer. After more, the method usually cycles, and the projected Newton
/// method continues from its best iterate.
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

/// The cycle count at which a method ends, from the cycles done: a fraction of the rest, so that cycles remain for every method of the list.
pub fn share<S: AdmissibleSet>(stage: Stage, done: u64, most: u64) -> u64 {
    let left = most.saturating_sub(done);
    // The only remaining cycle goes to the first method, whose start is the best.
    let share = LEAST_SHARE.min(left.div_ceil(2)).max((METHOD_SHARE * left as f64) as u64);
    done + if S::LIMITED && stage == Stage::ProjectedCg { share.min(LIMITED_SHARE) } else { share }
}

/// The methods that solve a scene, first to last. `multigrid`: whether V-cycles solve all its effects.
pub fn stages<S: AdmissibleSet>(method: Method, symmetric: bool, multigrid: bool) -> &'static [Stage] {
    use Stage::{Direct, FullMultigrid, Norm, ProjectedCg, ProjectedNewton, VCycles};
    match method {
        // With limits any of these may cycle between contact areas.
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
