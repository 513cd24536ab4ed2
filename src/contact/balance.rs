//! Pressures of an admissible set that carry a prescribed force.

use std::array::from_fn;
use std::ops::Range;

use super::{AdmissibleSet, State};
use crate::blocks;
use crate::powers::LARGEST;
use crate::scene::Load;
use crate::sums::{Sums, ROUND_OFF};
use crate::threads::Threads;

/// Most rounds of [`State::carry_force`] with limits. Nearly every round but the last brings elements to their limit, mostly many.
const ROUNDS: u32 = 50;

/// Pressures cancel if |sum of p| is below this part of the sum of |p|: p then gets the force by an added pressure, not by a factor. Contact
/// pressures q and attraction cancel if p is below this part of q.
pub const CANCELLED: f64 = 1e-3;

impl State {
    /// Whether p carries a prescribed force.
    pub fn carries(&self, threads: &Threads) -> bool {
        let Load::Force(force) = self.load else { return true };
        let [sum, all] = self.sum_pressures(threads, |p| [p, p.abs()]);
        let area = self.grid.element_area();
        (sum * area - force).abs() <= ROUND_OFF * (all * area + force.abs())
    }

    /// Projects p on the set and makes it carry a prescribed force: by [`State::balance_force`] if no limit is reached.
    /// Call before u is recomputed.
    pub fn carry_force<S: AdmissibleSet>(&mut self, set: S, threads: &Threads) -> Option<f64> {
        if S::FIXED && self.is_cancelled(threads) {
            self.shift_mean(threads);
            return None;
        }
        if !S::LIMITED {
            return self.balance_force(threads);
        }
        self.project(set);
        let Load::Force(force) = self.load else { return Some(1.0) };
        if !self.has_limited() {
            let factor = self.balance_force(threads);
            self.project(set);
            if !self.has_limited() {
                return factor;
            }
        }
        let pressures = force / self.grid.element_area();
        for _ in 0..ROUNDS {
            let [all, free, _] = self.sum_on_contact(threads);
            let missing = pressures - all;
            if missing.abs() <= f64::EPSILON * pressures {
                break;
            }
            if missing + free > 0.0 && free > 0.0 {
                let factor = 1.0 + missing / free;
                self.p.iter_mut().zip(&self.contact).filter(|(_, &inside)| inside).for_each(|(p, _)| *p *= factor);
            } else if self.carries(threads) {
                // Elements at their limit carry the force up to round-off.
                break;
            } else if missing < 0.0 {
                // The force is less than that of elements at their limit: they leave the limit.
                self.p.iter_mut().for_each(|p| *p *= pressures / all);
                self.contact.iter_mut().zip(&mut self.at_limit).for_each(|(inside, at)| *inside |= std::mem::take(at));
            } else {
                self.spread(missing);
            }
            self.project(set);
        }
        None
    }

    /// Adds a uniform pressure on C. If C is empty, exterior elements with a surface in reach enter C first.
    fn spread(&mut self, pressures: f64) {
        if self.contact_count() == 0 {
            for i in 0..self.h.len() {
                self.contact[i] = self.h[i].abs() < LARGEST && !self.at_limit[i];
            }
        }
        let uniform = pressures / self.contact_count().max(1) as f64;
        self.p.iter_mut().zip(&self.contact).filter(|(_, &inside)| inside).for_each(|(p, _)| *p += uniform);
    }

    /// Whether a prescribed force is much smaller than the sum of |p|. Then a factor on p that gives the force may be far too large.
    pub fn is_cancelled(&self, threads: &Threads) -> bool {
        let Load::Force(force) = self.load else { return false };
        let [all] = self.sum_pressures(threads, |p| [p.abs()]);
        force.abs() <= CANCELLED * all * self.grid.element_area()
    }

    /// Carries a cancelled force on a given contact area by a uniform pressure added on C.
    fn shift_mean(&mut self, threads: &Threads) {
        let Load::Force(force) = self.load else { return };
        let [all, _, count] = self.sum_on_contact(threads);
        let missing = (force / self.grid.element_area() - all) / count.max(1.0);
        self.p.iter_mut().zip(&self.contact).filter(|(_, &inside)| inside).for_each(|(p, _)| *p += missing);
    }

    /// The sum of p, the sum of p on C, and the number of elements in C. In blocks: the round-off of a plain sum of many equal pressures exceeds
    /// [`ROUND_OFF`].
    fn sum_on_contact(&self, threads: &Threads) -> [f64; 3] {
        let of_block = |block: Range<usize>| {
            let mut sums = Sums::new();
            sums.add([&self.p[block.clone()]], [&self.contact[block]], |[p], [inside]| {
                [p, if inside > 0.0 { p } else { 0.0 }, inside]
            });
            sums.values()
        };
        blocks::fold(&self.grid, threads, [0.0; 3], of_block, |sums, block| from_fn(|k| sums[k] + block[k]))
    }

    /// Moves elements of C with a pressure above their limit to the limit. Sets p to the limit there, and to 0 on exterior elements.
    pub fn project<S: AdmissibleSet>(&mut self, set: S) {
        if !S::LIMITED || !self.reached_limit && !set.any_beyond(0, self.p.iter().copied()) {
            return;
        }
        for i in 0..self.p.len() {
            if self.contact[i] && self.p[i] > set.limit(i) {
                (self.contact[i], self.at_limit[i], self.reached_limit) = (false, true, true);
            }
            if self.at_limit[i] {
                self.p[i] = set.limit(i);
            } else if !self.contact[i] {
                self.p[i] = 0.0;
            }
        }
    }
}
