//! The undeformed distance on a finer grid over the same rectangle, from the given one.

use crate::direction::Direction;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;

/// A step between two centres has this many times both slopes on one side, and at least 1/STEADY of the slope on its other side. On a parabola successive
/// slopes differ by equal amounts: the slope beyond one that is eight times another is at least 15/8 of it, and the outer two of four are at most three times the
/// inner two. Of waves of few elements only some intervals are then taken for steps.
const STEEPER: f64 = 8.0;
const STEADY: f64 = 1.5;
/// Cubics between monotone heights are monotone if slopes are at most this many times the smaller secant (Fritsch & Carlson 1980).
const MONOTONE: f64 = 3.0;

/// A surface is rough at its end if the third difference there exceeds this part of the steps: a wave of 12 elements.
const ROUGH: f64 = 0.25;

/// The values `h` of `grid` at the centres of a grid with `parts` elements for each one in x and in y.
///
/// The heights are interpolated by cubics between the centres in each direction (with fewer than five elements, by the polynomial through all): this
/// is exact for cubics and adds no roughness. Slopes jump only beside holes and rough ends. Where they jump, largest pressures are infinite. In a
/// periodic direction the nearest centres may lie across its end. Beyond the outermost centres a rough surface keeps the last height, because a cubic
/// would leave the range of heights.
///
/// Parts of an element without surface (+infinity) have none. If one of the four centres has none, the line through the element and its neighbour on
/// the side of the part is used. If that neighbour has none, the line through the element and its other neighbour is used, if the three or four
/// heights on that side are smooth. Otherwise the part has the height of the element.
pub fn refine(h: &[f64], grid: &Grid, parts: (usize, usize), repeats: (bool, bool)) -> Result<Vec<f64>> {
    let (mx, my) = (grid.mx, grid.my);
    let (fine_mx, fine_my) = (mx * parts.0, my * parts.1);
    let weights = |parts: usize| -> Vec<Part> { (0..parts).map(|part| Part::new(part, parts)).collect() };
    let (in_x, in_y) = (weights(parts.0), weights(parts.1));
    let [x, y] = Direction::both(grid, repeats);

    let mut rows = zeros(fine_mx * my, "undeformed distances of a finer grid")?;
    for (row, refined) in h.chunks_exact(mx).zip(rows.chunks_exact_mut(fine_mx)) {
        for (i, value) in refined.iter_mut().enumerate() {
            *value = in_x[i % parts.0].at(i / parts.0, x, |j| row[j]);
        }
    }
    let mut fine = zeros(fine_mx * fine_my, "undeformed distances of a finer grid")?;
    for (iy, refined) in fine.chunks_exact_mut(fine_mx).enumerate() {
        for (ix, value) in refined.iter_mut().enumerate() {
            *value = in_y[iy % parts.1].at(iy / parts.1, y, |j| rows[j * fine_mx + ix]);
        }
    }
    Ok(fine)
}

