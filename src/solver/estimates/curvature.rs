//! The curvature of the undeformed distance and of the pressures within an element, which elements do not resolve.

use std::f64::consts::PI;

use super::jumps::{each_jump, Jump};
use crate::contact::{Outline, Problem, State};
use crate::direction::{shortest_run, Direction};
use crate::rectangle::Rectangle;

/// Least rows of the contact area that are sampled. Means over more rows hardly differ.
const SAMPLED_ROWS: usize = 32;
/// Largest run that is counted: its error, `(2.5/run)^2`, is 2 %.
const LONGEST_RUN: usize = 16;

/// Second differences of h and p over the contact area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Curvature {
    /// `(dx^2 h_xx + dy^2 h_yy)/24`, its mean over the contact area with the weights of a flat punch's pressures. With a layer c,
    /// of h + c p.
    pub bend: f64,
    /// The approach minus the lowest h.
    pub depth: f64,
    /// u = approach - h, its mean with the weights of a flat punch's pressures: the force over dF/d(approach) (Betti).
    pub displaced: f64,
    /// The mean over the rim of `|bend|/run^2`, times the weight of the rim. `run`: the elements of the shorter run
    /// through an element.
    pub short: f64,
    /// rms of the second differences of p, over that of p.
    pub pressure: f64,
    /// Jumps of h next to contact: the sum of `|J|` times the uncertain part of an element.
    pub jumps: f64,
    /// The largest pressure beside a jump of h at which contact ends, or beyond which pressures are less than half: it is singular.
    pub highest_at_jumps: f64,
}

/// Sums over some elements.
#[derive(Default)]
struct Sums {
    bend: f64,
    h: f64,
    count: f64,
    rim_bend: f64,
    rim_h: f64,
    rim_count: f64,
    rim_short: f64,
    differences: f64,
    squares: f64,
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

    /// The element with the largest pressure `peak`, and the second differences of the pressures there, over the peak: small if elements resolve it.
    /// None without pressures.
    pub fn of_peak(problem: &Problem, state: &State, peak: f64) -> Option<(usize, f64)> {
        let at = state.p.iter().position(|p| *p == peak && peak > 0.0)?;
        let (mx, my) = (state.grid.mx, state.grid.my);
        let (x, y) = problem.coefficients.repeats(&state.grid);
        let (ix, iy) = (at % mx, at / mx);
        let beside = |neighbours: [Option<usize>; 2]| {
            2.0 * peak - neighbours.iter().map(|i| i.map_or(0.0, |i| state.p[i])).sum::<f64>()
        };
        let along = if mx > 1 { beside(neighbours(ix, mx, x).map(|n| n.map(|ix| iy * mx + ix))) } else { 0.0 };
        let across = if my > 1 { beside(neighbours(iy, my, y).map(|n| n.map(|iy| iy * mx + ix))) } else { 0.0 };
        Some((at, (along + across) / peak))
    }
}

impl Sums {
    /// An element with four neighbours, without a layer.
    #[inline]
    fn add_inner(&mut self, state: &State, directions: &[Direction; 2], at: usize) {
        let State { h, p, contact, grid, .. } = state;
        let (left, right, below, above) = (at - 1, at + 1, at - grid.mx, at + grid.mx);
        let second = |values: &[f64], a: usize, b: usize| values[a] + values[b] - 2.0 * values[at];
        let finite = |difference: f64| if difference.is_finite() { difference / 24.0 } else { 0.0 };
        let bend = finite(second(h, left, right)) + finite(second(h, below, above));
        let is_rim = !(contact[left] && contact[right] && contact[below] && contact[above]);
        let rim = is_rim.then(|| shortest_run(directions, contact, at, LONGEST_RUN));
        let difference = second(p, left, right) + second(p, below, above);
        self.count_in(state, at, (bend, difference, rim));
    }

