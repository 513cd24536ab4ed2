//! The goal of a loop, and why it ended.

use crate::contact::{AdmissibleSet, Survey};

/// The criterion: the measure that has to fall below the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Criterion {
    /// `||h - approach + A p||_2 <= tolerance * ||h - approach||_2`, over C.
    #[default]
    Residual,
    /// NORM's own: rms over C of the last change of p at most `tolerance` times the rms over C of p. As a stalled iterate also has a small last
    /// change, the residual has to be finite and at most the larger of [`UPDATE_RESIDUAL`] and the tolerance.
    Update,
}

/// The fraction of the remaining cycles that a method may use before the next one follows.
/// AUTO of a plain scene has 400, 240, 144, and the rest of 1000 for NORM, which converges on every contact area.
pub const SHARE: f64 = 0.4;
/// Relative residual up to which a small last change counts.
pub const UPDATE_RESIDUAL: f64 = 1e-2;

/// The goal of a loop on one grid.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// The criterion.
    pub criterion: Criterion,
    /// The tolerance of the criterion.
    pub tolerance: f64,
    /// Most cycles.
    pub max_cycles: u64,
}

impl Goal {
    /// The largest residual of a solution, relative to `h - approach`.
    pub fn residual(&self) -> f64 {
        match self.criterion {
            Criterion::Residual => self.tolerance,
            Criterion::Update => self.tolerance.max(UPDATE_RESIDUAL),
        }
    }

    /// Whether a state with a fresh u = A p satisfies the criterion and the contact conditions. Only this function decides.
    /// `update`: rms over C of the last change of p. Comparisons are such that a NaN does not pass.
    pub fn holds<S: AdmissibleSet>(&self, survey: &Survey, update: f64, _: S) -> bool {
        let allowed = self.residual();
        let rms = (survey.squares / survey.contact_count.max(1) as f64).sqrt();
        let small = !self.by_update() || update <= self.tolerance * rms;
        // An empty C has no residual, for any p.
        let finite = survey.residual.is_finite() && survey.pressures.is_finite();
        let conditions = finite && survey.residual <= allowed * survey.distance;
        let free = survey.violation <= allowed * survey.scale && survey.work.0 <= allowed * survey.work.1;
        small && conditions && (S::FIXED || free && survey.range.0 >= 0.0)
    }

    /// Whether the criterion is UPDATE.
    pub fn by_update(&self) -> bool {
        self.criterion == Criterion::Update
    }
}

/// Why a loop ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The certificate holds.
    Converged,
    /// `max_cycles` was reached.
    IterationLimit,
    /// The progress callback cancelled.
    Cancelled,
    /// No further progress: the method does not converge on this scene, or round-off is reached.
    Stagnated,
}
