//! What a call with friction returns, and what it starts from.

use contact_normal::ffi::contact_normal_report;

/// What a body carried before a step.
pub struct Before {
    pub q: Vec<[f64; 2]>,
    /// Of unlike bodies.
    pub p: Vec<f64>,
}

/// What a call returned.
pub struct Found {
    pub status: i32,
    pub message: String,
    pub p: Vec<f64>,
    /// Distances after deformation, and 1 in contact, 2 at a limit.
    pub e: Vec<f64>,
    pub contact: Vec<i32>,
    /// Displacements along the normal.
    pub u: Vec<f64>,
    pub q: Vec<[f64; 2]>,
    pub slip: Vec<[f64; 2]>,
    pub stick_slip: Vec<i32>,
    pub report: contact_normal_report,
    /// Callbacks after the one that cancelled, if one did.
    pub overrun: Option<u32>,
    /// Whether something was written.
    pub written: bool,
}

impl Found {
    /// Bits that have to be the same where the same is asked for twice.
    pub fn bits(&self) -> Vec<u64> {
        let vectors = self.q.iter().chain(&self.slip).flatten();
        let numbers = self.p.iter().chain(&self.u).chain(&self.e).chain(vectors).map(|value| value.to_bits());
        numbers.chain(self.stick_slip.iter().map(|&a| a as u64)).chain([self.status as u64]).collect()
    }
}
