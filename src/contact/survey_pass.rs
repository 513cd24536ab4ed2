//! The loop over the elements of a state that computes a [`Survey`].

use std::array::from_fn;
use std::ops::Range;

use super::State;
use crate::blocks::LANES;

/// The measures of a state whose u is A p, as sums, norms and extremes over its elements. The certificate follows from them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Survey {
    /// 2-norm over C of `e = h - approach + u`.
    pub residual: f64,
    /// 2-norm over C of `h - approach`, to which `residual` is relative.
    pub distance: f64,
    /// The rms of `h - approach` over C and the elements at their limit, to which `violation` is relative.
    pub scale: f64,
    /// The largest `-e` in the exterior area or e of an element at its limit, a length. 0 if neither is positive.
    pub violation: f64,
    /// The number of elements in C or at their limit.
    pub contact_count: usize,
    /// The sum of p.
    pub pressures: f64,
    /// The sum of p^2.
    pub squares: f64,
    /// The smallest p, and the largest p.
    pub range: (f64, f64),
    /// First `sum of p |e|`, to which an element at its limit adds only if e > 0; second `sum of p |u|`.
    pub work: (f64, f64),
}

/// The number of elements in a chunk. Loops over a chunk are vectorised.
const CHUNK: usize = 64;

/// The sums of e^2 and `(h - approach)^2` over C, and of p, p^2, `p |e|` and `p |u|` over all elements. Each sum has 64 parts: part k adds up the
/// elements with number k in their chunk.
type Parts = [[f64; CHUNK]; 6];

/// Adds a range of elements to the sums of a survey. Elements at their limit add only their p, p^2, `p |e|` and `p |u|` here;
/// `Survey::add_limited` adds the rest. The code is compiled for the vector length of this machine, on which no bit depends.
pub(super) struct Pass<'a> {
    pub state: &'a State,
    pub elements: Range<usize>,
    pub survey: &'a mut Survey,
}

impl pulp::NullaryFnOnce for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Pass { state, elements, survey } = self;
        let (mut sums, mut count): (Parts, u64) = ([[0.0; CHUNK]; 6], 0);
        let mut range = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
        for start in elements.clone().step_by(CHUNK) {
            let chunk = start..elements.end.min(start + CHUNK);
            let (penetrates, loaded) = signs(state, chunk.clone());
            if penetrates {
                survey.violation = survey.violation.max(deepest(state, chunk.clone()));
            }
            if loaded {
                count += add(state, chunk.clone(), &mut sums);
                extremes(&mut range, &state.p[chunk]);
            } else {
                extremes(&mut range, &[0.0]);
            }
        }
        let [rr, hh, pressures, squares, gaps, energy] = sums.each_mut().map(total);
        survey.residual += rr;
        survey.distance += hh;
        survey.contact_count += count as usize;
        survey.pressures += pressures;
        survey.squares += squares;
        survey.work = (survey.work.0 + gaps, survey.work.1 + energy);
        let (low, high) = (range.0.into_iter(), range.1.into_iter());
        survey.range = (low.fold(survey.range.0, f64::min), high.fold(survey.range.1, f64::max));
    }
}

/// Tells whether any element outside C penetrates (e < 0), and whether any element is in C or has a pressure. In most chunks no element penetrates,
/// and in many no element is in contact: then the loops for such elements are left out. Signs and zeros are tested as bits, without branches.
#[inline(always)]
fn signs(state: &State, elements: Range<usize>) -> (bool, bool) {
    let (h, u) = (&state.h[elements.clone()], &state.u[elements.clone()]);
    let (p, contact) = (&state.p[elements.clone()], &state.contact[elements]);
    let (mut penetrates, mut loaded) = (0, 0);
    for (((h, u), p), inside) in h.iter().zip(u).zip(p).zip(contact) {
        let inside = u64::from(*inside);
        penetrates |= (h - state.approach + u).to_bits() >> 63 & !inside;
        loaded |= p.to_bits() << 1 | inside;
    }
    (penetrates != 0, loaded != 0)
}

