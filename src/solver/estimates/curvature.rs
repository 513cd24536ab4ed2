//! Second differences of the undeformed distance and of the pressures over the contact area: they measure what elements do not resolve.

use std::f64::consts::PI;

use super::jumps::{each_jump, Jump};
use crate::contact::{Outline, Problem, State};
use crate::direction::{shortest_run, Direction};
use crate::rectangle::Rectangle;

/// From this many to twice as many rows of the contact area are sampled. Means over more rows hardly differ.
const SAMPLED_ROWS: usize = 32;
/// Longest run of elements that is counted. The error from its length, `(2.5/run)^2`, is 2 %, and less for longer runs.
const LONGEST_RUN: usize = 16;

/// Second differences of h and p over the contact area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Curvature {
    /// The bend: the mean of `(dx^2 h_xx + dy^2 h_yy)/24` over the contact area, with the pressures of a flat punch as weights. With a layer of
    /// compliance c, that of h + c p. A length.
    pub bend: f64,
    /// The approach minus the lowest h of the contact area.
    pub depth: f64,
    /// The mean of `u = approach - h` with the pressures of a flat punch as weights. By Betti's theorem it is the force over dF/d(approach).
    pub displaced: f64,
    /// The mean of `|bend|/run^2` over the elements at the rim, times the weight of the rim. `run` is the length, in elements, of the shorter one of
    /// the runs of contact along x and y through the element.
    pub short: f64,
    /// rms of the second differences of p, over the rms of p.
    pub pressure: f64,
    /// The sum over the jumps J of h next to contact of `|J|` times the part of an element in which the jump may lie.
    pub jumps: f64,
    /// The largest singular pressure beside a jump of h: one where contact ends at the jump, or pressures beyond it are less than half.
    pub highest_at_jumps: f64,
}

/// Sums over the sampled elements in contact; those with `rim` over elements at the rim only.
#[derive(Default)]
struct Sums {
    bend: f64,
    h: f64,
    count: f64,
    rim_bend: f64,
    rim_h: f64,
    rim_count: f64,
    /// Sum of `|bend|/run^2`.
    rim_short: f64,
    /// Sum of the squared second differences of p.
    differences: f64,
    /// Sum of p^2.
    squares: f64,
    /// The lowest h.
    lowest: f64,
}

impl Curvature {
    /// The curvature of a state with this outline.
    pub fn of(problem: &Problem, state: &State, outline: &Outline) -> Curvature {
        let stride = (outline.rows / SAMPLED_ROWS).max(1);
        let (mx, my) = (state.grid.mx, state.grid.my);
        let (repeats, layered) = (problem.coefficients.repeats(&state.grid), problem.coefficients.has_layer());
        let directions = Direction::both(&state.grid, repeats);
        let mut sums = Sums { lowest: f64::INFINITY, ..Sums::default() };
        let touched = state.contact.chunks_exact(mx).enumerate().filter(|(_, row)| row.contains(&true));
        for (iy, row) in touched.skip(stride / 2).step_by(stride) {
            let first = row.iter().position(|&inside| inside).unwrap_or(0);
            let end = row.iter().rposition(|&inside| inside).map_or(0, |last| last + 1);
            let plain = !layered && iy > 0 && iy + 1 < my;
            for ix in (first..end).filter(|&ix| row[ix]) {
                if plain && ix > 0 && ix + 1 < mx {
                    sums.add_inner(state, &directions, iy * mx + ix);
                } else {
                    sums.add(problem, state, &directions, (ix, iy));
                }
            }
        }
        let at_jumps = AtJumps::of(problem, state, repeats);
        sums.without_jumps([at_jumps.bend, at_jumps.short].map(|sum| sum / (24 * stride) as f64));
        let of_area = area_weight(problem, state, outline);
        let of_elements = sums.curvature(state.approach, of_area);
        Curvature { jumps: at_jumps.uncertain, highest_at_jumps: at_jumps.highest, ..of_elements }
    }

    /// The element with the largest pressure `peak`, and the negative sum of the second differences of p there over the peak. This is small if
    /// elements resolve the peak. None without pressures.
    pub fn of_peak(problem: &Problem, state: &State, peak: f64) -> Option<(usize, f64)> {
        let top = state.p.iter().position(|p| *p == peak && peak > 0.0)?;
        let (mx, my) = (state.grid.mx, state.grid.my);
        let (x, y) = problem.coefficients.repeats(&state.grid);
        let (ix, iy) = (top % mx, top / mx);
        let beside = |neighbours: [Option<usize>; 2]| {
            2.0 * peak - neighbours.iter().map(|i| i.map_or(0.0, |i| state.p[i])).sum::<f64>()
        };
        let along = if mx > 1 { beside(neighbours(ix, mx, x).map(|n| n.map(|ix| iy * mx + ix))) } else { 0.0 };
        let across = if my > 1 { beside(neighbours(iy, my, y).map(|n| n.map(|iy| iy * mx + ix))) } else { 0.0 };
        Some((top, (along + across) / peak))
    }
}

