//! Transfer of values between a grid and the next coarser grid (section 4.2 of the paper, figure 3).
//!
//! A coarse element covers up to 2 x 2 fine elements, its *children*: four by standard coarsening, fewer at the end of a row or column with an odd
//! number of elements, or if one direction is not coarsened.

use crate::grid::{children, Grid};
use crate::threads::Threads;

/// The number of coarse elements of a row that are interpolated together.
const BLOCK: usize = 32;

/// Restricts values by the mean over all children. Defects in the exterior area are zero and are included in the mean.
pub fn restrict_mean(fine: &Grid, coarse: &Grid, from: impl Fn(usize) -> f64 + Sync + Send, to: &mut [f64]) {
    let add = |(sum, count): (f64, f64), child| (sum + from(child), count + 1.0);
    collect(fine, coarse, to, add, |(sum, count)| sum / count);
}

/// Restricts the undeformed distance: takes the mean over the children that have a surface, or `+infinity` if none has. A distance above `highest`
/// counts as `highest`.
pub fn restrict_distance(fine: &Grid, coarse: &Grid, h: &[f64], highest: f64, to: &mut [f64], threads: &Threads) {
    let add = |(sum, count): (f64, f64), h: &f64| match *h {
        f64::INFINITY => (sum, count),
        h => (sum + h.min(highest), count + 1.0),
    };
    let mean = |(sum, count): (f64, f64)| if count > 0.0 { sum / count } else { f64::INFINITY };
    let columns = if coarse.mx < fine.mx { 2 } else { 1 };
    threads.for_a_pass(fine.len()).for_each_plain_row(
        to,
        coarse.mx,
        #[inline(always)]
        |y, row| {
            let mut rows = children(fine.my, coarse.my, y).map(|y| h[y * fine.mx..][..fine.mx].chunks(columns));
            let (Some(first), second) = (rows.next(), rows.next()) else { return };
            match second {
                Some(second) => row.iter_mut().zip(first.zip(second)).for_each(|(to, children)| {
                    *to = mean(match children {
                        // Four children are the common case: the compiler unrolls the loop.
                        ([a, b], [c, d]) => [a, b, c, d].into_iter().fold((0.0, 0.0), add),
                        (first, second) => first.iter().chain(second).fold((0.0, 0.0), add),
                    });
                }),
                None => {
                    row.iter_mut().zip(first).for_each(|(to, first)| *to = mean(first.iter().fold((0.0, 0.0), add)))
                }
            }
        },
    );
}

/// Restricts the contact area: a coarse element is in contact if at least half of its children are (2 of 4).
pub fn restrict_contact(fine: &Grid, coarse: &Grid, contact: &[bool], to: &mut [bool]) {
    let add = |(inside, count): (usize, usize), child: usize| (inside + usize::from(contact[child]), count + 1);
    collect(fine, coarse, to, add, |(inside, count)| 2 * inside >= count);
}

/// Sets every coarse element to `result` of the values that `add` collects from its children.
fn collect<A: Default, B>(
    fine: &Grid,
    coarse: &Grid,
    to: &mut [B],
    add: impl Fn(A, usize) -> A,
    result: impl Fn(A) -> B,
) {
    for (y, row) in to.chunks_exact_mut(coarse.mx).enumerate() {
        for (x, to) in row.iter_mut().enumerate() {
            let mut all = A::default();
            for y in children(fine.my, coarse.my, y) {
                for x in children(fine.mx, coarse.mx, x) {
                    all = add(all, y * fine.mx + x);
                }
            }
            *to = result(all);
        }
    }
}

/// Interpolates piecewise constant: calls `combine(value, coarse value)` for every fine element, which may change its value.
pub fn interpolate(fine: &Grid, coarse: &Grid, from: &[f64], to: &mut [f64], combine: impl Fn(&mut f64, f64)) {
    for (y, row) in to.chunks_exact_mut(fine.mx).enumerate() {
        interpolate_row(fine, coarse, from, y, row, &combine);
    }
}

/// Interpolates piecewise constant in row y of the fine grid; see [`interpolate`].
#[inline(always)]
pub fn interpolate_row(
    fine: &Grid,
    coarse: &Grid,
    from: &[f64],
    y: usize,
    row: &mut [f64],
    combine: impl Fn(&mut f64, f64),
) {
    let of = |fine: usize, coarse: usize| if coarse < fine { 2 } else { 1 };
    let from = &from[y / of(fine.my, coarse.my) * coarse.mx..][..coarse.mx];
    if coarse.mx == fine.mx {
        return row.iter_mut().zip(from).for_each(|(child, value)| combine(child, *value));
    }
    let mut pairs = row.chunks_exact_mut(2);
    for (pair, value) in pairs.by_ref().zip(from) {
        pair.iter_mut().for_each(|child| combine(child, *value));
    }
    if let ([child], Some(value)) = (pairs.into_remainder(), from.last()) {
        combine(child, *value);
    }
}

/// Interpolates linearly between the centres of the coarse elements. The interpolation is constant beyond the outermost centres, and next to unknown
/// values, which are `+infinity` (outside a window).
pub fn interpolate_linearly(fine: &Grid, coarse: &Grid, from: &[f64], to: &mut [f64], threads: &Threads) {
    let mix = |near: f64, far: f64| if far == f64::INFINITY { near } else { 0.75 * near + 0.25 * far };
    threads.for_a_pass(fine.len()).for_each_plain_row(
        to,
        fine.mx,
        #[inline(always)]
        |y, row| {
            // `near` is the coarse row that contains row y, `far` its neighbour on the side on which row y lies.
            let (near, far) = match (coarse.my == fine.my, y % 2) {
                (true, _) => (y, y),
                (_, 0) => (y / 2, (y / 2).saturating_sub(1)),
                _ => (y / 2, (y / 2 + 1).min(coarse.my - 1)),
            };
            let (near, far) = (&from[near * coarse.mx..][..coarse.mx], &from[far * coarse.mx..][..coarse.mx]);
            let at = |x: usize| mix(near[x], far[x]);
            if coarse.mx == fine.mx {
                row.iter_mut().enumerate().for_each(|(x, to)| *to = at(x));
                return;
            }
            // The loops are over blocks of coarse elements, with a neighbour on each side, so that the compiler vectorises them.
            let mut mixed = [0.0; BLOCK + 2];
            for (children, first) in row.chunks_mut(2 * BLOCK).zip((0..).step_by(BLOCK)) {
                let count = children.len().div_ceil(2);
                let neighbours = near[first..].iter().zip(&far[first..]);
                mixed[1..].iter_mut().zip(neighbours).for_each(|(mixed, (near, far))| *mixed = mix(*near, *far));
                mixed[0] = if first > 0 { at(first - 1) } else { mixed[1] };
                if first + count == coarse.mx {
                    mixed[count + 1] = mixed[count];
                }
                let mut pairs = children.chunks_exact_mut(2);
                for (pair, around) in pairs.by_ref().zip(mixed.windows(3)) {
                    (pair[0], pair[1]) = (mix(around[1], around[0]), mix(around[1], around[2]));
                }
                if let [last] = pairs.into_remainder() {
                    *last = mix(mixed[count], mixed[count - 1]);
                }
            }
        },
    );
}
