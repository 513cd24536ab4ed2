//! The values of quantities after a solve on one grid.

use std::time::Instant;

use super::deepest::{Peak, Stress, Surface};
use super::{Quantity, Value};
use crate::contact::Outline;
use crate::effects;
use crate::error::{invalid, Error, Result};
use crate::friction::STICK;
use crate::grid::Grid;
use crate::progress::{Progress, ProgressCallback};
use crate::scene::Scene;
use crate::solver::estimates::beyond_ends;
use crate::solver::{Outcome, Report, Solver};
use crate::stress::{of_scene, MOST_SLENDER};
use crate::sums::in_blocks;

/// An area of n elements has at least the error of `OUTLINE_ERROR sqrt(n)` elements, even if two grids agree on it by chance: the outline of a circle
/// has `3.5 sqrt(n)` elements. Stiffnesses have at least the relative error `OUTLINE_ERROR/sqrt(n)`; where they agreed on two grids by chance, errors
/// were up to `0.25/sqrt(n)`.
const OUTLINE_ERROR: f64 = 0.3;

/// Why a quantity has no value, or its value no error; numbered as in the C ABI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lack {
    /// The scene has no friction.
    NoFriction = 1,
    /// The scene prescribes the quantity.
    Prescribed,
    /// The quantity is not computed with an effect of the scene.
    Effect,
    /// There is no contact on this grid. The quantity has no value, or it is 0 while a finer grid has contact.
    NoContact,
    /// The value grows from grid to grid: it is infinite, or no grid resolves it.
    Singular,
    /// There is only one grid, but the error follows from several.
    OneGrid,
    /// The solve of the grid did not converge, or was refused.
    Unsolved,
    /// The changes from grid to grid do not decrease yet, so the error is unknown.
    Unsettled,
}

impl Quantity {
    /// Refuses a quantity that the scene does not have on any grid.
    pub fn check(self, scene: &Scene<'_>) -> Result<()> {
        let name = self.name();
        match self.lack(scene) {
            None => Ok(()),
            Some(Lack::NoFriction) => invalid(format!("{name} is asked for, but friction is not given")),
            Some(Lack::Prescribed) => invalid(format!("{name} is asked for, but the scene prescribes it")),
            Some(_) if self == Quantity::Stiffness => {
                Err(Error::Unsupported(format!("{name} is asked for; it is that of bodies without adhesion")))
            }
            Some(_) => Err(Error::Unsupported(format!(
                "{name} is asked for; stresses are those of half-spaces, without coating, own coefficients, \
                 a period in one direction, or elements more slender than 1:64 with two periods"
            ))),
        }
    }

    /// Why the scene does not have the quantity on any grid; None if it has.
    ///
    /// This function and others of this file are not inlined. Otherwise the compiler moves their tests of effects out of the loop over quantities,
    /// and reads memory of absent effects, which was never written. This is harmless, but valgrind reports it.
    #[inline(never)]
    fn lack(self, scene: &Scene<'_>) -> Option<Lack> {
        use Quantity::{Creepage, MaxShear, MaxVonMises, SpinMoment, StickArea, TangentialForce, VonMisesDepth};
        match self {
            TangentialForce | Creepage | SpinMoment | StickArea => {
                let Some(friction) = &scene.friction else { return Some(Lack::NoFriction) };
                let has_forces = friction.has_forces();
                let is_prescribed = match self {
                    TangentialForce => has_forces == [true; 2],
                    Creepage => has_forces == [false; 2],
                    _ => false,
                };
                is_prescribed.then_some(Lack::Prescribed)
            }
            MaxVonMises | VonMisesDepth | MaxShear => {
                let is_solved = [1, 2].iter().all(|body| of_scene(scene, *body, [None; 3]).is_ok());
                (!is_solved || is_too_slender(scene)).then_some(Lack::Effect)
            }
            // With adhesion the stiffness at fixed attraction differs from that of the bodies.
            Quantity::Stiffness => scene.attraction().map(|_| Lack::Effect),
            _ => None,
        }
    }
}

