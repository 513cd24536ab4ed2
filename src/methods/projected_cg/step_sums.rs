//! The sums over C of a step, and the update of u by the step.

/// The update `u = factor (u + alpha q + gamma w + A d)`. w is the product of the deflation direction, and d the change of p by truncation.
#[derive(Clone, Copy)]
pub(super) struct Update {
    pub(super) alpha: f64,
    pub(super) gamma: f64,
    /// Whether A d is added; z then holds A d. Otherwise the correction is deferred.
    pub(super) is_corrected: bool,
    pub(super) factor: f64,
}

impl Default for Update {
    fn default() -> Update {
        Update { alpha: 0.0, gamma: 0.0, is_corrected: false, factor: 1.0 }
    }
}

/// Sums over C that determine a step. A name of two letters is an inner product: `rt` = (r, t).
pub(super) struct StepSums {
    pub(super) rt: f64,
    pub(super) tq: f64,
    pub(super) tt: f64,
    /// The sum of |t|.
    pub(super) t1: f64,
    pub(super) pp: f64,
    /// (r, d) with the deflation direction d; 0 without one.
    pub(super) rd: f64,
    /// (q, d) with the deflation direction d; 0 without one.
    pub(super) qd: f64,
    /// The sums for the scaling of p to the least energy, if p is scaled.
    pub(super) energy: Option<Energy>,
}

impl StepSums {
    /// An upper bound on the 2-norm of the change of p: the sum of the norms of three changes, by the step along t, by the step along the deflation
    /// direction (`along_d`), and by the scaling.
    pub(super) fn change(&self, alpha: f64, along_d: f64, factor: f64) -> f64 {
        alpha.abs() * self.tt.sqrt() + along_d + (factor - 1.0).abs() * self.pp.sqrt()
    }
}

/// Sums over C for the energy of p + alpha t. Here d = approach - h, not the deflation direction: `pd` = (p, approach - h).
#[derive(Clone, Copy)]
pub(super) struct Energy {
    pub(super) pd: f64,
    pub(super) td: f64,
    pub(super) pu: f64,
    /// (p, q) + (t, u).
    pub(super) pq_tu: f64,
    pub(super) tq: f64,
}

impl Energy {
    /// Removes a part of t on one element of C from the sums: a deferred correction, which is in t for the product only. `depth` is approach - h.
    pub(super) fn leave_out(&mut self, correction: f64, (depth, u, q): (f64, f64, f64)) {
        self.td -= correction * depth;
        self.pq_tu -= correction * u;
        self.tq -= correction * q;
    }

    /// `(p, approach - h)` and `(p, u)` after a step of length alpha.
    pub(super) fn after(&self, alpha: f64) -> (f64, f64) {
        (self.pd + alpha * self.td, self.pu + alpha * (self.pq_tu + alpha * self.tq))
    }
}
