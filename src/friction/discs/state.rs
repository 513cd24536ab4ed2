//! What passes between the fields on C and a state on the grid.

use super::super::beside::{count_near, extension_on};
use super::super::disc::Units;
use super::super::plane::add;
use super::super::problem::{Problem, State};
use super::super::tangent::rho_of;
use super::super::unit::unit_of;
use super::super::vectors::over;
use super::{Discs, Way};
use crate::error::Result;
use crate::memory::unwritten;
use crate::operator::fft::Real;

/// What memory is for.
const FIELDS: &str = "the iteration on discs";

impl<T: Real> Discs<T> {
    /// Takes a state over.
    pub fn load(&mut self, problem: &Problem, state: &State) -> Result<()> {
        let (n, all) = (problem.count(), problem.grid.len());
        let (zero, nothing) = ([f64::NAN; 2], [T::nan(); 2]);
        unwritten(&mut self.bound, n, f64::NAN, FIELDS, problem.threads())?;
        unwritten(&mut self.curvature, n, T::nan(), FIELDS, problem.threads())?;
        for field in [&mut self.slip, &mut self.q, &mut self.u, &mut self.normal] {
            unwritten(field, n, zero, FIELDS, problem.threads())?;
        }
        let Way { z, direction, chord, product, deferred } = &mut self.way;
        for field in [&mut self.projected, z, direction, chord, product, deferred] {
            unwritten(field, n, nothing, FIELDS, problem.threads())?;
        }
        for field in [&mut self.given, &mut self.answer] {
            unwritten(field, all, nothing, FIELDS, problem.threads())?;
        }
        // What a layer is beyond its least compliance; none: it is uniform.
        let beyond = if problem.operators.excess.is_some() { n } else { 0 };
        unwritten(&mut self.excess, beyond, f64::NAN, FIELDS, problem.threads())?;
        if self.extension.is_none() {
            self.extension = extension_on(&problem.grid, problem.threads())?;
        }
        count_near(&mut self.extension, &problem.bound);
        let (a0, bound, slip) = (problem.operators.self_influence, problem.rms_bound(), problem.rms_slip());
        let cap = 0.3 / (a0 * (n.max(1) as f64).sqrt());
        let rho = rho_of((bound, slip), cap);
        let (traction, unit) = (unit_of(bound.min(slip / a0)), problem.operators.unit());
        self.units = Units { traction, displacement: traction * unit, a0: a0 / unit, rho: rho * unit };
        if let Some(excess) = &problem.operators.excess {
            self.excess.iter_mut().zip(problem.contact()).for_each(|(to, i)| *to = excess.at(i) / unit);
        }
        let by = 1.0 / self.units.displacement;
        let places = &problem.places;
        let Way { direction, chord, product, .. } = &mut self.way;
        let ways = places.cut(direction).zip(places.cut(chord)).zip(places.cut(product));
        let blocks = places.parts().zip(places.cut(&mut self.bound)).zip(places.cut(&mut self.slip)).zip(ways);
        over(problem.threads(), blocks, |_, (((part, bound), slip), ((direction, chord), product))| {
            for ((i, g), w) in part.on_grid().zip(bound.iter_mut()).zip(slip.iter_mut()) {
                *g = problem.bound[i] / traction;
                *w = add(problem.slip[i], problem.weighted(i, problem.offset)).map(|w| by * w);
            }
            for field in [direction, chord, product] {
                field.fill([T::zero(); 2]);
            }
            []
        });
        self.take(problem, state);
        Ok(())
    }

    /// q and u of a state; no correction is deferred.
    pub fn take(&mut self, problem: &Problem, state: &State) {
        let Units { traction, displacement, .. } = self.units;
        let (places, to_q, to_u) = (&problem.places, 1.0 / traction, 1.0 / displacement);
        let states = places.cut(&mut self.q).zip(places.cut(&mut self.u));
        let blocks = places.parts().zip(states).zip(places.cut(&mut self.way.deferred));
        over(problem.threads(), blocks, |_, ((part, (q, u)), deferred)| {
            for ((i, q), u) in part.on_grid().zip(q.iter_mut()).zip(u.iter_mut()) {
                *q = state.q[i].map(|q| to_q * q);
                *u = state.u[i].map(|u| to_u * u);
            }
            deferred.fill([T::zero(); 2]);
            []
        });
    }

    /// q and u for a state.
    pub fn give(&self, problem: &Problem, state: &mut State) {
        let Units { traction, displacement, .. } = self.units;
        let places = &problem.places;
        let blocks = places.parts().zip(places.cut_grid(&mut state.q).zip(places.cut_grid(&mut state.u)));
        over(problem.threads(), blocks, |_, (part, (to_q, to_u))| {
            for (k, i) in (part.start..).zip(part.in_rows()) {
                to_q[i] = self.q[k].map(|q| traction * q);
                to_u[i] = self.u[k].map(|u| displacement * u);
            }
            []
        });
    }
}
