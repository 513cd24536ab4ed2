//! The grids of nested iteration. Coarser grids have the same work of adhesion, and a longer range that their elements resolve.

use std::sync::Arc;

use super::law::{Attraction, Law};
use super::level::Level;
use super::unknowns::{is_small, Unknowns};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::memory::{reserve, sparse};
use crate::methods::multigrid::{coarsen, transfer};
use crate::methods::projected_cg::shift_to_mean;
use crate::operator::Operator;
use crate::threads::Threads;

/// The largest number of elements of the coarsest grid in each direction.
const COARSEST: usize = 31;
/// The name of the memory of surfaces in messages.
const MEMORY: &str = "the surfaces of adhesion";
/// The kappa, the largest `s a0`, of the shortest range that elements resolve.
pub const RESOLVED_KAPPA: f64 = 0.4;

/// The attraction of a scene, for all grids.
#[derive(Clone, Copy, Debug)]
pub struct Surfaces<'a> {
    /// The law of attraction.
    pub law: Law,
    /// The range rho; 0 means the shortest one that the elements resolve.
    pub range: f64,
    /// The work of adhesion w, if it is uniform.
    pub work: f64,
    /// The work of adhesion w of each element. `None`: it is uniform.
    pub works: Option<&'a [f64]>,
}

/// Sets up the grids, finest first. The finest one has the given operator, and its arrays are lent later.
pub fn levels(
    grid: Grid,
    coefficients: &Coefficients,
    operator: Arc<Operator<f64>>,
    threads: &Threads,
) -> Result<Vec<Level>> {
    let below = || std::iter::successors(coarsen(&grid, COARSEST), |grid| coarsen(grid, COARSEST));
    let mut levels = sparse(1 + below().count(), "the grids of adhesion")?;
    let lent = Unknowns::without_fields(grid.len(), threads)?;
    levels.push(Level::new((grid, coefficients.clone()), operator, (lent, 1.0), threads)?);
    let (mut fine, mut coefficients) = (grid, coefficients.clone());
    for coarse in below() {
        coefficients = coefficients.coarsen(&fine, &coarse)?;
        fine = coarse;
        let threads = &threads.suited_to(fine.len());
        let operator = Arc::new(Operator::new(&coefficients, &fine, threads)?);
        let work = fine.len() as f64 / grid.len() as f64;
        let now = Unknowns::new(fine.len(), threads)?;
        levels.push(Level::new((fine, coefficients.clone()), operator, (now, work), threads)?);
    }
    Ok(levels)
}

/// Copies the attraction of a scene to all grids, and restricts works of adhesion and undeformed distances to the coarser grids. The finest grid
/// has its undeformed distances already.
pub fn take_surfaces(levels: &mut [Level], given: Surfaces<'_>) -> Result<()> {
    let Surfaces { law, work, works, .. } = given;
    let largest = works.map_or(work, |works| works.iter().copied().fold(0.0, f64::max));
    for l in 0..levels.len() {
        let (finer, coarser) = levels.split_at_mut(l);
        let Level { problem, surface, .. } = &mut coarser[0];
        let (n, a0) = (problem.grid.len(), problem.self_influence());
        let resolved = law.shortest_range(largest, a0, RESOLVED_KAPPA);
        let range = match finer.first() {
            None if given.range > 0.0 => given.range,
            None => resolved,
            Some(finest) => finest.surface.attraction.range.max(resolved),
        };
        (surface.attraction, surface.work) = (Attraction { law, range }, largest);
        let has_works = works.is_some();
        if has_works {
            reserve(&mut surface.works, n, MEMORY)?;
        }
        surface.works.clear();
        match finer.last() {
            None => surface.works.extend_from_slice(works.unwrap_or_default()),
            Some(Level { problem: fine, surface: from, .. }) => {
                reserve(&mut surface.h, n, MEMORY)?;
                surface.h.resize(n, 0.0);
                let (from_grid, to_grid) = (&fine.grid, &problem.grid);
                transfer::restrict_distance(from_grid, to_grid, &from.h, f64::MAX, &mut surface.h, &problem.threads);
                if problem.coefficients.is_mean_free() {
                    shift_to_mean(&from.h, &mut surface.h);
                }
                if has_works {
                    surface.works.resize(n, 0.0);
                    transfer::restrict_mean(from_grid, to_grid, |i| from.works[i], &mut surface.works);
                }
            }
        }
    }
    Ok(())
}

/// Starts from the pressures of the next coarser grid, piecewise constant, and from its approach. The displacements follow by a fresh product.
/// The memory of linear solves passes to the finer grid.
pub fn prolong(coarse: &mut Level, fine: &mut Level) -> Result<()> {
    fine.fields = std::mem::take(&mut coarse.fields);
    fine.fields.leave_smaller(fine.now.u.len());
    if !is_small(fine.now.u.len()) {
        coarse.problem.rest();
    }
    let (from, to) = (coarse.problem.grid, fine.problem.grid);
    let (pressures, h) = (coarse.now.p.field.as_flattened(), &fine.surface.h);
    fine.problem.threads.for_each_plain_row(fine.now.p.field.as_flattened_mut(), to.mx, |y, row| {
        transfer::interpolate_row(&to, &from, pressures, y, row, |to, value| *to = value);
        row.iter_mut().zip(&h[y * to.mx..]).filter(|(_, h)| h.is_infinite()).for_each(|(p, _)| *p = 0.0);
    });
    fine.now.p.border = coarse.now.p.border;
    fine.refresh()
}
