//! Sums over C of a step, and the update of u.

/// The update of u: factor (u + alpha q + gamma w + A d). w is the product of the deflation direction.
#[derive(Clone, Copy)]
pub(super) struct Update {
    pub(super) alpha: f64,
    pub(super) gamma: f64,
    /// Whether z holds A d.
    pub(super) is_corrected: bool,
    pub(super) factor: f64,
}

impl Default for Update {
    fn default() -> Update {
        Update { alpha: 0.0, gamma: 0.0, is_corrected: false, factor: 1.0 }
    }
}

/// Sums over C: (r, t), (t, q), (t, t), the sum of |t|, (p, p); and (r, d), (q, d), 0 without a deflation direction.
pub(super) struct StepSums {
    pub(super) rt: f64,
    pub(super) tq: f64,
    pub(super) tt: f64,
    pub(super) t1: f64,
    pub(super) pp: f64,
    pub(super) rd: f64,
    pub(super) qd: f64,
    pub(super) energy: Option<Energy>,
}

impl StepSums {
    /// An upper bound on the 2-norm of the change of p. It is the sum of three changes: by the step along t, by the
    /// step along d (`along_d`), and by the scaling.
    pub(super) fn change(&self, alpha: f64, along_d: f64, factor: f64) -> f64 {
        alpha.abs() * self.tt.sqrt() + along_d + (factor - 1.0).abs() * self.pp.sqrt()
    }
}

/// Sums over C for the energy of p + alpha t: (p, d), (t, d), d = approach - h, (p, u), (p, q) + (t, u), (t, q).
#[derive(Clone, Copy)]
pub(super) struct Energy {
    pub(super) pd: f64,
    pub(super) td: f64,
    pub(super) pu: f64,
    pub(super) pq_tu: f64,
    pub(super) tq: f64,
}

impl Energy {
    /// Subtracts a correction in t on an element of C, which is no part of the step.
    pub(super) fn leave_out(&mut self, correction: f64, (depth, u, q): (f64, f64, f64)) {
        self.td -= correction * depth;
        self.pq_tu -= correction * u;
        self.tq -= correction * q;
    }

    /// `(p, d)` and `(p, u)` after a step of length alpha.
    pub(super) fn after(&self, alpha: f64) -> (f64, f64) {
        (self.pd + alpha * self.td, self.pu + alpha * (self.pq_tu + alpha * self.tq))
    }
}
