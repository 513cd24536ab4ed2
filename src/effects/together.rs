//! What all effects of a scene require together: the coefficients, the checks, and the joined [`Properties`].

use std::sync::Arc;

use super::coupled::{Coupled, History};
use super::effect::Effect;
use super::list::with_effects;
use super::memory::Memory;
use super::properties::{Continues, Layout, PressureLimit, Properties};
use crate::error::{invalid, Error, Result};
use crate::influence::{Coefficients, HalfSpace};
use crate::scene::{Friction, Plain, Scene};
use crate::threads::Threads;

/// The functions that need the whole [list](super::list) of effects.
macro_rules! define_list {
    ($($(#[doc = $doc:literal])+ $(#[cfg($when:meta)])? $name:ident: $effect:ty,)+) => {
        /// The number of effects in the list.
        pub const COUNT: usize = [$($(#[cfg($when)])? stringify!($name)),+].len();

        /// The index of an effect in the list. None: there is no effect `name`.
        pub fn place(name: &str) -> Option<usize> {
            [$($(#[cfg($when)])? stringify!($name)),+].iter().position(|known| *known == name)
        }

        /// One entry for each effect of the list. None: the scene does not have the effect, or its values [change nothing](Effect::is_one).
        pub(super) fn list<'s>(scene: &'s Scene<'_>) -> [Option<&'s dyn Effect>; COUNT] {
            let plain = &scene.plain();
            [$($(#[cfg($when)])? effective(&scene.$name, plain)),+]
        }
    };
}

with_effects!(define_list);

/// The effect, if there is one that [changes something](Effect::is_one).
fn effective<'s, E: Effect>(effect: &'s Option<E>, scene: &Plain<'_>) -> Option<&'s (dyn Effect + 's)> {
    effect.as_ref().filter(|effect| effect.is_one(scene)).map(|effect| effect as &dyn Effect)
}

/// The effects of a scene, in the order of the list.
pub fn effects<'s>(scene: &'s Scene<'_>) -> impl Iterator<Item = &'s dyn Effect> {
    list(scene).into_iter().flatten()
}

/// Among the effects of a scene, finds the first one that has a property. Returns the name of the effect, and the property.
fn first<'s, T>(scene: &'s Scene<'_>, property: impl Fn(Properties<'s>) -> Option<T>) -> Option<(&'static str, T)> {
    effects(scene).find_map(|effect| Some((effect.name(), property(effect.properties())?)))
}

/// Checks each effect of a scene, and refuses pairs that are not solved together.
pub fn check_effects(scene: &Scene<'_>) -> Result<()> {
    for effect in effects(scene) {
        effect.check(&scene.grid)?;
        let name = effect.name();
        let given = |other: &str| effects(scene).any(|effect| effect.name() == other);
        refuse_together(effect, given, |other| format!("{name} and {other} are both given"))?;
    }
    Ok(())
}

/// Refuses `effect` if it excludes an effect for which `is_present` holds. The message begins with `beginning(other)`.
pub(super) fn refuse_together(
    effect: &dyn Effect,
    is_present: impl Fn(&str) -> bool,
    beginning: impl Fn(&str) -> String,
) -> Result<()> {
    match effect.properties().excludes.iter().find(|other| is_present(other)) {
        Some(other) => Err(Error::Unsupported(format!("{}; {}", beginning(other), effect.why_excluded(other)))),
        None => Ok(()),
    }
}

/// Called if the caller's `coefficients` of pressures are not symmetric. Refuses coefficients that cannot be solved with an effect of the scene.
pub fn check_coefficients(scene: &Scene<'_>, coefficients: &Coefficients) -> Result<()> {
    effects(scene).try_for_each(|effect| effect.check_coefficients(&scene.grid, coefficients))
}

/// The name of the effect that holds the caller's coefficients, and their layout. Such coefficients replace those of the bodies.
pub fn own_coefficients(scene: &Scene<'_>) -> Option<(&'static str, Layout)> {
    first(scene, |properties| properties.own_coefficients)
}

/// Whether the caller's coefficients replace those of the bodies.
pub fn replace_bodies(scene: &Scene<'_>) -> bool {
    own_coefficients(scene).is_some()
}

/// Checks the elastic constants of each body, and those at both surfaces together.
pub fn check_bodies(scene: &Scene<'_>) -> Result<()> {
    scene.bodies.check_each()?;
    effects(scene).find_map(|effect| effect.at_surface(&scene.plain())).unwrap_or(scene.bodies).check()
}

/// The first effect that cannot be solved on a given contact area.
pub fn without_given_area(scene: &Scene<'_>) -> Option<&'static str> {
    effects(scene).find(|effect| !effect.properties().with_given_area).map(Effect::name)
}

/// Called before a solve on several grids. Refuses effects whose values hold on one grid only.
pub fn check_other_grids(scene: &Scene<'_>) -> Result<()> {
    match first(scene, |properties| properties.one_grid) {
        Some((name, why)) => Err(Error::Unsupported(format!("{name} is given; {why}"))),
        None => Ok(()),
    }
}

/// Whether a scene is periodic in x, and in y.
pub fn repeats(scene: &Scene<'_>) -> (bool, bool) {
    effects(scene)
        .map(|effect| effect.properties().repeats)
        .fold((false, false), |(x, y), (repeats_x, repeats_y)| (x | repeats_x, y | repeats_y))
}

/// The largest admissible pressures of a scene. None: there is no limit.
pub fn limits<'s>(scene: &'s Scene<'_>) -> Option<PressureLimit<'s>> {
    first(scene, |properties| properties.limits).map(|(_, limits)| limits)
}

/// The names of effects whose problem is solved after the normal one.
pub fn beside<'s>(scene: &'s Scene<'_>) -> impl Iterator<Item = &'static str> + 's {
    effects(scene).filter(|effect| effect.properties().is_beside).map(Effect::name)
}

/// The effects whose step begins where the last one ended. For each: its index in the list, its name, and how messages call such a step.
pub fn continuing<'s>(scene: &'s Scene<'_>) -> impl Iterator<Item = (usize, &'static str, Continues)> + 's {
    let indexed = list(scene).into_iter().enumerate();
    indexed.filter_map(|(k, effect)| effect.and_then(|effect| Some((k, effect.name(), effect.properties().continues?))))
}

/// The problems that are solved in turns with the normal one, each with the history of its effect.
pub fn coupled<'s>(scene: &'s Scene<'_>, histories: &'s mut [History; COUNT]) -> Result<Vec<Box<dyn Coupled + 's>>> {
    let (plain, mut coupled) = (scene.plain(), Vec::new());
    for (effect, history) in list(scene).into_iter().zip(histories) {
        if let Some(effect) = effect {
            coupled.extend(effect.coupled(&plain, history)?);
        }
    }
    Ok(coupled)
}

/// The step of bodies whose displacements depend on earlier steps, and the index in the list of the effect that has this step.
pub fn memory(scene: &Scene<'_>, histories: &mut [History; COUNT]) -> Result<Option<(usize, Box<dyn Memory>)>> {
    let (plain, list) = (scene.plain(), list(scene));
    for (k, (effect, history)) in list.iter().zip(histories).enumerate() {
        if let Some(memory) = effect.map_or(Ok(None), |effect| effect.memory(&plain, &list, history))? {
            return Ok(Some((k, memory)));
        }
    }
    Ok(None)
}

/// Called at the end of a step. Keeps the histories of the effects of the scene, and clears all others.
pub fn keep(scene: &Scene<'_>, histories: &mut [History; COUNT]) {
    for (effect, history) in list(scene).into_iter().zip(histories) {
        match effect {
            Some(_) => history.keep(),
            None => history.forget(),
        }
    }
}

/// The undeformed distance with the changes by the effects of a scene. None: no effect changes the undeformed distance.
pub fn surface(scene: &Scene<'_>) -> Result<Option<Vec<f64>>> {
    effects(scene).try_fold(None, |changed: Option<Vec<f64>>, effect| {
        let new = effect.surface(changed.as_deref().unwrap_or(scene.undeformed_distance))?;
        Ok(new.or(changed))
    })
}

/// The first effect of a scene that MULTIGRID and FULL_MULTIGRID do not solve, as messages call it.
pub fn excluded_method(scene: &Scene<'_>) -> Option<&'static str> {
    first(scene, |properties| properties.without_multigrid).map(|(_, what)| what)
}

impl Scene<'_> {
    /// The influence coefficients of pressures in this scene.
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

    /// Checks everything on which the solver relies: the grid, h, the load, each effect, pairs of effects, and the bodies if they are used. Returns
    /// the smallest undeformed distance.
    pub fn check(&self, threads: &Threads) -> Result<f64> {
        let lowest = self.check_distance_and_load(threads)?;
        self.check_effects_and_bodies()?;
        Ok(lowest)
    }

    /// Checks the grid, the effects and the bodies, but neither the undeformed distance nor the load.
    pub fn check_effects_and_bodies(&self) -> Result<()> {
        self.grid.check()?;
        check_effects(self)?;
        if !replace_bodies(self) {
            check_bodies(self)?;
        }
        Ok(())
    }

    /// The friction of a scene whose pressures are given. Of all [`Effect::check_load`] it calls that of friction only.
    pub fn tangential(&self) -> Result<&Friction<'_>> {
        self.grid.check()?;
        let Some(friction) = &self.friction else {
            return invalid("friction is not given: there is nothing to solve".into());
        };
        friction.check_load(&self.plain(), &list(self))?;
        Ok(friction)
    }

    /// As [`Scene::tangential`], with the checks of [`Scene::check_effects_and_bodies`].
    pub fn check_tangential(&self) -> Result<&Friction<'_>> {
        let friction = self.tangential()?;
        self.check_effects_and_bodies()?;
        Ok(friction)
    }

    /// Checks what may change from solve to solve: the undeformed distance and the load. Returns the smallest undeformed distance.
    pub fn check_distance_and_load(&self, threads: &Threads) -> Result<f64> {
        let plain = self.plain();
        let lowest = plain.check_distance(threads)?;
        self.load.check()?;
        effects(self).try_for_each(|effect| effect.check_load(&plain, &list(self)))?;
        plain.check_surface(lowest)?;
        Ok(lowest)
    }

    /// Refuses a load that no admissible pressures carry, unless the contact area `is_fixed`.
    pub fn check_free_load(&self, is_fixed: bool) -> Result<()> {
        self.load.check_sign(is_fixed || self.attraction().is_some())?;
        if is_fixed {
            return Ok(());
        }
        self.check_area(None)
    }

    /// Refuses a load that no admissible pressures carry, on any contact area or on the `given` one.
    pub fn check_area(&self, given: Option<&[bool]>) -> Result<()> {
        effects(self).try_for_each(|effect| effect.check_area(&self.plain(), &list(self), given))
    }
}
