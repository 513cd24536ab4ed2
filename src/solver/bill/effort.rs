//! What a small grid costs, by counts alone: a bill chooses its grids by these, so that it is the same on every run and every machine.
//!
//! Nanoseconds of one thread on an EPYC of 2024, measured on 16 x 16 to 256 x 256 elements; products and elements are those of the solve.

use crate::scene::Scene;
use crate::solver::quantities::{OnGrid, Quantity};

/// Of a solve, of the coefficients of a scene that repeats itself, and of those of coated bodies, whatever the grid.
const SOLVE: f64 = 3e4;
const PERIOD: f64 = 1.2e6;
const COATING: f64 = 4e5;
/// Of an element: for each product of the normal and of the tangential problem.
const NORMAL: f64 = 10.0;
const TANGENTIAL: f64 = 4.0;
/// For the coefficients by which tractions and pressures of unlike bodies feel each other, in rolling; in a shift they take half.
const UNLIKE: f64 = 7200.0;
/// For the largest stress over all depths: so many times more with tractions, and where the scene repeats itself. For the stiffness.
const STRESS: f64 = 1000.0;
const WITH_TRACTIONS: f64 = 3.0;
const REPEATED: f64 = 10.0;
const STIFFNESS: f64 = 60.0;

/// Of a scene that was solved on its grid, with the values of `wanted`.
pub fn effort(scene: &Scene<'_>, found: &OnGrid, wanted: &[Quantity]) -> f64 {
    let repeats = scene.period.is_some_and(|period| period.x || period.y);
    let unlike = if scene.friction.is_some() && scene.bodies.unlike() != 0.0 { UNLIKE } else { 0.0 };
    let normal = found.work_units - found.tangential;
    let stress =
        STRESS * if scene.friction.is_some() { WITH_TRACTIONS } else { 1.0 } * if repeats { REPEATED } else { 1.0 };
    let once =
        |any_of: &[Quantity], effort: f64| if wanted.iter().any(|of| any_of.contains(of)) { effort } else { 0.0 };
    // A largest stress is found with its depth.
    let values = once(&[Quantity::MaxVonMises, Quantity::VonMisesDepth], stress)
        + once(&[Quantity::MaxShear], stress)
        + once(&[Quantity::Stiffness], STIFFNESS);
    let each = NORMAL * normal + TANGENTIAL * found.tangential + unlike + values;
    let whole = [(true, SOLVE), (repeats, PERIOD), (scene.coating.is_some(), COATING)];
    let whole: f64 = whole.into_iter().filter(|(has, _)| *has).map(|(_, effort)| effort).sum();
    whole + each * scene.grid.len() as f64
}
