//! Compression by the mean pressure: coefficients with a [constant](crate::influence::Kernel::constant), as those of coatings with two periods.
//!
//! A constant changes no pressure of a given force, but it hides their errors: residuals are relative to the approach. So a given force is
//! solved without the constant, which is added to the result. A given approach is solved with it.

use super::{Asked, InitialGuess, Options, Solver};
use crate::contact::{Fixed, Freshness, NonNegative, Survey};
use crate::error::Result;
use crate::progress::{Measures, Monitor, Outcome};
use crate::scene::Load;

/// Factor on the tolerance of a second solve.
const SAFETY: f64 = 0.5;

impl Solver {
    /// Takes the coefficients for a load: without the constant for a force.
    pub(super) fn suit(&mut self, load: Load) -> Result<()> {
        let wanted = matches!(load, Load::Force(_));
        let Some(compressible) = self.set_up.compressible.as_mut().filter(|of| of.is_without != Some(wanted)) else {
            return Ok(());
        };
        compressible.is_without = None;
        let all = compressible.coefficients.clone();
        let coefficients = if wanted { all.without_constant().unwrap_or(all) } else { all };
        self.methods.forget_operator();
        self.adhesion = None;
        self.state.u_is = Freshness::Stale;
        self.set_up.largest_influence = coefficients.largest(&self.problem.grid);
        self.problem.renew(coefficients)?;
        self.methods.renew(&self.problem)?;
        if let Some(compressible) = &mut self.set_up.compressible {
            compressible.is_without = Some(wanted);
        }
        Ok(())
    }

    /// For a given force: whether the tolerance is met with the compression added to the approach. If not, solves once more to a smaller
    /// residual. A negative compression lessens the norm of the distances `h - approach`, a positive one may dominate it.
    pub(super) fn meet_compressed(
        &mut self,
        asked: Asked<'_>,
        monitor: &mut Monitor<'_>,
        outcome: Outcome,
    ) -> Result<Outcome> {
        let Asked { scene, options, .. } = asked;
        let (by, goal) = (self.compression(scene.load), options.goal());
        if by == 0.0 || goal.by_update() {
            return Ok(outcome);
        }
        let (holds, part) = self.holds_compressed(by, options);
        match outcome {
            Outcome::Stagnated if holds => Ok(Outcome::Converged),
            Outcome::Converged if !holds => {
                let tolerance = SAFETY * part * options.tolerance;
                let more = Options { tolerance, initial_guess: InitialGuess::Previous, error_ratio: 0.0, ..*options };
                monitor.ledger.rows.pop();
                let (again, _) = self.solve_normal(Asked { options: &more, ..asked }, monitor)?;
                let is_met = again == Outcome::Stagnated && self.holds_compressed(by, options).0;
                Ok(if is_met { Outcome::Converged } else { again })
            }
            _ => Ok(outcome),
        }
    }

    /// Whether the criterion holds with the compression, and the ratio of the distances with and without it.
    pub(super) fn holds_compressed(&mut self, by: f64, options: &Options) -> (bool, f64) {
        let without = Survey::of(&self.state);
        self.state.approach += by;
        let with = Survey::of(&self.state);
        self.state.approach -= by;
        let work = (without.work.0, (without.work.1 + by * without.pressures).abs());
        let survey = Survey { distance: with.distance, scale: with.scale, work, ..without };
        let holds = match options.is_fixed() {
            true => options.goal().holds(&survey, 0.0, Fixed),
            false => options.goal().holds(&survey, 0.0, NonNegative),
        };
        (holds && self.state.carries(&self.problem.threads), with.distance / without.distance)
    }

    /// The compression by the mean pressure of a given force.
    pub(super) fn compression(&self, load: Load) -> f64 {
        match (&self.set_up.compressible, load) {
            (Some(of), Load::Force(force)) => of.by(force / self.problem.grid.element_area()),
            _ => 0.0,
        }
    }

    /// Adds the compression to the result of a given force: displacements, approach, and the approaches of the ledger. Returns the new
    /// measures; none without compression.
    pub(super) fn compress(&mut self, load: Load, monitor: &mut Monitor<'_>) -> Option<Measures> {
        let by = Some(self.compression(load)).filter(|by| *by != 0.0)?;
        self.state.u.iter_mut().for_each(|u| *u += by);
        self.state.approach += by;
        // A later solve begins without the compression.
        self.state.u_is = Freshness::Stale;
        monitor.ledger.rows.iter_mut().for_each(|row| row.measures.approach += by);
        let row = monitor.ledger.rows.last_mut()?;
        row.measures.certificate = Survey::of(&self.state).certificate();
        Some(row.measures)
    }
}
