//! The guard against cycles of the active set.
//!
//! Exchanging all violators at once is fast but may cycle. Block principal pivoting (Judice & Pires 1994; Kim & Park 2011)
//! terminates for P-matrices. All violators are exchanged while their number reaches new minima, with up to three tries in
//! between. After that only the violator of the highest index is exchanged, until there is a new minimum. With limits of pressures and a
//! prescribed force it may cycle all the same.

/// Full exchanges allowed without a new minimum.
const TRIES: u32 = 3;

/// Decides whether all violators may be exchanged, or one.
#[derive(Clone, Copy, Debug)]
pub struct ExchangeGuard {
    fewest: usize,
    tries: u32,
}

impl Default for ExchangeGuard {
    fn default() -> ExchangeGuard {
        ExchangeGuard { fewest: usize::MAX, tries: TRIES }
    }
}

impl ExchangeGuard {
    /// Whether all of `violators` may be exchanged at once.
    pub fn allows_all(&mut self, violators: usize) -> bool {
        if violators < self.fewest {
            self.fewest = violators;
            self.tries = TRIES;
            return true;
        }
        self.tries = self.tries.saturating_sub(1);
        self.tries > 0
    }
}