/// Whether stresses near the surface are not computed because the scene has two periods and very slender elements. A single line of elements may be
/// slender.
fn is_too_slender(scene: &Scene<'_>) -> bool {
    let Grid { mx, my, dx, dy } = scene.grid;
    let is_line = mx == 1 || my == 1;
    effects::repeats(scene) == (true, true) && !is_line && dx.max(dy) > MOST_SLENDER * dx.min(dy)
}

/// Returns the values of the `wanted` quantities after a solve of `scene`, each with its reason if there is none. Stiffness and stresses are computed
/// here, which may take longer than the solve: `watch` is called after each step of these computations. None: `watch` cancelled.
pub fn values(
    solver: &mut Solver,
    scene: &Scene<'_>,
    report: &Report,
    wanted: &[Quantity],
    watch: ProgressCallback<'_>,
) -> Result<Option<Vec<std::result::Result<Value, Lack>>>> {
    let began = Instant::now();
    // Work units are 0 in this progress: by that callers can tell these steps from cycles of the solve. Steps are counted over all quantities.
    let (solved, residual, mut steps) = (report.solve_seconds, report.residual(), 0);
    let watch = &mut |_: &Progress| {
        steps += 1;
        let seconds = solved + began.elapsed().as_secs_f64();
        watch(&Progress { residual, ..Progress::of_part(&scene.grid, steps, seconds) })
    };
    let (mut stresses, mut values) = ([None, None], Vec::new());
    let at_ends = beyond_ends(&solver.problem, solver.state());
    for quantity in wanted {
        if let Some(lack) = quantity.lack(scene) {
            values.push(Err(lack));
            continue;
        }
        let stress = match quantity {
            Quantity::MaxShear => Some(Stress::Shear),
            Quantity::MaxVonMises | Quantity::VonMisesDepth => Some(Stress::VonMises),
            _ => None,
        };
        if let Some(stress) = stress {
            let is_depth = *quantity == Quantity::VonMisesDepth;
            let value = |peak: Peak| Value {
                value: if is_depth { peak.depth } else { peak.value },
                peak: Some(peak),
                least: 0.0,
            };
            let Some(peak) = peak((solver, scene), &mut stresses, stress, watch)? else { return Ok(None) };
            values.push(peak.map(value));
            continue;
        }
        let number = match quantity {
            Quantity::Force => Ok(report.measures.found(scene.load)),
            Quantity::MaxPressure => Ok(report.measures.max_pressure),
            Quantity::ContactArea => Ok(area(solver, report)),
            Quantity::MeanGap => Ok(mean_gap(solver)),
            Quantity::Stiffness => match stiffness(solver, report.measures.contact_count, watch)? {
                Some(stiffness) => stiffness,
                None => return Ok(None),
            },
            _ => tangential(solver, scene, report, *quantity),
        };
        let counted = |value: f64| match quantity {
            Quantity::StickArea => OUTLINE_ERROR / (value / scene.grid.element_area()).max(1.0).sqrt(),
            Quantity::Stiffness => OUTLINE_ERROR / (report.measures.contact_count.max(1) as f64).sqrt(),
            _ => 0.0,
        };
        values.push(number.map(|value| Value { least: counted(value).max(at_ends), ..Value::from(value) }));
    }
    Ok(Some(values))
}

/// The corrected area, from the report or from the outline.
fn area(solver: &Solver, report: &Report) -> f64 {
    let measures = &report.measures;
    if measures.corrected_area >= 0.0 {
        measures.corrected_area
    } else {
        let state = solver.state();
        Outline::of(state).corrected_area(state, measures.contact_count)
    }
}

/// The mean of the deformed distance over elements with a surface. 0 in full contact, where all deformed distances are residuals.
fn mean_gap(solver: &Solver) -> f64 {
    let state = solver.state();
    let finite = |i: &usize| state.h[*i].is_finite();
    let count = (0..state.h.len()).filter(finite).count();
    if state.contact_count() == count {
        return 0.0;
    }
    in_blocks((0..state.h.len()).filter(finite).map(|i| state.deformed_distance(i))) / count.max(1) as f64
}

