//! The same scene on coarser grids, its surface sampled at their elements: what errors are estimated from (module `estimates`).
//!
//! The means of h that nested iteration and multigrid put on coarser grids would not do: a mean over an element differs from the value at
//! its centre by `(d^2/24) laplace h`, as much as the discretisation changes.

use super::coarse_grids::{Coarse, CoarseGrids};
use crate::contact::NonNegative;
use crate::contact::{Freshness, State};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::reserve;
use crate::progress::{Criterion, Goal, Monitor};
use crate::scene::Load;

/// What a coarser grid finds for the same surface, sampled at its elements.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Size of its elements over that of the finest.
    pub size: f64,
    /// The force, or the approach if the force is prescribed.
    pub found: f64,
    /// Largest pressure.
    pub max_pressure: f64,
    /// rms of its pressures minus the means of those of the finest grid, over the rms of those.
    pub distance: f64,
}

/// The coarser grids to look at, by how often they are coarsened, coarsest first, and the elements in contact and the chord (see
/// [`Outline::chord`](crate::contact::Outline::chord)) that each needs: enough for its own errors to be regular.
const NEAR: [(usize, f64, f64); 4] = [(4, 200.0, 8.0), (3, 200.0, 0.0), (2, 50.0, 0.0), (1, 10.0, 0.0)];
/// That of the grid that shows the order, by how often it is coarsened more.
const FAR: [usize; 2] = [2, 1];
/// The elements in contact that it needs to show an order, and to predict an error when the order is taken for granted.
pub const SHOWS_ORDER: f64 = 50.0;
pub const PREDICTS: f64 = 10.0;
/// The residual of a sample of so many elements in contact: its discretisation error is about one over that number, and this part of it
/// does not matter.
const TOLERANCE: f64 = 3e-3;
const ITERATIONS: u64 = 40;

impl CoarseGrids {
    /// Up to two samples, of the nearer grid first, starting from the pressures of `fine`, whose contact area has chords of length
    /// `chord`; the farther one has at least `far_contact` elements in contact.
    pub fn samples(
        &mut self,
        fine: &State,
        chord: f64,
        far_contact: f64,
        monitor: &mut Monitor<'_>,
    ) -> Result<([Sample; 2], usize)> {
        let mut samples = [Sample { size: 1.0, found: 0.0, max_pressure: 0.0, distance: 0.0 }; 2];
        let contact = fine.contact_count() as f64;
        let enough = |grids: &Self, l: usize, least: f64| {
            grids.grids.get(l - 1).is_some_and(|grid| contact / size(fine, &grid.state).powi(2) >= least)
        };
        let suits = |(l, least, chord_least): &(usize, f64, f64)| {
            enough(self, *l, *least) && chord >= *chord_least * f64::from(1 << *l)
        };
        let Some((near, ..)) = NEAR.into_iter().find(suits) else {
            return Ok((samples, 0));
        };
        let far = FAR.into_iter().map(|more| near + more).find(|l| enough(self, *l, far_contact));
        let mut count = 0;
        for l in [Some(near), far].into_iter().flatten() {
            let Some(sample) = self.sample(l - 1, fine, monitor)? else { break };
            samples[count] = sample;
            count += 1;
        }
        Ok((samples, count))
    }

    /// None when nothing touches on that grid.
    fn sample(&mut self, l: usize, fine: &State, monitor: &mut Monitor<'_>) -> Result<Option<Sample>> {
        let finest = self.finest;
        let Coarse { level, state, means, .. } = &mut self.grids[l];
        sample_distance(&fine.grid, &state.grid, &fine.h, &mut state.h);
        reserve(means, state.p.len(), "means of the pressures")?;
        take_means(&fine.grid, &state.grid, &fine.p, means);
        for (i, &mean) in means.iter().enumerate() {
            state.p[i] = if state.h[i].is_finite() { mean } else { 0.0 };
            state.contact[i] = state.p[i] > 0.0;
        }
        (state.load, state.approach) = (fine.load, fine.approach);
        let count = state.contact_count();
        if count == 0 {
            return Ok(None);
        }
        let tolerance = TOLERANCE / count as f64;
        let goal = Goal { criterion: Criterion::Residual, tolerance, max_cycles: ITERATIONS };
        let mut silent = Monitor::silent();
        state.at_limit.clear();
        level.run(state, NonNegative, Freshness::Stale, &goal, finest, &mut silent)?;
        monitor.count_work(silent.count.work_units);
        state.balance_force();
        let (mut highest, mut squares, mut differences) = (0.0_f64, 0.0, 0.0);
        for (p, mean) in state.p.iter().zip(means.iter()) {
            highest = highest.max(*p);
            squares += mean * mean;
            differences += (p - mean) * (p - mean);
        }
        let found = match state.load {
            Load::Approach(_) => state.force(),
            Load::Force(_) => state.approach,
        };
        let distance = (differences / squares).sqrt();
        Ok((highest > 0.0).then_some(Sample { size: size(fine, state), found, max_pressure: highest, distance }))
    }
}

