//! A scene on another grid over the same rectangle: coarser or finer, in any ratio.

use super::{refine, Adhesion, Each, Friction, Layer, Motion, Patches, PressureLimit, Previous, Scene};
use crate::effects::{check_other_grids, repeats};
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::memory::{collected, zeros};

/// The directions in which finer grids of a scene have more elements, see [`Grid::refines`]. A surface callback may differ along each.
pub fn refines(scene: &Scene<'_>) -> (bool, bool) {
    match scene.undeformed_distance.is_empty() {
        true => (true, true),
        false => scene.grid.refines(repeats(scene)),
    }
}

/// The grid over the rectangle of a scene with the elements of the directions that it [`refines`] doubled `doublings` times. A negative
/// number halves those of both, rounded, down to one.
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
    let joined = 2f64.powi(-doublings);
    let fewer = |m: usize| ((m as f64 / joined).round() as usize).max(1);
    let (fewer_x, fewer_y) = (fewer(mx), fewer(my));
    let length = |m: usize, fewer: usize, d: f64| d * (m as f64 / fewer as f64);
    Grid::new(fewer_x, fewer_y, length(mx, fewer_x, dx), length(my, fewer_y, dy))
}

/// The undeformed distance `h` of `grid` at the centres of a coarser grid: the weighted mean of those of the four centres around each that
/// have a surface. With fewer than two there is no surface; a centre that coincides with one of `grid` has its value.
pub fn sample(h: &[f64], grid: &Grid, coarse: &Grid) -> Result<Vec<f64>> {
    let columns: Vec<[(usize, f64); 2]> = (0..coarse.mx).map(|i| between(i, coarse.mx, grid.mx)).collect();
    let mut sampled = zeros(coarse.len(), "undeformed distances of a coarser grid")?;
    for (iy, row) in sampled.chunks_exact_mut(coarse.mx).enumerate() {
        let rows = between(iy, coarse.my, grid.my);
        for (value, columns) in row.iter_mut().zip(&columns) {
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

/// The two of `m` centres around centre i of `coarse`, with their weights.
fn between(i: usize, coarse: usize, m: usize) -> [(usize, f64); 2] {
    // Integers until the end, so that coinciding centres are exact.
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
    /// Means over the elements of the other grid.
    fn means(&self, values: &[f64]) -> Result<Vec<f64>> {
        let parts = |m: usize, to: usize| -> Vec<Vec<(usize, f64)>> { (0..to).map(|i| parts(i, to, m)).collect() };
        let (columns, rows) = (parts(self.from.mx, self.to.mx), parts(self.from.my, self.to.my));
        let of = |i: usize| -> f64 {
            let (rows, columns) = (&rows[i / self.to.mx], &columns[i % self.to.mx]);
            let row = |y: usize| -> f64 { columns.iter().map(|(x, part)| part * values[self.from.index(*x, y)]).sum() };
            rows.iter().map(|(y, part)| part * row(*y)).sum()
        };
        Ok(collected((0..self.to.len()).map(of), "values of a scene on another grid")?)
    }

    fn pair(&self, pair: Option<[&[f64]; 2]>, factor: f64) -> Result<Option<[Vec<f64>; 2]>> {
        let Some([x, y]) = pair else { return Ok(None) };
        let mut pair = [self.means(x)?, self.means(y)?];
        pair.iter_mut().flatten().for_each(|value| *value *= factor);
        Ok(Some(pair))
    }

    /// The values in the elements around the centres of the other grid.
    fn at_centres(&self, values: &[i32]) -> Result<Vec<i32>> {
        let at = |i: usize, to: usize, m: usize| (2 * i + 1) * m / (2 * to);
        let of = |i: usize| {
            let (x, y) = (i % self.to.mx, i / self.to.mx);
            values[self.from.index(at(x, self.to.mx, self.from.mx), at(y, self.to.my, self.from.my))]
        };
        Ok(collected((0..self.to.len()).map(of), "patches of a scene on another grid")?)
    }

    /// The means of values given per element.
    fn each(&self, values: Option<Each<'_>>) -> Result<Option<Vec<f64>>> {
        values.and_then(|values| values.per_element()).map(|values| self.means(values)).transpose()
    }
}

/// The elements out of `m` that element i of `to` covers, with the part of element i that each covers.
fn parts(i: usize, to: usize, m: usize) -> Vec<(usize, f64)> {
    // Lengths are in units of 1/(to m) of the whole.
    let (start, end) = (i * m, (i + 1) * m);
    let part = |x: usize| (end.min((x + 1) * to) - start.max(x * to)) as f64 / m as f64;
    (start / to..end.div_ceil(to)).map(|x| (x, part(x))).collect()
}

/// The arrays per element of a scene, on another grid.
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
    /// A scene on the grid `to`. `surface`: the undeformed distance on it; none: that of the scene, [refined](refine) by a whole ratio or
    /// [sampled](sample). Compliances, limits, works of adhesion, coefficients of friction, weights and tractions are means over the elements. A
    /// rigid slip scales with the length of the step. A step of transient rolling keeps its length, and one of steady rolling its number of elements.
    ///
    /// # Errors
    /// `Unsupported`: effects that stand for one grid only, as own coefficients, or previous tractions kept by a solver.
    pub fn new(scene: &Scene<'_>, to: Grid, surface: Option<Vec<f64>>) -> Result<Regridded> {
        check_other_grids(scene)?;
        let from = scene.grid;
        let regrid = Regrid { from, to };
        let friction = scene.friction.as_ref();
        let (before, rolling_distance) = friction.map_or((1.0, 0.0), |friction| {
            let step = friction.distance(&from);
            let by_element = |grid: &Grid| Friction { rolling_distance: 0.0, ..*friction }.distance(grid);
            let other = match friction.motion {
                Motion::TransientRolling => step,
                // The step is a part of the discretisation.
                Motion::SteadyRolling => friction.rolling_distance * (by_element(&to) / by_element(&from)),
                Motion::Shift => friction.rolling_distance,
            };
            (step, other)
        });
        let step = friction.map_or(1.0, |friction| Friction { rolling_distance, ..*friction }.distance(&to));
        let layer = regrid.each(scene.layer.map(|layer| layer.0))?;
        let limits = regrid.each(scene.pressure_limit.map(|limit| limit.0))?;
        let works = regrid.each(scene.adhesion.map(|adhesion| adhesion.work))?;
        let mut undeformed_distance = match surface {
            Some(surface) => surface,
            None => distance(scene, &to)?,
        };
        let patches = scene.patches.map(|patches| regrid.at_centres(patches.patch)).transpose()?;
        // Without a patch there is no surface, also in a scene whose patches are left out.
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
            rigid_slip: regrid.pair(friction.and_then(|friction| friction.rigid_slip), step / before)?,
            previous: match friction.map(|friction| friction.previous) {
                Some(Previous::Given(tractions)) => regrid.pair(Some(tractions), 1.0)?,
                _ => None,
            },
            rolling_distance,
        })
    }

    /// The scene of [`Regridded::new`] on the other grid.
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
                // These belong to the elements of one grid. A law that reads them is refused on several grids.
                coefficients_before: None,
                yield_limits: None,
                ..friction
            }),
            ..scene.clone()
        }
    }
}

/// The undeformed distance of a scene on another grid: refined by cubics if each element becomes a whole number of elements, else sampled.
fn distance(scene: &Scene<'_>, to: &Grid) -> Result<Vec<f64>> {
    let (h, from) = (scene.undeformed_distance, &scene.grid);
    let (x, y) = (to.mx / from.mx, to.my / from.my);
    if x >= 1 && y >= 1 && to.mx == x * from.mx && to.my == y * from.my {
        return refine(h, from, (x, y), repeats(scene));
    }
    sample(h, from, to)
}
