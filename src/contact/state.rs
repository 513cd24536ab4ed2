//! The unknowns of the contact problem on one grid: pressures, displacements, contact area and approach.

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

/// An element whose h exceeds the smallest h by more than this many indentations is never in contact.
const OUT_OF_REACH: f64 = 1e6;

/// Pressures, displacements, contact area and approach on one grid, and the undeformed distance that they belong to.
pub struct State {
    /// The grid.
    pub grid: Grid,
    /// The undeformed distance h; `+infinity` on elements without a surface.
    pub h: Vec<f64>,
    /// The pressure p: zero on exterior elements, p_max on elements at their limit.
    pub p: Vec<f64>,
    /// The displacement u = A p. `u_is` tells how accurately this holds.
    pub u: Vec<f64>,
    /// How accurately u equals A p.
    pub u_is: Freshness,
    /// The contact area C: true for each element in C.
    pub contact: Vec<bool>,
    /// True for each element at its pressure limit. Such an element is not in C. Empty if the scene has no limits.
    pub at_limit: Vec<bool>,
    /// Whether an element has reached its limit in this solve.
    pub reached_limit: bool,
    /// The approach: given, or the current estimate when the force is prescribed.
    pub approach: f64,
    /// The prescribed approach, or the prescribed force.
    pub load: Load,
    /// The round-off of a displacement per unit of pressure. Smaller differences of displacements are meaningless.
    pub round_off: f64,
}

impl State {
    /// Allocates a state whose h, p and u the caller has yet to set. `load` is the load, and the initial approach for a prescribed force.
    pub fn new(grid: Grid, load: (Load, f64), threads: &Threads) -> Result<State> {
        let mut state = State::at_rest(grid, load, threads)?;
        state.wake(threads);
        Ok(state)
    }

    /// Creates a state whose arrays h, p and u have no memory yet if they are large. Call [`wake`](State::wake) before they are used.
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

    /// Returns a copy of this state, with a copy of u.
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

    /// Makes h, p and u usable after [`rest`](State::rest). The values of arrays whose memory was released are undefined.
    pub fn wake(&mut self, threads: &Threads) {
        let n = self.grid.len();
        [&mut self.h, &mut self.p, &mut self.u].into_iter().for_each(|values| wake(values, n, f64::NAN, threads));
    }

    /// Releases the memory of h, p and u while they are not needed, if they are large.
    pub fn rest(&mut self) {
        [&mut self.h, &mut self.p, &mut self.u].into_iter().for_each(rest);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.contact.len() * (3 * size_of::<f64>() + 2 * size_of::<bool>())
    }

    /// Whether any element is at its pressure limit.
    pub fn has_limited(&self) -> bool {
        self.reached_limit && self.at_limit.contains(&true)
    }

    /// For each row with an element in C: the range of the row's elements on the grid.
    pub fn rows_with_contact(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        // The fold has no early exit, so that the compiler vectorises it.
        let touches = |row: &[bool]| row.iter().fold(false, |any, &inside| any | inside);
        let mx = self.grid.mx;
        let rows = self.contact.chunks_exact(mx).enumerate();
        rows.filter(move |(_, row)| touches(row)).map(move |(y, _)| y * mx..(y + 1) * mx)
    }

    /// The number of elements in C.
    pub fn contact_count(&self) -> usize {
        // Sums of bytes: the compiler vectorises them. At most 255 elements are added to a byte, which cannot overflow.
        let count = |part: &[bool]| part.iter().map(|&inside| u8::from(inside)).sum::<u8>();
        self.contact.chunks(u8::MAX.into()).map(|part| usize::from(count(part))).sum()
    }

    /// Whether element i is in C or at its limit.
    #[inline]
    pub fn touches(&self, i: usize) -> bool {
        self.contact[i] || self.at_limit.get(i).is_some_and(|&at_limit| at_limit)
    }