impl Sums {
    /// Adds element i, which has four neighbours and no layer.
    #[inline]
    fn add_inner(&mut self, state: &State, directions: &[Direction; 2], i: usize) {
        let State { h, p, contact, grid, .. } = state;
        let (left, right, below, above) = (i - 1, i + 1, i - grid.mx, i + grid.mx);
        let second = |values: &[f64], a: usize, b: usize| values[a] + values[b] - 2.0 * values[i];
        let finite = |difference: f64| if difference.is_finite() { difference / 24.0 } else { 0.0 };
        let bend = finite(second(h, left, right)) + finite(second(h, below, above));
        let is_rim = !(contact[left] && contact[right] && contact[below] && contact[above]);
        let run = is_rim.then(|| shortest_run(directions, contact, i, LONGEST_RUN));
        let difference = second(p, left, right) + second(p, below, above);
        self.count_in(state, i, (bend, difference, run));
    }

    /// Adds any element.
    fn add(&mut self, problem: &Problem, state: &State, directions: &[Direction; 2], (ix, iy): (usize, usize)) {
        let [x, y] = directions;
        let i = iy * x.m + ix;
        let along = neighbours(ix, x.m, x.is_periodic).map(|n| n.map(|ix| iy * x.m + ix));
        let across = neighbours(iy, y.m, y.is_periodic).map(|n| n.map(|iy| iy * x.m + ix));
        // h plus the compression of the layer.
        let height = |i: usize| state.h[i] + problem.layer(i) * state.p[i];
        let (mut bend, mut difference, mut is_rim) = (0.0, 0.0, false);
        for pair in [along, across] {
            if let [Some(a), Some(b)] = pair {
                let of_h = height(a) + height(b) - 2.0 * height(i);
                bend += if of_h.is_finite() { of_h / 24.0 } else { 0.0 };
                is_rim |= !state.contact[a] || !state.contact[b];
            }
            if pair != [None, None] {
                let p = |i: Option<usize>| i.map_or(0.0, |i| state.p[i]);
                difference += p(pair[0]) + p(pair[1]) - 2.0 * state.p[i];
            }
        }
        let run = is_rim.then(|| shortest_run(directions, &state.contact, i, LONGEST_RUN));
        self.count_in(state, i, (bend, difference, run));
    }

    /// Adds element i to the sums, with its bend and its second differences of p. `run` is the shorter run through it if it is at the rim, else None.
    #[inline]
    fn count_in(&mut self, state: &State, i: usize, (bend, difference, run): (f64, f64, Option<usize>)) {
        self.bend += bend;
        self.h += state.h[i];
        self.count += 1.0;
        if let Some(run) = run {
            self.rim_bend += bend;
            self.rim_short += bend.abs() / (run * run) as f64;
            self.rim_h += state.h[i];
            self.rim_count += 1.0;
        }
        self.differences += difference * difference;
        self.squares += state.p[i] * state.p[i];
        self.lowest = self.lowest.min(state.h[i]);
    }

    /// Subtracts what jumps of h contribute to the bends of elements at the rim: a jump is no curvature.
    fn without_jumps(&mut self, [bend, short]: [f64; 2]) {
        self.bend -= bend;
        self.rim_bend -= bend;
        self.rim_short = (self.rim_short - short).max(0.0);
    }

    /// The curvature from the means over the area, with the weight `of_area`, and over the rim, with the weight `1 - of_area`.
    fn curvature(&self, approach: f64, of_area: f64) -> Curvature {
        let weighted = |sum: f64, rim: f64| {
            let mean = sum / self.count.max(1.0);
            let of_rim = if self.rim_count > 0.0 { rim / self.rim_count } else { mean };
            of_area * mean + (1.0 - of_area) * of_rim
        };
        let above = |h: f64| if self.count > 0.0 { approach - h } else { 0.0 };
        Curvature {
            bend: weighted(self.bend, self.rim_bend),
            depth: above(self.lowest),
            displaced: above(weighted(self.h, self.rim_h)),
            short: (1.0 - of_area) * self.rim_short / self.rim_count.max(1.0),
            pressure: if self.squares > 0.0 { (self.differences / self.squares).sqrt() } else { 0.0 },
            jumps: 0.0,
            highest_at_jumps: 0.0,
        }
    }
}

