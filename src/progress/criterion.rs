//! The goal of an iteration loop, and why the loop ended.

use crate::contact::{AdmissibleSet, Survey};

/// Which measure has to be at most the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Criterion {
    /// `||h - approach + A p||_2 <= tolerance * ||h - approach||_2`, over C.
    #[default]
    Residual,
    /// The criterion of Kalker's NORM: the rms over C of the last change of p is at most `tolerance` times the rms over C of p. An iterate that makes
    /// no progress also has a small last change. Therefore the relative residual must be at most the larger of [`UPDATE_RESIDUAL`] and the tolerance.
    Update,
}

/// The part of the remaining cycles that a method may use before the next method of the list follows. For example, the four methods of AUTO have 400,
/// 240, 144 and 216 of 1000 cycles; the last one is NORM, which converges on every contact area.
pub const METHOD_SHARE: f64 = 0.4;
/// With criterion UPDATE: the largest relative residual of a solution, unless the tolerance is larger.
pub const UPDATE_RESIDUAL: f64 = 1e-2;

/// The goal of an iteration loop on one grid.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// Which measure has to be at most the tolerance.
    pub criterion: Criterion,
    /// The bound on that measure.
    pub tolerance: f64,
    /// Most cycles on the grid.
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

    /// Whether a state satisfies the criterion and the contact conditions. No other function decides this. `survey` must be that of a state with u =
    /// A p by a fresh product; `update` is the rms over C of the last change of p. All comparisons are false for NaN.
    pub fn holds<S: AdmissibleSet>(&self, survey: &Survey, update: f64, _: S) -> bool {
        let allowed = self.residual();
        let ((of_gaps, of_displacements), (least_pressure, _)) = (survey.work, survey.range);
        let rms = (survey.squares / survey.contact_count.max(1) as f64).sqrt();
        let small = !self.by_update() || update <= self.tolerance * rms;
        // If C is empty the residual is 0 for any p, so the sum of p is tested as well.
        let finite = survey.residual.is_finite() && survey.pressures.is_finite();
        let conditions = finite && survey.residual <= allowed * survey.distance;
        let free = survey.violation <= allowed * survey.scale && of_gaps <= allowed * of_displacements;
        small && conditions && (S::FIXED || free && least_pressure >= 0.0)
    }

    /// Whether the criterion is UPDATE.
    pub fn by_update(&self) -> bool {
        self.criterion == Criterion::Update
    }
}

/// Why an iteration loop ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The certificate holds.
    Converged,
    /// `max_cycles` was reached.
    IterationLimit,
    /// The progress callback cancelled.
    Cancelled,
    /// No further progress: no method converges on this scene, or round-off prevents the tolerance.
    Stagnated,
}
