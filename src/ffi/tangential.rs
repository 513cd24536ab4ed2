//! `contact_normal_solve_tangential`: one tangential problem with given pressures, or a table of them.

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

/// Solves tangential problems of `scene->friction`: one, for programs that have a normal solver of their own, or a table of creep forces.
///
/// `solver` holds coefficients, operators and the last tractions for the next call, for `friction->continues` and for `initial_guess`
/// PREVIOUS; `scene` and `options` must be those of its set-up. NULL: each call sets up its own.
///
/// `pressure` `[my][mx]`: an element without a positive pressure is exterior. The undeformed distance and the load are not read and may be left
/// unset. Tractions do not change the pressures, also of unlike bodies. NULL, without a solver: the normal problem of the scene is solved
/// first, once.
///
/// `entries` `[n][3]`: for each entry the prescribed values in x and in y (creepages, or forces where `scene->friction->prescribed` says so) and the
/// spin. NULL, with n = 1: those of `scene->friction`. With given pressures this is one problem: all threads work on it, `progress` is
/// called for each iteration, and a refused call leaves `results` unchanged.
///
/// `report` (NULL: not wanted) has the measures of the pressures and, for one problem, those of friction. Its `warnings` has LAW if the
/// problem or one of the entries has this warning.
///
/// `options->threads` entries are solved at a time. Neighbours in the table should be neighbours in the motion: a run of 16 entries is solved
/// one after the other, each from the tractions of the one before if it differs little. All meet the tolerance. Results have the same bits
/// for any number of threads. `continues` is refused. The last result of the solver stays unchanged.
///
/// The other entries are solved if one is refused: its results stay unchanged, and `results->status` holds its status. The call returns OK if
/// the normal problem and all entries are OK. Otherwise it returns the status of the first entry that was refused (< 0), or if there is
/// none, that of the normal problem or of the first entry that stopped early (> 0). `contact_normal_last_error` then has a line
/// "entry 3: ..." for each such entry, counted from 0: 1000 lines at most.
///
/// `progress` is called on the calling thread: after the cycles of the normal problem, and then about once for each entry; `cycles` is the
/// number of solved entries and `residual` that of the last one. When it cancels, the results of unsolved entries stay unchanged, with
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
        // SAFETY: NULL or a handle of ours.
        let mut in_use = if solver.is_null() { None } else { Some(unsafe { InUse::begin(solver)? }) };
        if in_use.is_some() && pressure.is_null() {
            return Err(Refusal::null("pressure (with a solver)"));
        }
        // SAFETY: NULL or a struct that declares its size, by the conventions of the ABI.
        let results_given = unsafe { structs::read_optional(results.cast_const(), "results")? };
        let wanted = results_given.unwrap_or_default();
        let mut own = Buffers::default();
        // SAFETY: likewise.
        let request = unsafe {
            let also = |regions: &mut Regions, elements: usize| {
                regions.input("pressure", pressure, elements)?;
                regions.input("entries", entries.cast::<[f64; 3]>(), n)?;
                results_given.map_or(Ok(()), |given| given.add_to(regions, results, (n, elements)))
            };
            let needs = if pressure.is_null() { Needs::All } else { Needs::NoLoad };
            let buffers = in_use.as_mut().map_or(&mut own, |in_use| &mut in_use.held().buffers);
            Request::read(needs, (scene, options), (null_mut(), report), buffers, also)
        };
        match in_use.as_mut().map(InUse::held) {
            Some(Held { solver, buffers }) => {
                recording.keep_with(&buffers.regions, solver, request.as_ref().is_ok_and(Request::goes_on));
            }
            None => recording.keep(&own.regions),
        }
        let Request { scene: read, options, outputs } = request?;
        // SAFETY (both): NULL or arrays of this size, by the conventions of the ABI.
        let (pressure, given) = unsafe {
            let given = match (n, entries.is_null()) {
                (0, _) => Some(&[][..]),
                (1, true) => None,
                _ => Some(required("entries", entries.cast::<[f64; 3]>(), n)?),
            };
            (optional(pressure, read.grid.len()), given)
        };
        let solver = in_use.as_mut().map(|in_use| &mut in_use.held().solver);
        let call = Call { scene: &read, options: &options, outputs: &outputs, wanted: &wanted };
        call.solve(solver, pressure, given)
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_solve_tangential", options, arguments, solve) }
}

