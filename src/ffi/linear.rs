//! Products by a solver handle, and the stiffness of its last result.

use super::arguments::{required, Regions};
use super::conclusion::Conclusion;
use super::guard::guard;
use super::solver::{contact_normal_solver, Held, InUse};
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::watcher::why;
use crate::memory::zeros;

/// The displacements u = A p of pressures of the caller's, of any sign: `pressure` and `displacement` are `[my][mx]` of the handle's grid, and A
/// has all effects of the set-up that it depends on: own coefficients, coatings, periods, patches, the layer. The last result of the handle
/// stays. NOT_FINITE: a pressure is not. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_product(
    solver: *mut contact_normal_solver,
    pressure: *const f64,
    displacement: *mut f64,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a handle of ours.
        let mut in_use = unsafe { InUse::begin(solver)? };
        let Held { solver, buffers } = in_use.held();
        let n = solver.grid().len();
        if displacement.is_null() {
            return Err(Refusal::null("displacement"));
        }
        buffers.regions.clear();
        buffers.regions.input("pressure", pressure, n)?;
        buffers.regions.output("displacement", displacement, n)?;
        buffers.regions.check()?;
        // SAFETY: NULL or one value per element, by the conventions of the ABI.
        let pressure = unsafe { required("pressure", pressure, n)? };
        // A refused call writes nothing.
        let mut found = zeros(n, "displacements")?;
        solver.product(pressure, &mut found)?;
        // SAFETY: not NULL: room for one value per element.
        unsafe { std::ptr::copy_nonoverlapping(found.as_ptr(), displacement, n) };
        Ok(CONTACT_NORMAL_OK)
    })
}

/// Writes the `stiffness` dF/d approach of the last result of a handle: a force per length, by how much the force grows with the approach while
/// the contact area, pressures at their limit and tractions stay as they are. `A s = 1` is solved on the contact area, and the stiffness is the sum of
/// `s dx dy`; 0 without contact. `residual` (NULL: not wanted) is that of these equations, relative, in the 2-norm over the contact area: the
/// relative error of the stiffness is about that. OK: it is at most 1e-6, mostly 1e-10; ITERATION_LIMIT, STAGNATED: both are written, and it is
/// larger. INFEASIBLE: full contact with two periods. INVALID_ARGUMENT: the handle has no result. As a function of the approach the
/// force has this derivative also where the contact area changes, but for jumps by single elements that enter or leave. The first call sets up memory of about the size
/// of the handle. After `contact_normal_solver_set_influence` it is that of the new coefficients. UNSUPPORTED: the last result is one of adhesion,
/// whose report has it. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_stiffness(
    solver: *mut contact_normal_solver,
    stiffness: *mut f64,
    residual: *mut f64,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a handle of ours.
        let mut in_use = unsafe { InUse::begin(solver)? };
        let Held { solver, .. } = in_use.held();
        if stiffness.is_null() {
            return Err(Refusal::null("stiffness"));
        }
        let mut regions = Regions::default();
        regions.output("stiffness", stiffness, 1)?;
        regions.output("residual", residual, 1)?;
        regions.check()?;
        let (stop, found) = solver.stiffness()?;
        // SAFETY (all): NULL or room for a value.
        unsafe {
            stiffness.write(found.value);
            if !residual.is_null() {
                residual.write(found.residual);
            }
        }
        Conclusion::of(stop, || format!("{}; the residual of the stiffness is {:e}", why(stop), found.residual))
            .conclude()
    })
}
