//! `contact_normal_pull_off`: the search for the least force.

use super::conclusion::Conclusion;
use super::dump::{given, recorded, Recording};
use super::fields::contact_normal_fields;
use super::options::contact_normal_options;
use super::outputs::Buffers;
use super::report::contact_normal_report;
use super::scene::contact_normal_scene;
use super::solve::{explain, Needs, Request};
use super::status::contact_normal_status;
use super::watcher::Watcher;
use crate::solver::Solver;

/// Finds the pull-off: from the load of the scene, which has adhesion, the approach goes down until nothing is in contact, and so it does from
/// bodies that are pressed together. The result is the state of the least force on these ways (`report->normal.force`). A load to begin with that
/// is safe is a force of 0. The first way may take three times `max_cycles`, and each further way `max_cycles`, or four times the
/// cycles of the first and 500 if that is more. `options` NULL: the defaults; `fields`, `report` NULL: not wanted. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_pull_off(
    scene: *const contact_normal_scene,
    options: *const contact_normal_options,
    fields: *mut contact_normal_fields,
    report: *mut contact_normal_report,
) -> contact_normal_status {
    let arguments = given![scene, options, fields, report];
    let solve = |recording: &mut Recording<'_>| {
        let mut buffers = Buffers::default();
        // SAFETY: each pointer is NULL or points to a struct that declares its size, by the conventions of the ABI.
        let request =
            unsafe { Request::read(Needs::All, (scene, options), (fields, report), &mut buffers, |_, _| Ok(())) };
        recording.keep(&buffers.regions);
        let Request { scene, options, outputs } = request?;
        let (mut solver, _) = Solver::for_scene(&scene, &options.options)?;
        let watcher = Watcher::of(&options);
        let (stop, report) = solver.pull_off(&scene, &options.options, watcher.callback(&mut watcher.told()))?;
        let warnings = outputs.warnings(&scene, &options.options, &report, solver.state());
        outputs.write_fields(&solver, false);
        outputs.write_report(&report, solver.ledger(), warnings)?;
        let message = || explain(stop, &report, options.options.method, Some(solver.state()));
        watcher.conclusion(Conclusion { warnings, ..Conclusion::of(stop, message) }).conclude()
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_pull_off", options, arguments, solve) }
}
