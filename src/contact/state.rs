//! The unknowns of one grid and their status.

use std::array::from_fn;
use std::ops::Range;

use super::values::lowest;
pub use super::values::Freshness;
use crate::blocks;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{asleep, copied, keep, rest, wake, zeros};
use crate::scene::Load;
use crate::sums::{sum_where, Sums};
use crate::threads::Threads;

/// Elements that are higher above the lowest one than this many indentations are never in contact.
const OUT_OF_REACH: f64 = 1e6;

/// Pressures, displacements and contact area on one grid, with their undeformed distance.
pub struct State {
    /// The grid.
    pub grid: Grid,
    /// h; `+infinity` where there is no surface.
    pub h: Vec<f64>,
    /// p: zero on exterior elements, the limit on elements at their limit.
    pub p: Vec<f64>,
    /// u = A p. `u_is` tells how accurately.
    pub u: Vec<f64>,
    /// The freshness of u.
    pub u_is: Freshness,
    /// C.
    pub contact: Vec<bool>,
    /// Elements at their limit, which are not in C. Empty if the scene has no limits.
    pub at_limit: Vec<bool>,
    /// Whether an element has reached its limit in this solve.
    pub reached_limit: bool,
    /// The approach: given, or the current estimate when the force is prescribed.
    pub approach: f64,
    /// The load.
    pub load: Load,
    /// The round-off of a displacement per unit of pressure. Smaller differences are meaningless.
    pub round_off: f64,
}

impl State {
    /// A state whose undeformed distance, pressures and displacements are still to be set. `load` includes the initial approach for a prescribed
    /// force.
    pub fn new(grid: Grid, load: (Load, f64), threads: &Threads) -> Result<State> {
        let mut state = State::at_rest(grid, load, threads)?;
        state.wake(threads);
        Ok(state)
    }

    /// A new state with its large arrays at rest. [`wake`](State::wake) them before use.
    pub fn at_rest(grid: Grid, (load, estimate): (Load, f64), threads: &Threads) -> Result<State> {
        let mut arrays = [Vec::new(), Vec::new(), Vec::new()];
        for (values, what) in arrays.iter_mut().zip(["undeformed distances", "pressures", "displacements"]) {
            asleep(values, grid.len(), f64::NAN, what, threads)?;
        }
        let [h, p, u] = arrays;
        let approach = match load {
            Load::Approach(approach) => approach,
            Load::Force(_) => estimate,
        };
        Ok(State {
            grid,
            h,
            p,
            u,
            u_is: Freshness::Stale,
            contact: zeros(grid.len(), "contact")?,
            at_limit: Vec::new(),
            reached_limit: false,
            approach,
            load,
            round_off: 0.0,
        })
    }

    /// A copy.
    pub fn copy(&self, threads: &Threads) -> Result<State> {
        let mut copy = State::new(self.grid, (self.load, self.approach), threads)?;
        copy.h.copy_from_slice(&self.h);
        copy.p.copy_from_slice(&self.p);
        copy.u.copy_from_slice(&self.u);
        copy.contact.copy_from_slice(&self.contact);
        copy.at_limit = copied(&self.at_limit, "elements at their limit")?;
        (copy.u_is, copy.reached_limit, copy.approach) = (self.u_is, self.reached_limit, self.approach);
        copy.round_off = self.round_off;
        Ok(copy)
    }

    /// Wakes h, p and u.
    pub fn wake(&mut self, threads: &Threads) {
        let n = self.grid.len();
        [&mut self.h, &mut self.p, &mut self.u].into_iter().for_each(|values| wake(values, n, f64::NAN, threads));
    }

    /// Lets h, p and u rest.
    pub fn rest(&mut self) {
        [&mut self.h, &mut self.p, &mut self.u].into_iter().for_each(rest);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.contact.len() * (3 * size_of::<f64>() + size_of::<bool>())
    }

