//! `contact_normal_report`: the results of a solve, the estimated errors, and the cost.

use super::adhesion::contact_normal_report_adhesion;
use super::ledger::{contact_normal_ledger_row, copy, known, set_errors, set_measures};
use super::structs::{versioned, Versioned};
use super::visco::contact_normal_report_visco;
use crate::friction;
use crate::solver::{Limit, Report};

/// `limited_by`: what limits the accuracy is not known.
pub const CONTACT_NORMAL_LIMITED_BY_UNKNOWN: i32 = 0;
/// `limited_by`: the grid limits the accuracy. A smaller tolerance would not improve it.
pub const CONTACT_NORMAL_LIMITED_BY_GRID: i32 = 1;
/// `limited_by`: the tolerance limits the accuracy. It allows a larger error than that of the grid.
pub const CONTACT_NORMAL_LIMITED_BY_TOLERANCE: i32 = 2;
const _: () = assert!(Limit::Unknown as i32 == CONTACT_NORMAL_LIMITED_BY_UNKNOWN);
const _: () = assert!(Limit::Grid as i32 == CONTACT_NORMAL_LIMITED_BY_GRID);
const _: () = assert!(Limit::Tolerance as i32 == CONTACT_NORMAL_LIMITED_BY_TOLERANCE);

/// The results of the normal problem: a group of `contact_normal_report`.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub struct contact_normal_report_normal {
    /// Approach.
    pub approach: f64,
    /// Sum of p dx dy.
    pub force: f64,
    /// Largest pressure.
    pub max_pressure: f64,
    /// Smallest pressure.
    pub min_pressure: f64,
    /// Contact area: the area of the elements in contact.
    pub contact_area: f64,
    /// Contact area, corrected for the elements along its outline; < 0: not known.
    pub corrected_area: f64,
    /// Elements in contact.
    pub contact_count: i64,
    /// Elements in contact in the first or last row or column. If there are any, the potential contact area may be too small.
    pub edge_count: i64,
    /// The tolerance to which the status refers: that of the options, or a larger one that `error_ratio` allows, or the one that a solve to
    /// an accuracy chooses.
    pub tolerance: f64,
    /// `||h - approach + A p|| / ||h - approach||`, 2-norms over C, with a fresh product in double precision. With adhesion the norm of the
    /// displacements of the elements of C by their own pressures replaces the denominator if it is larger. With adhesion and a given force the
    /// residual is at least the missing part of the force, relative to the sum of |p| dx dy.
    pub residual: f64,
    /// The largest penetration -e outside C, or gap e of an element at its pressure limit, a length; 0 if there is none.
    pub violation: f64,
    /// `sum of p |e| / sum of p |u|`.
    pub complementarity: f64,
    /// rms over C of the last change of p.
    pub update: f64,
    /// Room for later versions: 0.
    pub reserved: [f64; 8],
}

/// The results of the tangential problem: a group of `contact_normal_report`. Without friction all is 0.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub struct contact_normal_report_tangential {
    /// The forces on body 1 in x and in y: the sums of q dx dy.
    pub force: [f64; 2],
    /// The moment about the centre of spin: the sum of (x qy - y qx) dx dy.
    pub moment: f64,
    /// The creepages in x and in y, prescribed or computed.
    pub creepage: [f64; 2],
    /// The rms over C of the wrong part of the slip, divided by the rms of the rigid slip, with a fresh product in double precision. Wrong is the
    /// whole slip of an element that sticks, and the part that is not opposite to q of an element that slips. In a shift, and in steady rolling with
    /// a prescribed force, the rms of the displacements replaces the divisor if it is larger. In other cases the divisor is at least 1.5e-8 of the
    /// displacements now and before the step, which is their round-off.
    pub residual: f64,
    /// `sum of (s.q + mu p |s|) / sum of mu p |rigid slip|`: 0 for the solution only. Without a rigid slip the divisor of the residual replaces
    /// |rigid slip|.
    pub gap: f64,
    /// Elements that stick.
    pub stick_count: i64,
    /// Elements that slip.
    pub slip_count: i64,
    /// If `friction->sensitivities` is 1, else 0: the derivatives of the force in x (row 0), of the force in y (row 1) and of the moment (row 2)
    /// by the creepage in x, by the creepage in y and by the spin, `[3][3]`. Computed creepages are varied as if they were prescribed. The pressures
    /// of unlike bodies change with the tractions, except in `contact_normal_solve_tangential`, whose pressures are given. 0 after CANCELLED.
    pub sensitivities: [f64; 9],
    /// rms over C of the last change of q; 0 if the initial guess was not changed.
    pub update: f64,
    /// The largest slope by which the traction bounds fall with the slip, with the effect of memory, times an element's influence on itself; 0
    /// without a law. From 0.5 on the iteration may end as STAGNATED. From 1 on a single element has several solutions.
    pub law_slope: f64,
    /// Room for later versions: 0.
    pub reserved: [f64; 6],
}

