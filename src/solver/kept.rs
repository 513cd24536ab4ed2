//! The last complete result, copied, to go back to: friction may refuse a scene when its normal problem is solved already.

use super::Solver;
use crate::contact::State;
use crate::effects::Previous;
use crate::error::{invalid, Result};
use crate::methods::projected_cg::{Predictor, Window};
use crate::progress::LedgerRow;
use crate::scene::Scene;

/// A copy of the last result, and of what a step in time goes on from.
pub struct Kept {
    state: State,
    before: (Predictor, Option<Window>),
    ledger: Vec<LedgerRow>,
}

impl Solver {
    /// Refuses friction that continues from tractions that are not there.
    pub(super) fn check_continues(&self, scene: &Scene<'_>) -> Result<()> {
        let continues = scene.friction.as_ref().is_some_and(|friction| friction.previous == Previous::Kept);
        if continues && self.friction().is_none() {
            return invalid("friction continues, but this solver holds no tractions yet".into());
        }
        Ok(())
    }

    /// A copy of the last result, for scenes with friction.
    pub(super) fn kept(&self, scene: &Scene<'_>) -> Result<Option<Kept>> {
        if scene.friction.is_none() || !self.has_result {
            return Ok(None);
        }
        let state = self.state.copy(&self.problem.threads)?;
        Ok(Some(Kept { state, before: self.methods.projected_cg.last()?, ledger: self.ledger.clone() }))
    }

    /// There is the last result again; without one there is none.
    pub(super) fn go_back(&mut self, kept: Option<Kept>) {
        self.has_result = kept.is_some();
        if let Some(Kept { state, before, ledger }) = kept {
            (self.state, self.ledger) = (state, ledger);
            self.methods.projected_cg.go_back(before);
        }
    }
}
