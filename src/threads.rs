//! The threads of one solve, or of a batch of solves: none but the caller's own, or a pool of ours.
//!
//! Pools are made when first asked for and shared by all solves of a process. Each is stamped with the process id: after
//! a fork the child has no workers, so it makes a pool of its own instead of waiting for threads that are not there; so does
//! an operator that was set up before the fork.
//! Work is cut into pieces whose results do not depend on who computes them, so that the answer has the same bits for
//! any number of threads.

use std::sync::{Arc, Mutex, PoisonError};

use crate::error::{Error, Result};

/// Who does the work.
#[derive(Clone, Default)]
pub enum Threads {
    /// The calling thread.
    #[default]
    One,
    /// A pool of our own.
    Pool(Pool),
}

/// A pool, and the process that has its workers.
#[derive(Clone)]
pub struct Pool {
    process: u32,
    count: usize,
    workers: Arc<rayon::ThreadPool>,
}

/// Elements of a grid from which on several threads multiply faster than one: a product takes some 200 us there, and waking the
/// others some 10 us, several times.
const WORTH_WAKING: usize = 128 * 128;

/// Prefix of the names of our threads.
pub(crate) const THREAD_NAME: &str = "contact-normal-";

static POOLS: Mutex<Vec<Pool>> = Mutex::new(Vec::new());

impl Threads {
    /// `count` threads; 0: as many as the machine has cores.
    pub fn new(count: usize) -> Result<Threads> {
        let count = match count {
            0 => std::thread::available_parallelism().map_or(1, |n| n.get()),
            n => n,
        };
        if count == 1 {
            return Ok(Threads::One);
        }
        let process = std::process::id();
        let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = pools.iter().find(|known| known.process == process && known.count == count) {
            return Ok(Threads::Pool(known.clone()));
        }
        // Pools of a parent process have no workers here, and dropping one would wait for them: forget it.
        pools.retain_mut(|known| {
            let ours = known.process == process;
            if !ours {
                std::mem::forget(known.workers.clone());
            }
            ours
        });
        let workers = rayon::ThreadPoolBuilder::new()
            .num_threads(count - 1)
            .thread_name(|i| format!("{THREAD_NAME}{i}"))
            .build()
            .map_err(|e| Error::OutOfMemory(format!("threads is {count}; the threads could not be started: {e}")))?;
        let pool = Pool { process, count, workers: Arc::new(workers) };
        pools.push(pool.clone());
        Ok(Threads::Pool(pool))
    }

    /// The workers; none: the calling thread works. After a fork they are those of a new pool.
    fn workers(&self) -> Option<Arc<rayon::ThreadPool>> {
        match self {
            Threads::One => None,
            Threads::Pool(pool) if pool.process == std::process::id() => Some(pool.workers.clone()),
            Threads::Pool(pool) => match Threads::new(pool.count) {
                Ok(Threads::Pool(pool)) => Some(pool.workers),
                _ => None,
            },
        }
    }

    /// Number of threads.
    pub fn count(&self) -> usize {
        match self {
            Threads::One => 1,
            Threads::Pool(pool) => pool.count,
        }
    }

    /// How many pieces work is cut into: some per thread, so that a thread held up by others leaves its share to them.
    pub fn pieces(&self) -> usize {
        match self.count() {
            1 => 1,
            count => 4 * count,
        }
    }

    /// Calls `work(k, scratch)` on each of the pieces' scratch.
    pub fn for_each<S: Send>(&self, scratch: &mut [S], work: impl Fn(usize, &mut S) + Sync + Send) {
        self.share(scratch.iter_mut().enumerate(), |(k, s)| work(k, s));
    }

    /// The calling thread and the others take pieces until there are none. The caller begins at once: it does not wait for others to wake.
    fn share<P: Send>(&self, pieces: impl Iterator<Item = P> + Send, work: impl Fn(P) + Sync) {
        let Some(workers) = self.workers() else { return pieces.for_each(work) };
        let pieces = Mutex::new(pieces);
        let next = || pieces.lock().unwrap_or_else(PoisonError::into_inner).next();
        let take_all = || {
            while let Some(piece) = next() {
                work(piece);
            }
        };
        workers.in_place_scope(|scope| {
            (1..self.count()).for_each(|_| scope.spawn(|_| take_all()));
            take_all();
        });
    }

    /// Calls `own(scratch)` for the first on the calling thread, and meanwhile `others(scratch)` for the rest on the others.
    pub fn for_each_beside<S: Send>(
        &self,
        scratch: &mut [S],
        own: impl FnOnce(&mut S),
        others: impl Fn(&mut S) + Sync + Send,
    ) {
        let Some((first, rest)) = scratch.split_first_mut() else { return };
        let others = &others;
        match self.workers() {
            None => {
                own(first);
                rest.iter_mut().for_each(others);
            }
            Some(workers) => workers.in_place_scope(|scope| {
                rest.iter_mut().for_each(|s| scope.spawn(move |_| others(s)));
                own(first);
            }),
        }
    }

