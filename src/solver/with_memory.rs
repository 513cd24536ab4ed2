//! Steps of bodies with memory: see [`Memory`].

use super::{Asked, Outcome, ProgressCallback, Report, Solver};
use crate::contact::{lowest, Freshness};
use crate::effects::Memory;
use crate::error::Result;
use crate::memory::zeros;
use crate::scene::{Load, Scene};

impl Solver {
    /// Solves a step of a checked scene as a problem of scaled lengths; `k`: the effect. A step that is refused or fails leaves the memory of
    /// the bodies unchanged. A step that stops early, by a limit or a callback, is a step of that memory.
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
        let (history, distance) = remembered.split_at_mut(scene.grid.len());
        memory.fill(&self.beside.histories[k], history);
        for ((distance, h), history) in distance.iter_mut().zip(scene.undeformed_distance).zip(&*history) {
            *distance = (h + history) / s;
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
            for (i, history) in history.iter().enumerate() {
                state.u[i] += history;
                state.h[i] = s * state.h[i] - history;
            }
            state.u_is = Freshness::Stale;
            state.load = scene.load;
            self.compliance = s;
            (outcome, report)
        });
        self.remembered = remembered;
        solved
    }

    /// Scales the lengths of the result, the report and the ledger from those of the problem solved.
    fn lengthen(&mut self, s: f64, load: Load, report: &mut Report) {
        let state = &mut self.state;
        state.u.iter_mut().for_each(|u| *u *= s);
        state.approach *= s;
        if let Load::Approach(approach) = load {
            state.approach = approach;
        }
        let approach = state.approach;
        // With a given force the error is that of the approach.
        let of_found = if matches!(load, Load::Force(_)) { s } else { 1.0 };
        for row in &mut self.ledger {
            row.measures.approach *= s;
            row.measures.certificate.violation *= s;
            row.error.force = row.error.force.map(|error| error * of_found);
        }
        report.measures.approach = approach;
        report.measures.certificate.violation *= s;
        report.error.force = report.error.force.map(|error| error * of_found);
        report.halving.error = report.halving.error.map(|error| error.times(of_found));
    }
}
