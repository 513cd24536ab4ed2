//! The guard against cycles of the active set.
//!
//! Exchanging all violators at once is fast but may cycle. Block principal pivoting (Judice & Pires 1994; Kim & Park
//! 2011) terminates for P-matrices. All violators are exchanged when their number is a new minimum, and up to two times
//! more after it. Then only the violator of the highest index is exchanged, until there is a new minimum. With pressure
//! limits and a prescribed force even this may cycle.

/// Full exchanges from a new minimum on, including the one at the minimum.
const FULL_EXCHANGES: u32 = 3;

/// Decides whether all violators may be exchanged, or one.
#[derive(Clone, Copy, Debug)]
pub struct ExchangeGuard {
    fewest: usize,
    tries: u32,
}

impl Default for ExchangeGuard {
    fn default() -> ExchangeGuard {
        ExchangeGuard { fewest: usize::MAX, tries: FULL_EXCHANGES }
    }
}

impl ExchangeGuard {
    /// Whether all of `violators` may be exchanged at once.
    pub fn allows_all(&mut self, violators: usize) -> bool {
        if violators < self.fewest {
            self.fewest = violators;
            self.tries = FULL_EXCHANGES;
            return true;
        }
        self.tries = self.tries.saturating_sub(1);
        self.tries > 0
    }
}
