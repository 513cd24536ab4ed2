//! A pass over a grid in blocks of rows, whose results are joined in order.
//!
//! Neither the blocks nor the bits of the joined result depend on the number of threads.

use std::array::from_fn;
use std::ops::Range;

use crate::grid::Grid;
use crate::threads::Threads;

/// Most blocks of a pass over a grid: each has a fixed cost.
pub const BLOCKS: usize = 64;
/// Elements of a block: two fields of 1024 vectors stay in the nearest cache. Blocks of whole rows have about as many, or more.
pub const BLOCK: usize = 1024;
/// Lanes of a pass, as many as in the longest vector: the compiler vectorises loops over them, and no bit of their sums depends on the machine.
/// Flags of as many elements are the bytes of a word.
pub const LANES: usize = 8;

/// Joins the results of `work(elements)` for each block to `nothing`, in the order of the blocks.
#[inline(always)]
pub fn fold<A: Clone + Send>(
    grid: &Grid,
    threads: &Threads,
    nothing: A,
    work: impl Fn(Range<usize>) -> A + Sync + Send,
    join: impl Fn(A, A) -> A,
) -> A {
    let (n, length) = (grid.len(), grid.rows_of_blocks(BLOCKS, BLOCK) * grid.mx);
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
        return (0..count).fold(nothing.clone(), |so_far, b| {
            let mut found = [nothing.clone()];
            pass(&mut found, b);
            let [found] = found;
            join(so_far, found)
        });
    }
    let mut found: [A; BLOCKS] = from_fn(|_| nothing.clone());
    pass(&mut found[..count], 0);
    found.into_iter().take(count).fold(nothing, join)
}

#[cfg(test)]
#[path = "../tests/unit/blocks.rs"]
mod tests;
