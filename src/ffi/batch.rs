//! `contact_normal_solver_solve_batch`: many problems in one call, spread over threads.

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

/// Solves `count` problems for the grid and the bodies of the solver, with the same options. As many are solved at a time as the
/// solver was set up with threads (0: all cores), each on one thread. `scenes`, `fields` and `reports` are arrays of `count`
/// structs, each filled by its `_init`; `statuses` is an array of `count` values. `fields`, `reports` and `statuses` may be NULL:
/// not wanted. A problem is refused if it reads or writes memory that another one writes.
///
/// A problem that is refused does not keep the others from being solved: its outputs stay as they are and `statuses` holds its
/// status. The call returns OK if all problems have that status, or else the status of the first one that was refused (< 0), or
/// else of the first one that stopped early (> 0). `contact_normal_last_error` then has a line "problem 3: ..." for each of them,
/// counted from 0 and in this order: 1000 lines at most. Where the arguments of the call itself are refused, `statuses` stays as it is too.
///
/// Results have the same bits as those of `contact_normal_solver_solve` for one problem after the other with one thread.
/// `initial_guess` may be NONE or GIVEN, not PREVIOUS, and a problem whose friction `continues` is refused. The last result of the solver itself stays, for later solves.
/// `progress` must be NULL (UNSUPPORTED): no callback is called from another thread; for the same reason there are no log
/// messages. The first batch sets up one solver per thread, which are kept. Since 0.1.
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
        // SAFETY: NULL or a handle of ours.
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
    outputs: Vec<Result<Outputs, Refusal>>,
    statuses: *mut contact_normal_status,
}

// SAFETY: the pointers are the caller's, who leaves what they point to alone during the call. Scenes are read only, and what is
// written for one problem no other reads or writes: by the conventions of the call, and `add_to`.
unsafe impl Sync for Batch {}

impl Batch {
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

    /// Adds all memory that is read and written, because several threads work at a time. A refused problem reads and writes nothing.
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

    /// Adds what problem `i` reads and writes.
    fn add_problem(&self, i: usize, regions: &mut Regions, n: usize) -> Result<(), Refusal> {
        self.outputs[i].as_ref().map_err(Refusal::clone)?.add_to(regions, n)?;
        // SAFETY: a scene that declares its size, by the conventions of the ABI.
        let (named, at) = unsafe { self.scenes.at(i, "scene").and_then(|at| Ok((Named::read(at)?, at)))? };
        named.add_to(regions, at)
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
            // The solve itself reports errors of the arguments.
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

/// The most problems with a line in the message of a batch.
const LINES: usize = 1000;

/// The problems that are not OK: those that were refused before those that stopped early, then by number.
#[derive(Default)]
pub(super) struct NotOk {
    first: Vec<(usize, Conclusion)>,
    /// The warnings of all problems.
    warnings: i32,
}

impl NotOk {
    pub fn note(&mut self, problem: usize, outcome: Conclusion) {
        let rank = |(problem, outcome): &(usize, Conclusion)| (outcome.status > CONTACT_NORMAL_OK, *problem);
        self.warnings |= outcome.warnings;
        if outcome.status != CONTACT_NORMAL_OK {
            let noted = (problem, outcome);
            self.first.insert(self.first.partition_point(|other| rank(other) < rank(&noted)), noted);
            self.first.truncate(LINES);
        }
    }

    /// The conclusion of the call. Its status is that of the first problem. Its message has a line for each problem ("problem 3: ..."), where `each`
    /// is the word for a problem. If all are OK, it has the warnings.
    pub fn outcome(self, each: &str) -> Conclusion {
        let status = self.first.first().map_or(CONTACT_NORMAL_OK, |(_, outcome)| outcome.status);
        let line = |(i, outcome): &(usize, Conclusion)| format!("{each} {i}: {}", outcome.message);
        let lines: Vec<String> = self.first.iter().map(line).collect();
        let warnings = if status == CONTACT_NORMAL_OK { self.warnings } else { 0 };
        Conclusion { status, message: lines.join("\n"), warnings, ..Conclusion::default() }
    }
}
