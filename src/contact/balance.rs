//! A prescribed force that has to be carried within an admissible set.

use std::array::from_fn;
use std::ops::Range;

use super::{AdmissibleSet, State};
use crate::blocks;
use crate::scene::Load;
use crate::sums::Sums;
use crate::threads::Threads;

/// Rounds of raising what is below its limit; each but the last brings an element to its limit, most of them many.
const ROUNDS: u32 = 50;

/// Round-off of the force, relative to the sum of all that pushes and pulls: that of a sum of 2^31 pressures in any order.
const ROUND_OFF: f64 = 1e-12;

/// Of the sum of |p|: forces of a smaller part are carried by adding, not by scaling p.
const CANCELLED: f64 = 1e-3;

/// Distances whose squares have no sum are never closed.
const OUT_OF_REACH: f64 = 1e140;

impl State {
    /// Whether p carries a prescribed force.
    pub fn carries(&self, threads: &Threads) -> bool {
        let Load::Force(force) = self.load else { return true };
        let [sum, all] = self.sum_pressures(threads, |p| [p, p.abs()]);
        let area = self.grid.element_area();
        (sum * area - force).abs() <= ROUND_OFF * (all * area + force.abs())
    }

    /// Projects p on the set, and with a prescribed force raises it to carry that: [`State::balance_force`] where no limit is reached.
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
                // Elements at their limit carry all of it, but for rounding.
                break;
            } else if missing < 0.0 {
                // Less than what is at its limit carries: that is not at its limit.
                self.p.iter_mut().for_each(|p| *p *= pressures / all);
                self.contact.iter_mut().zip(&mut self.at_limit).for_each(|(inside, at)| *inside |= std::mem::take(at));
            } else {
                self.spread(missing);
            }
            self.project(set);
        }
        None
    }

    /// A uniform pressure on C; on all that is exterior and has a surface in reach where C is empty.
    fn spread(&mut self, pressures: f64) {
        if self.contact_count() == 0 {
            for i in 0..self.h.len() {
                self.contact[i] = self.h[i].abs() < OUT_OF_REACH && !self.at_limit[i];
            }
        }
        let uniform = pressures / self.contact_count().max(1) as f64;
        self.p.iter_mut().zip(&self.contact).filter(|(_, &inside)| inside).for_each(|(p, _)| *p += uniform);
    }

    /// Whether a prescribed force is next to nothing beside what pushes and pulls: the sum of p is then round-off, and no measure of p.
    pub fn is_cancelled(&self, threads: &Threads) -> bool {
        let Load::Force(force) = self.load else { return false };
        let [all] = self.sum_pressures(threads, |p| [p.abs()]);
        force.abs() <= CANCELLED * all * self.grid.element_area()
    }

    /// On a given contact area such a force is carried by one pressure that is added everywhere.
    fn shift_mean(&mut self, threads: &Threads) {
        let Load::Force(force) = self.load else { return };
        let [all, _, count] = self.sum_on_contact(threads);
        let missing = (force / self.grid.element_area() - all) / count.max(1.0);
        self.p.iter_mut().zip(&self.contact).filter(|(_, &inside)| inside).for_each(|(p, _)| *p += missing);
    }

    /// The sums of p, of p on C, and the elements of C: by blocks, for a plain sum of many equal pressures is off by more than a force may be.
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

    /// Elements of C beyond their limit leave for it; what is at its limit has its value, what is exterior none.
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
