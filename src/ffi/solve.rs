//! `contact_normal_solve`, and what it shares with the solver handle.

use super::guard::guard;
use super::options::{self, contact_normal_options, Translated};
use super::report::{contact_normal_fields, contact_normal_ledger_row, contact_normal_progress, contact_normal_report};
use super::scene::{self, contact_normal_scene};
use super::status::{contact_normal_status, set_last_error, Refusal};
use super::structs;
use crate::scene::Scene;
use crate::solver::{ActiveSet, Guess, InitialGuess, Progress, Report, Solver, Stop};

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
        outputs.check_inputs(&options, scene.grid.len())?;
        let mut solver = Solver::new(&scene, &options.options)?;
        run(&mut solver, &scene, &options, &outputs)
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

    /// Whether the arrays that are read are there and hold what they must.
    pub fn check_inputs(&self, options: &Translated, n: usize) -> Result<(), Refusal> {
        let fixed = options.options.active_set == ActiveSet::Fixed;
        let given = options.options.initial_guess == InitialGuess::Given;
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

    /// The caller's initial guess: pressures and contact area.
    fn guess(&self, options: &Translated, n: usize) -> Option<(Vec<f64>, Vec<bool>)> {
        let given = options.options.initial_guess == InitialGuess::Given;
        let fixed = options.options.active_set == ActiveSet::Fixed;
        if !given && !fixed {
            return None;
        }
        let pressure = match given {
            // SAFETY: not null (check_inputs): n values, by the conventions of the ABI.
            true => unsafe { std::slice::from_raw_parts(self.fields.pressure, n) }.to_vec(),
            false => vec![0.0; n],
        };
        let contact = if self.fields.contact.is_null() {
            pressure.iter().map(|&p| p > 0.0).collect()
        } else {
            // SAFETY: likewise.
            unsafe { std::slice::from_raw_parts(self.fields.contact, n) }.iter().map(|&c| c != 0).collect()
        };
        Some((pressure, contact))
    }

    fn write(&self, solver: &Solver, report: &Report) -> Result<(), Refusal> {
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
            }
        }
        if self.report.is_null() {
            return Ok(());
        }
        let rows = solver.ledger();
        for (row, i) in rows.iter().zip(0..self.ledger_capacity as usize) {
            // SAFETY: i < ledger_capacity, the room in the caller's ledger.
            unsafe { self.ledger.add(i).write(row.into()) };
        }
        let report = contact_normal_report::of(report, rows.len(), self.ledger, self.ledger_capacity);
        // SAFETY: not null: a struct that declares its size.
        unsafe { structs::write(self.report, &report) }
    }
}

/// Solves with a solver that is set up, and writes the outputs.
pub(super) fn run(
    solver: &mut Solver,
    scene: &Scene<'_>,
    options: &Translated,
    outputs: &Outputs,
) -> Result<contact_normal_status, Refusal> {
    let n = scene.grid.len();
    outputs.check_inputs(options, n)?;
    let guess = outputs.guess(options, n);
    let guess = guess.as_ref().map(|(pressure, contact)| Guess { pressure, contact });
    let mut callback = |progress: &Progress| match options.progress {
        // SAFETY: the caller's function, called on the caller's thread with the caller's pointer; no lock is held.
        Some(callback) => unsafe { callback(&contact_normal_progress::from(progress), options.user) != 0 },
        None => false,
    };
    let (stop, report) =
        solver.solve(scene, &options.options, guess, options.progress.is_some().then_some(&mut callback))?;
    outputs.write(solver, &report)?;
    if stop != Stop::Converged {
        set_last_error(&explain(stop, &report));
    }
    Ok(stop.into())
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
