//! The half-space and the loads for the stresses in a body of a scene, with the scene's effects.

use super::{Body, Loads};
use crate::effects::Patches;
use crate::effects::{self, Stresses};
use crate::error::{invalid, Error, Result};
use crate::scene::Scene;

/// Returns the half-space that stands for `body` 1 or 2 of a scene, and its loads. `loads` are the pressure and the tractions, `[my][mx]`, or
/// `None`. Effects for which stresses are not known are refused. The undeformed distance and the load of the scene are not used.
pub fn of_scene<'a>(scene: &'a Scene<'a>, body: i32, loads: [Option<&'a [f64]>; 3]) -> Result<(Body, Loads<'a>)> {
    effects::check_effects(scene)?;
    let index = match body {
        1 => 0,
        2 => 1,
        other => return invalid(format!("body is {other}; it must be 1 or 2")),
    };
    let plain = scene.plain();
    let (mut periodic, mut patches) = (false, None);
    for effect in effects::effects(scene) {
        match effect.stresses(index, &plain) {
            Stresses::Same => {}
            Stresses::Repeat => periodic = true,
            Stresses::Patches { count, patch, factors } => patches = Some(Patches { count, patch, factors }),
            Stresses::Unknown(why) => return Err(Error::Unsupported(format!("{} {why}", effect.name()))),
        }
    }
    let [pressure, traction_x, traction_y] = loads;
    let poisson_ratio = scene.bodies.poisson_ratio[index];
    let body = Body { grid: scene.grid, poisson_ratio, periodic };
    Ok((body, Loads { pressure, traction_x, traction_y, patches }))
}
