//! Transfers a scene to another grid over the same rectangle, which may be coarser or finer in any ratio.

use super::{refine, Adhesion, Each, Friction, Layer, Motion, Patches, PressureLimit, Previous, Scene};
use crate::effects::{check_other_grids, repeats};
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::memory::{collected, zeros};

/// The directions in which finer grids of a scene have more elements: see [`Grid::refines`]. These are both directions if the scene has no undeformed
/// distance, because a surface callback may vary along both.
pub fn refines(scene: &Scene<'_>) -> (bool, bool) {
    match scene.undeformed_distance.is_empty() {
        true => (true, true),
        false => scene.grid.refines(repeats(scene)),
    }
}

/// The grid over the rectangle of a scene whose elements are doubled `doublings` times, in the directions that the scene [`refines`]. A negative
/// number halves the elements in both directions, rounded, down to one.
pub fn scaled(scene: &Scene<'_>, doublings: i32) -> Result<Grid> {
    let Grid { mx, my, dx, dy } = scene.grid;
    if doublings >= 0 {
        let parts = 1_usize.checked_shl(doublings as u32).unwrap_or(0);
        let (in_x, in_y) = refines(scene);
        let (x, y) = (if in_x { parts } else { 1 }, if in_y { parts } else { 1 });
        return match (mx.checked_mul(x), my.checked_mul(y)) {
            (Some(mx), Some(my)) if parts > 0 => Grid::new(mx, my, dx / x as f64, dy / y as f64),
            _ => invalid(format!("{mx} x {my} elements cannot be divided {doublings} times")),
        };
    }
    let ratio = 2f64.powi(-doublings);
    let fewer = |m: usize| ((m as f64 / ratio).round() as usize).max(1);
    let (fewer_x, fewer_y) = (fewer(mx), fewer(my));
    let length = |m: usize, fewer: usize, d: f64| d * (m as f64 / fewer as f64);
    Grid::new(fewer_x, fewer_y, length(mx, fewer_x, dx), length(my, fewer_y, dy))
}

/// Interpolates the undeformed distance `h` of `grid` to the centres of the `coarse` grid: bilinearly from the four centres around each. Centres
/// without a surface are left out of the weighted mean. If fewer than two of the four have a surface, there is none. A centre that coincides with one
/// of `grid` gets its value exactly.
pub fn sample(h: &[f64], grid: &Grid, coarse: &Grid) -> Result<Vec<f64>> {
    const SAMPLED: &str = "undeformed distances of a coarser grid";
    let columns = collected((0..coarse.mx).map(|i| between(i, coarse.mx, grid.mx)), SAMPLED)?;
    let mut sampled = zeros(coarse.len(), SAMPLED)?;
    for (iy, row) in sampled.chunks_exact_mut(coarse.mx).enumerate() {
        let rows = between(iy, coarse.my, grid.my);
        for (value, columns) in row.iter_mut().zip(&columns) {
            // `all` counts the centres with a positive weight, `count` those of them with a surface.
            let (mut sum, mut weights, mut count, mut all) = (0.0, 0.0, 0, 0);
            for ((y, of_y), (x, of_x)) in rows.iter().flat_map(|y| columns.iter().map(move |x| (*y, *x))) {
                let (h, weight) = (h[grid.index(x, y)], of_y * of_x);
                all += usize::from(weight > 0.0);
                if weight > 0.0 && h.is_finite() {
                    (sum, weights, count) = (sum + weight * h, weights + weight, count + 1);
                }
            }
            *value = if count < all.min(2) { f64::INFINITY } else { sum / weights };
        }
    }
    Ok(sampled)
}

/// Along one direction: the two centres of a grid with `m` elements around centre i of a grid with `coarse` elements, and their weights.
fn between(i: usize, coarse: usize, m: usize) -> [(usize, f64); 2] {
    // Integers up to the division, so that the weights of coinciding centres are exactly 1 and 0.
    let (twice, whole) = ((2 * i + 1) * m - coarse, 2 * coarse);
    let (first, part) = (twice / whole, (twice % whole) as f64 / whole as f64);
    [(first, 1.0 - part), ((first + 1).min(m - 1), part)]
}

/// The transfer from one grid to another.
struct Regrid {
    from: Grid,
    to: Grid,
}

