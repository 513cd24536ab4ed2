//! The goal of a loop, and why it ended.

use crate::contact::{AdmissibleSet, Survey};

/// The criterion: which number has to become small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Criterion {
    /// `||h - approach + A p||_2 <= tolerance * ||h - approach||_2`, over C.
    #[default]
    Residual,
    /// NORM's own: rms over C of the last change of p at most `tolerance` times the rms over C of p. A stalled iterate has a small
    /// last change, too: so the residual has to be finite and at most the larger of [`UPDATE_RESIDUAL`] and the tolerance.
    Update,
}

/// The relative residual up to which a small last change is believed.
pub const UPDATE_RESIDUAL: f64 = 1e-2;

/// The goal of a loop on one grid.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// Which number has to become small.
    pub criterion: Criterion,
    /// How small.
    pub tolerance: f64,
    /// Cycles at most.
    pub max_cycles: u64,
}

impl Goal {
    /// The residual that an answer may have at most, relative to `h - approach`.
    pub fn residual(&self) -> f64 {
        match self.criterion {
            Criterion::Residual => self.tolerance,
            Criterion::Update => self.tolerance.max(UPDATE_RESIDUAL),
        }
    }

    /// Whether a state whose u is a fresh A p satisfies the criterion, and with it the contact conditions: the one place that decides.
    /// `update`: rms over C of the last change of p. Comparisons are such that a NaN does not pass.
    pub fn holds<S: AdmissibleSet>(&self, survey: &Survey, update: f64, _: S) -> bool {
        let allowed = self.residual();
        let rms = (survey.squares / survey.contact_count.max(1) as f64).sqrt();
        let small = !self.by_update() || update <= self.tolerance * rms;
        // An empty C has no residual, whatever p is.
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
    /// The progress callback said so.
    Cancelled,
    /// No further progress: the method does not converge on this scene, or round-off is reached.
    Stagnated,
}
