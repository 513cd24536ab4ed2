//! Where a solve starts from: nothing, the caller's guess, or the solution before.

use super::{ActiveSet, Guess, InitialGuess, Method, Options, Solver};
use crate::contact::{norm_of_distance, residual_norm};
use crate::error::{invalid, Error, Result};
use crate::grid::Grid;
use crate::progress::Monitor;
use crate::scene::{Load, Scene};

/// A guess whose residual is larger than this, relative to `h - approach` over C, is no guess: p = 0 has 1.
const WORSE_THAN_NONE: f64 = 1e3;

/// What the finest grid's state holds at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// No pressures.
    Nothing,
    /// The caller's.
    Given,
    /// The last solution.
    Previous,
}

impl Solver {
    /// Takes over the undeformed distance, the load and the initial guess: then u is A p, or there is nothing.
    pub(super) fn start(
        &mut self,
        scene: &Scene<'_>,
        options: &Options,
        guess: Option<Guess<'_>>,
        monitor: &mut Monitor<'_>,
    ) -> Result<Start> {
        let mut u_is_known = std::mem::take(&mut self.u_is_product);
        let fixed = options.active_set == ActiveSet::Fixed;
        let state = &mut self.states[0];
        // What was at the pressure limit was in contact.
        for (inside, at_limit) in state.contact.iter_mut().zip(state.at_limit.drain(..)) {
            *inside |= at_limit;
        }
        let from = match (options.initial_guess, guess) {
            (InitialGuess::Previous, Some(guess)) if fixed => {
                check_guess(guess, &state.grid)?;
                if !self.solved_before {
                    state.p.fill(0.0);
                    u_is_known = false;
                }
                state.contact.copy_from_slice(guess.contact);
                Start::Previous
            }
            (InitialGuess::Previous, _) if self.solved_before => Start::Previous,
            (InitialGuess::Previous, _) => Start::Nothing,
            (InitialGuess::Given, Some(guess)) => {
                check_guess(guess, &state.grid)?;
                state.p.copy_from_slice(guess.pressure);
                state.contact.copy_from_slice(guess.contact);
                u_is_known = false;
                Start::Given
            }
            (InitialGuess::Given, None) => {
                return invalid("initial_guess is GIVEN, but no pressures and contact area are".into())
            }
            (InitialGuess::None, Some(guess)) if fixed => {
                check_guess(guess, &state.grid)?;
                state.p.fill(0.0);
                state.contact.copy_from_slice(guess.contact);
                u_is_known = false;
                Start::Given
            }
            (InitialGuess::None, _) => Start::Nothing,
        };
        if fixed && from == Start::Nothing {
            return invalid("active_set is FIXED, but no contact area is given".into());
        }

        let state = &mut self.states[0];
        state.h.copy_from_slice(scene.undeformed_distance);
        state.load = scene.load;
        if let Load::Approach(approach) = scene.load {
            state.approach = approach;
        }
        if from == Start::Nothing {
            state.p.fill(0.0);
            state.u.fill(0.0);
            state.contact.fill(false);
            // The other methods begin on coarser grids.
            if matches!(options.method, Method::Norm | Method::Multigrid) {
                state.start(self.projected.influence().at(0, 0));
            }
            return Ok(Start::Nothing);
        }
        for i in 0..state.p.len() {
            state.contact[i] &= state.h[i].is_finite();
            if state.p[i] != 0.0 && (!state.contact[i] || (!fixed && state.p[i] < 0.0)) {
                state.p[i] = 0.0;
                u_is_known = false;
            }
        }
        if state.contact_count() == 0 {
            if fixed {
                return invalid("active_set is FIXED, but the given contact area is empty".into());
            }
            state.start(self.projected.influence().at(0, 0));
            return Ok(Start::Nothing);
        }
        match state.balance_force() {
            Some(1.0) if u_is_known => {}
            Some(factor) if u_is_known => state.u.iter_mut().for_each(|u| *u *= factor),
            _ => {
                self.projected.displace(&state.p, &mut state.u);
                monitor.count_products(1, 1.0);
            }
        }
        state.fit_approach();
        // A guess that is far worse than none costs time, or cannot be computed with.
        let (residual, distance) = (residual_norm(state), norm_of_distance(state));
        if residual.is_finite() && residual <= WORSE_THAN_NONE * distance {
            return Ok(from);
        }
        state.p.fill(0.0);
        state.u.fill(0.0);
        if !fixed {
            state.start(self.projected.influence().at(0, 0));
            return Ok(Start::Nothing);
        }
        if state.balance_force().is_none() {
            self.projected.displace(&state.p, &mut state.u);
            monitor.count_products(1, 1.0);
            state.fit_approach();
        }
        Ok(from)
    }
}

fn check_guess(guess: Guess<'_>, grid: &Grid) -> Result<()> {
    if guess.pressure.len() != grid.len() || guess.contact.len() != grid.len() {
        return invalid(format!(
            "the initial guess has {} pressures and {} contact elements; the grid has {} elements",
            guess.pressure.len(),
            guess.contact.len(),
            grid.len()
        ));
    }
    match guess.pressure.iter().find(|p| !p.is_finite()) {
        Some(p) => Err(Error::NotFinite(format!("pressure, the initial guess, holds {p}; it must be finite"))),
        None => Ok(()),
    }
}