/// The stiffness of the last result, which has `contacts` elements in contact. None: `watch` cancelled.
#[inline(never)]
fn stiffness(
    solver: &mut Solver,
    contacts: usize,
    watch: ProgressCallback<'_>,
) -> Result<Option<std::result::Result<f64, Lack>>> {
    Ok(Some(match solver.watched_stiffness(Some(watch)) {
        Ok((Outcome::Cancelled, _)) => return Ok(None),
        // Without contact there is no stiffness. (With all pressures at their limit there is contact, and the stiffness is 0.)
        Ok((Outcome::Converged, _)) if contacts == 0 => Err(Lack::NoContact),
        Ok((Outcome::Converged, stiffness)) => Ok(stiffness.value),
        Ok(_) => Err(Lack::Unsolved),
        Err(Error::Infeasible(_)) => Err(Lack::Singular),
        Err(error) => return Err(error),
    }))
}

/// A quantity of the tangential problem.
#[inline(never)]
fn tangential(
    solver: &Solver,
    scene: &Scene<'_>,
    report: &Report,
    quantity: Quantity,
) -> std::result::Result<f64, Lack> {
    let found = (&scene.friction, &report.friction, solver.friction());
    let (Some(friction), Some(found), Some(solution)) = found else { return Err(Lack::NoFriction) };
    let has_force = friction.has_forces();
    match quantity {
        Quantity::TangentialForce => Ok(found.force[0].hypot(found.force[1])),
        Quantity::Creepage => {
            let creepage = |k: usize| if has_force[k] { found.creepage[k] } else { 0.0 };
            Ok(creepage(0).hypot(creepage(1)))
        }
        Quantity::SpinMoment => Ok(found.moment),
        _ => {
            let sticks = solution.stick_slip.iter().filter(|state| **state == STICK).count();
            Ok(sticks as f64 * solver.grid().element_area())
        }
    }
}

/// The largest stress in both bodies. It is computed at the first call and then kept in `known`.
#[inline(never)]
fn peak(
    of: (&Solver, &Scene<'_>),
    known: &mut [Option<std::result::Result<Peak, Lack>>; 2],
    stress: Stress,
    watch: ProgressCallback<'_>,
) -> Result<Option<std::result::Result<Peak, Lack>>> {
    let place = &mut known[usize::from(stress == Stress::Shear)];
    if place.is_none() {
        *place = peak_of(of, stress, watch)?;
    }
    Ok(*place)
}

/// Computes the largest stress in both bodies; rigid bodies have none. None: `watch` cancelled.
#[inline(never)]
fn peak_of(
    (solver, scene): (&Solver, &Scene<'_>),
    stress: Stress,
    watch: ProgressCallback<'_>,
) -> Result<Option<std::result::Result<Peak, Lack>>> {
    let (body, loads) = of_scene(scene, 1, [None; 3])?;
    let tractions = solver.friction().map(|solution| &solution.traction[..]);
    let threads = &solver.problem.threads;
    let grid = (*solver.grid(), body.periodic);
    let surface = Surface::of(grid, &solver.state().p, tractions, loads.patches, threads)?;
    let Some(surface) = surface else { return Ok(Some(Err(Lack::NoContact))) };
    let bodies = &scene.bodies;
    let elastic = |b: usize| bodies.shear_modulus[b].is_finite();
    let alike = surface.is_the_same_for_both() && bodies.poisson_ratio[0] == bodies.poisson_ratio[1];
    let mut of = |surface: &Surface<'_>, b: usize| surface.peak(stress, bodies.poisson_ratio[b], threads, watch);
    let largest = if elastic(0) { of(&surface, 0)? } else { Some(Peak::default()) };
    let Some(mut largest) = largest else { return Ok(None) };
    if elastic(1) && !(alike && elastic(0)) {
        let Some(other) = of(&surface.of_body_2(), 1)? else { return Ok(None) };
        largest = largest.or(other);
    }
    Ok(Some(Ok(largest)))
}