/// The weight w of the mean over the area: w times that mean plus 1 - w times the mean over the rim approximates the mean with the pressures of a
/// flat punch as weights.
///
/// *A half-space.* A flat punch presses most at its rim. On a circle the Laplacian of `h = r^n` has these means, with
/// `k = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2)`:
///
/// | mean | with the punch's pressures | over the area | over the rim |
/// |---|---|---|---|
/// | | n k | 2 n | n^2 |
///
/// So w = 2/3 is correct to a tenth up to n = 10. Many spots of contact hardly interact. The force of a flat punch on each is proportional to the
/// width of the spot, not to its area. The mean over all rims has these weights already. For the mean over the area, w is divided by the square root
/// of the number of spots.
///
/// *Two periods.* The more of the period is in contact, the more uniform is the punch's pressure. Strips that fill a part c of the period have the
/// pressures `cos(pi x)/sqrt(k^2 - sin^2(pi x))` with k = sin(pi c/2) (Westergaard 1939). For a wave `2 sin^2(pi x)` the mean with these weights is
/// k^2, that over the area is `m = 1 - sin(pi c)/(pi c)`, and that over the rim is 2 k^2. Hence w = `k^2/(2 k^2 - m)`, which grows from 3/4 to 1.
fn area_weight(problem: &Problem, state: &State, outline: &Outline) -> f64 {
    let (grid, count) = (&state.grid, state.contact_count());
    let repeats = problem.coefficients.repeats(grid);
    let scatter = outline.scatter(count, repeats);
    if repeats != (true, true) {
        return 2.0 / (3.0 * scatter);
    }
    let filled = PI * count as f64 / grid.len() as f64;
    let (k_squared, m) = ((0.5 * filled).sin().powi(2), 1.0 - filled.sin() / filled);
    let of_strips = if count > 0 { k_squared / (2.0 * k_squared - m) } else { 0.75 };
    // The weight of strips has gone from 3/4 towards 1 by this part: 4 w - 3. That of spots goes towards 1 by the same part.
    let of_spots = (2.0 / 3.0 + outline.straight_part() / 12.0) / scatter;
    of_spots + (1.0 - of_spots) * (4.0 * of_strips - 3.0)
}

/// Sums over the jumps of h next to contact.
#[derive(Default)]
struct AtJumps {
    /// See [`Curvature::jumps`].
    uncertain: f64,
    /// What the jumps contribute to the second differences of h at the rim.
    bend: f64,
    /// The same contributions, each absolute and divided by the squared length of the run.
    short: f64,
    /// See [`Curvature::highest_at_jumps`].
    highest: f64,
}

impl AtJumps {
    /// Sums over all jumps of h with contact on at least one side.
    fn of(problem: &Problem, state: &State, repeats: (bool, bool)) -> AtJumps {
        let (grid, contact, directions) = (&state.grid, &state.contact, Direction::both(&state.grid, repeats));
        let mut sums = AtJumps::default();
        let visit = |Jump { between: (i, j), height, uncertain, lines }: Jump| {
            sums.uncertain += lines * height.abs() * uncertain;
            let (less, more) =
                if state.p[i] < state.p[j] { (state.p[i], state.p[j]) } else { (state.p[j], state.p[i]) };
            if less < 0.5 * more {
                sums.highest = sums.highest.max(more);
            }
            // Within contact the second differences on both sides of a jump cancel. At the rim only one side is in contact.
            if contact[i] != contact[j] {
                let (inside, up) = if contact[i] { (i, height) } else { (j, -height) };
                let run = shortest_run(&directions, contact, inside, LONGEST_RUN);
                sums.bend += lines * up;
                sums.short += lines * up.abs() / (run * run) as f64;
            }
        };
        let touching = Rectangle::around_values(contact, grid, &problem.threads, |row| row.contains(&true));
        if let Some(part) = touching {
            each_jump((grid, &part), repeats, (|i: usize| state.h[i], false), |i, j| contact[i] || contact[j], visit);
        }
        sums
    }
}

/// The neighbours of element `i` in a line of `m` elements; None beyond an end without a period. A line of one element has none.
fn neighbours(i: usize, m: usize, repeats: bool) -> [Option<usize>; 2] {
    match (i, repeats && m > 1) {
        (_, _) if m == 1 => [None, None],
        (0, true) => [Some(m - 1), Some(1)],
        (0, false) => [None, Some(1)],
        (_, true) => [Some(i - 1), Some((i + 1) % m)],
        (_, false) => [Some(i - 1), Some(i + 1).filter(|next| *next < m)],
    }
}
