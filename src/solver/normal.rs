//! The normal problem of a scene, with the admissible set that the scene and the options choose: p >= 0, 0 <= p <= limit, or any p on a given contact
//! area.

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
    /// Solves the normal problem. Returns the outcome and the tolerance used.
    pub(super) fn solve_normal(&mut self, asked: Asked<'_>, monitor: &mut Monitor<'_>) -> Result<(Outcome, f64)> {
        take_over::take_distance(&mut self.state, asked.scene.undeformed_distance, &self.problem.threads);
        match effects::limits(asked.scene) {
            _ if asked.options.is_fixed() => self.run(asked, Fixed, monitor),
            None => self.run(asked, NonNegative, monitor),
            Some(limit) => self.run_limited(asked, limit, monitor),
        }
    }

    /// Solves with pressure limits. Limits per element are copied, because a callback may change the caller's array.
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
        // Whether iterates reached a limit, but the solution needs none: no element is held at its limit against a notable penetration. (An element
        // at its limit with e near 0 has the same pressure without the limit, up to round-off.)
        let only_iterates = self.state.reached_limit && {
            let scale = Survey::of(&self.state).scale;
            let held = |i: usize| self.state.deformed_distance(i) < -options.tolerance * scale;
            !(0..n).any(|i| self.state.at_limit[i] && held(i))
        };
        let converged = matches!(solved, Ok((Outcome::Converged, _)));
        if only_iterates && converged && options.initial_guess != InitialGuess::Previous {
            // The scene is solved again without limits. If that solve converges and stays within the limits, it is the result: then the bits do not
            // depend on limits that the solution does not reach. Otherwise the solution with limits is restored.
            let window = self.methods.projected_cg.current_window();
            let with_limits = self.state.copy(&self.problem.threads)?;
            let (ledger, count) = (std::mem::take(&mut monitor.ledger), monitor.count);
            monitor.ledger.estimates = ledger.estimates;
            monitor.enter_grid();
            self.methods.forget_iterates();
            let without = self.run(asked, NonNegative, monitor);
            let exceeds = self.state.p.iter().enumerate().any(|(i, p)| *p > set.limit(i));
            if matches!(without, Ok((Outcome::Converged, _))) && !exceeds {
                solved = without;
            } else {
                let work_units = monitor.count.work_units;
                (self.state, monitor.ledger, monitor.count) = (with_limits, ledger, count);
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
        // From here on the state is overwritten, and the solver has a result only if this solve completes.
        let had_result = std::mem::replace(has_result, false);
        if options.initial_guess != InitialGuess::Previous || !had_result {
            methods.projected_cg.forget_windows();
        }
        if !had_result {
            methods.projected_cg.forget_solutions();
        }
        let (from, survey) = take_over::take_over(problem, state, set, (asked, had_result), monitor)?;
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