impl Regrid {
    /// The values on the new grid: means over its elements of values that are constant on the old elements.
    fn means(&self, values: &[f64]) -> Result<Vec<f64>> {
        let Regrid { from, to } = self;
        let of = |i: usize| -> f64 {
            let columns = parts(i % to.mx, to.mx, from.mx);
            let row = |y: usize| -> f64 { columns.clone().map(|(x, part)| part * values[from.index(x, y)]).sum() };
            parts(i / to.mx, to.my, from.my).map(|(y, part)| part * row(y)).sum()
        };
        Ok(collected((0..self.to.len()).map(of), "values of a scene on another grid")?)
    }

    /// The means of two fields, times `factor`.
    fn pair(&self, pair: Option<[&[f64]; 2]>, factor: f64) -> Result<Option<[Vec<f64>; 2]>> {
        let Some([x, y]) = pair else { return Ok(None) };
        let mut pair = [self.means(x)?, self.means(y)?];
        pair.iter_mut().flatten().for_each(|value| *value *= factor);
        Ok(Some(pair))
    }

    /// The values of the old elements that contain the centres of the new elements.
    fn at_centres(&self, values: &[i32]) -> Result<Vec<i32>> {
        let old = |i: usize, to: usize, m: usize| (2 * i + 1) * m / (2 * to);
        let of = |i: usize| {
            let (x, y) = (i % self.to.mx, i / self.to.mx);
            values[self.from.index(old(x, self.to.mx, self.from.mx), old(y, self.to.my, self.from.my))]
        };
        Ok(collected((0..self.to.len()).map(of), "patches of a scene on another grid")?)
    }

    /// The means of values that are given per element. None for uniform values.
    fn each(&self, values: Option<Each<'_>>) -> Result<Option<Vec<f64>>> {
        values.and_then(|values| values.per_element()).map(|values| self.means(values)).transpose()
    }
}

/// Along one direction: the elements of a grid of `m` elements that overlap element i of a grid of `to` elements. With each comes the part of element
/// i that it covers.
fn parts(i: usize, to: usize, m: usize) -> impl Iterator<Item = (usize, f64)> + Clone {
    // Lengths in units of 1/(to m) of the whole line are integers.
    let (start, end) = (i * m, (i + 1) * m);
    let part = move |x: usize| (end.min((x + 1) * to) - start.max(x * to)) as f64 / m as f64;
    (start / to..end.div_ceil(to)).map(move |x| (x, part(x)))
}

/// The arrays of a scene on another grid.
pub struct Regridded {
    grid: Grid,
    undeformed_distance: Vec<f64>,
    layer: Option<Vec<f64>>,
    limits: Option<Vec<f64>>,
    works: Option<Vec<f64>>,
    patches: Option<Vec<i32>>,
    coefficients: Option<Vec<f64>>,
    compliances: Option<Vec<f64>>,
    weights: Option<[Vec<f64>; 2]>,
    rigid_slip: Option<[Vec<f64>; 2]>,
    previous: Option<[Vec<f64>; 2]>,
    rolling_distance: f64,
}

