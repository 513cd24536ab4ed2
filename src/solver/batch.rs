//! Batches: many independent problems are distributed over threads, and each is solved on one thread.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::{Guess, InitialGuess, Options, Outcome, Report, Solver};
use crate::contact::State;
use crate::effects::{self, Continues};
use crate::error::{invalid, Result};
use crate::scene::Scene;
use crate::threads::Threads;

/// One problem of a batch.
#[derive(Clone, Debug)]
pub struct Problem<'a> {
    /// The undeformed distance and the load; grid, bodies and influence coefficients must be those of the solver.
    pub scene: Scene<'a>,
    /// The pressures and contact area to start from (initial_guess GIVEN), or the prescribed contact area (active_set FIXED).
    pub guess: Option<Guess<'a>>,
}

impl Solver {
    /// Solves many problems with the same options. As many are solved at a time as the solver has threads, each on one thread.
    ///
    /// `found(i, solved, state)` is called for each problem i, in any order, on the thread that solved it. `solved` is the value of
    /// [`solve`](Self::solve), and `state` the result, unless `solved` is an error. Element i of the returned list is what `found` returned for i.
    ///
    /// A refused problem does not affect the others. Results have the bits of solves one after the other on one thread. The order of the solves
    /// is not known, therefore PREVIOUS is refused, and so is a problem whose friction [continues](crate::scene::Previous::Kept) a step. The
    /// result of this solver, [`state`](Self::state), does not change.
    pub fn solve_batch<R: Send>(
        &mut self,
        problems: &[Problem<'_>],
        options: &Options,
        found: impl Fn(usize, Result<(Outcome, Report)>, &State) -> R + Sync + Send,
    ) -> Result<Vec<R>> {
        self.check_batch(options)?;
        let results: Vec<Mutex<Option<R>>> = problems.iter().map(|_| Mutex::new(None)).collect();
        self.distribute(problems.len(), |i, worker| {
            let Problem { scene, guess } = &problems[i];
            let solved = Solver::check_problem(scene).and_then(|()| worker.solve(scene, options, *guess, None));
            let result = found(i, solved, worker.state());
            *results[i].lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
        })?;
        let results = results.into_iter().map(|result| result.into_inner().unwrap_or_else(PoisonError::into_inner));
        // After `distribute` every problem has a result, so `flatten` drops none.
        Ok(results.flatten().collect())
    }

    /// Refuses options with which a batch cannot be solved.
    pub(crate) fn check_batch(&self, options: &Options) -> Result<()> {
        self.set_up.check_options(options)?;
        if options.initial_guess == InitialGuess::Previous {
            return invalid(
                "initial_guess is PREVIOUS; in a batch it must be NONE or GIVEN, for the order of the solves is not known"
                    .into(),
            );
        }
        Ok(())
    }

    /// Refuses a problem that continues a previous step: in a batch this would be whatever its worker solved last.
    pub(crate) fn check_problem(scene: &Scene<'_>) -> Result<()> {
        match effects::continuing(scene).next() {
            Some((.., Continues { member, instead, .. })) => invalid(format!(
                "{member} is 1; in a batch it must be 0, for the order of the solves is not known: {instead}"
            )),
            None => Ok(()),
        }
    }

    /// Calls `work(i, worker)` once for each `i < count`; free workers take the numbers in increasing order. Workers are solvers of one thread each,
    /// kept for later batches.
    pub(crate) fn distribute(&mut self, count: usize, work: impl Fn(usize, &mut Solver) + Sync + Send) -> Result<()> {
        let workers = self.problem.threads.count().min(count);
        let mut crew = std::mem::take(&mut self.workers);
        if crew.len() < workers {
            crew.resize_with(workers, || None);
        }
        let (next, refusal) = (AtomicUsize::new(0), Mutex::new(None));
        let foreman = &*self;
        let take = |worker: &mut Option<Solver>| {
            if worker.is_none() {
                // Without memory for this worker, the other ones take its numbers.
                match foreman.worker() {
                    Ok(new) => *worker = Some(new),
                    Err(error) => *refusal.lock().unwrap_or_else(PoisonError::into_inner) = Some(error),
                }
            }
            let Some(worker) = worker else { return };
            loop {
                let i = next.fetch_add(1, Ordering::Relaxed);
                if i >= count {
                    return;
                }
                work(i, worker);
            }
        };
        self.problem.threads.for_each_beside(&mut crew[..workers], take, take);
        self.workers = crew;
        match refusal.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(error) if next.into_inner() < count => Err(error),
            _ => Ok(()),
        }
    }

    /// Sets up a solver of one thread with the coefficients of this one. It accepts this solver's options, including its number of threads.
    pub(super) fn worker(&self) -> Result<Solver> {
        let (coefficients, set_up) = (self.problem.coefficients.clone(), self.set_up.clone());
        let worker = Solver::of(self.problem.grid, coefficients, set_up, &Threads::One)?;
        Ok(Solver { own_tables: self.own_tables.clone(), ..worker })
    }
}
