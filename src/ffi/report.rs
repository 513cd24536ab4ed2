//! `contact_normal_report`: the results of a solve, their estimated errors, and their cost.

use super::adhesion::contact_normal_report_adhesion;
use super::ledger::{contact_normal_ledger_row, copy, known, set_errors, set_measures};
use super::structs::{versioned, Versioned};
use super::visco::contact_normal_report_visco;
use crate::friction;
use crate::solver::{Limit, Report};

/// `limited_by`: not known.
pub const CONTACT_NORMAL_LIMITED_BY_UNKNOWN: i32 = 0;
/// `limited_by`: the grid; a smaller tolerance would change nothing.
pub const CONTACT_NORMAL_LIMITED_BY_GRID: i32 = 1;
/// `limited_by`: the tolerance; it allows a larger error than that of the grid.
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
    /// Contact area: that of the elements in contact.
    pub contact_area: f64,
    /// Contact area, corrected for the elements along its outline; < 0: not known.
    pub corrected_area: f64,
    /// Elements in contact.
    pub contact_count: i64,
    /// Elements in contact on the first or last row or column: with any, the potential contact area may be too small.
    pub edge_count: i64,
    /// The tolerance that the status speaks of: that of the options, or a larger one where `error_ratio` allows it, or the one that
    /// an accuracy asks for.
    pub tolerance: f64,
    /// `||h - approach + A p|| / ||h - approach||`, 2-norms over C, with a fresh product in double precision. With adhesion relative to what the
    /// pressures of C displace their own elements by, where that is more, and at least what a force that is given lacks, relative to the sum of |p|.
    pub residual: f64,
    /// Largest -e outside C, or e of an element at its pressure limit; 0 if there is none: a length.
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
    /// The sum of q dx dy in x and y, on body 1.
    pub force: [f64; 2],
    /// The sum of (x qy - y qx) dx dy about the centre of spin.
    pub moment: f64,
    /// Creepages in x and y, given or found.
    pub creepage: [f64; 2],
    /// rms over C of the wrong part of the slip, relative to the rigid slip, with a fresh product in double precision. Wrong is all slip of an
    /// element that sticks, and the part that is not opposite to q where one slips. In a shift, and in steady rolling by a force, it is relative
    /// to the displacements where these are larger; otherwise to 1.5e-8 of the displacements, now and before the step, at least: their round-off.
    pub residual: f64,
    /// `sum of (s.q + mu p |s|) / sum of mu p |rigid slip|`: 0 for the solution only. Without a rigid slip the scale of the residual is in its place.
    pub gap: f64,
    /// Elements that stick.
    pub stick_count: i64,
    /// Elements that slip.
    pub slip_count: i64,
    /// If `friction->sensitivities` is 1, else 0: derivatives of `force` in x, in y and of `moment`, each by the creepages in x and y and by
    /// the spin; `[3][3]`, row by row. Creepages that are found count as given. Of unlike bodies the pressures follow the tractions, but
    /// those of `contact_normal_solve_tangential` are held. 0 after CANCELLED.
    pub sensitivities: [f64; 9],
    /// rms over C of the last change of q; 0 where the iteration ended where it began.
    pub update: f64,
    /// The largest slope by which bounds fall with the slip, memory included, times an element's influence on itself; 0 without a law. From .5 on the
    /// iteration may end as STAGNATED, from 1 on a single element has several solutions.
    pub law_slope: f64,
    /// Room for later versions: 0.
    pub reserved: [f64; 6],
}

/// The estimated errors: a group of `contact_normal_report`. They are estimated after a start from nothing, and after any start if there is a
/// ledger. They are absolute, and < 0 where they are not known.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub struct contact_normal_report_accuracy {
    /// Estimated error of the force (of the approach, when the force is prescribed).
    pub error_force: f64,
    /// Of the largest pressure.
    pub error_max_pressure: f64,
    /// Of the contact area.
    pub error_contact_area: f64,
    /// Of the corrected area.
    pub error_corrected_area: f64,
    /// Of the pressures: rms of the error over that of p.
    pub error_pressure: f64,
    /// Of the tangential force in x and y, or of the creepage where the force is prescribed. They are estimated when `error_force` is, of
    /// shifts from rest, and for bodies that are alike of steady rolling from rest; with a law of friction, or a layer that hardens or softens, of
    /// shifts by creepages only.
    pub error_tangential: [f64; 2],
    /// CONTACT_NORMAL_UNTRUSTED_... bits.
    pub untrusted: i32,
    /// The limit of the accuracy: CONTACT_NORMAL_LIMITED_BY_...
    pub limited_by: i32,
    /// About the seconds of a solve with elements of half the size; < 0: not known.
    pub halved_seconds: f64,
    /// And the error of the force (or the approach) that it would leave.
    pub halved_error_force: f64,
    /// The effects that `options->neglect_below` left out: the sum of `1 << (o - 1)` over CONTACT_NORMAL_OMIT_... o. Since 0.2.
    pub neglected: i64,
    /// By how much that may be wrong: the largest relative change of a quantity, its error included. Since 0.2.
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
    /// Elements that entered or left the contact area in them, in all.
    pub active_set_changes: i64,
    /// Products u = A p on the finest grid.
    pub matrix_products: i64,
    /// Products on all grids, in products on the finest.
    pub work_units: f64,
    /// With friction: products of two components on all grids, in products on the finest.
    pub tangential_products: f64,
    /// Seconds of set-up: 0 for later solves with a handle.
    pub setup_seconds: f64,
    /// Seconds of the solve.
    pub solve_seconds: f64,
    /// Seconds of the tangential problem, which are part of `solve_seconds`.
    pub tangential_seconds: f64,
    /// Bytes held by operators and unknowns.
    pub bytes: i64,
    /// Room for later versions: 0.
    pub reserved: [f64; 8],
}

/// The results of a solve and its cost, in groups. Written only when the status is >= 0. Later versions put new members into the room at the end
/// of a group, and new groups at the end of the report. Members that the library does not know are 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_report {
    /// Set by `contact_normal_report_init`.
    pub struct_size: i64,
    /// Rows of the whole ledger: one per grid, coarsest first. If there is room for fewer, those of the finest grids are written.
    pub ledger_rows: i64,
    /// In: room in `ledger`; default 0.
    pub ledger_capacity: i64,
    /// In: the caller's array, or NULL (default). Its first row is filled by `contact_normal_ledger_row_init`.
    pub ledger: *mut contact_normal_ledger_row,
    /// Warnings, even where the status is OK: CONTACT_NORMAL_WARNING_... bits. `contact_normal_last_error` has them in words.
    pub warnings: i32,
    /// Always 0.
    pub reserved: i32,
    /// The results of the normal problem.
    pub normal: contact_normal_report_normal,
    /// The results of the tangential problem.
    pub tangential: contact_normal_report_tangential,
    /// The estimated errors.
    pub accuracy: contact_normal_report_accuracy,
    /// Its cost.
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
    /// The values of `report`, with the ledger and its capacity from `given`.
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
