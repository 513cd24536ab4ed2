//! `contact_normal_solve`, and what it shares with the solver handle.

use super::guard::guard;
use super::options::{self, contact_normal_options, Translated};
use super::report::{contact_normal_fields, contact_normal_ledger_row, contact_normal_progress, contact_normal_report};
use super::scene::{self, contact_normal_scene};
use super::status::{contact_normal_status, set_last_error, Refusal, CONTACT_NORMAL_OK};
use super::structs::{self, Versioned};
use crate::memory::reserve;
use crate::scene::Scene;
use crate::solver::{
    ActiveSet, Guess, InitialGuess, LedgerRow, Options, Progress, ProgressCallback, Report, Solver, Stop,
};

/// Solves one scene. `options` NULL: the defaults; `report` NULL: not wanted. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solve(
    scene: *const contact_normal_scene,
    options: *const contact_normal_options,
    fields: *mut contact_normal_fields,
    report: *mut contact_normal_report,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: each pointer is NULL or points to a struct that declares its size, by the conventions of the ABI.
        let (scene, options, outputs) =
            unsafe { (scene::translate(scene)?, options::translate(options)?, Outputs::of(fields, report)?) };
        // Before the set-up: a refusal should not cost one.
        outputs.check_inputs(&options.options, scene.grid.len())?;
        let mut solver = Solver::new(&scene, &options.options)?;
        run_watched(&mut solver, &scene, &options, &outputs, &mut GuessBuffer::default())
    })
}

/// The caller's output structs, after a check.
pub(super) struct Outputs {
    fields: contact_normal_fields,
    report: *mut contact_normal_report,
    ledger: *mut contact_normal_ledger_row,
    ledger_capacity: i64,
}

impl Outputs {
    pub unsafe fn of(
        fields: *mut contact_normal_fields,
        report: *mut contact_normal_report,
    ) -> Result<Outputs, Refusal> {
        // SAFETY: NULL or structs that declare their size.
        let fields = unsafe { structs::read(fields.cast_const(), "fields")? };
        let (mut ledger, mut ledger_capacity) = (std::ptr::null_mut(), 0);
        if !report.is_null() {
            // SAFETY: as above.
            let given = unsafe { structs::read(report.cast_const(), "report")? };
            (ledger, ledger_capacity) = (given.ledger, given.ledger_capacity);
            if ledger_capacity < 0 {
                return Err(Refusal::invalid(format!(
                    "report->ledger_capacity is {ledger_capacity}; it must not be negative"
                )));
            }
            if ledger_capacity > 0 && ledger.is_null() {
                return Err(Refusal::null("report->ledger (with ledger_capacity > 0)"));
            }
        }
        Ok(Outputs { fields, report, ledger, ledger_capacity })
    }

    /// Where no arrays are wanted.
    pub unsafe fn report_only(report: *mut contact_normal_report) -> Result<Outputs, Refusal> {
        let mut nothing = contact_normal_fields::defaults();
        // SAFETY: by the caller; a whole struct.
        unsafe { Outputs::of(&mut nothing, report) }
    }

    /// Whether the arrays that are read are there and hold what they must.
    pub fn check_inputs(&self, options: &Options, n: usize) -> Result<(), Refusal> {
        let fixed = options.active_set == ActiveSet::Fixed;
        let given = options.initial_guess == InitialGuess::Given;
        if fixed && self.fields.contact.is_null() {
            return Err(Refusal::null("fields->contact (with active_set FIXED)"));
        }
        if given && self.fields.pressure.is_null() {
            return Err(Refusal::null("fields->pressure (with initial_guess GIVEN)"));
        }
        // SAFETY: not null: n values, by the conventions of the ABI.
        if fixed && unsafe { std::slice::from_raw_parts(self.fields.contact, n) }.iter().all(|&c| c == 0) {
            return Err(Refusal::invalid(
                "active_set is FIXED, but fields->contact is empty; it must hold an element".into(),
            ));
        }
        Ok(())
    }

    /// The options with what the report asks for: errors are estimated after a start from nothing, or when there is room for a ledger.
    fn options(&self, options: &Options) -> Options {
        let from_nothing = options.initial_guess == InitialGuess::None;
        Options { estimates: !self.report.is_null() && (from_nothing || self.ledger_capacity > 0), ..*options }
    }

