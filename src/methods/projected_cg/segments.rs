//! The contact area as runs of elements, and sums over it.
//!
//! Contact is often a small part of the grid and mostly in one piece: passes over runs touch nothing else, and work on slices.
//! Sums are taken per block of rows and added in the order of the blocks, which do not depend on the number of threads: nor do the
//! bits of the sums.

use std::mem::take;
use std::ops::Range;

use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{keep, reserve};
use crate::threads::Threads;

/// Blocks of rows at most.
const BLOCKS: usize = 64;
/// Sums at most that a pass takes.
const MOST_SUMS: usize = 5;
/// Parts of each sum of a block: an addition does not wait for the one before.
const LANES: usize = 4;

/// The runs of all rows.
pub struct Segments {
    mx: usize,
    /// Elements of a block.
    block: usize,
    /// Elements of the grid, `start..end`.
    runs: Vec<(u32, u32)>,
    /// The first run of each block, and the number of runs.
    first: Vec<u32>,
    /// Elements in contact.
    count: usize,
    /// Blocks whose runs are no longer true.
    changed: Vec<bool>,
    runs_before: Vec<(u32, u32)>,
    first_before: Vec<u32>,
    sums: Vec<[f64; MOST_SUMS]>,
    threads: Threads,
}

impl Segments {
    /// No contact. Memory for any contact area is reserved, and touched when it is needed.
    pub fn new(grid: &Grid, threads: &Threads) -> Result<Segments> {
        let most = grid.my * grid.mx.div_ceil(2);
        let rows = grid.my.div_ceil(BLOCKS);
        let blocks = grid.my.div_ceil(rows);
        let (mut runs, mut runs_before) = (Vec::new(), Vec::new());
        reserve(&mut runs, most, "the contact area")?;
        reserve(&mut runs_before, most, "the contact area")?;
        Ok(Segments {
            mx: grid.mx,
            block: rows * grid.mx,
            runs,
            first: vec![0; blocks + 1],
            count: 0,
            changed: vec![true; blocks],
            runs_before,
            first_before: vec![0; blocks + 1],
            sums: vec![[0.0; MOST_SUMS]; blocks],
            threads: threads.clone(),
        })
    }

    /// Number of elements in contact.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Says that element `i` enters or leaves.
    pub fn change(&mut self, i: usize) {
        self.changed[i / self.block] = true;
    }

    /// Says that any element may have changed sides.
    pub fn change_all(&mut self) {
        self.changed.fill(true);
    }

    /// Finds the runs of the blocks that changed.
    pub fn find(&mut self, contact: &[bool]) {
        if !self.changed.contains(&true) {
            return;
        }
        std::mem::swap(&mut self.runs, &mut self.runs_before);
        std::mem::swap(&mut self.first, &mut self.first_before);
        self.runs.clear();
        self.count = 0;
        for (b, block) in contact.chunks(self.block).enumerate() {
            let first = self.runs.len();
            self.first[b] = first as u32;
            if take(&mut self.changed[b]) {
                for (iy, row) in block.chunks_exact(self.mx).enumerate() {
                    find_in_row(row, (b * self.block + iy * self.mx) as u32, &mut self.runs);
                }
            } else {
                let before = self.first_before[b] as usize..self.first_before[b + 1] as usize;
                self.runs.extend_from_slice(&self.runs_before[before]);
            }
            self.count += self.runs[first..].iter().map(|(start, end)| (end - start) as usize).sum::<usize>();
        }
        if let Some(last) = self.first.last_mut() {
            *last = self.runs.len() as u32;
        }
    }

    /// Sums over C: `work(runs, sums)` adds those of a block.
    pub fn sum<const K: usize>(&mut self, work: impl Fn(Block<'_>, &mut Sums<K>) + Sync + Send) -> [f64; K] {
        let (runs, first, block) = (&self.runs, &self.first, self.block);
        self.threads.for_each_plain_row(&mut self.sums, 1, |b, total| {
            let mut sums = Sums([[0.0; LANES]; K]);
            let block = Block { start: b * block, runs: &runs[first[b] as usize..first[b + 1] as usize] };
            work(block, &mut sums);
            sums.total(&mut total[0]);
        });
        self.total()
    }

    /// As [`sum`](Self::sum), changing the elements of `data` on the way: `work(runs, the block's part of data, sums)`.
    pub fn sum_changing<A: Send, const K: usize>(
        &mut self,
        data: &mut [A],
        work: impl Fn(Block<'_>, &mut [A], &mut Sums<K>) + Sync + Send,
    ) -> [f64; K] {
        let (runs, first, block) = (&self.runs, &self.first, self.block);
        let (data, sums) = ((data, block), (&mut self.sums[..], 1));
        self.threads.for_each_row_pair(data, sums, |b, data, total| {
            let mut sums = Sums([[0.0; LANES]; K]);
            let block = Block { start: b * block, runs: &runs[first[b] as usize..first[b + 1] as usize] };
            work(block, data, &mut sums);
            sums.total(&mut total[0]);
        });
        self.total()
    }

    /// The runs of the blocks whose first sum of the last pass was not 0.
    pub fn of_blocks_with_sum(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let blocks = (0..self.sums.len()).filter(|&b| self.sums[b][0] != 0.0);
        let runs = blocks.flat_map(|b| &self.runs[self.first[b] as usize..self.first[b + 1] as usize]);
        runs.map(|&(start, end)| start as usize..end as usize)
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
        keep([&mut self.runs, &mut self.runs_before]);
    }
}

/// Appends the runs of a row whose first element is `start`.
fn find_in_row(row: &[bool], start: u32, runs: &mut Vec<(u32, u32)>) {
    let mut column = 0;
    while let Some(skipped) = first_that_is(true, &row[column..]) {
        let from = column + skipped;
        column = from + first_that_is(false, &row[from..]).unwrap_or(row.len() - from);
        runs.push((start + from as u32, start + column as u32));
    }
}

/// The first of some elements that is in contact, or is not; many at a time, which the compiler can vectorise.
pub fn first_that_is(inside: bool, elements: &[bool]) -> Option<usize> {
    const MANY: usize = 32;
    let none = |many: &[bool]| many.iter().fold(true, |none, &element| none & (element != inside));
    let skipped = MANY * elements.chunks_exact(MANY).take_while(|many| none(many)).count();
    elements[skipped..].iter().position(|&element| element == inside).map(|i| skipped + i)
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

/// Sums over elements of a block.
pub struct Sums<const K: usize>([[f64; LANES]; K]);

impl<const K: usize> Sums<K> {
    /// Adds `terms(0), .. terms(n - 1)`.
    #[inline(always)]
    pub fn add(&mut self, n: usize, mut terms: impl FnMut(usize) -> [f64; K]) {
        let whole = n - n % LANES;
        for start in (0..whole).step_by(LANES) {
            for lane in 0..LANES {
                let terms = terms(start + lane);
                for (sum, term) in self.0.iter_mut().zip(terms) {
                    sum[lane] += term;
                }
            }
        }
        for i in whole..n {
            for (sum, term) in self.0.iter_mut().zip(terms(i)) {
                sum[i - whole] += term;
            }
        }
    }

    fn total(&self, total: &mut [f64; MOST_SUMS]) {
        for (total, lanes) in total.iter_mut().zip(&self.0) {
            *total = lanes.iter().sum();
        }
    }
}
