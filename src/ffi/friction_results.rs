//! `contact_normal_friction_results`: the caller's arrays for the results of tangential problems.

use super::arguments::Regions;
use super::conclusion::Conclusion;
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_CANCELLED, CONTACT_NORMAL_ITERATION_LIMIT};
use super::structs::versioned;
use super::warnings::advice_on_law;
use super::watcher::why;
use crate::friction::{Report, Solution};
use crate::solver::{Ended, Outcome};

/// The caller's arrays for the results of n entries. NULL (the default of each): not wanted.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_friction_results {
    /// Set by `contact_normal_friction_results_init`.
    pub struct_size: i64,
    /// The forces on body 1 in x and in y, the sums of q dx dy, `[n][2]`.
    pub force: *mut f64,
    /// The moments about the centre of spin, the sums of (x qy - y qx) dx dy, `[n]`.
    pub moment: *mut f64,
    /// The creepages in x and in y, prescribed or computed, `[n][2]`.
    pub creepage: *mut f64,
    /// As `tangential.residual` of the report, `[n]`.
    pub residual: *mut f64,
    /// As `tangential.gap` of the report, `[n]`.
    pub gap: *mut f64,
    /// As `tangential_products` of the report, `[n]`.
    pub products: *mut f64,
    /// Elements that stick, `[n]`.
    pub stick_count: *mut i64,
    /// Elements that slip, `[n]`.
    pub slip_count: *mut i64,
    /// The status of each entry, `[n]`.
    pub status: *mut contact_normal_status,
    /// The tractions, `[n][2][my][mx]`: for each entry those in x, then those in y.
    pub traction: *mut f64,
    /// The slip, `[n][2][my][mx]`: for each entry that in x, then that in y.
    pub slip: *mut f64,
    /// CONTACT_NORMAL_STICK_SLIP_... of each element, `[n][my][mx]`.
    pub stick_slip: *mut i32,
    /// As `fields->friction_coefficient`, `[n][my][mx]`.
    pub friction_coefficient: *mut f64,
    /// As `fields->yield_limit`, `[n][my][mx]`.
    pub yield_limit: *mut f64,
}

versioned! { contact_normal_friction_results, contact_normal_friction_results_init, 104 }

// SAFETY: the caller does not touch the memory of the pointers during the call, and each entry has its own part of this memory.
unsafe impl Sync for contact_normal_friction_results {}

impl contact_normal_friction_results {
    /// Adds the struct at `address`, and the arrays for n entries on a grid of `elements` elements, to the regions.
    pub(super) fn add_to(
        &self,
        regions: &mut Regions,
        address: *const contact_normal_friction_results,
        (n, elements): (usize, usize),
    ) -> Result<(), Refusal> {
        let fields = n.saturating_mul(elements);
        regions.input_struct(address, self)?;
        regions.output("force", self.force, n.saturating_mul(2))?;
        regions.output("moment", self.moment, n)?;
        regions.output("creepage", self.creepage, n.saturating_mul(2))?;
        regions.output("residual", self.residual, n)?;
        regions.output("gap", self.gap, n)?;
        regions.output("products", self.products, n)?;
        regions.output("stick_count", self.stick_count, n)?;
        regions.output("slip_count", self.slip_count, n)?;
        regions.output("status", self.status, n)?;
        regions.output("traction", self.traction, fields.saturating_mul(2))?;
        regions.output("slip", self.slip, fields.saturating_mul(2))?;
        regions.output("stick_slip", self.stick_slip, fields)?;
        regions.output("friction_coefficient", self.friction_coefficient, fields)?;
        regions.output("yield_limit", self.yield_limit, fields)
    }

    /// Writes the status and the results of entry i. Returns its conclusion.
    pub(super) unsafe fn write(&self, i: usize, ended: Ended, solution: Option<&Solution>) -> Conclusion {
        let conclusion = match &ended {
            Ok((outcome, report)) => Conclusion::of(*outcome, || message(*outcome, report)),
            Err(error) => Refusal::from(error.clone()).into(),
        };
        // SAFETY (all): by the caller: NULL or room for all entries.
        unsafe {
            put(self.status, i, conclusion.status);
            if let (Ok((_, report)), Some(solution)) = (&ended, solution) {
                put(self.force.cast::<[f64; 2]>(), i, report.force);
                put(self.moment, i, report.moment);
                put(self.creepage.cast::<[f64; 2]>(), i, report.creepage);
                put(self.residual, i, report.certificate.residual);
                put(self.gap, i, report.certificate.gap);
                put(self.products, i, report.products);
                put(self.stick_count, i, report.certificate.stick_count as i64);
                put(self.slip_count, i, report.certificate.slip_count as i64);
                let elements = solution.stick_slip.len();
                for (field, to) in [(&solution.traction, self.traction), (&solution.slip, self.slip)] {
                    for (element, v) in field.iter().enumerate().filter(|_| !to.is_null()) {
                        put(to, 2 * i * elements + element, v[0]);
                        put(to, (2 * i + 1) * elements + element, v[1]);
                    }
                }
                for (element, stick_slip) in solution.stick_slip.iter().enumerate() {
                    put(self.stick_slip, i * elements + element, *stick_slip);
                    let particle = solution.particles.get(element).copied().unwrap_or_default();
                    put(self.friction_coefficient, i * elements + element, particle.coefficient);
                    put(self.yield_limit, i * elements + element, particle.yield_limit);
                }
            }
        }
        conclusion
    }

    /// Called after a call that `max_seconds` ended: gives the cancelled ones of n entries the status ITERATION_LIMIT.
    pub(super) unsafe fn late(&self, n: usize) {
        for i in (0..n).filter(|_| !self.status.is_null()) {
            // SAFETY: not null: room for all entries, each with its status, by the caller.
            unsafe {
                if self.status.add(i).read_unaligned() == CONTACT_NORMAL_CANCELLED {
                    put(self.status, i, CONTACT_NORMAL_ITERATION_LIMIT);
                }
            }
        }
    }
}

/// Writes value i of an output; NULL: not wanted.
unsafe fn put<T>(to: *mut T, i: usize, value: T) {
    if !to.is_null() {
        // SAFETY: not null, so there is room for value i, by the caller.
        unsafe { to.add(i).write_unaligned(value) };
    }
}

/// The message of an entry that did not converge.
fn message(outcome: Outcome, report: &Report) -> String {
    match outcome {
        Outcome::Cancelled => why(outcome).into(),
        _ => {
            let (residual, advice) = (report.certificate.residual, advice_on_law(report.law_slope));
            format!("{}; the residual is {residual:e}{advice}", why(outcome))
        }
    }
}
