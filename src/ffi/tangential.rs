//! `contact_normal_solve_tangential`: the tangential problem alone, with pressures that are given.

use super::arguments::required;
use super::fields::contact_normal_fields;
use super::guard::guard;
use super::options::contact_normal_options;
use super::outputs::Buffers;
use super::report::contact_normal_report;
use super::scene::{contact_normal_scene, Named};
use super::solve::{explain, Conclusion, Request};
use super::status::contact_normal_status;
use super::watcher::{watched, Watcher};
use crate::solver::solve_tangential;

/// Solves the tangential problem of `scene->friction` with the caller's pressures, `[my][mx]`: those that are not positive count as no
/// contact. For programs that have a normal solver of their own. The undeformed distance (not NULL) and the load, if one is set, are checked but not
/// used, and tractions do not change the pressures: of unlike bodies this is one turn of two. `fields->traction`, `slip` and
/// `stick_slip` are written, no other; of the report what speaks of friction, `force`, `max_pressure` and `contact_count`. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solve_tangential(
    scene: *const contact_normal_scene,
    pressure: *const f64,
    options: *const contact_normal_options,
    fields: *mut contact_normal_fields,
    report: *mut contact_normal_report,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: each pointer is NULL or points to a struct that declares its size, by the conventions of the ABI.
        let Request { scene, options, outputs } = unsafe {
            let named = Named::read(scene)?.load_or_none();
            Request::of((named, scene), options, fields, report, &mut Buffers::default(), |_, _| Ok(()))?
        };
        // SAFETY: NULL or one value per element, by the conventions of the ABI.
        let pressure = unsafe { required("pressure", pressure, scene.grid.len())? };
        let found = watched(Watcher::of(&options), |progress| {
            let (stop, solution, report) = solve_tangential(&scene, pressure, &options.options, progress)?;
            outputs.write_friction(Some(&solution), scene.grid.len());
            outputs.write_report(&report, &[], 0)?;
            Ok(Conclusion::of(stop, || explain(stop, &report, options.options.method, None)))
        });
        found?.conclude()
    })
}
