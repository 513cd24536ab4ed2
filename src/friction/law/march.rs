//! A march visits all elements and computes the states of their particles after the step. In steady rolling it visits elements in the order in which
//! a particle passes them, from the leading edge on: the state before the step is that after the step on the element upstream. Otherwise the state
//! before the step is given.

use super::element::{Law, Particle, Place, Resolved};
use crate::effects::Motion;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::collected;

/// The elements of a grid, with the states of their particles before the step.
pub struct March {
    pub grid: Grid,
    pub law: Law,
    /// Pressure and coefficient of each element.
    places: Vec<Place>,
    /// The state of each element's particle before the step; in steady rolling that of a particle that has not entered the contact.
    before: Vec<Particle>,
    /// In steady rolling: the offset in x and y, in elements, to the place where a particle was one step before. None for other motions.
    upstream: Option<(isize, isize)>,
    /// The largest slope with which bounds fall with the slip, times an element's influence on itself.
    pub falls: f64,
    /// The largest slope with which bounds rise with the slip, times an element's influence on itself.
    pub rises: f64,
    /// The result of the last [`resolve`](March::resolve) for each element.
    resolved: Vec<Resolved>,
    /// During a march: the state after the step of the particle on each element, or its change.
    after: Vec<Particle>,
    /// During a march: whether the particle on each element has entered the contact.
    entered: Vec<bool>,
}

const WHAT: &str = "a law of friction";

impl March {
    /// Sets up the march over a grid. `by` is the step of rolling in elements, `before(k)` the state of the particle of element k before the step.
    pub fn new(
        (grid, law): (Grid, Law),
        motion: Motion,
        by: (f64, f64),
        place: impl Fn(usize) -> Place,
        before: impl Fn(usize) -> Particle,
    ) -> Result<March> {
        let n = grid.len();
        let has_upstream = motion == Motion::SteadyRolling && by.0.fract() == 0.0 && by.1.fract() == 0.0;
        Ok(March {
            grid,
            law,
            places: collected((0..n).map(place), WHAT)?,
            before: collected((0..n).map(before), WHAT)?,
            upstream: has_upstream.then_some((by.0 as isize, by.1 as isize)),
            falls: 0.0,
            rises: 0.0,
            resolved: collected((0..n).map(|_| Resolved::default()), WHAT)?,
            after: collected((0..n).map(|_| Particle::default()), WHAT)?,
            entered: collected((0..n).map(|_| false), WHAT)?,
        })
    }

    /// The result of the last [`resolve`](March::resolve) on an element.
    pub fn resolved(&self, k: usize) -> &Resolved {
        &self.resolved[k]
    }

    /// Makes a march. Calls `each(k, place, state of the particle before the step)` for each element. `each` returns the state after the step. In
    /// steady rolling a particle is fresh until it enters the contact, so that the result does not depend on where the grid begins.
    pub fn go(&mut self, mut each: impl FnMut(usize, Place, Particle) -> Particle) {
        let March { places, before, after, entered, .. } = self;
        in_order(&self.grid, self.upstream, |k, upstream| {
            let from = upstream.filter(|&j| entered[j]);
            after[k] = each(k, places[k], from.map_or(before[k], |j| after[j]));
            entered[k] = from.is_some() || places[k].pressure > 0.0 && places[k].coefficient > 0.0;
        });
    }

    /// Makes a march that finds the slip of each element k at which its bound plus rho times the slip is `traction(k)`. [`resolved`](March::resolved)
    /// then has the results.
    pub fn resolve(&mut self, rho: f64, traction: impl Fn(usize) -> f64) {
        let (mut resolved, law) = (std::mem::take(&mut self.resolved), self.law);
        self.go(|k, place, before| {
            let inside = if place.pressure > 0.0 { traction(k) } else { 0.0 };
            resolved[k] = law.resolve(inside, rho, place, before);
            resolved[k].response.particle
        });
        self.resolved = resolved;
    }

    /// Makes a march that is linearised at the last [`resolve`](March::resolve): calls `each(k, change of the bound)` for changes `traction(k)` of
    /// the tractions of slipping elements.
    pub fn change(&mut self, traction: impl Fn(usize) -> f64, mut each: impl FnMut(usize, f64)) {
        let March { resolved, after, entered, .. } = self;
        in_order(&self.grid, self.upstream, |k, upstream| {
            let before = upstream.filter(|&j| entered[j]).map_or(Particle::default(), |j| after[j]);
            let Resolved { slips, linear, .. } = &resolved[k];
            let changes = [if *slips { traction(k) } else { 0.0 }, before.coefficient, before.yield_limit];
            let [bound, coefficient, yield_limit] = linear.map(|by| (0..3).map(|m| by[m] * changes[m]).sum());
            after[k] = Particle { coefficient, yield_limit };
            each(k, bound);
        });
    }
}

/// Calls `each(k, the element upstream)` for each element, upstream elements first. The element upstream is none if it is not on the grid, or if
/// `upstream` is none.
fn in_order(grid: &Grid, upstream: Option<(isize, isize)>, mut each: impl FnMut(usize, Option<usize>)) {
    let Grid { mx, my, .. } = *grid;
    let (x, y) = upstream.unwrap_or_default();
    let place = |k: usize, m: usize, towards: isize| if towards > 0 { m - 1 - k } else { k };
    for row in 0..my {
        let iy = place(row, my, y);
        for column in 0..mx {
            let ix = place(column, mx, x);
            let (jx, jy) = (ix.wrapping_add_signed(x), iy.wrapping_add_signed(y));
            let is_there = upstream.is_some() && jx < mx && jy < my;
            each(iy * mx + ix, is_there.then(|| jy * mx + jx));
        }
    }
}
