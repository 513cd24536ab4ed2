//! The joined properties of all effects of a scene.

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
        /// Number of effects.
        pub const COUNT: usize = [$($(#[cfg($when)])? stringify!($name)),+].len();

        /// The place of an effect in the list.
        pub fn place(name: &str) -> Option<usize> {
            [$($(#[cfg($when)])? stringify!($name)),+].iter().position(|known| *known == name)
        }

        /// The effects of a scene in the order of the list; none where the scene does not name the effect or it [has no effect](Effect::is_one).
        pub(super) fn list<'s>(scene: &'s Scene<'_>) -> [Option<&'s dyn Effect>; COUNT] {
            let plain = &scene.plain();
            [$($(#[cfg($when)])? of(&scene.$name, plain)),+]
        }
    };
}

with_effects!(define_list);

fn of<'s, E: Effect>(effect: &'s Option<E>, scene: &Plain<'_>) -> Option<&'s (dyn Effect + 's)> {
    effect.as_ref().filter(|effect| effect.is_one(scene)).map(|effect| effect as &dyn Effect)
}

/// The effects of a scene, in the order of the list.
pub fn effects<'s>(scene: &'s Scene<'_>) -> impl Iterator<Item = &'s dyn Effect> {
    list(scene).into_iter().flatten()
}

/// The first effect with an answer: its name and the answer.
fn first<'s, T>(scene: &'s Scene<'_>, answer: impl Fn(Properties<'s>) -> Option<T>) -> Option<(&'static str, T)> {
    effects(scene).find_map(|effect| Some((effect.name(), answer(effect.properties())?)))
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

/// Refuses an effect if `is_there` holds for one that it excludes. `say(other)` begins the message.
pub(super) fn refuse_together(
    effect: &dyn Effect,
    is_there: impl Fn(&str) -> bool,
    say: impl Fn(&str) -> String,
) -> Result<()> {
    match effect.properties().excludes.iter().find(|other| is_there(other)) {
        Some(other) => Err(Error::Unsupported(format!("{}; {}", say(other), effect.why_excluded(other)))),
        None => Ok(()),
    }
}

/// Checks the caller's `coefficients` of pressures, which are not symmetric: refuses them if they do not suit an effect of the scene.
pub fn check_coefficients(scene: &Scene<'_>, coefficients: &Coefficients) -> Result<()> {
    effects(scene).try_for_each(|effect| effect.check_coefficients(&scene.grid, coefficients))
}

/// The effect that has the caller's coefficients, and their layout. With such coefficients the bodies are not used.
pub fn own_coefficients(scene: &Scene<'_>) -> Option<(&'static str, Layout)> {
    first(scene, |properties| properties.own_coefficients)
}

/// Whether own coefficients replace the bodies.
pub fn replace_bodies(scene: &Scene<'_>) -> bool {
    own_coefficients(scene).is_some()
}

/// Checks each body, and both together with the materials at their surfaces.
pub fn check_bodies(scene: &Scene<'_>) -> Result<()> {
    scene.bodies.check_each()?;
    effects(scene).find_map(|effect| effect.at_surface(&scene.plain())).unwrap_or(scene.bodies).check()
}

/// The first effect that excludes a given contact area.
pub fn without_given_area(scene: &Scene<'_>) -> Option<&'static str> {
    effects(scene).find(|effect| !effect.properties().with_given_area).map(Effect::name)
}

/// The first effect that is given for one grid only, and why.
fn one_grid(scene: &Scene<'_>) -> Option<(&'static str, &'static str)> {
    first(scene, |properties| properties.one_grid)
}

/// Refuses effects that are given for one grid only; called before a solve on several grids.
pub fn check_other_grids(scene: &Scene<'_>) -> Result<()> {
    match one_grid(scene) {
        Some((name, why)) => Err(Error::Unsupported(format!("{name} is given; {why}"))),
        None => Ok(()),
    }
}

/// The directions in which a scene is periodic.
pub fn repeats(scene: &Scene<'_>) -> (bool, bool) {
    effects(scene)
        .map(|effect| effect.properties().repeats)
        .fold((false, false), |(x, y), (of_x, of_y)| (x | of_x, y | of_y))
}

/// The largest admissible pressures of a scene; none: there are no limits.
pub fn limits<'s>(scene: &'s Scene<'_>) -> Option<PressureLimit<'s>> {
    first(scene, |properties| properties.limits).map(|(_, limits)| limits)
}

/// The effects with a further problem after the normal one.
pub fn beside<'s>(scene: &'s Scene<'_>) -> impl Iterator<Item = &'static str> + 's {
    effects(scene).filter(|effect| effect.properties().is_beside).map(Effect::name)
}

/// The effects whose step begins where the last one ended: place in the list, name, and how they continue.
pub fn continuing<'s>(scene: &'s Scene<'_>) -> impl Iterator<Item = (usize, &'static str, Continues)> + 's {
    let named = list(scene).into_iter().enumerate();
    named.filter_map(|(k, effect)| effect.and_then(|effect| Some((k, effect.name(), effect.properties().continues?))))
}

/// The problems coupled with the normal one, each with its history.
pub fn coupled<'s>(scene: &'s Scene<'_>, histories: &'s mut [History; COUNT]) -> Result<Vec<Box<dyn Coupled + 's>>> {
    let (plain, mut coupled) = (scene.plain(), Vec::new());
    for (effect, history) in list(scene).into_iter().zip(histories) {
        if let Some(effect) = effect {
            coupled.extend(effect.coupled(&plain, history)?);
        }
    }
    Ok(coupled)
}

/// The memory of the bodies, and the place in the list of the effect that has it.
pub fn memory(scene: &Scene<'_>, histories: &mut [History; COUNT]) -> Result<Option<(usize, Box<dyn Memory>)>> {
    let (plain, list) = (scene.plain(), list(scene));
    for (k, (effect, history)) in list.iter().zip(histories).enumerate() {
        if let Some(memory) = effect.map_or(Ok(None), |effect| effect.memory(&plain, &list, history))? {
            return Ok(Some((k, memory)));
        }
    }
    Ok(None)
}

/// Ends a step: keeps the histories of the scene's effects, and drops all others.
pub fn keep(scene: &Scene<'_>, histories: &mut [History; COUNT]) {
    for (effect, history) in list(scene).into_iter().zip(histories) {
        match effect {
            Some(_) => history.keep(),
            None => history.forget(),
        }
    }
}

/// The undeformed distance as changed by the effects of a scene; none if they do not change it.
pub fn surface(scene: &Scene<'_>) -> Result<Option<Vec<f64>>> {
    effects(scene).try_fold(None, |changed: Option<Vec<f64>>, effect| {
        let new = effect.surface(changed.as_deref().unwrap_or(scene.undeformed_distance))?;
        Ok(new.or(changed))
    })
}

/// The first effect of a scene that MULTIGRID and FULL_MULTIGRID do not solve.
pub fn excluded_method(scene: &Scene<'_>) -> Option<&'static str> {
    first(scene, |properties| properties.without_multigrid).map(|(_, what)| what)
}

impl Scene<'_> {
    /// The coefficients of the scene.
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

    /// Checks everything the solver relies on: each effect, excluded pairs, and the bodies if used. Returns the least distance.
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

    /// The friction of a scene whose pressures are given, with the checks of [`Effect::check_load`] for friction alone.
    pub fn tangential(&self) -> Result<&Friction<'_>> {
        self.grid.check()?;
        let Some(friction) = &self.friction else {
            return invalid("friction is not given: there is nothing to solve".into());
        };
        friction.check_load(&self.plain(), &list(self))?;
        Ok(friction)
    }

    /// [`Scene::tangential`], with all checks but those of the distance and the load.
    pub fn check_tangential(&self) -> Result<&Friction<'_>> {
        let friction = self.tangential()?;
        self.check_effects_and_bodies()?;
        Ok(friction)
    }

    /// Checks the members that change from solve to solve. Returns the least distance.
    pub fn check_distance_and_load(&self, threads: &Threads) -> Result<f64> {
        let plain = self.plain();
        let lowest = plain.check_distance(threads)?;
        self.load.check()?;
        effects(self).try_for_each(|effect| effect.check_load(&plain, &list(self)))?;
        plain.check_surface(lowest)?;
        Ok(lowest)
    }

    /// Refuses a load that no pressures carry, unless the contact area `is_fixed`.
    pub fn check_free_load(&self, is_fixed: bool) -> Result<()> {
        self.load.check_sign(is_fixed || self.attraction().is_some())?;
        if is_fixed {
            return Ok(());
        }
        self.check_area(None)
    }

    /// Refuses a load that no pressures carry, on any contact area or on the given one.
    pub fn check_area(&self, given: Option<&[bool]>) -> Result<()> {
        effects(self).try_for_each(|effect| effect.check_area(&self.plain(), &list(self), given))
    }
}
