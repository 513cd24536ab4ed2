//! `contact_normal_solver`: a handle for many solves on one grid with one pair of bodies.

use std::cell::UnsafeCell;
use std::ptr::null_mut;
use std::sync::atomic::{AtomicBool, Ordering};

use super::arguments::Regions;
use super::dump::{given, recorded, Recording};
use super::fields::contact_normal_fields;
use super::friction::contact_normal_friction;
use super::guard::guard;
use super::influence::contact_normal_influence;
use super::options::contact_normal_options;
use super::outputs::{Buffers, Outputs};
use super::report::contact_normal_report;
use super::scene::contact_normal_scene;
use super::solve::{run, Needs, Request};
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::structs::{self, versioned, Versioned};
use super::watcher::Watcher;
use crate::solver::Solver;

/// A solver handle: the operators, transforms, grids and workspace of a scene, set up once for many solves. One thread at a time may use a handle;
/// different threads may use different handles. While a call uses a handle, any other call with the same handle, from a callback or from another
/// thread, is refused (INVALID_ARGUMENT).
pub struct contact_normal_solver {
    /// Whether a call uses the handle.
    is_in_use: AtomicBool,
    held: UnsafeCell<Held>,
}

/// The contents of a handle.
pub(in crate::ffi) struct Held {
    pub solver: Solver,
    pub buffers: Buffers,
}

impl contact_normal_solver {
    /// Makes a handle for a solver that is set up. `contact_normal_solver_free` frees the handle.
    pub(super) fn holding(solver: Solver) -> *mut contact_normal_solver {
        let held = UnsafeCell::new(Held { solver, buffers: Buffers::default() });
        Box::into_raw(Box::new(contact_normal_solver { is_in_use: AtomicBool::new(false), held }))
    }
}

/// While this value lives, a call uses the handle, and other calls with it are refused.
pub(in crate::ffi) struct InUse<'a> {
    handle: &'a contact_normal_solver,
}

impl InUse<'_> {
    /// Begins to use a handle. `solver` must be a handle that is not freed; NULL is refused.
    pub unsafe fn begin<'a>(solver: *const contact_normal_solver) -> Result<InUse<'a>, Refusal> {
        // SAFETY: NULL or a handle of this library, of which only an atomic and an UnsafeCell change.
        let handle = unsafe { solver.as_ref() }.ok_or_else(|| Refusal::null("solver"))?;
        if handle.is_in_use.swap(true, Ordering::Acquire) {
            return Err(Refusal::invalid(
                "solver is in use by a call that has not returned; a callback (or another thread) must use a handle of its own"
                    .into(),
            ));
        }
        Ok(InUse { handle })
    }

    /// The contents of the handle.
    pub fn held(&mut self) -> &mut Held {
        // SAFETY: because of `is_in_use` a handle has one InUse at most, and this one is borrowed mutably.
        unsafe { &mut *self.handle.held.get() }
    }
}

impl Drop for InUse<'_> {
    fn drop(&mut self) {
        self.handle.is_in_use.store(false, Ordering::Release);
    }
}

/// Sets up a solver for the grid, the bodies, the effects and the influence coefficients of `scene`, and for the cycle, the precision and the
/// threads of `options` (NULL: the defaults). The undeformed distance and the load of `scene` need not be set, because each solve has its own; if
/// they are set, they must be valid. `*solver` is written only if the status is OK. `contact_normal_solver_free` frees the solver. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_new(
    scene: *const contact_normal_scene,
    options: *const contact_normal_options,
    solver: *mut *mut contact_normal_solver,
) -> contact_normal_status {
    let arguments = given![scene, options];
    let set_up = |recording: &mut Recording<'_>| {
        if solver.is_null() {
            return Err(Refusal::null("solver"));
        }
        let mut buffers = Buffers::default();
        // SAFETY: each pointer is NULL or points to a struct that declares its size, by the conventions of the ABI.
        let request = unsafe {
            let also = |regions: &mut Regions, _| regions.output("solver", solver, 1);
            let (arguments, no_outputs) = ((scene, options), (null_mut(), null_mut()));
            Request::read(Needs::Bodies, arguments, no_outputs, &mut buffers, also)
        };
        recording.keep(&buffers.regions);
        let Request { scene, options, .. } = request?;
        let new = Solver::new(&scene, &options.options)?;
        // SAFETY: not null: room for a pointer.
        unsafe { solver.write(contact_normal_solver::holding(new)) };
        Ok(CONTACT_NORMAL_OK)
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_solver_new", options, arguments, set_up) }
}

