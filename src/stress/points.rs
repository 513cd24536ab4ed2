//! Stresses at given points, by direct summation over the loaded elements: valid at any place, and the oracle of the product.

use std::time::Instant;

use super::body::Body;
use super::kernels;
use super::loads::{Loads, Part};
use super::tensor::Tensor;
use crate::error::{invalid, require, Error, Number, Result};
use crate::grid::Grid;
use crate::progress::{Progress, ProgressCallback};
use crate::threads::Threads;

/// Elements times points between two calls of `progress`: some 10 ms of one thread.
const AT_ONCE: usize = 1 << 17;

/// The stresses at points `(x, y, z)`: x and y are counted from the middle of the grid, so that element `(ix, iy)` has its centre at
/// `((ix + 1/2 - mx/2) dx, (iy + 1/2 - my/2) dy)`; z is the depth. `out` has one tensor per point.
///
/// # Errors
/// `Unsupported`: a period; `InvalidArgument`: a negative depth, a point on the edge of an element at the surface, to within rounding of its
/// coordinates, where stresses jump or are infinite, or with patches a point that no element is above; otherwise as
/// [`subsurface_stress`](super::subsurface_stress). False: `progress`, which is called every few milliseconds with the points done, cancelled.
pub fn stress_at_points(
    body: &Body,
    loads: &Loads<'_>,
    points: &[[f64; 3]],
    threads: &Threads,
    mut progress: Option<ProgressCallback<'_>>,
    out: &mut [Tensor],
) -> Result<bool> {
    assert_eq!(points.len(), out.len());
    let began = Instant::now();
    if body.periodic {
        return Err(Error::Unsupported(
            "period is given; stresses at points are those of a scene that does not repeat itself".into(),
        ));
    }
    body.check()?;
    loads.check(&body.grid)?;
    points.iter().enumerate().try_for_each(|(i, point)| check(body, loads, i, *point))?;
    let at_once = threads.count() * (AT_ONCE / body.grid.len()).max(1);
    let (mut done, all) = (0, points.len());
    for (out, points) in out.chunks_mut(at_once).zip(points.chunks(at_once)) {
        threads.for_each_plain_row(out, 1, |i, out| out[0] = at_point(body, loads, points[i]));
        done += points.len();
        let told = Progress::of_part(&body.grid, done as u64, began.elapsed().as_secs_f64());
        // A stop that comes with the last points leaves nothing out.
        if progress.as_mut().is_some_and(|progress| progress(&told)) && done < all {
            return Ok(false);
        }
    }
    Ok(true)
}

fn check(body: &Body, loads: &Loads<'_>, i: usize, [x, y, z]: [f64; 3]) -> Result<()> {
    for (axis, value) in ["x", "y", "z"].into_iter().zip([x, y, z]) {
        require(value.is_finite(), &format!("{axis} of point {i}"), value, "it must be finite")?;
    }
    require(z >= 0.0, &format!("z of point {i}"), z, "a depth must not be negative")?;
    let Grid { mx, my, dx, dy } = body.grid;
    let [from_x, from_y, _] = from_corner(&body.grid, [x, y, z]);
    let (in_x, in_y) = (Line::of(from_x, dx, mx), Line::of(from_y, dy, my));
    let place = || format!("point {i} is ({}, {}, {})", Number(x), Number(y), Number(z));
    let is_at_surface = body.in_units(z) == 0.0 || z <= in_x.rounding.min(in_y.rounding);
    if is_at_surface && in_x.is_inside && in_y.is_inside && (in_x.is_on_edge || in_y.is_on_edge) {
        return invalid(format!(
            "{place}, on the edge of an element at the surface, to within rounding; stresses jump there or are infinite: \
             take a place within an element, or below",
            place = place()
        ));
    }
    if loads.coupled().is_some() && !(in_x.is_inside && in_y.is_inside) {
        return invalid(format!(
            "{}, and patches are given; a point takes the factors of the patch above it, so it must lie below the grid",
            place()
        ));
    }
    Ok(())
}

/// Round-off of coordinates, relative to the larger of grid and coordinate: of 4096 additions, or of an origin 4096 lengths away.
const ROUNDING: f64 = 4096.0 * f64::EPSILON;

/// A coordinate among the edges of m elements of size d.
struct Line {
    rounding: f64,
    is_inside: bool,
    is_on_edge: bool,
}

impl Line {
    fn of(x: f64, d: f64, m: usize) -> Line {
        let length = m as f64 * d;
        // At most 1e-3 of an element, so that only the nearest edge is tested.
        let rounding = (ROUNDING * length.max(x.abs())).min(1e-3 * d);
        let nearest = (x / d).round().clamp(0.0, m as f64) * d;
        let is_inside = x >= -rounding && x <= length + rounding;
        Line { rounding, is_inside, is_on_edge: (x - nearest).abs() <= rounding }
    }
}

/// The point relative to the outer corner of element (0, 0).
fn from_corner(grid: &Grid, [x, y, z]: [f64; 3]) -> [f64; 3] {
    [x + 0.5 * grid.mx as f64 * grid.dx, y + 0.5 * grid.my as f64 * grid.dy, z]
}

fn at_point(body: &Body, loads: &Loads<'_>, point: [f64; 3]) -> Tensor {
    let (grid, (dx, dy)) = (&body.grid, body.element());
    let [x, y, z] = from_corner(grid, point);
    let (loaded, list) = (loads.loaded(), loads.list());
    let scale = loads.scale();
    // On a common edge, the patch of the next element.
    let above = |x: f64, d: f64, m: usize| ((x / d) as usize).min(m - 1);
    let part = loads.coupled().map_or(Part::All, |patches| {
        Part::of(patches, grid.index(above(x, grid.dx, grid.mx), above(y, grid.dy, grid.my)))
    });
    let factors = loads.factors(part);
    let [x, y, z] = [x, y, z].map(|length| body.in_units(length));
    let mut sum = [0.0; 6];
    for j in 0..grid.len() {
        let factor = factors(j);
        let values = list.map(|load| load.map_or(0.0, |load| factor * (load[j] / scale)));
        if values == [0.0; 3] {
            continue;
        }
        let centre = ((j % grid.mx) as f64 + 0.5, (j / grid.mx) as f64 + 0.5);
        let kernel = kernels::at(body, loaded, (x - centre.0 * dx, y - centre.1 * dy, z));
        for (load, kernel) in values.into_iter().zip(kernel) {
            sum.iter_mut().zip(kernel).for_each(|(sum, kernel)| *sum += load * kernel);
        }
    }
    sum.map(|value| scale * value)
}
