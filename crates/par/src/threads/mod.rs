//! The threads of one solve, or of a batch of solves: the caller's thread alone, or the caller's thread and workers.
//!
//! Work is divided into pieces whose results do not depend on the thread that computes them. So results have the same bits for any number of threads.
//! The functions here that call pieces are inlined in code that is compiled for the vector instructions of this machine. No bit depends on these
//! instructions either, because no operations are fused or reordered.

mod busy;
#[allow(unsafe_code)] // The record of the process is a pointer.
mod pool;
#[allow(unsafe_code)] // Workers call a function whose lifetime the compiler does not see.
mod region;
mod shared;
#[allow(unsafe_code)] // Calls of libc for masks of signals.
mod signals;
#[allow(unsafe_code)] // Workers call a function whose lifetime the compiler does not see.
mod workers;

use std::sync::{Mutex, PoisonError};

use pool::Pool;
pub use pool::{kept, release};
pub use shared::{made_once, Shared};
pub use workers::{is_worker, THREAD_NAME};

use crate::error::Result;

/// The threads that share the work of a caller.
#[derive(Clone, Default)]
pub enum Threads {
    /// The calling thread alone.
    #[default]
    One,
    /// The calling thread and workers of the process.
    Pool(Pool),
}

/// The least number of elements of a grid on which a solve is faster if several threads share its products. A single product is faster from 64 x 64
/// elements on. With that limit, however, two threads took 1.11 times as long as one for a solve on 64 x 64
/// (docs/notes/2026-11-performance-targets.md).
const WORTH_WAKING: usize = 110 * 110;

/// The number of pieces of work for each thread. If one thread is delayed, the others process its pieces. With 6 to 16 pieces, measured times differ
/// by noise only.
const PIECES_PER_THREAD: usize = 8;

impl Threads {
    /// `count` threads, including the caller's. 0 stands for one thread per core of the machine.
    pub fn new(count: usize) -> Result<Threads> {
        let count = match count {
            0 => std::thread::available_parallelism().map_or(1, |n| n.get()),
            n => n,
        };
        Ok(if count == 1 { Threads::One } else { Threads::Pool(Pool::of(count)?) })
    }

    /// The pool of threads in this process. None if the calling thread works alone, or if a forked child cannot start threads.
    fn pool(&self) -> Option<Pool> {
        match self {
            Threads::One => None,
            Threads::Pool(pool) => pool.in_this_process(),
        }
    }

    /// The number of threads. Each may need its own scratch.
    pub fn count(&self) -> usize {
        match self {
            Threads::One => 1,
            Threads::Pool(pool) => pool.count(),
        }
    }

    /// Calls `work(k, item)` for each item, with its number k.
    pub fn for_each<A: Send>(&self, items: &mut [A], work: impl Fn(usize, &mut A) + Sync + Send) {
        self.share(
            items.iter_mut().enumerate(),
            &mut self.no_scratch(),
            #[inline(always)]
            |(k, item), ()| work(k, item),
        );
    }

    /// Calls `work(piece, scratch)` for each piece, where `scratch` is that of the calling thread. `scratch` has one item for each thread.
    ///
    /// The threads take pieces until none is left. The caller takes pieces from the front, and begins at once, without waiting for the workers to
    /// wake. The workers take pieces from the back. So, in the next pass over the same data, each thread finds much of its data in its cache.
    pub fn share<P: Send, S: Send>(
        &self,
        pieces: impl DoubleEndedIterator<Item = P> + ExactSizeIterator + Send,
        scratch: &mut [S],
        work: impl Fn(P, &mut S) + Sync,
    ) {
        self.share_pieces(pieces, scratch, &|piece, scratch| {
            pulp::Arch::new().dispatch(
                #[inline(always)]
                || work(piece, scratch),
            );
        });
    }

    /// [`share`](Self::share), compiled once for each type of pieces instead of once for each `work`. With it the library has 14.5 MB of machine code
    /// instead of 19.9 MB.
    fn share_pieces<P: Send, S: Send>(
        &self,
        pieces: impl DoubleEndedIterator<Item = P> + ExactSizeIterator + Send,
        scratch: &mut [S],
        work: &(dyn Fn(P, &mut S) + Sync),
    ) {
        let Some((own, others)) = scratch.split_first_mut() else { return };
        let pool = if pieces.len() > 1 { self.pool().filter(Pool::may_help) } else { None };
        let Some(pool) = pool else { return pieces.for_each(|piece| work(piece, own)) };
        let pieces = Mutex::new(pieces);
        let front = || pieces.lock().unwrap_or_else(PoisonError::into_inner).next();
        let back = || pieces.lock().unwrap_or_else(PoisonError::into_inner).next_back();
        let from_the_back = |scratch: &mut S| {
            while let Some(piece) = back() {
                work(piece, scratch);
            }
        };
        pool.share(others, &from_the_back, || {
            let mut count = 0;
            while let Some(piece) = front() {
                work(piece, own);
                count += 1;
            }
            count
        });
    }