/// Solves for the undeformed distance, the load, the pressure limit, the friction and the adhesion of `scene`. The grid, the bodies and their
/// branches, the layer, the coatings, the period and the patches must be those of the set-up; the message of a refusal names what differs.
/// `scene->influence` and `scene->row_tables` may be NULL: the solver uses the tables of the set-up. If they are not NULL, each solve compares them
/// with these tables; only `contact_normal_solver_set_influence` changes the coefficients. `fields`, `report` NULL: not wanted.
///
/// With one thread, later solves of the same kind as the first one allocate nothing (docs/conventions.md, "Many solves", has the exceptions). Tables
/// that are compared, friction, adhesion, pressure limits, patches and bodies that relax take some memory for the call. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_solve(
    solver: *mut contact_normal_solver,
    scene: *const contact_normal_scene,
    options: *const contact_normal_options,
    fields: *mut contact_normal_fields,
    report: *mut contact_normal_report,
) -> contact_normal_status {
    let arguments = given![scene, options, fields, report];
    let solve = |recording: &mut Recording<'_>| {
        // SAFETY: NULL or a handle of this library.
        let mut in_use = unsafe { InUse::begin(solver)? };
        let Held { solver, buffers } = in_use.held();
        // SAFETY: as in contact_normal_solver_new.
        let request = unsafe { Request::read(Needs::All, (scene, options), (fields, report), buffers, |_, _| Ok(())) };
        recording.keep_with(&buffers.regions, solver, request.as_ref().is_ok_and(Request::goes_on));
        let Request { scene, options, outputs } = request?;
        run(solver, &scene, &options.options, &Watcher::of(&options), &outputs, buffers)?.conclude()
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_solver_solve", options, arguments, solve) }
}

/// Gives a solver other influence coefficients, with their scale, for all later solves. `influence` has those of the normal problem. `friction` has
/// the tangential ones: `influence` and `influence_cross`, or `row_tables`; its other members are not used. NULL: the coefficients stay as they are;
/// one of both must be given. The solver must have been set up with coefficients of the same kinds: `scene->influence`; `friction->influence` or
/// `row_tables`; with `influence_cross` or without. The plans, the memory and the last result of the solver are kept, so PREVIOUS and `continues`
/// may start from this result. A call that is refused changes nothing, except after OUT_OF_MEMORY: then set both again. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_set_influence(
    solver: *mut contact_normal_solver,
    influence: *const contact_normal_influence,
    friction: *const contact_normal_friction,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a handle of this library.
        let mut in_use = unsafe { InUse::begin(solver)? };
        let Held { solver, .. } = in_use.held();
        // SAFETY (all): NULL or structs that declare their size, with tables of the sizes that they say.
        let (table, friction) = unsafe {
            let grid = solver.grid();
            let table =
                structs::read_optional(influence, "influence")?.map(|table| table.translate(grid)).transpose()?;
            let friction =
                structs::read_optional(friction, "friction")?.map(|given| given.tables_alone()).transpose()?;
            (table, friction)
        };
        if table.is_none() && friction.is_none() {
            return Err(Refusal::null("influence and friction"));
        }
        if let Some(friction) = &friction {
            solver.check_tangential_influence(friction)?;
        }
        if let Some(table) = table {
            solver.set_influence(table)?;
        }
        if let Some(friction) = &friction {
            solver.set_tangential_influence(friction)?;
        }
        Ok(CONTACT_NORMAL_OK)
    })
}

