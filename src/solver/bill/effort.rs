//! The cost of a small grid, from counts alone. A bill chooses its grids by it, so that the bill is the same on every run and machine.
//!
//! Nanoseconds of one thread on an EPYC of 2024, measured on 16 x 16 to 256 x 256 elements; products and elements are those of the solve.

use crate::effects;
use crate::scene::Scene;
use crate::solver::quantities::{OnGrid, Quantity};

/// Per solve, on any grid: the solve itself, the coefficients of a periodic scene, those of coated bodies.
const SOLVE: f64 = 3e4;
const PERIOD: f64 = 1.2e6;
const COATING: f64 = 4e5;
/// Per element and product: of the normal and of the tangential problem.
const NORMAL: f64 = 10.0;
const TANGENTIAL: f64 = 4.0;
/// Per element: the coefficients that couple both problems of unlike bodies, in rolling. In a shift they take half, but count in full.
const UNLIKE: f64 = 7200.0;
/// Per element: the largest stress over all depths, with factors for tractions and for periodic scenes; the stiffness.
const STRESS: f64 = 1000.0;
const WITH_TRACTIONS: f64 = 3.0;
const REPEATED: f64 = 10.0;
const STIFFNESS: f64 = 60.0;

/// The cost of a scene solved on its grid, with the values of `wanted`.
pub fn effort(scene: &Scene<'_>, found: &OnGrid, wanted: &[Quantity]) -> f64 {
    let repeats = effects::repeats(scene) != (false, false);
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
