//! A pass over a grid in blocks of rows, whose results are joined in order.
//!
//! The blocks do not depend on the number of threads: nor do the bits of what is joined.

use std::ops::Range;

use crate::grid::Grid;
use crate::threads::Threads;

/// Blocks at most, and elements of a block at least: each costs some work of its own.
const BLOCKS: usize = 64;
const LEAST: usize = 1024;

/// Joins what `work(elements)` returns for each block to `nothing`, in the order of the blocks.
#[inline(always)]
pub fn fold<A: Copy + Send>(
    grid: &Grid,
    threads: &Threads,
    nothing: A,
    work: impl Fn(Range<usize>) -> A + Sync + Send,
    join: impl Fn(A, A) -> A,
) -> A {
    let (n, length) = (grid.len(), grid.rows_of_blocks(BLOCKS, LEAST) * grid.mx);
    let (count, threads) = (n.div_ceil(length), threads.for_a_pass(n));
    let elements = |b: usize| b * length..((b + 1) * length).min(n);
    let pass = |found: &mut [A], first: usize| {
        threads.for_each(
            found,
            #[inline(always)]
            |b, found| *found = work(elements(first + b)),
        );
    };
    if threads.count() == 1 {
        return (0..count).fold(nothing, |so_far, b| {
            let mut found = [nothing];
            pass(&mut found, b);
            join(so_far, found[0])
        });
    }
    let mut found = [nothing; BLOCKS];
    pass(&mut found[..count], 0);
    found[..count].iter().fold(nothing, |so_far, found| join(so_far, *found))
}

#[cfg(test)]
#[path = "../tests/unit/blocks.rs"]
mod tests;
