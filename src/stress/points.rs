//! Stresses at places of the caller's, by direct summation over the loaded elements: right at any place, and the oracle of the product.

use super::kernels;
use super::tensor::Tensor;
use super::{Body, Loads};
use crate::error::{invalid, require, Error, Result};
use crate::threads::Threads;

/// The stresses at points `(x, y, z)`: x and y are counted from the outer corner of element (0, 0), so that element `(ix, iy)` has its
/// centre at `((ix + 1/2) dx, (iy + 1/2) dy)`; z is the depth. `out` has one tensor per point.
///
/// # Errors
/// `Unsupported`: a period; `InvalidArgument`: a negative depth, or a point on the edge of an element at the surface, where stresses jump
/// or are infinite; otherwise as [`subsurface_stress`](super::subsurface_stress).
pub fn stress_at_points(
    body: &Body,
    loads: &Loads<'_>,
    points: &[[f64; 3]],
    threads: &Threads,
    out: &mut [Tensor],
) -> Result<()> {
    assert_eq!(points.len(), out.len());
    if body.periodic {
        return Err(Error::Unsupported(
            "period is given; stresses at points are those of a scene that does not repeat itself".into(),
        ));
    }
    body.check()?;
    loads.check(&body.grid)?;
    points.iter().enumerate().try_for_each(|(i, point)| check(body, i, *point))?;
    threads.for_each_plain_row(out, 1, |i, out| out[0] = at_point(body, loads, points[i]));
    Ok(())
}

fn check(body: &Body, i: usize, [x, y, z]: [f64; 3]) -> Result<()> {
    for (axis, value) in ["x", "y", "z"].into_iter().zip([x, y, z]) {
        require(value.is_finite(), &format!("{axis} of point {i}"), value, "it must be finite")?;
    }
    require(z >= 0.0, &format!("z of point {i}"), z, "a depth must not be negative")?;
    let grid = &body.grid;
    let inside = |value: f64, d: f64, m: usize| value >= 0.0 && value <= m as f64 * d;
    let on_line = |value: f64, d: f64| (value / d).fract() == 0.0;
    let on_edge = on_line(x, grid.dx) || on_line(y, grid.dy);
    if body.in_units(z) == 0.0 && inside(x, grid.dx, grid.mx) && inside(y, grid.dy, grid.my) && on_edge {
        return invalid(format!(
            "point {i} is ({x}, {y}, {z}), on the edge of an element at the surface; stresses jump there or are infinite: take a place \
             within an element, or below"
        ));
    }
    Ok(())
}

fn at_point(body: &Body, loads: &Loads<'_>, [x, y, z]: [f64; 3]) -> Tensor {
    let (grid, (dx, dy)) = (&body.grid, body.element());
    let (loaded, list) = (loads.loaded(), loads.list());
    let [x, y, z] = [x, y, z].map(|length| body.in_units(length));
    let scale = loads.scale();
    let mut sum = [0.0; 6];
    for j in 0..grid.len() {
        let values = list.map(|load| load.map_or(0.0, |load| load[j] / scale));
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