/// Whether a surface with these heights at its end is smooth there, by their third difference, or the second difference of three. Two heights do not
/// suffice.
fn is_smooth(heights: &[f64]) -> bool {
    let steps = |k: usize| heights[k + 1] - heights[k];
    let (difference, count) = match heights.len() {
        4 => (steps(0) - 2.0 * steps(1) + steps(2), 3),
        3 => (steps(1) - steps(0), 2),
        _ => return false,
    };
    let largest = (0..count).fold(0.0, |largest: f64, k| largest.max(steps(k).abs()));
    difference.abs() <= ROUGH * largest
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

    /// The value at this part of element `i`.
    fn at(&self, i: usize, along: Direction, value: impl Fn(usize) -> f64) -> f64 {
        if value(i).is_infinite() {
            return f64::INFINITY;
        }
        let wanted = i as isize + first_node(self.offset);
        let count = if along.repeats { 4 } else { along.m.min(4) };
        let first = if along.repeats { wanted } else { wanted.clamp(0, (along.m - count) as isize) };
        let at = |place: isize| along.place(place).map_or(f64::INFINITY, &value);
        let nodes = [0, 1, 2, 3].map(|k| at(first + k));
        if nodes[..count].iter().any(|height| height.is_infinite()) {
            return self.beside_a_hole(i, along, value);
        }
        if count == 4 && self.is_beyond_centres(i, along) && !is_smooth(&nodes) {
            return value(i);
        }
        let through = |weights: &[f64]| weights.iter().zip(nodes).map(|(weight, node)| weight * node).sum::<f64>();
        // At the border of the grid the four nearest centres are not around the point.
        if first != wanted || count < 4 {
            let mut weights = self.weights;
            lagrange((i as isize - first) as f64 + self.offset, &mut weights[..count]);
            return through(&weights[..count]);
        }
        through(&self.weights) + self.smoothed(nodes, [first - 1, first + 4].map(at))
    }

    /// The change of the cubic through four centres to one whose slopes at the inner two are those of five centres each, the same as of the cubic on
    /// their other side. The slopes differ by a twelfth of the fourth differences. `beyond`: the centres before and behind the four.
    fn smoothed(&self, nodes: [f64; 4], beyond: [f64; 2]) -> f64 {
        let fourth = |outer: f64, [a, b, c, d]: [f64; 4]| outer - 4.0 * a + 6.0 * b - 4.0 * c + d;
        let [n0, n1, n2, n3] = nodes;
        let change = |outer: f64, nodes: [f64; 4]| {
            // Beside a hole or the border there are four centres.
            let smoothed = Some(fourth(outer, nodes) / 12.0).filter(|change| change.is_finite()).unwrap_or(0.0);
            smoothed + without_lip(outer, nodes, smoothed)
        };
        let (before, behind) = (change(beyond[0], nodes), change(beyond[1], [n3, n2, n1, n0]));
        let s = if self.offset < 0.0 { 1.0 + self.offset } else { self.offset };
        s * (1.0 - s) * ((1.0 - s) * before + s * behind)
    }

    /// Whether it lies outside the centres of the first and the last element.
    fn is_beyond_centres(&self, i: usize, along: Direction) -> bool {
        !along.repeats && (i == 0 && self.offset < 0.0 || i + 1 == along.m && self.offset > 0.0)
    }

    fn beside_a_hole(&self, i: usize, elements: Direction, value: impl Fn(usize) -> f64) -> f64 {
        let here = value(i);
        let side = |step: isize| elements.place(i as isize + step).map(&value).filter(|there| there.is_finite());
        let towards = if self.offset < 0.0 { -1 } else { 1 };
        let along = self.offset * towards as f64;
        if let Some(there) = side(towards) {
            return here + along * (there - here);
        }
        let mut behind = [here; 4];
        let count = (1..4).map_while(|k| side(-towards * k).map(|height| behind[k as usize] = height)).count();
        if is_smooth(&behind[..=count]) {
            here + along * (here - behind[1])
        } else {
            here
        }
    }
}

/// The change of the slope at the second of four centres, near a step, to one without a lip: a surface that rises above the centres beside a step would
/// carry the load there. `outer`: the centre before the four; `smoothed`: the change of the slope before.
fn without_lip(outer: f64, [n0, n1, n2, n3]: [f64; 4], smoothed: f64) -> f64 {
    let [a, b, c, d] = [n0 - outer, n1 - n0, n2 - n1, n3 - n2];
    // Beside a hole or the border the outer slope is not known: it is infinite.
    if a.is_infinite() {
        return 0.0;
    }
    let (level, step, next) =
        if b.abs() < c.abs() { (a.abs().max(b.abs()), c, d) } else { (c.abs().max(d.abs()), b, a) };
    let is_beside = STEEPER * level < step.abs() && next * step.signum() <= STEADY * step.abs();
    let is_one_before = STEEPER * b.abs().max(c.abs()) < a.abs().max(d.abs());
    if !is_beside && !is_one_before {
        return 0.0;
    }
    let slope = (6.0 * n2 - 3.0 * n1 - 2.0 * n0 - n3) / 6.0 + smoothed;
    let most = if b * c > 0.0 { MONOTONE * b.abs().min(c.abs()) } else { 0.0 };
    let limited = if slope * (b + c) > 0.0 { slope.signum() * slope.abs().min(most) } else { 0.0 };
    limited - slope
}

/// The first of the four nearest centres, relative to the element of the point.
fn first_node(offset: f64) -> isize {
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
