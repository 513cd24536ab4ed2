//! The outputs of a solve in the caller's memory: fields, a report and a ledger. The initial guess is read from the same fields.

use std::mem::MaybeUninit;
use std::slice::from_raw_parts_mut;

use super::arguments::{copy_to, Regions};
use super::fields::contact_normal_fields;
use super::ledger::contact_normal_ledger_row;
use super::report::contact_normal_report;
use super::status::Refusal;
use super::structs::{self, Rows, Versioned};
use super::warnings;
use crate::contact::State;
use crate::friction::{Solution, Vector, EXTERIOR};
use crate::memory::reserve;
use crate::scene::Scene;
use crate::solver::{ActiveSet, Guess, InitialGuess, LedgerRow, Neglected, Options, Report, Solver};

/// The caller's output structs, after a check.
pub(super) struct Outputs {
    /// A copy of the caller's `fields`.
    fields: contact_normal_fields,
    /// The address of the caller's `fields`, or NULL.
    fields_at: *const contact_normal_fields,
    /// The address of the caller's report, or NULL.
    report: *mut contact_normal_report,
    /// The contents of the caller's report before the call.
    given_report: Option<contact_normal_report>,
    /// The rows of the ledger in the caller's report. None: the report has no room for rows.
    ledger: Option<Rows<contact_normal_ledger_row>>,
    /// The effects that the solve leaves out of the scene (`neglect_below`).
    pub neglected: Option<Neglected>,
}

impl Outputs {
    /// Reads and checks the structs. NULL: not wanted.
    pub unsafe fn of(
        fields: *mut contact_normal_fields,
        report: *mut contact_normal_report,
    ) -> Result<Outputs, Refusal> {
        // SAFETY: NULL or structs that declare their size.
        let (given_fields, given_report) = unsafe {
            (
                structs::read_optional(fields.cast_const(), "fields")?,
                structs::read_optional(report.cast_const(), "report")?,
            )
        };
        let mut rows = None;
        if let Some(contact_normal_report { ledger, ledger_capacity, .. }) = given_report {
            if ledger_capacity < 0 {
                return Err(Refusal::invalid(format!(
                    "report->ledger_capacity is {ledger_capacity}; it must not be negative"
                )));
            }
            if ledger_capacity > 0 && ledger.is_null() {
                return Err(Refusal::null("report->ledger (with ledger_capacity > 0)"));
            }
            if ledger_capacity > 0 {
                // SAFETY: not null: its first row declares its size.
                rows = Some(unsafe { Rows::of(ledger, "report->ledger")? });
            }
        }
        let given_fields = given_fields.unwrap_or_else(contact_normal_fields::defaults);
        Ok(Outputs { fields: given_fields, fields_at: fields, report, given_report, ledger: rows, neglected: None })
    }

    /// The addresses of the caller's structs.
    pub fn at(&self) -> (*mut contact_normal_fields, *mut contact_normal_report) {
        (self.fields_at.cast_mut(), self.report)
    }

    /// Marks the arrays that the call also reads.
    pub fn add_read(&self, regions: &mut Regions, options: &Options) {
        let given = options.initial_guess == InitialGuess::Given;
        if given {
            regions.read_too(self.fields.pressure.cast_const());
        }
        if given || options.active_set == ActiveSet::Fixed {
            regions.read_too(self.fields.contact.cast_const());
        }
    }

    /// Refuses the call if an array that it has to read is missing, or if a FIXED contact area is empty.
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

    /// The options of the core. Errors are estimated if there is a report, and no initial guess or room for a ledger.
    pub fn options(&self, options: &Options) -> Options {
        let without_guess = options.initial_guess == InitialGuess::None;
        Options { estimates: self.given_report.is_some() && (without_guess || self.ledger_capacity() > 0), ..*options }
    }

