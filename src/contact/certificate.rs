//! How well the contact conditions hold: everything here is computed from p, h and a fresh u = A p.

use std::ops::Range;

use super::{AdmissibleSet, State};
use crate::grid::Grid;
use crate::threads::Threads;

/// The measures of a solution. Status OK means that they hold to the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certificate {
    /// `||h - approach + A p|| / ||h - approach||`, 2-norms over C.
    pub residual: f64,
    /// Largest `-e` over the exterior area, or e over the elements at their limit, 0 when there is none: a length.
    pub violation: f64,
    /// `sum of p |e| / sum of p |u|` over all elements: pressures times gaps, against the elastic energy.
    pub complementarity: f64,
    /// Smallest pressure.
    pub min_pressure: f64,
}

/// The round-off of `h - approach` where h is the approach: a sum and a mean of equal numbers. Distances below it are those of bodies that
/// fit exactly; larger ones, though round-off of a huge offset they may be, are not taken for none.
const ROUND_OFF: f64 = 2.0 * f64::EPSILON;

/// Blocks of rows, the sums of which are added in order.
const BLOCKS: usize = 64;
/// Parts of each sum of a row: an addition does not wait for the one before.
const LANES: usize = 4;

/// What one pass over a state whose u is A p tells.
#[derive(Clone, Copy, Debug, Default)]
pub struct Survey {
    /// 2-norm over C of `e = h - approach + u`.
    pub residual: f64,
    /// 2-norm over C of `h - approach`: what residuals are compared with.
    pub distance: f64,
    /// rms of the same over C and the elements at their limit: what violations are compared with.
    pub scale: f64,
    /// Largest `-e` over the exterior area, or e over the elements at their limit; 0 when there is none.
    pub violation: f64,
    /// Elements in contact, free or at their limit.
    pub contact_count: usize,
    /// Sum of p.
    pub pressures: f64,
    /// Sum of p^2.
    pub squares: f64,
    /// Smallest and largest p.
    pub range: (f64, f64),
    /// `sum of p |e|` and `sum of p |u|`; of elements at their limit only e > 0 counts.
    pub work: (f64, f64),
}

impl Survey {
    /// Surveys a state.
    pub fn of(state: &State) -> Survey {
        Survey::by(state, &Threads::One)
    }

    /// The same by several threads: block of rows by block, so that they make no difference.
    pub fn by(state: &State, threads: &Threads) -> Survey {
        let Grid { mx, my, .. } = state.grid;
        let nothing = Survey { range: (f64::INFINITY, f64::NEG_INFINITY), ..Survey::default() };
        let rows = my.div_ceil(BLOCKS);
        let add = |b: usize, block: &mut Survey| {
            (b * rows..((b + 1) * rows).min(my)).for_each(|y| block.add_rows(state, y * mx..(y + 1) * mx));
        };
        let (count, threads) = (my.div_ceil(rows), threads.for_a_pass(mx * my));
        let mut survey = nothing;
        if threads.count() == 1 {
            for b in 0..count {
                let mut block = nothing;
                add(b, &mut block);
                survey = survey.joined(&block);
            }
        } else {
            let mut blocks = [nothing; BLOCKS];
            threads.for_each(&mut blocks[..count], add);
            survey = blocks[..count].iter().fold(survey, Survey::joined);
        }
        let mut touching = survey.distance;
        if state.has_limited() {
            touching += survey.add_limited(state);
        }
        survey.scale = (touching / survey.contact_count.max(1) as f64).sqrt();
        survey.finish(state);
        survey
    }

    /// Of two parts of a grid, before norms are made of sums.
    fn joined(self, other: &Survey) -> Survey {
        Survey {
            residual: self.residual + other.residual,
            distance: self.distance + other.distance,
            scale: 0.0,
            violation: self.violation.max(other.violation),
            contact_count: self.contact_count + other.contact_count,
            pressures: self.pressures + other.pressures,
            squares: self.squares + other.squares,
            range: (self.range.0.min(other.range.0), self.range.1.max(other.range.1)),
            work: (self.work.0 + other.work.0, self.work.1 + other.work.1),
        }
    }

    /// Norms from sums. What is a difference of terms that are equal but for round-off is 0.
    fn finish(&mut self, state: &State) {
        (self.residual, self.distance) = (self.residual.sqrt(), self.distance.sqrt());
        let offset = ROUND_OFF * state.approach.abs();
        let noise = offset * (self.contact_count as f64).sqrt() + state.round_off * self.squares.sqrt();
        if noise.is_finite() && self.distance <= noise && self.residual <= noise {
            self.residual = 0.0;
            let largest = offset + state.round_off * self.range.1;
            if self.violation <= largest {
                self.violation = 0.0;
            }
            self.work.0 = 0.0;
        }
    }

