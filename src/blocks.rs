//! A pass over all elements of a grid. Blocks of rows are processed in parallel, and their results are joined in the order of the blocks.
//!
//! Neither the blocks nor the bits of the joined result depend on the number of threads.

use std::array::from_fn;
use std::ops::Range;

use crate::grid::Grid;
use crate::threads::Threads;

/// Most blocks of a pass over a grid, because each block has a fixed cost.
pub const BLOCKS: usize = 64;
/// The approximate minimum of the elements of a block, which consists of whole rows. Two fields of this many two-component vectors fit into the
/// first-level cache.
pub const BLOCK: usize = 1024;
/// The number of partial sums of a pass, one for each lane of the longest SIMD vector. The compiler vectorises loops over them. Their number is the
/// same on all machines, and so are the bits of sums. The flags (bool) of this many elements are the bytes of a 64-bit word.
pub const LANES: usize = 8;

/// Calls `work(elements)` for each block of elements, and joins the results in the order of the blocks, beginning with `nothing`.
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
    // One thread needs memory for one result at a time.
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