    /// Whether u is finite in the whole contact area. If u comes from a coarser grid, u is infinite outside that grid's window, and the contact area
    /// may have grown beyond the window.
    pub fn has_displacements(&self) -> bool {
        // The fold has no early exit, so that the compiler vectorises it.
        let known = |touches: &[bool], u: &[f64]| {
            touches.iter().zip(u).fold(true, |all, (touches, u)| all & (!touches | u.is_finite()))
        };
        self.rows_with_contact().all(|row| known(&self.contact[row.clone()], &self.u[row]))
            && (!self.has_limited() || known(&self.at_limit, &self.u))
    }

    /// The number of elements on the border of the grid (first or last row or column) that are in C or at their limit. If there are any, the
    /// potential contact area may be too small.
    pub fn edge_count(&self) -> usize {
        let [columns, rows, corners] = self.edge_counts();
        columns + rows - corners
    }

    /// The elements that [`edge_count`](State::edge_count) counts: the number on the first or last column, the number on the first or last row, and
    /// the number on both (corners).
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

    /// The normal force `sum of p dx dy`.
    pub fn force(&self) -> f64 {
        self.force_by(&Threads::One)
    }

    fn force_by(&self, threads: &Threads) -> f64 {
        self.pressures(threads) * self.grid.element_area()
    }

    /// The sum of all pressures, added up in blocks: if many equal pressures were added one by one, the round-off would exceed the tolerance of a
    /// force.
    pub fn pressures(&self, threads: &Threads) -> f64 {
        let [sum] = self.sum_pressures(threads, |p| [p]);
        sum
    }

    /// The K sums of `terms(p)` over all elements.
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

    /// The deformed distance `e = h - approach + u` of element i.
    pub fn deformed_distance(&self, i: usize) -> f64 {
        self.h[i] - self.approach + self.u[i]
    }

    /// If the force is prescribed: multiplies the pressures by a factor, so that they carry it. Call this before u is recomputed. Returns the
    /// factor, or None if a uniform pressure on C replaced the pressures. If C is empty, the element with the smallest h enters C first.
    pub fn balance_force(&mut self, threads: &Threads) -> Option<f64> {
        let Load::Force(force) = self.load else { return Some(1.0) };
        let carried = self.force_by(threads);
        let factor = force / carried;
        // A factor that is not positive would change the sign of all pressures.
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

    /// The cap on h for coarser grids: so large that an element with this h is never in contact, yet too small to dominate a mean of several h.
    /// `lowest` is the smallest h.
    pub fn out_of_reach(&self, lowest: f64, self_influence: f64) -> f64 {
        let lowest = Some(lowest).filter(|h| h.is_finite()).unwrap_or(0.0);
        let depth = match self.load {
            Load::Approach(approach) => approach - lowest,
            // The approach is largest if one element carries the whole force.
            Load::Force(force) => force / self.grid.element_area() * self_influence,
        };
        lowest + OUT_OF_REACH * depth.max(0.0)
    }

    /// If the force is prescribed: sets the approach that minimises the sum of e^2 over C, which is the mean of h + u over C.
    pub fn fit_approach(&mut self, threads: &Threads) {
        if let Load::Force(_) = self.load {
            // The h of the first element in C is subtracted from all terms. So the mean of equal distances is exact.
            let reference = self.rows_with_contact().flatten().find(|&i| self.contact[i]).map_or(0.0, |i| self.h[i]);
            let (sum, count) = blocks::fold(
                &self.grid,
                threads,
                (0.0, 0),
                #[inline(always)]
                |block| sum_where((&self.h[block.clone()], reference), &self.u[block.clone()], &self.contact[block]),
                |(sum, count), (of_block, count_of_block)| (sum + of_block, count + count_of_block),
            );
            if count > 0 {
                self.approach = reference + sum / count as f64;
            } else if self.has_limited() {
                // C is empty. The smallest approach with e <= 0 on all elements at their limit keeps them there.
                let held = (0..self.h.len()).filter(|&i| self.at_limit[i]).map(|i| self.h[i] + self.u[i]);
                self.approach = held.fold(f64::NEG_INFINITY, f64::max);
            }
        }
    }

    /// Discards the last result: no element is at its limit, and u is stale.
    pub fn forget(&mut self) {
        self.at_limit.fill(false);
        self.u_is = Freshness::Stale;
    }

    /// Sets p = 0 and u = A p = 0, and empties the contact area.
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
