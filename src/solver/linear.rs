//! Linear problems of a solver: products A p with the caller's pressures, and the stiffness of a result.

use super::tangential_calls::finite;
use super::{ActiveSet, Asked, Guess, InitialGuess, Method, Options, Outcome, Solver};
use crate::contact::Survey;
use crate::error::{invalid, Error, Result};
use crate::memory::zeros;
use crate::progress::{Monitor, ProgressCallback};
use crate::scene::{Bodies, Load, Scene};
use crate::sums::in_blocks;

/// Relative residual at which the equations of a stiffness are solved.
const TOLERANCE: f64 = 1e-10;
/// Relative residual that suffices if round-off prevents [`TOLERANCE`].
const SUFFICIENT_RESIDUAL: f64 = 1e-6;

/// The stiffness of a result: dF/d approach, at fixed contact area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stiffness {
    /// The stiffness, a force per length.
    pub value: f64,
    /// Relative residual of the equations `A s = 1`, in 2-norms over the contact area. The relative error of `value` is about as large.
    pub residual: f64,
}

impl Solver {
    /// Computes `displacement = A pressure`, both `[my][mx]`, for pressures of any sign. A contains the effects of the set-up that change influence
    /// coefficients. The last result does not change.
    pub fn product(&mut self, pressure: &[f64], displacement: &mut [f64]) -> Result<()> {
        self.set_up.check_table()?;
        let grid = self.problem.grid;
        for (name, length) in [("pressure", pressure.len()), ("displacement", displacement.len())] {
            if length != grid.len() {
                return invalid(format!("{name} has {length} values; the grid has {} elements", grid.len()));
            }
        }
        finite(&grid, pressure)?;
        self.problem.displace(pressure, displacement)?;
        // The product must not count as one of the next solve.
        self.problem.take_products();
        if let Some(compressible) = self.set_up.compressible.as_ref().filter(|of| of.is_without == Some(true)) {
            let by = compressible.by(in_blocks(pressure.iter().copied()));
            displacement.iter_mut().for_each(|u| *u += by);
        }
        Ok(())
    }

    /// Computes dF/d approach of the last result: the sum of `s dx dy`, where `A s = 1` on the contact area. The contact area, the pressures at
    /// their limit and the tractions are held fixed, and so is the length of a time step of bodies that relax. The stiffness is 0 without contact.
    /// The outcome tells why a value could not be computed. The last result does not change. The first call sets up another solver of one thread,
    /// which is kept.
    pub fn stiffness(&mut self) -> Result<(Outcome, Stiffness)> {
        self.watched_stiffness(None)
    }

    /// [`stiffness`](Solver::stiffness) with a progress callback, which may cancel.
    pub(super) fn watched_stiffness(&mut self, progress: Option<ProgressCallback<'_>>) -> Result<(Outcome, Stiffness)> {
        if !self.has_result {
            return invalid("solver has no result: there was no solve, or the last one found none".into());
        }
        self.set_up.check_table()?;
        if self.split.is_some() {
            let message =
                "the last result is one of adhesion; its stiffness comes with it where adhesion->stiffness is 1";
            return Err(Error::Unsupported(message.into()));
        }
        if !self.state.contact.contains(&true) {
            return Ok((Outcome::Converged, Stiffness::default()));
        }
        if self.workers.is_empty() {
            self.workers.push(None);
        }
        if self.workers[0].is_none() {
            self.workers[0] = Some(self.worker()?);
        }
        let Solver { workers, state, set_up, .. } = self;
        let options = Options {
            method: Method::Auto,
            active_set: ActiveSet::Fixed,
            initial_guess: InitialGuess::None,
            tolerance: TOLERANCE,
            estimates: false,
            ..set_up.options
        };
        let (outcome, found) = match &mut workers[0] {
            Some(worker) => worker.stiffness_of(&state.contact, &options, progress)?,
            None => unreachable!("it was set up"),
        };
        Ok((outcome, Stiffness { value: found.value / self.compliance, ..found }))
    }

    /// Computes the stiffness of the contact area `contact`. The result of this solver is overwritten.
    fn stiffness_of(
        &mut self,
        contact: &[bool],
        options: &Options,
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<(Outcome, Stiffness)> {
        let (grid, self_influence) = (self.problem.grid, self.problem.self_influence());
        // The right-hand side is not 1 but a power of two near the self-influence, so that pressures are of order 1 in any units. Dividing by a power
        // of two is exact.
        let unit = if self_influence > 0.0 { self_influence.log2().floor().exp2() } else { 1.0 };
        let load = Load::Approach(unit);
        self.suit(load)?;
        if self.problem.coefficients.is_mean_free() && !contact.contains(&false) {
            let message = "contact is full, and with two periods no force changes the approach: there is no stiffness";
            return Err(Error::Infeasible(message.into()));
        }
        let h: Vec<f64> = zeros(grid.len(), "distances of a stiffness")?;
        let p: Vec<f64> = zeros(grid.len(), "pressures of a stiffness")?;
        let guess = Some(Guess { pressure: &p, contact });
        // Of this scene only grid, distance and load are read: the coefficients already contain the bodies and the effects.
        let scene = &Scene::new(grid, &h, Bodies::same(1.0, 0.0), load);
        let mut monitor = Monitor::new(progress, Vec::new(), false);
        let (outcome, _) = self.solve_normal(Asked { guess, ..Asked::new((scene, 0.0), options) }, &mut monitor)?;
        let sum = in_blocks(self.state.p.iter().copied());
        let residual = Survey::of(&self.state).certificate().residual;
        let stiffness = Stiffness { value: sum * grid.element_area() / unit, residual };
        let outcome = if residual <= SUFFICIENT_RESIDUAL { Outcome::Converged } else { outcome };
        Ok((outcome, stiffness))
    }
}
