//! `contact_normal_solve`, and the parts of a solve that the solver handle uses as well.

use super::arguments::Regions;
use super::conclusion::Conclusion;
use super::dump::{given, recorded, Recording};
use super::fields::contact_normal_fields;
use super::options::{self, contact_normal_options, Translated};
use super::outputs::{Buffers, Outputs};
use super::report::contact_normal_report;
use super::scene::{contact_normal_scene, Named};
use super::status::{contact_normal_status, Refusal};
use super::warnings::advice_on_law;
use super::watcher::{why, Watcher};
use crate::contact::{Certificate, State};
use crate::effects;
use crate::error::Rounded;
use crate::scene::{Load, Scene};
use crate::solver::{ActiveSet, Asked, InitialGuess, Method, Neglected, Options, Outcome, Report, Solver};

/// Solves one scene. `options` NULL: the default options; `fields`, `report` NULL: not wanted. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_solve(
    scene: *const contact_normal_scene,
    options: *const contact_normal_options,
    fields: *mut contact_normal_fields,
    report: *mut contact_normal_report,
) -> contact_normal_status {
    let arguments = given![scene, options, fields, report];
    let solve = |recording: &mut Recording<'_>| {
        let mut buffers = Buffers::default();
        let (arguments, outputs) = ((scene, options), (fields, report));
        // SAFETY: each pointer is NULL or points to a struct that declares its size, by the conventions of the ABI.
        let request = unsafe { Request::read(Needs::AllOrLess, arguments, outputs, &mut buffers, |_, _| Ok(())) };
        recording.keep(&buffers.regions);
        let Request { mut scene, options, mut outputs } = request?;
        // Checked before the set-up, so that a refused call costs no set-up.
        outputs.check_inputs(&options.options, scene.grid.len())?;
        let watcher = Watcher::of(&options);
        if options.given.neglect_below > 0.0 {
            let target = options.given.neglect_below;
            let neglected = Neglected::of(&scene, &options.options, target, watcher.callback(&mut watcher.told()))?;
            scene = neglected.leave_out(&scene);
            outputs.neglected = Some(neglected);
        }
        let (mut solver, lowest) = Solver::for_scene(&scene, &options.options)?;
        let options = &outputs.options(&options.options);
        let guess = outputs.guess(options, scene.grid.len(), &mut buffers)?;
        let asked = Asked { guess, ..Asked::new((&scene, lowest), options) };
        let solved = solver.solve_checked(asked, watcher.callback(&mut watcher.told()))?;
        end(&solver, (&scene, options), solved, &watcher, &outputs)?.conclude()
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_solve", options, arguments, solve) }
}

/// The arguments of a solve. The values of the scene are not checked yet: the core does that.
pub(super) struct Request<'a> {
    pub scene: Scene<'a>,
    pub options: Translated,
    pub outputs: Outputs,
}

/// Which parts of a scene a call reads.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Needs {
    /// All parts. The undeformed distance and the load must be given.
    All,
    /// As `All`. The call may leave out effects (`neglect_below`).
    AllOrLess,
    /// The undeformed distance may be NULL. Then the load is not read either.
    Bodies,
    /// The pressures are given: neither the undeformed distance nor the load is read.
    NoLoad,
}

impl Request<'_> {
    /// Reads the structs. Refuses outputs that overlap with inputs or with each other: those of `fields` and `report`, and those that `also` adds for
    /// the number of elements. The caller's arrays must live as long as the result is used.
    pub unsafe fn read<'a>(
        needs: Needs,
        (scene, options): (*const contact_normal_scene, *const contact_normal_options),
        (fields, report): (*mut contact_normal_fields, *mut contact_normal_report),
        buffers: &mut Buffers,
        also: impl FnOnce(&mut Regions, usize) -> Result<(), Refusal>,
    ) -> Result<Request<'a>, Refusal> {
        let regions = &mut buffers.regions;
        regions.clear();
        // SAFETY (all): by the caller.
        unsafe {
            let named = Named::read(scene)?;
            match needs {
                Needs::NoLoad => named.add_without_distance(regions, scene)?,
                _ => named.add_to(regions, scene)?,
            }
            let translated = match needs {
                Needs::AllOrLess => options::translate_neglecting(options)?,
                _ => options::translate(options)?,
            };
            translated.add_to(regions, options)?;
            let outputs = Outputs::of(fields, report)?;
            outputs.add_to(regions, named.len())?;
            outputs.add_read(regions, &translated.options);
            also(regions, named.len())?;
            regions.check()?;
            let scene = match needs {
                Needs::NoLoad => named.without_load()?,
                Needs::Bodies if !named.has_distance() => named.without_load()?,
                Needs::Bodies => named.load_or_none().translate()?,
                _ => named.translate()?,
            };
            Ok(Request { scene, options: translated, outputs })
        }
    }
}

impl Request<'_> {
    /// Whether the solve starts from the last result of the handle.
    pub fn goes_on(&self) -> bool {
        let continues = effects::continuing(&self.scene).next().is_some();
        continues || self.options.options.initial_guess == InitialGuess::Previous
    }
}

/// Solves a scene by a solver that is set up, and writes the outputs.
pub(super) fn run(
    solver: &mut Solver,
    scene: &Scene<'_>,
    options: &Options,
    watcher: &Watcher,
    outputs: &Outputs,
    buffers: &mut Buffers,
) -> Result<Conclusion, Refusal> {
    let n = scene.grid.len();
    outputs.check_inputs(options, n)?;
    let options = &outputs.options(options);
    let guess = outputs.guess(options, n, buffers)?;
    let solved = solver.solve(scene, options, guess, watcher.callback(&mut watcher.told()))?;
    end(solver, (scene, options), solved, watcher, outputs)
}

