//! Lines in plane strain with two periods, by approach: the mean gap of a force.
//!
//! The mean of u is 0, so `mean of h - approach` is the mean gap. Near full contact it tends to 0 while the force grows. Its logarithm m falls
//! linearly with the force if contact covers more than some percent of a rough line: on lines of 9600 elements the slope changes by a tenth from
//! .35 to .99 of contact. So secants and extrapolations use m.

/// Range of the first relative change of the force if m is no logarithm: it is the relative error of the approach. Otherwise ln F changes by the
/// change of m.
const FIRST: (f64, f64) = (1e-3, 0.03);
/// A mean gap below this part of the wanted one counts as 0: contact is full, or the solution loose.
const LEAST_GAP: f64 = 0.1;

/// The wanted approach, and the results of the last force.
pub(super) struct Found {
    pub(super) wanted: f64,
    pub(super) force: f64,
    pub(super) approach: f64,
    pub(super) residual: f64,
    /// rms of h - approach over C.
    pub(super) size: f64,
    /// Mean of h, if the mean gap is positive.
    pub(super) mean: Option<f64>,
}

impl Found {
    /// m of an approach; the negative approach if there is no mean gap.
    pub(super) fn m(&self, approach: f64) -> f64 {
        self.mean.map_or(-approach, |mean| (mean - approach).max(LEAST_GAP * (mean - self.wanted)).ln())
    }

    /// Whether contact is full, or seems so in a loose solution.
    pub(super) fn is_full(&self) -> bool {
        self.mean.is_some_and(|mean| mean - self.approach <= LEAST_GAP * (mean - self.wanted))
    }

    /// Whether the residual exceeds the wanted gap, so that full contact may be due to it.
    pub(super) fn may_be_loose(&self) -> bool {
        self.is_full() && self.mean.is_some_and(|mean| self.residual * self.size > mean - self.wanted)
    }

    /// The relative error of the approach.
    pub(super) fn off(&self) -> f64 {
        (self.wanted - self.approach).abs() / self.size
    }

    /// The next force after the first one.
    pub(super) fn first_change(&self) -> f64 {
        let change = self.m(self.approach) - self.m(self.wanted);
        match self.mean {
            Some(_) => self.force * change.exp(),
            None => self.force * (1.0 + (change / self.size).abs().clamp(FIRST.0, FIRST.1).copysign(change)),
        }
    }
}
