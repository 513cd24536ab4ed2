//! `contact_normal_solve_tangential`: one tangential problem, or a table of tangential problems, with the same pressures.

use std::ptr::null_mut;
use std::sync::{Mutex, PoisonError};

use super::arguments::{not_negative, optional, required, Regions};
use super::batch::NotOk;
use super::conclusion::Conclusion;
use super::dump::{given, recorded, Recording};
use super::friction_results::contact_normal_friction_results;
use super::options::{contact_normal_options, Translated};
use super::outputs::{Buffers, Outputs};
use super::report::contact_normal_report;
use super::scene::contact_normal_scene;
use super::solve::{explain, Needs, Request};
use super::solver::{contact_normal_solver, Held, InUse};
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::structs;
use super::watcher::Watcher;
use crate::friction::Solution;
use crate::memory::collected;
use crate::scene::Scene;
use crate::solver::{solve_friction_batch, solve_tangential, Ended, Entry, Outcome, Solver};

/// Solves tangential problems with the friction of a scene: one problem, for programs that have another solver for the normal problem, or a table of
/// entries, for tables of creep forces.
///
/// `solver`: a handle that keeps the coefficients and operators, and the last tractions for `friction->continues` and `initial_guess` PREVIOUS of
/// the next call. `scene` and `options` must be those of its set-up. NULL: each call sets up operators of its own.
///
/// `pressure` `[my][mx]`: the given pressures; an element without a positive pressure is exterior. The undeformed distance and the load of the scene
/// are not read and may be left unset. Tractions do not change the given pressures, also for unlike bodies. NULL, without a solver: the call first
/// solves the normal problem of the scene, once.
///
/// `entries` `[n][3]`: for each entry the prescribed values in x and in y (creepages, or forces, by `scene->friction->prescribed`) and the spin.
/// NULL, with n = 1: the values of `scene->friction`. If the pressures are given and `entries` is NULL, the call solves one problem: all threads
/// work on it, `progress` is called for each iteration, and a refused call leaves `results` unchanged.
///
/// `report` (NULL: not wanted) gets the measures of the pressures and, for one problem, those of friction. Its `warnings` has LAW if the
/// problem or one of the entries has this warning.
///
/// Of a table, `options->threads` entries are solved at a time. Neighbouring entries should have similar motions: 16 entries in a row are solved one
/// after the other, and each starts from the tractions of the entry before if the motions differ little. All entries meet the tolerance, and results
/// have the same bits for any number of threads. `continues` is refused. The last result of the solver stays unchanged.
///
/// If an entry is refused, the others are still solved. The results of the refused entry stay unchanged, and `results->status` has its status. The
/// call returns OK if the normal problem and all entries are OK. Otherwise it returns the status of the first refused entry (< 0) or, if there is
/// none, that of the first entry that stopped early (> 0) or, if there is none either, that of the normal problem. `contact_normal_last_error` then
/// has a line "entry 3: ..." for each entry that is not OK, counted from 0: 1000 lines at most.
///
/// `progress` is called on the calling thread: after the cycles of the normal problem, and then about once for each entry. `cycles` is then the
/// number of solved entries, and `residual` that of the last one. If `progress` cancels, the results of unsolved entries stay unchanged, and have
/// the status CANCELLED, or ITERATION_LIMIT after `max_seconds`. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solve_tangential(
    solver: *mut contact_normal_solver,
    scene: *const contact_normal_scene,
    pressure: *const f64,
    options: *const contact_normal_options,
    n: i32,
    entries: *const f64,
    results: *mut contact_normal_friction_results,
    report: *mut contact_normal_report,
) -> contact_normal_status {
    let arguments = given![scene, pressure, options, n, entries, results, report];
    let solve = |recording: &mut Recording<'_>| {
        let n = not_negative("n", n)?;
        // SAFETY: NULL or a handle of this library.
        let mut in_use = if solver.is_null() { None } else { Some(unsafe { InUse::begin(solver)? }) };
        if in_use.is_some() && pressure.is_null() {
            return Err(Refusal::null("pressure (with a solver)"));
        }
        // SAFETY: NULL or a struct that declares its size, by the conventions of the ABI.
        let results_given = unsafe { structs::read_optional(results.cast_const(), "results")? };
        let wanted = results_given.unwrap_or_default();
        let mut new_buffers = Buffers::default();
        // SAFETY: as above.
        let request = unsafe {
            let also = |regions: &mut Regions, elements: usize| {
                regions.input("pressure", pressure, elements)?;
                regions.input("entries", entries.cast::<[f64; 3]>(), n)?;
                results_given.map_or(Ok(()), |given| given.add_to(regions, results, (n, elements)))
            };
            let needs = if pressure.is_null() { Needs::All } else { Needs::NoLoad };
            let buffers = in_use.as_mut().map_or(&mut new_buffers, |in_use| &mut in_use.held().buffers);
            Request::read(needs, (scene, options), (null_mut(), report), buffers, also)
        };
        match in_use.as_mut().map(InUse::held) {
            Some(Held { solver, buffers }) => {
                recording.keep_with(&buffers.regions, solver, request.as_ref().is_ok_and(Request::goes_on));
            }
            None => recording.keep(&new_buffers.regions),
        }
        let Request { scene: translated, options, outputs } = request?;
        // SAFETY (both): NULL or arrays of this size, by the conventions of the ABI.
        let (pressure, entries) = unsafe {
            let entries = match (n, entries.is_null()) {
                (0, _) => Some(&[][..]),
                (1, true) => None,
                _ => Some(required("entries", entries.cast::<[f64; 3]>(), n)?),
            };
            (optional(pressure, translated.grid.len()), entries)
        };
        let solver = in_use.as_mut().map(|in_use| &mut in_use.held().solver);
        let call = Call { scene: &translated, options: &options, outputs: &outputs, wanted: &wanted };
        call.solve(solver, pressure, entries)
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_solve_tangential", options, arguments, solve) }
}

