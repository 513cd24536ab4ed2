//! `contact_normal_pull_off`: the search for the pull-off force, the strongest pull of bodies with adhesion.

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

/// Searches the pull-off force of a scene with adhesion. The call decreases the approach until nothing is in contact, on several paths: from the
/// state of the scene's load, and from bodies that are pressed together. The result is the state of the strongest pull on these paths; its force, in
/// `report->normal.force`, is the smallest one, negative. A force of 0 is a load with which the search can always begin. The first path may take
/// three times `max_cycles`. Each further path may take `max_cycles` or, if that is more, 500 plus four times the cycles of the first path. `options`
/// NULL: the defaults; `fields`, `report` NULL: not wanted. Since 0.2.
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
        let (outcome, report) = solver.pull_off(&scene, &options.options, watcher.callback(&mut watcher.told()))?;
        let warnings = outputs.warnings(&scene, &options.options, &report, solver.state());
        outputs.write_fields(&solver, false);
        outputs.write_report(&report, solver.ledger(), warnings)?;
        let message = || explain(outcome, &report, options.options.method, Some(solver.state()));
        watcher.conclusion(Conclusion { warnings, ..Conclusion::of(outcome, message) }).conclude()
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_pull_off", options, arguments, solve) }
}
