//! What a call with friction returns.

use contact_normal::ffi::contact_normal_report;

/// What a call returned.
pub struct Found {
    pub status: i32,
    pub message: String,
    pub p: Vec<f64>,
    /// Displacements along the normal.
    pub u: Vec<f64>,
    pub q: Vec<[f64; 2]>,
    pub slip: Vec<[f64; 2]>,
    pub adhesion: Vec<i32>,
    pub report: contact_normal_report,
    /// Whether something was written.
    pub written: bool,
}

impl Found {
    /// Bits that have to be the same where the same is asked for twice.
    pub fn bits(&self) -> Vec<u64> {
        let vectors = self.q.iter().chain(&self.slip).flatten();
        let numbers = self.p.iter().chain(&self.u).chain(vectors).map(|value| value.to_bits());
        numbers.chain(self.adhesion.iter().map(|&a| a as u64)).chain([self.status as u64]).collect()
    }
}
