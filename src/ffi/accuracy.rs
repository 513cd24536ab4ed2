//! `contact_normal_solve_to_accuracy`: the caller gives an accuracy, and the library chooses the grid.

use libc::c_void;

use super::arguments::Regions;
use super::conclusion::Conclusion;
use super::dump::{given, recorded, Recording};
use super::floating_point::in_host_environment;
use super::options::{self, contact_normal_options};
use super::outputs::Outputs;
use super::report::contact_normal_report;
use super::scene::{contact_normal_scene, Named};
use super::solver::contact_normal_solver;
use super::status::{contact_normal_status, Refusal};
use super::structs::{self, versioned};
use super::watcher::Watcher;
use crate::grid::Grid;
use crate::scene::Scene;
use crate::solver::{solve_to_accuracy, Accuracy, Options, Refinement, Solver, SurfaceCallback};

/// A callback that writes the undeformed distance on an mx x my grid of dx x dy elements over the rectangle of the scene. It must write all values of
/// `undeformed_distance`, `[my][mx]`, x fastest. If it returns non-zero, the call is cancelled. It is called on the calling thread, in the
/// floating-point environment of that thread.
pub type contact_normal_surface_callback = Option<
    unsafe extern "C" fn(mx: i32, my: i32, dx: f64, dy: f64, undeformed_distance: *mut f64, user: *mut c_void) -> i32,
>;

/// The wanted accuracy, the limits on its cost, and (out) the grid that was used.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_accuracy {
    /// Set by `contact_normal_accuracy_init`.
    pub struct_size: i64,
    /// The largest estimated relative error of the force (or of the approach, if the force is prescribed), between 0 and 1; default 1e-3.
    pub target: f64,
    /// The largest number of seconds for all grids together; 0 (default): no limit. The first grid is solved whatever `max_seconds`, `max_bytes` and
    /// `max_elements` are.
    pub max_seconds: f64,
    /// The largest number of bytes that the solvers of two successive grids hold together; 0 (default): no limit.
    pub max_bytes: i64,
    /// The largest number of elements of a grid; 0 (default): 4096 x 4096.
    pub max_elements: i64,
    /// The callback that writes the undeformed distance on each grid. NULL (default): the undeformed distance of the scene is interpolated by cubics
    /// between the centres of elements; their slopes are continuous except beside holes and rough ends.
    pub surface: contact_normal_surface_callback,
    /// Passed to `surface`; default NULL.
    pub user: *mut c_void,
    /// Out: elements in x of the grid that was used; 0: the call was cancelled before a grid was solved.
    pub mx: i32,
    /// Out: elements in y of that grid.
    pub my: i32,
    /// Out: element size in x of that grid.
    pub dx: f64,
    /// Out: element size in y of that grid.
    pub dy: f64,
    /// Out: the estimated relative error on that grid; < 0: not known.
    pub reached: f64,
    /// Out: seconds for all grids together.
    pub seconds: f64,
    /// The largest estimated relative error of the largest pressure, below 1; 0 (default): no target.
    pub max_pressure_target: f64,
    /// The largest estimated relative error of the corrected contact area, below 1; 0 (default): no target.
    pub contact_area_target: f64,
    /// As `contact_area_target`, for the mean gap. Errors of the mean gap and of all quantities below are estimated from grids with fewer elements,
    /// which are solved as well. Since 0.2.
    pub mean_gap_target: f64,
    /// The target for the stiffness dF/dapproach.
    pub stiffness_target: f64,
    /// The target for the magnitude of the tangential force.
    pub tangential_force_target: f64,
    /// The target for the magnitude of the computed creepage.
    pub creepage_target: f64,
    /// The target for the moment about the spin centre.
    pub spin_moment_target: f64,
    /// The target for the stick area.
    pub stick_area_target: f64,
    /// The target for the largest von Mises stress.
    pub max_von_mises_target: f64,
    /// The target for the depth of the largest von Mises stress.
    pub von_mises_depth_target: f64,
    /// The target for the largest shear stress.
    pub max_shear_target: f64,
}

versioned! { contact_normal_accuracy, contact_normal_accuracy_init, 112, target: 1e-3, reached: -1.0 }