/// The estimated errors: a group of `contact_normal_report`. Errors are estimated if the solve has no initial guess, or if there is room for a
/// ledger. They are absolute, and < 0 if they are not known.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub struct contact_normal_report_accuracy {
    /// Estimated error of the force, or of the approach if the force is prescribed.
    pub error_force: f64,
    /// Estimated error of the largest pressure.
    pub error_max_pressure: f64,
    /// Estimated error of the contact area.
    pub error_contact_area: f64,
    /// Estimated error of the corrected area.
    pub error_corrected_area: f64,
    /// Estimated error of the pressures: the rms of the error divided by the rms of p.
    pub error_pressure: f64,
    /// Estimated errors of the tangential forces in x and in y, or of the creepage in a direction whose force is prescribed. They are known only if
    /// `error_force` is: for shifts from rest and, for like bodies, for steady rolling from rest. With a law of friction, or a layer that hardens or
    /// softens, they are known for shifts with prescribed creepages only.
    pub error_tangential: [f64; 2],
    /// CONTACT_NORMAL_UNTRUSTED_... bits.
    pub untrusted: i32,
    /// What limits the accuracy: CONTACT_NORMAL_LIMITED_BY_...
    pub limited_by: i32,
    /// The approximate seconds of a solve with elements of half the size; < 0: not known.
    pub halved_seconds: f64,
    /// The estimated error of the force (or of the approach) with elements of half the size; < 0: not known.
    pub halved_error_force: f64,
    /// The effects that `options->neglect_below` left out: the sum of `1 << (o - 1)` over CONTACT_NORMAL_OMIT_... o. Since 0.2.
    pub neglected: i64,
    /// The error because of the effects that are left out: the largest relative change of a quantity, with the error of this change. Since 0.2.
    pub neglected_error: f64,
    /// Room for later versions: 0.
    pub reserved: [f64; 6],
}

/// The cost of the solve: a group of `contact_normal_report`.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub struct contact_normal_report_statistics {
    /// Cycles (of multigrid) or iterations (of conjugate gradients) on the finest grid.
    pub cycles: i64,
    /// Active-set steps on the finest grid.
    pub active_set_steps: i64,
    /// Elements that entered or left the contact area, added up over all cycles on the finest grid.
    pub active_set_changes: i64,
    /// Products u = A p on the finest grid.
    pub matrix_products: i64,
    /// Products u = A p on all grids, in units of products on the finest grid.
    pub work_units: f64,
    /// With friction: products of two components on all grids, in units of such products on the finest grid.
    pub tangential_products: f64,
    /// Seconds of the set-up; 0 for later solves with a handle.
    pub setup_seconds: f64,
    /// Seconds of the solve.
    pub solve_seconds: f64,
    /// Seconds of the tangential problem, which are part of `solve_seconds`.
    pub tangential_seconds: f64,
    /// Bytes that operators and unknowns take.
    pub bytes: i64,
    /// Room for later versions: 0.
    pub reserved: [f64; 8],
}

