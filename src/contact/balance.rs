//! Makes pressures of an admissible set carry a prescribed force.

use std::array::from_fn;
use std::ops::Range;

use super::{AdmissibleSet, State};
use crate::blocks;
use crate::powers::LARGEST;
use crate::scene::Load;
use crate::sums::{Sums, ROUND_OFF};
use crate::threads::Threads;

/// The largest number of rounds of [`State::carry_force`] with limits. Nearly every round except the last brings elements to their limit, usually
/// many.
const ROUNDS: u32 = 50;

/// Pressures of both signs cancel if |sum of p| is below this part of the sum of |p|. Then p is made to carry the force by an added uniform pressure,
/// not by a factor. With adhesion, contact pressures q and attraction cancel if their sum p is below this part of q.
pub const CANCELLED: f64 = 1e-3;

impl State {
    /// Whether p carries the prescribed force up to round-off. True if the approach is prescribed.
    pub fn carries(&self, threads: &Threads) -> bool {
        let Load::Force(force) = self.load else { return true };
        let [sum, all] = self.sum_pressures(threads, |p| [p, p.abs()]);
        let area = self.grid.element_area();
        (sum * area - force).abs() <= ROUND_OFF * (all * area + force.abs())
    }

    /// Projects p on the set and makes p carry a prescribed force. If no element reaches its limit, [`State::balance_force`] does this, and the
    /// result is its factor. Otherwise the result is None. Call this function before u is recomputed.
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
                // The elements at their limit carry more than the force: all of them leave their limit.
                self.p.iter_mut().for_each(|p| *p *= pressures / all);
                self.contact.iter_mut().zip(&mut self.at_limit).for_each(|(inside, at)| *inside |= std::mem::take(at));
            } else {
                self.spread(missing);
            }
            self.project(set);
        }
        None
    }

    /// Adds a uniform pressure on C, whose sum over C is `pressures`. If C is empty, all elements with |h| < [`LARGEST`] that are not at their limit
    /// enter C first.
    fn spread(&mut self, pressures: f64) {
        if self.contact_count() == 0 {
            for i in 0..self.h.len() {
                self.contact[i] = self.h[i].abs() < LARGEST && !self.at_limit[i];
            }
        }
        let uniform = pressures / self.contact_count().max(1) as f64;
        self.p.iter_mut().zip(&self.contact).filter(|(_, &inside)| inside).for_each(|(p, _)| *p += uniform);
    }

    /// Whether a prescribed force is much smaller than the force of |p|. Then the factor that makes p carry the force may be far too large.
    pub fn is_cancelled(&self, threads: &Threads) -> bool {
        let Load::Force(force) = self.load else { return false };
        let [all] = self.sum_pressures(threads, |p| [p.abs()]);
        force.abs() <= CANCELLED * all * self.grid.element_area()
    }

    /// Makes p carry the prescribed force by a uniform pressure added on C.
    fn shift_mean(&mut self, threads: &Threads) {
        let Load::Force(force) = self.load else { return };
        let [all, _, count] = self.sum_on_contact(threads);
        let missing = (force / self.grid.element_area() - all) / count.max(1.0);
        self.p.iter_mut().zip(&self.contact).filter(|(_, &inside)| inside).for_each(|(p, _)| *p += missing);
    }

    /// Returns the sum of p, the sum of p on C, and the number of elements in C. The sums are taken in blocks: if many equal pressures were added one
    /// by one, the round-off would exceed [`ROUND_OFF`].
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