/// The arguments that all entries share.
struct Call<'a> {
    scene: &'a Scene<'a>,
    options: &'a Translated,
    outputs: &'a Outputs,
    wanted: &'a contact_normal_friction_results,
}

impl Call<'_> {
    /// One problem if pressures are given and entries are not; otherwise a table.
    fn solve(
        &self,
        solver: Option<&mut Solver>,
        pressure: Option<&[f64]>,
        given: Option<&[[f64; 3]]>,
    ) -> Result<contact_normal_status, Refusal> {
        match (pressure, given) {
            (Some(pressure), None) => self.one(solver, pressure),
            (None, None) => self.table(solver, pressure, self.scene.friction.as_ref().map(Entry::of).as_slice()),
            (_, Some(given)) => {
                let entry = |&[x, y, spin]: &[f64; 3]| Entry { amount: [x, y], spin };
                self.table(solver, pressure, &collected(given.iter().map(entry), "the entries of a table")?)
            }
        }
    }

    /// One problem, on all threads.
    fn one(&self, solver: Option<&mut Solver>, pressure: &[f64]) -> Result<contact_normal_status, Refusal> {
        let (scene, options) = (self.scene, &self.options.options);
        let watcher = Watcher::of(self.options);
        let told = &mut watcher.told();
        let progress = watcher.callback(told);
        let one_shot;
        let (stop, solution, report) = match solver {
            Some(solver) => solver.solve_tangential(scene, pressure, options, progress)?,
            None => {
                let (stop, solution, report) = solve_tangential(scene, pressure, options, progress)?;
                one_shot = solution;
                (stop, &one_shot, report)
            }
        };
        if let Some(found) = report.friction {
            // SAFETY: the caller's arrays were checked; there is one entry.
            unsafe { self.wanted.write(0, Ok((stop, found)), Some(solution)) };
        }
        let warnings = self.outputs.warnings_of_law(report.friction.map(|found| found.law_slope));
        self.outputs.write_report(&report, &[], warnings)?;
        let concluded = Conclusion::of(stop, || explain(stop, &report, options.method, None));
        self.concluded(watcher.conclusion(Conclusion { warnings, ..concluded }), 1)
    }

    /// A table, each entry on one thread.
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
        let found = |i: usize, ended: Ended, solution: Option<&Solution>| {
            if let Ok((_, report)) = &ended {
                let mut most = steepest.lock().unwrap_or_else(PoisonError::into_inner);
                *most = most.max(report.law_slope);
            }
            // SAFETY: each entry is solved by one thread; the caller's arrays were checked.
            let outcome = unsafe { self.wanted.write(i, ended, solution) };
            not_ok.lock().unwrap_or_else(PoisonError::into_inner).note(i, outcome);
        };
        let (stop, normal) = match (solver, pressure) {
            (Some(solver), Some(pressure)) => {
                solver.solve_friction_batch(self.scene, pressure, table, options, progress, found)?
            }
            _ => solve_friction_batch(self.scene, pressure, table, options, progress, found)?,
        };
        let steepest = steepest.into_inner().unwrap_or_else(PoisonError::into_inner);
        let warnings = self.outputs.warnings_of_law(Some(steepest));
        self.outputs.write_report(&normal, &[], warnings)?;
        let entries = not_ok.into_inner().unwrap_or_else(PoisonError::into_inner).outcome("entry");
        let message = || format!("the normal problem: {}", explain(stop, &normal, options.method, None));
        let concluded = match entries.status {
            CONTACT_NORMAL_OK if stop != Outcome::Converged => Conclusion::of(stop, message),
            _ => entries,
        };
        self.concluded(watcher.conclusion(Conclusion { warnings, ..concluded }), table.len())
    }

    /// Ends a call of n entries. An entry that `max_seconds` ended gets the status of the call.
    fn concluded(&self, of: Conclusion, n: usize) -> Result<contact_normal_status, Refusal> {
        if of.is_late {
            // SAFETY: the caller's arrays were checked.
            unsafe { self.wanted.late(n) };
        }
        of.conclude()
    }
}
