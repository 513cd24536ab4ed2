//! Residuals continued outside C, for the preconditioner.
//!
//! On C, `A_CC^-1 r` is the least of `v . A^-1 v` over all fields v that are r on C. A continuation E of r beside C therefore makes
//! `E' M E`, with M near A^-1, a better inverse of `A_CC` than zeros outside do, and no continuation makes it too small. Here an element
//! outside takes a part of what lies about it in C, less the farther C is:
//!
//! ```text
//! coarse value = mean of the children's in C, or in what is known of them
//! E r = r in C;   DECAY times the interpolated coarse value outside, on each of LEVELS grids, from the coarsest
//! ```
//!
//! On rough surfaces, whose C is many small spots, it saves up to a third of the products (docs/friction.md).

use super::Pair;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{blank, keep};
use crate::operator::fft::Real;
use crate::threads::Threads;

/// Coarser grids: C reaches eight elements far.
const LEVELS: usize = 3;
/// How much of the coarse value is left on the next finer grid.
const DECAY: f64 = 0.7;

/// E, and its transpose.
#[derive(Default)]
pub struct Extension<T: Real> {
    /// The given grid first; none before it is set up.
    grids: Vec<Fields<T>>,
}

/// One grid.
struct Fields<T: Real> {
    mx: usize,
    my: usize,
    /// Those that work on it.
    threads: Threads,
    /// 0 where a value is known: in C, or where a child's is; [`DECAY`] elsewhere.
    decay: Vec<T>,
    /// 1 over the number of known children, 0 where there is none; of the given grid there are no children.
    share: Vec<T>,
    /// Coarse values; of the given grid none.
    values: Vec<Pair<T>>,
    /// One row for each row of this grid: the next coarser grid's values between its rows, or this one's summed up along x.
    rows: Vec<Pair<T>>,
}

impl<T: Real> Fields<T> {
    fn new(mx: usize, my: usize, is_given: bool, threads: &Threads) -> Result<Fields<T>> {
        let (what, nothing) = ("the continuation of residuals", [T::nan(); 2]);
        let coarse = if is_given { 0 } else { mx * my };
        let rows = blank(my * mx.div_ceil(2), nothing, what)?;
        let (decay, share) = (blank(mx * my, T::nan(), what)?, blank(coarse, T::nan(), what)?);
        let values = blank(coarse, nothing, what)?;
        Ok(Fields { mx, my, threads: threads.suited_to(mx * my), decay, share, values, rows })
    }
}

impl<T: Real> Drop for Fields<T> {
    fn drop(&mut self) {
        keep([&mut self.decay, &mut self.share]);
        keep([&mut self.values, &mut self.rows]);
    }
}

impl<T: Real> Extension<T> {
    /// For a grid.
    pub fn new(grid: &Grid, threads: &Threads) -> Result<Extension<T>> {
        let (mut mx, mut my) = (grid.mx, grid.my);
        let mut grids = vec![Fields::new(mx, my, true, threads)?];
        for _ in 0..LEVELS {
            (mx, my) = (mx.div_ceil(2), my.div_ceil(2));
            grids.push(Fields::new(mx, my, false, threads)?);
        }
        Ok(Extension { grids })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let of = |fields: &Fields<T>| {
            let Fields { decay, share, values, rows, .. } = fields;
            size_of_val(&decay[..]) + size_of_val(&share[..]) + size_of_val(&values[..]) + size_of_val(&rows[..])
        };
        self.grids.iter().map(of).sum()
    }

    /// For a grid, where it is not there yet.
    pub fn fit(&mut self, grid: &Grid, threads: &Threads) -> Result<()> {
        if self.grids.is_empty() {
            *self = Extension::new(grid, threads)?;
        }
        Ok(())
    }