    /// Copies the caller's initial guess, pressures and contact area, to `buffers`. None: the solve reads neither.
    pub fn guess<'a>(
        &self,
        options: &Options,
        n: usize,
        buffers: &'a mut Buffers,
    ) -> Result<Option<Guess<'a>>, Refusal> {
        let given = options.initial_guess == InitialGuess::Given;
        let fixed = options.active_set == ActiveSet::Fixed;
        if !given && !fixed {
            return Ok(None);
        }
        let Buffers { pressure, contact, .. } = buffers;
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

    /// Adds the outputs of a solve on `n` elements, and the struct that points to them.
    pub fn add_to(&self, regions: &mut Regions, n: usize) -> Result<(), Refusal> {
        let fields = &self.fields;
        regions.input_struct(self.fields_at, fields)?;
        regions.output("pressure", fields.pressure, n)?;
        regions.output("displacement", fields.displacement, n)?;
        regions.output("deformed_distance", fields.deformed_distance, n)?;
        regions.output("contact", fields.contact, n)?;
        for k in 0..2 {
            regions.output("traction", fields.traction[k], n)?;
            regions.output("slip", fields.slip[k], n)?;
        }
        regions.output("stick_slip", fields.stick_slip, n)?;
        regions.output("contact_pressure", fields.contact_pressure, n)?;
        regions.output("attraction", fields.attraction, n)?;
        regions.output("friction_coefficient", fields.friction_coefficient, n)?;
        regions.output("yield_limit", fields.yield_limit, n)?;
        if let Some(report) = &self.given_report {
            regions.output_struct(self.report, report)?;
            if let Some(rows) = &self.ledger {
                regions.output_rows("ledger", report.ledger, rows, self.ledger_capacity())?;
            }
        }
        Ok(())
    }

    /// Writes the caller's arrays. If the contact area `is_fixed`, the array `contact` is not written and keeps the caller's codes.
    pub fn write_fields(&self, solver: &Solver, is_fixed: bool) {
        let state = solver.state();
        let n = state.p.len();
        let fields = &self.fields;
        let contact = |i: usize| if state.at_limit.get(i) == Some(&true) { 2 } else { i32::from(state.contact[i]) };
        // SAFETY (all four): NULL or room for n values, by the conventions of the ABI; no two overlap (`Regions`).
        unsafe {
            copy_to(&state.p, fields.pressure, 0);
            copy_to(&state.u, fields.displacement, 0);
            write_each(fields.deformed_distance, n, |i| state.deformed_distance(i));
            if !is_fixed {
                write_each(fields.contact, n, contact);
            }
        }
        self.write_friction(solver.friction(), n);
        self.write_adhesion(solver);
    }

    /// Writes contact pressure and attraction, the two parts of the pressure. Without adhesion all pressure is contact pressure.
    fn write_adhesion(&self, solver: &Solver) {
        let n = solver.state().p.len();
        // SAFETY (both): not null: room for one value per element, as above, which may be uninitialised.
        let room = |to: *mut f64| unsafe { to.cast::<MaybeUninit<f64>>().as_mut().map(|to| from_raw_parts_mut(to, n)) };
        if let Some(to) = room(self.fields.contact_pressure) {
            solver.write_part(to, |(contact_pressure, _)| contact_pressure);
        }
        if let Some(to) = room(self.fields.attraction) {
            solver.write_part(to, |(_, attraction)| attraction);
        }
    }

    /// Writes the fields of friction; zeros without friction.
    pub fn write_friction(&self, found: Option<&Solution>, n: usize) {
        let fields = &self.fields;
        let value = |field: &[Vector], i: usize, k: usize| if found.is_some() { field[i][k] } else { 0.0 };
        let none = Solution::default();
        let Solution { traction, slip, stick_slip, particles } = found.unwrap_or(&none);
        let particle = |i: usize| particles.get(i).copied().unwrap_or_default();
        // SAFETY (all): NULL or room for n values, as above.
        unsafe {
            for k in 0..2 {
                write_each(fields.traction[k], n, |i| value(traction, i, k));
                write_each(fields.slip[k], n, |i| value(slip, i, k));
            }
            write_each(fields.stick_slip, n, |i| if found.is_some() { stick_slip[i] } else { EXTERIOR });
            write_each(fields.friction_coefficient, n, |i| particle(i).coefficient);
            write_each(fields.yield_limit, n, |i| particle(i).yield_limit);
        }
    }

    /// The warning about a law of friction; 0 if no report is wanted.
    pub fn warnings_of_law(&self, slope: Option<f64>) -> i32 {
        self.given_report.map_or(0, |_| warnings::of_law(slope))
    }

    /// The warnings about a result; 0 if no report is wanted.
    pub fn warnings(&self, scene: &Scene<'_>, options: &Options, report: &Report, state: &State) -> i32 {
        self.given_report.map_or(0, |_| warnings::of(scene, options, report, state))
    }

    /// Writes the caller's report and ledger.
    pub fn write_report(&self, report: &Report, rows: &[LedgerRow], warnings: i32) -> Result<(), Refusal> {
        let Some(given) = &self.given_report else { return Ok(()) };
        // If there is no room for all rows, those of the finest grids are written.
        let skipped = rows.len().saturating_sub(self.ledger_capacity());
        if let Some(ledger) = &self.ledger {
            // SAFETY: i < ledger_capacity, the room in the caller's ledger.
            rows[skipped..].iter().enumerate().for_each(|(i, row)| unsafe { ledger.write(i, &row.into()) });
        }
        let mut report = contact_normal_report { warnings, ..contact_normal_report::of(report, rows.len(), given) };
        if let Some(neglected) = &self.neglected {
            (report.accuracy.neglected, report.accuracy.neglected_error) = (neglected.bits(), neglected.error);
        }
        // SAFETY: not null: a struct that declares its size.
        unsafe { structs::write(self.report, &report) }
    }

    /// The number of rows for which the caller's ledger has room.
    fn ledger_capacity(&self) -> usize {
        self.given_report.map_or(0, |report| report.ledger_capacity as usize)
    }
}

/// Writes `value(i)` for each of n elements. NULL: not wanted.
unsafe fn write_each<A>(to: *mut A, n: usize, value: impl Fn(usize) -> A) {
    if !to.is_null() {
        // SAFETY: not null: room for n values, by the caller.
        unsafe { (0..n).for_each(|i| to.add(i).write(value(i))) };
    }
}

/// Memory for an initial guess and for the addresses of arrays. A handle keeps it from solve to solve.
#[derive(Default)]
pub(super) struct Buffers {
    pressure: Vec<f64>,
    contact: Vec<bool>,
    pub regions: Regions,
}