/// Adds at most [`CHUNK`] elements to the sums. Returns the number of elements in C.
#[inline(always)]
fn add(state: &State, elements: Range<usize>, sums: &mut Parts) -> u64 {
    let (approach, limited, n) = (state.approach, !state.at_limit.is_empty(), elements.len());
    let (h, u) = (&state.h[elements.clone()][..n], &state.u[elements.clone()][..n]);
    let (p, contact) = (&state.p[elements.clone()][..n], &state.contact[elements][..n]);
    let [rr, hh, pressures, squares, gaps, energy] = sums.each_mut().map(|sums| &mut sums[..n]);
    for i in 0..n {
        let distance = h[i] - approach;
        let e = distance + u[i];
        // A product by 0 would make NaN of the infinite distances of elements without a surface. Instead a mask clears the bits of terms that do not
        // count.
        let (inside, presses) = (u64::from(contact[i]).wrapping_neg(), u64::from(p[i] != 0.0).wrapping_neg());
        rr[i] += f64::from_bits((e * e).to_bits() & inside);
        hh[i] += f64::from_bits((distance * distance).to_bits() & inside);
        pressures[i] += p[i];
        squares[i] += p[i] * p[i];
        // An element at its limit has a pressure but is not in C: e > 0 counts, e < 0 does not. The comparison is false for NaN.
        let gap = if limited && !contact[i] && e < 0.0 { 0.0 } else { e.abs() };
        gaps[i] += f64::from_bits((p[i] * gap).to_bits() & presses);
        energy[i] += f64::from_bits((p[i] * u[i].abs()).to_bits() & presses);
    }
    contact.iter().map(|inside| u64::from(*inside)).sum()
}

/// Adds up all parts of a sum: the second half is added to the first, and so on.
#[inline(always)]
fn total(parts: &mut [f64; CHUNK]) -> f64 {
    let mut n = CHUNK / 2;
    while n > 0 {
        let (sums, added) = parts.split_at_mut(n);
        sums.iter_mut().zip(added).for_each(|(sum, part)| *sum += *part);
        n /= 2;
    }
    parts[0]
}

/// Updates the smallest and the largest value of each lane by `values`.
#[inline(always)]
fn extremes((low, high): &mut ([f64; LANES], [f64; LANES]), values: &[f64]) {
    let (lanes, rest) = pulp::as_arrays::<LANES, f64>(values);
    // Two loops: one loop for both is not vectorised.
    for values in lanes {
        *low = from_fn(|lane| if values[lane] < low[lane] { values[lane] } else { low[lane] });
    }
    for values in lanes {
        *high = from_fn(|lane| if values[lane] > high[lane] { values[lane] } else { high[lane] });
    }
    for value in rest {
        (low[0], high[0]) = (low[0].min(*value), high[0].max(*value));
    }
}

/// The largest `-e` of exterior elements, or 0 if none is positive.
#[inline(always)]
fn deepest(state: &State, elements: Range<usize>) -> f64 {
    let approach = state.approach;
    let deeper = |so_far: f64, h: f64, u: f64, counts: bool| {
        let depth = if counts { approach - h - u } else { 0.0 };
        if depth > so_far {
            depth
        } else {
            so_far
        }
    };
    if !state.at_limit.is_empty() {
        let free = |i: usize| !state.contact[i] && !state.at_limit[i];
        return elements.fold(0.0, |so_far, i| deeper(so_far, state.h[i], state.u[i], free(i)));
    }
    let (h, of_rest_h) = pulp::as_arrays::<LANES, f64>(&state.h[elements.clone()]);
    let (u, of_rest_u) = pulp::as_arrays::<LANES, f64>(&state.u[elements.clone()]);
    let (contact, of_rest) = pulp::as_arrays::<LANES, bool>(&state.contact[elements]);
    let mut deepest = [0.0; LANES];
    for ((h, u), contact) in h.iter().zip(u).zip(contact) {
        deepest = from_fn(|lane| deeper(deepest[lane], h[lane], u[lane], !contact[lane]));
    }
    let rest = of_rest_h.iter().zip(of_rest_u).zip(of_rest);
    let of_rest = rest.fold(0.0, |so_far, ((h, u), inside)| deeper(so_far, *h, *u, !inside));
    deepest.into_iter().fold(of_rest, f64::max)
}

#[cfg(test)]
#[path = "../../tests/unit/survey_pass.rs"]
mod tests;