    /// Whether an element is at its limit.
    pub fn has_limited(&self) -> bool {
        self.reached_limit && self.at_limit.contains(&true)
    }

    /// The rows that have an element in contact.
    pub fn rows_with_contact(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        // The fold has no early exit, so that the compiler vectorises it.
        let touches = |row: &[bool]| row.iter().fold(false, |any, &inside| any | inside);
        let mx = self.grid.mx;
        let rows = self.contact.chunks_exact(mx).enumerate();
        rows.filter(move |(_, row)| touches(row)).map(move |(y, _)| y * mx..(y + 1) * mx)
    }

    /// Elements in contact.
    pub fn contact_count(&self) -> usize {
        // The compiler vectorises sums of bytes.
        let count = |part: &[bool]| part.iter().map(|&inside| u8::from(inside)).sum::<u8>();
        self.contact.chunks(u8::MAX.into()).map(|part| usize::from(count(part))).sum()
    }

    /// Whether element i is in contact, free or at its limit.
    #[inline]
    pub fn touches(&self, i: usize) -> bool {
        self.contact[i] || self.at_limit.get(i).is_some_and(|&at_limit| at_limit)
    }

    /// Whether u is finite in the whole contact area. u is infinite outside the window of a coarser grid, and the contact area may have grown beyond
    /// it.
    pub fn has_displacements(&self) -> bool {
        // The fold has no early exit, so that the compiler vectorises it.
        let known = |touches: &[bool], u: &[f64]| {
            touches.iter().zip(u).fold(true, |all, (touches, u)| all & (!touches | u.is_finite()))
        };
        self.rows_with_contact().all(|row| known(&self.contact[row.clone()], &self.u[row]))
            && (!self.has_limited() || known(&self.at_limit, &self.u))
    }

    /// Elements in contact, free or at their limit, on the first or last row or column. If there are any, the potential contact area may be too
    /// small.
    pub fn edge_count(&self) -> usize {
        let [columns, rows, corners] = self.edge_counts();
        columns + rows - corners
    }

    /// The elements of [`edge_count`](State::edge_count) on the first or last column, on the first or last row, and on
    /// both.
    pub fn edge_counts(&self) -> [usize; 3] {
        let Grid { mx, my, .. } = self.grid;
        let mut counts = [0; 3];
        let mut count = |touches: &[bool]| {
            for (iy, row) in touches.chunks_exact(mx).enumerate() {
                let ends = usize::from(row[0]) + row[1..].last().map_or(0, |last| usize::from(*last));
                counts[0] += ends;
                if iy == 0 || iy + 1 == my {
                    counts[1] += row.iter().filter(|&&inside| inside).count();
                    counts[2] += ends;
                }
            }
        };
        count(&self.contact);
        // No element is both in C and at its limit.
        if self.has_limited() {
            count(&self.at_limit);
        }
        counts
    }

    /// `sum of p dx dy`.
    pub fn force(&self) -> f64 {
        self.force_by(&Threads::One)
    }

    fn force_by(&self, threads: &Threads) -> f64 {
        self.pressures(threads) * self.grid.element_area()
    }

    /// The sum of all pressures, by blocks. The round-off of a plain sum of many equal values exceeds the tolerance of a force.
    pub fn pressures(&self, threads: &Threads) -> f64 {
        let [sum] = self.sum_pressures(threads, |p| [p]);
        sum
    }

    /// Sums over all pressures.
    pub(super) fn sum_pressures<const K: usize>(
        &self,
        threads: &Threads,
        terms: impl Fn(f64) -> [f64; K] + Sync + Send,
    ) -> [f64; K] {
        blocks::fold(
            &self.grid,
            threads,
            [0.0; K],
            #[inline(always)]
            |block| {
                let mut sums = Sums::new();
                sums.add::<f64, 1, 0>([&self.p[block]], [], |[p], []| terms(p));
                sums.values()
            },
            |sums, of_block| from_fn(|k| sums[k] + of_block[k]),
        )
    }

