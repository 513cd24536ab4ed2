//! `contact_normal_solver_solve_batch`: many problems in one call, each of which one thread solves.

use std::ptr::null_mut;
use std::sync::{Mutex, PoisonError};

use super::arguments::{not_negative, Regions};
use super::conclusion::Conclusion;
use super::dump::{Given, Recording};
use super::fields::contact_normal_fields;
use super::guard::guard;
use super::log::quietly;
use super::options::{self, contact_normal_options, Translated};
use super::outputs::{Buffers, Outputs};
use super::report::contact_normal_report;
use super::scene::{contact_normal_scene, Named};
use super::solve::run;
use super::solver::{contact_normal_solver, Held, InUse};
use super::status::{
    contact_normal_status, Refusal, CONTACT_NORMAL_OK, CONTACT_NORMAL_OUT_OF_MEMORY, CONTACT_NORMAL_UNSUPPORTED,
};
use super::structs::Rows;
use super::watcher::Watcher;
use crate::memory::collected;
use crate::solver::Solver;

/// Solves `count` problems for the grid and the bodies of the solver, with the same options. The solver's threads (0: all cores) solve different
/// problems at a time, one problem per thread. `scenes`, `fields` and `reports` are arrays of `count` structs, each filled by its `_init`;
/// `statuses` is an array of `count` values. `fields`, `reports` and `statuses` may be NULL: not wanted. The call is refused if one problem
/// reads or writes memory that another one writes.
///
/// If a problem is refused, the others are still solved. The outputs of the refused problem are not written, and `statuses` has its status. The
/// call returns OK if all problems have this status. Otherwise it returns the status of the first refused problem (< 0) or, if there is none, of the
/// first problem that stopped early (> 0). `contact_normal_last_error` then has a line "problem 3: ..." for each problem that is not OK: first the
/// refused ones, then the others, counted from 0, and at most 1000 lines. If the arguments of the call itself are refused, `statuses` is not written.
///
/// Results have the same bits as those of `contact_normal_solver_solve` for one problem after the other with one thread.
/// `initial_guess` may be NONE or GIVEN, not PREVIOUS, and a problem whose friction `continues` is refused. The last result of the solver itself is
/// kept for later solves. `progress` must be NULL (else UNSUPPORTED), because no callback is called from another thread. For the same reason there
/// are no log messages. The first batch sets up one solver per thread, which the handle keeps. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_solve_batch(
    solver: *mut contact_normal_solver,
    count: i32,
    scenes: *const contact_normal_scene,
    options: *const contact_normal_options,
    fields: *mut contact_normal_fields,
    reports: *mut contact_normal_report,
    statuses: *mut contact_normal_status,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a handle of this library.
        let mut in_use = unsafe { InUse::begin(solver)? };
        let Held { solver, buffers } = in_use.held();
        let count = not_negative("count", count)?;
        let options_at = options;
        // SAFETY: NULL or a struct that declares its size, by the conventions of the ABI.
        let options = unsafe { options::translate(options)? };
        if options.given.progress.is_some() {
            let message = "progress is given; in a batch it must be NULL: no callback is called from another thread";
            return Err(Refusal::new(CONTACT_NORMAL_UNSUPPORTED, message.into()));
        }
        solver.check_batch(&options.options)?;
        if count == 0 {
            return Ok(CONTACT_NORMAL_OK);
        }
        if scenes.is_null() {
            return Err(Refusal::null("scenes"));
        }
        // SAFETY: NULL or arrays of `count` structs, by the conventions of the ABI.
        let mut batch = unsafe { Batch::new(count, scenes, fields, reports, statuses)? };
        let regions = &mut buffers.regions;
        regions.clear();
        options.add_to(regions, options_at)?;
        batch.add_to(regions, solver.grid().len())?;
        regions.check()?;
        let (not_ok, n) = (Mutex::new(NotOk::default()), solver.grid().len());
        solver.distribute(count, |i, worker| {
            // SAFETY: each problem is solved by one thread.
            let outcome = quietly(|| unsafe { batch.solve(i, worker, (&options, n)) });
            not_ok.lock().unwrap_or_else(PoisonError::into_inner).note(i, outcome);
        })?;
        not_ok.into_inner().unwrap_or_else(PoisonError::into_inner).outcome("problem").conclude()
    })
}

/// The caller's arrays.
struct Batch {
    scenes: Rows<contact_normal_scene>,
    /// The outputs of each problem, or why the problem is refused.
    outputs: Vec<Result<Outputs, Refusal>>,
    /// `count` values, or NULL.
    statuses: *mut contact_normal_status,
}

// SAFETY: the caller does not touch the memory of the pointers during the call. Scenes are only read. No problem reads or writes memory that another
// one writes: `add_to` lists all memory, and overlaps are refused.
unsafe impl Sync for Batch {}

impl Batch {
    /// Reads the structs of the outputs of all problems.
    unsafe fn new(
        count: usize,
        scenes: *const contact_normal_scene,
        fields: *mut contact_normal_fields,
        reports: *mut contact_normal_report,
        statuses: *mut contact_normal_status,
    ) -> Result<Batch, Refusal> {
        // SAFETY (all): by the caller.
        unsafe {
            let scenes = Rows::of(scenes.cast_mut(), "scenes")?;
            let fields = if fields.is_null() { None } else { Some(Rows::of(fields, "fields")?) };
            let reports = if reports.is_null() { None } else { Some(Rows::of(reports, "reports")?) };
            let outputs_of = |i: usize| {
                let report = reports.as_ref().map_or(Ok(null_mut()), |rows| rows.at(i, "report"))?;
                let fields = fields.as_ref().map_or(Ok(null_mut()), |rows| rows.at(i, "fields"))?;
                Outputs::of(fields, report)
            };
            let outputs = collected((0..count).map(outputs_of), "the outputs of a batch")?;
            Ok(Batch { scenes, outputs, statuses })
        }
    }

