//! The guard against endless cycles of the active set.
//!
//! A violator is an element that has to leave or enter C. If all violators are exchanged at once, the iteration is fast but may cycle. Block
//! principal pivoting (Judice & Pires 1994; Kim & Park 2011) terminates for P-matrices: all violators are exchanged when their number is a new
//! minimum, and up to two times more after that. Then only the violator with the highest index is exchanged, until there is a new minimum. With
//! pressure limits and a prescribed force even block principal pivoting may cycle.

/// The number of full exchanges from a new minimum on, including the one at the minimum.
const FULL_EXCHANGES: u32 = 3;

/// Decides whether all violators may be exchanged, or only one.
#[derive(Clone, Copy, Debug)]
pub struct ExchangeGuard {
    /// The smallest number of violators so far.
    fewest: usize,
    /// The full exchanges that are left, including the current one.
    tries: u32,
}

impl Default for ExchangeGuard {
    fn default() -> ExchangeGuard {
        ExchangeGuard { fewest: usize::MAX, tries: FULL_EXCHANGES }
    }
}

impl ExchangeGuard {
    /// Whether all violators, of which there are `violators`, may be exchanged at once.
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
