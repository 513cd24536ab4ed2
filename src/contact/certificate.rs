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
/// Elements of a row whose terms are computed together: many at a time, which the compiler can vectorise.
const CHUNK: usize = 64;
/// Elements at the ends of a row that are skipped together.
const MANY: usize = 32;

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
        let add = |b: usize, survey: &mut Survey, terms: &mut Terms| {
            pulp::Arch::new().dispatch(Block { state, rows: b * rows..((b + 1) * rows).min(my), survey, terms });
        };
        let (count, threads) = (my.div_ceil(rows), threads.for_a_pass(mx * my));
        let mut survey = nothing;
        if threads.count() == 1 {
            let mut terms = [[0.0; CHUNK]; 6];
            for b in 0..count {
                let mut block = nothing;
                add(b, &mut block, &mut terms);
                survey = survey.joined(&block);
            }
        } else {
            let mut blocks = [nothing; BLOCKS];
            threads.for_each(&mut blocks[..count], |b, block| add(b, block, &mut [[0.0; CHUNK]; 6]));
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
    #[inline(always)]
    fn add_elements(&mut self, state: &State, row: Range<usize>, terms: &mut Terms) {
        let approach = state.approach;
        let (h, u) = (&state.h[row.clone()], &state.u[row.clone()]);
        let (p, contact) = (&state.p[row.clone()], &state.contact[row.clone()]);
        // Most rows have no element that penetrates, and many none in contact. Signs and zeros are bits, which the compiler can vectorise.
        let (mut penetrates, mut loaded) = (0, 0);
        for (((h, u), p), inside) in h.iter().zip(u).zip(p).zip(contact) {
            let inside = u64::from(*inside);
            penetrates |= (h - approach + u).to_bits() >> 63 & !inside;
            loaded |= p.to_bits() << 1 | inside;
        }
        if penetrates != 0 && state.at_limit.is_empty() {
            self.violation = self.violation.max(deepest(approach, h, u, contact));
        } else if penetrates != 0 {
            let free = |i: &usize| !contact[*i] && !state.at_limit[row.start + i];
            for i in (0..h.len()).filter(free) {
                self.violation = self.violation.max(approach - h[i] - u[i]);
            }
        }
        if loaded != 0 {
            self.add_columns(approach, (h, u, p, contact), terms);
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
    #[inline(always)]
    fn add_columns(&mut self, approach: f64, (h, u, p, contact): Columns<'_>, terms: &mut Terms) {
        let counts = |i: &usize| contact[*i] || p[*i] != 0.0;
        let before = MANY * p.chunks_exact(MANY).zip(contact.chunks_exact(MANY)).take_while(is_idle).count();
        let Some(first) = (before..h.len()).find(counts) else { return };
        let after = MANY * p.rchunks_exact(MANY).zip(contact.rchunks_exact(MANY)).take_while(is_idle).count();
        let end = (first..h.len() - after).rev().find(counts).map_or(first, |last| last + 1);
        if first > 0 || end < h.len() {
            self.range = (self.range.0.min(0.0), self.range.1.max(0.0));
        }
        let mut row = Row::new(terms);
        for start in (first..end).step_by(CHUNK) {
            let of = start..end.min(start + CHUNK);
            row.add(approach, (&h[of.clone()], &u[of.clone()], &p[of.clone()], &contact[of]));
        }
        let [rr, hh, pressures, squares, gaps, energy] = row.sums.map(|lanes| lanes.iter().sum::<f64>());
        self.residual += rr;
        self.distance += hh;
        self.contact_count += row.count as usize;
        self.pressures += pressures;
        self.squares += squares;
        self.work = (self.work.0 + gaps, self.work.1 + energy);
        let (low, high) = (row.low.into_iter(), row.high.into_iter());
        self.range = (low.fold(self.range.0, f64::min), high.fold(self.range.1, f64::max));
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

/// Rows that are added to a survey; compiled for the vectors of this machine, on which no bit depends.
struct Block<'a> {
    state: &'a State,
    rows: Range<usize>,
    survey: &'a mut Survey,
    terms: &'a mut Terms,
}

impl pulp::NullaryFnOnce for Block<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let mx = self.state.grid.mx;
        for y in self.rows {
            self.survey.add_elements(self.state, y * mx..(y + 1) * mx, self.terms);
        }
    }
}

/// h, u, p and C of some elements of a row.
type Columns<'a> = (&'a [f64], &'a [f64], &'a [f64], &'a [bool]);
/// Of some elements: e^2 and `(h - approach)^2` over C, p, p^2, `p |e|` and `p |u|`.
type Terms = [[f64; CHUNK]; 6];

/// What a row adds to a survey.
struct Row<'a> {
    terms: &'a mut Terms,
    /// Of the terms, in lanes.
    sums: [[f64; LANES]; 6],
    /// Elements in contact.
    count: u64,
    /// Least and greatest p, in lanes.
    low: [f64; LANES],
    high: [f64; LANES],
}

