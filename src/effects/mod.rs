//! What a scene may name beside its bodies: one file per effect, and the list of them.
//!
//! | effect | goes not with | MULTIGRID, FULL_MULTIGRID | on a handle |
//! |---|---|---|---|
//! | influence | period, row_tables | yes | not named: that of the set-up; named: the same |
//! | row_tables | influence, period | no | the same as influence |
//! | period | influence, row_tables, patches | no | that of the set-up |
//! | patches | period | no | those of the set-up |
//! | layer | | a uniform one | that of the set-up |
//! | pressure_limit | | yes | another one for each solve |
//!
//! A new effect is a file with an `impl Effect`, a field of [`Scene`], and a line in the list.

mod layer;
mod named;
mod patches;
mod period;
mod pressure_limit;
mod tables;

use std::sync::Arc;

pub use layer::Layer;
pub use named::{Named, Value};
pub use patches::Patches;
pub use period::Period;
pub use pressure_limit::PressureLimit;

use crate::error::{invalid, Error, Result};
use crate::grid::Grid;
use crate::influence::{Coefficients, HalfSpace, Kernel};
use crate::scene::Scene;

/// An effect. What is not said is that of one that changes nothing and goes with everything.
pub trait Effect {
    /// As it is called in a scene.
    fn name(&self) -> &'static str;

    /// Refuses what is none.
    fn check(&self, grid: &Grid) -> Result<()>;

    /// Refuses a load that it cannot carry; asked for each solve.
    fn check_load(&self, _scene: &Scene<'_>) -> Result<()> {
        Ok(())
    }

    /// The names of the effects that it is not solved with; one of a pair says so.
    fn excludes(&self) -> &'static [&'static str] {
        &[]
    }

    /// Whether the bodies of the scene do not matter: it has coefficients of its own.
    fn replaces_bodies(&self) -> bool {
        false
    }

    /// What MULTIGRID and FULL_MULTIGRID do not solve: there is no smoother, or there are no coarser grids.
    fn without_multigrid(&self) -> Option<&'static str> {
        None
    }

    /// Its own kernel, in place of the half-space's.
    fn kernel(&self, _scene: &Scene<'_>) -> Result<Option<Arc<dyn Kernel>>> {
        Ok(None)
    }

    /// What it does to the coefficients of the kernel.
    fn apply(&self, coefficients: Coefficients) -> Result<Coefficients> {
        Ok(coefficients)
    }

    /// Tells each value that a set-up depends on, with its name.
    fn values(&self, _tell: &mut dyn FnMut(&'static str, Value<'_>)) {}
}

/// Checks one value per element; the message names the first one that `require` refuses.
fn check_values(name: &str, values: &[f64], grid: &Grid, require: impl Fn(&str, f64) -> Result<()>) -> Result<()> {
    if values.len() != grid.len() {
        return invalid(format!("{name} has {} values; the grid has {} elements", values.len(), grid.len()));
    }
    match values.iter().position(|value| require(name, *value).is_err()) {
        Some(i) => require(&format!("{name} of {}", grid.element(i)), values[i]),
        None => Ok(()),
    }
}

/// Number of effects.
const COUNT: usize = 6;

/// The list: the effects that a scene names, those with a kernel first, the others in the order in which they act on coefficients.
fn list<'s>(scene: &'s Scene<'_>) -> [Option<&'s dyn Effect>; COUNT] {
    fn of<'s, E: Effect>(effect: &'s Option<E>) -> Option<&'s (dyn Effect + 's)> {
        effect.as_ref().map(|effect| effect as &dyn Effect)
    }
    [
        of(&scene.influence),
        of(&scene.row_tables),
        of(&scene.period),
        of(&scene.patches),
        of(&scene.layer),
        of(&scene.pressure_limit),
    ]
}

fn effects<'s>(scene: &'s Scene<'_>) -> impl Iterator<Item = &'s dyn Effect> {
    list(scene).into_iter().flatten()
}

/// Checks each effect of a scene, refuses pairs that are not solved, and the bodies if they matter.
pub fn check(scene: &Scene<'_>) -> Result<()> {
    check_effects(scene)?;
    if replace_bodies(scene) {
        return Ok(());
    }
    scene.bodies.check()
}

/// Checks each effect of a scene, and refuses pairs that are not solved.
pub fn check_effects(scene: &Scene<'_>) -> Result<()> {
    for effect in effects(scene) {
        effect.check(&scene.grid)?;
        if let Some(other) = effects(scene).find(|other| effect.excludes().contains(&other.name())) {
            return Err(Error::Unsupported(format!(
                "{} and {} are both given; this version does not solve them together",
                effect.name(),
                other.name()
            )));
        }
    }
    Ok(())
}

/// Checks what effects say about the load, which changes from solve to solve.
pub fn check_load(scene: &Scene<'_>) -> Result<()> {
    effects(scene).try_for_each(|effect| effect.check_load(scene))
}

/// Whether the bodies do not matter: own coefficients know none.
pub fn replace_bodies(scene: &Scene<'_>) -> bool {
    effects(scene).any(Effect::replaces_bodies)
}

/// What of a scene MULTIGRID and FULL_MULTIGRID do not solve.
pub fn excluded_method(scene: &Scene<'_>) -> Option<&'static str> {
    effects(scene).find_map(Effect::without_multigrid)
}

/// The coefficients that a scene asks for.
pub fn coefficients(scene: &Scene<'_>) -> Result<Coefficients> {
    let mut kernel = None;
    for effect in effects(scene) {
        kernel = kernel.or(effect.kernel(scene)?);
    }
    let plain = || Arc::new(HalfSpace::new(scene.grid.dx, scene.grid.dy, scene.bodies.compliance()));
    let coefficients = Coefficients::new(kernel.unwrap_or_else(|| plain()));
    effects(scene).try_fold(coefficients, |coefficients, effect| effect.apply(coefficients))
}
