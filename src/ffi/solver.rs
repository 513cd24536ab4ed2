//! `contact_normal_solver`: a handle for many solves on one grid and one pair of bodies.

use super::guard::guard;
use super::options::{self, contact_normal_options};
use super::report::{contact_normal_fields, contact_normal_report};
use super::scene::{self, contact_normal_scene, Known};
use super::solve::{run_watched, GuessBuffer, Outputs};
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use crate::scene::Scene;
use crate::solver::Solver;

/// Operators, transforms, grids and workspace, built once. One thread at a time may use a handle; different handles may be
/// used by different threads.
pub struct contact_normal_solver {
    pub(super) solver: Solver,
    guess: GuessBuffer,
}

impl contact_normal_solver {
    /// A handle for a solver that is set up; `contact_normal_solver_free` frees it.
    pub(super) fn holding(solver: Solver) -> *mut contact_normal_solver {
        Box::into_raw(Box::new(contact_normal_solver { solver, guess: GuessBuffer::default() }))
    }
}

/// Sets up a solver for the grid, the bodies and the influence coefficients of `scene`, whose undeformed distance and load do not
/// matter yet but must be valid, with the smoother, sweeps, relaxation, coarsest and threads of `options` (NULL: the defaults).
/// `*solver` is written only when the status is OK; free it with `contact_normal_solver_free`. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_new(
    scene: *const contact_normal_scene,
    options: *const contact_normal_options,
    solver: *mut *mut contact_normal_solver,
) -> contact_normal_status {
    guard(|| {
        if solver.is_null() {
            return Err(Refusal::null("solver"));
        }
        // SAFETY: each pointer is NULL or points to a struct that declares its size, by the conventions of the ABI.
        let (scene, options) = unsafe { (scene::translate(scene)?, options::translate(options)?) };
        let new = Solver::new(&scene, &options.options)?;
        // SAFETY: not null: room for a pointer.
        unsafe { solver.write(contact_normal_solver::holding(new)) };
        Ok(CONTACT_NORMAL_OK)
    })
}

/// Solves for the undeformed distance and the load of `scene`. Its grid and bodies must be those that the solver was set up
/// for; `scene->influence` must be NULL for a solver of the half-space, and is not read again otherwise. So are the period and
/// whether there are a layer and patches, whose values are those of the set-up; the pressure limit is the scene's. After a first solve,
/// further ones of the same kind allocate nothing, with one thread (README, "Many solves"). Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_solve(
    solver: *mut contact_normal_solver,
    scene: *const contact_normal_scene,
    options: *const contact_normal_options,
    fields: *mut contact_normal_fields,
    report: *mut contact_normal_report,
) -> contact_normal_status {
    guard(|| {
        if solver.is_null() {
            return Err(Refusal::null("solver"));
        }
        // SAFETY: not null: made by contact_normal_solver_new and used by one thread at a time.
        let contact_normal_solver { solver, guess } = unsafe { &mut *solver };
        // SAFETY: as in contact_normal_solver_new.
        let (scene, options, outputs) =
            unsafe { (scene_for(solver, scene)?, options::translate(options)?, Outputs::of(fields, report)?) };
        run_watched(solver, &scene, &options, &outputs, guess)
    })
}

/// Translates a scene for a solver that is set up.
pub(super) unsafe fn scene_for<'a>(solver: &Solver, scene: *const contact_normal_scene) -> Result<Scene<'a>, Refusal> {
    let known = Known { influence: solver.has_own_influence(), row_tables: solver.has_row_tables(), distance: false };
    // SAFETY: by the caller.
    let scene = unsafe { scene::translate_for(scene, known)? };
    if !known.influence && !known.row_tables {
        scene.check()?;
    }
    Ok(scene)
}

/// Frees a solver; NULL is ignored. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_free(solver: *mut contact_normal_solver) {
    guard(|| {
        if !solver.is_null() {
            // SAFETY: made by contact_normal_solver_new, and not used after this.
            drop(unsafe { Box::from_raw(solver) });
        }
        Ok(CONTACT_NORMAL_OK)
    });
}
