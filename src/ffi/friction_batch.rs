//! `contact_normal_friction_batch`: tables of tangential forces.

use std::ptr::null_mut;
use std::sync::{Mutex, PoisonError};

use super::arguments::{not_negative, optional, required, Regions};
use super::batch::NotOk;
use super::guard::guard;
use super::options::contact_normal_options;
use super::outputs::Buffers;
use super::report::contact_normal_report;
use super::scene::{contact_normal_scene, Named};
use super::solve::{explain, Conclusion, Request};
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::structs::{self, versioned};
use super::watcher::{watched, why, Watcher};
use crate::friction::{Report, Solution};
use crate::memory::collected;
use crate::solver::{solve_friction_batch, Ended, Entry, Outcome};

/// Where the results of n entries are written; NULL (the default of each): not wanted.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_friction_results {
    /// Set by `contact_normal_friction_results_init`.
    pub struct_size: i64,
    /// The sums of q dx dy in x and y, on body 1, `[n][2]`.
    pub force: *mut f64,
    /// The sums of (x qy - y qx) dx dy about the centre of spin, `[n]`.
    pub moment: *mut f64,
    /// Creepages in x and y, given or found, `[n][2]`.
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
    /// Tractions, `[n][2][my][mx]`: those in x and then those in y of each entry.
    pub traction: *mut f64,
    /// Slip, `[n][2][my][mx]`.
    pub slip: *mut f64,
    /// CONTACT_NORMAL_STICK_SLIP_... of each element, `[n][my][mx]`.
    pub stick_slip: *mut i32,
}

versioned! { contact_normal_friction_results, contact_normal_friction_results_init, 104 }

/// Solves n tangential problems of one scene: a table of creep forces. `entries` is `[n][3]`: of each entry what is prescribed in x and in y
/// (the creepage or, where `scene->friction->prescribed` says so, the force) and the spin; those of `scene->friction` itself are not
/// used. `pressure` `[my][mx]`: as for `contact_normal_solve_tangential`; NULL: the normal problem of the scene is solved first, once. Of
/// unlike bodies the tractions do not change the pressures.
///
/// As many entries are solved at a time as `options->threads` says. Neighbours in the table should be neighbours in the motion: 16 in a row
/// are solved one after the other, each from the tractions of the one before if it differs little, and all meet the tolerance. Results have
/// the same bits for any number of threads.
///
/// An entry that is refused does not keep the others from being solved: its results stay as they are, and `results->status` holds its
/// status. The call returns OK if the normal problem and all entries have that status, or else that of the first entry that was refused
/// (< 0), or else that of the normal problem or of the first entry that stopped early (> 0). `contact_normal_last_error` then has a line
/// "entry 3: ..." for each of them, counted from 0: 1000 lines at most. `report` (NULL: not wanted) is that of the normal problem.
///
/// `progress` is called on the calling thread: after the cycles of the normal problem, and then about once for each entry; `cycles` counts
/// the entries that are done and `residual` is that of the last one. When it cancels, the results of entries that are not done stay as
/// they are, with the status CANCELLED. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_friction_batch(
    scene: *const contact_normal_scene,
    pressure: *const f64,
    options: *const contact_normal_options,
    n: i32,
    entries: *const f64,
    results: *mut contact_normal_friction_results,
    report: *mut contact_normal_report,
) -> contact_normal_status {
    guard(|| {
        let n = not_negative("n", n)?;
        // SAFETY: NULL or a struct that declares its size, by the conventions of the ABI.
        let wanted = unsafe { structs::read(results.cast_const(), "results")? };
        // SAFETY: likewise.
        let Request { scene: read, options, outputs } = unsafe {
            let also = |regions: &mut Regions, elements: usize| {
                regions.input("pressure", pressure, elements)?;
                regions.input("entries", entries.cast::<[f64; 3]>(), n)?;
                wanted.add_to(regions, results, (n, elements))
            };
            let named = Named::read(scene)?;
            let named = if pressure.is_null() { named } else { named.load_or_none() };
            Request::of((named, scene), options, null_mut(), report, &mut Buffers::default(), also)?
        };
        // SAFETY (both): NULL or arrays of this size, by the conventions of the ABI.
        let (pressure, given) = unsafe {
            let given = if n == 0 { &[][..] } else { required("entries", entries.cast::<[f64; 3]>(), n)? };
            (optional(pressure, read.grid.len()), given)
        };
        let entry = |&[x, y, spin]: &[f64; 3]| Entry { amount: [x, y], spin };
        let table = collected(given.iter().map(entry), "the entries of a table")?;
        let concluded = watched(Watcher::of(&options), |progress| {
            let not_ok = Mutex::new(NotOk::default());
            let found = |i: usize, ended: Ended, solution: Option<&Solution>| {
                // SAFETY: each entry is solved by one thread; the caller's arrays were checked.
                let outcome = unsafe { wanted.write(i, ended, solution) };
                not_ok.lock().unwrap_or_else(PoisonError::into_inner).note(i, outcome);
            };
            let (stop, normal) = solve_friction_batch(&read, pressure, &table, &options.options, progress, found)?;
            outputs.write_report(&normal, &[], 0)?;
            let entries = not_ok.into_inner().unwrap_or_else(PoisonError::into_inner).outcome("entry");
            if entries.status != CONTACT_NORMAL_OK || stop == Outcome::Converged {
                return Ok(entries);
            }
            let message = || format!("the normal problem: {}", explain(stop, &normal, options.options.method, None));
            Ok(Conclusion::of(stop, message))
        });
        concluded?.conclude()
    })
}

// SAFETY: the pointers are the caller's, who leaves what they point to alone during the call; what is written for one entry no other
// one writes.
unsafe impl Sync for contact_normal_friction_results {}

impl contact_normal_friction_results {
    /// Adds what is written of n entries on so many elements, and the struct that says where.
    fn add_to(
        &self,
        regions: &mut Regions,
        at: *const contact_normal_friction_results,
        (n, elements): (usize, usize),
    ) -> Result<(), Refusal> {
        let fields = n.saturating_mul(elements);
        regions.input_struct(at, self)?;
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
        regions.output("stick_slip", self.stick_slip, fields)
    }

    /// Writes how entry i ended, and what was found of it.
    unsafe fn write(&self, i: usize, ended: Ended, solution: Option<&Solution>) -> Conclusion {
        let outcome = match &ended {
            Ok((stop, report)) => Conclusion::of(*stop, || said(*stop, report)),
            Err(error) => Refusal::from(error.clone()).into(),
        };
        // SAFETY (all): by the caller: NULL or room for all entries.
        unsafe {
            put(self.status, i, outcome.status);
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
                }
            }
        }
        outcome
    }
}

/// Writes a value where it is wanted.
unsafe fn put<T>(to: *mut T, i: usize, value: T) {
    if !to.is_null() {
        // SAFETY: not null: room for it, by the caller.
        unsafe { to.add(i).write_unaligned(value) };
    }
}

/// Why an entry is not OK.
fn said(stop: Outcome, found: &Report) -> String {
    match stop {
        Outcome::Cancelled => why(stop).into(),
        _ => format!("{}; the residual is {:e}", why(stop), found.certificate.residual),
    }
}
