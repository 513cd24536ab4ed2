//! The effort of a solve on a small grid: its seconds, estimated from counts of products and elements. A bill chooses its grids by the effort, not by
//! measured seconds, so that the bill is the same in every call and on every machine.
//!
//! All constants are nanoseconds of one thread, measured on an AMD EPYC of 2024 with 16 x 16 to 256 x 256 elements.

use crate::effects;
use crate::scene::Scene;
use crate::solver::quantities::{OnGrid, Quantity};

/// Each solve, on any grid.
const SOLVE: f64 = 3e4;
/// The coefficients of a periodic scene, on any grid.
const PERIOD: f64 = 1.2e6;
/// The coefficients of coated bodies, on any grid.
const COATING: f64 = 4e5;
/// Each element and product of the normal problem.
const NORMAL: f64 = 10.0;
/// Each element and product of the tangential problem.
const TANGENTIAL: f64 = 4.0;
/// Each element, for the coefficients that couple the normal and the tangential problem of unlike bodies in rolling. In a shift they take half, which
/// is neglected.
const UNLIKE: f64 = 7200.0;
/// Each element, for a largest stress over all depths.
const STRESS: f64 = 1000.0;
/// Factor on [`STRESS`] with tractions.
const WITH_TRACTIONS: f64 = 3.0;
/// Factor on [`STRESS`] in periodic scenes.
const REPEATED: f64 = 10.0;
/// Each element, for the stiffness.
const STIFFNESS: f64 = 60.0;

/// The effort of the solve `found` of a scene, with the values of the `wanted` quantities.
pub fn effort(scene: &Scene<'_>, found: &OnGrid, wanted: &[Quantity]) -> f64 {
    let repeats = effects::repeats(scene) != (false, false);
    let unlike = if scene.friction.is_some() && scene.bodies.unlike() != 0.0 { UNLIKE } else { 0.0 };
    let normal = found.work_units - found.tangential;
    let stress =
        STRESS * if scene.friction.is_some() { WITH_TRACTIONS } else { 1.0 } * if repeats { REPEATED } else { 1.0 };
    let once =
        |any_of: &[Quantity], effort: f64| if wanted.iter().any(|one| any_of.contains(one)) { effort } else { 0.0 };
    // A largest stress and its depth are found together.
    let values = once(&[Quantity::MaxVonMises, Quantity::VonMisesDepth], stress)
        + once(&[Quantity::MaxShear], stress)
        + once(&[Quantity::Stiffness], STIFFNESS);
    let each = NORMAL * normal + TANGENTIAL * found.tangential + unlike + values;
    let whole = [(true, SOLVE), (repeats, PERIOD), (scene.coating.is_some(), COATING)];
    let whole: f64 = whole.into_iter().filter(|(has, _)| *has).map(|(_, effort)| effort).sum();
    whole + each * scene.grid.len() as f64
}