    /// Calls `work(row, its data, scratch)` on each row of `data`, a run of rows per piece; the last row may be shorter.
    pub fn for_each_row<A: Send, S: Send>(
        &self,
        data: &mut [A],
        row_length: usize,
        scratch: &mut [S],
        work: impl Fn(usize, &mut [A], &mut S) + Sync + Send,
    ) {
        let rows_per_piece = data.len().div_ceil(row_length).div_ceil(scratch.len()).max(1);
        self.for_each_chunk_pair((data, rows_per_piece * row_length), (scratch, 1), |k, rows, scratch| {
            for (i, row) in rows.chunks_mut(row_length).enumerate() {
                work(k * rows_per_piece + i, row, &mut scratch[0]);
            }
        });
    }

    /// Calls `work(row, its data in a, its data in b, scratch)` on each row of both, a run of rows per piece.
    pub fn for_each_row_pair_with<A: Send, B: Send, S: Send>(
        &self,
        (a, length_a): (&mut [A], usize),
        (b, length_b): (&mut [B], usize),
        scratch: &mut [S],
        work: impl Fn(usize, &mut [A], &mut [B], &mut S) + Sync + Send,
    ) {
        let rows_per_piece = a.len().div_ceil(length_a).div_ceil(scratch.len()).max(1);
        let rows = |k: usize, a: &mut [A], b: &mut [B], scratch: &mut S| {
            for (i, (a, b)) in a.chunks_mut(length_a).zip(b.chunks_mut(length_b)).enumerate() {
                work(k * rows_per_piece + i, a, b, scratch);
            }
        };
        let (of_a, of_b) = (rows_per_piece * length_a, rows_per_piece * length_b);
        let pieces = a.chunks_mut(of_a).zip(b.chunks_mut(of_b)).zip(scratch).enumerate();
        self.share(pieces, |(k, ((a, b), scratch))| rows(k, a, b, scratch));
    }

    /// Calls `work(row, its data)` on each row of `data`.
    pub fn for_each_plain_row<A: Send>(
        &self,
        data: &mut [A],
        length: usize,
        work: impl Fn(usize, &mut [A]) + Sync + Send,
    ) {
        let rows_per_piece = data.len().div_ceil(length).div_ceil(self.pieces()).max(1);
        let rows = |k: usize, rows: &mut [A]| {
            rows.chunks_mut(length).enumerate().for_each(|(i, row)| work(k * rows_per_piece + i, row));
        };
        self.share(data.chunks_mut(rows_per_piece * length).enumerate(), |(k, chunk)| rows(k, chunk));
    }

    /// Calls `work(row, its data in a, its data in b)` on each row of both, a run of rows per piece; the last row may be shorter.
    pub fn for_each_row_pair<A: Send, B: Send>(
        &self,
        (a, length_a): (&mut [A], usize),
        (b, length_b): (&mut [B], usize),
        work: impl Fn(usize, &mut [A], &mut [B]) + Sync + Send,
    ) {
        let rows_per_piece = a.len().div_ceil(length_a).div_ceil(self.pieces()).max(1);
        self.for_each_chunk_pair((a, rows_per_piece * length_a), (b, rows_per_piece * length_b), |k, a, b| {
            for (i, (a, b)) in a.chunks_mut(length_a).zip(b.chunks_mut(length_b)).enumerate() {
                work(k * rows_per_piece + i, a, b);
            }
        });
    }

    /// Calls `work(k, chunk of a, chunk of b)` on each pair of chunks.
    fn for_each_chunk_pair<A: Send, B: Send>(
        &self,
        (a, length_a): (&mut [A], usize),
        (b, length_b): (&mut [B], usize),
        work: impl Fn(usize, &mut [A], &mut [B]) + Sync + Send,
    ) {
        let pieces = a.chunks_mut(length_a).zip(b.chunks_mut(length_b)).enumerate();
        self.share(pieces, |(k, (a, b))| work(k, a, b));
    }

    /// These threads for a pass over arrays of so many elements, which takes about a tenth of the time of a product.
    pub fn for_a_pass(&self, elements: usize) -> Threads {
        self.suited_to(elements / 10)
    }

    /// These threads for work on so many elements: the caller's own where waking the others takes longer than the work.
    pub fn suited_to(&self, elements: usize) -> Threads {
        if elements < WORTH_WAKING {
            Threads::One
        } else {
            self.clone()
        }
    }
}
