//! The results of a call with friction, and the loads on the bodies before its step.

use contact_normal::ffi::contact_normal_report;

/// The loads on the bodies before a step.
pub struct Before {
    /// The tractions of the elements.
    pub q: Vec<[f64; 2]>,
    /// The pressures of the elements. Only with unlike bodies do they have an effect.
    pub p: Vec<f64>,
}

/// The results of a call.
pub struct Found {
    pub status: i32,
    pub message: String,
    /// Pressures.
    pub p: Vec<f64>,
    /// Deformed distances.
    pub e: Vec<f64>,
    /// 0: exterior, 1: in contact, 2: at a pressure limit.
    pub contact: Vec<i32>,
    /// Displacements along the normal.
    pub u: Vec<f64>,
    /// Tractions.
    pub q: Vec<[f64; 2]>,
    pub slip: Vec<[f64; 2]>,
    /// 0: exterior, 1: stick, 2: slip.
    pub stick_slip: Vec<i32>,
    pub report: contact_normal_report,
    /// The number of callbacks after the one that cancelled, if one did.
    pub overrun: Option<u32>,
    /// Whether the call wrote any output.
    pub written: bool,
}

impl Found {
    /// The bits of the status and of the fields, which must be the same for equal calls.
    pub fn bits(&self) -> Vec<u64> {
        let vectors = self.q.iter().chain(&self.slip).flatten();
        let numbers = self.p.iter().chain(&self.u).chain(&self.e).chain(vectors).map(|value| value.to_bits());
        numbers.chain(self.stick_slip.iter().map(|&a| a as u64)).chain([self.status as u64]).collect()
    }
}
