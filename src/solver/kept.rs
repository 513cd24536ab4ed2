//! A copy of the last complete result. It is restored if a coupled problem is refused after the normal problem is solved, or if a pulling force has no
//! equilibrium. If coefficients turn out to be those of no elastic body, no result is left: a copy for each solve would allocate.

use super::Solver;
use crate::contact::State;
use crate::effects;
use crate::error::Result;
use crate::methods::projected_cg::Predictor;
use crate::progress::LedgerRow;
use crate::rectangle::Rectangle;
use crate::scene::Scene;

/// A copy of the last result, and of the state from which the next solve continues.
pub struct Kept {
    state: State,
    before: (Predictor, Option<Rectangle>),
    ledger: Vec<LedgerRow>,
}

impl Solver {
    /// A copy of the last result, for scenes that a solve may refuse. None for other scenes, and without a result.
    pub(super) fn kept(&self, scene: &Scene<'_>) -> Result<Option<Kept>> {
        let may_be_refused = effects::beside(scene).next().is_some() || scene.attraction().is_some();
        if !may_be_refused || !self.has_result {
            return Ok(None);
        }
        let state = self.state.copy(&self.problem.threads)?;
        Ok(Some(Kept { state, before: self.methods.projected_cg.last()?, ledger: self.ledger.clone() }))
    }

    /// Restores the last result. Without a copy the solver has no result.
    pub(super) fn go_back(&mut self, kept: Option<Kept>) {
        self.has_result = kept.is_some();
        if let Some(Kept { state, before, ledger }) = kept {
            (self.state, self.ledger) = (state, ledger);
            self.methods.projected_cg.go_back(before);
        }
    }
}
