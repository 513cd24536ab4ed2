//! A copy of the last complete result, made before a solve that may be refused when the result is already overwritten. This happens in two cases: a
//! coupled problem is refused after the normal problem is solved, or a tensile force has no equilibrium with adhesion. Other scenes get no copy, as
//! it takes memory in each solve. If their coefficients turn out to be indefinite, the solver has no result afterwards.

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
    /// What PROJECTED_CG extrapolates the next start from, and its window.
    continuation: (Predictor, Option<Rectangle>),
    ledger: Vec<LedgerRow>,
}

impl Solver {
    /// Copies the last result if a solve of `scene` may be refused late. None for other scenes, and without a result.
    pub(super) fn kept(&self, scene: &Scene<'_>) -> Result<Option<Kept>> {
        let may_be_refused = effects::beside(scene).next().is_some() || scene.attraction().is_some();
        if !may_be_refused || !self.has_result {
            return Ok(None);
        }
        let state = self.state.copy(&self.problem.threads)?;
        Ok(Some(Kept { state, continuation: self.methods.projected_cg.last()?, ledger: self.ledger.clone() }))
    }

    /// Restores the last result from its copy. Without a copy the solver has no result afterwards.
    pub(super) fn go_back(&mut self, kept: Option<Kept>) {
        self.has_result = kept.is_some();
        if let Some(Kept { state, continuation, ledger }) = kept {
            (self.state, self.ledger) = (state, ledger);
            self.methods.projected_cg.go_back(continuation);
        }
    }
}