/// Solves on the grid of `scene`, then on finer grids over the same rectangle, until the targets are met: `report->accuracy.error_force` is at most
/// `accuracy->target` times the force (or the approach, if the force is prescribed), and the errors of the other quantities are at most
/// their targets. Besides, the contact must have enough elements across in both directions: 6 for forces, 12 for the largest pressure, 32 for areas,
/// and 10 for the others.
///
/// With `accuracy->surface` the scene's undeformed distance is not read and may be NULL. The tolerance is that of `options` or, if that is less, a
/// tenth of the targets, and a hundredth of the targets for the largest pressure and for stresses. For a quantity other than force, largest pressure
/// and area, up to two grids with fewer elements are solved first. Arrays of one value per element (compliances, limits, coefficients of friction,
/// weights, previous tractions) are averaged over the elements of other grids.
///
/// OK: the targets are met. ITERATION_LIMIT: a limit of time, memory or elements forbids the next grid. CANCELLED: the surface or the
/// progress callback cancelled the call. STAGNATED: a target is below round-off, or no estimate can be trusted (a singular largest pressure has
/// none). After these three statuses `contact_normal_last_error` has the best error reached, and report and handle have the result with this error.
/// UNSUPPORTED: influence coefficients of your own, FIXED contact, and stresses of coated bodies.
///
/// `*solver` (`solver` NULL: not wanted) is a handle with the result, which `contact_normal_solver_fields` copies and `contact_normal_solver_free`
/// frees; it is NULL if the call was cancelled before a grid was solved. `contact_normal_cost_of_accuracy` predicts the cost. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solve_to_accuracy(
    scene: *const contact_normal_scene,
    options: *const contact_normal_options,
    accuracy: *mut contact_normal_accuracy,
    solver: *mut *mut contact_normal_solver,
    report: *mut contact_normal_report,
) -> contact_normal_status {
    let arguments = given![scene, options, accuracy, report];
    let solve = |recording: &mut Recording<'_>| {
        // SAFETY: each pointer is NULL or points to a struct that declares its size, by the conventions of the ABI.
        let (mut given, translated, named, outputs) = unsafe {
            (
                structs::read(accuracy.cast_const(), "accuracy")?,
                options::translate(options)?,
                Named::read(scene)?,
                Outputs::of(std::ptr::null_mut(), report)?,
            )
        };
        let mut regions = Regions::default();
        match given.surface {
            Some(_) => named.add_without_distance(&mut regions, scene)?,
            None => named.add_to(&mut regions, scene)?,
        }
        translated.add_to(&mut regions, options)?;
        outputs.add_to(&mut regions, 0)?;
        regions.output_struct(accuracy, &given)?;
        regions.output("solver", solver, 1)?;
        recording.keep(&regions);
        regions.check()?;
        // The undeformed distance is copied: later grids are refined from it, and callbacks may write into the caller's array.
        // SAFETY: as above.
        let h = if given.surface.is_some() { Vec::new() } else { unsafe { named.copy_of_distance()? } };
        // SAFETY: as above.
        let scene = unsafe { named.with_distance(&h)? };
        let asked = translate(&given)?;
        let mut write = surface(&given, recording);
        let surface = write.as_mut().map(|write| write as SurfaceCallback<'_>);
        let watcher = Watcher::of(&translated);
        let told = &mut watcher.told();
        let outcome = solve_to_accuracy(&scene, &translated.options, &asked, surface, watcher.callback(told))?;
        let last_solver = outcome.solver.as_ref();
        given.set_grid(last_solver.map(Solver::grid));
        (given.reached, given.seconds) = (outcome.reached.unwrap_or(-1.0), outcome.seconds);
        let warnings = warnings(&outputs, &outcome, (&scene, &translated.options));
        outputs.write_report(&outcome.report, last_solver.map_or(&[], |solver| solver.ledger()), warnings)?;
        // SAFETY: a struct that declares its size; NULL or room for a pointer.
        unsafe {
            structs::write(accuracy, &given)?;
            if !solver.is_null() {
                solver.write(outcome.solver.map_or(std::ptr::null_mut(), contact_normal_solver::holding));
            }
        }
        let (status, message) = (outcome.stop.into(), outcome.reason);
        watcher.conclusion(Conclusion { status, message, warnings, ..Conclusion::default() }).conclude()
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_solve_to_accuracy", options, arguments, solve) }
}

/// The warnings about the last grid. There is no warning about an unknown error if the error of the targets is known.
fn warnings(outputs: &Outputs, outcome: &Refinement, (scene, options): (&Scene<'_>, &Options)) -> i32 {
    let Some(solver) = &outcome.solver else { return 0 };
    let on_last_grid = Scene { grid: *solver.grid(), ..scene.clone() };
    let options = Options { estimates: outcome.reached.is_none(), ..*options };
    outputs.warnings(&on_last_grid, &options, &outcome.report, solver.state())
}

impl contact_normal_accuracy {
    /// Sets the grid of the result; zeros without a result.
    fn set_grid(&mut self, grid: Option<&Grid>) {
        (self.mx, self.my) = grid.map_or((0, 0), |grid| (grid.mx as i32, grid.my as i32));
        (self.dx, self.dy) = grid.map_or((0.0, 0.0), |grid| (grid.dx, grid.dy));
    }
}

/// A function that calls the caller's surface callback and records what it wrote. Returns true to cancel. None: there is no callback.
pub(super) fn surface<'r, 'a>(
    given: &contact_normal_accuracy,
    recording: &'r mut Recording<'a>,
) -> Option<impl FnMut(&Grid, &mut [f64]) -> bool + use<'r, 'a>> {
    let (surface, user) = (given.surface?, given.user);
    Some(move |grid: &Grid, h: &mut [f64]| {
        // SAFETY: the caller's function, on the caller's thread, with room for all values; no lock is held.
        let cancels = in_host_environment(|| unsafe {
            surface(grid.mx as i32, grid.my as i32, grid.dx, grid.dy, h.as_mut_ptr(), user) != 0
        });
        if !cancels {
            recording.keep_surface(grid.mx, grid.my, h);
        }
        cancels
    })
}

/// The targets and the limits.
pub(super) fn translate(given: &contact_normal_accuracy) -> Result<Accuracy, Refusal> {
    let limit = |name: &str, value: i64| {
        let refuse = |_| Refusal::invalid(format!("{name} is {value}; it must be positive, or 0 for no limit"));
        u64::try_from(value).map_err(refuse)
    };
    Ok(Accuracy {
        // In the order of Quantity::ALL.
        targets: [
            given.target,
            given.max_pressure_target,
            given.contact_area_target,
            given.mean_gap_target,
            given.stiffness_target,
            given.tangential_force_target,
            given.creepage_target,
            given.spin_moment_target,
            given.stick_area_target,
            given.max_von_mises_target,
            given.von_mises_depth_target,
            given.max_shear_target,
        ],
        max_seconds: given.max_seconds,
        max_bytes: limit("max_bytes", given.max_bytes)?,
        max_elements: limit("max_elements", given.max_elements)?,
    })
}
