//! The contact area as runs of elements, and sums over it.
//!
//! Contact is often a small part of the grid and mostly in one piece: passes over runs touch nothing else, and work on slices.
//! Sums are taken per block of rows and added in the order of the blocks, which do not depend on the number of threads: nor do the
//! bits of the sums.

use std::mem::take;
use std::ops::Range;

use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{keep, reserve, sparse};
use crate::sums::Sums;
use crate::threads::Threads;

/// Blocks of rows at most, and elements of a block at least: each costs some additions.
const BLOCKS: usize = 64;
const LEAST: usize = 512;
/// Elements that are compared at a time, one in each byte of a word.
const EIGHT: usize = 8;
/// Sums at most that a pass takes.
const MOST_SUMS: usize = 9;

/// The runs of all rows.
pub struct Segments {
    mx: usize,
    /// Elements of a block.
    block: usize,
    found: Vec<Found>,
    /// Elements in contact.
    count: usize,
    /// How often it was found anew.
    version: u64,
    sums: Vec<[f64; MOST_SUMS]>,
    /// Elements of each block.
    listed: Vec<Vec<u32>>,
    threads: Threads,
}

/// The runs of a block, as elements `start..end` of the grid.
#[derive(Default)]
struct Found {
    runs: Vec<(u32, u32)>,
    /// Elements in contact.
    count: usize,
    /// Whether the runs are no longer true.
    changed: bool,
    /// The version in which they were found.
    version: u64,
}

impl Segments {
    /// No contact. Memory for any contact area is reserved, and touched when it is needed.
    pub fn new(grid: &Grid, threads: &Threads) -> Result<Segments> {
        let rows = grid.rows_of_blocks(BLOCKS, LEAST);
        let blocks = grid.my.div_ceil(rows);
        let mut found = Vec::new();
        found.resize_with(blocks, Found::default);
        for block in &mut found {
            reserve(&mut block.runs, rows * grid.mx.div_ceil(2), "the contact area")?;
        }
        let listed = (0..blocks).map(|_| sparse(rows * grid.mx, "the contact area")).collect::<Result<_>>()?;
        let sums = vec![[0.0; MOST_SUMS]; blocks];
        let (mx, block, threads) = (grid.mx, rows * grid.mx, threads.clone());
        Ok(Segments { mx, block, found, count: 0, version: 0, sums, listed, threads })
    }

    /// Number of elements in contact.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The version of the contact area: it rises with each change.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Whether elements in some rows may have changed sides since a version.
    pub fn changed_since(&self, version: u64, elements: Range<usize>) -> bool {
        self.found[elements.start / self.block..elements.end.div_ceil(self.block)]
            .iter()
            .any(|block| block.version > version)
    }

    /// Says that element `i` enters or leaves.
    pub fn change(&mut self, i: usize) {
        self.found[i / self.block].changed = true;
    }

    /// Says that any element may have changed sides.
    pub fn change_all(&mut self) {
        self.found.iter_mut().for_each(|block| block.changed = true);
    }

    /// Finds the runs of the blocks that changed.
    pub fn find(&mut self, contact: &[bool]) {
        if !self.found.iter().any(|block| block.changed) {
            return;
        }
        self.version += 1;
        let (mx, length, now) = (self.mx, self.block, self.version);
        self.threads.for_each_plain_row(
            &mut self.found,
            1,
            #[inline(always)]
            |b, found| {
                let Found { runs, count, changed, version } = &mut found[0];
                if take(changed) {
                    *version = now;
                    runs.clear();
                    let elements = &contact[b * length..contact.len().min((b + 1) * length)];
                    for (iy, row) in elements.chunks_exact(mx).enumerate() {
                        find_in_row(row, (b * length + iy * mx) as u32, runs);
                    }
                    *count = runs.iter().map(|(start, end)| (end - start) as usize).sum();
                }
            },
        );
        self.count = self.found.iter().map(|block| block.count).sum();
    }

