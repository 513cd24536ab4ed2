//! The half-space and the loads for the stresses of a scene, with its effects.

use super::{Body, Loads};
use crate::effects::Patches;
use crate::effects::{self, Stresses};
use crate::error::{invalid, Error, Result};
use crate::scene::Scene;

/// The half-space that is `body` 1 or 2 of a scene, with pressures and tractions on it, `[my][mx]`; none: not there.
/// Refuses effects with which stresses are not known. The distance and the load of the scene are not used.
pub fn of_scene<'a>(scene: &'a Scene<'a>, body: i32, loads: [Option<&'a [f64]>; 3]) -> Result<(Body, Loads<'a>)> {
    effects::check_effects(scene)?;
    let b = match body {
        1 => 0,
        2 => 1,
        other => return invalid(format!("body is {other}; it must be 1 or 2")),
    };
    let plain = scene.plain();
    let (mut periodic, mut patches) = (false, None);
    for effect in effects::effects(scene) {
        match effect.stresses(b, &plain) {
            Stresses::Same => {}
            Stresses::Repeat => periodic = true,
            Stresses::Patches { count, patch, factors } => patches = Some(Patches { count, patch, factors }),
            Stresses::Unknown(why) => return Err(Error::Unsupported(format!("{} {why}", effect.name()))),
        }
    }
    let [pressure, traction_x, traction_y] = loads;
    let poisson_ratio = scene.bodies.poisson_ratio[b];
    let body = Body { grid: scene.grid, poisson_ratio, periodic };
    Ok((body, Loads { pressure, traction_x, traction_y, patches }))
}