    /// The scratch of work that needs none: one empty item for each thread.
    fn no_scratch(&self) -> Vec<()> {
        vec![(); self.count()]
    }

    /// The number of rows of each piece, if `rows` rows are shared among the threads.
    fn rows_per_piece(&self, rows: usize) -> usize {
        let pieces = if self.count() == 1 { 1 } else { PIECES_PER_THREAD * self.count() };
        rows.div_ceil(pieces).max(1)
    }

    /// Calls `own(item)` for the first item on the calling thread. Meanwhile each free worker takes one of the other items and calls `others(item)`.
    /// Items that no worker has taken when `own` returns are not processed. With one thread, `others` is called for all other items after `own`.
    pub fn for_each_beside<A: Send>(
        &self,
        items: &mut [A],
        own: impl FnOnce(&mut A),
        others: impl Fn(&mut A) + Sync + Send,
    ) {
        let Some((first, rest)) = items.split_first_mut() else { return };
        match self.pool() {
            None => {
                own(first);
                rest.iter_mut().for_each(others);
            }
            Some(pool) => pool.run_with_workers(rest, &others, || own(first)),
        }
    }

    /// Calls `work(number, row, scratch)` for each row of `data`. A row has `length` values; the last one may have fewer. `scratch` is that of the
    /// calling thread.
    pub fn for_each_row<A: Send, S: Send>(
        &self,
        data: &mut [A],
        length: usize,
        scratch: &mut [S],
        work: impl Fn(usize, &mut [A], &mut S) + Sync + Send,
    ) {
        let per_piece = self.rows_per_piece(data.len().div_ceil(length));
        self.share(
            data.chunks_mut(per_piece * length).enumerate(),
            scratch,
            #[inline(always)]
            |(k, rows), scratch| {
                for (i, row) in rows.chunks_mut(length).enumerate() {
                    work(k * per_piece + i, row, scratch);
                }
            },
        );
    }

    /// Calls `work(number, row of a, row of b, scratch)` for each pair of rows of `a` and `b`, which are given with the lengths of their rows. The
    /// last row may be shorter. `scratch` is that of the calling thread.
    pub fn for_each_row_pair_with<A: Send, B: Send, S: Send>(
        &self,
        (a, length_a): (&mut [A], usize),
        (b, length_b): (&mut [B], usize),
        scratch: &mut [S],
        work: impl Fn(usize, &mut [A], &mut [B], &mut S) + Sync + Send,
    ) {
        let per_piece = self.rows_per_piece(a.len().div_ceil(length_a));
        let pieces = a.chunks_mut(per_piece * length_a).zip(b.chunks_mut(per_piece * length_b)).enumerate();
        self.share(
            pieces,
            scratch,
            #[inline(always)]
            |(k, (a, b)), scratch| {
                for (i, (a, b)) in a.chunks_mut(length_a).zip(b.chunks_mut(length_b)).enumerate() {
                    work(k * per_piece + i, a, b, scratch);
                }
            },
        );
    }

    /// Calls `work(number, row)` for each row of `data`. A row has `length` values; the last one may have fewer.
    pub fn for_each_plain_row<A: Send>(
        &self,
        data: &mut [A],
        length: usize,
        work: impl Fn(usize, &mut [A]) + Sync + Send,
    ) {
        self.for_each_row(
            data,
            length,
            &mut self.no_scratch(),
            #[inline(always)]
            |k, row, ()| work(k, row),
        );
    }

    /// Calls `work(number, row of a, row of b)` for each pair of rows of `a` and `b`, which are given with the lengths of their rows. The last row
    /// may be shorter.
    pub fn for_each_row_pair<A: Send, B: Send>(
        &self,
        a: (&mut [A], usize),
        b: (&mut [B], usize),
        work: impl Fn(usize, &mut [A], &mut [B]) + Sync + Send,
    ) {
        self.for_each_row_pair_with(
            a,
            b,
            &mut self.no_scratch(),
            #[inline(always)]
            |k, a, b, ()| work(k, a, b),
        );
    }

    /// The threads for one pass over arrays of this many elements. Several threads save time in a pass if it has twice as many elements as a solve
    /// needs for that.
    pub fn for_a_pass(&self, elements: usize) -> Threads {
        self.suited_to(elements / 2)
    }

    /// The threads for a solve on this many elements. The calling thread works alone if waking workers would take longer than the work.
    pub fn suited_to(&self, elements: usize) -> Threads {
        if elements < WORTH_WAKING {
            Threads::One
        } else {
            self.clone()
        }
    }
}
