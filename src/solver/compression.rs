//! Compression by the mean pressure. Some influence coefficients contain a [constant](crate::influence::Kernel::constant), for example those of
//! coatings with two periods: it displaces all elements by the same length, the compression.
//!
//! If the force is given, the compression changes no pressure. But residuals are relative to `h - approach`, so a large compression would hide errors
//! of the pressures. Therefore a given force is solved without the constant, and the compression is added to the result. A given approach is
//! solved with the constant.

use super::{Asked, InitialGuess, Options, Solver};
use crate::contact::{Fixed, Freshness, NonNegative, Survey};
use crate::error::Result;
use crate::progress::{Measures, Monitor, Outcome};
use crate::scene::Load;

/// Factor on the tolerance of a second solve, so that it surely meets the tolerance with the compression.
const SAFETY: f64 = 0.5;

impl Solver {
    /// Sets up the operators with the coefficients for a load: without the constant for a force, with it for an approach. Does nothing if they are in
    /// use already.
    pub(super) fn suit(&mut self, load: Load) -> Result<()> {
        let without = matches!(load, Load::Force(_));
        let Some(compressible) = self.set_up.compressible.as_mut().filter(|of| of.is_without != Some(without)) else {
            return Ok(());
        };
        compressible.is_without = None;
        let all = compressible.coefficients.clone();
        let coefficients = if without { all.without_constant().unwrap_or(all) } else { all };
        self.methods.forget_operator();
        self.adhesion = None;
        self.state.u_is = Freshness::Stale;
        self.set_up.largest_influence = coefficients.largest(&self.problem.grid);
        self.problem.renew(coefficients)?;
        self.methods.renew(&self.problem)?;
        if let Some(compressible) = &mut self.set_up.compressible {
            compressible.is_without = Some(without);
        }
        Ok(())
    }

    /// For a given force, solved without the constant and ended with `outcome`: judges the criterion with the compression added to the approach. If a
    /// converged solve does not meet it, solves once more to a smaller residual: a negative compression reduces the norm of `h - approach`, to which
    /// residuals are relative. If a stagnated solve meets it, the outcome is Converged: a positive compression may dominate that norm.
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
        let (holds, ratio) = self.holds_compressed(by, options);
        match outcome {
            Outcome::Stagnated if holds => Ok(Outcome::Converged),
            Outcome::Converged if !holds => {
                let tolerance = SAFETY * ratio * options.tolerance;
                let more = Options { tolerance, initial_guess: InitialGuess::Previous, error_ratio: 0.0, ..*options };
                monitor.ledger.rows.pop();
                let (again, _) = self.solve_normal(Asked { options: &more, ..asked }, monitor)?;
                let is_met = again == Outcome::Stagnated && self.holds_compressed(by, options).0;
                Ok(if is_met { Outcome::Converged } else { again })
            }
            _ => Ok(outcome),
        }
    }

    /// Whether the criterion holds with the compression `by`, and the ratio of the norms of `h - approach` with and without it.
    pub(super) fn holds_compressed(&mut self, by: f64, options: &Options) -> (bool, f64) {
        let without = Survey::of(&self.state);
        self.state.approach += by;
        let with = Survey::of(&self.state);
        self.state.approach -= by;
        let (of_gaps, of_displacements) = without.work;
        let work = (of_gaps, (of_displacements + by * without.pressures).abs());
        let survey = Survey { distance: with.distance, scale: with.scale, work, ..without };
        let holds = match options.is_fixed() {
            true => options.goal().holds(&survey, 0.0, Fixed),
            false => options.goal().holds(&survey, 0.0, NonNegative),
        };
        (holds && self.state.carries(&self.problem.threads), with.distance / without.distance)
    }

    /// The compression by the mean pressure of a given force; 0 for a given approach, or without a constant.
    pub(super) fn compression(&self, load: Load) -> f64 {
        match (&self.set_up.compressible, load) {
            (Some(of), Load::Force(force)) => of.by(force / self.problem.grid.element_area()),
            _ => 0.0,
        }
    }

    /// Adds the compression to the result of a given force: to the displacements, to the approach, and to the approaches of the ledger. Returns the
    /// measures of the last row with the compression; None if there is none.
    pub(super) fn compress(&mut self, load: Load, monitor: &mut Monitor<'_>) -> Option<Measures> {
        let by = Some(self.compression(load)).filter(|by| *by != 0.0)?;
        self.state.u.iter_mut().for_each(|u| *u += by);
        self.state.approach += by;
        // A later solve of a given force starts without the compression, so it must not reuse this u.
        self.state.u_is = Freshness::Stale;
        monitor.ledger.rows.iter_mut().for_each(|row| row.measures.approach += by);
        let row = monitor.ledger.rows.last_mut()?;
        row.measures.certificate = Survey::of(&self.state).certificate();
        Some(row.measures)
    }
}