    /// Sums over C: `work(runs, sums)` adds those of a block.
    pub fn sum<const K: usize>(&mut self, work: impl Fn(Block<'_>, &mut Sums<K>) + Sync + Send) -> [f64; K] {
        let (found, block) = (&self.found, self.block);
        self.threads.for_each_plain_row(
            &mut self.sums,
            1,
            #[inline(always)]
            |b, total| {
                let mut sums = Sums::new();
                let block = Block { start: b * block, runs: &found[b].runs };
                work(block, &mut sums);
                total[0][..K].copy_from_slice(&sums.values());
            },
        );
        self.total()
    }

    /// Changes the elements of `data`: `work(runs, the block's part of data, elements)` lists elements, which [`listed`](Self::listed) gives.
    pub fn list_changing<A: Send>(
        &mut self,
        data: &mut [A],
        work: impl Fn(Block<'_>, &mut [A], &mut Vec<u32>) + Sync + Send,
    ) {
        let (found, block) = (&self.found, self.block);
        let (data, listed) = ((data, block), (&mut self.listed[..], 1));
        self.threads.for_each_row_pair(
            data,
            listed,
            #[inline(always)]
            |b, data, listed| {
                listed[0].clear();
                let block = Block { start: b * block, runs: &found[b].runs };
                work(block, data, &mut listed[0]);
            },
        );
    }

    /// The elements that the last pass listed, in the order of the blocks.
    pub fn listed(&self) -> impl Iterator<Item = usize> + '_ {
        self.listed.iter().flatten().map(|&i| i as usize)
    }

    /// As [`sum`](Self::sum), changing the elements of `data` on the way: `work(runs, the block's part of data, sums)`.
    pub fn sum_changing<A: Send, const K: usize>(
        &mut self,
        data: &mut [A],
        work: impl Fn(Block<'_>, &mut [A], &mut Sums<K>) + Sync + Send,
    ) -> [f64; K] {
        let (found, block) = (&self.found, self.block);
        let (data, sums) = ((data, block), (&mut self.sums[..], 1));
        self.threads.for_each_row_pair(
            data,
            sums,
            #[inline(always)]
            |b, data, total| {
                let mut sums = Sums::new();
                let block = Block { start: b * block, runs: &found[b].runs };
                work(block, data, &mut sums);
                total[0][..K].copy_from_slice(&sums.values());
            },
        );
        self.total()
    }

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
        self.found.iter_mut().for_each(|block| keep([&mut block.runs]));
    }
}

/// Appends the runs of a row whose first element is `start`. A run begins or ends where an element differs from the one before; eight are
/// compared at a time.
#[inline(always)]
fn find_in_row(row: &[bool], start: u32, runs: &mut Vec<(u32, u32)>) {
    let (eights, rest) = pulp::as_arrays::<EIGHT, bool>(row);
    // No contact behind the row, so that each run ends.
    let mut last = [false; EIGHT];
    last[..rest.len()].copy_from_slice(rest);
    let (mut before, mut first) = (0, None);
    for k in 0..=eights.len() {
        let elements = u64::from_le_bytes(eights.get(k).unwrap_or(&last).map(u8::from));
        let mut edges = elements ^ (elements << 8 | before);
        before = elements >> 56;
        while edges != 0 {
            let edge = start + (EIGHT * k) as u32 + edges.trailing_zeros() / 8;
            match first.take() {
                Some(first) => runs.push((first, edge)),
                None => first = Some(edge),
            }
            edges &= edges - 1;
        }
    }
}

/// The runs of a block.
pub struct Block<'a> {
    start: usize,
    runs: &'a [(u32, u32)],
}

impl Block<'_> {
    /// Segments of elements in contact: among those of the grid, and among those of the block.
    pub fn runs(&self) -> impl Iterator<Item = (Range<usize>, Range<usize>)> + '_ {
        self.runs.iter().map(|&(start, end)| {
            let run = start as usize..end as usize;
            (run.clone(), run.start - self.start..run.end - self.start)
        })
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/segments.rs"]
mod tests;