/// Copies the last result of a handle to `fields`. It is the result of `contact_normal_solver_solve`, or the one with which
/// `contact_normal_solve_to_accuracy` made the handle; the grid of the latter has `accuracy->mx` x `accuracy->my` elements. A solve has a result if
/// its status is >= 0. If a solve is refused before it begins or because of its friction, the handle keeps the result before; if it fails later,
/// the handle may have no result. If `contact_normal_solve_tangential` was called with this handle since, tractions, slip and stick area are those
/// of that call. INVALID_ARGUMENT: there is no result. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_fields(
    solver: *const contact_normal_solver,
    fields: *mut contact_normal_fields,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a handle of this library.
        let mut in_use = unsafe { InUse::begin(solver)? };
        let Held { solver, buffers } = in_use.held();
        if fields.is_null() {
            return Err(Refusal::null("fields"));
        }
        // SAFETY: not null: a struct that declares its size.
        let outputs = unsafe { Outputs::of(fields, null_mut())? };
        buffers.regions.clear();
        outputs.add_to(&mut buffers.regions, solver.grid().len())?;
        buffers.regions.check()?;
        if !solver.has_solved() {
            return Err(Refusal::invalid(
                "solver has no result: there was no solve, or the last one found none".into(),
            ));
        }
        outputs.write_fields(solver, false);
        Ok(CONTACT_NORMAL_OK)
    })
}

/// The settings of a solver handle: see `contact_normal_solver_query`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_solver_info {
    /// Set by `contact_normal_solver_info_init`.
    pub struct_size: i64,
    /// Elements in x of the solver's grid.
    pub mx: i32,
    /// Elements in y of the solver's grid.
    pub my: i32,
    /// Element size in x.
    pub dx: f64,
    /// Element size in y.
    pub dy: f64,
    /// The threads with which the solver was set up; 0: all cores.
    pub threads: i32,
    /// 1: the solver has a result, which `contact_normal_solver_fields` copies; 0: the solver has none.
    pub has_result: i32,
    /// The bytes of memory that the solver holds.
    pub bytes: i64,
}

versioned! { contact_normal_solver_info, contact_normal_solver_info_init, 48 }

/// Writes the settings of a solver to `info`: the grid, the threads, the bytes, and whether the solver has a result. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_query(
    solver: *const contact_normal_solver,
    info: *mut contact_normal_solver_info,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a handle of this library.
        let mut in_use = unsafe { InUse::begin(solver)? };
        let Held { solver, .. } = in_use.held();
        let grid = *solver.grid();
        let found = contact_normal_solver_info {
            mx: grid.mx as i32,
            my: grid.my as i32,
            dx: grid.dx,
            dy: grid.dy,
            threads: solver.threads() as i32,
            has_result: i32::from(solver.has_solved()),
            bytes: solver.bytes() as i64,
            ..contact_normal_solver_info::defaults()
        };
        if info.is_null() {
            return Err(Refusal::null("info"));
        }
        // SAFETY: not NULL: a struct that declares its size.
        unsafe { structs::write(info, &found)? };
        Ok(CONTACT_NORMAL_OK)
    })
}

/// Frees a solver. INVALID_ARGUMENT: a call uses the solver, so it is not freed; free it after that call. NULL is ignored. The library keeps some of
/// the freed memory for later solvers: see `contact_normal_release`. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_free(solver: *mut contact_normal_solver) -> contact_normal_status {
    guard(|| {
        if solver.is_null() {
            return Ok(CONTACT_NORMAL_OK);
        }
        // SAFETY: not null, so a handle of this library. `forget` leaves it in use, so that no other call can begin to use it.
        std::mem::forget(unsafe { InUse::begin(solver)? });
        // SAFETY: made by `holding`; no other call uses it now or later.
        drop(unsafe { Box::from_raw(solver) });
        Ok(CONTACT_NORMAL_OK)
    })
}
