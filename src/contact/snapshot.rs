//! A copy of the result of a state, to restore it.

use super::State;
use crate::error::Result;
use crate::memory::{keep, reserve};

/// A copy of the result of a state without u, to restore it.
#[derive(Default)]
pub struct Snapshot {
    p: Vec<f64>,
    contact: Vec<bool>,
    at_limit: Vec<bool>,
    approach: f64,
}

impl Snapshot {
    /// Memory for a state; `what`: its name in messages.
    pub fn reserve(&mut self, state: &State, what: &str) -> Result<()> {
        reserve(&mut self.p, state.p.len(), what)?;
        reserve(&mut self.contact, state.p.len(), what)?;
        Ok(reserve(&mut self.at_limit, state.at_limit.len(), what)?)
    }

    /// Copies the result of a state.
    pub fn keep(&mut self, state: &State) {
        self.p.clone_from(&state.p);
        self.contact.clone_from(&state.contact);
        self.at_limit.clone_from(&state.at_limit);
        self.approach = state.approach;
    }

    /// Restores the kept result, but not u.
    pub fn give_back(&self, state: &mut State) {
        state.p.copy_from_slice(&self.p);
        state.contact.copy_from_slice(&self.contact);
        state.at_limit.copy_from_slice(&self.at_limit);
        state.approach = self.approach;
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.p.len() * (size_of::<f64>() + size_of::<bool>())
    }
}

impl Drop for Snapshot {
    fn drop(&mut self) {
        keep([&mut self.p]);
        keep([&mut self.contact, &mut self.at_limit]);
    }
}
