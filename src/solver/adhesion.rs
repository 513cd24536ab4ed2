//! Solves scenes with adhesion. The module [`adhesion`](crate::adhesion) does so on grids of its own. Some of its steps hold the attraction fixed
//! ("frozen"): what remains is a contact problem without adhesion, which the methods of AUTO solve.

use std::mem::MaybeUninit;

use super::adhesive_friction::check_alike;
use super::methods::Methods;
use super::stages;
use super::take_over::{is_without_contact, take_distance};
use super::{check, Asked, Criterion, Guess, InitialGuess, Method, Options, ProgressCallback, Report, Solver};
use crate::adhesion::{self, Frozen, Request, Surfaces};
use crate::contact::{self, lowest, Freshness, NonNegative, Problem, State, Survey};
use crate::effects::{self, Adhesion, Work};
use crate::error::{invalid, Error, Result};
use crate::grid::Grid;
use crate::methods::{Start, Task};
use crate::progress::{Goal, Monitor, Outcome, Progress};
use crate::scene::{Load, Scene};

/// Solves contact problems with frozen attraction ([`Frozen`]) by the methods of AUTO.
struct Plain(Methods);

impl Frozen for Plain {
    fn solve(
        &mut self,
        problem: &mut contact::Problem,
        state: &mut State,
        (tolerance, max_cycles): (f64, u64),
        monitor: &mut Monitor<'_>,
    ) -> Result<Outcome> {
        let lowest = lowest(&state.h);
        state.round_off = problem.round_off();
        state.reached_limit = false;
        if is_without_contact(state, lowest, false) {
            return Ok(Outcome::Converged);
        }
        problem.refresh(state, NonNegative)?;
        let survey = Survey::by(state, &problem.threads);
        let state_grid = state.grid;
        // The methods get a separate monitor. The callback below counts only cycles on the grid of the state as cycles of the caller's solve.
        let mut tell = |progress: &Progress| {
            let Progress { mx, my, active_set_changes, update, residual, .. } = *progress;
            let grid = Grid { mx, my, ..state_grid };
            if (mx, my) == (state_grid.mx, state_grid.my) {
                !monitor.cycle_done(&grid, active_set_changes, update, residual)
            } else {
                !monitor.uncounted_done(&grid, residual)
            }
        };
        let mut inner_monitor = Monitor::new(Some(&mut tell), Vec::new(), false);
        let goal = Goal { criterion: Criterion::Residual, tolerance, max_cycles };
        let mut task = Task { problem, state, lowest, set: NonNegative, goal, monitor: &mut inner_monitor };
        let stages = stages::stages::<NonNegative>(Method::Auto, true, false);
        self.0.solve(&mut task, (Start::Given, Some(survey)), stages, 0.0)
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

impl Solver {
    /// Returns a function from an element's index to its contact pressure q and attraction sigma in the last result. None without a result, or if
    /// its scene had no adhesion.
    pub fn adhesion(&self) -> Option<impl Fn(usize) -> (f64, f64) + '_> {
        let split = self.split.as_ref().filter(|_| self.has_result)?;
        Some(|i| split.at(&self.state, i))
    }

    /// Writes `which((q, sigma))` for each element of the last result: q is the contact pressure, sigma the attraction. Without adhesion q is p and
    /// sigma is 0.
    pub fn write_part(&self, to: &mut [MaybeUninit<f64>], which: impl Fn((f64, f64)) -> f64 + Sync + Send) {
        let (state, split) = (&self.state, self.adhesion());
        let parts = |i: usize| split.as_ref().map_or((state.p[i], 0.0), |split| split(i));
        let mx = state.grid.mx;
        self.problem.threads.for_each_plain_row(to, mx, |y, row| {
            row.iter_mut().zip(y * mx..).for_each(|(to, i)| {
                to.write(which(parts(i)));
            });
        });
    }

    /// Searches for the pull-off force: the least normal force of a stable state, which is negative if the bodies hold together. The approach
    /// decreases until nothing is in contact, once from the load of the scene, and again from bodies pressed together. The result is the state of
    /// the least force on these paths.
    pub fn pull_off(
        &mut self,
        scene: &Scene<'_>,
        options: &Options,
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<(Outcome, Report)> {
        let lowest = scene.check_distance_and_load(&self.problem.threads)?;
        self.set_up.check(scene, options, &self.problem)?;
        let asked = Asked::new((scene, lowest), options);
        check::guess(asked)?;
        let surface = effects::surface(scene)?;
        let changed = surface.as_deref().map(|h| Scene { undeformed_distance: h, ..scene.clone() });
        let asked = asked.on(changed.as_ref(), &self.problem.threads)?;
        let Some(adhesion) = scene.attraction() else {
            return invalid("adhesion is not given, or its work is 0: nothing holds the bodies together".into());
        };
        self.solve_adhesive(asked, (adhesion, true), progress)
    }

    /// Solves a checked scene with adhesion, or searches for its pull-off force if `pull_off`.
    pub(super) fn solve_adhesive(
        &mut self,
        asked: Asked<'_>,
        (adhesion, pull_off): (&Adhesion<'_>, bool),
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<(Outcome, Report)> {
        let Asked { scene, options, .. } = asked;
        check::guess(asked)?;
        check_options(options)?;
        // With adhesion the coefficients always contain the compression by the mean pressure, also for a given force.
        self.suit(Load::Approach(0.0))?;
        check::range(asked, &self.problem, self.set_up.largest_influence)?;
        if !self.problem.symmetric {
            let message = "adhesion is given, and the influence coefficients are not symmetric; this version does not solve them together";
            return Err(Error::Unsupported(message.into()));
        }
        check_alike(scene)?;
        self.check_continues(scene)?;
        let from_last_result = options.initial_guess == InitialGuess::Previous && self.has_result;
        let kept = self.kept(scene)?;
        self.methods.projected_cg.forget_windows();
        self.methods.projected_cg.forget_solutions();
        let mut monitor = Monitor::new(progress, std::mem::take(&mut self.ledger), false);
        self.has_result = false;
        take_distance(&mut self.state, scene.undeformed_distance, &self.problem.threads);
        let solved = self.run_adhesive(asked, (adhesion, pull_off), from_last_result, &mut monitor);
        self.ledger = std::mem::take(&mut monitor.ledger.rows);
        let solved = solved.and_then(|(outcome, found, split)| {
            let (outcome, friction) = self.rub(scene, (adhesion, &split), options, outcome, &mut monitor)?;
            Ok((outcome, found, friction, split))
        });
        if solved.is_err() {
            self.go_back(kept);
        }
        let (outcome, found, friction, split) = solved?;
        (self.has_result, self.split, self.compliance) = (true, Some(split), 1.0);
        effects::keep(scene, &mut self.beside.histories);
        let mut report = Report { adhesion: Some(found), friction, ..Report::of(&monitor, options.tolerance) };
        report.measures = self.ledger.last().map(|row| row.measures).unwrap_or_default();
        report.error.untrusted = found.untrusted();
        report.solve_seconds = monitor.seconds();
        report.setup_seconds = std::mem::take(&mut self.setup_seconds);
        report.bytes = self.bytes() as u64;
        report.log(options.method, &self.problem.grid, outcome);
        Ok((outcome, report))
    }

    /// Calls the solver of adhesion with the arrays of the state, and takes over its solution.
    fn run_adhesive(
        &mut self,
        Asked { scene, lowest, options, guess, .. }: Asked<'_>,
        (adhesion, pull_off): (&Adhesion<'_>, bool),
        from_last_result: bool,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, adhesion::Report, adhesion::Split)> {
        let mut solver = match self.adhesion.take() {
            Some(solver) => solver,
            None => {
                let operator = self.problem.operator()?.clone();
                let Problem { grid, coefficients, threads, .. } = &self.problem;
                Box::new(adhesion::Solver::new(*grid, coefficients, operator, threads)?)
            }
        };
        // The solver of adhesion has memory of its own for products.
        self.problem.rest();
        let lent = Lent::new(&mut solver, &mut self.state);
        let (contact, approach) = (&lent.state.contact[..], lent.state.approach);
        let start_state = match guess {
            _ if from_last_result => Some(adhesion::InitialState { pressure: None, contact, approach }),
            Some(Guess { pressure, contact }) => {
                Some(adhesion::InitialState { pressure: Some(pressure), contact, approach: lowest })
            }
            None => None,
        };
        let (work, works) = match adhesion.work {
            Work::Uniform(work) => (work, None),
            Work::PerElement(works) => (0.0, Some(works)),
        };
        let surfaces = Surfaces { law: adhesion.law, range: adhesion.range, work, works };
        let request = Request {
            surfaces,
            load: scene.load,
            pull_off,
            start: adhesion.start,
            state: start_state.filter(|start| lowest.is_finite() && start.approach.is_finite()),
            stiffness: adhesion.stiffness,
            stability: adhesion.stability,
            tolerance: options.tolerance,
            max_cycles: options.max_cycles as u64,
        };
        let make = |problem: &contact::Problem| -> Result<Box<dyn Frozen>> {
            Ok(Box::new(Plain(Methods::new(problem, options)?)))
        };
        let solved = lent.solver.solve(&request, &make, monitor);
        drop(lent);
        if solved.is_ok() {
            let (state, found) = (&mut self.state, solver.finest());
            state.contact.copy_from_slice(&found.now.contact);
            state.at_limit.fill(false);
            (state.load, state.approach, state.reached_limit) = (scene.load, found.now.approach(), false);
            (state.round_off, state.u_is) = (self.problem.round_off(), Freshness::Exact);
        }
        let solved = solved.and_then(|(outcome, found)| Ok((outcome, found, solver.split()?)));
        self.adhesion = Some(solver);
        solved
    }
}

/// Moves h, p and u of a state to a solver of adhesion while that solves, instead of copying them. Dropping the struct moves them back, also after
/// an error, so that the next solve works.
struct Lent<'a> {
    solver: &'a mut adhesion::Solver,
    state: &'a mut State,
}

impl<'a> Lent<'a> {
    fn new(solver: &'a mut adhesion::Solver, state: &'a mut State) -> Lent<'a> {
        state.u_is = Freshness::Stale;
        let State { h, p, u, .. } = &mut *state;
        solver.lend([h, p, u].map(std::mem::take));
        Lent { solver, state }
    }
}

impl Drop for Lent<'_> {
    fn drop(&mut self) {
        let State { h, p, u, .. } = &mut *self.state;
        [*h, *p, *u] = self.solver.give_back();
    }
}

/// Refuses options that exclude adhesion.
fn check_options(options: &Options) -> Result<()> {
    let (name, rule) = match options {
        Options { method: Method::Norm | Method::Multigrid | Method::FullMultigrid, .. } => {
            ("method is another one", "it must be AUTO or PROJECTED_CG")
        }
        Options { criterion: Criterion::Update, .. } => ("criterion is UPDATE", "it must be RESIDUAL"),
        _ => return Ok(()),
    };
    Err(Error::Unsupported(format!("adhesion is given, and {name}: {rule} in this version")))
}
