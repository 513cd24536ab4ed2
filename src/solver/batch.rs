//! Many problems at once: whole solves are spread over threads, each on one thread.

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
    /// The start, with GIVEN, and the contact area, with FIXED.
    pub guess: Option<Guess<'a>>,
}

impl Solver {
    /// Solves many problems with the same options, as many at a time as the solver was set up with threads. Each solve runs on
    /// one thread. `found(i, solved, state)` is called for each problem i, in any order, on the thread that solved it. `solved` is
    /// that of [`solve`](Self::solve). `state` is the result, unless `solved` is an error. Element i of the returned list is the
    /// value of this call.
    ///
    /// A refused problem does not affect the others. Results have the same bits as those of one solve
    /// after the other with one thread. PREVIOUS is refused, and so is a problem whose friction [continues](crate::scene::Previous::Kept): the
    /// order of the solves is not known. This solver's own [`state`](Self::state) stays as it is.
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
        // `distribute` has done all of them.
        Ok(results.flatten().collect())
    }

    /// Refuses options that exclude a batch.
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

    /// Refuses a problem that would continue from its worker's last solve.
    pub(crate) fn check_problem(scene: &Scene<'_>) -> Result<()> {
        match effects::continuing(scene).next() {
            Some((.., Continues { member, instead, .. })) => invalid(format!(
                "{member} is 1; in a batch it must be 0, for the order of the solves is not known: {instead}"
            )),
            None => Ok(()),
        }
    }

    /// Calls `work(i, worker)` for each `i < count` on a free worker.
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
                // If this fails, the other workers do its share.
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

    /// A solver like this one, of one thread. It accepts the same options.
    pub(super) fn worker(&self) -> Result<Solver> {
        let (coefficients, set_up) = (self.problem.coefficients.clone(), self.set_up.clone());
        let worker = Solver::of(self.problem.grid, coefficients, set_up, &Threads::One)?;
        Ok(Solver { own_tables: self.own_tables.clone(), ..worker })
    }
}