impl Row<'_> {
    /// Nothing yet.
    #[inline(always)]
    fn new(terms: &mut Terms) -> Row<'_> {
        let sums = [[0.0; LANES]; 6];
        Row { terms, sums, count: 0, low: [f64::INFINITY; LANES], high: [f64::NEG_INFINITY; LANES] }
    }

    /// Adds at most [`CHUNK`] elements.
    #[inline(always)]
    fn add(&mut self, approach: f64, (h, u, p, contact): Columns<'_>) {
        let n = h.len();
        let [rr, hh, pressures, squares, gaps, energy] = self.terms.each_mut().map(|terms| &mut terms[..n]);
        let (u, p, contact) = (&u[..n], &p[..n], &contact[..n]);
        for i in 0..n {
            let distance = h[i] - approach;
            let e = distance + u[i];
            // Distances of elements without a surface are infinite: their bits are cleared.
            let counts = u64::from(contact[i]).wrapping_neg();
            rr[i] = f64::from_bits((e * e).to_bits() & counts);
            hh[i] = f64::from_bits((distance * distance).to_bits() & counts);
            pressures[i] = p[i];
            squares[i] = p[i] * p[i];
            gaps[i] = if p[i] != 0.0 { p[i] * e.abs() } else { 0.0 };
            energy[i] = if p[i] != 0.0 { p[i] * u[i].abs() } else { 0.0 };
        }
        self.count += contact.iter().map(|inside| u64::from(*inside)).sum::<u64>();
        let lanes = p.chunks_exact(LANES);
        for &p in lanes.remainder() {
            (self.low[0], self.high[0]) = (self.low[0].min(p), self.high[0].max(p));
        }
        for p in lanes {
            for ((low, high), &p) in self.low.iter_mut().zip(&mut self.high).zip(p) {
                (*low, *high) = (if p < *low { p } else { *low }, if p > *high { p } else { *high });
            }
        }
        let whole = n.next_multiple_of(LANES);
        self.terms.iter_mut().for_each(|terms| terms[n..whole].fill(0.0));
        // All sums together: none waits for its last addition.
        for start in (0..whole).step_by(LANES) {
            for (sums, terms) in self.sums.iter_mut().zip(&*self.terms) {
                sums.iter_mut().zip(&terms[start..start + LANES]).for_each(|(sum, term)| *sum += term);
            }
        }
    }
}

/// Whether some elements are neither in contact nor under load.
#[inline(always)]
fn is_idle((p, contact): &(&[f64], &[bool])) -> bool {
    let elements = p.iter().zip(*contact);
    elements.fold(0, |loaded, (p, inside)| loaded | p.to_bits() << 1 | u64::from(*inside)) == 0
}

/// The largest `-e` over the exterior elements of a row, or 0.
#[inline(always)]
fn deepest(approach: f64, h: &[f64], u: &[f64], contact: &[bool]) -> f64 {
    const LANES: usize = 8;
    let deeper = |so_far: f64, h: f64, u: f64, inside: bool| {
        let depth = if inside { 0.0 } else { approach - h - u };
        if depth > so_far {
            depth
        } else {
            so_far
        }
    };
    let mut deepest = [0.0; LANES];
    let whole = h.len() - h.len() % LANES;
    for start in (0..whole).step_by(LANES) {
        let lanes = start..start + LANES;
        let (h, u, contact) = (&h[lanes.clone()], &u[lanes.clone()], &contact[lanes]);
        for lane in 0..LANES {
            deepest[lane] = deeper(deepest[lane], h[lane], u[lane], contact[lane]);
        }
    }
    let rest = (whole..h.len()).fold(0.0, |so_far, i| deeper(so_far, h[i], u[i], contact[i]));
    deepest.into_iter().fold(rest, f64::max)
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
