//! Stresses at given points, by direct summation over the loaded elements. The sums hold at any point, and tests compare the products by FFT with
//! them.

use std::time::Instant;

use super::body::Body;
use super::kernels;
use super::loads::{Loads, Part};
use super::tensor::Tensor;
use crate::error::{invalid, require, Error, Number, Result};
use crate::grid::Grid;
use crate::progress::{Progress, ProgressCallback};
use crate::threads::Threads;

/// The number of elements times points between two calls of `progress`: some 10 ms of one thread.
const AT_ONCE: usize = 1 << 17;

/// Computes the stresses at `points`, one tensor per point in `out`. A point is `(x, y, z)` with the depth z. x and y are counted from the middle
/// of the grid, so that element `(ix, iy)` has its centre at `((ix + 1/2 - mx/2) dx, (iy + 1/2 - my/2) dy)`. `progress` is called every few
/// milliseconds with the number of points that are done. Returns true if all points are done, false if `progress` cancelled.
///
/// * `Unsupported`: a period.
/// * `InvalidArgument`: a negative depth; a point at the surface on the edge of an element, up to the rounding of its coordinates, where stresses
///   jump or are infinite; with coupled patches, a point that lies below no element.
/// * Otherwise as [`subsurface_stress`](super::subsurface_stress).
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
        // After the last points there is nothing to cancel.
        if progress.as_mut().is_some_and(|progress| progress(&told)) && done < all {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Refuses point i if its stresses are not defined.
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

/// The round-off of coordinates, relative to the larger of the grid's length and the coordinate: that of 4096 additions, or of an origin that is
/// 4096 lengths away.
const ROUNDING: f64 = 4096.0 * f64::EPSILON;

/// The position of a coordinate among the edges of m elements of size d.
struct Line {
    /// The round-off of the coordinate.
    rounding: f64,
    /// Whether the coordinate lies on the grid, up to round-off.
    is_inside: bool,
    /// Whether the coordinate lies on an edge, up to round-off.
    is_on_edge: bool,
}

impl Line {
    /// The position of the coordinate x, which is counted from the first edge.
    fn of(x: f64, d: f64, m: usize) -> Line {
        let length = m as f64 * d;
        // The round-off is at most 1e-3 of an element, so that only the nearest edge is tested.
        let rounding = (ROUNDING * length.max(x.abs())).min(1e-3 * d);
        let nearest = (x / d).round().clamp(0.0, m as f64) * d;
        let is_inside = x >= -rounding && x <= length + rounding;
        Line { rounding, is_inside, is_on_edge: (x - nearest).abs() <= rounding }
    }
}

/// The point relative to the outer corner of element (0, 0) instead of the middle of the grid.
fn from_corner(grid: &Grid, [x, y, z]: [f64; 3]) -> [f64; 3] {
    [x + 0.5 * grid.mx as f64 * grid.dx, y + 0.5 * grid.my as f64 * grid.dy, z]
}

/// The stresses at one point: the sum over all elements.
fn at_point(body: &Body, loads: &Loads<'_>, point: [f64; 3]) -> Tensor {
    let (grid, (dx, dy)) = (&body.grid, body.element());
    let [x, y, z] = from_corner(grid, point);
    let (loaded, list) = (loads.loaded(), loads.list());
    let scale = loads.scale();
    // A point below the common edge of two elements belongs to the patch of the one at larger x or y.
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
