//! `contact_normal_solver`: a handle for many solves on one grid and one pair of bodies.

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

/// Operators, transforms, grids and workspace, built once. One thread at a time may use a handle; different handles may be
/// used by different threads. While a call uses a handle, any other call with it, from a callback or from another thread, is refused
/// (INVALID_ARGUMENT).
pub struct contact_normal_solver {
    is_in_use: AtomicBool,
    held: UnsafeCell<Held>,
}

/// The contents of a handle.
pub(in crate::ffi) struct Held {
    pub solver: Solver,
    pub buffers: Buffers,
}

impl contact_normal_solver {
    /// A handle for a solver that is set up; `contact_normal_solver_free` frees it.
    pub(super) fn holding(solver: Solver) -> *mut contact_normal_solver {
        let held = UnsafeCell::new(Held { solver, buffers: Buffers::default() });
        Box::into_raw(Box::new(contact_normal_solver { is_in_use: AtomicBool::new(false), held }))
    }
}

/// A handle that a call uses, until it is dropped.
pub(in crate::ffi) struct InUse<'a> {
    handle: &'a contact_normal_solver,
}

impl InUse<'_> {
    /// `solver`: NULL or a handle that was not freed.
    pub unsafe fn begin<'a>(solver: *const contact_normal_solver) -> Result<InUse<'a>, Refusal> {
        // SAFETY: NULL or a handle of ours; what changes in it is behind an atomic or an UnsafeCell.
        let handle = unsafe { solver.as_ref() }.ok_or_else(|| Refusal::null("solver"))?;
        if handle.is_in_use.swap(true, Ordering::Acquire) {
            return Err(Refusal::invalid(
                "solver is in use by a call that has not returned; a callback (or another thread) must use a handle of its own"
                    .into(),
            ));
        }
        Ok(InUse { handle })
    }

    pub fn held(&mut self) -> &mut Held {
        // SAFETY: `is_in_use` lets one InUse of a handle exist, and this one is borrowed mutably.
        unsafe { &mut *self.handle.held.get() }
    }
}

impl Drop for InUse<'_> {
    fn drop(&mut self) {
        self.handle.is_in_use.store(false, Ordering::Release);
    }
}

/// Sets up a solver for the grid, the bodies, the effects and the influence coefficients of `scene`, and for the cycle,
/// precision and threads of `options` (NULL: the defaults). Each solve takes an undeformed distance and a load of its own: they need not be
/// set, and what is set must be valid. `*solver` is written only when the status is OK; free it with `contact_normal_solver_free`.
/// Since 0.1.
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

/// Solves for the undeformed distance, the load and the pressure limit of `scene`. Grid, bodies and their branches, layer, coatings, period
/// and patches must be those of the set-up; what differs is refused by name. `scene->influence` and `scene->row_tables` may be NULL: those of the solver. If they
/// are not NULL, each solve reads and compares them. Other coefficients need `contact_normal_solver_set_influence`. `fields`, `report`
/// NULL: not wanted. After a first solve, further ones of the same kind allocate nothing, with one thread, without coefficients to compare,
/// and without friction, adhesion, pressure limits, patches and bodies that relax, which take some memory for the call (docs/conventions.md,
/// "Many solves"). Since 0.1.
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
        // SAFETY: NULL or a handle of ours.
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

/// Gives a solver other coefficients, and their scale, for all later solves. `influence`: those of the normal problem; `friction`: its
/// `influence` and `influence_cross`, or its `row_tables`; nothing else of it is used. NULL: the old ones stay; one of the two must be given.
/// The solver must have been set up with coefficients of the same kinds: `scene->influence`; `friction->influence` or `row_tables`, and
/// `influence_cross` or none. Its plans and its memory are kept, and so is its last result, from which PREVIOUS and `continues` may start.
/// A call that is refused changes nothing; after OUT_OF_MEMORY set both again. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_set_influence(
    solver: *mut contact_normal_solver,
    influence: *const contact_normal_influence,
    friction: *const contact_normal_friction,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a handle of ours.
        let mut in_use = unsafe { InUse::begin(solver)? };
        let Held { solver, .. } = in_use.held();
        // SAFETY (all): NULL or structs that declare their size, with tables of the sizes that they say.
        let (table, friction) = unsafe {
            let grid = solver.grid();
            let table = structs::read_optional(influence, "influence")?.map(|of| of.translate(grid)).transpose()?;
            let friction = structs::read_optional(friction, "friction")?.map(|of| of.tables_alone()).transpose()?;
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

/// Copies the last result of a handle: of `contact_normal_solver_solve`, or the one that `contact_normal_solve_to_accuracy` made it
/// with, whose grid has `accuracy->mx` x `accuracy->my` elements. A solve has a result when its status is >= 0; one that was refused
/// leaves the result before as it is, or none if it failed on the way. One that was refused for its friction always leaves it. Tractions, slip
/// and stick area are those that `contact_normal_solve_tangential` found with this handle since, if it did.
/// INVALID_ARGUMENT if there is none. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_fields(
    solver: *const contact_normal_solver,
    fields: *mut contact_normal_fields,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a handle of ours.
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

/// The settings of a solver: see `contact_normal_solver_query`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_solver_info {
    /// Set by `contact_normal_solver_info_init`.
    pub struct_size: i64,
    /// Elements in x of its grid.
    pub mx: i32,
    /// Elements in y.
    pub my: i32,
    /// Element size in x.
    pub dx: f64,
    /// Element size in y.
    pub dy: f64,
    /// Threads that it was set up with; 0: all cores.
    pub threads: i32,
    /// 1: it holds a result, for `contact_normal_solver_fields`; 0: it does not.
    pub has_result: i32,
    /// Bytes that it holds.
    pub bytes: i64,
}

versioned! { contact_normal_solver_info, contact_normal_solver_info_init, 48 }

/// Writes the settings of a solver: its grid, its threads, its bytes, and whether it has a result. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_query(
    solver: *const contact_normal_solver,
    info: *mut contact_normal_solver_info,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a handle of ours.
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

/// Frees a solver. INVALID_ARGUMENT: a call uses it, and nothing was freed: free it after that call. NULL is ignored. The library keeps
/// memory of what is freed for later solvers: see `contact_normal_release`. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solver_free(solver: *mut contact_normal_solver) -> contact_normal_status {
    guard(|| {
        if solver.is_null() {
            return Ok(CONTACT_NORMAL_OK);
        }
        // SAFETY: not null: a handle of ours. It stays in use, so that nothing else begins with it.
        std::mem::forget(unsafe { InUse::begin(solver)? });
        // SAFETY: made by `holding`, in no other use, and not used after this.
        drop(unsafe { Box::from_raw(solver) });
        Ok(CONTACT_NORMAL_OK)
    })
}