/// The arguments that all entries share.
struct Call<'a> {
    scene: &'a Scene<'a>,
    options: &'a Translated,
    /// The report.
    outputs: &'a Outputs,
    /// The arrays for the results of entries.
    wanted: &'a contact_normal_friction_results,
}

impl Call<'_> {
    /// Solves one problem if pressures are given and entries are not; otherwise a table.
    fn solve(
        &self,
        solver: Option<&mut Solver>,
        pressure: Option<&[f64]>,
        entries: Option<&[[f64; 3]]>,
    ) -> Result<contact_normal_status, Refusal> {
        match (pressure, entries) {
            (Some(pressure), None) => self.one(solver, pressure),
            (None, None) => self.table(solver, pressure, self.scene.friction.as_ref().map(Entry::of).as_slice()),
            (_, Some(entries)) => {
                let entry = |&[x, y, spin]: &[f64; 3]| Entry { amount: [x, y], spin };
                self.table(solver, pressure, &collected(entries.iter().map(entry), "the entries of a table")?)
            }
        }
    }

    /// Solves one problem on all threads.
    fn one(&self, solver: Option<&mut Solver>, pressure: &[f64]) -> Result<contact_normal_status, Refusal> {
        let (scene, options) = (self.scene, &self.options.options);
        let watcher = Watcher::of(self.options);
        let told = &mut watcher.told();
        let progress = watcher.callback(told);
        let without_handle;
        let (outcome, solution, report) = match solver {
            Some(solver) => solver.solve_tangential(scene, pressure, options, progress)?,
            None => {
                let (outcome, solution, report) = solve_tangential(scene, pressure, options, progress)?;
                without_handle = solution;
                (outcome, &without_handle, report)
            }
        };
        if let Some(found) = report.friction {
            // SAFETY: the caller's arrays were checked; there is one entry.
            unsafe { self.wanted.write(0, Ok((outcome, found)), Some(solution)) };
        }
        let warnings = self.outputs.warnings_of_law(report.friction.map(|found| found.law_slope));
        self.outputs.write_report(&report, &[], warnings)?;
        let conclusion = Conclusion::of(outcome, || explain(outcome, &report, options.method, None));
        self.conclude(watcher.conclusion(Conclusion { warnings, ..conclusion }), 1)
    }

    /// Solves a table, each entry on one thread.
    fn table(
        &self,
        solver: Option<&mut Solver>,
        pressure: Option<&[f64]>,
        table: &[Entry],
    ) -> Result<contact_normal_status, Refusal> {
        let options = &self.options.options;
        let watcher = Watcher::of(self.options);
        let told = &mut watcher.told();
        let progress = watcher.callback(told);
        let (not_ok, steepest) = (Mutex::new(NotOk::default()), Mutex::new(0.0f64));
        let entry_done = |i: usize, ended: Ended, solution: Option<&Solution>| {
            if let Ok((_, report)) = &ended {
                let mut most = steepest.lock().unwrap_or_else(PoisonError::into_inner);
                *most = most.max(report.law_slope);
            }
            // SAFETY: each entry is solved by one thread; the caller's arrays were checked.
            let conclusion = unsafe { self.wanted.write(i, ended, solution) };
            not_ok.lock().unwrap_or_else(PoisonError::into_inner).note(i, conclusion);
        };
        let (outcome, normal) = match (solver, pressure) {
            (Some(solver), Some(pressure)) => {
                solver.solve_friction_batch(self.scene, pressure, table, options, progress, entry_done)?
            }
            _ => solve_friction_batch(self.scene, pressure, table, options, progress, entry_done)?,
        };
        let steepest = steepest.into_inner().unwrap_or_else(PoisonError::into_inner);
        let warnings = self.outputs.warnings_of_law(Some(steepest));
        self.outputs.write_report(&normal, &[], warnings)?;
        let entries = not_ok.into_inner().unwrap_or_else(PoisonError::into_inner).outcome("entry");
        let message = || format!("the normal problem: {}", explain(outcome, &normal, options.method, None));
        let conclusion = match entries.status {
            CONTACT_NORMAL_OK if outcome != Outcome::Converged => Conclusion::of(outcome, message),
            _ => entries,
        };
        self.conclude(watcher.conclusion(Conclusion { warnings, ..conclusion }), table.len())
    }

    /// Ends a call of n entries. Entries that `max_seconds` ended get the status ITERATION_LIMIT.
    fn conclude(&self, conclusion: Conclusion, n: usize) -> Result<contact_normal_status, Refusal> {
        if conclusion.is_late {
            // SAFETY: the caller's arrays were checked.
            unsafe { self.wanted.late(n) };
        }
        conclusion.conclude()
    }
}
