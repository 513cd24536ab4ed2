//! The state of the particles, from element to element: in steady rolling from the leading edge on, else from the step before.

use super::element::{Law, Particle, Place, Resolved};
use crate::effects::Motion;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::collected;

/// The particles of a grid and their states.
pub struct March {
    pub grid: Grid,
    pub law: Law,
    places: Vec<Place>,
    /// The state of each element's particle: before the step, or fresh.
    had: Vec<Particle>,
    /// In steady rolling with memory: the elements between a particle's place and the one a step before, upstream.
    upstream: Option<(isize, isize)>,
    /// The largest slopes with which bounds fall and rise with the slip, times an element's influence on itself.
    pub falls: f64,
    pub rises: f64,
    /// The result of the last [`resolve`](March::resolve) on each element.
    resolved: Vec<Resolved>,
    /// The state of each particle during a march.
    carries: Vec<Particle>,
    /// Whether each particle has entered the contact, during a march.
    entered: Vec<bool>,
}

const WHAT: &str = "a law of friction";

impl March {
    /// The particles of elements with their states before the step.
    pub fn new(
        (grid, law): (Grid, Law),
        motion: Motion,
        by: (f64, f64),
        place: impl Fn(usize) -> Place,
        had: impl Fn(usize) -> Particle,
    ) -> Result<March> {
        let n = grid.len();
        let has_upstream = motion == Motion::SteadyRolling && by.0.fract() == 0.0 && by.1.fract() == 0.0;
        Ok(March {
            grid,
            law,
            places: collected((0..n).map(place), WHAT)?,
            had: collected((0..n).map(had), WHAT)?,
            upstream: has_upstream.then_some((by.0 as isize, by.1 as isize)),
            falls: 0.0,
            rises: 0.0,
            resolved: collected((0..n).map(|_| Resolved::default()), WHAT)?,
            carries: collected((0..n).map(|_| Particle::default()), WHAT)?,
            entered: collected((0..n).map(|_| false), WHAT)?,
        })
    }

    /// The result of the last [`resolve`](March::resolve) on an element.
    pub fn resolved(&self, k: usize) -> &Resolved {
        &self.resolved[k]
    }

    /// Calls `each(k, place, state before)` in the order in which particles pass; it returns the state afterwards. In steady rolling particles are
    /// fresh until they enter the contact, wherever the grid begins.
    pub fn go(&mut self, mut each: impl FnMut(usize, Place, Particle) -> Particle) {
        let March { places, had, carries, entered, .. } = self;
        in_order(&self.grid, self.upstream, |k, upstream| {
            let from = upstream.filter(|&j| entered[j]);
            carries[k] = each(k, places[k], from.map_or(had[k], |j| carries[j]));
            entered[k] = from.is_some() || places[k].pressure > 0.0 && places[k].coefficient > 0.0;
        });
    }

    /// Finds the slips at which the bound plus rho times the slip is `traction(k)`.
    pub fn resolve(&mut self, rho: f64, traction: impl Fn(usize) -> f64) {
        let (mut resolved, law) = (std::mem::take(&mut self.resolved), self.law);
        self.go(|k, place, had| {
            let inside = if place.pressure > 0.0 { traction(k) } else { 0.0 };
            resolved[k] = law.resolve(inside, rho, place, had);
            resolved[k].response.particle
        });
        self.resolved = resolved;
    }

    /// Calls `each(k, change of the bound)` for changes `traction(k)` of tractions on slip, linearised at the last resolved state.
    pub fn change(&mut self, traction: impl Fn(usize) -> f64, mut each: impl FnMut(usize, f64)) {
        let March { resolved, carries, entered, .. } = self;
        in_order(&self.grid, self.upstream, |k, upstream| {
            let had = upstream.filter(|&j| entered[j]).map_or(Particle::default(), |j| carries[j]);
            let Resolved { slips, linear, .. } = &resolved[k];
            let gains = [if *slips { traction(k) } else { 0.0 }, had.coefficient, had.yield_limit];
            let [bound, coefficient, yield_limit] = linear.map(|by| (0..3).map(|m| by[m] * gains[m]).sum());
            carries[k] = Particle { coefficient, yield_limit };
            each(k, bound);
        });
    }
}

/// Calls `each(k, the element upstream)`, upstream elements first.
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
