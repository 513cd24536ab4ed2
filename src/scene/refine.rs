//! Interpolates the undeformed distance to a finer grid over the same rectangle.

use crate::direction::Direction;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;

/// A change of height between two centres is a step if it exceeds both changes on one of its sides by this factor (see also [`STEADY`]). A parabola
/// has no steps: its successive changes differ by equal amounts, so beyond a change that is 8 times another the next one is at least 15/8 of it, and
/// the outer two of four changes are at most 3 times the inner two. On waves of few elements only some intervals count as steps.
const STEEPER: f64 = 8.0;
/// The change on the other side of a step is at most this times the step.
const STEADY: f64 = 1.5;
/// Cubics between monotone heights are monotone if their slopes are at most this times the smaller adjacent secant (Fritsch and Carlson 1980).
const MONOTONE: f64 = 3.0;

/// A surface is rough at its end if the third difference there exceeds this part of the largest change of height: that of a wave of 12 elements.
const ROUGH: f64 = 0.25;

/// Interpolates the values `h` at the centres of `grid` to the centres of a finer grid, which has `parts` elements for each one in x and in y.
///
/// *Inside.* In each direction the heights are interpolated by cubics between the centres. With fewer than five elements, the polynomial through all
/// centres is used. This is exact for cubics and adds no roughness. Slopes jump only beside holes and at rough ends. (Pressures are infinite at jumps
/// of the slope.) In a periodic direction the nearest centres may lie across the end of the period.
///
/// *Ends.* Beyond the outermost centres a rough surface keeps the last height, because a cubic would leave the range of heights.
///
/// *Holes.* Parts of an element without a surface (+infinity) have none. If one of the four nearest centres of a part has no surface, the heights are
/// those of a line, the first of these that applies:
///
/// 1. through the element and its neighbour on the side of the part, if that neighbour has a surface;
/// 2. through the element and its other neighbour, if the three or four heights on that side are smooth;
/// 3. constant: the height of the element.
pub fn refine(h: &[f64], grid: &Grid, parts: (usize, usize), repeats: (bool, bool)) -> Result<Vec<f64>> {
    let (mx, my) = (grid.mx, grid.my);
    let (fine_mx, fine_my) = (mx * parts.0, my * parts.1);
    let all_parts = |parts: usize| -> Vec<Part> { (0..parts).map(|part| Part::new(part, parts)).collect() };
    let (in_x, in_y) = (all_parts(parts.0), all_parts(parts.1));
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

/// Whether a surface with these heights at its end is smooth there ([`ROUGH`]). Four heights are judged by their third difference, three by their
/// second difference. Fewer heights do not count as smooth.
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

/// One of the parts into which every element is divided in a direction.
struct Part {
    /// The position of the part's centre, relative to the centre of the element, in elements.
    offset: f64,
    /// The weights of the cubic through the four centres around the part.
    weights: [f64; 4],
}

impl Part {
    /// Part number `part` of `parts`.
    fn new(part: usize, parts: usize) -> Part {
        let offset = (part as f64 + 0.5) / parts as f64 - 0.5;
        let mut weights = [0.0; 4];
        lagrange(offset - first_node(offset) as f64, &mut weights);
        Part { offset, weights }
    }

    /// The height at this part of element `i` of a line, whose elements have the heights `value`.
    fn at(&self, i: usize, along: Direction, value: impl Fn(usize) -> f64) -> f64 {
        if value(i).is_infinite() {
            return f64::INFINITY;
        }
        let wanted = i as isize + first_node(self.offset);
        let count = if along.is_periodic { 4 } else { along.m.min(4) };
        let first = if along.is_periodic { wanted } else { wanted.clamp(0, (along.m - count) as isize) };
        let height = |position: isize| along.number(position).map_or(f64::INFINITY, &value);
        let nodes = [0, 1, 2, 3].map(|k| height(first + k));
        if nodes[..count].iter().any(|height| height.is_infinite()) {
            return self.beside_a_hole(i, along, value);
        }
        if count == 4 && self.is_beyond_centres(i, along) && !is_smooth(&nodes) {
            return value(i);
        }
        let through = |weights: &[f64]| weights.iter().zip(nodes).map(|(weight, node)| weight * node).sum::<f64>();
        // At the border of the grid, or with fewer than four elements, there are not two centres on both sides of the part.
        if first != wanted || count < 4 {
            let mut weights = self.weights;
            lagrange((i as isize - first) as f64 + self.offset, &mut weights[..count]);
            return through(&weights[..count]);
        }
        through(&self.weights) + self.correction(nodes, [first - 1, first + 4].map(height))
    }

    /// What is added to the cubic through four centres, so that slopes do not jump from one interval to the next. At each inner centre the slope
    /// becomes that of the polynomial through the five centres around it; it changes by a twelfth of the fourth difference. Near steps the slope is
    /// limited as well. `outer` are the heights before and after the four.
    fn correction(&self, nodes: [f64; 4], outer: [f64; 2]) -> f64 {
        let fourth_difference = |outer: f64, [a, b, c, d]: [f64; 4]| outer - 4.0 * a + 6.0 * b - 4.0 * c + d;
        let [n0, n1, n2, n3] = nodes;
        let change = |outer: f64, nodes: [f64; 4]| {
            // Beside a hole or the border there is no fifth centre, and the slope is not changed.
            let of_five = fourth_difference(outer, nodes) / 12.0;
            let of_five = if of_five.is_finite() { of_five } else { 0.0 };
            of_five + without_lip(outer, nodes, of_five)
        };
        let (before, after) = (change(outer[0], nodes), change(outer[1], [n3, n2, n1, n0]));
        let s = if self.offset < 0.0 { 1.0 + self.offset } else { self.offset };
        s * (1.0 - s) * ((1.0 - s) * before + s * after)
    }

    /// Whether this part of element `i` lies beyond the centre of the first or the last element of a line.
    fn is_beyond_centres(&self, i: usize, along: Direction) -> bool {
        !along.is_periodic && (i == 0 && self.offset < 0.0 || i + 1 == along.m && self.offset > 0.0)
    }

    /// The height at this part of element `i` if one of the four nearest centres has no surface: see [`refine`].
    fn beside_a_hole(&self, i: usize, along: Direction, value: impl Fn(usize) -> f64) -> f64 {
        let height = value(i);
        let neighbour = |steps: isize| along.number(i as isize + steps).map(&value).filter(|h| h.is_finite());
        let sign = if self.offset < 0.0 { -1 } else { 1 };
        let distance = self.offset * sign as f64;
        if let Some(next) = neighbour(sign) {
            return height + distance * (next - height);
        }
        // The heights from the element away from the part.
        let mut heights = [height; 4];
        let count = (1..4).map_while(|k| neighbour(-sign * k).map(|h| heights[k as usize] = h)).count();
        if is_smooth(&heights[..=count]) {
            height + distance * (height - heights[1])
        } else {
            height
        }
    }
}

/// Near a step: the change of the slope at the second of four centres after which the surface has no lip, that is, does not rise above the centres
/// beside the step. A lip would carry the load. 0 if there is no step nearby. `outer` is the height before the four, `of_five` the change of the
/// slope so far.
fn without_lip(outer: f64, [n0, n1, n2, n3]: [f64; 4], of_five: f64) -> f64 {
    let [a, b, c, d] = [n0 - outer, n1 - n0, n2 - n1, n3 - n2];
    // Beside a hole or the border the outer change is unknown: it is infinite.
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
    let slope = (6.0 * n2 - 3.0 * n1 - 2.0 * n0 - n3) / 6.0 + of_five;
    let most = if b * c > 0.0 { MONOTONE * b.abs().min(c.abs()) } else { 0.0 };
    let limited = if slope * (b + c) > 0.0 { slope.signum() * slope.abs().min(most) } else { 0.0 };
    limited - slope
}

/// The number of the first of the four nearest centres, relative to the element, for a point at `offset` from the element's centre.
fn first_node(offset: f64) -> isize {
    if offset < 0.0 {
        -2
    } else {
        -1
    }
}

/// Writes the weights of Lagrange's polynomial: its value at `t` is the weighted sum of its values at 0, 1, 2, ...
fn lagrange(t: f64, weights: &mut [f64]) {
    let count = weights.len();
    for (j, weight) in weights.iter_mut().enumerate() {
        *weight = (0..count).filter(|k| *k != j).map(|k| (t - k as f64) / (j as f64 - k as f64)).product();
    }
}
