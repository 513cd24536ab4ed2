//! Lines in plane strain with two periods and a prescribed approach: how the mean gap depends on the force.
//!
//! The mean of u is 0, so the mean gap is the mean of h - approach. Near full contact the mean gap tends to 0 while the force grows. Let m be the
//! logarithm of the mean gap. If contact covers more than some percent of a rough line, m falls linearly with the force: on lines of 9600 elements
//! the slope changes by a tenth between 35 % and 99 % of contact. So secants and extrapolations use m.

/// If there is no mean gap, the first relative change of the force is the relative error of the approach, clamped to this range. If there is one, ln
/// F changes by the change of m.
const FIRST: (f64, f64) = (1e-3, 0.03);
/// A mean gap below this part of the wanted one counts as 0: contact is full, or the solution is not yet accurate.
const LEAST_GAP: f64 = 0.1;

/// The wanted approach, and what the solve of the last force found.
pub(super) struct Found {
    /// The prescribed approach.
    pub(super) wanted: f64,
    /// The last force.
    pub(super) force: f64,
    /// The approach that belongs to this force.
    pub(super) approach: f64,
    /// The relative residual to which this force was solved.
    pub(super) residual: f64,
    /// The rms of h - approach over C, at the wanted approach.
    pub(super) size: f64,
    /// The mean of h, if the mean gap at the wanted approach is positive.
    pub(super) mean: Option<f64>,
}

impl Found {
    /// The logarithm m of the mean gap at an approach; minus the approach if the wanted mean gap is not positive.
    pub(super) fn m(&self, approach: f64) -> f64 {
        self.mean.map_or(-approach, |mean| (mean - approach).max(LEAST_GAP * (mean - self.wanted)).ln())
    }

    /// Whether contact is full, or seems so because the solution is not yet accurate.
    pub(super) fn is_full(&self) -> bool {
        self.mean.is_some_and(|mean| mean - self.approach <= LEAST_GAP * (mean - self.wanted))
    }

    /// Whether the residual exceeds the wanted gap, so that full contact may be due to it.
    pub(super) fn may_be_loose(&self) -> bool {
        self.is_full() && self.mean.is_some_and(|mean| self.residual * self.size > mean - self.wanted)
    }

    /// The distance between the found and the wanted approach, relative to the rms of h - approach.
    pub(super) fn off(&self) -> f64 {
        (self.wanted - self.approach).abs() / self.size
    }

    /// The second force, for which there is no secant yet.
    pub(super) fn first_change(&self) -> f64 {
        let change = self.m(self.approach) - self.m(self.wanted);
        match self.mean {
            Some(_) => self.force * change.exp(),
            None => self.force * (1.0 + (change / self.size).abs().clamp(FIRST.0, FIRST.1).copysign(change)),
        }
    }
}
