//! The undeformed distance on a finer grid over the same rectangle, from the given one.

use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;

/// The values `h` of `grid` at the centres of a grid with `parts` elements for each one in x and in y.
///
/// By cubics through the four nearest centres in each direction (with fewer elements, the polynomial through all): exact for cubics,
/// and without additional roughness. Parts of an element without surface (+infinity) have none. If one of the four has none, the line
/// through the element and its neighbour with surface is used, on the side of the part if possible, else a constant.
pub fn refine(h: &[f64], grid: &Grid, parts: (usize, usize)) -> Result<Vec<f64>> {
    let (mx, my) = (grid.mx, grid.my);
    let (fine_mx, fine_my) = (mx * parts.0, my * parts.1);
    let weights = |parts: usize| -> Vec<Part> { (0..parts).map(|part| Part::new(part, parts)).collect() };
    let (in_x, in_y) = (weights(parts.0), weights(parts.1));

    let mut rows = zeros(fine_mx * my, "undeformed distances of a finer grid")?;
    for (row, refined) in h.chunks_exact(mx).zip(rows.chunks_exact_mut(fine_mx)) {
        for (i, value) in refined.iter_mut().enumerate() {
            *value = in_x[i % parts.0].at(i / parts.0, mx, |j| row[j]);
        }
    }
    let mut fine = zeros(fine_mx * fine_my, "undeformed distances of a finer grid")?;
    for (iy, refined) in fine.chunks_exact_mut(fine_mx).enumerate() {
        for (ix, value) in refined.iter_mut().enumerate() {
            *value = in_y[iy % parts.1].at(iy / parts.1, my, |j| rows[j * fine_mx + ix]);
        }
    }
    Ok(fine)
}

/// One of the parts of every element: its distance from the centre of the element, in elements, and the weights of the cubic
/// through the four centres around it.
struct Part {
    offset: f64,
    weights: [f64; 4],
}

impl Part {
    fn new(part: usize, parts: usize) -> Part {
        let offset = (part as f64 + 0.5) / parts as f64 - 0.5;
        let mut weights = [0.0; 4];
        lagrange(offset - first_node(offset) as f64, &mut weights);
        Part { offset, weights }
    }

    /// The value at this part of element `i` of `m`.
    fn at(&self, i: usize, m: usize, value: impl Fn(usize) -> f64) -> f64 {
        if value(i).is_infinite() {
            return f64::INFINITY;
        }
        let count = m.min(4);
        let wanted = i as i64 + first_node(self.offset);
        let first = wanted.clamp(0, (m - count) as i64) as usize;
        if (first..first + count).any(|j| value(j).is_infinite()) {
            return self.beside_a_hole(i, m, value);
        }
        // At the border of the grid the four nearest centres are not around the point.
        let mut weights = self.weights;
        if first as i64 != wanted || count < 4 {
            lagrange(i as f64 + self.offset - first as f64, &mut weights[..count]);
        }
        weights[..count].iter().enumerate().map(|(k, weight)| weight * value(first + k)).sum()
    }

    fn beside_a_hole(&self, i: usize, m: usize, value: impl Fn(usize) -> f64) -> f64 {
        let here = value(i);
        let side = |step: i64| {
            let j = i as i64 + step;
            (0..m as i64).contains(&j).then(|| value(j as usize)).filter(|there| there.is_finite())
        };
        let towards = if self.offset < 0.0 { -1 } else { 1 };
        let along = self.offset * towards as f64;
        match (side(towards), side(-towards)) {
            (Some(there), _) => here + along * (there - here),
            (None, Some(behind)) => here + along * (here - behind),
            (None, None) => here,
        }
    }
}

/// The first of the four nearest centres, relative to the element of the point.
fn first_node(offset: f64) -> i64 {
    if offset < 0.0 {
        -2
    } else {
        -1
    }
}

/// Weights at `t` of the values at 0, 1, 2, ...
fn lagrange(t: f64, weights: &mut [f64]) {
    let count = weights.len();
    for (j, weight) in weights.iter_mut().enumerate() {
        *weight = (0..count).filter(|k| *k != j).map(|k| (t - k as f64) / (j as f64 - k as f64)).product();
    }
}
