//! The contact area as a list of segments, and loops over the segments.
//!
//! A *segment* is a group of eight neighbours of which at least one is in contact. Contact is often a small part of the grid, so loops touch the
//! segments only. On a rough surface about five neighbours are in contact, which do not fill a segment. The other elements of a segment are computed
//! as well and masked, without a branch.
//!
//! The grid is divided into *blocks* of segments, which threads process in parallel. Each block has sums of its elements, which are added in the
//! order of the blocks. Neither the blocks nor the bits of the sums depend on the number of threads.

mod arrays;
mod block;
mod lists;
mod over;
mod passes;

use std::mem::take;
use std::ops::Range;

use arrays::{eights, rest};
pub use block::{Becomes, Block, Terms, Wanted};

use crate::blocks::{BLOCK, BLOCKS, LANES};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{keep, reserve, sparse};
use crate::threads::Threads;

/// The largest number of sums in one loop.
const MOST_SUMS: usize = 9;

/// The segments of all blocks.
pub struct Segments {
    /// The number of elements of a block, a multiple of eight. The last block may have fewer.
    block: usize,
    /// For each block: its segments.
    found: Vec<Found>,
    /// The number of elements in contact.
    count: usize,
    /// The version of the contact area, which increases with each change.
    version: u64,
    /// For each block: its sums in the last loop.
    sums: Vec<[f64; MOST_SUMS]>,
    /// For each block: the elements that the last loop listed, because they may enter or leave C.
    listed: Vec<Vec<u32>>,
    threads: Threads,
}

/// The segments of one block.
#[derive(Default)]
struct Found {
    /// The numbers of the segments; number k has the elements 8 k to 8 k + 7 of the block.
    segments: Vec<u32>,
    /// The number of elements in contact.
    count: usize,
    /// Whether the contact area has changed since the segments were found.
    changed: bool,
    /// The version of the contact area in which the segments were found.
    version: u64,
}

impl Found {
    /// The block of these segments, which begins at the element `start` and has at most `length` elements.
    fn block<'a>(&'a self, start: usize, length: usize, contact: &'a [bool]) -> Block<'a> {
        Block::new(start, contact, length, &self.segments)
    }
}

impl Segments {
    /// Creates the list of an empty contact area. Memory for any contact area is reserved, and first touched when needed.
    pub fn new(grid: &Grid, threads: &Threads) -> Result<Segments> {
        let block = (grid.rows_of_blocks(BLOCKS, BLOCK) * grid.mx).next_multiple_of(LANES);
        let blocks = grid.len().div_ceil(block);
        let mut found = Vec::new();
        found.resize_with(blocks, Found::default);
        for found in &mut found {
            reserve(&mut found.segments, block / LANES, "the contact area")?;
        }
        let listed = (0..blocks).map(|_| sparse(block, "the contact area")).collect::<par::Result<_>>()?;
        let sums = vec![[0.0; MOST_SUMS]; blocks];
        Ok(Segments { block, found, count: 0, version: 0, sums, listed, threads: threads.clone() })
    }

    /// The number of elements in contact.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The version of the contact area, which increases with each change.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Whether any of these elements may have entered or left C since a version.
    pub fn changed_since(&self, version: u64, elements: Range<usize>) -> bool {
        self.found[elements.start / self.block..elements.end.div_ceil(self.block)]
            .iter()
            .any(|block| block.version > version)
    }

    /// Calls `changes(element)` for each element that the last loop listed, in the order of the blocks. `changes` returns whether the element enters
    /// or leaves C.
    pub fn change_listed(&mut self, mut changes: impl FnMut(usize) -> bool) {
        for (block, listed) in self.found.iter_mut().zip(&self.listed) {
            for &i in listed {
                block.changed |= changes(i as usize);
            }
        }
    }

    /// Marks the segments of all blocks as out of date.
    pub fn change_all(&mut self) {
        self.found.iter_mut().for_each(|block| block.changed = true);
    }

    /// Whether the segments of all blocks are up to date.
    fn are_found(&self) -> bool {
        !self.found.iter().any(|block| block.changed)
    }