    /// C has changed: where `bound` is positive.
    pub fn contact_changed(&mut self, bound: &[f64]) {
        let decay = |is_known: bool| if is_known { T::zero() } else { T::of(DECAY) };
        let Some(given) = self.grids.first_mut() else { return };
        let mx = given.mx;
        given.threads.for_each_plain_row(&mut given.decay, mx, |iy, row| {
            row.iter_mut().zip(&bound[iy * mx..]).for_each(|(decay_of, g)| *decay_of = decay(*g > 0.0));
        });
        for l in 1..self.grids.len() {
            let (fine, coarse) = pair(&mut self.grids, l);
            let (mx, fine_mx) = (coarse.mx, fine.mx);
            let (share, decays) = ((&mut coarse.share[..], mx), (&mut coarse.decay[..], mx));
            fine.threads.for_each_row_pair(share, decays, |iy, share, decay_of| {
                share.fill(T::zero());
                let end = (2 * (iy + 1)).min(fine.my);
                for row in fine.decay[2 * iy * fine_mx..end * fine_mx].chunks_exact(fine_mx) {
                    for (count, children) in share.iter_mut().zip(row.chunks(2)) {
                        *count += T::of(children.iter().filter(|decay| decay.is_zero()).count() as f64);
                    }
                }
                for (share, decay_of) in share.iter_mut().zip(decay_of) {
                    *decay_of = decay(*share > T::zero());
                    *share = if *share > T::zero() { T::one() / *share } else { T::zero() };
                }
            });
        }
    }

    /// E r: fills in what is not known of `r`, which is zero there.
    pub fn fill(&mut self, r: &mut [Pair<T>]) {
        for l in 1..self.grids.len() {
            let (fine, coarse) = pair(&mut self.grids, l);
            let (mx, share) = (fine.mx, &coarse.share);
            let from = if l == 1 { &*r } else { &fine.values };
            fine.threads.for_each_plain_row(&mut coarse.values, coarse.mx, |iy, to| {
                let end = (2 * (iy + 1)).min(fine.my);
                sum_of_children(&from[2 * iy * mx..end * mx], mx, to);
                let share = &share[iy * to.len()..(iy + 1) * to.len()];
                to.iter_mut().zip(share).for_each(|(to, share)| *to = to.map(|sum| *share * sum));
            });
        }
        for l in (1..self.grids.len()).rev() {
            let (fine, coarse) = pair(&mut self.grids, l);
            let Fields { mx, decay, values, rows, threads, .. } = fine;
            let to = if l == 1 { &mut *r } else { values };
            threads.for_each_row_pair((to, *mx), (rows, coarse.mx), |iy, to, between| {
                let [(own, near), (other, far)] = neighbours(iy, coarse.my);
                let (own, other) = (coarse.row(own), coarse.row(other));
                for ((between, own), other) in between.iter_mut().zip(own).zip(other) {
                    *between = plus(own.map(|value| T::of(near) * value), T::of(far), *other);
                }
                add_between(between, &decay[iy * *mx..(iy + 1) * *mx], to);
            });
        }
    }

    /// E' z in C; elsewhere z is left as it is.
    pub fn fold(&mut self, z: &mut [Pair<T>]) {
        for l in 1..self.grids.len() {
            let (fine, coarse) = pair(&mut self.grids, l);
            let Fields { mx, my, decay, values, rows, threads, .. } = fine;
            let (mx, my, width) = (*mx, *my, coarse.mx);
            let from = if l == 1 { &*z } else { values };
            threads.for_each_plain_row(rows, width, |iy, sums| {
                let row = iy * mx..(iy + 1) * mx;
                sum_between(&from[row.clone()], &decay[row], sums);
            });
            let (rows, coarse_my) = (&*rows, coarse.my);
            threads.for_each_plain_row(&mut coarse.values, width, |k, sums| {
                sums.fill(none());
                for iy in (2 * k).saturating_sub(1)..(2 * k + 3).min(my) {
                    let weight: f64 =
                        neighbours(iy, coarse_my).iter().filter(|near| near.0 == k).map(|near| near.1).sum();
                    let row = &rows[iy * width..(iy + 1) * width];
                    sums.iter_mut().zip(row).for_each(|(sum, value)| *sum = plus(*sum, T::of(weight), *value));
                }
            });
        }
        for l in (1..self.grids.len()).rev() {
            let (fine, coarse) = pair(&mut self.grids, l);
            let Fields { mx, decay, values, threads, .. } = fine;
            let to = if l == 1 { &mut *z } else { values };
            let (mx, width) = (*mx, coarse.mx);
            threads.for_each_plain_row(to, mx, |iy, to| {
                let row = (iy / 2) * width..(iy / 2 + 1) * width;
                let known = decay[iy * mx..(iy + 1) * mx].chunks(2);
                let from = coarse.values[row.clone()].iter().zip(&coarse.share[row]);
                for ((to, known), (value, share)) in to.chunks_mut(2).zip(known).zip(from) {
                    for (to, decay) in to.iter_mut().zip(known) {
                        let share = if decay.is_zero() { *share } else { T::zero() };
                        *to = plus(*to, share, *value);
                    }
                }
            });
        }
    }
}