impl Regridded {
    /// Transfers the arrays of a scene to the grid `to`:
    ///
    /// - The undeformed distance is `surface` if given. Otherwise that of the scene is [refined](refine) if each element becomes a whole number of
    ///   elements, else [sampled](sample).
    /// - Compliances, limits, works of adhesion, coefficients of friction, weights and tractions become means over the new elements.
    /// - A rigid slip scales with the length of the rolling step. A step of transient rolling keeps its length, a step of steady rolling
    ///   keeps its number of elements.
    ///
    /// # Errors
    /// `Unsupported`: effects that belong to one grid, such as the caller's influence coefficients or tractions kept by a solver.
    pub fn new(scene: &Scene<'_>, to: Grid, surface: Option<Vec<f64>>) -> Result<Regridded> {
        check_other_grids(scene)?;
        let from = scene.grid;
        let regrid = Regrid { from, to };
        let friction = scene.friction.as_ref();
        // The length of a rolling step on the old grid, and `rolling_distance` on the new one.
        let (old_step, rolling_distance) = friction.map_or((1.0, 0.0), |friction| {
            let step = friction.distance(&from);
            let default_step = |grid: &Grid| Friction { rolling_distance: 0.0, ..*friction }.distance(grid);
            let new = match friction.motion {
                Motion::TransientRolling => step,
                // In steady rolling the step is a part of the discretisation and refined with the grid.
                Motion::SteadyRolling => friction.rolling_distance * (default_step(&to) / default_step(&from)),
                Motion::Shift => friction.rolling_distance,
            };
            (step, new)
        });
        let new_step = friction.map_or(1.0, |friction| Friction { rolling_distance, ..*friction }.distance(&to));
        let layer = regrid.each(scene.layer.map(|layer| layer.0))?;
        let limits = regrid.each(scene.pressure_limit.map(|limit| limit.0))?;
        let works = regrid.each(scene.adhesion.map(|adhesion| adhesion.work))?;
        let mut undeformed_distance = match surface {
            Some(surface) => surface,
            None => distance(scene, &to)?,
        };
        let patches = scene.patches.map(|patches| regrid.at_centres(patches.patch)).transpose()?;
        // Elements without a patch have no surface. A bill may leave out the patches of this scene later, and this must remain.
        for (h, patch) in undeformed_distance.iter_mut().zip(patches.iter().flatten()) {
            if *patch < 0 {
                *h = f64::INFINITY;
            }
        }
        Ok(Regridded {
            grid: to,
            undeformed_distance,
            layer,
            limits,
            works,
            patches,
            coefficients: regrid.each(friction.map(|friction| friction.coefficient))?,
            compliances: regrid.each(friction.map(|friction| friction.compliance))?,
            weights: regrid.pair(friction.and_then(|friction| friction.weights), 1.0)?,
            rigid_slip: regrid.pair(friction.and_then(|friction| friction.rigid_slip), new_step / old_step)?,
            previous: match friction.map(|friction| friction.previous) {
                Some(Previous::Given(tractions)) => regrid.pair(Some(tractions), 1.0)?,
                _ => None,
            },
            rolling_distance,
        })
    }

    /// `scene`, which must be that of [`Regridded::new`], on the other grid.
    pub fn scene<'a>(&'a self, scene: &Scene<'a>) -> Scene<'a> {
        let per_element = |values: &'a Option<Vec<f64>>, uniform: Each<'a>| {
            values.as_ref().map_or(uniform, |values| Each::PerElement(values))
        };
        let pair = |pair: &'a Option<[Vec<f64>; 2]>| pair.as_ref().map(|[x, y]| [&x[..], &y[..]]);
        Scene {
            grid: self.grid,
            undeformed_distance: &self.undeformed_distance,
            layer: scene.layer.map(|layer| Layer(per_element(&self.layer, layer.0))),
            pressure_limit: scene.pressure_limit.map(|limit| PressureLimit(per_element(&self.limits, limit.0))),
            adhesion: scene
                .adhesion
                .map(|adhesion| Adhesion { work: per_element(&self.works, adhesion.work), ..adhesion }),
            patches: scene
                .patches
                .map(|patches| Patches { patch: self.patches.as_deref().unwrap_or_default(), ..patches }),
            friction: scene.friction.map(|friction| Friction {
                coefficient: per_element(&self.coefficients, friction.coefficient),
                compliance: per_element(&self.compliances, friction.compliance),
                weights: pair(&self.weights),
                rigid_slip: pair(&self.rigid_slip),
                previous: pair(&self.previous).map_or(Previous::None, Previous::Given),
                rolling_distance: self.rolling_distance,
                initial: None,
                // Both arrays belong to the elements of one grid. Friction laws that read them are refused on several grids.
                coefficients_before: None,
                yield_limits: None,
                ..friction
            }),
            ..scene.clone()
        }
    }
}

/// The undeformed distance of a scene on another grid: [refined](refine) if each element becomes a whole number of elements, else [sampled](sample).
fn distance(scene: &Scene<'_>, to: &Grid) -> Result<Vec<f64>> {
    let (h, from) = (scene.undeformed_distance, &scene.grid);
    let (x, y) = (to.mx / from.mx, to.my / from.my);
    if x >= 1 && y >= 1 && to.mx == x * from.mx && to.my == y * from.my {
        return refine(h, from, (x, y), repeats(scene));
    }
    sample(h, from, to)
}
