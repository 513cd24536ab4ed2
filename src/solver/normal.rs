//! The normal problem of a scene, on its admissible set.

use super::stages;
use super::take_over;
use super::{Asked, InitialGuess, Solver};
use crate::contact::{AdmissibleSet, Fixed, NonNegative, Survey};
use crate::effects;
use crate::error::Result;
use crate::memory::{reserve, zeros};
use crate::methods::Task;
use crate::progress::{Monitor, Outcome};
use crate::scene::{Each, PressureLimit};

impl Solver {
    /// Solves the normal problem on the scene's admissible set.
    pub(super) fn solve_normal(&mut self, asked: Asked<'_>, monitor: &mut Monitor<'_>) -> Result<(Outcome, f64)> {
        take_over::take_distance(&mut self.state, asked.scene.undeformed_distance, &self.problem.threads);
        match effects::limits(asked.scene) {
            _ if asked.options.is_fixed() => self.run(asked, Fixed, monitor),
            None => self.run(asked, NonNegative, monitor),
            Some(limit) => self.run_limited(asked, limit, monitor),
        }
    }

    /// Solves with limits, which are copied, as a callback may change the caller's.
    fn run_limited(
        &mut self,
        asked: Asked<'_>,
        limit: PressureLimit<'_>,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, f64)> {
        let options = asked.options;
        let n = self.state.p.len();
        if self.state.at_limit.is_empty() {
            self.state.at_limit = zeros(n, "elements at their limit")?;
        }
        let mut limits = std::mem::take(&mut self.limits);
        let set = match limit.0 {
            Each::Uniform(_) => limit,
            Each::PerElement(given) => {
                limits.clear();
                reserve(&mut limits, n, "pressure limits")?;
                limits.extend_from_slice(given);
                PressureLimit(Each::PerElement(&limits))
            }
        };
        let mut solved = self.run(asked, set, monitor);
        // An element at its limit with e near 0 is there by round-off of an equal pressure.
        let on_the_way = self.state.reached_limit && {
            let scale = Survey::of(&self.state).scale;
            let held = |i: usize| self.state.deformed_distance(i) < -options.tolerance * scale;
            !(0..n).any(|i| self.state.at_limit[i] && held(i))
        };
        let converged = matches!(solved, Ok((Outcome::Converged, _)));
        if on_the_way && converged && options.initial_guess != InitialGuess::Previous {
            // Only iterates reached a limit. If the solve without limits converges and stays within them, its bits are the result.
            let window = self.methods.projected_cg.current_window();
            let found = (self.state.copy(&self.problem.threads)?, std::mem::take(&mut monitor.ledger), monitor.count);
            monitor.ledger.estimates = found.1.estimates;
            monitor.enter_grid();
            self.methods.forget_iterates();
            let without = self.run(asked, NonNegative, monitor);
            let exceeds = self.state.p.iter().enumerate().any(|(i, p)| *p > set.limit(i));
            if matches!(without, Ok((Outcome::Converged, _))) && !exceeds {
                solved = without;
            } else {
                let work_units = monitor.count.work_units;
                (self.state, monitor.ledger, monitor.count) = found;
                (monitor.survey, self.has_result) = (None, true);
                monitor.count.work_units = work_units;
                self.methods.forget_iterates();
                self.methods.projected_cg.forget_solutions();
                self.methods.projected_cg.go_back_to(window);
                if let (Ok((outcome, _)), true) = (&mut solved, monitor.is_cancelled()) {
                    *outcome = Outcome::Cancelled;
                }
            }
        }
        self.limits = limits;
        solved
    }

    /// Solves on an admissible set, with the distances of the state. Returns the outcome and the tolerance used.
    fn run<S: AdmissibleSet>(&mut self, asked: Asked<'_>, set: S, monitor: &mut Monitor<'_>) -> Result<(Outcome, f64)> {
        let Asked { lowest, options, .. } = asked;
        let Solver { problem, state, methods, set_up, has_result, .. } = self;
        let multigrid = set_up.without_multigrid.is_none();
        let stages = stages::stages::<S>(options.method, problem.symmetric, multigrid);
        // From here on the last result is lost, unless this solve completes.
        let solved = std::mem::replace(has_result, false);
        if options.initial_guess != InitialGuess::Previous || !solved {
            methods.projected_cg.forget_windows();
        }
        if !solved {
            methods.projected_cg.forget_solutions();
        }
        let (from, survey) = take_over::take_over(problem, state, set, (asked, solved), monitor)?;
        let mut task = Task { problem, state, lowest, set, goal: options.goal(), monitor };
        let is_unloaded = take_over::is_without_contact(task.state, lowest, S::FIXED)
            || take_over::is_even_without_force::<S>(task.state);
        let outcome = if is_unloaded {
            Outcome::Converged
        } else if take_over::fills_limits(task.problem, task.state, set)? {
            task.count_products();
            Outcome::Converged
        } else {
            methods.solve(&mut task, (from, survey), stages, options.error_ratio)?
        };
        let outcome = if task.monitor.is_cancelled() { Outcome::Cancelled } else { outcome };
        *has_result = true;
        task.monitor.close_grid(task.state);
        Ok((outcome, task.goal.tolerance))
    }
}
