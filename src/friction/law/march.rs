//! The state of the particles, from element to element: in steady rolling from the leading edge on, else from the step before.

use super::element::{Law, Particle, Place, Resolved};
use crate::effects::Motion;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::collected;

/// A grid, and what its particles had.
pub struct March {
    pub grid: Grid,
    pub law: Law,
    places: Vec<Place>,
    /// The state of each element's particle: before the step, or fresh.
    had: Vec<Particle>,
    /// In steady rolling with memory how many elements upstream a particle was a step before.
    upstream: Option<(isize, isize)>,
    /// How steeply bounds fall and rise with the slip, each times an element's influence on itself.
    pub falls: f64,
    pub rises: f64,
    /// Of each element, by the last [`resolve`](March::resolve).
    resolved: Vec<Resolved>,
    /// The state of each, on the way.
    carries: Vec<Particle>,
    /// Whether the particle of each has met the contact, on the way.
    entered: Vec<bool>,
}

const WHAT: &str = "a law of friction";

impl March {
    /// Of elements and of what their particles had.
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

    /// The findings of the last [`resolve`](March::resolve) on an element.
    pub fn resolved(&self, k: usize) -> &Resolved {
        &self.resolved[k]
    }

    /// Calls `each(k, place, what its particle had)` in the order in which particles pass; it returns what they carry then. In steady rolling they
    /// are fresh until they enter the contact, wherever the grid begins.
    pub fn go(&mut self, mut each: impl FnMut(usize, Place, Particle) -> Particle) {
        let March { places, had, carries, entered, .. } = self;
        in_order(&self.grid, self.upstream, |k, upstream| {
            let from = upstream.filter(|&j| entered[j]);
            carries[k] = each(k, places[k], from.map_or(had[k], |j| carries[j]));
            entered[k] = from.is_some() || places[k].pressure > 0.0 && places[k].coefficient > 0.0;
        });
    }

    /// The slips by which bounds plus rho times them are `traction(k)`.
    pub fn resolve(&mut self, rho: f64, traction: impl Fn(usize) -> f64) {
        let (mut resolved, law) = (std::mem::take(&mut self.resolved), self.law);
        self.go(|k, place, had| {
            let inside = if place.pressure > 0.0 { traction(k) } else { 0.0 };
            resolved[k] = law.resolve(inside, rho, place, had);
            resolved[k].response.particle
        });
        self.resolved = resolved;
    }

    /// How bounds change, by the last resolved, with tractions on slip by `traction(k)`: calls `each(k, that)`.
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

/// Calls `each(k, the element upstream on the grid)` so that what is upstream comes first.
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