    /// `e = h - approach + u` of element i.
    pub fn deformed_distance(&self, i: usize) -> f64 {
        self.h[i] - self.approach + self.u[i]
    }

    /// With a prescribed force: scales the pressures to carry it. Call it before u is recomputed. Returns the factor. None if
    /// uniform pressures replaced the pressures; without contact the lowest element carries all.
    pub fn balance_force(&mut self, threads: &Threads) -> Option<f64> {
        let Load::Force(force) = self.load else { return Some(1.0) };
        let carried = self.force_by(threads);
        let factor = force / carried;
        // Force and pressures have the same sign.
        if carried != 0.0 && factor.is_finite() && factor > 0.0 {
            if factor != 1.0 {
                threads.for_a_pass(self.p.len()).for_each_plain_row(&mut self.p, self.grid.mx, |_, row| {
                    row.iter_mut().for_each(|p| *p *= factor);
                });
            }
            return Some(factor);
        }
        // Pressures that are too small or too large to be scaled (none yet, all truncated, a guess) are replaced by a uniform pressure.
        if force > 0.0 && self.contact_count() == 0 {
            let touched = Some(lowest(&self.h)).filter(|h| h.is_finite());
            if let Some(i) = touched.and_then(|lowest| self.h.iter().position(|h| *h == lowest)) {
                self.contact[i] = true;
            }
        }
        let uniform = force / (self.grid.element_area() * self.contact_count().max(1) as f64);
        self.p.iter_mut().zip(&self.contact).for_each(|(p, &inside)| *p = if inside { uniform } else { 0.0 });
        None
    }

    /// The cap on h for coarser grids. It is beyond any contact, yet too small to dominate a mean. `lowest` is the least h.
    pub fn out_of_reach(&self, lowest: f64, self_influence: f64) -> f64 {
        let lowest = Some(lowest).filter(|h| h.is_finite()).unwrap_or(0.0);
        let depth = match self.load {
            Load::Approach(approach) => approach - lowest,
            // The approach is largest if one element carries the whole force.
            Load::Force(force) => force / self.grid.element_area() * self_influence,
        };
        lowest + OUT_OF_REACH * depth.max(0.0)
    }

    /// With a prescribed force: sets the least-squares approach, the mean of h + u over the contact area.
    pub fn fit_approach(&mut self, threads: &Threads) {
        if let Load::Force(_) = self.load {
            // The sum is relative to one of the elements. So the mean of equal distances is exact.
            let own = self.rows_with_contact().flatten().find(|&i| self.contact[i]).map_or(0.0, |i| self.h[i]);
            let (sum, count) = blocks::fold(
                &self.grid,
                threads,
                (0.0, 0),
                #[inline(always)]
                |block| sum_where((&self.h[block.clone()], own), &self.u[block.clone()], &self.contact[block]),
                |(sum, count), (of_block, count_of_block)| (sum + of_block, count + count_of_block),
            );
            if count > 0 {
                self.approach = own + sum / count as f64;
            } else if self.has_limited() {
                // C is empty: the least approach that keeps all elements at their limit.
                let held = (0..self.h.len()).filter(|&i| self.at_limit[i]).map(|i| self.h[i] + self.u[i]);
                self.approach = held.fold(f64::NEG_INFINITY, f64::max);
            }
        }
    }

    /// Discards the last result.
    pub fn forget(&mut self) {
        self.at_limit.fill(false);
        self.u_is = Freshness::Stale;
    }

    /// Sets p = 0 and u = A p = 0, without contact.
    pub fn unload(&mut self) {
        self.p.fill(0.0);
        self.u.fill(0.0);
        self.contact.fill(false);
        self.at_limit.fill(false);
        self.u_is = Freshness::Exact;
    }
}

impl Drop for State {
    fn drop(&mut self) {
        keep([&mut self.h, &mut self.p, &mut self.u]);
        keep([&mut self.contact, &mut self.at_limit]);
    }
}