/// Writes the outputs of a solve. Returns the status, the message and the warnings.
fn end(
    solver: &Solver,
    (scene, options): (&Scene<'_>, &Options),
    (outcome, report): (Outcome, Report),
    watcher: &Watcher,
    outputs: &Outputs,
) -> Result<Conclusion, Refusal> {
    let warnings = outputs.warnings(scene, options, &report, solver.state());
    outputs.write_fields(solver, options.active_set == ActiveSet::Fixed);
    outputs.write_report(&report, solver.ledger(), warnings)?;
    let message =
        || explain(outcome, &report, options.method, Some(solver.state())) + &lack_of_force(scene.load, &report);
    Ok(watcher.conclusion(Conclusion { warnings, ..Conclusion::of(outcome, message) }))
}

/// The message of a solve that did not converge: why the iteration ended, after how many cycles, and with which residuals.
pub(super) fn explain(outcome: Outcome, report: &Report, method: Method, state: Option<&State>) -> String {
    let (cycles, residual) = (report.count.cycles, report.measures.certificate.residual);
    let tangential = report.friction.map(|found| format!("; that of friction is {:e}", found.certificate.residual));
    let counted = |count: u64, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    let products = match report.friction {
        Some(found) if outcome == Outcome::IterationLimit => {
            format!(" and {} of friction", counted(found.products.round() as u64, "product"))
        }
        _ => String::new(),
    };
    let cycles = counted(cycles, "cycle");
    let mut message = format!("{} after {cycles}{products}; the residual is {residual:e}", why(outcome));
    if outcome != Outcome::Cancelled && residual <= report.tolerance && report.friction.is_none() {
        let Certificate { violation, complementarity, .. } = report.measures.certificate;
        message += &format!(", the violation {violation:e} and the complementarity {complementarity:e}");
    }
    if let Some(law) = report.adhesion.map(|found| found.law_residual).filter(|law| !(*law <= report.tolerance)) {
        message += &format!("; that of the law of adhesion is {law:e}");
    }
    message += tangential.as_deref().unwrap_or_default();
    if let Some(missing) = report.friction.map(|found| found.missing).filter(|missing| *missing > report.tolerance) {
        message += &format!("; the tangential force is off by {missing:e} of mu N");
    }
    if outcome == Outcome::Stagnated {
        message += &state.map_or_else(String::new, |state| stagnation(report, method, state));
    }
    if outcome != Outcome::Cancelled {
        message += &report.friction.map_or_else(String::new, |found| advice_on_law(found.law_slope));
    }
    message
}

/// The part of the message about a force that differs from the given one by more than the tolerance; empty otherwise.
fn lack_of_force(load: Load, report: &Report) -> String {
    let Load::Force(given) = load else { return String::new() };
    let lack = (report.measures.force / given - 1.0).abs();
    if !(lack > report.tolerance && lack.is_finite()) {
        return String::new();
    }
    let found = match report.adhesion.is_some_and(|found| found.is_short) {
        true => format!(
            "; no way down has led to the force that is given until then, and the strongest state on them holds a pull of {}, at an approach \
             of {}",
            Rounded(report.measures.force),
            Rounded(report.measures.approach)
        ),
        false => String::new(),
    };
    format!("{found}; the force is off by {} of the one that is given", Rounded(lack))
}

/// The part of the message about a solve that stagnated: the reason, if the result shows it, and advice.
fn stagnation(report: &Report, method: Method, state: &State) -> String {
    let (residual, distances) = (report.measures.certificate.residual, Distances::of(state));
    // If the residual of the normal problem meets the tolerance, the tangential problem has stagnated.
    let is_normal = report.friction.is_none() || residual > report.tolerance;
    // The residual has the round-off of the product and of the distances: some multiples of that of one distance.
    if residual > report.tolerance && residual <= 100.0 * distances.round_off {
        return match distances.largest > FAR * distances.rms {
            true => format!(
                ", about the round-off of distances of order {:.0e}: a larger tolerance, or distances measured from nearer",
                distances.largest
            ),
            false => ", about the round-off of double precision: a larger tolerance".into(),
        };
    }
    let advice = match method {
        Method::Auto => "",
        Method::Multigrid | Method::FullMultigrid => ": another method or smoother may go on; AUTO tries them all",
        _ => ": another method may go on; AUTO tries them all",
    };
    match is_normal {
        true if state.p.iter().all(|p| *p == 0.0) => {
            format!(", that of p = 0: nothing that was tried is nearer to a solution{advice}")
        }
        true => advice.into(),
        false => String::new(),
    }
}

/// If the largest of |h| and |u| exceeds the rms of h - approach by more than this factor, a message advises to measure h from a nearer plane.
const FAR: f64 = 100.0;

/// The size of h, u and h - approach on the elements in contact or, if there are none, on those at the pressure limit.
struct Distances {
    /// The largest of |h| and |u|.
    largest: f64,
    /// rms of h - approach, to which the residual is relative.
    rms: f64,
    /// The round-off of `largest`, relative to `rms`; 0 if `rms` is 0.
    round_off: f64,
}

impl Distances {
    fn of(state: &State) -> Distances {
        let (mut largest, mut squares, mut count) = (0.0f64, 0.0, 0usize);
        let has_contact = state.contact_count() > 0;
        for i in (0..state.h.len()).filter(|&i| if has_contact { state.contact[i] } else { state.touches(i) }) {
            largest = largest.max(state.h[i].abs()).max(state.u[i].abs());
            squares += (state.h[i] - state.approach).powi(2);
            count += 1;
        }
        let rms = (squares / count.max(1) as f64).sqrt();
        let round_off = Some(f64::EPSILON * largest / rms).filter(|round_off| round_off.is_finite());
        Distances { largest, rms, round_off: round_off.unwrap_or(0.0) }
    }
}