/// Size of the elements of a coarser grid over that of the finer one.
fn size(fine: &State, coarse: &State) -> f64 {
    (coarse.grid.element_area() / fine.grid.element_area()).sqrt()
}

/// Fine elements in a coarse one, along x and y.
fn factors(fine: &Grid, coarse: &Grid) -> (usize, usize) {
    ((coarse.dx / fine.dx).round() as usize, (coarse.dy / fine.dy).round() as usize)
}

/// The fine elements around the centre of coarse element `i` and their weights in the cubic through them, linear near the ends; none
/// where the centre lies outside.
fn stencil(i: usize, factor: usize, m: usize) -> Option<[(usize, f64); 4]> {
    let centre = factor * i + factor / 2;
    if factor == 1 {
        return Some([(i, 1.0), (i, 0.0), (i, 0.0), (i, 0.0)]);
    }
    if centre >= 2 && centre + 1 < m {
        let near = 9.0 / 16.0;
        let far = -1.0 / 16.0;
        return Some([(centre - 1, near), (centre, near), (centre - 2, far), (centre + 1, far)]);
    }
    (centre < m).then_some([(centre - 1, 0.5), (centre, 0.5), (centre, 0.0), (centre, 0.0)])
}

/// h at the centres of the coarse elements. Where a surface ends nearby: the mean of the elements around the centre, or `+infinity` where
/// most of them have none.
fn sample_distance(fine: &Grid, coarse: &Grid, h: &[f64], to: &mut [f64]) {
    let (fx, fy) = factors(fine, coarse);
    for iy in 0..coarse.my {
        let rows = stencil(iy, fy, fine.my);
        for ix in 0..coarse.mx {
            to[coarse.index(ix, iy)] = match (stencil(ix, fx, fine.mx), rows) {
                (Some(columns), Some(rows)) => at_centre(fine, h, &columns, &rows),
                _ => f64::INFINITY,
            };
        }
    }
}

fn at_centre(fine: &Grid, h: &[f64], columns: &[(usize, f64); 4], rows: &[(usize, f64); 4]) -> f64 {
    let mut sum = 0.0;
    for &(y, wy) in rows.iter().filter(|(_, w)| *w != 0.0) {
        for &(x, wx) in columns.iter().filter(|(_, w)| *w != 0.0) {
            sum += wx * wy * h[fine.index(x, y)];
        }
    }
    if sum.is_finite() {
        return sum;
    }
    let (mut sum, mut count) = (0.0, 0.0);
    for (y, x) in rows[..2].iter().flat_map(|row| columns[..2].iter().map(move |column| (row.0, column.0))) {
        let h = h[fine.index(x, y)];
        if h.is_finite() {
            sum += h;
            count += 1.0;
        }
    }
    if count >= 2.0 {
        sum / count
    } else {
        f64::INFINITY
    }
}

/// Means of the fine pressures over the coarse elements; what lies outside the fine grid carries none.
fn take_means(fine: &Grid, coarse: &Grid, p: &[f64], means: &mut Vec<f64>) {
    let (fx, fy) = factors(fine, coarse);
    means.clear();
    means.resize(coarse.len(), 0.0);
    // Rows without pressures add nothing.
    let loaded = |(_, row): &(usize, &[f64])| row.iter().fold(false, |any, p| any | (*p != 0.0));
    for (y, row) in p.chunks_exact(fine.mx).enumerate().filter(loaded) {
        let to = &mut means[(y / fy) * coarse.mx..][..coarse.mx];
        for (to, p) in to.iter_mut().zip(row.chunks(fx)) {
            *to += p.iter().sum::<f64>();
        }
    }
    let share = 1.0 / (fx * fy) as f64;
    means.iter_mut().for_each(|mean| *mean *= share);
}

#[cfg(test)]
#[path = "../../../tests/unit/coarser_solutions.rs"]
mod tests;
