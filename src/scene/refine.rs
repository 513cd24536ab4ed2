//! The undeformed distance on a finer grid over the same rectangle, from the one that is given.

use crate::error::Result;
use crate::grid::Grid;
use crate::operator::zeros;

/// The values `h` of `grid` at the centres of a grid with `parts` elements for each one in both directions.
///
/// By cubics through the four nearest centres in each direction (of fewer elements, the polynomial through all): exact for cubics,
/// and without roughness that the data do not have. Parts of an element without surface (+infinity) have none; where one is
/// among the four, the line through the element and its neighbour with surface is taken, on the side of the part if there is
/// one, else a constant.
pub fn refine(h: &[f64], grid: &Grid, parts: usize) -> Result<Vec<f64>> {
    let (mx, my) = (grid.mx, grid.my);
    let (fine_mx, fine_my) = (mx * parts, my * parts);
    let weights: Vec<Part> = (0..parts).map(|part| Part::new(part, parts)).collect();

    let mut rows = zeros(fine_mx * my, "undeformed distances of a finer grid")?;
    for (row, refined) in h.chunks_exact(mx).zip(rows.chunks_exact_mut(fine_mx)) {
        for (i, value) in refined.iter_mut().enumerate() {
            *value = weights[i % parts].at(i / parts, mx, |j| row[j]);
        }
    }
    let mut fine = zeros(fine_mx * fine_my, "undeformed distances of a finer grid")?;
    for (iy, refined) in fine.chunks_exact_mut(fine_mx).enumerate() {
        for (ix, value) in refined.iter_mut().enumerate() {
            *value = weights[iy % parts].at(iy / parts, my, |j| rows[j * fine_mx + ix]);
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
        // At the border of the grid the four nearest centres lie otherwise.
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

/// The first of the four nearest centres, from the element in which the point lies.
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

#[cfg(test)]
mod tests {
    use super::*;

    const INF: f64 = f64::INFINITY;

    /// `value(x, y)` at the centres; the corner of the grid is at (0, 0).
    fn sampled(grid: &Grid, value: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let centre = |i: usize, d: f64| (i as f64 + 0.5) * d;
        (0..grid.len()).map(|i| value(centre(i % grid.mx, grid.dx), centre(i / grid.mx, grid.dy))).collect()
    }

    fn finer(grid: &Grid, parts: usize) -> Grid {
        let d = parts as f64;
        Grid::new(grid.mx * parts, grid.my * parts, grid.dx / d, grid.dy / d).expect("a grid")
    }

    /// Largest difference of the refined samples from the samples on the finer grid.
    fn error(mx: usize, my: usize, parts: usize, value: impl Fn(f64, f64) -> f64 + Copy) -> f64 {
        let grid = Grid::new(mx, my, 1.0 / mx as f64, 0.7 / my as f64).expect("a grid");
        let refined = refine(&sampled(&grid, value), &grid, parts).expect("memory");
        let exact = sampled(&finer(&grid, parts), value);
        refined.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    // Round-off: half an element outside the last centre the weights' moduli sum to 6 in each direction, values are of order 1:
    // 36 times some units of 1.1e-16.
    const ROUND_OFF: f64 = 2e-14;

    #[test]
    fn polynomials_up_to_the_number_of_centres_are_reproduced() {
        let cubic = |x: f64, y: f64| 1.0 - x + 2.0 * x * y * y - x.powi(3) * y + 0.5 * x.powi(3) * y.powi(3);
        for parts in [1, 2, 4, 8] {
            assert!(error(7, 5, parts, cubic) < ROUND_OFF, "{parts}");
            assert!(error(4, 4, parts, cubic) < ROUND_OFF, "{parts}");
            assert!(error(3, 9, parts, |x, y| x * x - x * y.powi(3)) < ROUND_OFF, "{parts}");
            assert!(error(2, 1, parts, |x, _| 3.0 - x) < ROUND_OFF, "{parts}");
        }
        assert!(error(7, 5, 4, |x, _| x.powi(4)) > 1e-5);
    }

    #[test]
    fn parts_of_a_hole_are_holes_and_lines_go_on_beside_it() {
        let grid = Grid::new(6, 5, 1.0, 1.0).expect("a grid");
        let line = |x: f64, y: f64| 2.0 + 0.25 * x - 0.5 * y;
        let mut h = sampled(&grid, line);
        let holes = [grid.index(0, 0), grid.index(2, 2), grid.index(3, 2), grid.index(5, 4)];
        holes.iter().for_each(|&i| h[i] = INF);
        let refined = refine(&h, &grid, 4).expect("memory");
        let fine = finer(&grid, 4);
        for (i, (found, exact)) in refined.iter().zip(sampled(&fine, line)).enumerate() {
            let (ix, iy) = (i % fine.mx, i / fine.mx);
            if holes.contains(&grid.index(ix / 4, iy / 4)) {
                assert_eq!(*found, INF, "({ix}, {iy})");
            } else {
                assert!((found - exact).abs() < ROUND_OFF, "({ix}, {iy}): {found} for {exact}");
            }
        }
    }

    #[test]
    fn an_element_alone_is_flat() {
        let grid = Grid::new(3, 3, 1.0, 1.0).expect("a grid");
        let mut h = vec![INF; 9];
        h[4] = 0.75;
        let refined = refine(&h, &grid, 2).expect("memory");
        assert_eq!(refined.iter().filter(|v| v.is_finite()).copied().collect::<Vec<f64>>(), [0.75; 4]);
    }
}
