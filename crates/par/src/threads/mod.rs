//! The threads of one solve, or of a batch of solves: the caller's thread alone, or a pool.
//!
//! Work is divided into pieces whose results do not depend on the thread that computes them. So results have the same bits for
//! any number of threads. Code inlined here is compiled for the vector instructions of this machine. No bit depends on them either, because no
//! operations are fused or reordered.

mod busy;
#[allow(unsafe_code)] // lifetimes of work that workers share
mod crew;
#[allow(unsafe_code)] // the record of the process
mod pool;
#[allow(unsafe_code)] // lifetimes of work that workers share
mod region;
mod shared;
#[allow(unsafe_code)] // masks of signals
mod signals;

use std::sync::{Mutex, PoisonError};

pub use crew::{is_worker, THREAD_NAME};
use pool::Pool;
pub use pool::{kept, release};
pub use shared::{made_once, Shared};

use crate::error::Result;

/// The threads that do the work.
#[derive(Clone, Default)]
pub enum Threads {
    /// The calling thread.
    #[default]
    One,
    /// A pool of workers.
    Pool(Pool),
}

/// From this number of elements on a solve is faster if several threads share its products. A single product is faster from 64 x 64 on, but
/// with that limit two threads took 1.11 times as long as one for a solve on 64 x 64 (docs/notes/2026-11-performance-targets.md).
const WORTH_WAKING: usize = 110 * 110;

/// Pieces of work per thread. If one thread is delayed, the others take over its pieces. With 6 to 16 pieces measured times differ by noise.
const PIECES_PER_THREAD: usize = 8;

impl Threads {
    /// `count` threads. 0 means one per core of the machine.
    pub fn new(count: usize) -> Result<Threads> {
        let count = match count {
            0 => std::thread::available_parallelism().map_or(1, |n| n.get()),
            n => n,
        };
        Ok(if count == 1 { Threads::One } else { Threads::Pool(Pool::of(count)?) })
    }

    /// The pool; none if the calling thread works alone.
    fn pool(&self) -> Option<Pool> {
        match self {
            Threads::One => None,
            Threads::Pool(pool) => pool.here(),
        }
    }

    /// Number of threads. Each may need separate scratch.
    pub fn count(&self) -> usize {
        match self {
            Threads::One => 1,
            Threads::Pool(pool) => pool.count(),
        }
    }

    /// Calls `work(k, item)` on each of some items.
    pub fn for_each<A: Send>(&self, items: &mut [A], work: impl Fn(usize, &mut A) + Sync + Send) {
        self.share(
            items.iter_mut().enumerate(),
            &mut self.no_scratch(),
            #[inline(always)]
            |(k, item), ()| work(k, item),
        );
    }

    /// Calls `work(piece, scratch)` on each of some pieces, with the scratch of its thread.
    ///
    /// The threads take pieces until none is left. The caller begins at once, at the front, and does not wait for the
    /// others to wake. They begin at the back. Thus a thread finds much of its data in its cache, from the previous pass.
    pub fn share<P: Send, S: Send>(
        &self,
        pieces: impl DoubleEndedIterator<Item = P> + ExactSizeIterator + Send,
        scratch: &mut [S],
        work: impl Fn(P, &mut S) + Sync,
    ) {
        self.hand_out(pieces, scratch, &|piece, scratch| {
            pulp::Arch::new().dispatch(
                #[inline(always)]
                || work(piece, scratch),
            );
        });
    }

    /// [`share`](Self::share), compiled once for all kinds of `work`: the library has 14.5 MB of machine code instead of 19.9.
    fn hand_out<P: Send, S: Send>(
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
        let from_behind = |scratch: &mut S| {
            while let Some(piece) = back() {
                work(piece, scratch);
            }
        };
        pool.share(others, &from_behind, || {
            let mut count = 0;
            while let Some(piece) = front() {
                work(piece, own);
                count += 1;
            }
            count
        });
    }

    /// Scratch of work that needs none.
    fn no_scratch(&self) -> Vec<()> {
        vec![(); self.count()]
    }

    /// Rows of each piece of work on `rows` rows.
    fn rows_per_piece(&self, rows: usize) -> usize {
        let pieces = if self.count() == 1 { 1 } else { PIECES_PER_THREAD * self.count() };
        rows.div_ceil(pieces).max(1)
    }

    /// Calls `own(item)` for the first item on the calling thread. Meanwhile the other threads call `others(item)` for the rest.
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
            Some(pool) => pool.beside(rest, &others, || own(first)),
        }
    }

    /// Calls `work(row, its data, scratch)` on each row of `data`; the last row may be shorter.
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

    /// Calls `work(row, its data in a, its data in b, scratch)` on each row of both; the last row may be shorter.
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

    /// Calls `work(row, its data)` on each row of `data`; the last row may be shorter.
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

    /// Calls `work(row, its data in a, its data in b)` on each row of both; the last row may be shorter.
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

    /// The threads for one pass over arrays. A pass needs twice as many elements as a solve to gain by several threads.
    pub fn for_a_pass(&self, elements: usize) -> Threads {
        self.suited_to(elements / 2)
    }

    /// The threads for work on this many elements. The caller's thread works alone if waking the others takes longer than the work.
    pub fn suited_to(&self, elements: usize) -> Threads {
        if elements < WORTH_WAKING {
            Threads::One
        } else {
            self.clone()
        }
    }
}