    /// Any element.
    fn add(&mut self, problem: &Problem, state: &State, directions: &[Direction; 2], (ix, iy): (usize, usize)) {
        let [x, y] = directions;
        let at = iy * x.m + ix;
        let along = neighbours(ix, x.m, x.repeats).map(|n| n.map(|ix| iy * x.m + ix));
        let across = neighbours(iy, y.m, y.repeats).map(|n| n.map(|iy| iy * x.m + ix));
        let yields = |i: usize| state.h[i] + problem.layer(i) * state.p[i];
        let (mut bend, mut difference, mut is_rim) = (0.0, 0.0, false);
        for pair in [along, across] {
            if let [Some(a), Some(b)] = pair {
                let of_h = yields(a) + yields(b) - 2.0 * yields(at);
                bend += if of_h.is_finite() { of_h / 24.0 } else { 0.0 };
                is_rim |= !state.contact[a] || !state.contact[b];
            }
            if pair != [None, None] {
                let p = |i: Option<usize>| i.map_or(0.0, |i| state.p[i]);
                difference += p(pair[0]) + p(pair[1]) - 2.0 * state.p[at];
            }
        }
        let rim = is_rim.then(|| shortest_run(directions, &state.contact, at, LONGEST_RUN));
        self.count_in(state, at, (bend, difference, rim));
    }

    /// `rim`: the shorter run of an element at the rim.
    #[inline]
    fn count_in(&mut self, state: &State, at: usize, (bend, difference, rim): (f64, f64, Option<usize>)) {
        self.bend += bend;
        self.h += state.h[at];
        self.count += 1.0;
        if let Some(run) = rim {
            self.rim_bend += bend;
            self.rim_short += bend.abs() / (run * run) as f64;
            self.rim_h += state.h[at];
            self.rim_count += 1.0;
        }
        self.differences += difference * difference;
        self.squares += state.p[at] * state.p[at];
        self.lowest = self.lowest.min(state.h[at]);
    }

    /// Subtracts the contribution of jumps to the bends of adjacent elements.
    fn without_jumps(&mut self, [bend, short]: [f64; 2]) {
        self.bend -= bend;
        self.rim_bend -= bend;
        self.rim_short = (self.rim_short - short).max(0.0);
    }

    /// Means over the area and over the rim, with `of_area` as the weight of the area.
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

/// The weight of the mean over the area against that over the rim, so that both together give the mean with the pressures of a flat punch.
///
/// A flat punch presses most at its rim. For `h = r^n` its weights give n k, the mean over the area gives 2 n and that over the rim n^2, with
/// `k = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2)`: weights of two thirds and one third are right to a tenth up to n = 10. Many places of contact
/// hardly interact. The force of a flat punch on each is proportional to its width, not its area. The mean over the rims has these weights. The mean
/// over the area is divided by the square root of the number of places.
///
/// With two periods the punch's pressure is the more uniform, the more of the period is in contact. Strips that fill a part c of the period have the
/// pressures `cos(pi x)/sqrt(k^2 - sin^2(pi x))`, k = sin(pi c/2) (Westergaard 1939). For a wave `2 sin^2(pi x)` their mean is k^2, that over the
/// area `m = 1 - sin(pi c)/(pi c)`, and that over the rim 2 k^2: the weight `k^2/(2 k^2 - m)` grows from three quarters to 1.
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
    // The weight of strips grows from three quarters to 1. Other weights approach 1 by the same fraction of their distance.
    let of_places = (2.0 / 3.0 + outline.straight_part() / 12.0) / scatter;
    of_places + (1.0 - of_places) * (4.0 * of_strips - 3.0)
}

/// Sums over the jumps of h next to contact.
#[derive(Default)]
struct AtJumps {
    /// See [`Curvature::jumps`].
    uncertain: f64,
    /// The contributions to the second differences of h at the rim: as they are, and over the squared elements of the run.
    bend: f64,
    short: f64,
    /// See [`Curvature::highest_at_jumps`].
    highest: f64,
}

impl AtJumps {
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
            // Next to a jump within contact the second differences have opposite signs.
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

/// The elements before and behind element `i` of `m`; none beyond an end without a period.
fn neighbours(i: usize, m: usize, repeats: bool) -> [Option<usize>; 2] {
    match (i, repeats && m > 1) {
        (_, _) if m == 1 => [None, None],
        (0, true) => [Some(m - 1), Some(1)],
        (0, false) => [None, Some(1)],
        (_, true) => [Some(i - 1), Some((i + 1) % m)],
        (_, false) => [Some(i - 1), Some(i + 1).filter(|next| *next < m)],
    }
}
