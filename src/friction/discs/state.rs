//! Copies a problem and its state from the grid to the fields on C, and the state back.

use super::super::beside::{count_near, extension_on};
use super::super::disc::Units;
use super::super::plane::add;
use super::super::problem::{Problem, State};
use super::super::tangent::rho_of;
use super::super::unit::unit_of;
use super::fields::{Fields, FIELDS};
use super::Discs;
use crate::error::Result;
use crate::memory::unwritten;
use crate::methods::fields::over;
use crate::operator::fft::Real;

/// The name of this memory in messages.
const MEMORY: &str = "the iteration on discs";

impl<T: Real> Discs<T> {
    /// Allocates memory, chooses the units, and copies the problem and its state to the fields.
    pub fn load(&mut self, problem: &Problem, state: &State) -> Result<()> {
        let (places, all, threads) = (&problem.places, problem.grid.len(), problem.threads());
        unwritten(&mut self.fields, FIELDS * places.length(), f64::NAN, MEMORY, threads)?;
        for field in self.input.iter_mut().chain(&mut self.output) {
            unwritten(field, all, T::nan(), MEMORY, threads)?;
        }
        if self.extension.is_none() {
            self.extension = extension_on(&problem.grid, threads)?;
        }
        count_near(&mut self.extension, &problem.bound);
        let (a0, bound, slip) = (problem.operators.self_influence, problem.rms_bound(), problem.rms_slip());
        let largest_rho = 0.3 / (a0 * (problem.count().max(1) as f64).sqrt());
        let rho = rho_of((bound, slip), largest_rho);
        let (traction, unit) = (unit_of(bound.min(slip / a0)), problem.operators.unit());
        self.units = Units { traction, displacement: traction * unit, a0: a0 / unit, rho: rho * unit };
        let by = 1.0 / self.units.displacement;
        let [x, y] = &mut self.input;
        let input = places.cut_grid(x).zip(places.cut_grid(y));
        let blocks = places.parts().zip(places.cut(&mut self.fields, FIELDS)).zip(input);
        over(threads, blocks, |_, ((part, values), (x, y))| {
            values.fill(0.0);
            x.fill(T::zero());
            y.fill(T::zero());
            let Fields { bound, excess, slip: [wx, wy], .. } = &mut Fields::of(values);
            part.each(|i, k| {
                bound[k] = problem.bound[i] / traction;
                [wx[k], wy[k]] = add(problem.slip[i], problem.weighted(i, problem.offset)).map(|w| by * w);
            });
            if let Some(layer) = &problem.operators.excess {
                part.each(|i, k| excess[k] = layer.at(i) / unit);
            }
            []
        });
        self.copy_from(problem, state);
        Ok(())
    }

    /// Copies q and u of a state to the fields, and sets the deferred corrections to 0.
    pub fn copy_from(&mut self, problem: &Problem, state: &State) {
        let Units { traction, displacement, .. } = self.units;
        let (places, to_q, to_u) = (&problem.places, 1.0 / traction, 1.0 / displacement);
        let blocks = places.parts().zip(places.cut(&mut self.fields, FIELDS));
        over(problem.threads(), blocks, |_, (part, values)| {
            let Fields { q: [qx, qy], u: [ux, uy], deferred, .. } = &mut Fields::of(values);
            part.each(|i, k| {
                [qx[k], qy[k]] = state.q[i].map(|q| to_q * q);
                [ux[k], uy[k]] = state.u[i].map(|u| to_u * u);
            });
            deferred.iter_mut().for_each(|deferred| deferred.fill(0.0));
            []
        });
    }

    /// Copies q and u from the fields to a state.
    pub fn copy_to(&mut self, problem: &Problem, state: &mut State) {
        let Units { traction, displacement, .. } = self.units;
        let places = &problem.places;
        let states = places.cut_grid(&mut state.q).zip(places.cut_grid(&mut state.u));
        let blocks = places.parts().zip(places.cut(&mut self.fields, FIELDS)).zip(states);
        over(problem.threads(), blocks, |_, ((part, values), (to_q, to_u))| {
            let Fields { q: [qx, qy], u: [ux, uy], .. } = Fields::of(values);
            part.each(|i, k| {
                to_q[i - part.first()] = [qx[k], qy[k]].map(|q| traction * q);
                to_u[i - part.first()] = [ux[k], uy[k]].map(|u| displacement * u);
            });
            []
        });
    }
}