    /// The caller's initial guess: pressures and contact area.
    fn guess<'a>(
        &self,
        options: &Options,
        n: usize,
        buffer: &'a mut GuessBuffer,
    ) -> Result<Option<Guess<'a>>, Refusal> {
        let given = options.initial_guess == InitialGuess::Given;
        let fixed = options.active_set == ActiveSet::Fixed;
        if !given && !fixed {
            return Ok(None);
        }
        let GuessBuffer { pressure, contact } = buffer;
        pressure.clear();
        contact.clear();
        reserve(pressure, n, "the initial guess")?;
        reserve(contact, n, "the initial guess")?;
        if given {
            // SAFETY: not null (check_inputs): n values, by the conventions of the ABI.
            pressure.extend_from_slice(unsafe { std::slice::from_raw_parts(self.fields.pressure, n) });
        } else {
            pressure.resize(n, 0.0);
        }
        if self.fields.contact.is_null() {
            contact.extend(pressure.iter().map(|&p| p > 0.0));
        } else {
            // SAFETY: likewise.
            contact.extend(unsafe { std::slice::from_raw_parts(self.fields.contact, n) }.iter().map(|&c| c != 0));
        }
        Ok(Some(Guess { pressure, contact }))
    }

    /// The caller's arrays that a solve on `n` elements writes: name, address, bytes.
    pub fn written(&self, n: usize) -> impl Iterator<Item = (&'static str, usize, usize)> {
        let fields = &self.fields;
        let rows = self.ledger_capacity as usize;
        [
            ("pressure", fields.pressure as usize, n * size_of::<f64>()),
            ("displacement", fields.displacement as usize, n * size_of::<f64>()),
            ("deformed_distance", fields.deformed_distance as usize, n * size_of::<f64>()),
            ("contact", fields.contact as usize, n * size_of::<i32>()),
            ("ledger", self.ledger as usize, rows.saturating_mul(size_of::<contact_normal_ledger_row>())),
        ]
        .into_iter()
        .filter(|&(_, start, bytes)| start != 0 && bytes > 0)
    }

    /// Writes the caller's arrays.
    pub fn write_fields(&self, solver: &Solver) {
        let state = solver.state();
        let n = state.p.len();
        let fields = &self.fields;
        // SAFETY (all four): not null: room for n values, by the conventions of the ABI. One array may not serve twice.
        unsafe {
            if !fields.pressure.is_null() {
                std::ptr::copy_nonoverlapping(state.p.as_ptr(), fields.pressure, n);
            }
            if !fields.displacement.is_null() {
                std::ptr::copy_nonoverlapping(state.u.as_ptr(), fields.displacement, n);
            }
            if !fields.deformed_distance.is_null() {
                (0..n).for_each(|i| fields.deformed_distance.add(i).write(state.deformed_distance(i)));
            }
            if !fields.contact.is_null() {
                (0..n).for_each(|i| fields.contact.add(i).write(i32::from(state.contact[i])));
                let at_limit = state.at_limit.iter().enumerate().filter(|(_, &at_limit)| at_limit);
                at_limit.for_each(|(i, _)| fields.contact.add(i).write(2));
            }
        }
    }

    /// Writes the caller's report and ledger.
    pub fn write_report(&self, report: &Report, rows: &[LedgerRow]) -> Result<(), Refusal> {
        if self.report.is_null() {
            return Ok(());
        }
        // Where there is not room for all, those of the finest grids.
        let skipped = rows.len().saturating_sub(self.ledger_capacity as usize);
        for (i, row) in rows[skipped..].iter().enumerate() {
            // SAFETY: i < ledger_capacity, the room in the caller's ledger.
            unsafe { self.ledger.add(i).write(row.into()) };
        }
        let report = contact_normal_report::of(report, rows.len(), self.ledger, self.ledger_capacity);
        // SAFETY: not null: a struct that declares its size.
        unsafe { structs::write(self.report, &report) }
    }
}

/// Memory for initial guesses, kept by a handle from one solve to the next.
#[derive(Default)]
pub(super) struct GuessBuffer {
    pressure: Vec<f64>,
    contact: Vec<bool>,
}

/// How a solve ended, and its message; none after OK.
pub(super) struct Outcome {
    pub status: contact_normal_status,
    pub message: String,
}

impl Outcome {
    /// The end of an export: the message becomes that of this thread.
    pub fn conclude(self) -> Result<contact_normal_status, Refusal> {
        if self.status < CONTACT_NORMAL_OK {
            return Err(Refusal::new(self.status, self.message));
        }
        if self.status > CONTACT_NORMAL_OK {
            set_last_error(&self.message);
        }
        Ok(self.status)
    }
}

/// Tells the caller's progress callback, if there is one; whether to cancel.
pub(super) fn watcher(options: &Translated) -> impl FnMut(&Progress) -> bool + '_ {
    |progress| match options.progress {
        // SAFETY: the caller's function, called on the caller's thread with the caller's pointer; no lock is held.
        Some(callback) => unsafe { callback(&contact_normal_progress::from(progress), options.user) != 0 },
        None => false,
    }
}

/// Solves with a solver that is set up, and writes the outputs; the caller's progress callback watches.
pub(super) fn run_watched(
    solver: &mut Solver,
    scene: &Scene<'_>,
    options: &Translated,
    outputs: &Outputs,
    guess: &mut GuessBuffer,
) -> Result<contact_normal_status, Refusal> {
    let mut callback = watcher(options);
    let progress: Option<ProgressCallback<'_>> = options.progress.is_some().then_some(&mut callback);
    run(solver, scene, &options.options, progress, outputs, guess)?.conclude()
}

/// Solves with a solver that is set up, and writes the outputs.
pub(super) fn run(
    solver: &mut Solver,
    scene: &Scene<'_>,
    options: &Options,
    progress: Option<ProgressCallback<'_>>,
    outputs: &Outputs,
    guess: &mut GuessBuffer,
) -> Result<Outcome, Refusal> {
    let n = scene.grid.len();
    outputs.check_inputs(options, n)?;
    let options = &outputs.options(options);
    let (stop, report) = solver.solve(scene, options, outputs.guess(options, n, guess)?, progress)?;
    outputs.write_fields(solver);
    outputs.write_report(&report, solver.ledger())?;
    let message = if stop == Stop::Converged { String::new() } else { explain(stop, &report) };
    Ok(Outcome { status: stop.into(), message })
}

fn explain(stop: Stop, report: &Report) -> String {
    let (cycles, residual) = (report.cycles, report.measures.certificate.residual);
    let why = match stop {
        Stop::Converged => "solved",
        Stop::IterationLimit => "max_cycles was reached",
        Stop::Cancelled => "the progress callback cancelled",
        Stop::Stagnated => "no further progress",
    };
    format!("{why} after {cycles} cycles; the residual is {residual:e}")
}