    /// Adds the memory that all problems read and write, because several threads work at a time. A refused problem reads and writes nothing.
    fn add_to(&mut self, regions: &mut Regions, n: usize) -> Result<(), Refusal> {
        regions.output("statuses", self.statuses, self.outputs.len())?;
        for i in 0..self.outputs.len() {
            regions.enter_problem(i);
            match self.add_problem(i, regions, n) {
                Ok(()) => {}
                Err(refusal) if refusal.status == CONTACT_NORMAL_OUT_OF_MEMORY => return Err(refusal),
                Err(refusal) => {
                    regions.leave_out_problem();
                    self.outputs[i] = Err(refusal);
                }
            }
        }
        Ok(())
    }

    /// Adds the memory that problem `i` reads and writes.
    fn add_problem(&self, i: usize, regions: &mut Regions, n: usize) -> Result<(), Refusal> {
        self.outputs[i].as_ref().map_err(Refusal::clone)?.add_to(regions, n)?;
        // SAFETY: a scene that declares its size, by the conventions of the ABI.
        let scene = unsafe { self.scenes.at(i, "scene")? };
        // SAFETY: as above.
        unsafe { Named::read(scene)? }.add_to(regions, scene)
    }

    /// Solves problem `i` and writes its outputs and its status. No two threads may do so for the same `i`.
    unsafe fn solve(&self, i: usize, worker: &mut Solver, (options, n): (&Translated, usize)) -> Conclusion {
        let (fields, report) = self.outputs[i].as_ref().map_or((null_mut(), null_mut()), Outputs::at);
        // SAFETY: as below.
        let (scene, given_options) =
            (unsafe { self.scenes.at(i, "scene") }.unwrap_or(null_mut()), &raw const options.given);
        let arguments = &[
            ("scene", scene.given()),
            ("options", given_options.given()),
            ("fields", fields.given()),
            ("report", report.given()),
        ];
        // SAFETY: as below.
        let mut recording = unsafe { Recording::new("contact_normal_solver_solve", given_options, arguments) };
        if recording.is_wanted() {
            let mut regions = Regions::default();
            // If the arguments have errors, the solve below reports them.
            let _ = options.add_to(&mut regions, given_options).and_then(|()| self.add_problem(i, &mut regions, n));
            if let Ok(outputs) = &self.outputs[i] {
                outputs.add_read(&mut regions, &options.options);
            }
            recording.keep_with(&regions, worker, false);
        }
        let mut solved = || -> Result<Conclusion, Refusal> {
            let outputs = self.outputs[i].as_ref().map_err(Refusal::clone)?;
            // SAFETY: a scene that declares its size, by the conventions of the ABI.
            let scene = unsafe { Named::read(self.scenes.at(i, "scene")?)?.translate()? };
            Solver::check_problem(&scene)?;
            let watcher = Watcher::without_callback(options);
            run(worker, &scene, &options.options, &watcher, outputs, &mut Buffers::default())
        };
        let mut outcome = solved().unwrap_or_else(Conclusion::from);
        outcome.message += &recording.finish(outcome.status, &outcome.message);
        if !self.statuses.is_null() {
            // SAFETY: not null: room for `count` values.
            unsafe { self.statuses.add(i).write(outcome.status) };
        }
        outcome
    }
}

/// The largest number of problems that have a line in the message of a batch.
const LINES: usize = 1000;

/// The problems of a batch that are not OK.
#[derive(Default)]
pub(super) struct NotOk {
    /// The number and the conclusion of each such problem: first the refused ones, then those that stopped early, each group in the order of numbers.
    problems: Vec<(usize, Conclusion)>,
    /// The bits of the warnings about all problems.
    warnings: i32,
}

impl NotOk {
    /// Adds the conclusion of a problem.
    pub fn note(&mut self, problem: usize, outcome: Conclusion) {
        let rank = |(problem, outcome): &(usize, Conclusion)| (outcome.status > CONTACT_NORMAL_OK, *problem);
        self.warnings |= outcome.warnings;
        if outcome.status != CONTACT_NORMAL_OK {
            let noted = (problem, outcome);
            self.problems.insert(self.problems.partition_point(|other| rank(other) < rank(&noted)), noted);
            self.problems.truncate(LINES);
        }
    }

    /// The conclusion of the call. The status is that of the first problem in `problems`. The message has a line for each of these problems
    /// ("problem 3: ..."), which begins with the word `each`. If all problems are OK, the conclusion has the warnings.
    pub fn outcome(self, each: &str) -> Conclusion {
        let status = self.problems.first().map_or(CONTACT_NORMAL_OK, |(_, outcome)| outcome.status);
        let line = |(i, outcome): &(usize, Conclusion)| format!("{each} {i}: {}", outcome.message);
        let lines: Vec<String> = self.problems.iter().map(line).collect();
        let warnings = if status == CONTACT_NORMAL_OK { self.warnings } else { 0 };
        Conclusion { status, message: lines.join("\n"), warnings, ..Conclusion::default() }
    }
}