    /// Finds the segments of the blocks in which the contact area has changed.
    pub fn find(&mut self, contact: &[bool]) {
        if self.are_found() {
            return;
        }
        self.version += 1;
        let (length, now) = (self.block, self.version);
        self.threads.for_each_plain_row(
            &mut self.found,
            1,
            #[inline(always)]
            |b, found| {
                let Found { segments, count, changed, version } = &mut found[0];
                if take(changed) {
                    *version = now;
                    let start = b * length;
                    *count = find_segments(&contact[start..contact.len().min(start + length)], segments);
                }
            },
        );
        self.count = self.found.iter().map(|block| block.count).sum();
    }

    /// Adds up the sums of all blocks, which `work(block)` returns. The segments of `contact` must be up to date.
    pub fn sum<const K: usize>(
        &mut self,
        contact: &[bool],
        work: impl Fn(Block<'_>) -> [f64; K] + Sync + Send,
    ) -> [f64; K] {
        debug_assert!(self.are_found(), "segments of the contact area before");
        let (found, length) = (&self.found, self.block);
        self.threads.for_each_plain_row(
            &mut self.sums,
            1,
            #[inline(always)]
            |b, total| {
                total[0][..K].copy_from_slice(&work(found[b].block(b * length, length, contact)));
            },
        );
        self.total()
    }

    /// As [`sum`](Self::sum), where `work(block, its part of data)` also changes `data`.
    pub fn sum_changing<A: Send, const K: usize>(
        &mut self,
        contact: &[bool],
        data: &mut [A],
        work: impl Fn(Block<'_>, &mut [A]) -> [f64; K] + Sync + Send,
    ) -> [f64; K] {
        debug_assert!(self.are_found(), "segments of the contact area before");
        let (found, length) = (&self.found, self.block);
        self.threads.for_each_row_pair(
            (data, length),
            (&mut self.sums[..], 1),
            #[inline(always)]
            |b, data, total| {
                total[0][..K].copy_from_slice(&work(found[b].block(b * length, length, contact), data));
            },
        );
        self.total()
    }

    /// Calls `work(block, its part of data, list)` for each block. It may change the data, and adds elements that may enter or leave C to the list.
    pub fn list_changing<A: Send>(
        &mut self,
        contact: &[bool],
        data: &mut [A],
        work: impl Fn(Block<'_>, &mut [A], &mut Vec<u32>) + Sync + Send,
    ) {
        let (found, length) = (&self.found, self.block);
        self.threads.for_each_row_pair(
            (data, length),
            (&mut self.listed[..], 1),
            #[inline(always)]
            |b, data, listed| {
                listed[0].clear();
                work(found[b].block(b * length, length, contact), data, &mut listed[0]);
            },
        );
    }

    /// The elements that the last loop listed, in the order of the blocks.
    pub fn listed(&self) -> impl Iterator<Item = usize> + '_ {
        self.listed.iter().flatten().map(|&i| i as usize)
    }

    /// The sums of all blocks, added up in the order of the blocks.
    fn total<const K: usize>(&self) -> [f64; K] {
        let mut total = [0.0; K];
        for sums in &self.sums {
            total.iter_mut().zip(sums).for_each(|(total, sum)| *total += sum);
        }
        total
    }
}

impl Drop for Segments {
    fn drop(&mut self) {
        self.found.iter_mut().for_each(|block| keep([&mut block.segments]));
    }
}

/// Finds the segments of a block. Returns the number of its elements in contact.
#[inline(always)]
fn find_segments(contact: &[bool], segments: &mut Vec<u32>) -> usize {
    segments.clear();
    let mut count = 0;
    for (k, eight) in eights(contact).iter().chain([&rest(contact)]).enumerate() {
        let inside = u64::from_le_bytes(eight.map(u8::from));
        if inside != 0 {
            segments.push(k as u32);
            count += inside.count_ones() as usize;
        }
    }
    count
}

#[cfg(test)]
#[path = "../../../../tests/unit/segments.rs"]
mod tests;