    /// A row of elements; those at their limit count as exterior until [`add_limited`](Self::add_limited) corrects that.
    fn add_rows(&mut self, state: &State, row: Range<usize>) {
        let (h, u) = (&state.h[row.clone()], &state.u[row.clone()]);
        let (p, contact) = (&state.p[row.clone()], &state.contact[row.clone()]);
        // Most rows have no element that penetrates, and many none in contact: both the compiler can vectorise.
        let (mut penetrates, mut loaded) = (false, false);
        for i in 0..h.len() {
            penetrates |= !contact[i] & (h[i] - state.approach + u[i] < 0.0);
            loaded |= contact[i] | (p[i] != 0.0);
        }
        if penetrates {
            let free = |i: &usize| !contact[*i] && !state.at_limit.get(row.start + i).is_some_and(|at_limit| *at_limit);
            for i in (0..h.len()).filter(free) {
                self.violation = self.violation.max(state.approach - h[i] - u[i]);
            }
        }
        if loaded {
            self.add_row(state.approach, h, u, p, contact);
        } else {
            self.range = (self.range.0.min(0.0), self.range.1.max(0.0));
        }
    }

    /// Elements at their limit: their e must not be positive. Returns their sum of `(h - approach)^2`.
    fn add_limited(&mut self, state: &State) -> f64 {
        let mut touching = 0.0;
        for i in (0..state.p.len()).filter(|&i| state.at_limit[i]) {
            let (p, e) = (state.p[i], state.deformed_distance(i));
            self.contact_count += 1;
            self.violation = self.violation.max(e);
            self.work.0 += p * (e.max(0.0) - e.abs());
            touching += (state.h[i] - state.approach).powi(2);
        }
        touching
    }

    /// The columns of a row from the first to the last that is in contact or has a pressure.
    fn add_row(&mut self, approach: f64, h: &[f64], u: &[f64], p: &[f64], contact: &[bool]) {
        let counts = |i: &usize| contact[*i] || p[*i] != 0.0;
        let Some(first) = (0..h.len()).find(counts) else { return };
        let end = (first..h.len()).rev().find(counts).map_or(first, |last| last + 1);
        if first > 0 || end < h.len() {
            self.range = (self.range.0.min(0.0), self.range.1.max(0.0));
        }
        let (mut sums, mut count) = ([[0.0; LANES]; 6], 0);
        let mut add = |i: usize, lane: usize| {
            let (p, inside) = (p[i], contact[i]);
            let distance = h[i] - approach;
            let e = distance + u[i];
            self.range = (self.range.0.min(p), self.range.1.max(p));
            count += usize::from(inside);
            // Distances of elements without a surface are infinite.
            let zero_or = |counts: bool, value: f64| if counts { value } else { 0.0 };
            let (rr, hh) = (zero_or(inside, e * e), zero_or(inside, distance * distance));
            let (gap, energy) = (zero_or(p != 0.0, p * e.abs()), zero_or(p != 0.0, p * u[i].abs()));
            for (sum, term) in sums.iter_mut().zip([rr, hh, p, p * p, gap, energy]) {
                sum[lane] += term;
            }
        };
        let whole = end - (end - first) % LANES;
        (first..whole).step_by(LANES).for_each(|i| (0..LANES).for_each(|lane| add(i + lane, lane)));
        (whole..end).for_each(|i| add(i, i - whole));
        let [rr, hh, pressures, squares, gaps, energy] = sums.map(|lanes| lanes.iter().sum::<f64>());
        self.residual += rr;
        self.distance += hh;
        self.contact_count += count;
        self.pressures += pressures;
        self.squares += squares;
        self.work = (self.work.0 + gaps, self.work.1 + energy);
    }

    /// How far the conditions are from being met: the larger of the relative residual and the relative violation, p = 0 having 1; infinite
    /// where pressures are not admissible. `max` alone would drop what is not a number.
    pub fn violation<S: AdmissibleSet>(&self, _: S) -> f64 {
        let relative = |value: f64, scale: f64| if value == 0.0 { 0.0 } else { value / scale };
        let residual = relative(self.residual, self.distance);
        let violation = if S::FIXED { 0.0 } else { relative(self.violation, self.scale) };
        let admissible = S::FIXED || self.range.0 >= 0.0;
        match residual.max(violation) {
            worst if admissible && worst >= residual && worst >= violation => worst,
            _ => f64::INFINITY,
        }
    }

    /// The measures of the solution.
    pub fn certificate(&self) -> Certificate {
        let relative = |value: f64, scale: f64| if value == 0.0 { 0.0 } else { value / scale };
        Certificate {
            residual: relative(self.residual, self.distance),
            violation: self.violation,
            complementarity: relative(self.work.0.max(0.0), self.work.1),
            min_pressure: self.range.0,
        }
    }
}

/// 2-norm over C of `h - approach`.
pub fn norm_of_distance(state: &State) -> f64 {
    over_contact(state, |i| state.h[i] - state.approach)
}

/// 2-norm over C of `h - approach + u`.
pub fn residual_norm(state: &State) -> f64 {
    over_contact(state, |i| state.deformed_distance(i))
}

fn over_contact(state: &State, value: impl Fn(usize) -> f64) -> f64 {
    let mut sum = 0.0;
    for i in state.rows_with_contact().flatten().filter(|&i| state.contact[i]) {
        sum += value(i) * value(i);
    }
    sum.sqrt()
}
