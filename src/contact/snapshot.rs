//! A copy of a state's pressures, contact area and approach.

use super::State;
use crate::error::Result;
use crate::memory::{self, reserve};

/// A copy of p, C, the elements at their limit, and the approach of a state. u is not copied: whoever restores the state computes A p anew, or
/// keeps u elsewhere.
#[derive(Default)]
pub struct Snapshot {
    p: Vec<f64>,
    contact: Vec<bool>,
    at_limit: Vec<bool>,
    approach: f64,
}

impl Snapshot {
    /// Allocates memory for a copy of `state`. `what` names this memory in messages.
    pub fn reserve(&mut self, state: &State, what: &str) -> Result<()> {
        reserve(&mut self.p, state.p.len(), what)?;
        reserve(&mut self.contact, state.p.len(), what)?;
        Ok(reserve(&mut self.at_limit, state.at_limit.len(), what)?)
    }

    /// Copies p, C, the elements at their limit and the approach of `state` into this snapshot.
    pub fn copy_from(&mut self, state: &State) {
        self.p.clone_from(&state.p);
        self.contact.clone_from(&state.contact);
        self.at_limit.clone_from(&state.at_limit);
        self.approach = state.approach;
    }

    /// Sets `state` to this snapshot, except for u and `u_is`.
    pub fn restore_to(&self, state: &mut State) {
        state.p.copy_from_slice(&self.p);
        state.contact.copy_from_slice(&self.contact);
        state.at_limit.copy_from_slice(&self.at_limit);
        state.approach = self.approach;
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.p.len() * (size_of::<f64>() + 2 * size_of::<bool>())
    }
}

impl Drop for Snapshot {
    fn drop(&mut self) {
        memory::keep([&mut self.p]);
        memory::keep([&mut self.contact, &mut self.at_limit]);
    }
}