/// The results and the cost of a solve, in groups. The report is written only if the status is >= 0. Later versions put new members into the room at
/// the end of a group, and new groups at the end of the report. Members that the library does not know are 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_report {
    /// Set by `contact_normal_report_init`.
    pub struct_size: i64,
    /// The number of rows of the whole ledger: one per grid, coarsest first. If there is room for fewer, the rows of the finest grids are written.
    pub ledger_rows: i64,
    /// In: the number of rows for which `ledger` has room; default 0.
    pub ledger_capacity: i64,
    /// In: the caller's array, or NULL (default). `contact_normal_ledger_row_init` must have filled the first row.
    pub ledger: *mut contact_normal_ledger_row,
    /// Warnings, also if the status is OK: CONTACT_NORMAL_WARNING_... bits. `contact_normal_last_error` has them in words.
    pub warnings: i32,
    /// Always 0.
    pub reserved: i32,
    /// The results of the normal problem.
    pub normal: contact_normal_report_normal,
    /// The results of the tangential problem.
    pub tangential: contact_normal_report_tangential,
    /// The estimated errors.
    pub accuracy: contact_normal_report_accuracy,
    /// The cost of the solve.
    pub statistics: contact_normal_report_statistics,
    /// The results of adhesion.
    pub adhesion: contact_normal_report_adhesion,
    /// The results of a step in time.
    pub visco: contact_normal_report_visco,
}

versioned! {
    contact_normal_report, contact_normal_report_init, 704,
    normal: contact_normal_report_normal { corrected_area: -1.0, ..Default::default() },
    accuracy: contact_normal_report_accuracy {
        error_force: -1.0,
        error_max_pressure: -1.0,
        error_contact_area: -1.0,
        error_corrected_area: -1.0,
        error_pressure: -1.0,
        error_tangential: [-1.0; 2],
        halved_seconds: -1.0,
        halved_error_force: -1.0,
        ..Default::default()
    },
}

impl contact_normal_report {
    /// The report in C with the values of `report`. `ledger` and `ledger_capacity` are those of the caller's report, `given`.
    pub(super) fn of(report: &Report, ledger_rows: usize, given: &Self) -> Self {
        let mut to = Self { ledger_rows: ledger_rows as i64, ..Self::defaults() };
        (to.ledger, to.ledger_capacity) = (given.ledger, given.ledger_capacity);
        to.normal.set(report);
        to.accuracy.set(report);
        let statistics = &mut to.statistics;
        copy!(report.count => statistics: cycles, active_set_steps, active_set_changes, matrix_products, work_units);
        copy!(report => statistics: setup_seconds, solve_seconds, bytes);
        if let Some(found) = &report.adhesion {
            to.adhesion.set(found);
        }
        if let Some(found) = &report.visco {
            to.visco.set(found);
        }
        if let Some(found) = &report.friction {
            (statistics.tangential_products, statistics.tangential_seconds) = (found.products, found.seconds);
            to.accuracy.error_tangential = found.error.map(known);
            to.tangential.set(found);
        }
        to
    }
}

impl contact_normal_report_normal {
    fn set(&mut self, report: &Report) {
        copy!(report.measures.certificate => self: violation, complementarity, min_pressure);
        copy!(report.measures => self: edge_count);
        copy!(report => self: tolerance);
        copy!(report.count => self: update);
        set_measures!(self, report.measures);
    }
}

impl contact_normal_report_tangential {
    fn set(&mut self, found: &friction::Report) {
        copy!(found => self: force, moment, creepage, update, law_slope);
        copy!(found.certificate => self: residual, gap, stick_count, slip_count);
        let sensitivities = found.sensitivities.iter().flatten().flatten();
        self.sensitivities.iter_mut().zip(sensitivities).for_each(|(to, from)| *to = *from);
    }
}

impl contact_normal_report_accuracy {
    fn set(&mut self, report: &Report) {
        set_errors!(self, report.error);
        (self.halved_seconds, self.halved_error_force) = (known(report.halving.seconds), known(report.halving.force()));
        self.limited_by = report.limit as i32;
    }
}
