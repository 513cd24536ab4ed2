//! Products u = A p by a solver handle, and the stiffness of the handle's last result.

use super::arguments::{required, Regions};
use super::conclusion::Conclusion;
use super::guard::guard;
use super::solver::{contact_normal_solver, Held, InUse};
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::watcher::why;
use crate::memory::zeros;

/// Computes the displacements u = A p of given pressures of any sign. `pressure` and `displacement` are `[my][mx]` on the handle's grid. A includes
/// the effects of the set-up that change it: influence coefficients of your own, coatings, periods, patches, the layer. The last result of the
/// handle is kept. NOT_FINITE: a pressure is not finite. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_product(
    solver: *mut contact_normal_solver,
    pressure: *const f64,
    displacement: *mut f64,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a handle of this library.
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
        // The product goes to memory of its own, because a refused call writes nothing.
        let mut product = zeros(n, "displacements")?;
        solver.product(pressure, &mut product)?;
        // SAFETY: not NULL: room for one value per element.
        unsafe { std::ptr::copy_nonoverlapping(product.as_ptr(), displacement, n) };
        Ok(CONTACT_NORMAL_OK)
    })
}

/// Computes the `stiffness` dF/dapproach of the last result of a handle, a force per length: the growth of the force with the approach while the
/// contact area, pressures at their limit and tractions stay constant. It solves `A s = 1` on the contact area; the stiffness is the sum of
/// `s dx dy`, or 0 without contact. `residual` (NULL: not wanted) receives the relative residual of these equations, in the 2-norm over the contact
/// area. The relative error of the stiffness is about this residual.
///
/// OK: the residual is at most 1e-6, mostly 1e-10. ITERATION_LIMIT, STAGNATED: the residual is larger; both values are written. INFEASIBLE: full
/// contact with two periods. INVALID_ARGUMENT: the handle has no result. UNSUPPORTED: the last result has adhesion; its report has the stiffness.
///
/// The force has this derivative by the approach also where the contact area changes, except for jumps when single elements enter or leave. After
/// `contact_normal_solver_set_influence` the stiffness is that of the new coefficients. The first call sets up memory of about the size of the
/// handle. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_stiffness(
    solver: *mut contact_normal_solver,
    stiffness: *mut f64,
    residual: *mut f64,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a handle of this library.
        let mut in_use = unsafe { InUse::begin(solver)? };
        let Held { solver, .. } = in_use.held();
        if stiffness.is_null() {
            return Err(Refusal::null("stiffness"));
        }
        let mut regions = Regions::default();
        regions.output("stiffness", stiffness, 1)?;
        regions.output("residual", residual, 1)?;
        regions.check()?;
        let (outcome, found) = solver.stiffness()?;
        // SAFETY (all): NULL or room for a value.
        unsafe {
            stiffness.write(found.value);
            if !residual.is_null() {
                residual.write(found.residual);
            }
        }
        Conclusion::of(outcome, || format!("{}; the residual of the stiffness is {:e}", why(outcome), found.residual))
            .conclude()
    })
}