/// `v + a w`.
#[inline]
fn plus<T: Real>(v: Pair<T>, a: T, w: Pair<T>) -> Pair<T> {
    [v[0] + a * w[0], v[1] + a * w[1]]
}

#[inline]
fn none<T: Real>() -> Pair<T> {
    [T::zero(); 2]
}

/// The grid before l, and l.
fn pair<T: Real>(grids: &mut [Fields<T>], l: usize) -> (&mut Fields<T>, &mut Fields<T>) {
    let (fine, coarse) = grids.split_at_mut(l);
    (&mut fine[l - 1], &mut coarse[0])
}

impl<T: Real> Fields<T> {
    /// A row of the values.
    fn row(&self, iy: usize) -> &[Pair<T>] {
        &self.values[iy * self.mx..(iy + 1) * self.mx]
    }
}

/// The sums of up to two rows, `mx` long, by pairs along x.
fn sum_of_children<T: Real>(rows: &[Pair<T>], mx: usize, to: &mut [Pair<T>]) {
    to.fill(none());
    for row in rows.chunks_exact(mx) {
        let pairs = row.chunks_exact(2);
        if let ([last], Some(to)) = (pairs.remainder(), to.last_mut()) {
            *to = plus(*to, T::one(), *last);
        }
        for (to, pair) in to.iter_mut().zip(pairs) {
            *to = [to[0] + (pair[0][0] + pair[1][0]), to[1] + (pair[0][1] + pair[1][1])];
        }
    }
}

/// Adds to a fine row `factor` times the coarse row, interpolated.
fn add_between<T: Real>(coarse: &[Pair<T>], factor: &[T], fine: &mut [Pair<T>]) {
    let ends = [0, fine.len() - 1];
    for i in ends.into_iter().take(fine.len()) {
        let [(own, near), (other, far)] = neighbours(i, coarse.len());
        let value = plus(coarse[own].map(|value| T::of(near) * value), T::of(far), coarse[other]);
        fine[i] = plus(fine[i], factor[i], value);
    }
    if fine.len() < 3 {
        return;
    }
    // Between the ends come the right child of k and the left child of k + 1.
    let (near, far) = (T::of(0.75), T::of(0.25));
    let inner = 1..fine.len() - 1;
    let (to, factor) = (&mut fine[inner.clone()], &factor[inner]);
    for (k, (to, factor)) in to.chunks_mut(2).zip(factor.chunks(2)).enumerate() {
        let (left, right) = (coarse[k], coarse[k + 1]);
        to[0] = plus(to[0], factor[0], plus(left.map(|value| near * value), far, right));
        if let ([_, to], [_, factor]) = (to, factor) {
            *to = plus(*to, *factor, plus(right.map(|value| near * value), far, left));
        }
    }
}

/// The transpose of [`add_between`]: `factor` times a fine row, summed up on a coarse one.
fn sum_between<T: Real>(fine: &[Pair<T>], factor: &[T], coarse: &mut [Pair<T>]) {
    coarse.fill(none());
    let ends = [0, fine.len() - 1];
    for i in ends.into_iter().take(fine.len()) {
        for (k, weight) in neighbours(i, coarse.len()) {
            coarse[k] = plus(coarse[k], T::of(weight) * factor[i], fine[i]);
        }
    }
    if fine.len() < 3 {
        return;
    }
    let (near, far, inner) = (T::of(0.75), T::of(0.25), 1..fine.len() - 1);
    let (from, factor) = (&fine[inner.clone()], &factor[inner]);
    for (k, (from, factor)) in from.chunks(2).zip(factor.chunks(2)).enumerate() {
        let value = |i: usize| from[i].map(|value| factor[i] * value);
        let left = value(0);
        let right = if from.len() == 2 { value(1) } else { none() };
        coarse[k] = plus(plus(coarse[k], near, left), far, right);
        coarse[k + 1] = plus(plus(coarse[k + 1], far, left), near, right);
    }
}

/// The two coarse places between which a fine one lies, and their weights.
pub fn neighbours(fine: usize, coarse: usize) -> [(usize, f64); 2] {
    let own = fine / 2;
    let other = if fine % 2 == 0 { own.checked_sub(1) } else { Some(own + 1).filter(|k| *k < coarse) };
    other.map_or([(own, 1.0), (own, 0.0)], |other| [(own, 0.75), (other, 0.25)])
}

#[cfg(test)]
#[path = "../../tests/unit/friction_extension.rs"]
mod tests;
