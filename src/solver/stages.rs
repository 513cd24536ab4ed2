//! Which methods solve a scene, in which order, and with how many cycles each.

use super::options::Method;
use crate::contact::AdmissibleSet;

/// A method has this part of the cycles that are left, then the next one takes over. It has at least LEAST_SHARE of them, or half of what is left. AUTO of a
/// plain scene: 400, 240, 144, and the rest of 1000 for NORM, which ends on every area of contact.
const SHARE: f64 = 0.4;
const LEAST_SHARE: u64 = 60;
/// The cycles of PROJECTED_CG with limits at most. Most scenes with limits take fewer; where it takes more it mostly goes round in circles, and the
/// projected Newton method goes on from its best iterate.
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

/// Cycles up to which a method may go on before the next takes over, of which so many are done: a part of those that are left, so that every method of the list
/// has its turn.
pub fn share<S: AdmissibleSet>(stage: Stage, done: u64, most: u64) -> u64 {
    let left = most.saturating_sub(done);
    let share = LEAST_SHARE.min(left / 2).max((SHARE * left as f64) as u64);
    done + if S::LIMITED && stage == Stage::ProjectedCg { share.min(LIMITED_SHARE) } else { share }
}

/// The methods that solve a scene, first to last. `multigrid`: whether V-cycles solve all its effects.
pub fn stages<S: AdmissibleSet>(method: Method, symmetric: bool, multigrid: bool) -> &'static [Stage] {
    use Stage::{Direct, FullMultigrid, Norm, ProjectedCg, ProjectedNewton, VCycles};
    match method {
        Method::Norm => &[Norm],
        // Around limits V-cycles may go round in circles.
        Method::Multigrid if S::LIMITED && symmetric => &[VCycles, ProjectedNewton],
        Method::FullMultigrid if S::LIMITED && symmetric => &[FullMultigrid, ProjectedNewton],
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
