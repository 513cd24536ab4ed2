//! The list of effects, and what all those of a scene say together.

use std::sync::Arc;

use super::effect::Effect;
use crate::error::{invalid, Error, Result};
use crate::influence::{Coefficients, HalfSpace};
use crate::scene::{Friction, Scene};
use crate::threads::Threads;

/// Number of effects.
pub(super) const COUNT: usize = 9;

/// The list: the effects that a scene names, those with a kernel first, the others in the order in which they act on coefficients. A coating of no
/// thickness, or of the body's own material, is none, and an adhesion without any work.
pub(super) fn list<'s>(scene: &'s Scene<'_>) -> [Option<&'s dyn Effect>; COUNT] {
    fn of<'s, E: Effect>(effect: &'s Option<E>) -> Option<&'s (dyn Effect + 's)> {
        effect.as_ref().map(|effect| effect as &dyn Effect)
    }
    [
        of(&scene.influence),
        of(&scene.row_tables),
        of(&scene.coating).filter(|_| scene.coating.is_some_and(|coating| coating.is_one(&scene.plain()))),
        of(&scene.period),
        of(&scene.patches),
        of(&scene.layer),
        of(&scene.pressure_limit),
        of(&scene.friction),
        of(&scene.adhesion).filter(|_| {
            scene.adhesion.is_some_and(|adhesion| adhesion.is_one() || adhesion.check(&scene.grid).is_err())
        }),
    ]
}

pub(super) fn effects<'s>(scene: &'s Scene<'_>) -> impl Iterator<Item = &'s dyn Effect> {
    list(scene).into_iter().flatten()
}

/// Checks each effect of a scene, and refuses pairs that are not solved.
pub fn check_effects(scene: &Scene<'_>) -> Result<()> {
    for effect in effects(scene) {
        effect.check(&scene.grid)?;
        let name = effect.name();
        let given = |other: &str| effects(scene).any(|effect| effect.name() == other);
        refuse_together(effect, given, |other| format!("{name} and {other} are both given"))?;
    }
    Ok(())
}

/// Refuses an effect beside others that are there and that it is not solved with; `say(other)` begins the message.
pub(super) fn refuse_together(
    effect: &dyn Effect,
    is_there: impl Fn(&str) -> bool,
    say: impl Fn(&str) -> String,
) -> Result<()> {
    match effect.excludes().iter().find(|other| is_there(other)) {
        Some(other) => Err(Error::Unsupported(format!("{}; this version does not solve them together", say(other)))),
        None => Ok(()),
    }
}

/// Whether the bodies do not matter: own coefficients know none.
pub fn replace_bodies(scene: &Scene<'_>) -> bool {
    effects(scene).any(Effect::replaces_bodies)
}

/// Checks the bodies, which a coating needs to be elastic.
pub fn check_bodies(scene: &Scene<'_>) -> Result<()> {
    if let Some(coating) = &scene.coating {
        coating.check_below(&scene.plain())?;
    }
    scene.bodies.check()
}

/// What of a scene MULTIGRID and FULL_MULTIGRID do not solve.
pub fn excluded_method(scene: &Scene<'_>) -> Option<&'static str> {
    effects(scene).find_map(Effect::without_multigrid)
}

impl Scene<'_> {
    /// The coefficients that this scene asks for.
    pub fn coefficients(&self) -> Result<Coefficients> {
        self.grid.check()?;
        let (plain, mut kernel) = (self.plain(), None);
        for effect in effects(self) {
            if kernel.is_none() {
                kernel = effect.kernel(&plain, &list(self))?;
            }
        }
        let half_space = || Arc::new(HalfSpace::new(self.grid.dx, self.grid.dy, self.bodies.compliance()));
        let coefficients = Coefficients::new(kernel.unwrap_or_else(|| half_space()));
        effects(self).try_fold(coefficients, |coefficients, effect| effect.apply(coefficients))
    }

    /// Checks everything the solver relies on: each effect, the pairs that are not solved, and the bodies if they matter. Returns the least distance.
    pub fn check(&self, threads: &Threads) -> Result<f64> {
        let lowest = self.check_distance_and_load(threads)?;
        self.check_effects_and_bodies()?;
        Ok(lowest)
    }

    /// Checks all but the distance and the load.
    pub fn check_effects_and_bodies(&self) -> Result<()> {
        self.grid.check()?;
        check_effects(self)?;
        if !replace_bodies(self) {
            check_bodies(self)?;
        }
        Ok(())
    }

    /// The friction of a scene whose pressures are given; refuses tables without `cross` beside unlike bodies.
    pub fn tangential(&self) -> Result<&Friction<'_>> {
        self.grid.check()?;
        let Some(friction) = &self.friction else {
            return invalid("friction is not given: there is nothing to solve".into());
        };
        friction.check_load(&self.plain(), &list(self))?;
        Ok(friction)
    }

    /// The same; checks all but the distance and the load.
    pub fn check_tangential(&self) -> Result<&Friction<'_>> {
        let friction = self.tangential()?;
        self.check_effects_and_bodies()?;
        Ok(friction)
    }

    /// Checks what changes from solve to solve. Returns the least distance.
    pub fn check_distance_and_load(&self, threads: &Threads) -> Result<f64> {
        let plain = self.plain();
        let lowest = plain.check_distance(threads)?;
        self.load.check()?;
        effects(self).try_for_each(|effect| effect.check_load(&plain, &list(self)))?;
        plain.check_surface(lowest)?;
        Ok(lowest)
    }

    /// Refuses a load that no pressures carry: of a contact area that is to be found, not of one that `is_fixed`.
    pub fn check_free_load(&self, is_fixed: bool) -> Result<()> {
        self.load.check_sign(is_fixed || self.attraction().is_some())?;
        if is_fixed {
            return Ok(());
        }
        self.check_area(None)
    }

    /// Refuses a load that no pressures carry, on any contact area or on the one that is given.
    pub fn check_area(&self, given: Option<&[bool]>) -> Result<()> {
        effects(self).try_for_each(|effect| effect.check_area(&self.plain(), &list(self), given))
    }
}
