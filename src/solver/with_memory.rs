//! Time steps of visco-elastic bodies. A step is a normal problem of elastic bodies in scaled lengths: see [`Memory`], which defines s and H.

use super::{Asked, Outcome, ProgressCallback, Report, Solver};
use crate::contact::{lowest, Freshness};
use crate::effects::Memory;
use crate::error::Result;
use crate::memory::zeros;
use crate::scene::{Load, Scene};

impl Solver {
    /// Solves a step of a checked scene, with the memory of effect number `k`. If the step is refused or fails, the history of the bodies does not
    /// change. A step that ends early, by a limit or by the callback, is added to the history.
    pub(super) fn solve_with_memory(
        &mut self,
        asked: Asked<'_>,
        (k, memory): (usize, &dyn Memory),
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<(Outcome, Report)> {
        let scene = asked.scene;
        self.check_continues(scene)?;
        let s = memory.compliance();
        let mut remembered = std::mem::take(&mut self.remembered);
        if remembered.is_empty() {
            remembered = zeros(2 * scene.grid.len(), "what bodies remember")?;
        }
        // H of each element, and (h + H)/s.
        let (from_history, distance) = remembered.split_at_mut(scene.grid.len());
        memory.fill(&self.beside.histories[k], from_history);
        for ((distance, h), from_history) in distance.iter_mut().zip(scene.undeformed_distance).zip(&*from_history) {
            *distance = (h + from_history) / s;
        }
        let load = match scene.load {
            Load::Approach(approach) => Load::Approach(approach / s),
            force => force,
        };
        let step = Scene { undeformed_distance: distance, load, ..scene.clone() };
        let solved = self.solve_at_once(Asked { scene: &step, lowest: lowest(distance), ..asked }, progress);
        let solved = solved.map(|(outcome, mut report)| {
            report.visco = Some(memory.step_done(&mut self.beside.histories[k], &self.state));
            self.lengthen(s, scene.load, &mut report);
            let state = &mut self.state;
            // Back from the scaled problem: u = s A p + H, and h is that of the scene.
            for (i, from_history) in from_history.iter().enumerate() {
                state.u[i] += from_history;
                state.h[i] = s * state.h[i] - from_history;
            }
            state.u_is = Freshness::Stale;
            state.load = scene.load;
            self.compliance = s;
            (outcome, report)
        });
        self.remembered = remembered;
        solved
    }

    /// Multiplies the lengths of result, report and ledger by s: from the scaled problem back to the scene.
    fn lengthen(&mut self, s: f64, load: Load, report: &mut Report) {
        let state = &mut self.state;
        state.u.iter_mut().for_each(|u| *u *= s);
        state.approach *= s;
        if let Load::Approach(approach) = load {
            state.approach = approach;
        }
        let approach = state.approach;
        // With a given force `error.force` is the error of the approach, a length.
        let factor = if matches!(load, Load::Force(_)) { s } else { 1.0 };
        for row in &mut self.ledger {
            row.measures.approach *= s;
            row.measures.certificate.violation *= s;
            row.error.force = row.error.force.map(|error| error * factor);
        }
        report.measures.approach = approach;
        report.measures.certificate.violation *= s;
        report.error.force = report.error.force.map(|error| error * factor);
        report.halving.error = report.halving.error.map(|error| error.times(factor));
    }
}
